//! Solids as sets define them, and lines through them.

use crate::support::{Dice, near, v};
use glam::{DAffine3, DMat3, DVec3};
use terrell::solid::{Crossing, Facet, Shape, Solid};
use terrell::tree::Line;

pub(super) const ALL: [Shape; 5] = [Shape::Plane, Shape::Sphere, Shape::Box, Shape::Cylinder, Shape::Cone];

/// A solid as sets define it, to compare with.
pub(super) enum Set {
    Leaf(Shape, DAffine3),
    Union(Vec<Self>),
    Intersection(Vec<Self>),
    Difference(Box<Self>, Vec<Self>),
    Complement(Box<Self>),
}

impl Set {
    /// Any, of up to so many storeys.
    pub(super) fn random(dice: &mut Dice, storeys: usize) -> Self {
        let storeys = storeys.saturating_sub(1);
        let kind = if storeys == 0 { 0 } else { dice.below(5) };
        let members = |dice: &mut Dice| (0..dice.below(4)).map(|_| Self::random(dice, storeys)).collect();
        match kind {
            0 => Self::Leaf(ALL[dice.below(5)], map(dice)),
            1 => Self::Union(members(dice)),
            2 => Self::Intersection(members(dice)),
            3 => Self::Difference(Box::new(Self::random(dice, storeys)), members(dice)),
            _ => Self::Complement(Box::new(Self::random(dice, storeys))),
        }
    }

    pub(super) fn contains(&self, p: DVec3) -> bool {
        match self {
            Self::Leaf(shape, map) => inside(*shape, map.inverse().transform_point3(p)),
            Self::Union(members) => members.iter().any(|m| m.contains(p)),
            Self::Intersection(members) => members.iter().all(|m| m.contains(p)),
            Self::Difference(whole, parts) => whole.contains(p) && !parts.iter().any(|m| m.contains(p)),
            Self::Complement(other) => !other.contains(p),
        }
    }

    pub(super) fn solid(&self) -> Solid {
        match self {
            Self::Leaf(shape, map) => placed(*shape, *map),
            Self::Union(members) => Solid::union(members.iter().map(Self::solid)),
            Self::Intersection(members) => Solid::intersection(members.iter().map(Self::solid)),
            Self::Difference(whole, parts) => whole.solid().difference(parts.iter().map(Self::solid)),
            Self::Complement(other) => other.solid().complement(),
        }
    }
}

/// Whether the point is in the open shape.
pub(super) fn inside(shape: Shape, p: DVec3) -> bool {
    let radius = libm::hypot(p.x, p.z);
    match shape {
        Shape::Plane => p.y < 0.0,
        Shape::Sphere => p.length() < 1.0,
        Shape::Box => p.abs().max_element() < 0.5,
        Shape::Cylinder => radius < 1.0 && p.y.abs() < 0.5,
        Shape::Cone => p.y > -0.5 && radius < 0.5 - p.y,
    }
}

/// Moved, turned, stretched, sheared and every other time mirrored.
pub(super) fn map(dice: &mut Dice) -> DAffine3 {
    let sizes = v(dice.between(0.3, 2.0), dice.between(0.3, 2.0), dice.between(0.3, 2.0));
    let sizes = if dice.part() < 0.5 { sizes.with_x(-sizes.x) } else { sizes };
    let turned = DMat3::from_quat(dice.turn()) * DMat3::from_diagonal(sizes) * DMat3::from_quat(dice.turn());
    DAffine3 { matrix3: turned, translation: dice.in_cube() }
}

pub(super) fn placed(shape: Shape, map: DAffine3) -> Solid {
    Solid::from(shape).placed(map).unwrap()
}

/// A box from its corners.
pub(super) fn cuboid(lo: DVec3, hi: DVec3) -> Solid {
    placed(Shape::Box, DAffine3::from_translation(0.5 * (lo + hi)) * DAffine3::from_scale(hi - lo))
}

pub(super) fn at(line: &Line, s: f64) -> DVec3 {
    line.origin + line.step * s
}

pub(super) fn random_line(dice: &mut Dice) -> Line {
    let step = dice.direction() * libm::pow(10.0, dice.between(-3.0, 3.0));
    Line { origin: dice.in_cube() * 2.0 + step * dice.between(-2.0, 2.0) / step.length(), step }
}

pub(super) fn all(solid: &Solid, line: &Line) -> Vec<Crossing> {
    let mut found = Vec::new();
    solid.crossings(line, f64::NEG_INFINITY, f64::INFINITY, &mut |crossing| {
        found.push(crossing);
        true
    });
    found
}

pub(super) fn first(solid: &Solid, origin: DVec3, step: DVec3) -> Option<(f64, Facet)> {
    let line = Line { origin, step };
    let crossing = solid.nearest(&line, 0.0, f64::INFINITY)?;
    Some((crossing.s, solid.surface_at(&crossing, at(&line, crossing.s))))
}

/// Both have the same crossings.
#[track_caller]
pub(super) fn same(one: &Solid, other: &Solid, line: &Line) {
    let (one, other) = (all(one, line), all(other, line));
    assert_eq!(one.len(), other.len(), "{one:?}\n{other:?}");
    for (a, b) in one.iter().zip(&other) {
        near(a.s * line.step.length(), b.s * line.step.length(), 1e-9);
        assert_eq!(a.entering, b.entering);
    }
}
