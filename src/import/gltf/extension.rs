//! Numbers, colours and textures in the extensions of materials, read from the JSON as it stands, so that
//! each fault has its place.

use crate::import::Job;
use gltf::json;
use serde_json::{Map, Value};

/// The numbers that the specification allows.
#[derive(Debug, Clone, Copy)]
pub(super) enum Range {
    /// Any that is finite.
    Finite,
    /// From 0 to 1.
    Unit,
    /// From 0 on.
    FromZero,
    /// More than 0.
    AboveZero,
    /// From 1 on, and 0, which stands for infinite.
    RefractiveIndex,
}

impl Range {
    fn contains(self, value: f32) -> bool {
        let inside = match self {
            Self::Finite => true,
            Self::Unit => (0.0..=1.0).contains(&value),
            Self::FromZero => value >= 0.0,
            Self::AboveZero => value > 0.0,
            Self::RefractiveIndex => value == 0.0 || value >= 1.0,
        };
        inside && value.is_finite()
    }

    /// What to type.
    fn hint(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::Unit => "a number from 0 to 1",
            Self::FromZero => "a finite number from 0 on",
            Self::AboveZero => "a finite number above 0, or leave it out",
            Self::RefractiveIndex => "a finite number from 1 on, such as 1.5, or 0",
        }
    }

    /// The number, if it is in range; otherwise a fault and `or`.
    pub(super) fn check(self, value: f32, or: f32, element: &str, job: &mut Job) -> f32 {
        if self.contains(value) {
            return value;
        }
        job.fault(element, format!("{value} is out of range"), format!("type {}", self.hint()));
        or
    }
}

/// One extension of a material.
pub(super) struct Extension<'a> {
    /// Nothing for one that is not there: all of its values have their defaults.
    entries: Option<&'a Map<String, Value>>,
    element: String,
}

impl<'a> Extension<'a> {
    /// Looks an extension up among those of the material at `element`.
    pub(super) fn find(
        others: Option<&'a Map<String, Value>>,
        name: &str,
        element: &str,
        job: &mut Job,
    ) -> Self {
        let element = format!("{element}.extensions.{name}");
        let value = others.and_then(|others| others.get(name));
        let entries = value.and_then(Value::as_object);
        if let Some(value) = value.filter(|value| !value.is_object()) {
            job.fault(&element, format!("{} is not an object", kind(value)), "type {}, or leave it out");
        }
        Self { entries, element }
    }

    /// The place of an entry.
    pub(super) fn at(&self, key: &str) -> String {
        format!("{}.{key}", self.element)
    }

    /// An entry, if it is there. One exporter writes null for infinity, the default of a distance.
    fn get(&self, key: &str) -> Option<&'a Value> {
        self.entries?.get(key).filter(|value| !value.is_null())
    }

    /// A number in a range; `or` if it is not there.
    pub(super) fn number(&self, key: &str, range: Range, or: f32, job: &mut Job) -> f32 {
        self.get(key).map_or(or, |value| number(value, range, or, &self.at(key), job))
    }

    /// A colour, three numbers in a range; white if it is not there.
    pub(super) fn color(&self, key: &str, range: Range, job: &mut Job) -> [f32; 3] {
        let Some(value) = self.get(key) else { return [1.0; 3] };
        let Some(channels) = value.as_array().filter(|list| list.len() == 3) else {
            let hint = "type three numbers, such as [1, 1, 1]";
            job.fault(self.at(key), format!("{} is not a colour", kind(value)), hint);
            return [1.0; 3];
        };
        let element = |i: usize| format!("{}[{i}]", self.at(key));
        std::array::from_fn(|i| number(&channels[i], range, 1.0, &element(i), job))
    }

    /// A reference to a texture, which may be to one that does not exist.
    pub(super) fn texture(&self, key: &str, job: &mut Job) -> Option<json::texture::Info> {
        placed(serde_json::from_value(self.get(key)?.clone()), &self.at(key), job)
    }

    /// A reference to a normal map, as [`Extension::texture`].
    pub(super) fn normal_texture(&self, key: &str, job: &mut Job) -> Option<json::material::NormalTexture> {
        placed(serde_json::from_value(self.get(key)?.clone()), &self.at(key), job)
    }
}

/// What was parsed at a place; a fault gives none.
pub(super) fn placed<T>(parsed: Result<T, serde_json::Error>, element: &str, job: &mut Job) -> Option<T> {
    parsed.map_err(|error| job.fault(element, error.to_string(), "")).ok()
}

fn number(value: &Value, range: Range, or: f32, element: &str, job: &mut Job) -> f32 {
    let Some(number) = value.as_f64() else {
        job.fault(element, format!("{} is not a number", kind(value)), format!("type {}", range.hint()));
        return or;
    };
    range.check(number as f32, or, element, job)
}

/// What something is, in few words however long it is.
fn kind(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Number(value) => value.to_string(),
        Value::String(_) => "a text".to_owned(),
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(_) => "an object".to_owned(),
    }
}
