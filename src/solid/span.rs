//! Where a line is inside each shape, in the shape's own coordinates.
//!
//! Discriminants come from how the line passes (its closest approach, or its moment about the apex), not from
//! differences of squares: an origin far away costs its own rounding only.

use super::Shape;
use super::surface::{BOTTOM, SIDE, TOP};
use crate::tree::Line;
use glam::DVec3;

/// Where a line passes through the surface of a shape; at infinity where it never does.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    pub(super) s: f64,
    pub(super) face: u8,
}

/// Where a line is inside a shape: one span, for all shapes are convex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub(super) enter: End,
    pub(super) exit: End,
}

impl Span {
    const ALL: Self = Self::side(f64::NEG_INFINITY, f64::INFINITY);

    const fn side(enter: f64, exit: f64) -> Self {
        Self { enter: End { s: enter, face: SIDE }, exit: End { s: exit, face: SIDE } }
    }

    /// What both have in common.
    #[inline]
    fn and(self, other: Self) -> Self {
        Self {
            enter: if other.enter.s > self.enter.s { other.enter } else { self.enter },
            exit: if other.exit.s < self.exit.s { other.exit } else { self.exit },
        }
    }
}

/// Steps below this move nothing: their inverses would not be finite.
const STILL: f64 = 1e-280;

/// Where `lo` <= o + d s <= `hi`. A line that lies in a face is inside: two boxes that touch have no gap.
#[inline]
fn slab(o: f64, d: f64, [lo, hi]: [f64; 2], faces: [u8; 2]) -> Option<Span> {
    if d.abs() < STILL {
        return (lo <= o && o <= hi).then_some(Span::ALL);
    }
    let inverse = 1.0 / d;
    let lower = End { s: (lo - o) * inverse, face: faces[0] };
    let upper = End { s: (hi - o) * inverse, face: faces[1] };
    Some(if d > 0.0 { Span { enter: lower, exit: upper } } else { Span { enter: upper, exit: lower } })
}

/// Where |o + d s| <= 1.
#[inline]
fn ball(o: DVec3, d: DVec3) -> Option<Span> {
    let inverse = 1.0 / d.length_squared();
    let closest = -o.dot(d) * inverse;
    let within = 1.0 - (o + d * closest).length_squared();
    // Not `within <= 0`: what is not a number is no span.
    if !(within > 0.0) {
        return None;
    }
    let half = (within * inverse).sqrt();
    Some(Span::side(closest - half, closest + half))
}

fn cylinder(o: DVec3, d: DVec3) -> Option<Span> {
    let caps = slab(o.y, d.y, [-0.5, 0.5], [BOTTOM, TOP])?;
    let (o, across) = (o.with_y(0.0), d.with_y(0.0));
    // Along the axis: the drift is no number to divide by.
    if across.length_squared() <= 1e-60 * d.y * d.y {
        return (o.length_squared() <= 1.0).then_some(caps);
    }
    Some(ball(o, across)?.and(caps))
}

fn cone(o: DVec3, d: DVec3) -> Option<Span> {
    // From the apex down, where the cone is x² + z² <= y².
    let (p, d) = (DVec3::new(o.x, 0.5 - o.y, o.z), DVec3::new(d.x, -d.y, d.z));
    let depth = slab(p.y, d.y, [0.0, 1.0], [SIDE, BOTTOM])?;
    let form = |a: DVec3, b: DVec3| a.x * b.x + a.z * b.z - a.y * b.y;
    // a s² + 2 b s + c <= 0. A zero must be +0 to lead to the right infinity.
    let (a, b, c) = (form(d, d) + 0.0, form(p, d), form(p, p));
    // b² - a c, by the identity that spares it that difference: it does not depend on how far away the origin is.
    let w = p.cross(d);
    let square = w.x * w.x + w.z * w.z - w.y * w.y;
    if a >= 0.0 && square <= 0.0 {
        return None;
    }
    let root = square.max(0.0).sqrt();
    let m = if b > 0.0 { -b - root } else { root - b };
    let (s, t) = if m == 0.0 { (0.0, 0.0) } else { (m / a, c / m) };
    let (first, last) = (s.min(t), s.max(t));
    // A flat line is inside between the roots, a steep one beyond them, above or below the apex.
    let side = if a >= 0.0 {
        Span::side(first, last)
    } else if d.y > 0.0 {
        Span::side(last, f64::INFINITY)
    } else {
        Span::side(f64::NEG_INFINITY, first)
    };
    Some(side.and(depth))
}

impl Shape {
    /// Where the line is inside; none if it only touches.
    #[inline]
    pub(super) fn span(self, line: &Line) -> Option<Span> {
        let (o, d) = (line.origin, line.step);
        let span = match self {
            Self::Plane => slab(o.y, d.y, [f64::NEG_INFINITY, 0.0], [SIDE, SIDE]),
            Self::Sphere => ball(o, d),
            Self::Box => {
                let [x, y, z] = [0, 1, 2].map(|axis: u8| {
                    let i = usize::from(axis);
                    slab(o[i], d[i], [-0.5, 0.5], [2 * axis, 2 * axis + 1])
                });
                Some(x?.and(y?).and(z?))
            }
            Self::Cylinder => cylinder(o, d),
            Self::Cone => cone(o, d),
        }?;
        (span.enter.s < span.exit.s).then_some(span)
    }

    /// Whether the point is inside or on the surface.
    pub(super) fn contains(self, p: DVec3) -> bool {
        let across = p.x * p.x + p.z * p.z;
        match self {
            Self::Plane => p.y <= 0.0,
            Self::Sphere => p.length_squared() <= 1.0,
            Self::Box => p.abs().max_element() <= 0.5,
            Self::Cylinder => across <= 1.0 && p.y.abs() <= 0.5,
            Self::Cone => p.y.abs() <= 0.5 && across <= (0.5 - p.y) * (0.5 - p.y),
        }
    }
}
