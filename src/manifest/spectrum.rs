//! Spectra as written: of light, or of what a surface reflects.

use super::Spanned;
use super::names::{self, Nameable, Names};
use super::node::{Content, Node};
use super::plain::{NotNegative, words};
use super::quantity::{Temperature, Wavelength};
use super::reader::{Read, Reader, Reported};
use super::record::{Kind, List, Shape, choice, record};
use super::table::{Rows, Table};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Parts that a spectrum may be made of in all, names written out.
const MOST_PARTS: usize = 1000;

/// A spectrum, names resolved.
#[derive(Debug, Clone, PartialEq)]
pub enum Spectrum {
    /// Planck's law at this temperature in kelvin.
    BlackBody(f64),
    /// A spectral line.
    Line(Line),
    /// Linear between these (wavelength in nm, value), wavelengths rising; zero outside.
    Table(Rows),
    /// The same value at all wavelengths.
    Constant(f64),
    /// A colour, linear sRGB.
    Rgb([f64; 3]),
    /// A named illuminant.
    Illuminant(Illuminant),
    /// The sum of these.
    Sum(Vec<Arc<Self>>),
    /// A multiple of another.
    Scaled {
        /// Multiplies every value.
        factor: f64,
        /// What is multiplied.
        of: Arc<Self>,
    },
}

/// A spectral line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Its wavelength, nm.
    pub centre_nm: f64,
    /// Its full width at half maximum, nm; none for a line without width.
    pub width_nm: Option<f64>,
}

words! {
    /// An illuminant with a name.
    Illuminant, "an illuminant" {
        /// Daylight (CIE 15:2018).
        "D65" => D65;
        /// Incandescent light: a black body at 2856 K (CIE 15:2018).
        "A" => A;
        /// The same power at all wavelengths.
        "E" => E;
    }
}

impl Spectrum {
    /// Daylight.
    pub const D65: Self = Self::Illuminant(Illuminant::D65);

    /// Parts it is made of, not counting beyond `most`.
    fn parts(&self, most: usize) -> usize {
        match self {
            Self::Sum(parts) => parts
                .iter()
                .fold(1, |count, part| if count > most { count } else { count + part.parts(most - count) }),
            Self::Scaled { of, .. } if most > 0 => 1 + of.parts(most - 1),
            _ => 1,
        }
    }

    /// Its largest value where that has a meaning: as a reflectance.
    pub(crate) fn peak(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            Self::Rgb(rgb) => Some(rgb.iter().fold(0.0, |most, x| x.max(most))),
            Self::Table(rows) => Some(rows.iter().fold(0.0, |most, (_, value)| value.max(most))),
            Self::Scaled { factor, of } => of.peak().map(|peak| peak * factor),
            _ => None,
        }
    }

    /// Whether there is light in it that no surface is described by: a black body or an illuminant.
    pub(crate) fn is_light(&self) -> bool {
        match self {
            Self::BlackBody(_) | Self::Illuminant(_) => true,
            Self::Sum(parts) => parts.iter().any(|part| part.is_light()),
            Self::Scaled { of, .. } => of.is_light(),
            _ => false,
        }
    }
}

choice! {
    /// What a spectrum is.
    Form, "a spectrum" {
        /// The temperature of a black body.
        black_body => BlackBody(f64) = Temperature, "5600 K";
        /// A spectral line: its wavelength, or its centre and width.
        line => Line(Line) = LineKind, "589 nm";
        /// A CSV file of wavelengths in nm and values, or a list of such pairs.
        table => Table(Rows) = Table, "spectra/lamp.csv";
        /// One value at all wavelengths.
        constant => Constant(f64) = NotNegative, "1";
        /// A colour, linear sRGB.
        rgb => Rgb([f64; 3]) = Rgb, "0.8 0.2 0.1";
        /// A colour as screens have it.
        srgb => Srgb([f64; 3]) = Srgb, "\"#ff8800\"";
        /// The sum of several.
        sum => Sum(Vec<Arc<Spectrum>>) = List<SpectrumKind>, "[D65, { line: 589 nm }]";
        /// Another spectrum, by name or written out: for use with `scale`.
        of => Of(Arc<Spectrum>) = SpectrumKind, "D65";
    }
}

record! {
    /// A spectrum: one of its forms, and what it is multiplied with.
    SpectrumKeys, "a spectrum" {
        @include form: Form, "Which form it has.";
        /// Multiplies every value.
        scale: f64 = NotNegative, default(1.0), "2";
    }
}

/// A spectrum: the name of one, or a map that says what it is.
pub(crate) struct SpectrumKind;

