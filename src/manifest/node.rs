//! The tree of a YAML text, in which every value knows where it stands.

use crate::error::Place;
use std::ops::Range;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

/// A value and where it is written.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) place: Place,
    pub(crate) content: Content,
    /// Values in it, itself included, with aliases expanded; every 64 bytes of text count as one more.
    pub(super) values: usize,
    /// Levels in it; 1 for text.
    pub(super) depth: usize,
}

/// What a value is.
#[derive(Debug, Clone)]
pub(crate) enum Content {
    /// Text as written; quoted or not decides only whether it can mean nothing at all (`~`).
    Scalar { text: String, quoted: bool },
    /// Items in order.
    List(Vec<Rc<Node>>),
    /// Entries in order, no key twice.
    Map(Vec<Entry>),
}

/// A key and its value.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_place: Place,
    pub(crate) value: Rc<Node>,
}

impl Node {
    pub(crate) fn new(place: Place, content: Content) -> Self {
        let (values, depth) = match &content {
            Content::Scalar { text, .. } => (text.len() / 64, 0),
            Content::List(items) => measure(items.iter()),
            Content::Map(entries) => measure(entries.iter().map(|entry| &entry.value)),
        };
        Self { place, content, values: values.saturating_add(1), depth: depth + 1 }
    }

    /// Whether there is nothing written: `key:`, `~` or `null`.
    pub(crate) fn is_nothing(&self) -> bool {
        matches!(&self.content, Content::Scalar { text, quoted: false } if matches!(text.as_str(), "" | "~" | "null"))
    }

    /// Whether it is written that there is nothing: `~` or `null`.
    pub(crate) fn is_removal(&self) -> bool {
        self.is_nothing() && self.text() != Some("")
    }

    /// The text, if it is text.
    pub(crate) fn text(&self) -> Option<&str> {
        match &self.content {
            Content::Scalar { text, .. } => Some(text),
            _ => None,
        }
    }

    /// The value of a key, if it is a map that has it.
    pub(crate) fn get(&self, key: &str) -> Option<&Rc<Self>> {
        match &self.content {
            Content::Map(entries) => entries.iter().find(|entry| entry.key == key).map(|entry| &entry.value),
            _ => None,
        }
    }

    /// "text", "a list" or "a map".
    pub(crate) fn describe(&self) -> &'static str {
        match &self.content {
            Content::Scalar { .. } if self.is_nothing() => "empty",
            Content::Scalar { .. } => "text",
            Content::List(_) => "a list",
            Content::Map(_) => "a map",
        }
    }
}

fn measure<'a>(children: impl Iterator<Item = &'a Rc<Node>>) -> (usize, usize) {
    children
        .fold((0, 0), |(values, depth), child| (child.values.saturating_add(values), child.depth.max(depth)))
}

/// Where places in a text belong.
#[derive(Debug, Clone)]
pub(crate) enum Source {
    /// A file.
    File { path: Arc<Path>, text: Arc<str> },
    /// An argument of the command as it was typed, from this byte on.
    Argument { text: Arc<str>, from: usize },
}

impl Source {
    pub(super) fn place(&self, span: Range<usize>) -> Place {
        match self {
            Self::File { path, text } => Place::Text { path: path.clone(), text: text.clone(), span },
            Self::Argument { text, from } => {
                Place::Argument { text: text.clone(), span: span.start + from..span.end + from }
            }
        }
    }

    pub(super) fn file(path: &Path, text: &str) -> Self {
        Self::File { path: path.into(), text: text.into() }
    }
}
