//! Records: what keys a map of the manifest may have, written once.
//!
//! [`record!`] turns a list of keys into a struct, the code that reads it from a [`Node`], and the
//! description of its keys that the schema is made from; [`choice!`] does the same for "exactly one of these
//! keys". A key is written
//!
//! ~~~text
//! /// What it means.
//! at: DVec3 = Point, default(DVec3::ZERO), "0 2 -9.5 m";
//! ~~~
//!
//! name, type in the struct, [`Kind`] that reads it, `required`, `optional`,
//! `default(..)` or `empty` (read as if an empty map were written), an example.
//! Keys are read in the order in which they are listed, and all of their faults are reported.

pub(crate) use super::list::{List, Named, named_entries};
use super::node::{Content, Entry, Node};
use super::reader::{Read, Reader, Reported};
use crate::error::{Place, nearest_name};

/// What a value of the manifest looks like: the raw material of a schema.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Text; the words say which ("a place", "a colour as #rrggbb").
    Text(&'static str),
    /// A bare number; the words say which.
    Number(&'static str),
    /// One of these words.
    Words(&'static [&'static str]),
    /// A list.
    List(fn() -> Self),
    /// A map with names of the user's own.
    Map(fn() -> Self),
    /// A map with known keys.
    Record(RecordShape),
    /// Any one of these.
    Either(Vec<Self>),
}

/// The keys of a map.
#[derive(Debug, Clone, Copy)]
pub struct RecordShape {
    /// "a body".
    pub title: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its keys, in the order in which they are explained.
    pub fields: fn() -> Vec<Field>,
}

/// Whether a key has to be there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// It has to.
    Required,
    /// It need not.
    Optional,
    /// One of all that are marked so has to; at most one, if the choice has a default.
    Alternative,
}

/// A key of a map.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// The key as written.
    pub key: &'static str,
    /// What it means.
    pub doc: &'static str,
    /// A value for it.
    pub example: &'static str,
    /// Whether it has to be there.
    pub presence: Presence,
    /// The choice of which it is an alternative; empty if it is none.
    pub group: &'static str,
    /// What its value looks like.
    pub shape: fn() -> Shape,
}

/// A way of reading a value.
pub(crate) trait Kind {
    /// What comes of it.
    type Value;
    /// Whether a key may be written with nothing after it.
    const MAY_BE_EMPTY: bool = false;
    /// What it looks like.
    fn shape() -> Shape;
    /// The value; all faults are reported.
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value>;
}

/// A map with known keys.
pub(crate) trait Record: Sized {
    const TITLE: &'static str;
    const DOC: &'static str;
    fn fields() -> Vec<Field>;
    /// Reads its keys, passing over those of the records that it stands beside.
    fn take(entries: &Entries<'_>, reader: &mut Reader<'_>) -> Read<Self>;
}

impl<R: Record> Kind for R {
    type Value = R;
    fn shape() -> Shape {
        Shape::Record(RecordShape { title: R::TITLE, doc: R::DOC, fields: R::fields })
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<R> {
        let entries = Entries::of::<R>(node, reader)?;
        let value = R::take(&entries, reader)?;
        if entries.unknown { Err(Reported) } else { Ok(value) }
    }
}

/// The entries of a map that is being read as a record.
pub(crate) struct Entries<'n> {
    pub(crate) node: &'n Node,
    all: &'n [Entry],
    unknown: bool,
    /// Known keys that an unknown one was probably meant to be: not to be missed aloud.
    meant: Vec<&'static str>,
}

impl<'n> Entries<'n> {
    fn of<R: Record>(node: &'n Node, reader: &mut Reader<'_>) -> Read<Self> {
        let Content::Map(entries) = &node.content else {
            let what = format!("{} is a map of keys; this is {}", R::TITLE, node.describe());
            return Err(reader.fault(&node.place, what, keys_hint::<R>()));
        };
        let mut read = Self { node, all: entries, unknown: false, meant: Vec::new() };
        let fields = R::fields();
        for entry in entries {
            if fields.iter().all(|field| field.key != entry.key) {
                read.unknown::<R>(entry, &fields, reader);
            }
        }
        Ok(read)
    }

