//! A displaced icosphere in a room of twelve triangles, so that every ray meets something.

use glam::{DVec3, Vec3};
use std::collections::BTreeMap;
use terrell::mesh::Mesh;

/// `20 * 4^level` triangles and twelve.
pub fn ball_in_room(level: u32) -> Mesh {
    let (mut points, mut triangles) = icosahedron();
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize_or(DVec3::Z));
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
    let mut positions: Vec<Vec3> = points.iter().map(|p| (*p * height(*p)).as_vec3()).collect();
    let normals = positions.iter().map(|p| p.normalize_or(Vec3::Z)).chain([Vec3::Z; 8]).collect();
    let first = positions.len() as u32;
    positions.extend(
        (0..8).map(|i| Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -6.0 } else { 6.0 }))),
    );
    for [a, b, c, d] in [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]] {
        triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|i| first + i)));
    }
    Mesh { positions, normals, triangles, ..Mesh::default() }
}

/// How far out the surface is: waves of four lengths.
fn height(p: DVec3) -> f64 {
    (0..4).map(|i| (f64::from(1 << (2 * i)), i)).fold(2.0, |sum, (wave, i)| {
        let q = p * (3.0 * wave) + f64::from(i);
        sum + 0.3 / libm::pow(wave, 0.9) * (libm::sin(q.x) * libm::cos(q.y) + libm::sin(q.z))
    })
}

fn icosahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let long = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points: Vec<DVec3> = Vec::new();
    for (a, b) in [(1.0, long), (-1.0, long), (1.0, -long), (-1.0, -long)] {
        points.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
    }
    let mut triangles = Vec::new();
    for i in 0..12_u32 {
        for (j, k) in (0..i).flat_map(|j| (0..j).map(move |k| (j, k))) {
            let [p, q, r] = [i, j, k].map(|i| points[i as usize]);
            if [p - q, q - r, r - p].iter().all(|edge| (edge.length() - 2.0).abs() < 1e-9) {
                triangles.push(if (q - p).cross(r - p).dot(p) > 0.0 { [i, j, k] } else { [i, k, j] });
            }
        }
    }
    (points.into_iter().map(|p| p.normalize_or(DVec3::Z)).collect(), triangles)
}
