//! What a sight ray can meet: bodies grouped by rest frame, each mesh with one tree.
//!
//! This is the only place where rays pass between the lab and the rest frames of bodies. A ray enters a rest
//! frame with the limit of s that the frames before it have left; no event is ever transformed back to be compared.

mod crowd;
mod hit;
mod placed;

pub use crowd::Crowd;
pub use hit::{Departure, Hit, Spot};
use placed::Met;
pub use placed::{Form, Placed};

use crate::spacetime::{Event, Lab, Poincare, Rest, SightRay};
use crate::tree::{Bounds, Line, Tree};

/// So many are asked one by one.
const FEW: usize = 3;

/// Everything at rest in one frame.
#[derive(Debug, Clone)]
pub struct RestFrame {
    /// Into the frame.
    pub rest_from_lab: Poincare<Rest, Lab>,
    /// What is in it: first what is in the tree, then the rest.
    pub placed: Vec<Placed>,
    tree: Tree,
    in_tree: u32,
}

impl RestFrame {
    /// Builds the tree over what is placed. What has no end has no place in it; and a few need none: each begins with its own box.
    pub fn new(rest_from_lab: Poincare<Rest, Lab>, placed: Vec<Placed>) -> Self {
        let (mut placed, endless): (Vec<_>, Vec<_>) =
            placed.into_iter().partition(|placed| placed.bounds().is_some());
        let mut boxes: Vec<Bounds> = placed.iter().filter_map(Placed::bounds).collect();
        if boxes.len() <= FEW {
            boxes.clear();
        }
        placed.extend(endless);
        Self { rest_from_lab, placed, tree: Tree::build(&boxes), in_tree: boxes.len() as u32 }
    }

    /// What is not in the tree.
    fn apart(&self) -> std::ops::Range<u32> {
        self.in_tree..self.placed.len() as u32
    }

    /// Where a ray starts, here: without the way through the lab if it comes from a body of this frame.
    #[inline]
    fn start(&self, ray: &SightRay, from: Option<&Departure<'_>>) -> Event<Rest> {
        match from {
            Some(from) if std::ptr::eq(from.rest, self) => from.at,
            _ => self.rest_from_lab * ray.event,
        }
    }

    fn nearest(&self, ray: &SightRay, from: Option<&Departure<'_>>, s_max: f64) -> Option<(u32, Met)> {
        let ray = SightRay { event: self.start(ray, from), k: self.rest_from_lab.light(ray.k) };
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let mut nearest = None;
        let limit = self.tree.walk(&line, s_max, |number, limit| {
            match self.placed[number as usize].nearest(&ray, limit) {
                Some(met) => {
                    nearest = Some((number, met));
                    met.s()
                }
                None => limit,
            }
        });
        for number in self.apart() {
            let limit = nearest.map_or(limit, |(_, met)| met.s());
            nearest = self.placed[number as usize].nearest(&ray, limit).map(|met| (number, met)).or(nearest);
        }
        nearest
    }

    fn any(&self, ray: &SightRay, from: Option<&Departure<'_>>, s_max: f64) -> bool {
        let ray = SightRay { event: self.start(ray, from), k: self.rest_from_lab.light(ray.k) };
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let met = |number: u32, limit| {
            if self.placed[number as usize].any(&ray, limit) { -1.0 } else { limit }
        };
        self.tree.walk(&line, s_max, met) < 0.0
            || self.apart().any(|number| self.placed[number as usize].any(&ray, s_max))
    }

    fn until<'w>(
        &'w self,
        ray: &SightRay,
        from: Option<&Departure<'_>>,
        s_max: f64,
        enough: &mut dyn FnMut(Hit<'w>) -> bool,
    ) -> bool {
        let ray = SightRay { event: self.start(ray, from), k: self.rest_from_lab.light(ray.k) };
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let mut stops = |number: u32| {
            let placed = &self.placed[number as usize];
            let mut met = |met: Met| enough(Hit { s: met.s(), rest: self, placed, met });
            placed.until(&ray, s_max, &mut met)
        };
        self.tree.walk(&line, s_max, |number, limit| if stops(number) { -1.0 } else { limit }) < 0.0
            || self.apart().any(stops)
    }
}

/// All bodies.
#[derive(Debug, Clone, Default)]
pub struct World {
    /// One for each velocity.
    pub frames: Vec<RestFrame>,
}

impl World {
    /// What tells which of many rest frames a ray can meet, fastest for rays to this event; none where they are few.
    pub fn crowd(&self, event: Event) -> Option<Crowd> {
        Crowd::around(&self.frames, event)
    }

    /// Calls `visit` with every rest frame that a ray may meet, the limit of s so far, which it returns, or a negative one to end.
    #[inline]
    fn ask<'w>(
        &'w self,
        crowd: Option<&Crowd>,
        ray: &SightRay,
        s_max: f64,
        mut visit: impl FnMut(&'w RestFrame, f64) -> f64,
    ) -> f64 {
        if let Some(crowd) = crowd {
            return crowd.walk(ray, s_max, |number, limit| visit(&self.frames[number as usize], limit));
        }
        let mut limit = s_max;
        for rest in &self.frames {
            limit = visit(rest, limit);
            if limit < 0.0 {
                break;
            }
        }
        limit
    }

    /// The first body that the ray meets: the smallest s over all rest frames.
    pub fn nearest(&self, ray: &SightRay) -> Option<Hit<'_>> {
        self.nearest_from(ray, None, None)
    }

    /// The same for a ray that may leave a body.
    pub fn nearest_from(
        &self,
        ray: &SightRay,
        from: Option<&Departure<'_>>,
        crowd: Option<&Crowd>,
    ) -> Option<Hit<'_>> {
        let mut nearest: Option<Hit<'_>> = None;
        self.ask(crowd, ray, f64::INFINITY, |rest, limit| match rest.nearest(ray, from, limit) {
            Some((number, met)) => {
                nearest = Some(Hit { s: met.s(), rest, placed: &rest.placed[number as usize], met });
                met.s()
            }
            None => limit,
        });
        nearest
    }

    /// Whether anything stands in the way at 0 < s < `s_max`, of a ray that may leave a body.
    pub fn blocked(
        &self,
        ray: &SightRay,
        from: Option<&Departure<'_>>,
        s_max: f64,
        crowd: Option<&Crowd>,
    ) -> bool {
        self.ask(crowd, ray, s_max, |rest, limit| if rest.any(ray, from, s_max) { -1.0 } else { limit }) < 0.0
    }

    /// The surfaces of solids without end that an event is within.
    pub fn endless_around(&self, event: Event) -> impl Iterator<Item = usize> {
        self.frames.iter().flat_map(move |rest| {
            let x = (rest.rest_from_lab * event).x;
            let endless = rest.placed.iter().skip(rest.in_tree as usize).filter(|p| p.bounds().is_none());
            endless.filter(move |placed| placed.contains(x)).map(|placed| placed.surfaces as usize)
        })
    }

    /// All that stands in the way at 0 < s < `s_max`, in no order, until one is enough: whether it was. The ray may leave
    /// a body.
    pub fn until<'w>(
        &'w self,
        ray: &SightRay,
        from: Option<&Departure<'_>>,
        s_max: f64,
        crowd: Option<&Crowd>,
        mut enough: impl FnMut(Hit<'w>) -> bool,
    ) -> bool {
        let stops = |rest: &'w RestFrame, limit: f64| {
            if rest.until(ray, from, s_max, &mut enough) { -1.0 } else { limit }
        };
        self.ask(crowd, ray, s_max, stops) < 0.0
    }
}
