//! Shapes without a file, from the manifest's words.

use crate::manifest::{self, SolidForm};
use crate::solid::{Shape, Solid};
use glam::{DAffine3, DVec3};

/// The solid in the body's own coordinates; none if it has no extent.
pub(super) fn solid(written: &manifest::Solid) -> Option<Solid> {
    let sized = |shape: Shape, size: DVec3| Solid::from(shape).placed(DAffine3::from_scale(size));
    let all = |parts: &[manifest::Solid]| parts.iter().map(solid).collect::<Option<Vec<_>>>();
    let solid = match &written.form {
        SolidForm::Plane(_) => Some(Solid::from(Shape::Plane)),
        SolidForm::Sphere(sphere) => sized(Shape::Sphere, DVec3::splat(sphere.radius)),
        SolidForm::Box(cuboid) => sized(Shape::Box, cuboid.size),
        SolidForm::Cylinder(round) => {
            sized(Shape::Cylinder, DVec3::new(round.radius, round.height, round.radius))
        }
        SolidForm::Cone(round) => sized(Shape::Cone, DVec3::new(round.radius, round.height, round.radius)),
        SolidForm::Union(parts) => Some(Solid::union(all(parts)?)),
        SolidForm::Intersection(parts) => Some(Solid::intersection(all(parts)?)),
        SolidForm::Difference(parts) => {
            let mut parts = all(parts)?.into_iter();
            Some(parts.next()?.difference(parts))
        }
    }?;
    solid.placed(DAffine3::from_rotation_translation(written.pose.rotation, written.pose.at))
}
