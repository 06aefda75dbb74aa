//! What a sight ray can meet: bodies grouped by rest frame, each mesh with one tree.
//!
//! This is the only place where rays pass between the lab and the rest frames of bodies. A ray enters a rest
//! frame with the limit of s that the frames before it have left; no event is ever transformed back to be compared.

mod crowd;
mod hit;
mod placed;
mod rays;

pub use crowd::Crowd;
pub use hit::{Departure, Hit, Spot};
use placed::Met;
pub use placed::{Form, Placed};
use rays::Rays;

use crate::spacetime::{Event, Lab, Poincare, Rest, SightRay};
use crate::tree::{Bounds, Each, Line, Lines, MANY, Tree, each, some_of};

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

    /// A ray here: from a body of this frame without the way through the lab.
    #[inline]
    fn line(&self, ray: &SightRay, from: Option<&Departure<'_>>) -> Line {
        let start = match from {
            Some(from) if std::ptr::eq(from.rest, self) => from.at,
            _ => self.rest_from_lab * ray.event,
        };
        Line { origin: start.x, step: -self.rest_from_lab.light(ray.k).x }
    }

    fn nearest(&self, ray: &SightRay, from: Option<&Departure<'_>>, s_max: f64) -> Option<(u32, Met)> {
        let line = self.line(ray, from);
        let mut nearest = None;
        let mut limit = self.tree.walk(&line, s_max, |number, limit| {
            let met = self.placed[number as usize].nearest(&line, limit.next_up());
            met.map_or(limit, |met| nearer(number, met, limit, &mut nearest))
        });
        for number in self.apart() {
            let met = self.placed[number as usize].nearest(&line, limit.next_up());
            limit = met.map_or(limit, |met| nearer(number, met, limit, &mut nearest));
        }
        nearest
    }

    fn any(&self, ray: &SightRay, from: Option<&Departure<'_>>, s_max: f64) -> bool {
        let line = self.line(ray, from);
        let met = |number: u32, limit| {
            if self.placed[number as usize].any(&line, limit) { -1.0 } else { limit }
        };
        self.tree.walk(&line, s_max, met) < 0.0
            || self.apart().any(|number| self.placed[number as usize].any(&line, s_max))
    }

    /// The same as [`Self::nearest`] for lines that go together: each limit of s becomes that of what is met.
    fn nearest_many(&self, lines: &Lines, limits: &mut Each<f64>) -> Each<Option<(u32, Met)>> {
        let mut nearest = [None; MANY];
        let mut look = |number: u32, limits: &mut Each<f64>| {
            let within = each(|i| limits[i].next_up());
            self.placed[number as usize].nearest_many(lines, &within, |i, met| {
                limits[i] = nearer(number, met, limits[i], &mut nearest[i]);
            });
        };
        self.tree.walk_many(lines, limits, &mut look);
        self.apart().for_each(|number| look(number, limits));
        nearest
    }

    /// The same as [`Self::any`] for lines that go together: their limits become negative where something is met.
    fn any_many(&self, lines: &Lines, limits: &mut Each<f64>) {
        let look = |number: u32, limits: &mut Each<f64>| {
            let met = self.placed[number as usize].any_many(lines, limits);
            (0..MANY).filter(|i| met >> i & 1 == 1).for_each(|i| limits[i] = -1.0);
        };
        self.tree.walk_many(lines, limits, look);
        self.apart().for_each(|number| look(number, limits));
    }

    fn until<'w>(
        &'w self,
        ray: &SightRay,
        from: Option<&Departure<'_>>,
        s_max: f64,
        enough: &mut dyn FnMut(Hit<'w>) -> bool,
    ) -> bool {
        let line = self.line(ray, from);
        let mut stops = |number: u32| {
            let placed = &self.placed[number as usize];
            let mut met = |met: Met| enough(Hit { s: met.s(), rest: self, placed, met });
            placed.until(&line, s_max, &mut met)
        };
        self.tree.walk(&line, s_max, |number, limit| if stops(number) { -1.0 } else { limit }) < 0.0
            || self.apart().any(stops)
    }
}

