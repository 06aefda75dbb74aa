//! Lights as written.

use super::Spanned;
use super::course::Course;
use super::motion::Placement;
use super::node::Node;
use super::plain::{Direction, Placed};
use super::quantity::{ConeAngle, Quantity, Temperature};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, choice, record};
use super::spectrum::{Spectrum, SpectrumKind};
use super::units::Dimension;
use crate::error::Place;
use glam::DVec3;
use std::sync::Arc;

/// A measure of light: as the eye weighs it, or as power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amount {
    /// In cd, lm, lx or cd/m².
    Photometric(f64),
    /// In W/sr, W, W/m² or W/m²/sr.
    Radiometric(f64),
}

/// How strong a lamp is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strength {
    /// To each side: cd or W/sr.
    Intensity(Amount),
    /// To all sides together: lm or W.
    Total(Amount),
}

record! {
    /// A light that moves like a body.
    pub Light, "a light" {
        @include source: LightSource, "What kind of light it is.";
        @include placement: Placement, "Where it is and how it moves.";
        @include course: Course, "How it changes.";
    }
}

choice! {
    /// What kind of light it is.
    pub LightSource, "a light" {
        /// A point that shines alike to all sides.
        lamp => Lamp(Lamp) = Lamp, "{ intensity: 300 cd }";
        /// A point that shines into a cone.
        spot => Spot(Spot) = Spot, "{ intensity: 300 cd, cone: 40 deg }";
        /// Parallel light from far away.
        sun => Sun(Sun) = Sun, "{ illuminance: 1000 lx, direction: -1 -2 -3 }";
    }
}

record! {
    /// A point that shines alike to all sides in its rest frame.
    pub Lamp, "a lamp" {
        /// Its strength: to each side in cd or W/sr, or in total in lm or W.
        intensity: Strength = LampStrength, required, "300 cd";
        /// Its light; daylight (D65) unless said.
        spectrum: Arc<Spectrum> = SpectrumKind, default(Arc::new(Spectrum::D65)), "{ black_body: 5600 K }";
    }
}

record! {
    /// A point that shines into a cone in its rest frame.
    SpotKeys, "a spot" {
        @include lamp: Lamp, "Strength and spectrum.";
        /// The middle of the cone: the way the light goes, in the light's own axes.
        direction: DVec3 = Direction, default(DVec3::NEG_Y), "0 -1 0";
        /// The full angle of the cone, outside of which there is no light.
        cone: f64 = ConeAngle, required, "40 deg";
        /// The full angle within which there is all of the light; that of the cone unless said.
        inner: Option<f64> = ConeAngle, optional, "30 deg";
    }
}

/// A point that shines into a cone in its rest frame.
#[derive(Debug, Clone)]
pub struct Spot {
    /// Strength along the middle of the cone, or in total into the cone, and spectrum.
    pub lamp: Lamp,
    /// The middle of the cone: the way the light goes, in the light's own axes; a unit vector.
    pub direction: DVec3,
    /// The full angle, radians, outside of which there is no light.
    pub cone: f64,
    /// The full angle, radians, within which there is all of the light.
    pub inner: f64,
}

impl Kind for Spot {
    type Value = Self;
    fn shape() -> Shape {
        SpotKeys::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        let keys = SpotKeys::read(node, reader)?;
        let inner = keys.inner.unwrap_or(keys.cone);
        if inner > keys.cone {
            let place = node.get("inner").map_or(&node.place, |inner| &inner.place);
            let cone = node.get("cone").and_then(|cone| cone.text()).unwrap_or_default();
            let hint = format!("inner: {cone} (or less)");
            return Err(reader.fault(place, "the inner cone is wider than the cone", hint));
        }
        Ok(Self { lamp: keys.lamp, direction: keys.direction, cone: keys.cone, inner })
    }
}

record! {
    /// Parallel light from far away.
    pub Sun, "a sun" {
        /// Its strength on a surface that faces it, at rest in the light's frame: lx or W/m2.
        illuminance: Amount = Illuminance, required, "1000 lx";
        /// Its light; daylight (D65) unless said.
        spectrum: Arc<Spectrum> = SpectrumKind, default(Arc::new(Spectrum::D65)), "{ black_body: 5778 K }";
        /// The way the light goes, in the light's own axes; a unit vector.
        direction: DVec3 = Direction, default(DVec3::NEG_Y), "-1 -2 -3";
    }
}

/// Light from a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Glow {
    /// Where it is written.
    pub place: Place,
    /// Its brightness: cd/m² or W/m²/sr.
    pub brightness: Amount,
    /// Its spectrum.
    pub spectrum: Arc<Spectrum>,
}

