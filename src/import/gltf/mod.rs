//! glTF 2.0, as `.gltf` with its files or as `.glb`.
//!
//! The `gltf` crate parses the JSON and the container; numbers are read here, each accessor checked against
//! its view and its buffer before anything is allocated.
//!
//! Read: the default scene with its nodes, meshes (triangles, strips, fans), materials, lights and cameras, and
//! the extensions in [`document::SUPPORTED`]. Skinned and morphed meshes stand in their rest pose. Animations
//! and ambient occlusion are passed over.

mod accessor;
mod buffer;
mod document;
mod extension;
mod material;
mod primitive;
mod scene;
mod texture;

use super::{Asset, Job, Material};
use crate::mesh::Mesh;
use document::Document;
use gltf::json;
use std::sync::Arc;

/// Reads the bytes of a `.gltf` or `.glb` file.
pub(super) fn read(bytes: &[u8], job: &mut Job) -> Option<Asset> {
    let document = document::open(bytes, job)?;
    let (materials, ignored) = material::all(&document, job);
    let placed = scene::place(&document, job)?;
    let mut asset = Asset {
        nodes: placed.nodes,
        materials,
        ignored,
        lights: placed.lights,
        cameras: placed.cameras,
        animations: document.animations.clone(),
        ..Asset::default()
    };
    let mut numbers = vec![None; document.root.meshes.len()];
    for mut instance in placed.instances {
        let written = instance.mesh;
        let number = *numbers.get_mut(written)?.get_or_insert_with(|| {
            asset.meshes.push(Arc::new(mesh(&document, written, &asset.materials, job)));
            asset.meshes.len() - 1
        });
        instance.mesh = number;
        asset.instances.push(instance);
    }
    if asset.meshes.iter().any(|mesh| uses(mesh, asset.materials.len())) {
        asset.materials.push(Material::default());
    }
    Some(asset)
}

/// Whether a mesh uses the material of a number.
fn uses(mesh: &Mesh, material: usize) -> bool {
    mesh.parts.iter().any(|part| part.material as usize == material)
}

/// One mesh with all of its primitives. What is at fault is left out and reported.
fn mesh(document: &Document<'_>, number: usize, materials: &[Material], job: &mut Job) -> Mesh {
    let mut mesh = Mesh::default();
    let Some(written) = document.root.meshes.get(number) else { return mesh };
    mesh.name = written.name.clone().unwrap_or_default();
    let mut lacks_tangents = false;
    for (i, part) in written.primitives.iter().enumerate() {
        let element = format!("meshes[{number}].primitives[{i}]");
        let Some(shape) = primitive::read(document, part, &element, job) else { continue };
        let material = part.material.map_or(materials.len(), |index| index.value());
        primitive::check_textures(&shape, materials.get(material), &element, job);
        let bumpy = materials.get(material).is_some_and(Material::has_normal_map);
        lacks_tangents |= bumpy && shape.tangents.is_empty();
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
