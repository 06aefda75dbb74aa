//! Primitives: accessors become triangles with their attributes.

use super::accessor::{self, Elements};
use super::document::Document;
use crate::import::shape::Shape;
use crate::import::{Job, Material};
use glam::{DVec3, Vec2, Vec3};
use gltf::json;
use gltf::json::accessor::{ComponentType as Kind, Type};
use gltf::json::material::AlphaMode;
use gltf::json::mesh::{Mode, Semantic};
use gltf::json::validation::Checked;
use std::collections::BTreeSet;

/// How far from 1 or -1 a tangent's sign may be written.
const HANDEDNESS: f32 = 1e-3;

/// Types that an attribute may have (glTF 2.0 §3.7.2.1).
struct Allowed {
    shapes: &'static [Type],
    /// Component type, and whether normalised; float is always allowed.
    kinds: &'static [(Kind, bool)],
    /// More of them with `KHR_mesh_quantization`.
    quantized: &'static [(Kind, bool)],
}

const POSITION: Allowed = Allowed {
    shapes: &[Type::Vec3],
    kinds: &[],
    quantized: &[
        (Kind::I8, false),
        (Kind::I8, true),
        (Kind::U8, false),
        (Kind::U8, true),
        (Kind::I16, false),
        (Kind::I16, true),
        (Kind::U16, false),
        (Kind::U16, true),
    ],
};
const NORMAL: Allowed =
    Allowed { shapes: &[Type::Vec3], kinds: &[], quantized: &[(Kind::I8, true), (Kind::I16, true)] };
const TANGENT: Allowed =
    Allowed { shapes: &[Type::Vec4], kinds: &[], quantized: &[(Kind::I8, true), (Kind::I16, true)] };
const TEXCOORD: Allowed = Allowed {
    shapes: &[Type::Vec2],
    kinds: &[(Kind::U8, true), (Kind::U16, true)],
    quantized: POSITION.quantized,
};
const COLOR: Allowed = Allowed {
    shapes: &[Type::Vec3, Type::Vec4],
    kinds: &[(Kind::U8, true), (Kind::U16, true)],
    quantized: &[],
};

impl Allowed {
    fn check(&self, elements: &Elements<'_>, quantized: bool) -> Result<(), String> {
        let kind = (elements.kind, elements.normalized);
        let known = elements.kind == Kind::F32
            || self.kinds.contains(&kind)
            || (quantized && self.quantized.contains(&kind));
        if known && self.shapes.contains(&elements.shape) {
            return Ok(());
        }
        let normalized = if elements.normalized { "normalised " } else { "" };
        Err(format!("{:?} of {normalized}{:?} is not a type allowed here", elements.shape, elements.kind))
    }
}

/// Reads the attributes of one primitive.
struct Attributes<'a, 'b> {
    document: &'a Document<'b>,
    primitive: &'a json::mesh::Primitive,
    element: &'a str,
    job: &'a mut Job,
}

impl Attributes<'_, '_> {
    /// An attribute at the vertices picked; none if the primitive has none. A fault is reported and gives none.
    fn read<const N: usize>(
        &mut self,
        semantic: Semantic,
        allowed: &Allowed,
        vertices: usize,
        picked: Option<&[u32]>,
    ) -> Option<Vec<[f32; N]>> {
        let name = semantic.to_string();
        let index = *self.primitive.attributes.get(&Checked::Valid(semantic))?;
        let values = self.values(index, allowed, vertices, picked).and_then(|values| finite(values, picked));
        values.map_err(|what| self.job.fault(format!("{}.attributes.{name}", self.element), what, "")).ok()
    }

    fn values<const N: usize>(
        &mut self,
        index: json::Index<json::Accessor>,
        allowed: &Allowed,
        vertices: usize,
        picked: Option<&[u32]>,
    ) -> Result<Vec<[f32; N]>, String> {
        let elements = accessor::open(self.document, index, self.job)?;
        allowed.check(&elements, self.document.quantized)?;
        if elements.count != vertices {
            return Err(format!("has {} elements, but POSITION has {vertices}", elements.count));
        }
        elements.floats(picked, self.job)
    }

