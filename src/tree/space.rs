//! Lines and boxes, and the units of a tree: those in which all that it holds lies within [-1, 1].

use glam::{DVec3, Vec3};
use obvhs::aabb::Aabb;
use rayon::prelude::*;

/// Half the widening of each box, in units in which the whole tree lies within [-1, 1].
///
/// A walk rounds its start (6e-8), its direction (6e-8 over a length up to 3.5) and the box corners (6e-8).
const PAD: f32 = 1e-6;

/// How much further a line leaves a box than is computed: two roundings of the distance (Ize 2013), and some.
pub(super) const SLACK: f32 = 1.000_001;

/// The points `origin + s step`, s > 0.
///
/// From more than 1e9 sizes of a tree away the rounding of its start passes over what is in the tree, which it may then miss.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// Where s is zero.
    pub origin: DVec3,
    /// What one unit of s moves.
    pub step: DVec3,
}

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub lo: DVec3,
    /// Largest coordinates.
    pub hi: DVec3,
}

impl Bounds {
    /// Of no point.
    pub const EMPTY: Self = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };

    /// The smallest that holds all the points.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { lo: b.lo.min(p), hi: b.hi.max(p) })
    }

    /// The smallest that holds both.
    pub fn with(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The eight corners.
    pub fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { self.lo[axis] } else { self.hi[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Where the line is inside, as a stretch of s (which may be empty: first > last).
    ///
    /// `inverse`: one over the line's step, finite also where that is zero.
    #[inline]
    fn stretch(self, line: &Line, inverse: DVec3) -> (f64, f64) {
        let (a, b) = ((self.lo - line.origin) * inverse, (self.hi - line.origin) * inverse);
        (a.min(b).max_element(), a.max(b).min_element())
    }
}

/// The units of a tree.
#[derive(Debug, Clone, Copy)]
pub(super) struct Space {
    pub(super) bounds: Bounds,
    // The bounds, widened by more than all padding.
    pub(super) entrance: Bounds,
    pub(super) centre: DVec3,
    pub(super) scale: f64,
}

impl Space {
    /// Those of a tree over so many items with these boxes.
    pub(super) fn around(count: usize, of: impl Fn(usize) -> Bounds + Sync + Send) -> Self {
        let bounds = (0..count).into_par_iter().map(of).reduce(|| Bounds::EMPTY, Bounds::with);
        if count == 0 {
            return Self { bounds, entrance: bounds, centre: DVec3::ZERO, scale: 1.0 };
        }
        let centre = 0.5 * bounds.lo + 0.5 * bounds.hi;
        let half = (bounds.hi - centre).max_element();
        // A single point still has a size: that of the rounding at its place.
        let half = half.max(centre.abs().max_element() * 1e-12).max(1e-200);
        let pad = f64::from(4.0 * PAD) * half;
        let entrance = Bounds { lo: bounds.lo - pad, hi: bounds.hi + pad };
        Self { bounds, entrance, centre, scale: 1.0 / half }
    }

    /// Half the widening of each box, as a length.
    pub(super) fn pad(&self) -> f64 {
        f64::from(PAD) / self.scale
    }

    /// A box in these units, padded.
    pub(super) fn padded(&self, b: &Bounds) -> Aabb {
        let lo = ((b.lo - self.centre) * self.scale).as_vec3() - PAD;
        let hi = ((b.hi - self.centre) * self.scale).as_vec3() + PAD;
        Aabb::new(lo.into(), hi.into())
    }

    /// The beginning of a walk: moves the start to the box in `f64`, and only then goes to `f32`. None for a line that
    /// does not meet the box of all.
    #[inline]
    pub(super) fn enter(&self, line: &Line, s_max: f64) -> Option<Entered> {
        // Finite, so that nothing times zero is not a number.
        let inverse = (1.0 / line.step).clamp(DVec3::splat(-1e300), DVec3::splat(1e300));
        let (first, last) = self.entrance.stretch(line, inverse);
        let first = if first > 0.0 { first } else { 0.0 };
        // Not `first > last`: a line that is not a number meets nothing.
        if !(first <= last && first < s_max) {
            return None;
        }
        let speed = line.step.length();
        let length = speed * self.scale;
        let start = ((line.origin + line.step * first - self.centre) * self.scale).as_vec3();
        // Below 1e-12 of the length a component moves nothing across the tree.
        let inverse = (inverse * speed).clamp(DVec3::splat(-1e12), DVec3::splat(1e12)).as_vec3();
        let mut walk = Entered { start, inverse, first, length, t_max: f32::MAX };
        walk.limit(s_max);
        // From here on nothing is infinite but boxes of nothing, and no inverse is zero.
        (length > 0.0 && length.is_finite() && start.is_finite()).then_some(walk)
    }
}

/// A line inside a tree: from the start with unit speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entered {
    pub(super) start: Vec3,
    pub(super) inverse: Vec3,
    pub(super) first: f64,
    pub(super) length: f64,
    pub(super) t_max: f32,
}

impl Entered {
    /// Where the line enters a box; infinite if it does not.
    #[inline]
    pub(super) fn entry(&self, lo: Vec3, hi: Vec3) -> f32 {
        let a = (lo - self.start) * self.inverse;
        let b = (hi - self.start) * self.inverse;
        let (near, far) = (a.min(b), a.max(b));
        let enter = near.x.max(near.y).max(near.z.max(0.0));
        let leave = far.x.min(far.y).min(far.z);
        if enter <= leave * SLACK { enter } else { f32::INFINITY }
    }

    #[inline]
    pub(super) fn limit(&mut self, s_max: f64) {
        // More than the rounding of s and of the first, which are large where the line starts far away.
        let s = s_max - self.first + 4.0 * f64::EPSILON * s_max;
        self.t_max = (s * self.length * 1.000_001).min(f64::from(f32::MAX)) as f32;
    }
}
