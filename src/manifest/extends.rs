//! Manifests that begin from others: `extends`. What they say is merged before anything of it is read.
//!
//! A value keeps its place in its own file, so that faults are shown there and paths are relative to there. Maps are
//! merged key by key, everything else takes the place of what was there; `key: ~` takes a key away; one of several
//! alternatives (`orbit`, `rocket`) takes the others away. `bodies` and `lights` may be maps that change items of the list.

use super::list::item;
use super::node::{Content, Entry, Node, Source};
use super::plain::{FilePath, neighbour, tidy};
use super::reader::{Read, Reader};
use super::record::{Field, Kind, Record, Shape};
use super::table::read_text;
use super::{Manifest, shorthand, yaml};
use crate::error::{Fault, Place, Report};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Manifests one above the other.
const DEEPEST: usize = 16;
/// Manifests in all.
const MOST_FILES: usize = 64;
/// Lists whose items may be changed by a map of them.
pub(super) const LISTS: [&str; 2] = ["bodies", "lights"];

/// The tree of a manifest with those that it extends below it, and whether one of them, with a fault, could not be had. Their files,
/// in the order in which they are read, are added to `read`.
pub(super) fn resolve(
    root: Rc<Node>,
    path: &Path,
    read: &mut Vec<PathBuf>,
    report: &mut Report,
) -> (Rc<Node>, bool) {
    let mut bases = Bases { open: vec![path.to_owned()], read, values: 0, partial: false, report };
    let root = bases.resolve(root);
    (root, bases.partial)
}

/// The manifests that one extends. They are put below it before it is read: here they come too late.
pub(crate) struct Extends;

impl Kind for Extends {
    type Value = Vec<PathBuf>;
    fn shape() -> Shape {
        Shape::Either(vec![FilePath::shape(), Shape::List(FilePath::shape)])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        let what = "what a manifest extends is said in the manifest";
        Err(reader.fault(&node.place, what, "write `extends: ..` into it"))
    }
}

struct Bases<'r> {
    /// The manifests that are being read, the outermost first.
    open: Vec<PathBuf>,
    read: &'r mut Vec<PathBuf>,
    values: usize,
    /// Whether one could not be had.
    partial: bool,
    report: &'r mut Report,
}

impl Bases<'_> {
    fn resolve(&mut self, mut root: Rc<Node>) -> Rc<Node> {
        let Content::Map(entries) = &root.content else { return root };
        let Some(at) = entries.iter().position(|entry| entry.key == "extends") else { return root };
        let named = entries[at].value.clone();
        self.values += root.values;
        if let Content::Map(entries) = &mut Rc::make_mut(&mut root).content {
            entries.remove(at);
        }
        let names: &[Rc<Node>] = match &named.content {
            Content::List(items) => items,
            _ => std::slice::from_ref(&named),
        };
        let all: Vec<_> = names.iter().filter_map(|name| self.base(name)).collect();
        self.partial |= all.len() < names.len();
        let shape = super::shape();
        let over_all = |mut under: Rc<Node>, over: &Rc<Node>| {
            if shorthand::KEYS.iter().any(|key| over.get(key).is_some_and(|value| !value.is_removal())) {
                shorthand::make_way(Rc::make_mut(&mut under));
            }
            let mut merge = Merge { report: self.report };
            merge.node("", &under, over, Some(&shape))
        };
        match all.split_first() {
            Some((first, more)) => more.iter().chain([&root]).fold(first.clone(), over_all),
            None => root,
        }
    }

    /// The tree of a manifest that another one names.
    fn base(&mut self, name: &Node) -> Option<Rc<Node>> {
        let Some(text) = name.text().filter(|text| !text.trim().is_empty() && !name.is_nothing()) else {
            let what = format!(
                "`extends` is the path of a manifest, or a list of those; this is {}",
                name.describe()
            );
            return self.fault(name, what, "extends: studio.yaml");
        };
        let folder = self.open.last().and_then(|path| path.parent()).unwrap_or(Path::new(""));
        let path = tidy(&folder.join(text));
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if let Some(at) = self.open.iter().position(|open| real(open) == real(&path)) {
            let circle: Vec<_> = self.open[at..].iter().chain([&path]).map(|path| short(path)).collect();
            let what = format!("the manifest `{}` extends itself: {}", short(&path), circle.join(" -> "));
            return self.fault(name, what, "break the circle: remove one of these `extends`");
        }
        if self.open.len() > DEEPEST || self.read.len() > MOST_FILES {
            let what =
                format!("manifests that extend one another, more than {DEEPEST} deep or {MOST_FILES} in all");
            return self.fault(name, what, "write some of them as one");
        }
        self.report.inputs.depend(&path);
        let text = match read_text(&path) {
            Ok(text) => text,
            Err(why) => {
                let what = format!("the manifest `{}`: {why}", path.display());
                return self.fault(name, what, neighbour(&path));
            }
        };
        self.read.push(path.clone());
        let source = Source::file(&path, &text);
        let root = yaml::parse(&source, &text, self.report)?;
        if !matches!(root.content, Content::Map(_)) {
            return self.fault(
                &root,
                format!("a manifest is a map of keys; this is {}", root.describe()),
                "light_speed: 1 m/s",
            );
        }
        if root.values + self.values > yaml::MOST_VALUES {
            let what = format!("more than {} values in all of these manifests", yaml::MOST_VALUES);
            return self.fault(name, what, "long tables belong in a CSV file");
        }
        self.open.push(path);
        let resolved = self.resolve(root);
        self.open.pop();
        Some(resolved)
    }

    fn fault<T>(&mut self, node: &Node, what: impl Into<String>, hint: impl Into<String>) -> Option<T> {
        self.report.fault(node.place.clone(), what, hint);
        None
    }
}

