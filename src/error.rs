//! Faults, warnings and the two kinds of error: what the user wrote, and what the machine refused.
//!
//! Nothing here prints. A stage that reads input gathers every [`Fault`] it finds in a [`Report`] and
//! goes on as long as it can, so that a user sees all of them at once.

use crate::inputs::Inputs;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a fault stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// A stretch of a text file: the bytes `span` of `text`.
    Text {
        /// The file, as the user named it.
        path: Arc<Path>,
        /// The whole text of the file.
        text: Arc<str>,
        /// The stretch of `text`, in bytes.
        span: Range<usize>,
    },
    /// An element of a model file, such as `nodes[3].mesh` or `line 17`.
    Element {
        /// The file.
        path: PathBuf,
        /// The element in the file's own terms.
        element: String,
    },
    /// A file as a whole.
    File {
        /// The file.
        path: PathBuf,
    },
    /// A stretch of an argument of the command.
    Argument {
        /// The argument as typed.
        text: Arc<str>,
        /// The stretch of `text`, in bytes.
        span: Range<usize>,
    },
    /// The command line or nothing in particular.
    Command,
}

impl Place {
    /// A whole file.
    pub fn file(path: impl Into<PathBuf>) -> Self {
        Self::File { path: path.into() }
    }

    /// An element of a file, in the file's own terms.
    pub fn element(path: impl Into<PathBuf>, element: impl Into<String>) -> Self {
        Self::Element { path: path.into(), element: element.into() }
    }

    /// Line and column, both counted from one, of the start of a stretch of text.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let Self::Text { text, span, .. } = self else { return None };
        let before = text.get(..span.start)?;
        let before = before.strip_prefix('\u{feff}').unwrap_or(before);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Some((line, column))
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text { path, .. } => {
                let (line, column) = self.line_column().unwrap_or((1, 1));
                write!(f, "{}:{line}:{column}", path.display())
            }
            Self::Element { path, element } => write!(f, "{}: {element}", path.display()),
            Self::File { path } => write!(f, "{}", path.display()),
            Self::Argument { text, .. } => f.write_str(text),
            Self::Command => write!(f, "terrell"),
        }
    }
}

/// One thing wrong with an input: where, what, and what to type instead.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Where it stands.
    pub place: Place,
    /// What is wrong, one line, without a full stop.
    pub what: String,
    /// What to do about it, one line; empty when there is nothing to say.
    pub hint: String,
    /// Other places that have to do with it, each with what is there.
    pub also: Vec<(Place, String)>,
}

impl Fault {
    /// A fault with a hint (which may be empty).
    pub fn new(place: Place, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { place, what: what.into(), hint: hint.into(), also: Vec::new() }
    }

    /// With another place that has to do with it.
    #[must_use]
    pub fn and(mut self, place: Place, what: impl Into<String>) -> Self {
        self.also.push((place, what.into()));
        self
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.what)?;
        for (place, what) in &self.also {
            write!(f, "\n  {place}: {what}")?;
        }
        if !self.hint.is_empty() {
            write!(f, "\n  help: {}", self.hint)?;
        }
        Ok(())
    }
}

/// What a stage found while reading: faults stop the work, warnings do not.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Faults in the order found.
    pub faults: Vec<Fault>,
    /// Warnings in the order found.
    pub warnings: Vec<Fault>,
    /// What was read.
    pub inputs: Inputs,
}

impl Report {
    /// Adds a fault.
    pub fn fault(&mut self, place: Place, what: impl Into<String>, hint: impl Into<String>) {
        self.faults.push(Fault::new(place, what, hint));
    }

    /// Adds a warning.
    pub fn warn(&mut self, place: Place, what: impl Into<String>, hint: impl Into<String>) {
        self.warnings.push(Fault::new(place, what, hint));
    }

    /// `value` if no fault was found, otherwise all of the faults.
    pub fn finish<T>(self, value: Option<T>) -> Result<T, Error> {
        match value {
            Some(value) if self.faults.is_empty() => Ok(value),
            _ => Err(Error::Input(self.faults)),
        }
    }
}

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Error {
    /// What the user wrote is at fault (exit code 2).
    Input(Vec<Fault>),
    /// The machine refused: disk full, no permission (exit code 1).
    Machine {
        /// The file or device.
        path: PathBuf,
        /// What was being done.
        doing: String,
        /// What the machine said.
        source: std::io::Error,
    },
    /// The user stopped it (exit code 130, as shells have it for Ctrl-C).
    Stopped {
        /// What is there, and how to go on.
        there: String,
    },
}

impl Error {
    /// A single fault.
    pub fn fault(place: Place, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Input(vec![Fault::new(place, what, hint)])
    }

    /// The machine refused something.
    pub fn machine(path: &Path, doing: impl Into<String>, source: std::io::Error) -> Self {
        Self::Machine { path: path.to_owned(), doing: doing.into(), source }
    }

    /// The process's exit code.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Machine { .. } => 1,
            Self::Stopped { .. } => 130,
        }
    }
}

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        Self::Input(vec![fault])
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(faults) => {
                for (i, fault) in faults.iter().enumerate() {
                    if i > 0 {
                        writeln!(f)?;
                    }
                    write!(f, "{fault}")?;
                }
                Ok(())
            }
            Self::Machine { path, doing, source } => write!(f, "{}: {doing}: {source}", path.display()),
            Self::Stopped { there } => write!(f, "stopped: {there}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Machine { source, .. } => Some(source),
            Self::Input(_) | Self::Stopped { .. } => None,
        }
    }
}

/// The name in `known` nearest to `written`, if one is near enough to be what was meant.
pub fn nearest_name<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Longer ones are no slips of the finger, and their distances cost memory.
    let short = |name: &str| name.len() <= 64;
    known
        .into_iter()
        .filter(|name| short(name) && short(written))
        .map(|name| (strsim::damerau_levenshtein(&written.to_lowercase(), &name.to_lowercase()), name))
        .filter(|(distance, name)| *distance <= (name.len().max(written.len()) / 3).max(1))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// Names, those first that are the most like what is written.
pub fn by_nearness<'a>(written: &str, known: &[&'a str]) -> Vec<&'a str> {
    let mut names = known.to_vec();
    // Longer ones are no slips of the finger, and their distances cost memory.
    let distance = |name: &&str| match name.len().max(written.len()) {
        0..=64 => strsim::damerau_levenshtein(&written.to_lowercase(), &name.to_lowercase()),
        longer => longer,
    };
    names.sort_by_cached_key(distance);
    names
}

/// So many of something, as it is said.
pub(crate) fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

/// The lines of a table that say something, without blanks around them, and at which byte of the text each begins: no
/// empty ones, no comments (`#`), and no mark of byte order.
pub(crate) fn table_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut end = 0;
    text.split_inclusive('\n').filter_map(move |line| {
        let begins = line.trim_start_matches('\u{feff}').trim_start();
        let start = end + (line.len() - begins.len());
        end += line.len();
        let kept = begins.trim_end();
        (!kept.is_empty() && !kept.starts_with('#')).then_some((start, kept))
    })
}