choice! {
    /// How bright a surface is.
    Brightness, "this light" {
        /// Its luminance (or, in W/m2/sr, its radiance).
        luminance => Luminance(Amount) = Luminance, "500 cd/m2";
        /// Its radiance.
        radiance => Radiance(Amount) = Radiance, "3 W/m2/sr";
        /// The temperature of a black body, which says both how bright it is and of what spectrum.
        black_body => BlackBody(f64) = Temperature, "5778 K";
    }
}

record! {
    /// Light from a surface: how bright, and of what spectrum.
    GlowKeys, "this light" {
        @include brightness: Brightness, "How bright.";
        /// Its light; daylight (D65) unless said.
        spectrum: Option<Spanned<Arc<Spectrum>>> = Placed<SpectrumKind>, optional, "{ black_body: 3000 K }";
    }
}

/// Light from a surface, or from everywhere.
pub(crate) struct GlowKind;

impl Kind for GlowKind {
    type Value = Glow;
    fn shape() -> Shape {
        GlowKeys::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Glow> {
        let keys = GlowKeys::read(node, reader)?;
        let (brightness, spectrum) = match (keys.brightness, keys.spectrum) {
            (Brightness::BlackBody(_), Some(spectrum)) => {
                let what = "the temperature of a black body says its spectrum already";
                return Err(reader.fault(&spectrum.place, what, "remove `spectrum`, or give a `luminance`"));
            }
            (Brightness::BlackBody(kelvin), None) => {
                let radiance = crate::spectrum::Spectrum::BlackBody(kelvin).total().unwrap_or_default();
                (Amount::Radiometric(radiance), Arc::new(Spectrum::BlackBody(kelvin)))
            }
            (Brightness::Luminance(amount) | Brightness::Radiance(amount), spectrum) => {
                let spectrum = spectrum.map(|spectrum| spectrum.value);
                (amount, spectrum.unwrap_or_else(|| Arc::new(Spectrum::D65)))
            }
        };
        Ok(Glow { place: keys.place, brightness, spectrum })
    }
}

/// Reads an amount of light, zero or more, and says in which dimension it was written.
fn amount(node: &Node, quantity: &Quantity, reader: &mut Reader<'_>) -> Read<(Amount, Dimension)> {
    use Dimension::{Flux, Illuminance, Intensity, Luminance};
    let (numbers, dimension) = reader.quantity(node, quantity)?;
    let number = numbers.first().copied().unwrap_or_default();
    if !(0.0..=1e30).contains(&number) {
        let hint = reader.typed(&format!("300 {}", quantity.unit));
        let what = format!("`{}` is out of range", node.text().unwrap_or_default());
        return Err(reader.fault(&node.place, what, hint));
    }
    let photometric = matches!(dimension, Flux | Illuminance | Intensity | Luminance);
    Ok((if photometric { Amount::Photometric(number) } else { Amount::Radiometric(number) }, dimension))
}

/// Declares kinds that are an amount of light.
macro_rules! amounts {
    ($( $(#[doc = $doc:literal])* $name:ident: $what:literal, [$($dimension:ident),*], $unit:literal; )*) => {$(
        $(#[doc = $doc])*
        pub(crate) struct $name;
        impl $name {
            const QUANTITY: Quantity =
                Quantity { what: $what, count: 1, dimensions: &[$(Dimension::$dimension),*], unit: $unit };
        }
        impl Kind for $name {
            type Value = Amount;
            fn shape() -> Shape {
                Shape::Text(concat!($what, " with its unit, in ", $unit, " for example"))
            }
            fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Amount> {
                Ok(amount(node, &Self::QUANTITY, reader)?.0)
            }
        }
    )*};
}

amounts! {
    /// lx or W/m².
    Illuminance: "an illuminance", [Illuminance, Irradiance], "lx";
    /// cd/m² or W/m²/sr.
    Luminance: "a luminance", [Luminance, Radiance], "cd/m2";
    /// W/m²/sr.
    Radiance: "a radiance", [Radiance], "W/m2/sr";
}

struct LampStrength;

impl Kind for LampStrength {
    type Value = Strength;
    fn shape() -> Shape {
        Shape::Text("a strength with its unit: cd or W/sr to each side, lm or W in total")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Strength> {
        use Dimension::{Flux, Intensity, Power, RadiantIntensity};
        const QUANTITY: Quantity = Quantity {
            what: "the strength of a lamp",
            count: 1,
            dimensions: &[Intensity, RadiantIntensity, Flux, Power],
            unit: "cd",
        };
        let (amount, dimension) = amount(node, &QUANTITY, reader)?;
        let total = matches!(dimension, Flux | Power);
        Ok(if total { Strength::Total(amount) } else { Strength::Intensity(amount) })
    }
}
