//! Triangles on their way from a file into a [`Mesh`]: normals made where there are none, runs of
//! different materials put together.

use super::files::Refusal;
use crate::mesh::{Mesh, Part};
use glam::{DVec3, Vec2, Vec3};

/// The triangles of one material, as read. All attributes are as long as the positions or empty.
#[derive(Debug, Default)]
pub(super) struct Shape {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub tangents: Vec<[f32; 4]>,
    pub uvs: [Vec<Vec2>; 2],
    pub colors: Vec<[f32; 4]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// Gives every triangle its own three vertices and its own normal.
    pub(super) fn flatten(&mut self) {
        let corners = self.triangles.as_flattened();
        let normals = self.triangles.iter().flat_map(|t| {
            let normal = self.area(*t).normalize_or(DVec3::Z).as_vec3();
            [normal; 3]
        });
        self.normals = normals.collect();
        self.tangents = spread(&self.tangents, corners);
        self.uvs = [spread(&self.uvs[0], corners), spread(&self.uvs[1], corners)];
        self.colors = spread(&self.colors, corners);
        self.positions = spread(&self.positions, corners);
        self.triangles = (0..self.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    }

    /// Brings normals to unit length and replaces those without a direction by the triangles' own; how
    /// many were replaced.
    pub(super) fn unit_normals(&mut self) -> usize {
        let mut lost = Vec::new();
        for (i, normal) in self.normals.iter_mut().enumerate() {
            let unit = normal.as_dvec3().normalize_or_zero();
            if unit == DVec3::ZERO {
                lost.push(i as u32);
            }
            *normal = unit.as_vec3();
        }
        if lost.is_empty() {
            return 0;
        }
        let mut sums = vec![DVec3::ZERO; lost.len()];
        for &triangle in &self.triangles {
            for corner in triangle {
                if let Ok(i) = lost.binary_search(&corner) {
                    sums[i] += self.area(triangle);
                }
            }
        }
        for (&i, sum) in lost.iter().zip(sums) {
            self.normals[i as usize] = sum.normalize_or(DVec3::Z).as_vec3();
        }
        lost.len()
    }

    /// The normal of a triangle times twice its area.
    fn area(&self, [a, b, c]: [u32; 3]) -> DVec3 {
        let at = |i: u32| self.positions[i as usize].as_dvec3();
        (at(b) - at(a)).cross(at(c) - at(a))
    }
}

/// The values of the corners, one each.
fn spread<T: Copy>(values: &[T], corners: &[u32]) -> Vec<T> {
    if values.is_empty() {
        return Vec::new();
    }
    corners.iter().map(|&i| values[i as usize]).collect()
}

/// Adds the triangles of a shape, which must have normals, to a mesh.
pub(super) fn append(mesh: &mut Mesh, mut shape: Shape, material: u32) -> Result<(), Refusal> {
    if shape.triangles.is_empty() {
        return Ok(());
    }
    let first = mesh.positions.len();
    let whole = first + shape.positions.len();
    let triangles = mesh.triangles.len() + shape.triangles.len();
    if u32::try_from(whole.max(triangles)).is_err() {
        return Err(Refusal::new("more than 4294967295 vertices or triangles in one mesh", "split the mesh"));
    }
    for (into, from) in mesh.uvs.iter_mut().zip(&mut shape.uvs) {
        extend(into, from, first, whole, Vec2::ZERO);
    }
    extend(&mut mesh.tangents, &mut shape.tangents, first, whole, [1.0, 0.0, 0.0, 1.0]);
    extend(&mut mesh.colors, &mut shape.colors, first, whole, [1.0; 4]);
    let offset = first as u32;
    if first == 0 {
        (mesh.positions, mesh.normals, mesh.triangles) = (shape.positions, shape.normals, shape.triangles);
    } else {
        mesh.positions.append(&mut shape.positions);
        mesh.normals.append(&mut shape.normals);
        mesh.triangles.extend(shape.triangles.iter().map(|t| t.map(|i| i + offset)));
    }
    let end = triangles as u32;
    match mesh.parts.last_mut() {
        Some(part) if part.material == material => part.end = end,
        _ => mesh.parts.push(Part { end, material }),
    }
    Ok(())
}

/// Appends an attribute; where one side has none, `missing` stands in.
fn extend<T: Copy>(into: &mut Vec<T>, from: &mut Vec<T>, first: usize, whole: usize, missing: T) {
    if into.is_empty() && from.is_empty() {
        return;
    }
    into.resize(first, missing);
    into.append(from);
    into.resize(whole, missing);
}
