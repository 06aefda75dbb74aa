//! Very blue and very red light, and lamps that come very near.

use super::sound_picture;
use crate::support::{
    Body, Eye, Lantern, Stage, ball, black_body, close, diffuse, exposed, flat, glowing, look, plane, v,
};
use glam::DVec3;
use terrell::lamp::Beam;
use terrell::spacetime::{Event, Velocity};
use terrell::spectrum::Wavelengths;

/// The Lorentz factor of straight approach with a Doppler factor (or its inverse, of recession).
fn gamma_of(doppler: f64) -> f64 {
    0.5 * (doppler + 1.0 / doppler)
}

/// A black body looks as one of temperature T D. What moves may be the camera or the body; the bound is that of D, 4 ε γ
/// and five powers.
#[test]
fn black_body_of_doppler_factor_1e_minus_6_to_2e8_has_temperature_t_d() {
    let along = v(2.0, 3.0, -6.0) / 7.0;
    for doppler in [1e-6, 1e-3, 1e3, 1e6, 1e8, 1.9e8] {
        let speed = if doppler > 1.0 { along } else { -along };
        let velocity = Velocity::from_gamma(gamma_of(doppler), speed);
        let ball = Body::of(ball(1.0, DVec3::ZERO), glowing(black_body(5000.0 / doppler)));
        let (far, eye) = (along * 10.0, Eye::at(0.0, DVec3::ZERO).toward(along));
        let eye_moves = (ball.clone().at(0.0, far), eye.moving(velocity));
        // The light that is seen left it 10 m before.
        let body_moves = (ball.at(-10.0, far).moving(-velocity), eye);
        for (body, eye) in [eye_moves, body_moves] {
            let scene = Stage::of([body]).seen_by(&eye);
            let light = look(&scene, &eye.sight(along)).radiance;
            let right = terrell::spectrum::Source::new(&terrell::spectrum::Spectrum::BlackBody(5000.0), 1.0);
            let right = right.at_each(&Wavelengths::<64>::new().nm);
            for (got, right) in light.iter().zip(right) {
                close(*got, right, 32.0 * f64::EPSILON * velocity.gamma() + 1e-10);
            }
            sound_picture(&scene);
        }
    }
}

/// D⁵ of 2e8 is 3e41: more than 32 bits can say. Where it is red there is no light at all.
#[test]
fn picture_brighter_than_its_numbers_is_as_bright_as_they_can_say() {
    let velocity = Velocity::from_gamma(1e8, DVec3::NEG_Z);
    for (moves, bright) in [(velocity, true), (-velocity, false)] {
        let body = Body::of(ball(3.0, DVec3::ZERO), glowing(flat(1.0))).at(0.0, v(0.0, 0.0, -10.0));
        // So narrow that the ball, which is aberrated to 1e-8 rad, fills the picture.
        let eye = Eye::at(0.0, DVec3::ZERO).moving(moves).wide(if bright { 1e-8 } else { 1.0 });
        let picture = sound_picture(&Stage::of([body]).seen_by(&eye));
        let brightest = picture.iter().map(|xyz| xyz[1]).fold(0.0, f32::max);
        assert_eq!(brightest > 1e36, bright, "{brightest}");
        assert!(brightest <= 1e37);
    }
}

/// The lamp goes through the floor under the camera, and through the camera itself.
#[test]
fn lamp_that_passes_through_camera_and_floor_leaves_only_numbers() {
    let floor = || Body::of(plane(v(0.0, -1.0, 0.0), DVec3::Y), diffuse(0.5));
    let shade = || Body::of(ball(0.2, v(0.5, -0.5, -3.0)), diffuse(0.5));
    for moves in
        [Velocity::REST, Velocity::from_gamma(1.5, v(0.1, 1.0, 0.0)), Velocity::from_gamma(1e6, DVec3::Y)]
    {
        for place in [DVec3::ZERO, v(0.0, -1.0, -2.0), v(0.0, -1.0, -3.0)] {
            for before in [0.0, 1e-300, -1e-300, 1e-16, -1e-16, 1e-9, -1e-9, 1e-3] {
                let lamp = Lantern::at(before, place, flat(1.0)).moving(moves);
                let spot =
                    Beam::Spot { place: DVec3::ZERO, axis: DVec3::NEG_Y, cos_inner: 0.9, cos_outer: 0.5 };
                let stage = Stage::of([floor(), shade()]).lit_by([lamp.clone(), lamp.with(spot)]);
                sound_picture(&stage.seen_by(&Eye::at(0.0, DVec3::ZERO).toward(v(0.0, -0.5, -1.0))));
            }
        }
    }
}

/// A lamp that is at the very place of the floor that is seen, or nearer to it than numbers tell.
#[test]
fn place_at_the_lamp_itself_has_a_finite_brightness() {
    let floor = Body::of(plane(DVec3::ZERO, DVec3::Y), diffuse(0.5));
    for height in [0.0, 1e-300, 1e-160, 1e-30, 1e-17, 1e-12, 1e-6] {
        for moves in [Velocity::REST, Velocity::from_gamma(1e7, v(1.0, 0.0, 0.0))] {
            let lamp = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).moving(moves);
            let lamp = lamp.with(Beam::Point { place: v(0.0, height, 0.0) });
            let scene = Stage::of([floor.clone()]).lit_by([lamp]).scene();
            let ray = crate::support::light_to(v(0.0, 2.0, 1.0), Event::ORIGIN);
            let light = look(&scene, &ray);
            assert!(light.radiance.iter().all(|value| value.is_finite() && *value >= 0.0), "{height}");
        }
    }
}

/// All of it boosted to γ = 1e8, lamp, ball and camera, is the picture at rest: what rests together needs no lab. The
/// lamp's light on the ball passes no other frame.
#[test]
fn picture_at_rest_is_the_picture_of_all_that_moves_together_at_gamma_1e8() {
    let along = v(2.0, 3.0, -6.0) / 7.0;
    let stage = |moves: Velocity| {
        let ball = Body::of(ball(1.0, v(0.3, 0.0, -4.0)), diffuse(0.5)).moving(moves);
        let wall = Body::of(plane(v(0.0, 0.0, -6.0), DVec3::Z), diffuse(0.5)).moving(moves);
        let lamp = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Point { place: v(2.0, 2.0, 0.0) });
        let stage = Stage::of([ball, wall]).lit_by([lamp.moving(moves)]);
        stage.seen_by(&Eye::at(0.0, DVec3::ZERO).moving(moves))
    };
    let right = exposed::<8>(&stage(Velocity::REST), 0.0, (60, 40));
    for gamma in [1e2, 1e4, 1e6, 1e8] {
        let got = exposed::<8>(&stage(Velocity::from_gamma(gamma, along)), 0.0, (60, 40));
        let brightest = right.iter().map(|xyz| xyz.y).fold(0.0, f64::max);
        let off: Vec<f64> = right.iter().zip(&got).map(|(a, b)| (*a - *b).length() / brightest).collect();
        // An edge may pass a pixel's centre.
        let others = off.iter().filter(|off| **off > 64.0 * f64::EPSILON * gamma + 1e-9).count();
        assert!(
            others <= 2,
            "γ = {gamma}: {others} pixels differ, by up to {:?}",
            off.iter().copied().fold(0.0, f64::max)
        );
    }
}
