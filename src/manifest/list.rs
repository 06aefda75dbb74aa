//! Lists, and maps with names of the user's own.

use super::extends::LISTS;
use super::node::{Content, Entry, Node};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape};
use crate::error::nearest_name;
use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::rc::Rc;

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
            let hint = "begin each item with `- ` on a line of its own";
            // It may change items of a list that is in a manifest that could not be had.
            let changes = LISTS.contains(&key.as_str()) && matches!(node.content, Content::Map(_));
            return Err(if changes {
                reader.missing(&node.place, what, hint)
            } else {
                reader.fault(&node.place, what, hint)
            });
        };
        let (values, sound) = each::<K>(items, reader);
        sound.map(|()| values)
    }
}

/// The items without faults, and whether that is all of them.
pub(crate) fn each<K: Kind>(items: &[Rc<Node>], reader: &mut Reader<'_>) -> (Vec<K::Value>, Read<()>) {
    let (mut values, mut sound) = (Vec::new(), Ok(()));
    for (index, item) in items.iter().enumerate() {
        let value = reader.under(&index.to_string(), &item.place, |reader| {
            reader.something(item)?;
            K::read(item, reader)
        });
        match value {
            Ok(value) => values.push(value),
            Err(reported) => sound = Err(reported),
        }
    }
    (values, sound)
}

/// Where in a list the item is that a key means: by its name or that of its asset, or by its number from 0; or why there
/// is none, and what to type.
pub(crate) fn item(items: &[Rc<Node>], key: &str) -> Result<usize, (String, String)> {
    let text = |item: &'_ Rc<Node>, key: &str| item.get(key).and_then(|node| node.text()).map(str::to_owned);
    let names: Vec<_> = items.iter().map(|item| text(item, "name").or_else(|| text(item, "asset"))).collect();
    let named: Vec<usize> = (0..items.len()).filter(|at| names[*at].as_deref() == Some(key)).collect();
    match (named.as_slice(), key.parse::<usize>()) {
        (&[at], _) => Ok(at),
        (&[first, second, ..], _) => {
            let what = format!("{} items of this list are named `{key}`", named.len());
            Err((what, format!("say which by its number: {first}, {second}")))
        }
        ([], Ok(at)) if at < items.len() => Ok(at),
        ([], number) => {
            let nearest = nearest_name(key, names.iter().flatten().map(String::as_str));
            let hint = match (nearest, number) {
                (Some(nearest), _) => format!("did you mean `{nearest}`?"),
                _ if items.is_empty() => "the list is empty; `+` adds to it".to_owned(),
                _ => format!("items are named, or numbered from 0 to {}; `+` adds to them", items.len() - 1),
            };
            Err((format!("`{key}` is no item of this list of {}", items.len()), hint))
        }
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
