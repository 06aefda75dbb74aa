//! YAML text as a tree in which every value knows where it stands.
//!
//! Two readers look at the text: `saphyr-parser`, whose events carry their places and make the tree, and
//! `serde_yaml`, which must agree that it is YAML at all. Scalars stay text as written: what `0.9 0 0 c` or
//! `on` means is for those who read the tree. Refused: tags, merge keys, keys that are not text, repeated
//! keys, several documents, and whatever is too large or too deep (aliases count as what they stand for).

use super::node::{Content, Entry, Node, Source};
use super::reader::MOST_FAULTS;
use crate::error::{Place, Report};
use saphyr_parser::{Event, Parser, ScalarStyle, Span, StrInput};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

/// Values of a text at which a second reader looks.
const MANY_VALUES: usize = 60_000;
/// Lists and maps within one another.
const DEEPEST: usize = 64;
/// Bytes of one text.
const LONGEST_TEXT: usize = 10_000;
/// Values in all (keys are values too), each alias counted as what it stands for: the second reader writes them out.
pub(super) const MOST_VALUES: usize = 250_000;

/// The tree of a YAML text, or none with the reasons reported.
pub(crate) fn parse(source: &Source, text: &str, report: &mut Report) -> Option<Rc<Node>> {
    // Offsets count from the start of the file, a byte order mark included.
    let bare = text.strip_prefix('\u{feff}').unwrap_or(text);
    let known = report.faults.len();
    let root = Builder::new(source, text, bare, report).build(Parser::new_from_str(bare))?;
    // The second reader keeps all events at once: of very many values that takes more memory than all else.
    let second = report.faults.len() == known && root.values <= MANY_VALUES;
    if second && let Err(error) = serde_yaml::from_str::<serde::de::IgnoredAny>(bare) {
        let at = error.location().map_or(0, |location| location.index()) + (text.len() - bare.len());
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or_default();
        let hint = "look at the indentation, and at quotes and brackets left open";
        report.fault(source.place(clamp(text, at..at)), format!("this is not YAML: {what}"), hint);
        return None;
    }
    Some(root)
}

/// A span within the text and on character boundaries.
fn clamp(text: &str, span: Range<usize>) -> Range<usize> {
    let mut start = span.start.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = span.end.clamp(start, text.len());
    while !text.is_char_boundary(end) {
        end += 1;
    }
    start..end
}

/// A list or map whose end has not come yet.
enum Open {
    List { start: usize, anchor: usize, items: Vec<Rc<Node>> },
    Map { start: usize, anchor: usize, entries: Vec<Entry>, keys: BTreeSet<String>, key: Option<Key> },
}

/// A key that waits for its value; `text` is none when the key was refused.
struct Key {
    text: Option<String>,
    span: Range<usize>,
}

/// Where a key of the innermost map is written first.
fn first_key(open: &[Open], key: &str) -> Option<Place> {
    match open.last() {
        Some(Open::Map { entries, .. }) => {
            entries.iter().find(|entry| entry.key == key).map(|entry| entry.key_place.clone())
        }
        _ => None,
    }
}

/// Reading cannot go on; the reason is reported.
struct Stopped;

struct Builder<'a> {
    source: &'a Source,
    text: &'a str,
    /// Byte offsets of the characters, for text that is not ASCII.
    offsets: Option<Vec<u32>>,
    /// Bytes before the first character that the parser sees.
    skipped: usize,
    report: &'a mut Report,
    open: Vec<Open>,
    anchors: BTreeMap<usize, Rc<Node>>,
    values: usize,
    root: Option<Rc<Node>>,
}

impl<'a> Builder<'a> {
    fn new(source: &'a Source, text: &'a str, bare: &str, report: &'a mut Report) -> Self {
        let offsets = (!bare.is_ascii()).then(|| bare.char_indices().map(|(at, _)| at as u32).collect());
        let skipped = text.len() - bare.len();
        let (open, anchors) = (Vec::new(), BTreeMap::new());
        Self { source, text, offsets, skipped, report, open, anchors, values: 0, root: None }
    }

