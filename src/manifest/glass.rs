//! Glass and other clear stuff as written.

use super::Spanned;
use super::node::{Content, Node};
use super::paint::{Reflectance, is_number};
use super::plain::{Placed, Real, Switch, words};
use super::quantity::{Length, Written};
use super::reader::{Read, Reader, Reported};
use super::record::{Kind, List, Shape, choice, record};
use super::spectrum::Spectrum;
use crate::error::Place;
use std::sync::Arc;

/// Greatest index of refraction: nothing clear has so much.
const GREATEST_INDEX: f64 = 10.0;
/// Most terms of a Sellmeier formula.
const MOST_TERMS: usize = 6;

words! {
    /// Clear stuff whose index of refraction is known.
    GlassName, "a glass" {
        /// Borosilicate crown, for lenses.
        "BK7" => Bk7;
        /// Dense flint: strong dispersion.
        "SF11" => Sf11;
        /// Quartz glass.
        "fused_silica" => FusedSilica;
        /// Diamond.
        "diamond" => Diamond;
        /// Water at 20 °C.
        "water" => Water;
    }
}

choice! {
    /// How light is refracted.
    pub Index, "a glass" {
        /// The index of refraction, the same at all wavelengths; 1 or more.
        index => Constant(f64) = RefractiveIndex, "1.5";
        /// By Cauchy: n = A + B/λ² + C/λ⁴, λ in µm; A, or A and B, or all three.
        cauchy => Cauchy([f64; 3]) = Cauchy, "1.5046 0.0042";
        /// By Sellmeier: n² = 1 + Σ Bλ²/(λ² - C), λ in µm: one to six pairs of B and C (in µm²).
        sellmeier => Sellmeier(Vec<[f64; 2]>) = List<Term>, "[[1.03961212, 0.00600069867], [0.231792344, 0.0200179144]]";
        /// As measured in something with a name.
        name => Named(GlassName) = GlassName, "BK7";
    }
}

record! {
    /// Something clear, such as glass.
    GlassKeys, "a glass" {
        @include index: Index, "How light is refracted.";
        /// What is left of white light after `distance` in it; all of it unless said.
        color: Option<Spanned<Arc<Spectrum>>> = Placed<Reflectance>, optional, "{ rgb: 0.2 0.8 0.3 }";
        /// The way in it after which `color` is left.
        distance: Option<Spanned<f64>> = Placed<Length>, optional, "10 cm";
        /// Whether it is a thin pane, which light goes straight through, and not the surface of something thick. It reflects as
        /// one face does, and `color` is what it lets through of the rest.
        thin: bool = Switch, default(false), "on";
    }
}

/// Something clear.
#[derive(Debug, Clone)]
pub struct Glass {
    /// Where it is written.
    pub place: Place,
    /// How light is refracted.
    pub index: Index,
    /// What is swallowed of it; none for nothing.
    pub color: Option<Tint>,
    /// Whether it is a thin pane, without refraction.
    pub thin: bool,
}

/// What clear stuff leaves of light.
#[derive(Debug, Clone)]
pub struct Tint {
    /// The part of the light, at each wavelength, that is left after `distance`.
    pub color: Arc<Spectrum>,
    /// Metres.
    pub distance: f64,
}

/// A glass: a name, an index of refraction, or a map.
pub(crate) struct GlassKind;