    /// Tangents of unit length with their handedness; what is no tangent is warned of and gives none at all, so
    /// that they are derived from the texture coordinates.
    fn tangents(&mut self, vertices: usize, picked: Option<&[u32]>) -> Option<Vec<[f32; 4]>> {
        let index = *self.primitive.attributes.get(&Checked::Valid(Semantic::Tangents))?;
        let element = format!("{}.attributes.TANGENT", self.element);
        let values = self.values(index, &TANGENT, vertices, picked);
        let mut values = values.map_err(|what| self.job.fault(&element, what, "")).ok()?;
        for (i, value) in values.iter_mut().enumerate() {
            let [x, y, z, w] = *value;
            let unit = DVec3::new(x.into(), y.into(), z.into()).normalize_or_zero();
            if unit == DVec3::ZERO || (w.abs() - 1.0).abs() > HANDEDNESS || !w.is_finite() {
                let vertex = picked.map_or(i, |picked| picked[i] as usize);
                let what =
                    format!("vertex {vertex} is {value:?}, which is no direction with a sign of 1 or -1");
                let hint = "all tangents of this primitive are passed over: export them again, or none";
                self.job.warn(element, what, hint);
                return None;
            }
            let [x, y, z] = unit.as_vec3().to_array();
            *value = [x, y, z, w.signum()];
        }
        Some(values)
    }
}

/// Values that are all finite.
fn finite<const N: usize>(values: Vec<[f32; N]>, picked: Option<&[u32]>) -> Result<Vec<[f32; N]>, String> {
    let Some(i) = values.iter().position(|v| !v.iter().all(|c| c.is_finite())) else {
        return Ok(values);
    };
    let vertex = picked.map_or(i, |picked| picked[i] as usize);
    Err(format!("vertex {vertex} is {:?}, which is not finite", values[i]))
}

/// The triangles of a primitive; none if it has none or is at fault, which is reported.
pub(super) fn read(
    document: &Document<'_>,
    primitive: &json::mesh::Primitive,
    element: &str,
    job: &mut Job,
) -> Option<Shape> {
    let Checked::Valid(mode) = primitive.mode else { return None };
    if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
        job.warn(element, "points and lines have no surface and are passed over", "");
        return None;
    }
    if primitive.targets.is_some() {
        job.warn(element, "its morph targets are passed over: it has its rest shape", "");
    }
    let before = job.faults;
    let vertices = count(document, primitive, element, job)?;
    let corners = corners(document, primitive, vertices, element, job)?;
    let mut triangles = triangles(&corners, mode);
    drop(corners);
    if triangles.is_empty() {
        job.warn(element, "has no triangles", "");
        return None;
    }
    let picked = pick(&mut triangles, vertices);
    let picked = picked.as_deref();
    let mut attributes = Attributes { document, primitive, element, job };
    let positions = attributes.read(Semantic::Positions, &POSITION, vertices, picked);
    let normals = attributes.read(Semantic::Normals, &NORMAL, vertices, picked);
    // Those that belong to other normals mean nothing (§3.7.2.1).
    let tangents = normals.is_some().then(|| attributes.tangents(vertices, picked)).flatten();
    let mut uvs = [0, 1].map(|set| attributes.read(Semantic::TexCoords(set), &TEXCOORD, vertices, picked));
    let colors = attributes.read(Semantic::Colors(0), &COLOR, vertices, picked);
    if job.faults > before {
        return None;
    }
    let mut shape = Shape {
        positions: vectors(positions),
        normals: vectors(normals),
        tangents: tangents.unwrap_or_default(),
        uvs: [0, 1]
            .map(|set| uvs[set].take().unwrap_or_default().into_iter().map(Vec2::from_array).collect()),
        colors: colors.unwrap_or_default(),
        triangles,
    };
    if opaque(document, primitive) {
        shape.colors.iter_mut().for_each(|color| color[3] = 1.0);
    }
    finish_normals(&mut shape, element, job)?;
    Some(shape)
}

fn vectors(values: Option<Vec<[f32; 3]>>) -> Vec<Vec3> {
    values.unwrap_or_default().into_iter().map(Vec3::from_array).collect()
}

/// The number of vertices.
fn count(
    document: &Document<'_>,
    primitive: &json::mesh::Primitive,
    element: &str,
    job: &mut Job,
) -> Option<usize> {
    let index = *primitive.attributes.get(&Checked::Valid(Semantic::Positions))?;
    let count = accessor::open(document, index, job).and_then(|elements| {
        POSITION.check(&elements, document.quantized)?;
        u32::try_from(elements.count).map_err(|_| format!("{} vertices are too many", elements.count))?;
        Ok(elements.count)
    });
    count.map_err(|what| job.fault(format!("{element}.attributes.POSITION"), what, "")).ok()
}

