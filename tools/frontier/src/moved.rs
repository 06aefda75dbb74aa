//! Vertices moved to where they appear, and the triangles between them traced at rest.

use crate::shade::{Facet, Found};
use crate::stage::{Prop, Stage};
use glam::{DVec2, DVec3, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;
use terrell::mesh::Mesh;
use terrell::spacetime::{Event, SightRay};
use terrell::tree::Line;
use terrell::triangles::Triangles;

/// A mesh in its rest frame, as it is cut up.
#[derive(Clone, Default)]
struct Cloth {
    places: Vec<DVec3>,
    uvs: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    materials: Vec<u32>,
}

impl Cloth {
    fn of(prop: &Prop) -> Self {
        let mesh = &prop.triangles.mesh;
        let places = mesh.positions.iter().map(|p| prop.rest_from_mesh.transform_point3(p.as_dvec3()));
        let uvs = mesh.uvs[0].iter().map(|uv| uv.as_dvec2());
        let materials = (0..mesh.triangles.len() as u32).map(|i| mesh.material_of(i));
        Self {
            places: places.collect(),
            uvs: uvs.collect(),
            triangles: mesh.triangles.clone(),
            materials: materials.collect(),
        }
    }

    /// The number of the vertex halfway along an edge.
    fn middle(&mut self, known: &mut BTreeMap<(u32, u32), u32>, a: u32, b: u32) -> u32 {
        *known.entry((a.min(b), a.max(b))).or_insert_with(|| {
            self.places.push(0.5 * (self.places[a as usize] + self.places[b as usize]));
            if !self.uvs.is_empty() {
                self.uvs.push(0.5 * (self.uvs[a as usize] + self.uvs[b as usize]));
            }
            self.places.len() as u32 - 1
        })
    }

    /// Halves the edges that are to be halved, and cuts triangles to fit; whether there were any.
    fn refine(&mut self, halve: impl Fn(DVec3, DVec3) -> bool) -> bool {
        let mut known = BTreeMap::new();
        let mut cut = Vec::with_capacity(self.triangles.len());
        let mut materials = Vec::with_capacity(self.triangles.len());
        for (triangle, material) in
            std::mem::take(&mut self.triangles).into_iter().zip(std::mem::take(&mut self.materials))
        {
            let [a, b, c] = triangle;
            let mut half = |p: u32, q: u32| {
                // Ends in one order, so that both triangles at the edge decide alike.
                let (x, y) = (self.places[p.min(q) as usize], self.places[p.max(q) as usize]);
                halve(x, y).then(|| self.middle(&mut known, p, q))
            };
            let pieces: Vec<[u32; 3]> = match (half(a, b), half(b, c), half(c, a)) {
                (None, None, None) => vec![triangle],
                (Some(p), None, None) => vec![[a, p, c], [p, b, c]],
                (None, Some(q), None) => vec![[b, q, a], [q, c, a]],
                (None, None, Some(r)) => vec![[c, r, b], [r, a, b]],
                (Some(p), Some(q), None) => vec![[p, b, q], [a, p, q], [a, q, c]],
                (None, Some(q), Some(r)) => vec![[q, c, r], [b, q, r], [b, r, a]],
                (Some(p), None, Some(r)) => vec![[r, a, p], [c, r, p], [c, p, b]],
                (Some(p), Some(q), Some(r)) => vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]],
            };
            materials.extend(pieces.iter().map(|_| material));
            cut.extend(pieces);
        }
        self.triangles = cut;
        self.materials = materials;
        !known.is_empty()
    }
}

/// How finely meshes are cut before their vertices are moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cut {
    /// Every triangle in four, so many times, before the exposure (its cost is not counted).
    Levels(u32),
    /// Edges are halved, at each exposure, while they appear bent by more than so many pixels.
    Bent(f64),
}

/// Meshes, cut, still at rest.
pub struct Cloths {
    cloths: Vec<Cloth>,
    cut: Cut,
}

