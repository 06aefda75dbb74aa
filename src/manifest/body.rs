//! Assets and bodies as written.

use super::Spanned;
use super::light::{Glow, GlowKind};
use super::list::each;
use super::material::{AnyMaterial, Material};
use super::motion::Placement;
use super::node::{Content, Node};
use super::plain::{FilePath, Placed, Scale, Switch, Text};
use super::reader::{Read, Reader, instead};
use super::record::{Entries, Field, Kind, List, Named, Presence, Record, Shape, record};
use super::solid::{self, Pose, Solid, SolidForm};
use super::swarm::{self, Swarm};
use crate::error::Place;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What bodies are copies of.
#[derive(Debug, Clone)]
pub struct AssetRef {
    /// Where it is written.
    pub place: Place,
    /// A model file or a shape.
    pub source: AssetSource,
}

/// Where an asset comes from.
#[derive(Debug, Clone)]
pub enum AssetSource {
    /// A model file, or a part of one.
    File(ModelFile),
    /// A shape that is described in the manifest.
    Solid(Solid),
}

/// A model file, or a part of one.
#[derive(Debug, Clone)]
pub struct ModelFile {
    /// The file: `.glb`, `.gltf` or `.obj`.
    pub file: Spanned<PathBuf>,
    /// Only this node of the file, and its children.
    pub node: Option<Spanned<String>>,
    /// Whether the lights in the file come along.
    pub lights: bool,
}

impl AssetRef {
    /// Its model file; none for a shape.
    pub fn file(&self) -> Option<&ModelFile> {
        match &self.source {
            AssetSource::File(file) => Some(file),
            AssetSource::Solid(_) => None,
        }
    }

    /// Its shape; none for a model file.
    pub fn solid(&self) -> Option<&Solid> {
        match &self.source {
            AssetSource::File(_) => None,
            AssetSource::Solid(solid) => Some(solid),
        }
    }
}

/// Where an asset comes from, as written: `file`, or one of the keys of a shape.
#[derive(Debug, Clone)]
enum SourceKeys {
    File(Spanned<PathBuf>),
    Form(SolidForm),
}

impl Record for SourceKeys {
    const TITLE: &'static str = "an asset";
    const DOC: &'static str = "Where an asset comes from.";
    fn fields() -> Vec<Field> {
        let file = Field {
            key: "file",
            doc: "A model file: `.glb`, `.gltf` or `.obj`.",
            example: "models/monkey.glb",
            presence: Presence::Alternative,
            group: Self::TITLE,
            shape: FilePath::shape,
        };
        let forms = SolidForm::fields().into_iter().map(|form| Field { group: Self::TITLE, ..form });
        std::iter::once(file).chain(forms).collect()
    }
    fn take(entries: &Entries<'_>, reader: &mut Reader<'_>) -> Read<Self> {
        let given = entries.one_of(Self::TITLE, &Self::fields(), false, reader)?;
        if given == Some("file") {
            let key = ("file", "models/monkey.glb");
            return entries.required::<Placed<FilePath>>(Self::TITLE, key, reader).map(Self::File);
        }
        SolidForm::take(entries, reader).map(Self::Form)
    }
}

record! {
    /// What else is said of a model file.
    OfFile, "an asset" {
        /// Only this node of the file, and its children.
        node: Option<Spanned<String>> = Placed<Text>, optional, "Floor";
        /// Whether the lights in the file come along.
        lights: bool = Switch, default(true), "off";
    }
}

record! {
    /// What bodies are copies of: a model file, a part of one, or a shape.
    AssetKeys, "an asset" {
        @include source: SourceKeys, "Where it comes from.";
        @include of_file: OfFile, "What else is said of a file.";
        @include pose: Pose, "Where a shape is from the body's origin.";
    }
}

/// An asset: a path, a map, or the word `plane`.
struct AssetKind;