impl Kind for GlassKind {
    type Value = Glass;
    fn shape() -> Shape {
        Shape::Either(vec![GlassName::shape(), RefractiveIndex::shape(), GlassKeys::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Glass> {
        let plain = |index| Glass { place: node.place.clone(), index, color: None, thin: false };
        if is_number(node) {
            return RefractiveIndex::read(node, reader).map(|index| plain(Index::Constant(index)));
        }
        if node.text().is_some() {
            return GlassName::read(node, reader).map(|name| plain(Index::Named(name)));
        }
        let keys = GlassKeys::read(node, reader)?;
        let color = match (keys.color, keys.distance) {
            (None, None) => None,
            (Some(color), None) if keys.thin => Some(Tint { color: color.value, distance: 0.0 }),
            (Some(_), Some(distance)) if keys.thin => {
                let what = "a thin pane has no inside that light goes through over a distance";
                return Err(reader.fault(
                    &distance.place,
                    what,
                    "remove it: `color` is what the pane lets through",
                ));
            }
            (Some(color), Some(distance)) => Some(Tint { color: color.value, distance: distance.value }),
            (Some(color), None) => {
                let what = "after how much of this glass is that colour left?";
                return Err(reader.missing(&color.place, what, "distance: 10 cm"));
            }
            (None, Some(distance)) => {
                let what = "this glass has a `distance` but no `color` that is left after it";
                return Err(reader.missing(&distance.place, what, "color: { rgb: 0.2 0.8 0.3 }"));
            }
        };
        refracts(node, &keys.index, reader)?;
        Ok(Glass { place: keys.place, index: keys.index, color, thin: keys.thin })
    }
}

/// Faults a formula that gives no index of refraction somewhere in the visible.
fn refracts(node: &Node, index: &Index, reader: &mut Reader<'_>) -> Read<()> {
    let key = match index {
        Index::Cauchy(_) => "cauchy",
        Index::Sellmeier(terms) if terms.is_empty() || terms.len() > MOST_TERMS => {
            let place = node.get("sellmeier").map_or(&node.place, |terms| &terms.place);
            let what = format!("a Sellmeier formula has 1 to {MOST_TERMS} terms; here are {}", terms.len());
            return Err(reader.fault(place, what, "sellmeier: [[1.0396, 0.0060], [0.2318, 0.0200]]"));
        }
        Index::Sellmeier(_) => "sellmeier",
        Index::Constant(_) | Index::Named(_) => return Ok(()),
    };
    let place = node.get(key).map_or(&node.place, |formula| &formula.place);
    if let Index::Sellmeier(terms) = index {
        let mut resonances = terms.iter().map(|[_, c]| c.sqrt() * 1e3);
        if let Some(nm) = resonances.find(|nm| (380.0..=780.0).contains(nm)) {
            let what = format!("this formula has a resonance in the midst of the visible, at {nm:.0} nm");
            return Err(reader.fault(
                place,
                what,
                "the second number of each pair is the square of a wavelength in um",
            ));
        }
    }
    for nm in (380..=780).step_by(10) {
        let index = index_squared(index, f64::from(nm) * 1e-3);
        if !(1.0..=GREATEST_INDEX * GREATEST_INDEX).contains(&index) {
            let what = match index {
                x if x >= 0.0 => {
                    format!("by this formula the index of refraction at {nm} nm is {:.3}", x.sqrt())
                }
                _ => format!("by this formula there is no index of refraction at {nm} nm"),
            };
            let hint =
                format!("it is from 1 to {GREATEST_INDEX}, with wavelengths in um: `glass: BK7` is one");
            return Err(reader.fault(place, what, hint));
        }
    }
    Ok(())
}

/// The square of the index of refraction by a formula; wavelength in µm.
fn index_squared(index: &Index, wavelength: f64) -> f64 {
    let square = wavelength * wavelength;
    match index {
        Index::Cauchy([a, b, c]) => {
            let n = a + (b + c / square) / square;
            n * n.abs()
        }
        Index::Sellmeier(terms) => 1.0 + terms.iter().map(|[b, c]| b * square / (square - c)).sum::<f64>(),
        Index::Constant(_) | Index::Named(_) => 1.0,
    }
}

/// An index of refraction.
pub(crate) struct RefractiveIndex;

impl Kind for RefractiveIndex {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("an index of refraction, 1 or more")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let index = Real::read(node, reader)?;
        if (1.0..=GREATEST_INDEX).contains(&index) {
            return Ok(index);
        }
        let hint = reader.typed(&format!("1.5 (from 1 to {GREATEST_INDEX})"));
        Err(reader.fault(&node.place, format!("`{index}` is no index of refraction"), hint))
    }
}

/// One to three bare numbers; zero for the others.
struct Cauchy;

impl Kind for Cauchy {
    type Value = [f64; 3];
    fn shape() -> Shape {
        Shape::Text("one to three bare numbers, as in 1.5046 0.0042")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<[f64; 3]> {
        let text = reader.text(node, "a Cauchy formula", "1.5046 0.0042")?;
        let count = Written::of(text).numbers.len().clamp(1, 3);
        let mut numbers = reader.bare(node, "a Cauchy formula", count)?;
        numbers.resize(3, 0.0);
        <[f64; 3]>::try_from(numbers).map_err(|_| Reported)
    }
}

/// A term of a Sellmeier formula: B and C.
struct Term;

impl Kind for Term {
    type Value = [f64; 2];
    fn shape() -> Shape {
        Shape::List(|| Shape::Number("B, then C in µm²"))
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<[f64; 2]> {
        let numbers: Option<Vec<f64>> = match &node.content {
            Content::List(pair) => pair.iter().map(|number| number.text()?.parse().ok()).collect(),
            _ => None,
        };
        match numbers.as_deref() {
            Some(&[b, c]) if b.abs() <= 1e6 && (0.0..=1e6).contains(&c) => Ok([b, c]),
            _ => {
                let what = "a term is two numbers, B and C, with C in um2 and not below zero";
                Err(reader.fault(&node.place, what, "[1.03961212, 0.00600069867]"))
            }
        }
    }
}
