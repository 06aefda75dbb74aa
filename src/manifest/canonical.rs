//! What a manifest says, however it is written: without comments, places and the order of keys.

use super::node::{Content, Node};
use crate::inputs::{self, Digest};

/// Keys that do not concern the pictures.
const NOT_SEEN: [&str; 2] = ["film", "output"];

/// The digest of what concerns the pictures.
pub(super) fn digest(root: &Node) -> Digest {
    let mut bytes = Vec::new();
    write(root, &NOT_SEEN, &mut bytes);
    inputs::digest(bytes)
}

/// Kinds and lengths come first, so that no two trees are written alike.
fn write(node: &Node, without: &[&str], bytes: &mut Vec<u8>) {
    let mut begin = |kind: u8, length: usize| {
        bytes.push(kind);
        bytes.extend((length as u64).to_le_bytes());
    };
    match &node.content {
        Content::Scalar { .. } if node.is_nothing() => begin(b'-', 0),
        Content::Scalar { text, .. } => {
            begin(b's', text.len());
            bytes.extend(text.as_bytes());
        }
        Content::List(items) => {
            begin(b'l', items.len());
            items.iter().for_each(|item| write(item, &[], bytes));
        }
        Content::Map(entries) => {
            let mut entries: Vec<_> =
                entries.iter().filter(|entry| !without.contains(&entry.key.as_str())).collect();
            entries.sort_by(|a, b| a.key.cmp(&b.key));
            begin(b'm', entries.len());
            for entry in entries {
                bytes.extend((entry.key.len() as u64).to_le_bytes());
                bytes.extend(entry.key.as_bytes());
                write(&entry.value, &[], bytes);
            }
        }
    }
}