    fn build(&mut self, mut parser: Parser<'_, StrInput<'_>>) -> Option<Rc<Node>> {
        let mut documents = 0;
        while let Some(event) = parser.next_event() {
            let (event, span) = match event {
                Ok(event) => event,
                Err(error) => {
                    self.not_yaml(error.info(), error.marker().index());
                    return None;
                }
            };
            documents += usize::from(matches!(event, Event::DocumentStart(_)));
            let span = self.bytes(span);
            if documents > 1 {
                self.fault(
                    span,
                    "a second document begins here",
                    "a manifest is one document: remove the `---`",
                );
                return None;
            }
            if self.event(event, span).is_err() {
                return None;
            }
        }
        if self.root.as_ref().is_none_or(|root| root.is_nothing()) {
            self.fault(
                0..0,
                "the file is empty",
                "manifests/flyby.yaml of the examples is one to begin with",
            );
            return None;
        }
        self.root.take()
    }

    fn event(&mut self, event: Event<'_>, span: Range<usize>) -> Result<(), Stopped> {
        let start = span.start;
        match event {
            Event::Scalar(text, style, anchor, tag) => {
                self.refuse_tag(tag.is_some(), &span);
                let quoted = style != ScalarStyle::Plain;
                self.value(Content::Scalar { text: text.into_owned(), quoted }, span, anchor)
            }
            Event::SequenceStart(anchor, tag) => {
                self.refuse_tag(tag.is_some(), &span);
                self.begin(Open::List { start, anchor, items: Vec::new() }, span)
            }
            Event::MappingStart(anchor, tag) => {
                self.refuse_tag(tag.is_some(), &span);
                self.begin(
                    Open::Map { start, anchor, entries: Vec::new(), keys: BTreeSet::new(), key: None },
                    span,
                )
            }
            Event::SequenceEnd | Event::MappingEnd => match self.open.pop() {
                Some(Open::List { start, anchor, mut items }) => {
                    items.shrink_to_fit();
                    self.value(Content::List(items), start..span.end, anchor)
                }
                Some(Open::Map { start, anchor, mut entries, .. }) => {
                    entries.shrink_to_fit();
                    self.value(Content::Map(entries), start..span.end, anchor)
                }
                None => Ok(()),
            },
            Event::Alias(anchor) => match self.anchors.get(&anchor).cloned() {
                Some(node) => self.place(node, span),
                None => Err(self.stop(
                    span,
                    "this alias stands for something that contains it",
                    "write it out instead",
                )),
            },
            _ => Ok(()),
        }
    }

    fn begin(&mut self, open: Open, span: Range<usize>) -> Result<(), Stopped> {
        if self.open.len() >= DEEPEST {
            self.too_deep(span);
            return Err(Stopped);
        }
        self.open.push(open);
        Ok(())
    }

    /// A value is complete.
    fn value(&mut self, content: Content, span: Range<usize>, anchor: usize) -> Result<(), Stopped> {
        if matches!(&content, Content::Scalar { text, .. } if text.len() > LONGEST_TEXT) {
            let what = format!("a text longer than {LONGEST_TEXT} bytes");
            return Err(self.stop(span, &what, "look for a quote that is left open"));
        }
        self.values += 1;
        let span = self.trim(&content, span);
        let node = Rc::new(Node::new(self.source.place(span.clone()), content));
        if anchor != 0 {
            self.anchors.insert(anchor, node.clone());
        }
        self.place(node, span)
    }

    /// Puts a value where it belongs: into the innermost list or map, as its item, key or value.
    fn place(&mut self, node: Rc<Node>, span: Range<usize>) -> Result<(), Stopped> {
        if node.values.max(self.values) > MOST_VALUES {
            let what = format!("more than {MOST_VALUES} values, aliases counted as what they stand for");
            return Err(self.stop(span, &what, "long tables belong in a CSV file"));
        }
        if node.depth + self.open.len() > DEEPEST + 1 {
            self.too_deep(span);
            return Err(Stopped);
        }
        match self.open.last_mut() {
            None => self.root = Some(node),
            Some(Open::List { items, .. }) => items.push(node),
            Some(Open::Map { entries, key, .. }) => match key.take() {
                Some(Key { text: Some(text), span }) => {
                    let key_place = self.source.place(span);
                    let value = if node.is_nothing() {
                        Node::new(key_place.clone(), node.content.clone()).into()
                    } else {
                        node
                    };
                    entries.push(Entry { key: text, key_place, value });
                }
                Some(Key { text: None, .. }) => {}
                None => self.key(&node, span),
            },
        }
        Ok(())
    }

