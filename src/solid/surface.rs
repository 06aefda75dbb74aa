//! The surfaces of the shapes, in their own coordinates: normals, texture coordinates, extents.

use super::Shape;
use crate::tree::Bounds;
use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

// Faces of all shapes but the box, whose faces are -x, +x, -y, +y, -z, +z.
pub(super) const SIDE: u8 = 0;
pub(super) const TOP: u8 = 1;
pub(super) const BOTTOM: u8 = 2;

/// The surface around a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// The point, moved onto the surface of its leaf.
    pub place: DVec3,
    /// Unit vector out of the whole solid.
    pub normal: DVec3,
    /// Texture coordinates: seen from outside its leaf u grows to the right and v downwards.
    pub uv: DVec2,
    /// dP/du; zero at poles and apex.
    pub tangent_u: DVec3,
    /// dP/dv.
    pub tangent_v: DVec3,
}

/// Turns a point about the y axis by longitude: d/du of a point, u = longitude / 2π.
fn eastward(p: DVec3) -> DVec3 {
    TAU * DVec3::new(p.z, 0.0, -p.x)
}

/// Longitude / 2π in [0, 1): 0 at +x, 1/4 at -z, so that it grows to the right of who looks from outside, +y up.
fn longitude(p: DVec3) -> f64 {
    let u = libm::atan2(-p.z, p.x) / TAU;
    let u = if u < 0.0 { u + 1.0 } else { u + 0.0 };
    if u < 1.0 { u } else { 0.0 }
}

/// The unit vector from the y axis to the point; some such vector on the axis itself.
fn radial(p: DVec3) -> DVec3 {
    p.with_y(0.0).normalize_or(DVec3::X)
}

/// A point moved into the disk of a cap.
fn onto_disk(p: DVec3, y: f64) -> DVec3 {
    let across = p.with_y(0.0);
    (if across.length_squared() > 1.0 { across.normalize() } else { across }).with_y(y)
}

/// A disk in the square 0..1, facing up or down.
fn disk(p: DVec3, up: f64) -> Facet {
    let place = onto_disk(p, p.y);
    Facet {
        place,
        normal: DVec3::Y * up,
        uv: 0.5 + 0.5 * DVec2::new(place.x, place.z * up),
        tangent_u: 2.0 * DVec3::X,
        tangent_v: 2.0 * DVec3::Z * up,
    }
}

fn box_face(p: DVec3, face: u8) -> Facet {
    // Outwards, to the right, down.
    let (normal, right, down) = match face {
        0 => (DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y),
        1 => (DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y),
        2 => (DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z),
        3 => (DVec3::Y, DVec3::X, DVec3::Z),
        4 => (DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y),
        _ => (DVec3::Z, DVec3::X, DVec3::NEG_Y),
    };
    let mut place = p.clamp(DVec3::splat(-0.5), DVec3::splat(0.5));
    let axis = usize::from(face / 2).min(2);
    place[axis] = 0.5 * normal[axis];
    let uv = 0.5 + DVec2::new(place.dot(right), place.dot(down));
    Facet { place, normal, uv, tangent_u: right, tangent_v: down }
}

fn sphere_at(p: DVec3) -> Facet {
    let place = p.normalize_or(DVec3::Y);
    let across = libm::hypot(place.x, place.z);
    let uv = DVec2::new(longitude(place), libm::atan2(across, place.y) / PI);
    let tangent_v = PI * (radial(place) * place.y).with_y(-across);
    Facet { place, normal: place, uv, tangent_u: eastward(place), tangent_v }
}

fn cylinder_side(p: DVec3) -> Facet {
    let normal = radial(p);
    let place = normal.with_y(p.y.clamp(-0.5, 0.5));
    let uv = DVec2::new(longitude(normal), 0.5 - place.y);
    Facet { place, normal, uv, tangent_u: eastward(place), tangent_v: DVec3::NEG_Y }
}

