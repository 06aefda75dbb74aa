//! Values given on the command line, put into the tree of a manifest before it is read.

use super::node::{Content, Entry, Node, Source};
use super::yaml;
use crate::error::{Place, Report};
use std::rc::Rc;

/// The tree with each override at its path of keys and indices; maps that are missing on the way are made.
pub(crate) fn apply(root: Rc<Node>, overrides: &[(String, String)], report: &mut Report) -> Option<Rc<Node>> {
    let known = report.faults.len();
    let mut root = root;
    for (path, text) in overrides {
        let before = report.faults.len();
        if let Some(value) = yaml::parse(&Source::Command, text, report) {
            let keys: Vec<_> = path.split('.').collect();
            if let Err(why) = set(Rc::make_mut(&mut root), &keys, value) {
                report.fault(
                    Place::Command,
                    why,
                    "--set observer.velocity=\"0 0 0.5 c\", --set bodies.0.scale=2",
                );
            }
        }
        for fault in &mut report.faults[before..] {
            fault.what = format!("--set {path}: {}", fault.what);
        }
    }
    (report.faults.len() == known).then_some(root)
}

fn set(node: &mut Node, keys: &[&str], value: Rc<Node>) -> Result<(), String> {
    let Some((key, rest)) = keys.split_first() else {
        *node = Rc::unwrap_or_clone(value);
        return Ok(());
    };
    if key.is_empty() {
        return Err("the path has an empty key".to_owned());
    }
    if node.is_nothing() {
        node.content = Content::Map(Vec::new());
    }
    match &mut node.content {
        Content::Scalar { .. } => Err(format!("there is text here, which has no `{key}`")),
        Content::List(items) => {
            let count = items.len();
            let item = key.parse::<usize>().ok().and_then(|index| items.get_mut(index));
            let item = item.ok_or_else(|| format!("`{key}` is not an index of this list of {count}"))?;
            set(Rc::make_mut(item), rest, value)
        }
        Content::Map(entries) => {
            if let Some(entry) = entries.iter_mut().find(|entry| entry.key == *key) {
                return set(Rc::make_mut(&mut entry.value), rest, value);
            }
            let mut made = Node::new(Place::Command, Content::Map(Vec::new()));
            set(&mut made, rest, value)?;
            entries.push(Entry { key: (*key).to_owned(), key_place: Place::Command, value: made.into() });
            Ok(())
        }
    }
}
