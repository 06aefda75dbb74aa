//! glTF 2.0, as `.gltf` with its files or as `.glb`.
//!
//! The `gltf` crate parses the JSON and the container; numbers are read here, each accessor checked against
//! its view and its buffer before anything is allocated.
//!
//! Read: the default scene with its nodes, meshes (triangles, strips, fans), materials, lights and cameras, and
//! the extensions in [`document::SUPPORTED`]. Skinned and morphed meshes stand in their rest pose. Animations
//! move cameras only; ambient occlusion is passed over.

mod accessor;
mod animation;
mod buffer;
mod document;
mod extension;
mod material;
mod primitive;
mod scene;
mod texture;

use super::{Asset, Instance, Job, Material};
use crate::mesh::Mesh;
use document::Document;
use gltf::json;
use std::sync::Arc;

/// Reads the bytes of a `.gltf` or `.glb` file, and makes something of its meshes while its pictures are decoded.
pub(super) fn read<T: Send>(
    bytes: &[u8],
    job: &mut Job,
    make: impl FnOnce(&[Arc<Mesh>]) -> T + Send,
) -> Option<(Asset, T)> {
    let document = document::open(bytes, job)?;
    let mut part = job.part();
    let ((materials, ignored), placed) = rayon::join(
        || material::all(&document, job),
        || {
            let mut placed = scene::place(&document, &mut part)?;
            let animations = animation::all(&document, &placed, &mut part);
            let read = meshes(&document, &mut placed.instances, &mut part)?;
            let made = make(&read.meshes);
            Some((placed, animations, read, made))
        },
    );
    job.found_by(part);
    let (placed, animations, Meshes { meshes, skins }, made) = placed?;
    for skin in &skins {
        skin.check_textures(&materials, job);
    }
    let mut asset = Asset {
        nodes: placed.nodes,
        meshes,
        materials,
        ignored,
        instances: placed.instances,
        lights: placed.lights,
        cameras: placed.cameras,
        animations,
        ..Asset::default()
    };
    if asset.meshes.iter().any(|mesh| uses(mesh, asset.materials.len())) {
        asset.materials.push(Material::default());
    }
    Some((asset, made))
}

/// The meshes that are placed.
#[derive(Default)]
struct Meshes {
    meshes: Vec<Arc<Mesh>>,
    skins: Vec<primitive::Skin>,
}

/// Reads the meshes of the instances, which then go by their new numbers.
fn meshes(document: &Document<'_>, instances: &mut [Instance], job: &mut Job) -> Option<Meshes> {
    let mut numbers = vec![None; document.root.meshes.len()];
    let mut read = Meshes::default();
    for instance in instances {
        let written = instance.mesh;
        instance.mesh = *numbers.get_mut(written)?.get_or_insert_with(|| {
            let mesh = mesh(document, written, &mut read.skins, job);
            read.meshes.push(Arc::new(mesh));
            read.meshes.len() - 1
        });
    }
    Some(read)
}

/// Whether a mesh uses the material of a number.
fn uses(mesh: &Mesh, material: usize) -> bool {
    mesh.parts.iter().any(|part| part.material as usize == material)
}

/// One mesh with all of its primitives. What is at fault is left out and reported.
fn mesh(document: &Document<'_>, number: usize, skins: &mut Vec<primitive::Skin>, job: &mut Job) -> Mesh {
    let mut mesh = Mesh::default();
    let Some(written) = document.root.meshes.get(number) else { return mesh };
    mesh.name = written.name.clone().unwrap_or_default();
    let mut lacks_tangents = false;
    for (i, part) in written.primitives.iter().enumerate() {
        let element = format!("meshes[{number}].primitives[{i}]");
        let Some(shape) = primitive::read(document, part, &element, job) else { continue };
        let materials = &document.root.materials;
        let material = part.material.map_or(materials.len(), |index| index.value());
        let bumpy = materials.get(material).is_some_and(material::has_normal_map);
        lacks_tangents |= bumpy && shape.tangents.is_empty();
        skins.push(primitive::Skin::of(&shape, material, element.clone()));
        if let Err(refusal) = super::shape::append(&mut mesh, shape, material as u32) {
            job.refused(element, refusal);
        }
    }
    // Those made up for a primitive without any do no harm unless it has a normal map.
    if lacks_tangents {
        mesh.tangents = Vec::new();
    }
    mesh
}

/// The name of something, or nothing.
fn name(written: Option<&String>) -> String {
    written.cloned().unwrap_or_default()
}

/// An element of a list by its index, if there is one.
fn get<T>(list: &[T], index: json::Index<T>) -> Option<&T> {
    list.get(index.value())
}
