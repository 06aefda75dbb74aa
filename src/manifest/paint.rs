//! What part of the light a surface reflects, and where on it.

use super::Spanned;
use super::node::{Content, Node};
use super::plain::{NotNegative, Placed, ThereFile};
use super::quantity::Length;
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, choice, record};
use super::spectrum::{Spectrum, SpectrumKind};
use crate::error::nearest_name;
use std::path::PathBuf;
use std::sync::Arc;

/// What part of the light is reflected: a bare number, or a spectrum that is nowhere above 1.
pub(crate) struct Reflectance;

impl Kind for Reflectance {
    type Value = Arc<Spectrum>;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Number("a part of the light, from 0 to 1"), SpectrumKind::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Spectrum>> {
        if is_pattern(node) {
            let hint = reader.typed("0.8, or { rgb: 0.8 0.2 0.1 }");
            return Err(reader.fault(&node.place, "here is no place for a pattern", hint));
        }
        let named = node.text().is_some_and(|text| reader.spectra.has(text));
        let spectrum = if is_number(node) && !named {
            Arc::new(Spectrum::Constant(NotNegative::read(node, reader)?))
        } else {
            SpectrumKind::read(node, reader)?
        };
        if spectrum.is_light() || spectrum.peak().is_none() {
            let hint = reader.typed("0.8, or { rgb: 0.8 0.2 0.1 }, { table: paint.csv }, { constant: 0.8 }");
            let what = "this is light, not a part of light that is reflected";
            return Err(reader.fault(&node.place, what, hint));
        }
        match spectrum.peak() {
            Some(peak) if peak > 1.0 => {
                let what = format!("a surface cannot reflect {peak} times the light that falls on it");
                let hint = reader.typed("1 (at most, at any wavelength)");
                Err(reader.fault(&node.place, what, hint))
            }
            _ => Ok(spectrum),
        }
    }
}

/// Whether text begins as a number does.
pub(crate) fn is_number(node: &Node) -> bool {
    node.text().is_some_and(|text| text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)))
}

/// What part of the light is reflected, and where.
#[derive(Debug, Clone)]
pub enum Paint {
    /// The same everywhere.
    Even(Arc<Spectrum>),
    /// Squares in turn: by whether the sum of the texture coordinates, counted in whole squares, is even or odd.
    Checker {
        /// The side of a square in units of texture coordinates (metres on a plane).
        size: f64,
        /// On squares of even sum, such as that from (0, 0) to (1, 1).
        even: Arc<Spectrum>,
        /// On the others.
        odd: Arc<Spectrum>,
    },
    /// A picture, laid on by the texture coordinates and repeated.
    Picture {
        /// Its file.
        file: Spanned<PathBuf>,
        /// The side of one copy in units of texture coordinates (metres on a plane).
        size: f64,
    },
}

record! {
    /// Squares in turn, by the texture coordinates: those of a plane are metres, those of a file mostly go from 0
    /// to 1, which counts as 1 m.
    Checker, "a checkerboard" {
        /// The side of a square: 1 m unless said.
        size: f64 = Length, default(1.0), "1 m";
        /// What part of the light is reflected by every other square, such as that from (0, 0) to (1, 1).
        even: Arc<Spectrum> = Reflectance, required, "0.9";
        /// What part of the light is reflected by the squares between.
        odd: Arc<Spectrum> = Reflectance, required, "0.02";
    }
}

choice! {
    /// What is painted on a surface.
    Pattern, "a pattern" {
        /// Squares in turn.
        checker => Checker(Checker) = Checker, "{ even: 0.9, odd: 0.02 }";
        /// A picture file, laid on by the texture coordinates and repeated.
        picture => Picture(Spanned<PathBuf>) = Placed<ThereFile>, "paint.png";
    }
}

record! {
    /// A pattern, instead of a part of the light that is the same all over a surface.
    PatternKeys, "a pattern" {
        @include pattern: Pattern, "What is painted.";
        /// The side of one copy of the picture: 1 m unless said.
        size: Option<Spanned<f64>> = Placed<Length>, optional, "1 m";
    }
}

/// A reflectance, or a pattern.
pub(crate) struct PaintKind;

impl Kind for PaintKind {
    type Value = Paint;
    fn shape() -> Shape {
        Shape::Either(vec![Reflectance::shape(), PatternKeys::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Paint> {
        if !is_pattern(node) {
            return Reflectance::read(node, reader).map(Paint::Even);
        }
        let keys = PatternKeys::read(node, reader)?;
        match (keys.pattern, keys.size) {
            (Pattern::Checker(_), Some(size)) => {
                let hint = "checker: { size: 1 m, even: 0.9, odd: 0.02 }";
                Err(reader.fault(
                    &size.place,
                    "the size of a checkerboard's squares is one of its own keys",
                    hint,
                ))
            }
            (Pattern::Checker(Checker { size, even, odd, .. }), None) => {
                Ok(Paint::Checker { size, even, odd })
            }
            (Pattern::Picture(file), size) => {
                Ok(Paint::Picture { file, size: size.map_or(1.0, |size| size.value) })
            }
        }
    }
}

/// Whether a map has a key that is one of a pattern, or was meant to be.
fn is_pattern(node: &Node) -> bool {
    let Content::Map(entries) = &node.content else { return false };
    entries.iter().any(|entry| nearest_name(&entry.key, ["checker", "picture"]).is_some())
}