impl Cloths {
    pub fn new(stage: &Stage, cut: Cut) -> Self {
        let mut cloths: Vec<Cloth> = stage.props.iter().map(Cloth::of).collect();
        if let Cut::Levels(levels) = cut {
            for _ in 0..levels {
                cloths.iter_mut().for_each(|cloth| _ = cloth.refine(|_, _| true));
            }
        }
        Self { cloths, cut }
    }
}

/// All bodies as they appear from one event.
pub struct Moved<'a> {
    stage: &'a Stage,
    cloths: std::borrow::Cow<'a, [Cloth]>,
    // The first triangle of each cloth.
    starts: Vec<u32>,
    tree: Triangles,
}

/// Where a place in a body's rest frame appears, relative to an eye at rest in the lab.
fn appears(prop: &Prop, eye: Event, place: DVec3) -> DVec3 {
    let there = prop.rest_from_lab * eye;
    let left = Event::new(there.t - (place - there.x).length(), place);
    prop.rest_from_lab.undo(left).x - eye.x
}

/// Cuts no deeper than this.
const DEEPEST: u32 = 9;

impl<'a> Moved<'a> {
    /// Moves the vertices and builds the tree.
    pub fn new(stage: &'a Stage, cloths: &'a Cloths) -> Self {
        let eye = stage.view.tetrad.event;
        let mut cut: std::borrow::Cow<'a, [Cloth]> = cloths.cloths.as_slice().into();
        if let Cut::Bent(pixels) = cloths.cut {
            let (_, cone) = stage
                .view
                .sight(0.5 * DVec2::new(crate::stage::WIDTH.into(), crate::stage::HEIGHT.into()), 1.0);
            let most = pixels * 2.0 * cone.pixel;
            for (cloth, prop) in cut.to_mut().iter_mut().zip(&stage.props) {
                let bent = |a: DVec3, b: DVec3| {
                    let [a, b, m] = [a, b, 0.5 * (a + b)].map(|place| appears(prop, eye, place));
                    let off = 0.5 * (a + b) - m;
                    let along = m / m.length();
                    (off - along * off.dot(along)).length() > most * m.length()
                };
                (0..DEEPEST).any(|_| !cloth.refine(bent));
            }
        }
        let mut mesh = Mesh::default();
        let mut starts = Vec::new();
        for (cloth, prop) in cut.iter().zip(&stage.props) {
            let first = mesh.positions.len() as u32;
            starts.push(mesh.triangles.len() as u32);
            let moved = cloth.places.iter().map(|place| appears(prop, eye, *place).as_vec3());
            mesh.positions.extend(moved.collect::<Vec<Vec3>>());
            mesh.triangles.extend(cloth.triangles.iter().map(|t| t.map(|i| first + i)));
        }
        Self { stage, cloths: cut, starts, tree: Triangles::new(Arc::new(mesh)) }
    }

    pub fn triangles(&self) -> usize {
        self.tree.mesh.triangles.len()
    }

    /// What a sight ray meets. (The eye rests in the lab, so that k has unit length and s is the distance.)
    pub fn meet(&self, ray: &SightRay) -> Option<Found<'_>> {
        let met = self.tree.nearest(&Line { origin: DVec3::ZERO, step: -ray.k.x }, f64::INFINITY)?;
        let number = self.starts.partition_point(|start| *start <= met.triangle) - 1;
        let (cloth, prop) = (&self.cloths[number], &self.stage.props[number]);
        let own = (met.triangle - self.starts[number]) as usize;
        let indices = cloth.triangles[own].map(|i| i as usize);
        let facet = Facet {
            corners: indices.map(|i| cloth.places[i]),
            uvs: (!cloth.uvs.is_empty()).then(|| indices.map(|i| cloth.uvs[i])),
            paint: &prop.paints[cloth.materials[own] as usize],
        };
        let k = prop.rest_from_lab * ray.k;
        Some(Found { facet, weights: met.weights, k, s: met.s, body: prop.body })
    }
}
