//! Shadow rays that start on a surface: a plate with a low fin on it, of any size, some metres from the origin, beside
//! another of a million metres.

use glam::{DAffine3, DQuat, DVec3, Vec3};
use std::sync::Arc;
use terrell::mesh::Mesh;
use terrell::scene::{Placement, WorldBuilder};
use terrell::spacetime::{Event, FourVector, Rest, SightRay, Velocity};
use terrell::tree::Line;
use terrell::triangles::Triangles;
use terrell::world::Form;

/// How a shadow ray is kept from the surface that it starts on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// By a bound on the rounding.
    Ours,
    /// By 0.1 mm, in f64.
    Fixed64,
    /// By 0.1 mm, in f32.
    Fixed32,
    /// By a part in 100,000 of the coordinates, in f32.
    Relative32,
    /// Not at all, in f64.
    Nothing,
}

pub const METHODS: [Method; 5] =
    [Method::Ours, Method::Fixed64, Method::Fixed32, Method::Relative32, Method::Nothing];

impl Method {
    pub fn name(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Fixed64 => "off by 1e-4 m, f64",
            Self::Fixed32 => "off by 1e-4 m, f32",
            Self::Relative32 => "off by 1e-5 of the coordinates, f32",
            Self::Nothing => "not moved off, f64",
        }
    }

    pub fn code(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Fixed64 => "ε64",
            Self::Fixed32 => "ε32",
            Self::Relative32 => "rel",
            Self::Nothing => "0",
        }
    }

    /// Where the ray starts, in the body's rest frame.
    fn start(self, place: DVec3, normal: DVec3) -> DVec3 {
        let single = |v: DVec3| v.as_vec3().as_dvec3();
        match self {
            Self::Ours | Self::Nothing => place,
            Self::Fixed64 => place + normal * 1e-4,
            Self::Fixed32 => single(single(place) + normal * 1e-4),
            Self::Relative32 => single(single(place) + normal * (1e-5 * place.abs().max_element())),
        }
    }
}

/// The fin's height, in units of the plate's half side.
const FIN: f32 = 1e-3;
const RAYS: u32 = 2000;

fn plate_with_fin() -> Arc<Triangles> {
    let v = Vec3::new;
    let positions = vec![
        v(-1.0, 0.0, -1.0),
        v(-1.0, 0.0, 1.0),
        v(1.0, 0.0, 1.0),
        v(1.0, 0.0, -1.0),
        v(0.0, 0.0, -1.0),
        v(0.0, 0.0, 1.0),
        v(0.0, FIN, 1.0),
        v(0.0, FIN, -1.0),
    ];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    Arc::new(Triangles::new(Arc::new(Mesh { positions, triangles, ..Mesh::default() })))
}

/// The part of shadow rays that are decided wrongly: half start just before the fin and must meet it, half behind it
/// and must meet nothing.
pub fn wrong(size: f64, method: Method) -> f64 {
    let turn = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.7);
    let centre = DVec3::new(2.0, 1.3, -5.0) * size.max(1.0);
    let map = DAffine3::from_scale_rotation_translation(DVec3::splat(size), turn, centre);
    let triangles = plate_with_fin();
    let velocity = Velocity::from_proper(DVec3::new(1.0, -1.0, 1.0));
    let placement = Placement { origin: Event::new(0.0, DVec3::ZERO), velocity };
    let mut builder = WorldBuilder::default();
    builder.add(0, placement, &Form::Mesh(triangles.clone()), map, 0);
    // Below it, back to back, one of a million metres.
    let centre = centre - turn * DVec3::Y * (2.0 * size.max(1.0));
    let large = DAffine3::from_scale_rotation_translation(DVec3::new(1e6, -1e6, 1e6), turn, centre);
    builder.add(1, placement, &Form::Mesh(triangles.clone()), large, 0);
    let world = builder.build();
    let rest_from_lab = placement.rest_from_lab();
    let sun = turn * DVec3::new(0.85, 0.5, 0.1).normalize();
    let eye = map.transform_point3(DVec3::new(0.1, 3.0, 0.2));
    let mut wrong = 0;
    for i in 0..RAYS {
        let (a, b) = ((f64::from(i) * 0.618_034).fract(), (f64::from(i) * 0.754_878).fract());
        let before = i % 2 == 0;
        let x = if before { -f64::from(FIN) * (0.2 + 0.8 * a) } else { 0.1 + 0.8 * a };
        let target = map.transform_point3(DVec3::new(x, 0.0, 1.6 * b - 0.8));
        let way = eye - target;
        let k = FourVector::<Rest>::new(way.length(), way);
        let event = rest_from_lab.undo(Event::new(0.0, eye));
        let ray = SightRay { event, k: rest_from_lab.boost().inverse() * k };
        let Some(hit) = world.nearest(&ray) else { continue };
        let spot = hit.spot(&ray);
        let met = if method == Method::Ours {
            let k = rest_from_lab.boost().inverse() * FourVector::<Rest>::new(1.0, -sun);
            let from = spot.departure(hit.rest);
            world.blocked(&SightRay { event: from.event, k }, Some(&from), f64::INFINITY, None)
        } else {
            let start = method.start(spot.event.x, spot.facet_normal);
            let back = map.inverse();
            let line = Line { origin: back.transform_point3(start), step: back.transform_vector3(sun) };
            triangles.any(&line, f64::INFINITY)
        };
        wrong += u32::from(met != before);
    }
    f64::from(wrong) / f64::from(RAYS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_one_metre_small_steps_off_decide_rightly_and_none_does_not() {
        for method in [Method::Ours, Method::Fixed64, Method::Fixed32] {
            assert_eq!(wrong(1.0, method), 0.0, "{method:?}");
        }
        assert!(wrong(1.0, Method::Nothing) > 0.05);
    }
}