/// A path's last part.
fn short(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

struct Merge<'r> {
    report: &'r mut Report,
}

impl Merge<'_> {
    /// What two say of one thing of a shape, the second above the first.
    fn node(&mut self, key: &str, under: &Rc<Node>, over: &Rc<Node>, shape: Option<&Shape>) -> Rc<Node> {
        match (&under.content, &over.content) {
            (Content::Map(below), Content::Map(above)) => {
                let mut entries = below.clone();
                if key == "exposures" {
                    make_way_for_times(&mut entries, above);
                }
                above.iter().for_each(|entry| self.entry(&mut entries, above, entry, shape));
                Node::new(over.place.clone(), Content::Map(entries)).into()
            }
            (Content::List(below), Content::Map(above)) if LISTS.contains(&key) => {
                let mut items: Vec<_> = below.iter().cloned().map(Some).collect();
                let of = shape.and_then(item_shape);
                let mut more = Vec::new();
                let mut changed: Vec<Option<&Entry>> = vec![None; below.len()];
                for entry in above {
                    let Some(at) = self.item(&mut items, below, entry, (key, of.as_ref()), &mut more) else {
                        continue;
                    };
                    if let Some(first) = changed[at].replace(entry) {
                        self.changed_twice(key, first, entry);
                    }
                }
                let items = items.into_iter().flatten().chain(more).collect();
                Node::new(over.place.clone(), Content::List(items)).into()
            }
            _ => over.clone(),
        }
    }

    fn entry(&mut self, entries: &mut Vec<Entry>, above: &[Entry], over: &Entry, shape: Option<&Shape>) {
        let (of, others) = shape.map(|shape| inside(shape, &over.key)).unwrap_or_default();
        entries.retain(|entry| {
            !others.contains(&entry.key.as_str()) || above.iter().any(|given| given.key == entry.key)
        });
        let Some(at) = entries.iter().position(|entry| entry.key == over.key) else {
            return entries.push(over.clone());
        };
        if over.value.is_removal() {
            entries.remove(at);
        } else {
            let value = self.node(&over.key, &entries[at].value, &over.value, of.as_ref());
            entries[at] = Entry { value, ..over.clone() };
        }
    }

    /// An item that is changed under its name and under its number.
    fn changed_twice(&mut self, key: &str, first: &Entry, second: &Entry) {
        let what = format!("`{key}`: `{}` and `{}` are the same item", first.key, second.key);
        let hint = format!("write all that changes under `{}`", first.key);
        let fault = Fault::new(second.key_place.clone(), what, hint);
        self.report.faults.push(fault.and(first.key_place.clone(), "changed here already"));
    }

    /// A change of one item of a list, which one; `+` adds items to it.
    fn item(
        &mut self,
        items: &mut [Option<Rc<Node>>],
        below: &[Rc<Node>],
        over: &Entry,
        (key, of): (&str, Option<&Shape>),
        more: &mut Vec<Rc<Node>>,
    ) -> Option<usize> {
        if over.key == "+" {
            match &over.value.content {
                Content::List(added) => more.extend(added.iter().cloned()),
                _ => more.push(over.value.clone()),
            }
            return None;
        }
        match item(below, &over.key) {
            Ok(at) => {
                let removed = over.value.is_removal();
                items[at] = (!removed).then(|| self.node("", &below[at], &over.value, of));
                Some(at)
            }
            Err((what, hint)) => {
                self.report.fault(over.key_place.clone(), format!("`{key}`: {what}"), hint);
                None
            }
        }
    }
}

