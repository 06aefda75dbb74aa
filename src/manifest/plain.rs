//! Values without a unit: bare numbers and vectors, counts, switches, words, names and paths.

use super::Spanned;
use super::node::Node;
use super::quantity::{Written, vector};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape};
use crate::error::nearest_name;
use glam::DVec3;
use std::collections::BTreeSet;
use std::marker::PhantomData;
use std::path::{Component, Path, PathBuf};

/// Files of a folder that are looked through for one that was meant.
const MOST_NEIGHBOURS: usize = 10_000;

/// A value and where it is written.
pub(crate) struct Placed<K>(PhantomData<K>);

impl<K: Kind> Kind for Placed<K> {
    type Value = Spanned<K::Value>;
    fn shape() -> Shape {
        K::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        Ok(Spanned { value: K::read(node, reader)?, place: node.place.clone() })
    }
}

/// A bare number.
pub(crate) struct Real;

impl Kind for Real {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a bare number")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        Ok(reader.bare(node, "a bare number", 1)?.first().copied().unwrap_or_default())
    }
}

/// A bare number of zero or more.
pub(crate) struct NotNegative;

impl Kind for NotNegative {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a bare number, zero or more")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let number = Real::read(node, reader)?;
        if number >= 0.0 {
            return Ok(number);
        }
        let hint = reader.typed(&format!("{} (zero or more)", -number));
        Err(reader.fault(&node.place, format!("`{number}` is below zero"), hint))
    }
}

/// A bare number from 0 to 1.
pub(crate) struct Part;

impl Kind for Part {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a bare number from 0 to 1")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let number = Real::read(node, reader)?;
        if (0.0..=1.0).contains(&number) {
            return Ok(number);
        }
        let hint = reader.typed(&format!("{} (from 0 to 1)", number.clamp(0.0, 1.0)));
        Err(reader.fault(&node.place, format!("`{number}` is out of range"), hint))
    }
}

/// Three bare numbers.
pub(crate) struct Vector;