impl Kind for AssetKind {
    type Value = AssetRef;
    fn shape() -> Shape {
        Shape::Either(vec![FilePath::shape(), AssetKeys::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<AssetRef> {
        let place = node.place.clone();
        if !matches!(node.content, Content::Map(_)) {
            if let Some(solid) = solid::alone(node, reader)? {
                return Ok(AssetRef { place, source: AssetSource::Solid(solid) });
            }
            let file = Placed::<FilePath>::read(node, reader)?;
            let file = ModelFile { file, node: None, lights: true };
            return Ok(AssetRef { place, source: AssetSource::File(file) });
        }
        let AssetKeys { source, of_file, pose, .. } = AssetKeys::read(node, reader)?;
        let source = match source {
            SourceKeys::File(file) => {
                let hint = "give it to the bodies that are made of it";
                unwanted(node, &["at", "rotation"], "a model file", hint, reader)?;
                AssetSource::File(ModelFile { file, node: of_file.node, lights: of_file.lights })
            }
            SourceKeys::Form(form) => {
                unwanted(node, &["node", "lights"], "a shape", "it is for model files: remove it", reader)?;
                AssetSource::Solid(solid::checked(Solid { place: place.clone(), form, pose }, reader)?)
            }
        };
        Ok(AssetRef { place, source })
    }
}

/// Faults keys that make no sense here.
fn unwanted(node: &Node, keys: &[&str], what: &str, hint: &str, reader: &mut Reader<'_>) -> Read<()> {
    match keys.iter().find_map(|key| Some((key, node.get(key)?))) {
        Some((key, value)) => Err(reader.fault(&value.place, format!("{what} has no `{key}`"), hint)),
        None => Ok(()),
    }
}

/// The assets, under the names by which bodies ask for them.
pub(crate) struct Assets;

impl Kind for Assets {
    type Value = BTreeMap<String, AssetRef>;
    fn shape() -> Shape {
        Named::<AssetKind>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        if let Content::Map(entries) = &node.content {
            reader.assets = entries.iter().map(|entry| entry.key.clone()).collect();
            let solids = entries.iter().filter(|entry| solid::is_solid(&entry.value));
            reader.solids = solids.map(|entry| entry.key.clone()).collect();
        }
        Named::<RestAsset>::read(node, reader)
    }
}

/// An asset that is remembered where others have faults.
struct RestAsset;

impl Kind for RestAsset {
    type Value = AssetRef;
    fn shape() -> Shape {
        AssetKind::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<AssetRef> {
        let asset = AssetKind::read(node, reader)?;
        let name = reader.key().unwrap_or_default().to_owned();
        reader.rest.assets.insert(name, asset.clone());
        Ok(asset)
    }
}

record! {
    /// A copy of an asset that moves at constant velocity.
    pub Body, "a body" {
        @include placement: Placement, "Where it is and how it moves.";
        /// The name of what it is a copy of.
        asset: Spanned<String> = AssetName, required, "monkey";
        /// Its own name; that of its asset unless said.
        name: Option<String> = Text, optional, "left_monkey";
        /// Its size in its rest frame: one factor, or one for each axis.
        scale: DVec3 = Scale, default(DVec3::ONE), "2";
        /// Its material, instead of those of its file: a name or a map.
        material: Option<Arc<Material>> = AnyMaterial, optional, "mirror";
        /// Materials instead of single ones of its file, by the names that these have there.
        materials: Vec<(Spanned<String>, Arc<Material>)> = FileMaterials, default(Vec::new()), "{ Skin: mirror }";
        /// Light that falls on it from all sides alike, in its rest frame, instead of that which falls on all bodies.
        ambient: Option<Glow> = GlowKind, optional, "{ luminance: 20 cd/m2 }";
        /// Not one of it but many, each with a place, a turn and a velocity of its own.
        swarm: Option<Swarm> = Swarm, optional, "{ count: 10000, within: 20 4 20 m, speed: 0.6 c }";
    }
}

impl Body {
    /// The name by which it is known.
    pub fn known_as(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.asset.value)
    }
}

/// The name of an asset.
pub(super) struct AssetName;

impl Kind for AssetName {
    type Value = Spanned<String>;
    fn shape() -> Shape {
        Shape::Text("the name of an asset, one of `assets`")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Spanned<String>> {
        let name = Placed::<Text>::read(node, reader)?;
        if reader.assets.contains(&name.value) {
            return Ok(name);
        }
        let known = reader.assets.iter().map(String::as_str);
        let hint = if reader.suggests() { instead(&name.value, known, "assets") } else { String::new() };
        Err(reader.missing(&name.place, format!("there is no asset named `{}`", name.value), hint))
    }
}

/// Materials by the names that those of a file have.
struct FileMaterials;

impl Kind for FileMaterials {
    type Value = Vec<(Spanned<String>, Arc<Material>)>;
    fn shape() -> Shape {
        Named::<AnyMaterial>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        let mut named = Named::<AnyMaterial>::read(node, reader)?;
        let Content::Map(entries) = &node.content else { return Ok(Vec::new()) };
        let place = |entry: &super::node::Entry| entry.key_place.clone();
        Ok(entries
            .iter()
            .filter_map(|entry| {
                let material = named.remove(&entry.key)?;
                Some((Spanned { value: entry.key.clone(), place: place(entry) }, material))
            })
            .collect())
    }
}

/// Bodies that are looked at though others have faults.
const MOST_OF_REST: usize = 1000;

/// The bodies, whose names are known from here on.
pub(crate) struct Bodies;

impl Kind for Bodies {
    type Value = Vec<Body>;
    fn shape() -> Shape {
        List::<Body>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Vec<Body>> {
        let Content::List(items) = &node.content else { return List::<Body>::read(node, reader) };
        // Names are taken from the text, so that a fault elsewhere in a body does not make its name unknown.
        let name = |item: &Node, key: &str| item.get(key).and_then(|node| node.text()).map(str::to_owned);
        let known_as = |item: &Node| name(item, "name").or_else(|| name(item, "asset")).unwrap_or_default();
        reader.bodies = items.iter().map(|item| known_as(item)).collect();
        let mut own = BTreeMap::new();
        let mut sound = Ok(());
        for item in items {
            let (Some(name), Some(node)) = (name(item, "name"), item.get("name")) else { continue };
            if let Some(first) = own.get(&name) {
                let (what, hint) =
                    (format!("another body is named `{name}` already"), format!("name: {name}_2"));
                sound = Err(reader.fault_and(&node.place, (*first, "the other one"), what, hint));
            } else {
                own.insert(name, &node.place);
            }
        }
        for item in items {
            sound = sound.and(swarm::check(item, reader));
            if name(item, "asset").is_some_and(|asset| reader.solids.contains(&asset))
                && let Some(materials) = item.get("materials")
            {
                let what = "a shape is all of one material, without a name";
                sound = Err(reader.fault(&materials.place, what, "material: mirror"));
            }
        }
        let (bodies, all) = each::<Body>(items, reader);
        reader.rest.bodies = bodies.iter().take(MOST_OF_REST).cloned().collect();
        all.and(sound).map(|()| bodies)
    }
}
