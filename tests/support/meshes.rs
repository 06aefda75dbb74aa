//! Small meshes.

use super::v;
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;
use terrell::mesh::Mesh;
use terrell::triangles::Triangles;

fn indexed(positions: &[DVec3], triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh { positions: positions.iter().map(|p| p.as_vec3()).collect(), triangles, ..Mesh::default() }
}

/// A mesh with its tree.
pub(crate) fn built(mesh: Mesh) -> Arc<Triangles> {
    Arc::new(Triangles::new(Arc::new(mesh)))
}

/// Triangles from their corners, none shared.
pub(crate) fn soup(corners: &[[DVec3; 3]]) -> Mesh {
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    indexed(corners.as_flattened(), triangles)
}

/// A unit sphere of `20 * 4^level` triangles, its normals those of the sphere.
pub(crate) fn icosphere(level: u32) -> Mesh {
    let long = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points: Vec<DVec3> = Vec::new();
    for (a, b) in [(1.0, long), (-1.0, long), (1.0, -long), (-1.0, -long)] {
        points.extend([v(0.0, a, b), v(a, b, 0.0), v(b, 0.0, a)]);
    }
    // Three corners whose distances are all that of an edge, turned outward.
    let pairs = (0..12_u32).flat_map(|i| (0..i).map(move |j| (i, j)));
    let face = |[i, j, k]: [u32; 3]| {
        let [p, q, r] = [i, j, k].map(|i| points[i as usize]);
        let near = [p - q, q - r, r - p].iter().all(|edge| (edge.length() - 2.0).abs() < 1e-9);
        near.then(|| if (q - p).cross(r - p).dot(p) > 0.0 { [i, j, k] } else { [i, k, j] })
    };
    let mut triangles: Vec<[u32; 3]> =
        pairs.flat_map(|(i, j)| (0..j).map(move |k| [i, j, k])).filter_map(face).collect();
    for point in &mut points {
        *point /= point.length();
    }
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = points[a as usize] + points[b as usize];
                points.push(sum / sum.length());
                points.len() as u32 - 1
            })
        };
        let mut finer = Vec::with_capacity(triangles.len() * 4);
        for [a, b, c] in triangles {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let mut mesh = indexed(&points, triangles);
    mesh.normals = mesh.positions.iter().map(|p| p.normalize_or(Vec3::Z)).collect();
    mesh
}

/// A square from -1 to 1 in x and y, that faces +z.
pub(crate) fn square() -> Mesh {
    let corner = |x: f64, y: f64| v(x, y, 0.0);
    indexed(
        &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        vec![[0, 1, 2], [0, 2, 3]],
    )
}

/// A cube from -1 to 1 with flat sides.
pub(crate) fn cube() -> Mesh {
    let corners: [DVec3; 8] = std::array::from_fn(|i| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { -1.0 } else { 1.0 };
        v(pick(0), pick(1), pick(2))
    });
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    indexed(&corners, triangles)
}

/// The mesh with a colour at each vertex, from its place.
pub(crate) fn coloured(mut mesh: Mesh) -> Mesh {
    mesh.colors = mesh
        .positions
        .iter()
        .map(|p| [p.x, p.y, p.z].map(|c| 0.5 + 0.4 * c))
        .map(|[r, g, b]| [r, g, b, 1.0])
        .collect();
    mesh
}
