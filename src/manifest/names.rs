//! Names that stand for spectra and materials, resolved wherever they are used.

use super::Spanned;
use super::node::Node;
use super::reader::{Read, Reader, Reported, instead};
use super::record::named_entries;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// What names of one sort stand for.
pub(crate) struct Names<T> {
    written: BTreeMap<String, Rc<Node>>,
    /// What was read; none when it had faults, which are reported already.
    known: BTreeMap<String, Option<Arc<T>>>,
    /// Names being read now, the outermost first.
    open: Vec<String>,
}

impl<T> Default for Names<T> {
    fn default() -> Self {
        Self { written: BTreeMap::new(), known: BTreeMap::new(), open: Vec::new() }
    }
}

impl<T> Names<T> {
    /// Whether the manifest gives this name.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.written.contains_key(name)
    }
}

/// Something that can be given a name.
pub(crate) trait Nameable: Sized + 'static {
    /// "spectrum".
    const WHAT: &'static str;
    /// The key of the manifest under which names are given.
    const UNDER: &'static str;
    /// Names that need not be given.
    const BUILT_IN: &'static [&'static str];
    fn names<'r>(reader: &'r mut Reader<'_>) -> &'r mut Names<Self>;
    fn read_named(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Self>>;
}

/// Takes in all names of a sort, then reads what they stand for.
pub(crate) fn read_all<T: Nameable>(node: &Node, reader: &mut Reader<'_>) -> Read<BTreeMap<String, Arc<T>>> {
    let entries = named_entries(node, reader)?;
    for entry in entries {
        T::names(reader).written.insert(entry.key.clone(), entry.value.clone());
    }
    let mut values = Vec::new();
    for entry in entries {
        let reserved = T::BUILT_IN.contains(&entry.key.as_str());
        let value = if reserved {
            let what = format!("`{}` is a {} already", entry.key, T::WHAT);
            Err(reader.fault(&entry.key_place, what, "choose another name"))
        } else {
            find::<T>(&Spanned { value: entry.key.clone(), place: entry.key_place.clone() }, reader)
        };
        values.push(value.map(|value| (entry.key.clone(), value)));
    }
    values.into_iter().collect()
}

/// What a name stands for.
pub(crate) fn find<T: Nameable>(name: &Spanned<String>, reader: &mut Reader<'_>) -> Read<Arc<T>> {
    let suggests = reader.suggests();
    let names = T::names(reader);
    if let Some(known) = names.known.get(&name.value) {
        return known.clone().ok_or(Reported);
    }
    if let Some(at) = names.open.iter().position(|open| *open == name.value) {
        let mut circle = names.open.split_off(at);
        names.open.extend(circle.iter().cloned());
        circle.push(name.value.clone());
        let what = format!("the {} `{}` is made of itself: {}", T::WHAT, name.value, circle.join(" -> "));
        return Err(reader.fault(&name.place, what, "break the circle: write one of them out"));
    }
    let Some(node) = names.written.get(&name.value).cloned() else {
        let known = names.written.keys().map(String::as_str).chain(T::BUILT_IN.iter().copied());
        let hint = if suggests { instead(&name.value, known, T::UNDER) } else { String::new() };
        return Err(reader.missing(
            &name.place,
            format!("there is no {} named `{}`", T::WHAT, name.value),
            hint,
        ));
    };
    names.open.push(name.value.clone());
    let value = reader.under(&name.value, &name.place, |reader| {
        reader.something(&node)?;
        T::read_named(&node, reader)
    });
    let names = T::names(reader);
    names.open.pop();
    names.known.insert(name.value.clone(), value.as_ref().ok().cloned());
    value
}
