//! Materials as written.

use super::Spanned;
use super::course::{Blinking, Rising, Timed};
use super::glass::{Glass, GlassKind};
use super::light::{Glow, GlowKind};
use super::names::{self, Nameable, Names};
use super::node::Node;
use super::paint::{Paint, PaintKind, is_number};
use super::plain::{Part, Placed, words};
use super::quantity::Instant;
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, choice, record};
use super::spectrum::Spectrum;
use crate::error::{Place, nearest_name};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A material.
#[derive(Debug, Clone)]
pub struct Material {
    /// Where it is written.
    pub place: Place,
    /// What it does with light.
    pub kind: MaterialKind,
    /// What it does, as far as it is described by a colour or a picture, with light below 380 nm.
    pub ultraviolet: Beyond,
    /// The same above 780 nm.
    pub infrared: Beyond,
}

choice! {
    /// What a surface does with light.
    pub MaterialKind, "a material", otherwise(MaterialKind::Imported) {
        @unit Imported, "What the file says.";
        /// Scatters light alike to all sides: the part of it that is scattered, at each wavelength.
        diffuse => Diffuse(Paint) = PaintKind, "0.8";
        /// Reflects light as a mirror: the part of it that is reflected, at each wavelength.
        mirror => Mirror(Paint) = PaintKind, "0.9";
        /// Reflects light as a metal does by its measured index: a smooth mirror, or with `roughness` a dull one.
        metal => Metal(Metal) = Metal, "gold";
        /// Scatters light below a clear coat that reflects some of it.
        gloss => Gloss(Gloss) = Gloss, "{ base: 0.8 }";
        /// Lets light through, and reflects some of it.
        glass => Glass(Glass) = GlassKind, "BK7";
        /// Shines of itself.
        emission => Emission(Glow) = GlowKind, "{ luminance: 500 cd/m2 }";
        /// Two materials in turn, on the body's own clock.
        blinking => Blinking(BlinkingMaterial) = BlinkingMaterial,
            "{ period: 2 s, on: { emission: { luminance: 500 cd/m2 } }, off: { diffuse: 0.02 } }";
        /// Materials at several of the body's own times, in their order; mixed linearly between one and the next.
        keys => Keys(Vec<MaterialKey>) = Rising<MaterialKey>,
            "[{ at: 0 s, material: { diffuse: 0.8 } }, { at: 2 s, material: { diffuse: 0.1 } }]";
    }
}

record! {
    /// What else is said of a material.
    Besides, "a material" {
        /// How dull a metal is, from 0 (a smooth mirror, unless said) to 1.
        roughness: Option<Spanned<f64>> = Placed<Part>, optional, "0.2";
        /// What a surface described by a colour or a picture does with light below 380 nm: `mean` (unless said: the mean of red, green and blue), `hold` (as at 380 nm) or a part of the light.
        ultraviolet: Option<Spanned<Beyond>> = Placed<Beyond>, optional, "hold";
        /// The same above 780 nm.
        infrared: Option<Spanned<Beyond>> = Placed<Beyond>, optional, "0.5";
    }
}

record! {
    /// What a surface does with light. With nothing but `ultraviolet` or `infrared`, it is otherwise as the file has it.
    MaterialKeys, "a material" {
        @include kind: MaterialKind, "What it does with light.";
        @include besides: Besides, "What else is said.";
    }
}

/// What a surface described by a colour or a picture does with light that no eye sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beyond {
    /// As the mean of red, green and blue.
    Mean,
    /// As at the end of the visible.
    Hold,
    /// Reflects this part of it.
    Value(f64),
}

impl Kind for Beyond {
    type Value = Self;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Words(&["mean", "hold"]), Part::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        if is_number(node) {
            return Part::read(node, reader).map(Self::Value);
        }
        match reader.text(node, "what a surface does with light that no eye sees", "mean")? {
            "mean" => Ok(Self::Mean),
            "hold" => Ok(Self::Hold),
            other => {
                let nearest = nearest_name(other, ["mean", "hold"]).unwrap_or("mean");
                let hint = format!("{} (or hold, or a number from 0 to 1)", reader.typed(nearest));
                let hint = if nearest == "hold" { hint.replace("or hold", "or mean") } else { hint };
                let what = format!("`{other}` is neither mean nor hold nor a part of the light");
                Err(reader.fault(&node.place, what, hint))
            }
        }
    }
}

words! {
    /// A metal whose index of refraction has been measured.
    MetalName, "a metal" {
        /// Gold.
        "gold" => Gold;
        /// Silver.
        "silver" => Silver;
        /// Copper.
        "copper" => Copper;
        /// Aluminium.
        "aluminium" => Aluminium;
    }
}

/// A metal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metal {
    /// Which.
    pub name: MetalName,
    /// From 0 (a smooth mirror) to 1.
    pub roughness: f64,
}

