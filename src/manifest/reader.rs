//! What is at hand while a manifest is read: the report, the key being read, and what names stand for.

use super::body::{AssetRef, Body};
use super::lens::Lens;
use super::material::Material;
use super::names::Names;
use super::node::{Node, Source};
use super::record::Kind;
use super::spectrum::Spectrum;
use super::surroundings::Surroundings;
use super::yaml;
use crate::error::{Place, Report, nearest_name};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Keys within one another, names followed included; deeper means a mistake or an attack.
const DEEPEST: usize = 96;

/// Faults that are kept; nobody reads more.
pub(crate) const MOST_FAULTS: usize = 1000;
/// Characters of a message that are kept.
const LONGEST_MESSAGE: usize = 400;

/// The speed of light in vacuum, m/s (exact: SI brochure, 9th edition, §2.2).
pub const LIGHT_SPEED: f64 = 299_792_458.0;

/// Something is wrong with a value and the report says what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reported;

/// A value, or none because of faults that are in the report.
pub(crate) type Read<T> = Result<T, Reported>;

/// What has no faults of its own, and may have some in files.
#[derive(Default)]
pub(crate) struct Rest {
    pub(crate) assets: BTreeMap<String, AssetRef>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) surroundings: Vec<Surroundings>,
}

/// The state of reading.
pub(crate) struct Reader<'a> {
    pub(crate) report: &'a mut Report,
    /// The folder of the manifest: paths in it are relative to that.
    pub(crate) folder: &'a Path,
    /// Metres that light travels in a second of this manifest.
    pub(crate) light_speed: f64,
    /// The names under `assets`.
    pub(crate) assets: BTreeSet<String>,
    /// Those of them that are shapes, not model files.
    pub(crate) solids: BTreeSet<String>,
    /// The names of the bodies, each under its own name or that of its asset.
    pub(crate) bodies: Vec<String>,
    /// Whether the observer is a ring of observers, whose exposures may all be at one instant.
    pub(crate) ring: bool,
    /// Whether the observer is a camera of a file, whose animation has times of its own.
    pub(crate) filmed: bool,
    /// What the observer's camera makes its pictures with.
    pub(crate) lens: Lens,
    pub(crate) spectra: Names<Spectrum>,
    pub(crate) materials: Names<Material>,
    /// What could be read of things that stand in files, whatever else has faults.
    pub(crate) rest: Rest,
    /// Whether a manifest that this one extends could not be had: what is missing here may be there.
    pub(crate) partial: bool,
    keys: Vec<String>,
    /// What stands before and after the part of a text that is being read.
    around: (String, String),
}

impl<'a> Reader<'a> {
    pub(crate) fn new(folder: &'a Path, report: &'a mut Report) -> Self {
        Self {
            report,
            folder,
            light_speed: LIGHT_SPEED,
            assets: BTreeSet::new(),
            solids: BTreeSet::new(),
            bodies: Vec::new(),
            ring: false,
            filmed: false,
            lens: Lens::Pinhole,
            spectra: Names::default(),
            materials: Names::default(),
            rest: Rest::default(),
            partial: false,
            keys: Vec::new(),
            around: (String::new(), String::new()),
        }
    }