    fn unknown<R: Record>(&mut self, entry: &Entry, fields: &[Field], reader: &mut Reader<'_>) {
        self.unknown = true;
        let what = format!("`{}` is not a key of {}", entry.key, R::TITLE);
        if !reader.suggests() {
            reader.fault(&entry.key_place, what, "");
            return;
        }
        let keys = || fields.iter().map(|field| field.key);
        let nearest = nearest_name(&entry.key, keys()).or_else(|| other_word(&entry.key, keys));
        let nearest = nearest.filter(|key| self.get(key).is_none());
        let hint = match nearest.map(|key| (key, in_argument(entry, key))) {
            Some((_, Some(argument))) => argument,
            Some((key, None)) => format!("did you mean `{key}`? {}", keys_hint::<R>()),
            None => keys_hint::<R>(),
        };
        self.meant.extend(nearest);
        reader.fault(&entry.key_place, what, hint);
    }

    /// The entry of a key.
    pub(crate) fn get(&self, key: &str) -> Option<&'n Entry> {
        self.all.iter().find(|entry| entry.key == key)
    }

    /// Whether an unknown key was probably meant to be this one.
    pub(crate) fn is_meant(&self, key: &str) -> bool {
        self.meant.contains(&key)
    }

    /// The value of a key that may be left out.
    pub(crate) fn optional<K: Kind>(
        &self,
        (key, example): (&str, &str),
        reader: &mut Reader<'_>,
    ) -> Read<Option<K::Value>> {
        let Some(entry) = self.get(key) else { return Ok(None) };
        let known = reader.report.faults.len();
        reader
            .under(&entry.key, &entry.value.place, |reader| {
                if !K::MAY_BE_EMPTY {
                    reader.something(&entry.value)?;
                }
                let value = K::read(&entry.value, reader);
                if value.is_err() {
                    reader.better_hint::<K>(known, example);
                }
                value
            })
            .map(Some)
    }

    /// The value of a key; if it is left out, what an empty map would have been read as.
    pub(crate) fn or_empty<K: Kind>(&self, key: (&str, &str), reader: &mut Reader<'_>) -> Read<K::Value> {
        match self.optional::<K>(key, reader)? {
            Some(value) => Ok(value),
            None => K::read(&Node::new(Place::Command, Content::Map(Vec::new())), reader),
        }
    }

    /// The value of a key that has to be there.
    pub(crate) fn required<K: Kind>(
        &self,
        title: &str,
        (key, example): (&str, &str),
        reader: &mut Reader<'_>,
    ) -> Read<K::Value> {
        match self.optional::<K>((key, example), reader)? {
            Some(value) => Ok(value),
            None if self.is_meant(key) => Err(Reported),
            None => {
                let what = format!("{title} needs `{key}`");
                Err(reader.missing(&self.node.place, what, format!("{key}: {example}")))
            }
        }
    }

    /// Which of these alternatives is given; faults when it is not exactly one.
    pub(crate) fn one_of(
        &self,
        title: &str,
        fields: &[Field],
        optional: bool,
        reader: &mut Reader<'_>,
    ) -> Read<Option<&'static str>> {
        let given: Vec<_> = fields.iter().filter(|field| self.get(field.key).is_some()).collect();
        let keys = fields.iter().map(|field| field.key).collect::<Vec<_>>().join(", ");
        match given.as_slice() {
            [] if optional => Ok(None),
            [] if fields.iter().any(|field| self.is_meant(field.key)) => Err(Reported),
            [] => {
                let hint = fields
                    .first()
                    .map_or_else(String::new, |field| format!("{}: {}", field.key, field.example));
                Err(reader.missing(&self.node.place, format!("{title} needs one of {keys}"), hint))
            }
            [one] => Ok(Some(one.key)),
            [first, second, ..] => {
                let entries = [first.key, second.key].map(|key| self.all.iter().position(|e| e.key == key));
                let later = entries.into_iter().flatten().max().and_then(|at| self.all.get(at));
                let place = later.map_or(&self.node.place, |entry| &entry.key_place);
                let what = format!("{title} has both `{}` and `{}`", first.key, second.key);
                let earlier = entries.into_iter().flatten().min().and_then(|at| self.all.get(at));
                let earlier = earlier.map_or(&self.node.place, |entry| &entry.key_place);
                Err(reader.fault_and(place, (earlier, "the other one"), what, format!("keep one of {keys}")))
            }
        }
    }
}