/// Puts what is met in place of what was met so far if it comes before; returns the limit of s. (At the same s it is that with the
/// smallest number, whichever was asked first.)
#[inline]
fn nearer(number: u32, met: Met, limit: f64, nearest: &mut Option<(u32, Met)>) -> f64 {
    let s = met.s();
    if s < limit || nearest.is_some_and(|(other, before)| s == before.s() && number < other) {
        *nearest = Some((number, met));
        return s;
    }
    limit
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
        self.ask(crowd, ray, f64::INFINITY, |rest, limit| match rest.nearest(ray, from, limit.next_up()) {
            Some((number, met)) => {
                let hit = Hit { s: met.s(), rest, placed: &rest.placed[number as usize], met };
                self.nearer(hit, limit, &mut nearest)
            }
            None => limit,
        });
        nearest
    }

    /// The same as [`Self::nearest_from`] for up to 16 rays of no body that go together.
    pub fn nearest_many<'r>(
        &self,
        rays: impl IntoIterator<Item = &'r SightRay>,
        crowd: Option<&Crowd>,
    ) -> [Option<Hit<'_>>; MANY] {
        let mut nearest = [None; MANY];
        let rays = Rays::of(rays.into_iter().map(|ray| (ray, None, f64::INFINITY)));
        let mut limits = rays.s_max;
        self.ask_many(&rays, crowd, &mut limits, |rest, limits| {
            let mut within = each(|i| limits[i].next_up());
            for (i, found) in rest.nearest_many(&rays.within(rest), &mut within).into_iter().enumerate() {
                let Some((placed, met)) = found else { continue };
                let hit = Hit { s: met.s(), rest, placed: &rest.placed[placed as usize], met };
                limits[i] = self.nearer(hit, limits[i], &mut nearest[i]);
            }
        });
        nearest
    }

    /// The same as [`Self::blocked`] for up to 16 rays that go together, each with where it leaves and its limit of s: bit by bit.
    pub fn blocked_many<'r>(
        &self,
        rays: impl IntoIterator<Item = (&'r SightRay, &'r Departure<'r>, f64)>,
        crowd: Option<&Crowd>,
    ) -> u32 {
        let rays = Rays::of(rays.into_iter().map(|(ray, from, s_max)| (ray, Some(from), s_max)));
        let mut limits = rays.s_max;
        self.ask_many(&rays, crowd, &mut limits, |rest, limits| rest.any_many(&rays.within(rest), limits));
        (0..rays.count()).filter(|i| limits[*i] < 0.0).fold(0, |bits, i| bits | 1 << i)
    }

    /// Asks the rest frames that any of some rays may meet before its limit of s: `visit` lowers the limits of those rays that it may be
    /// for; the others have negative ones meanwhile.
    fn ask_many<'w>(
        &'w self,
        rays: &Rays<'_>,
        crowd: Option<&Crowd>,
        limits: &mut Each<f64>,
        mut visit: impl FnMut(&'w RestFrame, &mut Each<f64>),
    ) {
        let Some(crowd) = crowd else {
            for rest in &self.frames {
                visit(rest, limits);
                if limits.iter().all(|limit| *limit < 0.0) {
                    break;
                }
            }
            return;
        };
        crowd.meeting(rays, |number, first| {
            // (What has met nothing goes on without end, and so far is a box that it does not enter.)
            let concerns = |i: usize| first[i] < f64::INFINITY && first[i] <= limits[i];
            let concerned = (0..MANY).fold(0, |bits, i| bits | u32::from(concerns(i)) << i);
            if concerned != 0 {
                some_of(concerned, limits, |limits| visit(&self.frames[number as usize], limits));
            }
        });
    }

    /// Puts a hit in place of the nearest so far if it comes before; returns the limit of s. (At the same s it is that in the first
    /// rest frame, whichever was asked first.)
    #[inline]
    fn nearer<'w>(&self, hit: Hit<'w>, limit: f64, nearest: &mut Option<Hit<'w>>) -> f64 {
        let place = |hit: &Hit<'_>| self.frames.iter().position(|rest| std::ptr::eq(rest, hit.rest));
        let wins = |other: &Hit<'_>| hit.s == other.s && place(&hit) < place(other);
        if hit.s < limit || nearest.as_ref().is_some_and(wins) {
            *nearest = Some(hit);
            return hit.s;
        }
        limit
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

    /// Whether an event may be within what surfaces enclose: in the box of all those of a rest frame to which `of` gives the same
    /// number, or something of them has no end.
    pub fn may_enclose(&self, event: Event, of: impl Fn(usize) -> Option<u32>) -> bool {
        self.frames.iter().any(|rest| {
            let mut boxes: Vec<(u32, Option<Bounds>)> = Vec::new();
            for placed in &rest.placed {
                for number in placed.all_surfaces().filter_map(&of) {
                    let own = placed.bounds();
                    match boxes.iter_mut().find(|(known, _)| *known == number) {
                        Some((_, all)) => *all = all.zip(own).map(|(all, own)| all.with(own)),
                        None => boxes.push((number, own)),
                    }
                }
            }
            let x = (rest.rest_from_lab * event).x;
            let holds = |all: Bounds| {
                let pad = 1e-9 * (all.hi - all.lo + x.abs());
                (all.lo - pad).cmple(x).all() && x.cmple(all.hi + pad).all()
            };
            boxes.iter().any(|(_, all)| all.is_none_or(holds))
        })
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
