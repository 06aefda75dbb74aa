//! The reference of the manifest, written from the same lists that read it.

use super::record::{Field, Presence, RecordShape, Shape};
use super::shape;
use std::collections::{BTreeSet, VecDeque};

/// All records and their keys as Markdown.
pub fn reference() -> String {
    let mut text = String::from(PREFACE);
    let mut seen = BTreeSet::new();
    let mut waiting: VecDeque<RecordShape> = records(&shape()).into();
    while let Some(record) = waiting.pop_front() {
        if !seen.insert(record.title) {
            continue;
        }
        text += &section(&record);
        for field in (record.fields)() {
            waiting.extend(records(&(field.shape)()));
        }
    }
    text
}

/// What a key means, in one sentence; its path from the outermost, without the places of lists.
pub fn meaning(path: &[&str]) -> String {
    let mut shape = shape();
    let mut doc = "";
    for key in path {
        let Some(field) = field(&shape, key) else { return String::new() };
        doc = field.doc;
        shape = (field.shape)();
    }
    let text = doc.split_whitespace().collect::<Vec<_>>().join(" ");
    let end = text.find(". ").map_or(text.len(), |end| end + 1);
    text.get(..end).unwrap_or_default().to_owned()
}

fn field(shape: &Shape, key: &str) -> Option<Field> {
    match shape {
        Shape::Record(record) => (record.fields)().into_iter().find(|field| field.key == key),
        Shape::List(of) | Shape::Map(of) => field(&of(), key),
        Shape::Either(shapes) => shapes.iter().find_map(|shape| field(shape, key)),
        Shape::Text(_) | Shape::Number(_) | Shape::Words(_) => None,
    }
}

const PREFACE: &str = "\
# What a manifest may say

Written from the program's own lists by `TERRELL_UPDATE=1 cargo test --release reference`; do not edit.

A number with a dimension carries its unit: `0.8 c`, `90 deg`, `5778 K`, `589 nm`, `12 ns`, `3 m`, `0 2 -9.5 m`. Places and velocities are the
lab's; `rotation`, `scale` and directions are in the rest frame of what they belong to, whose axes are the pure boost of the lab's. Paths are relative to the
manifest's folder. Keys marked * have to be there; of those marked + exactly one (or none, where the record has a default).
";

fn section(record: &RecordShape) -> String {
    let mut text = format!(
        "\n## {}\n\n{}\n\n| key | value | example |\n| --- | --- | --- |\n",
        record.title,
        record.doc.trim()
    );
    for field in (record.fields)() {
        let mark = match field.presence {
            Presence::Required => " *",
            Presence::Alternative => " +",
            Presence::Optional => "",
        };
        let doc = field.doc.trim().replace('\n', " ").replace('|', "\\|");
        text += &format!(
            "| `{}`{mark} | {doc} ({}) | `{}` |\n",
            field.key,
            words(&(field.shape)()).replace('|', "\\|"),
            field.example.replace('|', "\\|")
        );
    }
    text
}

/// A value's shape in words.
fn words(shape: &Shape) -> String {
    match shape {
        Shape::Text(what) | Shape::Number(what) => (*what).to_owned(),
        Shape::Words(words) => words.join(", "),
        Shape::List(of) => format!("a list: {}", words(&of())),
        Shape::Map(of) => format!("names of your own, each with: {}", words(&of())),
        Shape::Record(record) => {
            format!(
                "[{}](#{})",
                record.title,
                record.title.to_lowercase().replace(' ', "-").replace('\'', "")
            )
        }
        Shape::Either(shapes) => shapes.iter().map(words).collect::<Vec<_>>().join("; or "),
    }
}

/// The records named in a shape.
fn records(shape: &Shape) -> Vec<RecordShape> {
    match shape {
        Shape::Record(record) => vec![*record],
        Shape::List(of) | Shape::Map(of) => records(&of()),
        Shape::Either(shapes) => shapes.iter().flat_map(records).collect(),
        Shape::Text(_) | Shape::Number(_) | Shape::Words(_) => Vec::new(),
    }
}