/// What is said elsewhere, and the keys that are meant by it.
const OTHER_WORDS: [(&str, &[&str]); 22] = [
    ("fov", &["field_of_view"]),
    ("angle", &["field_of_view"]),
    ("colour", &["color", "diffuse", "spectrum"]),
    ("color", &["diffuse", "spectrum"]),
    ("rgb", &["diffuse", "spectrum"]),
    ("position", &["at"]),
    ("location", &["at"]),
    ("translation", &["at"]),
    ("time", &["at_time", "at"]),
    ("speed", &["velocity"]),
    ("beta", &["velocity"]),
    ("target", &["look_at"]),
    ("resolution", &["size"]),
    ("width", &["size"]),
    ("height", &["size"]),
    ("spp", &["samples"]),
    ("fps", &["rate"]),
    ("frames", &["count"]),
    ("model", &["asset"]),
    ("camera", &["observer"]),
    ("objects", &["bodies"]),
    ("background", &["surroundings"]),
];

/// The key that is meant by a word of other programs, if it is one of these.
fn other_word<I: Iterator<Item = &'static str>>(word: &str, keys: impl Fn() -> I) -> Option<&'static str> {
    let meant = OTHER_WORDS.iter().find(|(other, _)| word.eq_ignore_ascii_case(other))?.1;
    meant.iter().find_map(|meant| keys().find(|key| key == meant))
}

/// The argument with another key in place of the last of its path, if the key stands there.
fn in_argument(entry: &Entry, key: &str) -> Option<String> {
    let Place::Argument { text, span } = &entry.key_place else { return None };
    let above = text.get(..span.end)?.strip_suffix(entry.key.as_str())?;
    Some(format!("{above}{key}{}", text.get(span.end..)?))
        .filter(|_| above.ends_with('.') || above.ends_with(' '))
}

/// The keys of a map, to be shown.
pub(crate) fn keys<R: Record>() -> String {
    R::fields().iter().map(|field| field.key).collect::<Vec<_>>().join(", ")
}

fn keys_hint<R: Record>() -> String {
    format!("the keys of {} are {}", R::TITLE, keys::<R>())
}

