//! Triangles with their attributes, in the coordinates of the file's own mesh.
//!
//! A mesh does not know where it stands or how fast it moves. It is checked when it is made: indices in
//! range, numbers finite, attributes as long as the positions or empty.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// A run of triangles with one material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The first triangle after the run.
    pub end: u32,
    /// Index into the asset's materials.
    pub material: u32,
}

/// Triangles with their attributes.
///
/// Texture coordinates have their origin in the upper left corner of the picture (as glTF; OBJ's are
/// turned over at import).
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// The file's name for it.
    pub name: String,
    /// Vertices, metres in the mesh's own coordinates. Finite.
    pub positions: Vec<Vec3>,
    /// Shading normals, unit length, one a vertex.
    pub normals: Vec<Vec3>,
    /// The direction in which u of the normal map grows (unit length), and the sign w, 1 or -1, of the bitangent
    /// w n × t; one a vertex, or empty where the file has none and they follow from the texture coordinates.
    pub tangents: Vec<[f32; 4]>,
    /// Up to two sets of texture coordinates, each one a vertex or empty.
    pub uvs: [Vec<Vec2>; 2],
    /// Linear RGBA, one a vertex, or empty for white.
    pub colors: Vec<[f32; 4]>,
    /// Corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Materials of the triangles, in order; the last `end` is the number of triangles.
    pub parts: Vec<Part>,
}

impl Mesh {
    /// Whether its triangles close it in: every edge is passed as often one way as the other.
    pub fn is_closed(&self) -> bool {
        let place = |i: u32| self.positions[i as usize].to_array().map(|c| (c + 0.0).to_bits());
        let around = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(place);
            [(a, b), (b, c), (c, a)]
        };
        let passed = |(from, to)| if from < to { ([from, to], 1) } else { ([to, from], -1) };
        let edges = self.triangles.par_iter().flat_map_iter(around).filter(|(from, to)| from != to);
        let mut edges: Vec<([[u32; 3]; 2], i32)> = edges.map(passed).collect();
        edges.par_sort_unstable();
        edges.chunk_by(|a, b| a.0 == b.0).all(|same| same.iter().map(|(_, way)| way).sum::<i32>() == 0)
    }

    /// The material of a triangle, an index into the asset's materials.
    pub fn material_of(&self, triangle: u32) -> u32 {
        let part = self.parts.partition_point(|part| part.end <= triangle);
        self.parts.get(part).map_or(0, |part| part.material)
    }
}