    /// Reports a fault.
    pub(crate) fn fault(
        &mut self,
        place: &Place,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> Reported {
        if self.report.faults.len() >= MOST_FAULTS {
            return Reported;
        }
        self.report.fault(place.clone(), shortened(what.into()), shortened(hint.into()));
        Reported
    }

    /// Reports a fault that another place has to do with.
    pub(crate) fn fault_and(
        &mut self,
        place: &Place,
        (other, there): (&Place, &str),
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> Reported {
        let known = self.report.faults.len();
        self.fault(place, what, hint);
        if let Some(fault) = self.report.faults.get_mut(known) {
            fault.also.push((other.clone(), there.to_owned()));
        }
        Reported
    }

    /// Reports that something is missing, unless it may be in a manifest that could not be had.
    pub(crate) fn missing(
        &mut self,
        place: &Place,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> Reported {
        if self.partial { Reported } else { self.fault(place, what, hint) }
    }

    /// Whether names that were probably meant are still looked for: not after very many faults.
    pub(crate) fn suggests(&self) -> bool {
        self.report.faults.len() < MOST_FAULTS / 20
    }

    /// Reads the value of a key, or an item of a list.
    pub(crate) fn under<T>(
        &mut self,
        key: &str,
        place: &Place,
        read: impl FnOnce(&mut Self) -> Read<T>,
    ) -> Read<T> {
        if self.keys.len() >= DEEPEST {
            return Err(self.fault(place, format!("more than {DEEPEST} keys within one another"), ""));
        }
        self.keys.push(key.to_owned());
        let value = read(self);
        self.keys.pop();
        value
    }

    /// The key being read: the innermost that is no index of a list.
    pub(crate) fn key(&self) -> Option<&str> {
        self.keys.last().map(String::as_str).filter(|key| !key.starts_with(|c: char| c.is_ascii_digit()))
    }

    /// `text` as the value of the key being read: what to type.
    pub(crate) fn typed(&self, text: &str) -> String {
        let (before, after) = &self.around;
        match self.key() {
            Some(key) => format!("{key}: {before}{text}{after}"),
            None => format!("{before}{text}{after}"),
        }
    }

    /// Reads a part of a text.
    pub(crate) fn between<T>(&mut self, before: &str, after: &str, read: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::replace(&mut self.around, (before.to_owned(), after.to_owned()));
        let value = read(self);
        self.around = outer;
        value
    }

    /// Faults a value that is not there (`key:`).
    pub(crate) fn something(&mut self, node: &Node) -> Read<()> {
        if !node.is_nothing() {
            return Ok(());
        }
        let key = self.key().unwrap_or("this item").to_owned();
        let hint = if after(&node.place).trim_start_matches(':').trim_start().starts_with('#') {
            format!("`#` begins a comment: put quotes around the text, as in `{key}: \"#ff8800\"`")
        } else {
            "write a value, or leave the key out".to_owned()
        };
        Err(self.fault(&node.place, format!("`{key}` has no value"), hint))
    }
}

impl Reader<'_> {
    /// Sees to it that what a hint of the value of a key says to type is no fault itself; else it is the example of the key.
    /// `known`: how many faults there were before.
    pub(crate) fn better_hint<K: Kind>(&mut self, known: usize, example: &str) {
        if !self.suggests() {
            return;
        }
        let [fault] = self.report.faults.get(known..).unwrap_or_default() else { return };
        let Some(typed) = self.key().and_then(|key| fault.hint.strip_prefix(&format!("{key}: "))) else {
            return;
        };
        if typed.contains("}, ") {
            return; // Several keys.
        }
        let end = [" (", ", or ", ", and ", "; "].iter().filter_map(|stop| typed.find(stop)).min();
        let typed = typed.get(..end.unwrap_or(typed.len())).unwrap_or_default().to_owned();
        let mut kept = std::mem::take(self.report);
        let light_speed = self.light_speed;
        let source = Source::file(self.folder, &typed);
        let accepted =
            yaml::parse(&source, &typed, self.report).is_some_and(|node| K::read(&node, self).is_ok());
        self.light_speed = light_speed;
        if !accepted && let (Some(fault), Some(key)) = (kept.faults.get_mut(known), self.key()) {
            fault.hint = format!("{key}: {example}");
        }
        *self.report = kept;
    }
}

/// What to type instead of a name that stands for nothing: the nearest known one, or where names are given.
pub(crate) fn instead<'n>(name: &str, known: impl Iterator<Item = &'n str> + Clone, under: &str) -> String {
    if let Some(nearest) = nearest_name(name, known.clone().take(1000)) {
        return format!("did you mean `{nearest}`?");
    }
    let count = known.clone().count();
    let mut first = known.take(12).collect::<Vec<_>>().join(", ");
    if count > 12 {
        first.push_str(&format!(" and {} more", count - 12));
    }
    match count {
        0 => format!("there are none yet: name it under `{under}:`"),
        _ => format!("under `{under}:` there are {first}"),
    }
}

/// A message cut to a length that can be read.
fn shortened(message: String) -> String {
    match message.char_indices().nth(LONGEST_MESSAGE) {
        Some((end, _)) => format!("{}…", &message[..end]),
        None => message,
    }
}

/// The rest of the line after a place.
fn after(place: &Place) -> &str {
    match place {
        Place::Text { text, span, .. } => {
            text.get(span.end..).unwrap_or_default().lines().next().unwrap_or_default()
        }
        _ => "",
    }
}