/// A key as it is written: `r#box` is `box`, a word that Rust keeps for itself.
pub(crate) const fn plain_key(name: &'static str) -> &'static str {
    match name.as_bytes() {
        [b'r', b'#', ..] => name.split_at(2).1,
        _ => name,
    }
}

/// Declares a record; see the module.
macro_rules! record {
    (
        $(#[doc = $doc:literal])*
        $vis:vis $name:ident, $title:literal {
            $( @include $inc:ident : $inc_ty:ty, $idoc:literal; )*
            $( $(#[doc = $fdoc:literal])*
               $field:ident : $ty:ty = $kind:ty, $mode:ident $( ( $default:expr ) )?, $example:literal; )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone)]
        $vis struct $name {
            /// Where it is written.
            #[allow(dead_code, reason = "what is made of a record need not keep its place")]
            pub place: $crate::error::Place,
            $( #[doc = $idoc] pub $inc: $inc_ty, )*
            $( $(#[doc = $fdoc])* pub $field: $ty, )*
        }
        impl $crate::manifest::record::Record for $name {
            const TITLE: &'static str = $title;
            const DOC: &'static str = concat!($($doc, "\n"),*);
            fn fields() -> Vec<$crate::manifest::record::Field> {
                #[allow(unused_mut, reason = "not every record stands beside another")]
                let mut fields = vec![$( $crate::manifest::record::Field {
                    key: stringify!($field),
                    doc: concat!($($fdoc, "\n"),*),
                    example: $example,
                    presence: record!(@presence $mode),
                    group: "",
                    shape: <$kind as $crate::manifest::record::Kind>::shape,
                } ),*];
                $( fields.extend(<$inc_ty as $crate::manifest::record::Record>::fields()); )*
                fields
            }
            fn take(
                entries: &$crate::manifest::record::Entries<'_>,
                reader: &mut $crate::manifest::reader::Reader<'_>,
            ) -> $crate::manifest::reader::Read<Self> {
                $( let $field = record!(@read $mode $kind, $title, entries, reader, stringify!($field), $example $(, $default)?); )*
                $( let $inc = <$inc_ty as $crate::manifest::record::Record>::take(entries, reader); )*
                Ok(Self { place: entries.node.place.clone(), $( $inc: $inc?, )* $( $field: $field?, )* })
            }
        }
    };
    (@presence required) => { $crate::manifest::record::Presence::Required };
    (@presence $other:ident) => { $crate::manifest::record::Presence::Optional };
    (@read required $kind:ty, $title:literal, $entries:ident, $reader:ident, $key:expr, $example:literal) => {
        $entries.required::<$kind>($title, ($key, $example), $reader)
    };
    (@read optional $kind:ty, $title:literal, $entries:ident, $reader:ident, $key:expr, $example:literal) => {
        $entries.optional::<$kind>(($key, $example), $reader)
    };
    (@read empty $kind:ty, $title:literal, $entries:ident, $reader:ident, $key:expr, $example:literal) => {
        $entries.or_empty::<$kind>(($key, $example), $reader)
    };
    (@read default $kind:ty, $title:literal, $entries:ident, $reader:ident, $key:expr, $example:literal, $default:expr) => {
        $entries.optional::<$kind>(($key, $example), $reader).map(|value| value.unwrap_or_else(|| $default))
    };
}

/// Declares "exactly one of these keys", as an enum; with `otherwise`, none of them is right too.
macro_rules! choice {
    (
        $(#[doc = $doc:literal])*
        $vis:vis $name:ident, $title:literal $(, otherwise($default:expr))? {
            $( @unit $unit:ident, $udoc:literal; )*
            $( $(#[doc = $fdoc:literal])*
               $key:ident => $variant:ident($ty:ty) = $kind:ty, $example:literal; )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone)]
        $vis enum $name {
            $( #[doc = $udoc] $unit, )*
            $( $(#[doc = $fdoc])* $variant($ty), )*
        }
        impl $crate::manifest::record::Record for $name {
            const TITLE: &'static str = $title;
            const DOC: &'static str = concat!($($doc, "\n"),*);
            fn fields() -> Vec<$crate::manifest::record::Field> {
                vec![$( $crate::manifest::record::Field {
                    key: $crate::manifest::record::plain_key(stringify!($key)),
                    doc: concat!($($fdoc, "\n"),*),
                    example: $example,
                    presence: $crate::manifest::record::Presence::Alternative,
                    group: $title,
                    shape: <$kind as $crate::manifest::record::Kind>::shape,
                } ),*]
            }
            fn take(
                entries: &$crate::manifest::record::Entries<'_>,
                reader: &mut $crate::manifest::reader::Reader<'_>,
            ) -> $crate::manifest::reader::Read<Self> {
                #[allow(unused_mut, unused_assignments, reason = "not every choice has a default")]
                let mut otherwise: Option<fn() -> Self> = None;
                $( otherwise = Some(|| $default); )?
                let given = entries.one_of($title, &Self::fields(), otherwise.is_some(), reader);
                $( let $key = entries.optional::<$kind>(($crate::manifest::record::plain_key(stringify!($key)), $example), reader); )*
                let given = given?;
                if let (None, Some(otherwise)) = (given, otherwise) {
                    return Ok(otherwise());
                }
                $( if given == Some($crate::manifest::record::plain_key(stringify!($key))) {
                    return $key?.map(Self::$variant).ok_or($crate::manifest::reader::Reported);
                } )*
                Err($crate::manifest::reader::Reported)
            }
        }
    };
}

pub(crate) use {choice, record};