impl Kind for Vector {
    type Value = DVec3;
    fn shape() -> Shape {
        Shape::Text("three bare numbers, as in 0 1 0")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DVec3> {
        Ok(vector(&reader.bare(node, "a bare vector", 3)?))
    }
}

/// Three bare numbers, not all zero: a unit vector comes of them.
pub(crate) struct Direction;

impl Kind for Direction {
    type Value = DVec3;
    fn shape() -> Shape {
        Shape::Text("three bare numbers, not all zero, as in 0 1 0")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DVec3> {
        let along = vector(&reader.bare(node, "a direction", 3)?);
        let largest = along.abs().max_element();
        if largest > 0.0 {
            // Scaled first, so that no square over- or underflows.
            let scaled = along / largest;
            return Ok(scaled / scaled.length());
        }
        let hint = reader.typed(if reader.key() == Some("up") { "0 1 0" } else { "0 0 1" });
        Err(reader.fault(&node.place, "a direction cannot be zero", hint))
    }
}

/// A whole number from `LEAST` to `MOST`.
pub(crate) struct Count<const LEAST: u32, const MOST: u32>;

impl<const LEAST: u32, const MOST: u32> Kind for Count<LEAST, MOST> {
    type Value = u32;
    fn shape() -> Shape {
        Shape::Number("a whole number")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<u32> {
        let number = Real::read(node, reader)?;
        whole(number, LEAST, MOST).ok_or_else(|| {
            let hint = reader
                .typed(&format!("{} (a whole number from {LEAST} to {MOST})", fitted(number, LEAST, MOST)));
            reader.fault(&node.place, format!("`{}` is out of range", node.text().unwrap_or_default()), hint)
        })
    }
}

/// The number, if it is whole and within bounds.
pub(crate) fn whole(number: f64, least: u32, most: u32) -> Option<u32> {
    let within = number >= f64::from(least) && number <= f64::from(most) && number.fract().abs() <= 0.0;
    within.then_some(number as u32)
}

fn fitted(number: f64, least: u32, most: u32) -> u32 {
    number.round().clamp(f64::from(least), f64::from(most)) as u32
}

/// `on` or `off`.
pub(crate) struct Switch;

impl Kind for Switch {
    type Value = bool;
    fn shape() -> Shape {
        Shape::Words(&["on", "off"])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<bool> {
        match reader.text(node, "a switch", "on")? {
            "on" | "true" => Ok(true),
            "off" | "false" => Ok(false),
            other => {
                let hint = reader.typed(if matches!(other, "no" | "No" | "0") { "off" } else { "on" });
                Err(reader.fault(&node.place, format!("`{other}` is neither on nor off"), hint))
            }
        }
    }
}

/// Text, not empty.
pub(crate) struct Text;

impl Kind for Text {
    type Value = String;
    fn shape() -> Shape {
        Shape::Text("text")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<String> {
        let text = reader.text(node, "a name", "some_name")?;
        if text.trim().is_empty() {
            return Err(reader.fault(
                &node.place,
                "this text is empty",
                "write a name, or leave the key out",
            ));
        }
        Ok(text.to_owned())
    }
}

/// A path relative to the manifest's folder; what comes of it is that path seen from the working folder.
pub(crate) struct FilePath;

impl Kind for FilePath {
    type Value = PathBuf;
    fn shape() -> Shape {
        Shape::Text("a path relative to the manifest's folder")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<PathBuf> {
        let text = reader.text(node, "a path", "folder/name")?;
        if text.trim().is_empty() || text.contains('\0') {
            let hint = reader.typed("folder/name");
            return Err(reader.fault(&node.place, "this is not a path", hint));
        }
        let folder = match &node.place {
            crate::error::Place::Text { path, .. } => path.parent().unwrap_or(Path::new("")),
            _ => reader.folder,
        };
        Ok(tidy(&folder.join(text)))
    }
}

/// The path of a file that is there.
pub(crate) struct ThereFile;

impl Kind for ThereFile {
    type Value = PathBuf;
    fn shape() -> Shape {
        FilePath::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<PathBuf> {
        let path = FilePath::read(node, reader)?;
        if path.is_file() {
            return Ok(path);
        }
        Err(reader.fault(&node.place, format!("there is no file `{}`", path.display()), neighbour(&path)))
    }
}

/// What to type instead of the path of a file that is not there: the nearest name in its folder.
pub(crate) fn neighbour(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MOST_NEIGHBOURS);
    let there: BTreeSet<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    match nearest_name(&name, there.iter().map(String::as_str)).filter(|near| *near != name) {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => "paths are relative to the manifest's folder".to_owned(),
    }
}

/// The path without `folder/..`, as long as nothing of it is a link that would lead elsewhere.
pub(crate) fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for part in path.components() {
        let up = part == Component::ParentDir;
        let named = matches!(tidy.components().next_back(), Some(Component::Normal(_)));
        if up && named && !tidy.is_symlink() {
            tidy.pop();
        } else {
            tidy.push(part);
        }
    }
    tidy
}

/// Declares an enum whose values are words.
macro_rules! words {
    ($(#[doc = $doc:literal])* $name:ident, $what:literal { $( $(#[doc = $wdoc:literal])* $word:literal => $variant:ident; )* }) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name { $( $(#[doc = $wdoc])* $variant, )* }
        impl $crate::manifest::record::Kind for $name {
            type Value = Self;
            fn shape() -> $crate::manifest::record::Shape {
                $crate::manifest::record::Shape::Words(&[$($word),*])
            }
            fn read(
                node: &$crate::manifest::node::Node,
                reader: &mut $crate::manifest::reader::Reader<'_>,
            ) -> $crate::manifest::reader::Read<Self> {
                match $crate::manifest::plain::word(node, $what, &[$($word),*], reader)? {
                    $( $word => Ok(Self::$variant), )*
                    _ => Err($crate::manifest::reader::Reported),
                }
            }
        }
    };
}
pub(crate) use words;

/// One of the words known.
pub(crate) fn word<'n>(node: &'n Node, what: &str, known: &[&str], reader: &mut Reader<'_>) -> Read<&'n str> {
    let text = reader.text(node, what, known.first().copied().unwrap_or_default())?;
    if known.contains(&text) {
        return Ok(text);
    }
    let nearest = nearest_name(text, known.iter().copied());
    let typed = reader.typed(nearest.or(known.first().copied()).unwrap_or_default());
    let hint = format!("{typed} (one of {})", known.join(", "));
    Err(reader.fault(&node.place, format!("`{text}` is not {what}"), hint))
}

/// A factor for each axis, not zero: one number above zero, or three.
pub(crate) struct Scale;

impl Kind for Scale {
    type Value = DVec3;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Number("a factor above zero"), Shape::Text("three factors, as in 1 2 1")])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DVec3> {
        let several = node.text().is_some_and(|text| Written::of(text).numbers.len() > 1);
        if several {
            let factors = Vector::read(node, reader)?;
            if factors.to_array().iter().all(|x| *x != 0.0) {
                return Ok(factors);
            }
        } else {
            let factor = Real::read(node, reader)?;
            if factor > 0.0 {
                return Ok(DVec3::splat(factor));
            }
        }
        let hint = reader.typed("2, or three factors other than zero, as in 1 1 -1");
        Err(reader.fault(&node.place, "a scale cannot be zero, nor one number below zero", hint))
    }
}