/// The vertices of the corners in order.
fn corners(
    document: &Document<'_>,
    primitive: &json::mesh::Primitive,
    vertices: usize,
    element: &str,
    job: &mut Job,
) -> Option<Vec<u32>> {
    let read = |job: &mut Job| {
        let Some(index) = primitive.indices else {
            job.files.take(vertices as u64 * 4).map_err(|refusal| refusal.what)?;
            return Ok((0..vertices as u32).collect());
        };
        let elements = accessor::open(document, index, job)?;
        let unsigned = matches!(elements.kind, Kind::U8 | Kind::U16 | Kind::U32);
        if !unsigned || elements.shape != Type::Scalar || elements.normalized {
            let (shape, kind) = (elements.shape, elements.kind);
            return Err(format!("{shape:?} of {kind:?} is not a type of indices"));
        }
        let corners = elements.integers(job)?;
        match corners.iter().position(|&corner| corner as usize >= vertices) {
            Some(i) => Err(format!("number {i} is vertex {}, but there are {vertices} vertices", corners[i])),
            None => Ok(corners),
        }
    };
    let corners: Result<Vec<u32>, String> = read(job);
    let corners = corners.map_err(|what| job.fault(format!("{element}.indices"), what, "")).ok()?;
    if primitive.mode == Checked::Valid(Mode::Triangles) && corners.len() % 3 != 0 {
        let of = if primitive.indices.is_some() { ".indices" } else { ".attributes.POSITION" };
        job.fault(format!("{element}{of}"), format!("{} corners are not a multiple of 3", corners.len()), "");
        return None;
    }
    Some(corners)
}

/// The triangles of a list, a strip or a fan (glTF 2.0 §3.7.2.1), without those with two corners in one.
fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    let flat = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::TriangleStrip => {
            let turned =
                |(i, w): (usize, &[u32])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] };
            corners.windows(3).enumerate().map(turned).filter(flat).collect()
        }
        Mode::TriangleFan => {
            let Some((&hub, rim)) = corners.split_first() else { return Vec::new() };
            rim.windows(2).map(|w| [w[0], w[1], hub]).filter(flat).collect()
        }
        _ => corners.as_chunks().0.iter().filter(|t| flat(t)).copied().collect(),
    }
}

/// When the triangles use few of the vertices, numbers them anew; which of the old ones they are.
///
/// Many files keep the vertices of all primitives in one accessor.
fn pick(triangles: &mut [[u32; 3]], vertices: usize) -> Option<Vec<u32>> {
    let corners = triangles.as_flattened_mut();
    if corners.len() >= vertices {
        return None;
    }
    let mut picked = corners.to_vec();
    picked.sort_unstable();
    picked.dedup();
    for corner in corners {
        *corner = picked.binary_search(corner).unwrap_or(0) as u32;
    }
    Some(picked)
}

/// Whether a primitive's material says that coverage does not count.
fn opaque(document: &Document<'_>, primitive: &json::mesh::Primitive) -> bool {
    let material = primitive.material.and_then(|index| super::get(&document.root.materials, index));
    material.is_none_or(|material| material.alpha_mode == Checked::Valid(AlphaMode::Opaque))
}

/// Makes flat normals where there are none, as the specification demands (§3.7.2.1).
fn finish_normals(shape: &mut Shape, element: &str, job: &mut Job) -> Option<()> {
    if shape.normals.is_empty() {
        // Three vertices of at most 56 bytes a triangle.
        let bytes = shape.triangles.len() as u64 * 3 * 56;
        if let Err(refusal) = job.files.take(bytes) {
            job.refused(element, refusal);
            return None;
        }
        shape.flatten();
        return Some(());
    }
    let lost = shape.unit_normals();
    if lost > 0 {
        let what = format!("{lost} normals have no direction; those of the triangles stand in for them");
        job.warn(format!("{element}.attributes.NORMAL"), what, "");
    }
    Some(())
}

/// What the textures of a primitive need to know of it.
pub(super) struct Skin {
    element: String,
    material: usize,
    /// Which texture coordinates it has.
    uvs: [bool; 2],
}

impl Skin {
    pub(super) fn of(shape: &Shape, material: usize, element: String) -> Self {
        Self { element, material, uvs: [0, 1].map(|set| !shape.uvs[set].is_empty()) }
    }

    /// Warns when a primitive lacks the texture coordinates that its material's textures need.
    pub(super) fn check_textures(&self, materials: &[Material], job: &mut Job) {
        let Some(material) = materials.get(self.material) else { return };
        let sets: BTreeSet<u8> = material.textures().map(|(_, texture)| texture.uv_set).collect();
        for set in sets {
            if self.uvs.get(usize::from(set)) == Some(&false) {
                let what =
                    format!("its material `{}` has a texture, but there is no TEXCOORD_{set}", material.name);
                job.warn(&self.element, what, "unwrap the mesh before exporting it");
            }
        }
    }
}