    fn key(&mut self, node: &Node, span: Range<usize>) {
        let text = match &node.content {
            Content::Scalar { text, quoted } if text == "<<" && !quoted => {
                self.fault(span.clone(), "merge keys (`<<`) are not used here", "write the keys out");
                None
            }
            Content::Scalar { text, .. } => {
                let repeated = match self.open.last_mut() {
                    Some(Open::Map { keys, .. }) => !keys.insert(text.clone()),
                    _ => false,
                };
                if repeated {
                    let what = format!("`{text}` is written twice");
                    let known = self.report.faults.len();
                    self.fault(span.clone(), &what, "remove one of the two, or make a list");
                    if let Some(fault) = self.report.faults.get_mut(known)
                        && let Some(first) = first_key(&self.open, text)
                    {
                        fault.also.push((first, "the first".to_owned()));
                    }
                }
                (!repeated).then(|| text.clone())
            }
            _ => {
                self.fault(
                    span.clone(),
                    &format!("{} cannot be a key", node.describe()),
                    "a key is text, as in `at: ..`",
                );
                None
            }
        };
        if let Some(Open::Map { key, .. }) = self.open.last_mut() {
            *key = Some(Key { text, span });
        }
    }

    fn refuse_tag(&mut self, tagged: bool, span: &Range<usize>) {
        if tagged {
            self.fault(
                span.clone(),
                "tags (`!..`) are not used here",
                "remove it; text that begins with ! needs quotes",
            );
        }
    }

    fn not_yaml(&mut self, info: &str, index: usize) {
        let at = self.byte(index);
        if info.contains("recursion limit") {
            return self.too_deep(at..at);
        }
        let line = self.text[..at].rsplit('\n').next().unwrap_or_default().len();
        let line = self.text[at - line..].lines().next().unwrap_or_default();
        let hint = if line.starts_with(|c: char| c.is_whitespace())
            && line.trim_start_matches(' ').starts_with('\t')
        {
            "YAML indents with spaces: replace the tab"
        } else if line.contains("] ") {
            "vectors are written without brackets, as in `at: 0 2 -9.5 m`"
        } else if info.contains("anchor") {
            "`*name` repeats a value above it that is marked `&name`; text that begins with * needs quotes"
        } else if line.contains(": ") {
            "look at the indentation, and at quotes and brackets left open; text with `: ` in it needs quotes"
        } else {
            "look at the indentation, and at quotes and brackets left open"
        };
        self.fault(at..at, &format!("this is not YAML: {info}"), hint);
    }

    fn too_deep(&mut self, span: Range<usize>) {
        let what = format!("lists and maps within one another more than {DEEPEST} deep");
        self.fault(span, &what, "a manifest needs no more than ten");
    }

    fn stop(&mut self, span: Range<usize>, what: &str, hint: &str) -> Stopped {
        self.fault(span, what, hint);
        Stopped
    }

    fn fault(&mut self, span: Range<usize>, what: &str, hint: &str) {
        if self.report.faults.len() >= MOST_FAULTS {
            return;
        }
        self.report.fault(self.source.place(clamp(self.text, span)), what, hint);
    }

    /// Byte offset of a character.
    fn byte(&self, index: usize) -> usize {
        let within = match &self.offsets {
            None => index,
            Some(offsets) => offsets.get(index).map_or(self.text.len(), |at| *at as usize),
        };
        clamp(self.text, within + self.skipped..self.text.len()).start
    }

    fn bytes(&self, span: Span) -> Range<usize> {
        let start = self.byte(span.start.index());
        start..self.byte(span.end.index()).max(start)
    }

    /// Without the anchor before a value and the blanks and comments after it.
    fn trim(&self, content: &Content, span: Range<usize>) -> Range<usize> {
        let mut span = clamp(self.text, span);
        let written = &self.text[span.clone()];
        if written.starts_with('&')
            && let Some(gap) = written.find(char::is_whitespace)
        {
            span.start += gap + written[gap..].len() - written[gap..].trim_start().len();
        }
        let last = match content {
            Content::Scalar { .. } => None,
            Content::List(items) => items.last().map(|node| &node.place),
            Content::Map(entries) => entries.last().map(|entry| &entry.value.place),
        };
        // The parser sees the end of a block only at the next token: its last value ends earlier.
        let closed = self.text[..span.end].trim_end().ends_with([']', '}']);
        if let (false, Some(Place::Text { span: inner, .. })) = (closed, last)
            && inner.end > span.start
        {
            span.end = inner.end.min(span.end);
        }
        let kept = self.text[span.clone()].trim_end().len();
        span.start..span.start + kept
    }
}