impl Kind for SpectrumKind {
    type Value = Arc<Spectrum>;
    fn shape() -> Shape {
        Shape::Either(vec![
            Shape::Text("the name of a spectrum: D65, A, E, or one of `spectra`"),
            SpectrumKeys::shape(),
        ])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Spectrum>> {
        if let Some(name) = node.text() {
            return match name {
                "D65" | "A" | "E" => Ok(Arc::new(Spectrum::Illuminant(Illuminant::read(node, reader)?))),
                _ => names::find(&Spanned { value: name.to_owned(), place: node.place.clone() }, reader),
            };
        }
        let keys = SpectrumKeys::read(node, reader)?;
        let spectrum = match keys.form {
            Form::BlackBody(kelvin) => Spectrum::BlackBody(kelvin),
            Form::Line(line) => Spectrum::Line(line),
            Form::Table(rows) => Spectrum::Table(rows),
            Form::Constant(value) => Spectrum::Constant(value),
            Form::Rgb(rgb) | Form::Srgb(rgb) => Spectrum::Rgb(rgb),
            Form::Sum(parts) => Spectrum::Sum(parts),
            Form::Of(of) => return multiple(keys.scale, of, node, reader),
        };
        multiple(keys.scale, Arc::new(spectrum), node, reader)
    }
}

/// A multiple of a spectrum, if it is not too large: names can double what they stand for at every step.
fn multiple(factor: f64, of: Arc<Spectrum>, node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Spectrum>> {
    if of.parts(MOST_PARTS) > MOST_PARTS {
        let what = format!("a spectrum of more than {MOST_PARTS} parts, names written out");
        return Err(reader.fault(&node.place, what, "write the sum as a table"));
    }
    let plain = factor.to_bits() == 1.0_f64.to_bits();
    Ok(if plain { of } else { Arc::new(Spectrum::Scaled { factor, of }) })
}

impl Nameable for Spectrum {
    const WHAT: &'static str = "spectrum";
    const UNDER: &'static str = "spectra";
    const BUILT_IN: &'static [&'static str] = &["D65", "A", "E"];
    fn names<'r>(reader: &'r mut Reader<'_>) -> &'r mut Names<Self> {
        &mut reader.spectra
    }
    fn read_named(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Self>> {
        SpectrumKind::read(node, reader)
    }
}

/// The spectra that have names.
pub(crate) struct Spectra;

impl Kind for Spectra {
    type Value = BTreeMap<String, Arc<Spectrum>>;
    fn shape() -> Shape {
        Shape::Map(SpectrumKind::shape)
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        names::read_all(node, reader)
    }
}

record! {
    /// A spectral line with a width.
    LineKeys, "a spectral line" {
        /// Its wavelength.
        centre: f64 = Wavelength, required, "589 nm";
        /// Its full width at half maximum; none if left out.
        width: Option<f64> = Wavelength, optional, "20 nm";
    }
}

struct LineKind;

impl Kind for LineKind {
    type Value = Line;
    fn shape() -> Shape {
        Shape::Either(vec![Wavelength::shape(), LineKeys::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Line> {
        if matches!(node.content, Content::Map(_)) {
            let keys = LineKeys::read(node, reader)?;
            return Ok(Line { centre_nm: keys.centre, width_nm: keys.width });
        }
        Ok(Line { centre_nm: Wavelength::read(node, reader)?, width_nm: None })
    }
}

struct Rgb;

impl Kind for Rgb {
    type Value = [f64; 3];
    fn shape() -> Shape {
        Shape::Text("red, green and blue, linear, as in 0.8 0.2 0.1")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<[f64; 3]> {
        let rgb = reader.bare(node, "a colour", 3)?;
        if rgb.iter().any(|x| *x < 0.0) {
            let right: Vec<_> = rgb.iter().map(|x| x.max(0.0).to_string()).collect();
            let hint = reader.typed(&right.join(" "));
            return Err(reader.fault(&node.place, "a colour has no part below zero", hint));
        }
        <[f64; 3]>::try_from(rgb).map_err(|_| Reported)
    }
}

struct Srgb;

impl Kind for Srgb {
    type Value = [f64; 3];
    fn shape() -> Shape {
        Shape::Text("a colour as \"#rrggbb\"")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<[f64; 3]> {
        let text = reader.text(node, "a colour", "\"#ff8800\"")?;
        hexadecimal(text).ok_or_else(|| {
            let hint = reader.typed("\"#ff8800\"");
            reader.fault(&node.place, format!("`{text}` is not a colour as #rrggbb"), hint)
        })
    }
}

/// `#rrggbb` as linear sRGB.
fn hexadecimal(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let part = |at: usize| digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok());
    let linear = |byte: u8| crate::color::srgb_decode(f64::from(byte) / 255.0);
    Some([linear(part(0)?), linear(part(2)?), linear(part(4)?)])
}
