//! Lists, and maps with names of the user's own.

use super::node::{Content, Entry, Node};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape};
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// A list, each item of one kind.
pub(crate) struct List<K>(PhantomData<K>);

impl<K: Kind> Kind for List<K> {
    type Value = Vec<K::Value>;
    fn shape() -> Shape {
        Shape::List(K::shape)
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        let Content::List(items) = &node.content else {
            let key = reader.key().unwrap_or("this").to_owned();
            let what = format!("`{key}` is a list; this is {}", node.describe());
            return Err(reader.fault(&node.place, what, "begin each item with `- ` on a line of its own"));
        };
        let mut values = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            values.push(reader.under(&index.to_string(), &item.place, |reader| {
                reader.something(item)?;
                K::read(item, reader)
            }));
        }
        values.into_iter().collect()
    }
}

/// A map with names of the user's own, each value of one kind.
pub(crate) struct Named<K>(PhantomData<K>);

impl<K: Kind> Kind for Named<K> {
    type Value = BTreeMap<String, K::Value>;
    fn shape() -> Shape {
        Shape::Map(K::shape)
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        let mut values = Vec::new();
        for entry in named_entries(node, reader)? {
            let value = reader.under(&entry.key, &entry.value.place, |reader| {
                reader.something(&entry.value)?;
                K::read(&entry.value, reader)
            });
            values.push(value.map(|value| (entry.key.clone(), value)));
        }
        values.into_iter().collect()
    }
}

/// The entries of a map with names of the user's own.
pub(crate) fn named_entries<'n>(node: &'n Node, reader: &mut Reader<'_>) -> Read<&'n [Entry]> {
    if let Content::Map(entries) = &node.content {
        return Ok(entries);
    }
    let key = reader.key().unwrap_or("this").to_owned();
    let what = format!("`{key}` is a map of names; this is {}", node.describe());
    Err(reader.fault(&node.place, what, "write `name: ..` for each, indented alike"))
}