impl Kind for Metal {
    type Value = Self;
    fn shape() -> Shape {
        MetalName::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        Ok(Self { name: MetalName::read(node, reader)?, roughness: 0.0 })
    }
}

record! {
    /// A surface that scatters light, below a clear coat.
    pub Gloss, "a gloss" {
        /// What is below: the part of the light that is scattered.
        base: Paint = PaintKind, required, "0.8";
        /// How dull the coat is, from 0 (a smooth mirror) to 1: 0.3 unless said.
        roughness: f64 = Part, default(0.3), "0.1";
        /// The index of refraction of the coat: 1.5 unless said.
        index: f64 = super::glass::RefractiveIndex, default(1.5), "1.5";
    }
}

record! {
    /// Two materials in turn, on the body's own clock: that reads zero where it passes its `at`.
    pub BlinkingMaterial, "a blinking material" {
        @include blinking: Blinking, "When it is which.";
        /// The material while it is lit.
        on: Arc<Material> = Steady, required, "{ emission: { luminance: 500 cd/m2 } }";
        /// The material while it is not.
        off: Arc<Material> = Steady, required, "{ diffuse: 0.02 }";
    }
}

record! {
    /// A material at one time.
    pub MaterialKey, "a moment of a material" {
        /// When, on the body's own clock, metres of light travel.
        at: f64 = Instant, required, "2 s";
        /// What it is like then.
        material: Arc<Material> = Steady, required, "{ diffuse: 0.1 }";
    }
}

impl Timed for MaterialKey {
    fn at(&self) -> f64 {
        self.at
    }
}

impl Material {
    /// A material that is described in full by its kind.
    fn plain(place: &Place, kind: MaterialKind) -> Self {
        Self { place: place.clone(), kind, ultraviolet: Beyond::Mean, infrared: Beyond::Mean }
    }

    /// Whether it is another at another time.
    pub fn changes(&self) -> bool {
        matches!(self.kind, MaterialKind::Blinking(_) | MaterialKind::Keys(_))
    }
}

impl Kind for Material {
    type Value = Self;
    fn shape() -> Shape {
        MaterialKeys::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        let MaterialKeys { place, kind, besides } = MaterialKeys::read(node, reader)?;
        let beyond = besides.ultraviolet.as_ref().or(besides.infrared.as_ref());
        let mut material = Self::plain(&place, kind);
        match (&mut material.kind, &besides.roughness) {
            (MaterialKind::Metal(metal), Some(roughness)) => metal.roughness = roughness.value,
            (_, Some(roughness)) => {
                let hint = "metal: gold, or gloss: { base: 0.8, roughness: 0.3 }";
                return Err(reader.missing(&roughness.place, "`roughness` is for metals", hint));
            }
            (MaterialKind::Imported, None) if beyond.is_none() => {
                let kinds = super::record::keys::<MaterialKind>();
                let what = format!("a material needs one of {kinds}");
                return Err(reader.missing(&place, what, "diffuse: 0.8"));
            }
            _ => {}
        }
        if let (true, Some(beyond)) = (material.changes(), beyond) {
            let what = "each of the materials that it changes between says this for itself";
            let hint = "off: { diffuse: 0.8, infrared: hold }";
            return Err(reader.fault(&beyond.place, what, hint));
        }
        material.ultraviolet = besides.ultraviolet.map_or(Beyond::Mean, |beyond| beyond.value);
        material.infrared = besides.infrared.map_or(Beyond::Mean, |beyond| beyond.value);
        Ok(material)
    }
}

/// A material: the name of one, or a map that says what it is.
pub(crate) struct AnyMaterial;

impl Kind for AnyMaterial {
    type Value = Arc<Material>;
    fn shape() -> Shape {
        let name = Shape::Text("the name of a material: mirror, or one of `materials`");
        Shape::Either(vec![name, Material::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Material>> {
        match node.text() {
            Some("mirror") if !reader.materials.has("mirror") => {
                let perfect = Paint::Even(Arc::new(Spectrum::Constant(1.0)));
                Ok(Arc::new(Material::plain(&node.place, MaterialKind::Mirror(perfect))))
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

/// A material that does not change.
struct Steady;

impl Kind for Steady {
    type Value = Arc<Material>;
    fn shape() -> Shape {
        AnyMaterial::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Material>> {
        let material = AnyMaterial::read(node, reader)?;
        if !material.changes() {
            return Ok(material);
        }
        let what = "a material that changes cannot be part of another that does";
        Err(reader.fault(&node.place, what, "put all of its times into one list of `keys`"))
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
        AnyMaterial::read(node, reader)
    }
}

/// The materials that have names.
pub(crate) struct Materials;

impl Kind for Materials {
    type Value = BTreeMap<String, Arc<Material>>;
    fn shape() -> Shape {
        Shape::Map(AnyMaterial::shape)
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        names::read_all(node, reader)
    }
}