/// Exposures are `at` a time, or `count` of them `from` one `to` another: what is said above takes the place of the other.
fn make_way_for_times(below: &mut Vec<Entry>, above: &[Entry]) {
    let says = |entries: &[Entry], keys: &[&str]| {
        entries.iter().any(|entry| keys.contains(&entry.key.as_str()) && !entry.value.is_removal())
    };
    if says(above, &["at"]) && says(below, &["from", "to"]) {
        below.retain(|entry| !["from", "to", "count"].contains(&entry.key.as_str()));
    } else if says(above, &["from", "to"]) {
        below.retain(|entry| entry.key != "at");
    }
}

/// What a key's value looks like in something of a shape, and the keys of which it is an alternative.
pub(super) fn inside(shape: &Shape, key: &str) -> (Option<Shape>, Vec<&'static str>) {
    match shape {
        Shape::Map(of) => (Some(of()), Vec::new()),
        Shape::Record(record) => {
            let fields = (record.fields)();
            let Some(field) = fields.iter().find(|field| field.key == key) else { return (None, Vec::new()) };
            let alternative =
                |other: &&Field| !field.group.is_empty() && other.group == field.group && other.key != key;
            let others = fields.iter().filter(alternative).map(|other| other.key).collect();
            (Some((field.shape)()), others)
        }
        Shape::Either(shapes) => {
            shapes.iter().map(|shape| inside(shape, key)).find(|(of, _)| of.is_some()).unwrap_or_default()
        }
        _ => (None, Vec::new()),
    }
}

/// What an item looks like.
pub(super) fn item_shape(shape: &Shape) -> Option<Shape> {
    match shape {
        Shape::List(of) => Some(of()),
        Shape::Either(shapes) => shapes.iter().find_map(item_shape),
        _ => None,
    }
}

/// Where a manifest stands among itself and those that it extends.
pub(super) fn order(files: &[PathBuf], place: &Place) -> (usize, usize) {
    match place {
        Place::Text { path, span, .. } => {
            let file = files.iter().position(|file| **file == **path);
            file.map_or((usize::MAX, 0), |file| (file, span.start))
        }
        _ => (usize::MAX, 0),
    }
}

/// Warns of an output that is another manifest's.
pub(super) fn warn_of_output(root: &Node, path: &Path, report: &mut Report) {
    let Some(output) = root.get("output") else { return };
    let folder = output.get("folder").unwrap_or(output);
    let Place::Text { path: of, .. } = &folder.place else { return };
    if **of != *path {
        let stem = path.file_stem().map_or_else(|| "film".into(), |stem| stem.to_string_lossy());
        let what = format!("the pictures go where those of `{}` go", short(of));
        report.warn(
            folder.place.clone(),
            what,
            format!("in `{}`, write `output: ../out/{stem}`", short(path)),
        );
    }
}

/// The keys of which one at least says who looks.
pub(super) const LOOKING: [&str; 3] = ["observer", "turntable", "flyby"];

/// Whether there is no observer, nor a key that was meant to be one.
pub(super) fn nobody_looks(root: &Node) -> bool {
    let Content::Map(entries) = &root.content else { return false };
    if entries.iter().any(|entry| LOOKING.contains(&entry.key.as_str())) {
        return false;
    }
    let fields = Manifest::fields();
    let keys = || fields.iter().map(|field| field.key);
    let unknown = entries.iter().filter(|entry| keys().all(|key| key != entry.key)).take(100);
    let mut meant = unknown.filter_map(|entry| crate::error::nearest_name(&entry.key, keys()));
    !meant.any(|key| LOOKING.contains(&key))
}
