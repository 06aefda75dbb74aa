//! What a sight ray can meet: bodies grouped by rest frame, each mesh with one tree.
//!
//! This is the only place where rays pass between the lab and the rest frames of bodies. A ray enters a rest
//! frame with the limit of s that the frames before it have left; no event is ever transformed back to be compared.

mod hit;
mod placed;

pub use hit::{Hit, Spot};
pub use placed::Placed;

use crate::spacetime::{Lab, Poincare, Rest, SightRay};
use crate::tree::{Bounds, Line, Tree};
use crate::triangles::Meeting;

/// Everything at rest in one frame.
#[derive(Debug, Clone)]
pub struct RestFrame {
    /// Into the frame.
    pub rest_from_lab: Poincare<Rest, Lab>,
    /// The meshes in it.
    pub placed: Vec<Placed>,
    tree: Tree,
}

impl RestFrame {
    /// Builds the tree over the placed meshes.
    pub fn new(rest_from_lab: Poincare<Rest, Lab>, placed: Vec<Placed>) -> Self {
        let boxes: Vec<Bounds> = placed.iter().map(Placed::bounds).collect();
        Self { rest_from_lab, placed, tree: Tree::build(&boxes) }
    }

    fn nearest(&self, ray: &SightRay, s_max: f64) -> Option<(u32, Meeting)> {
        let ray = ray.to(&self.rest_from_lab);
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let mut nearest = None;
        self.tree.walk(&line, s_max, |number, limit| {
            let placed = &self.placed[number as usize];
            match placed.nearest(&ray, limit) {
                Some(meeting) => {
                    nearest = Some((number, meeting));
                    meeting.s
                }
                None => limit,
            }
        });
        nearest
    }

    fn any(&self, ray: &SightRay, s_max: f64) -> bool {
        let ray = ray.to(&self.rest_from_lab);
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let met = |number: u32, limit| {
            let placed = &self.placed[number as usize];
            if placed.any(&ray, limit) { -1.0 } else { limit }
        };
        self.tree.walk(&line, s_max, met) < 0.0
    }

    fn until<'w>(&'w self, ray: &SightRay, s_max: f64, enough: &mut dyn FnMut(Hit<'w>) -> bool) -> bool {
        let ray = ray.to(&self.rest_from_lab);
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let met = |number: u32, limit| {
            let placed = &self.placed[number as usize];
            let mut met = |meeting: Meeting| enough(Hit { s: meeting.s, rest: self, placed, meeting });
            if placed.until(&ray, limit, &mut met) { -1.0 } else { limit }
        };
        self.tree.walk(&line, s_max, met) < 0.0
    }
}

/// All bodies.
#[derive(Debug, Clone, Default)]
pub struct World {
    /// One for each velocity.
    pub frames: Vec<RestFrame>,
}

impl World {
    /// The first body that the ray meets: the smallest s over all rest frames.
    pub fn nearest(&self, ray: &SightRay) -> Option<Hit<'_>> {
        let mut nearest: Option<Hit<'_>> = None;
        for rest in &self.frames {
            let s_max = nearest.map_or(f64::INFINITY, |hit| hit.s);
            if let Some((number, meeting)) = rest.nearest(ray, s_max) {
                nearest = Some(Hit { s: meeting.s, rest, placed: &rest.placed[number as usize], meeting });
            }
        }
        nearest
    }

    /// Whether anything stands in the way at 0 < s < `s_max`.
    pub fn blocked(&self, ray: &SightRay, s_max: f64) -> bool {
        self.frames.iter().any(|rest| rest.any(ray, s_max))
    }

    /// All that stands in the way at 0 < s < `s_max`, in no order, until one is enough: whether it was.
    pub fn until<'w>(&'w self, ray: &SightRay, s_max: f64, mut enough: impl FnMut(Hit<'w>) -> bool) -> bool {
        self.frames.iter().any(|rest| rest.until(ray, s_max, &mut enough))
    }
}
