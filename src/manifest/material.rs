//! Materials as written.

use super::Spanned;
use super::light::{Glow, GlowKind};
use super::names::{self, Nameable, Names};
use super::node::Node;
use super::plain::NotNegative;
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, choice};
use super::spectrum::{Spectrum, SpectrumKind};
use crate::error::nearest_name;
use std::collections::BTreeMap;
use std::sync::Arc;

choice! {
    /// What a surface does with light.
    pub Material, "a material" {
        /// Scatters light alike to all sides: the part of it that is scattered, at each wavelength.
        diffuse => Diffuse(Arc<Spectrum>) = Reflectance, "0.8";
        /// Reflects light as a mirror: the part of it that is reflected, at each wavelength.
        mirror => Mirror(Arc<Spectrum>) = Reflectance, "0.9";
        /// Shines of itself.
        emission => Emission(Glow) = GlowKind, "{ luminance: 500 cd/m2 }";
    }
}

/// What part of the light is reflected: a bare number, or a spectrum that is nowhere above 1.
struct Reflectance;

impl Kind for Reflectance {
    type Value = Arc<Spectrum>;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Number("a part of the light, from 0 to 1"), SpectrumKind::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Spectrum>> {
        let numeric = node
            .text()
            .is_some_and(|text| text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)));
        let named = node.text().is_some_and(|text| reader.spectra.has(text));
        let spectrum = if numeric && !named {
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

/// A material: the name of one, or a map that says what it is.
pub(crate) struct MaterialKind;

impl Kind for MaterialKind {
    type Value = Arc<Material>;
    fn shape() -> Shape {
        let name = Shape::Text("the name of a material: mirror, or one of `materials`");
        Shape::Either(vec![name, Material::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Material>> {
        match node.text() {
            Some("mirror") if !reader.materials.has("mirror") => {
                Ok(Arc::new(Material::Mirror(Arc::new(Spectrum::Constant(1.0)))))
            }
            Some(name) if !reader.materials.has(name) && nearest_name(name, ["mirror"]).is_some() => {
                let what = format!("there is no material named `{name}`");
                Err(reader.fault(&node.place, what, "did you mean `mirror`?"))
            }
            Some(name) => names::find(&Spanned { value: name.to_owned(), place: node.place.clone() }, reader),
            None => Ok(Arc::new(<Material as Kind>::read(node, reader)?)),
        }
    }
}

impl Nameable for Material {
    const WHAT: &'static str = "material";
    const UNDER: &'static str = "materials";
    // `mirror` is known too, but may be given another meaning.
    const BUILT_IN: &'static [&'static str] = &[];
    fn names<'r>(reader: &'r mut Reader<'_>) -> &'r mut Names<Self> {
        &mut reader.materials
    }
    fn read_named(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Self>> {
        MaterialKind::read(node, reader)
    }
}

/// The materials that have names.
pub(crate) struct Materials;

impl Kind for Materials {
    type Value = BTreeMap<String, Arc<Material>>;
    fn shape() -> Shape {
        Shape::Map(MaterialKind::shape)
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        names::read_all(node, reader)
    }
}
