//! Wavefront OBJ with its materials (MTL).
//!
//! The text is checked line by line first ([`tidy`]), since `tobj`, which then takes it apart, has no line
//! numbers in its errors, lets much pass and panics now and then. It gets only what was found to be right.
//!
//! Each `o` and each `g` begins an object, which becomes a mesh and a node; the same name again goes on with
//! the same object. Normals are those of the file or flat: smoothing groups are not read. Colours of
//! vertices are sRGB, as Blender and the sculpting programs write them; `Kd` and `Ke` are linear.

mod mtl;
mod polygon;
mod tidy;

use super::shape::{self, Shape};
use super::{Asset, Instance, Job, Material, Node};
use crate::mesh::Mesh;
use crate::texture::linear_from_srgb;
use glam::{DAffine3, Vec2, Vec3};
use std::sync::Arc;
use tidy::Tidied;

/// Bytes in memory for a byte of text: the text, the tidied text, `tobj`'s tables and the mesh.
const BYTES_PER_BYTE: u64 = 16;

/// Reads the bytes of an `.obj` file.
pub(super) fn read(bytes: &[u8], job: &mut Job) -> Option<Asset> {
    if let Err(refusal) = job.files.take(bytes.len() as u64 * BYTES_PER_BYTE) {
        job.refused("the whole file", refusal);
        return None;
    }
    let text = String::from_utf8_lossy(bytes);
    let tidied = tidy::tidy(&text, job)?;
    drop(text);
    let meshes = meshes(&tidied, job)?;
    let mut asset = Asset { materials: tidied.library.materials, ..Asset::default() };
    if meshes.iter().any(|mesh| mesh.parts.iter().any(|p| p.material as usize == asset.materials.len())) {
        asset.materials.push(Material { double_sided: true, ..Material::default() });
    }
    for (i, mesh) in meshes.into_iter().enumerate() {
        let name = mesh.name.clone();
        asset.nodes.push(Node {
            name,
            parent: None,
            pose: crate::import::Pose::Matrix(DAffine3::IDENTITY),
            asset_from_node: DAffine3::IDENTITY,
        });
        asset.instances.push(Instance { mesh: i, asset_from_mesh: DAffine3::IDENTITY, node: i });
        asset.meshes.push(Arc::new(mesh));
    }
    Some(asset)
}

/// The objects that have triangles.
fn meshes(tidied: &Tidied, job: &mut Job) -> Option<Vec<Mesh>> {
    let options =
        tobj::LoadOptions { single_index: true, triangulate: false, ignore_points: true, ignore_lines: true };
    // Materials go by their numbers; unknown ones have none.
    let loader = |_: &std::path::Path| {
        let numbers = 0..tidied.library.materials.len();
        let material = |i: usize| tobj::Material { name: i.to_string(), ..Default::default() };
        Ok((numbers.clone().map(material).collect(), numbers.map(|i| (i.to_string(), i)).collect()))
    };
    let models = match tobj::load_obj_buf(&mut tidied.text.as_slice(), &options, loader) {
        Ok((models, _)) => models,
        Err(error) => {
            job.fault("the whole file", error.to_string(), "");
            return None;
        }
    };
    let name = |name: &String| Mesh { name: name.clone(), ..Mesh::default() };
    let mut meshes: Vec<Mesh> = tidied.objects.iter().map(name).collect();
    let mut fanned = 0;
    for model in models {
        let Some(mesh) = model.name.parse().ok().and_then(|i: usize| meshes.get_mut(i)) else { continue };
        let material = model.mesh.material_id.unwrap_or(tidied.library.materials.len());
        let mut shape = shape(model.mesh, &mut fanned);
        if shape.normals.is_empty() {
            shape.flatten();
        } else {
            shape.unit_normals();
        }
        if let Err(refusal) = shape::append(mesh, shape, material as u32) {
            job.refused(format!("object `{}`", mesh.name), refusal);
            return None;
        }
    }
    if fanned > 0 {
        let what =
            format!("{fanned} polygons with over {} corners are taken for convex", polygon::CORNERS_LIMIT);
        job.warn("f", what, "triangulate the model before exporting it");
    }
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    Some(meshes)
}

/// A run of faces as triangles, its texture coordinates turned over.
fn shape(mesh: tobj::Mesh, fanned: &mut usize) -> Shape {
    let vectors = |values: &[f32]| values.as_chunks().0.iter().copied().map(Vec3::from_array).collect();
    let positions: Vec<Vec3> = vectors(&mesh.positions);
    let mut triangles = Vec::new();
    if mesh.face_arities.is_empty() {
        triangles.extend_from_slice(mesh.indices.as_chunks().0);
    } else {
        let mut rest = mesh.indices.as_slice();
        for arity in mesh.face_arities {
            let Some((corners, after)) = rest.split_at_checked(arity as usize) else { break };
            rest = after;
            if !polygon::triangulate(&positions, corners, &mut triangles) {
                *fanned += 1;
            }
        }
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let uv = |uv: &[f32; 2]| Vec2::new(uv[0], 1.0 - uv[1]);
    let color = |c: &[f32; 3]| {
        let [r, g, b] = c.map(|c| linear_from_srgb(c.max(0.0)));
        [r, g, b, 1.0]
    };
    Shape {
        normals: vectors(&mesh.normals),
        tangents: Vec::new(),
        uvs: [mesh.texcoords.as_chunks().0.iter().map(uv).collect(), Vec::new()],
        colors: mesh.vertex_color.as_chunks().0.iter().map(color).collect(),
        positions,
        triangles,
    }
}
