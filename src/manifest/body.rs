//! Assets and bodies as written.

use super::Spanned;
use super::material::{Material, MaterialKind};
use super::motion::Placement;
use super::node::{Content, Node};
use super::plain::{FilePath, Placed, Scale, Switch, Text};
use super::reader::{Read, Reader, instead};
use super::record::{Kind, List, Named, Shape, record};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

record! {
    /// A model file, or a part of one.
    pub AssetRef, "an asset" {
        /// The file: `.glb`, `.gltf` or `.obj`.
        file: Spanned<PathBuf> = Placed<FilePath>, required, "models/monkey.glb";
        /// Only this node of the file, and its children.
        node: Option<Spanned<String>> = Placed<Text>, optional, "Floor";
        /// Whether the lights in the file come along.
        lights: bool = Switch, default(true), "off";
    }
}

/// An asset: a path, or a map.
struct AssetKind;

impl Kind for AssetKind {
    type Value = AssetRef;
    fn shape() -> Shape {
        Shape::Either(vec![FilePath::shape(), AssetRef::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<AssetRef> {
        if let Content::Map(_) = node.content {
            return <AssetRef as Kind>::read(node, reader);
        }
        let file = Placed::<FilePath>::read(node, reader)?;
        Ok(AssetRef { place: node.place.clone(), file, node: None, lights: true })
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
        }
        Named::<AssetKind>::read(node, reader)
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
        material: Option<Arc<Material>> = MaterialKind, optional, "mirror";
        /// Materials instead of single ones of its file, by the names that these have there.
        materials: Vec<(Spanned<String>, Arc<Material>)> = FileMaterials, default(Vec::new()), "{ Skin: mirror }";
    }
}

impl Body {
    /// The name by which it is known.
    pub fn known_as(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.asset.value)
    }
}

/// The name of an asset.
struct AssetName;

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
        Err(reader.fault(&name.place, format!("there is no asset named `{}`", name.value), hint))
    }
}

/// Materials by the names that those of a file have.
struct FileMaterials;

impl Kind for FileMaterials {
    type Value = Vec<(Spanned<String>, Arc<Material>)>;
    fn shape() -> Shape {
        Named::<MaterialKind>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        let mut named = Named::<MaterialKind>::read(node, reader)?;
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
        let mut own = BTreeSet::new();
        let mut distinct = Ok(());
        for item in items {
            let (Some(name), Some(node)) = (name(item, "name"), item.get("name")) else { continue };
            if !own.insert(name.clone()) {
                let what = format!("another body is named `{name}` already");
                distinct = Err(reader.fault(&node.place, what, format!("name: {name}_2")));
            }
        }
        let bodies = List::<Body>::read(node, reader)?;
        distinct.map(|()| bodies)
    }
}
