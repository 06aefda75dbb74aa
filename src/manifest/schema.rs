//! The JSON Schema of a manifest (draft 2020-12), written from the same lists that read it: for editors, which complete
//! keys and say what they mean.
//!
//! It knows keys, words, lists and where numbers stand. What is in a text (units, names) the program itself says.

use super::extends::{LISTS, LOOKING};
use super::record::{Presence, RecordShape, Shape};
use super::shape;
use serde_json::{Map, Value, json};

/// The schema, as text.
pub fn schema() -> String {
    let mut definitions = Definitions::default();
    let whole = definitions.of(&shape(), Said::Whole);
    let changes = definitions.of(&shape(), Said::Changes);
    definitions.write_waiting();
    let root = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "a manifest of terrell",
        "if": { "type": "object", "required": ["extends"] },
        "then": changes,
        "else": { "allOf": [whole, { "anyOf": LOOKING.map(|key| json!({ "required": [key] })) }] },
        "$defs": definitions.written,
    });
    // Objects of texts and numbers alone.
    serde_json::to_string_pretty(&root).unwrap_or_default() + "\n"
}

/// What is said of a thing: all of it, or what is to be changed of another manifest's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Said {
    Whole,
    Changes,
}

/// Records by their names.
#[derive(Default)]
struct Definitions {
    written: Map<String, Value>,
    // Records that have been named, with their names; the first so many are written.
    named: Vec<(RecordShape, Said, String)>,
    done: usize,
}

impl Definitions {
    /// The name of a record: its title, and a number where another has the same.
    fn name(&mut self, record: RecordShape, said: Said) -> String {
        let alike = |other: &RecordShape, also: Said| other.title == record.title && also == said;
        let same = |(other, also, _): &&(RecordShape, Said, String)| {
            alike(other, *also) && std::ptr::fn_addr_eq(other.fields, record.fields)
        };
        if let Some((_, _, name)) = self.named.iter().find(same) {
            return name.clone();
        }
        let title = record.title.replace(' ', "-") + if said == Said::Changes { "-changed" } else { "" };
        let before = self.named.iter().filter(|(other, also, _)| alike(other, *also)).count();
        let name = if before > 0 { format!("{title}-{}", before + 1) } else { title };
        self.named.push((record, said, name.clone()));
        name
    }

    fn write_waiting(&mut self) {
        while let Some((record, said, name)) = self.named.get(self.done).cloned() {
            let written = self.record(&record, said);
            self.written.insert(name, written);
            self.done += 1;
        }
    }

    fn record(&mut self, record: &RecordShape, said: Said) -> Value {
        let fields = (record.fields)();
        let properties: Map<String, Value> = fields
            .iter()
            .map(|field| {
                let shape = (field.shape)();
                let mut value = self.of(&shape, said);
                if said == Said::Changes {
                    value = json!({ "anyOf": self.changes(field.key, &shape, value) });
                }
                if let Value::Object(value) = &mut value {
                    value.insert("description".into(), words(field.doc).into());
                    let example = serde_yaml::from_str::<Value>(field.example);
                    value.extend(example.ok().map(|example| ("examples".into(), json!([example]))));
                }
                (field.key.to_owned(), value)
            })
            .collect();
        let required: Vec<&str> = fields
            .iter()
            .filter(|field| field.presence == Presence::Required && said == Said::Whole)
            .map(|field| field.key)
            .collect();
        json!({
            "title": record.title,
            "description": words(record.doc),
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    }

    /// A value, what takes it away, and, of some lists, a map of their items by name or number.
    fn changes(&mut self, key: &str, shape: &Shape, value: Value) -> Vec<Value> {
        let mut any = vec![value, json!({ "type": "null" })];
        if let (true, Shape::List(of)) = (LISTS.contains(&key), shape) {
            let more = self.of(&of(), Said::Whole);
            let item = json!({ "anyOf": [self.of(&of(), Said::Changes), { "type": "null" }] });
            let add = json!({ "anyOf": [{ "type": "array", "items": more }, more] });
            any.push(json!({ "type": "object", "properties": { "+": add }, "additionalProperties": item }));
        }
        any
    }

    fn of(&mut self, shape: &Shape, said: Said) -> Value {
        match shape {
            Shape::Text("nothing, or {}") => json!({ "type": ["null", "object"], "maxProperties": 0 }),
            // A single number without a unit is a number to an editor.
            Shape::Text(what) => json!({ "type": ["string", "number"], "title": what }),
            Shape::Number(what) => json!({ "type": ["number", "string"], "pattern": NUMBER, "title": what }),
            Shape::Words(words) => {
                json!({ "enum": words.iter().flat_map(|word| meant(word)).collect::<Vec<_>>() })
            }
            // Lists are not merged.
            Shape::List(of) => json!({ "type": "array", "items": self.of(&of(), Said::Whole) }),
            Shape::Map(of) if said == Said::Changes => {
                let item = json!({ "anyOf": [self.of(&of(), said), { "type": "null" }] });
                json!({ "type": "object", "additionalProperties": item })
            }
            Shape::Map(of) => json!({ "type": "object", "additionalProperties": self.of(&of(), said) }),
            Shape::Record(record) => json!({ "$ref": format!("#/$defs/{}", self.name(*record, said)) }),
            Shape::Either(shapes) => {
                json!({ "anyOf": shapes.iter().map(|shape| self.of(shape, said)).collect::<Vec<_>>() })
            }
        }
    }
}

/// A number that an editor takes for text.
const NUMBER: &str = "^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$";

/// What an editor may take a word for: it may be a number, or, to some, a truth.
fn meant(word: &str) -> Vec<Value> {
    let mut meant = vec![Value::from(word)];
    meant.extend(word.parse::<u64>().ok().map(Value::from));
    meant.extend(match word {
        "on" => Some(Value::Bool(true)),
        "off" => Some(Value::Bool(false)),
        _ => None,
    });
    meant
}

/// A comment's lines as one.
fn words(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}
