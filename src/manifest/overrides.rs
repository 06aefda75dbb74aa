//! Values given on the command line, put into the tree of a manifest before it is read.

use super::extends::{inside, item_shape};
use super::list::item;
use super::node::{Content, Entry, Node, Source};
use super::record::{Field, Presence, RecordShape, Shape};
use super::{shorthand, yaml};
use crate::error::{Place, Report};
use std::rc::Rc;
use std::sync::Arc;

const EXAMPLES: &str = "--set observer.velocity=\"0 0 0.5 c\", --set bodies.monkey.scale=2";

/// The tree with each override at its path of keys; maps that are missing on the way are made. Items of lists go by name or
/// number, `+` adds one; `~` takes away what is at the path.
///
/// `partial`: whether a part of the tree could not be had, so that a path may lead there.
pub(crate) fn apply(
    root: Rc<Node>,
    overrides: &[(String, String)],
    partial: bool,
    report: &mut Report,
) -> Option<Rc<Node>> {
    let known = report.faults.len();
    let mut root = root;
    let shape = super::shape();
    for (path, text) in overrides {
        let shown: Arc<str> = format!("--set {path}={text}").into();
        let argument = Argument { shown: shown.clone(), keys: "--set ".len(), length: path.len() };
        if text.trim().is_empty() {
            let hint = format!("--set {path}=.., or --set '{path}=~' to take it away");
            report.fault(argument.place(), format!("`{path}` has no value"), hint);
            continue;
        }
        let from = shown.len() - text.len();
        let Some(value) = parsed(&Source::Argument { text: shown, from }, text, report) else { continue };
        let keys: Vec<_> = path.split('.').collect();
        let short =
            |key: &&str| shorthand::KEYS.contains(key) && root.get(key).is_none() && !value.is_removal();
        if keys.first().is_some_and(short) {
            shorthand::make_way(Rc::make_mut(&mut root));
        }
        if let Err((what, hint)) = argument.set(Rc::make_mut(&mut root), Some(&shape), &keys, value)
            && !partial
        {
            report.fault(argument.place(), what, hint);
        }
    }
    (report.faults.len() == known).then_some(root)
}

/// The value, `~` too.
fn parsed(source: &Source, text: &str, report: &mut Report) -> Option<Rc<Node>> {
    let text_alone = text.trim();
    if matches!(text_alone, "~" | "null") {
        let content = Content::Scalar { text: text_alone.to_owned(), quoted: false };
        return Some(Node::new(source.place(0..text.len()), content).into());
    }
    yaml::parse(source, text, report)
}

/// An argument as typed, and where in it the path of keys is.
struct Argument {
    shown: Arc<str>,
    keys: usize,
    length: usize,
}

/// What is wrong, and what to type.
type Wrong = (String, String);

impl Argument {
    fn place(&self) -> Place {
        Place::Argument { text: self.shown.clone(), span: self.keys..self.keys + self.length }
    }

    fn set(
        &self,
        node: &mut Node,
        shape: Option<&Shape>,
        keys: &[&str],
        value: Rc<Node>,
    ) -> Result<(), Wrong> {
        let Some((key, rest)) = keys.split_first() else {
            *node = Rc::unwrap_or_clone(value);
            return Ok(());
        };
        if key.is_empty() {
            return Err(("the path has an empty key".to_owned(), EXAMPLES.to_owned()));
        }
        if node.is_nothing() {
            node.content = Content::Map(Vec::new());
        }
        let removal = rest.is_empty() && value.is_removal();
        match &mut node.content {
            Content::Scalar { text, .. } => {
                let what = format!("there is the text `{text}` here, which has no `{key}`");
                Err((what, self.whole(text, shape, keys).unwrap_or_else(|| EXAMPLES.to_owned())))
            }
            Content::List(items) if *key == "+" => {
                items.push(self.made(shape.and_then(item_shape).as_ref(), rest, value)?);
                Ok(())
            }
            Content::List(items) => {
                let at = item(items, key)?;
                if removal {
                    items.remove(at);
                    return Ok(());
                }
                self.set(Rc::make_mut(&mut items[at]), shape.and_then(item_shape).as_ref(), rest, value)
            }
            Content::Map(entries) => {
                let (of, others) = shape.map(|shape| inside(shape, key)).unwrap_or_default();
                if removal {
                    let before = entries.len();
                    entries.retain(|entry| entry.key != *key);
                    return if entries.len() < before { Ok(()) } else { Err(nothing(entries, key)) };
                }
                entries.retain(|entry| !others.contains(&entry.key.as_str()));
                if let Some(entry) = entries.iter_mut().find(|entry| entry.key == *key) {
                    return self.set(Rc::make_mut(&mut entry.value), of.as_ref(), rest, value);
                }
                let value = if rest.first() == Some(&"+") {
                    let list = Node::new(self.place(), Content::List(Vec::new()));
                    self.filled(list, of.as_ref(), rest, value)?
                } else {
                    self.made(of.as_ref(), rest, value)?
                };
                entries.push(Entry { key: (*key).to_owned(), key_place: self.place(), value });
                Ok(())
            }
        }
    }

    /// What to type where there is a text that stands for one key of a map, and another key of that map is meant.
    fn whole(&self, text: &str, shape: Option<&Shape>, keys: &[&str]) -> Option<String> {
        let (key, within) = keys.split_first()?;
        let record = shape.and_then(|shape| record_with(shape, key))?;
        let fields = (record.fields)();
        let stands_for = |field: &&Field| field.presence == Presence::Required || field.key == "file";
        let mut meant = fields.iter().filter(stands_for);
        let first = meant.next().filter(|first| meant.next().is_none() && first.key != *key)?;
        let path = self.shown.get(self.keys..self.keys + self.length)?;
        let above = path.strip_suffix(&keys.join("."))?.strip_suffix('.')?;
        let value = self.shown.get(self.keys + self.length + 1..)?;
        let value = within.iter().rev().fold(value.to_owned(), |value, key| format!("{{ {key}: {value} }}"));
        Some(format!("--set {above}=\"{{ {}: {text}, {key}: {value} }}\"", first.key))
    }

    fn made(&self, shape: Option<&Shape>, keys: &[&str], value: Rc<Node>) -> Result<Rc<Node>, Wrong> {
        self.filled(Node::new(self.place(), Content::Map(Vec::new())), shape, keys, value)
    }

    fn filled(
        &self,
        mut node: Node,
        shape: Option<&Shape>,
        keys: &[&str],
        value: Rc<Node>,
    ) -> Result<Rc<Node>, Wrong> {
        self.set(&mut node, shape, keys, value)?;
        Ok(node.into())
    }
}

/// The map with this key that something of a shape may be.
fn record_with(shape: &Shape, key: &str) -> Option<RecordShape> {
    match shape {
        Shape::Record(record) if (record.fields)().iter().any(|field| field.key == key) => Some(*record),
        Shape::Either(shapes) => shapes.iter().find_map(|shape| record_with(shape, key)),
        _ => None,
    }
}

/// There is nothing to be taken away.
fn nothing(entries: &[Entry], key: &str) -> Wrong {
    let keys = entries.iter().map(|entry| entry.key.as_str());
    let hint = match crate::error::nearest_name(key, keys.clone()) {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => format!("there are {}", keys.collect::<Vec<_>>().join(", ")),
    };
    (format!("there is no `{key}` to be taken away"), hint)
}
