//! Grazing rays: no light passes where there is none, and nothing shades itself.

use crate::support::{
    Body, Dice, Eye, Lantern, Stage, ball, black, built, close, cube, diffuse, icosphere, is_bright,
    light_from, plane, square, v,
};
use glam::{DAffine3, DQuat, DVec3};
use terrell::lamp::Beam;
use terrell::spacetime::{Event, Velocity};

fn sun(axis: DVec3, moves: Velocity) -> Lantern {
    let axis = axis / axis.length();
    Lantern::at(0.0, DVec3::ZERO, crate::support::flat(1.0)).with(Beam::Sun { axis }).moving(moves)
}

/// From a height over a floor, at an angle: the floor is met h / sin(angle) away, to the direction's own last digit. The
/// bound is 4 ε / angle, a part.
#[test]
fn plane_is_met_where_it_is_at_angles_down_to_1e_minus_9() {
    let turn = DQuat::from_axis_angle(v(0.0, 0.6, 0.8), 0.7);
    for height in [1e-3, 1.0, 1e3] {
        for angle in [1e-1, 1e-3, 1e-5, 1e-7, 1e-9] {
            for turn in [turn, DQuat::IDENTITY] {
                let (sin, cos) = libm::sincos(angle);
                let eye: Event = Event::new(0.0, turn * v(0.0, height, 0.0));
                let ray = light_from(eye.x + turn * v(cos, -sin, 0.0) * height, eye);
                let scene = Stage::of([Body::of(plane(DVec3::ZERO, turn * DVec3::Y), black())]).scene();
                let hit = scene.world.nearest(&ray).unwrap();
                close(hit.s, height / sin, 16.0 * f64::EPSILON / angle);
            }
        }
    }
}

/// A ball is passed or met as the ray's closest approach to its centre says, to 1e-14 of what the ray starts from.
#[test]
fn sphere_is_met_or_passed_to_a_part_1e_minus_13_of_its_radius() {
    let mut dice = Dice(5);
    for _ in 0..2000 {
        let n = dice.direction();
        let across = n.any_orthonormal_vector();
        let scene = Stage::of([Body::of(ball(1.0, DVec3::ZERO), black())]).scene();
        for off in [1e-13, 1e-9, 1e-5] {
            let distance = dice.between(1.5, 20.0);
            // A ray from the eye whose closest approach is 1 ± off.
            let meets = |closest: f64| {
                let eye: Event = Event::new(0.0, across * closest - n * distance);
                scene.world.nearest(&light_from(eye.x + n, eye)).is_some()
            };
            let off = off * distance;
            assert!(meets(1.0 - off) && !meets(1.0 + off), "{off} at {distance}");
        }
    }
}

/// Light that all but passes along a floor, of triangles and exact, at rest and fast: it is lit everywhere.
#[test]
fn floor_in_grazing_light_has_no_dark_pixel() {
    let mut dice = Dice(6);
    for gamma in [1.0 + 1e-9, 3.0, 1e4, 1e8] {
        for elevation in [1e-2, 1e-4, 1e-6, 1e-9] {
            if elevation < 64.0 * f64::EPSILON * gamma {
                continue; // Of the sun's direction, seen through the lab, so much is left open.
            }
            let velocity = Velocity::from_gamma(gamma, dice.direction());
            let turn = dice.turn();
            let floors = [
                Body::of(plane(v(0.0, -0.5, 0.0), DVec3::Y), diffuse(0.5)),
                Body::new(&built(square()), diffuse(0.5))
                    .sized(500.0)
                    .facing(DVec3::Y)
                    .mapped(DAffine3::from_translation(v(0.0, -0.5, 0.0))),
            ];
            for floor in floors {
                let light = turn * v(0.8, -elevation, 0.6);
                let stage = Stage::of([floor.mapped(DAffine3::from_quat(turn)).moving(velocity)]);
                let scene = stage.lit_by([sun(light, velocity)]).scene();
                let eye = Eye::at(0.0, DVec3::ZERO).moving(velocity);
                let mut dark = 0;
                for _ in 0..500 {
                    let down = turn * v(dice.between(-9.0, 9.0), -0.5, dice.between(-9.0, 9.0));
                    dark += u32::from(!is_bright(&scene, &eye.sight(down)));
                }
                assert_eq!(dark, 0, "γ = {gamma}, elevation {elevation}");
            }
        }
    }
}

/// The line between day and night on a ball is where the sun stands on the horizon, to 1e-9 rad and 256 γ ε.
#[test]
fn ball_is_lit_up_to_its_terminator_and_no_further() {
    let mut dice = Dice(7);
    for gamma in [1.0 + 1e-9, 3.0, 1e4, 1e8] {
        let velocity = Velocity::from_gamma(gamma, dice.direction());
        let body = Body::of(ball(1.0, v(4.0, 0.0, 0.0)), diffuse(0.5)).moving(velocity);
        let scene = Stage::of([body]).lit_by([sun(DVec3::NEG_Z, velocity)]).scene();
        let eye = Eye::at(0.0, DVec3::ZERO).moving(velocity);
        let (mut wrong, mut tried) = (0, 0);
        for _ in 0..4000 {
            let high = libm::pow(10.0, -dice.between(0.1, 7.0)) * [1.0, -1.0][dice.below(2)];
            let (sin, cos) = libm::sincos(dice.between(0.0, std::f64::consts::TAU));
            let across = (1.0 - high * high).sqrt();
            let n = v(across * cos, across * sin, high);
            let unsure = 1e-9 + 256.0 * f64::EPSILON * gamma;
            // Seen from the origin, and not at the outline.
            if n.x < -0.4 && high.abs() > unsure {
                tried += 1;
                wrong += u32::from(is_bright(&scene, &eye.sight(v(4.0, 0.0, 0.0) + n)) != (high > 0.0));
            }
        }
        assert!(wrong == 0 && tried > 500, "γ = {gamma}: {wrong} of {tried}");
    }
}

/// Rays aimed at edges of convex bodies from outside: what lies within the outline by 1e-6 is met.
#[test]
fn no_ray_is_lost_just_within_an_outline() {
    let mut dice = Dice(8);
    for mesh in [cube(), icosphere(3)] {
        let triangles = built(mesh);
        for gamma in [1.0 + 1e-9, 10.0, 1e5, 1e8] {
            let velocity = Velocity::from_gamma(gamma, dice.direction());
            for _ in 0..60 {
                let centre = dice.direction() * dice.between(3.0, 9.0);
                let body = Body::new(&triangles, black()).mapped(DAffine3::from_translation(centre));
                let scene = Stage::of([body.moving(velocity)]).scene();
                let eye = Eye::at(0.0, DVec3::ZERO).moving(velocity);
                for _ in 0..40 {
                    let corners = triangles.corners(dice.below(triangles.mesh.triangles.len()) as u32);
                    let place = corners[0].lerp(corners[1], dice.part()) * (1.0 - 1e-6);
                    assert!(scene.world.nearest(&eye.sight(centre + place)).is_some(), "γ = {gamma}");
                }
            }
        }
    }
}