fn cone_side(p: DVec3) -> Facet {
    let out = radial(p);
    // The nearest point of the generator, by its depth below the apex, which is the radius there.
    let depth = (0.5 * (p.dot(out) + 0.5 - p.y)).clamp(0.0, 1.0);
    let place = (out * depth).with_y(0.5 - depth);
    let on_axis = p.x == 0.0 && p.z == 0.0;
    let normal = if on_axis { DVec3::Y } else { out.with_y(1.0).normalize() };
    let uv = DVec2::new(longitude(out), depth);
    Facet { place, normal, uv, tangent_u: eastward(place), tangent_v: out.with_y(-1.0) }
}

impl Shape {
    /// A vector out of the surface, of any length; zero at an apex.
    #[inline]
    pub(super) fn outwards(self, face: u8, p: DVec3) -> DVec3 {
        match (self, face) {
            (Self::Plane, _) | (Self::Cylinder | Self::Cone, TOP) => DVec3::Y,
            (Self::Cylinder | Self::Cone, BOTTOM) => DVec3::NEG_Y,
            (Self::Sphere, _) => p,
            (Self::Box, _) => DVec3::AXES[usize::from(face / 2).min(2)] * (f64::from(face % 2) - 0.5),
            (Self::Cylinder, _) => p.with_y(0.0),
            (Self::Cone, _) => p.with_y((p.x * p.x + p.z * p.z).sqrt()),
        }
    }

    /// The surface at a point near it, as of the shape alone in its own coordinates.
    pub(super) fn facet(self, face: u8, p: DVec3) -> Facet {
        match (self, face) {
            (Self::Plane, _) => Facet {
                place: p.with_y(0.0),
                normal: DVec3::Y,
                uv: DVec2::new(p.x, p.z),
                tangent_u: DVec3::X,
                tangent_v: DVec3::Z,
            },
            (Self::Sphere, _) => sphere_at(p),
            (Self::Box, _) => box_face(p, face),
            (Self::Cylinder | Self::Cone, TOP) => disk(p.with_y(0.5), 1.0),
            (Self::Cylinder | Self::Cone, BOTTOM) => disk(p.with_y(-0.5), -1.0),
            (Self::Cylinder, _) => cylinder_side(p),
            (Self::Cone, _) => cone_side(p),
        }
    }

    /// Boxes that hold the placed shape, and all that is not it.
    pub(super) fn extents(self, outer_from_own: &DAffine3, own_from_outer: &DAffine3) -> [Bounds; 2] {
        let rows = outer_from_own.matrix3.transpose();
        let rows = [rows.x_axis, rows.y_axis, rows.z_axis];
        let per_axis = |reach: fn(DVec3) -> (f64, f64)| {
            let reach = rows.map(reach);
            Bounds {
                lo: outer_from_own.translation + DVec3::from(reach.map(|r| r.0)),
                hi: outer_from_own.translation + DVec3::from(reach.map(|r| r.1)),
            }
        };
        let round = match self {
            Self::Plane => return half_spaces(own_from_outer),
            Self::Sphere => per_axis(|row| (-row.length(), row.length())),
            Self::Box => per_axis(|row| (-0.5 * row.abs().element_sum(), 0.5 * row.abs().element_sum())),
            Self::Cylinder => per_axis(|row| {
                let reach = 0.5 * row.y.abs() + row.with_y(0.0).length();
                (-reach, reach)
            }),
            Self::Cone => per_axis(|row| {
                let (apex, disk) = (0.5 * row.y, row.with_y(0.0).length());
                (apex.min(-apex - disk), apex.max(-apex + disk))
            }),
        };
        [round, EVERYWHERE]
    }
}

/// The box of all points.
pub(super) const EVERYWHERE: Bounds = Bounds { lo: DVec3::NEG_INFINITY, hi: DVec3::INFINITY };

/// A placed plane has bounds where it is square to an axis.
fn half_spaces(own_from_outer: &DAffine3) -> [Bounds; 2] {
    let row = own_from_outer.matrix3.row(1);
    let mut sides = [EVERYWHERE; 2];
    for axis in 0..3 {
        if row.abs() == DVec3::AXES[axis] * row[axis].abs() {
            let face = -own_from_outer.translation.y / row[axis];
            let inner = usize::from(row[axis] < 0.0);
            sides[inner].hi[axis] = face;
            sides[1 - inner].lo[axis] = face;
        }
    }
    sides
}
