//! A camera inside a body, on a surface, and passing through one.

use super::sound_picture;
use crate::support::{
    Body, Eye, Stage, ball, black, built, cube, cuboid, diffuse, flat, glass, glowing, icosphere, mirror,
    pixel_centre, square, v,
};
use glam::{DAffine3, DVec3};
use terrell::spacetime::Velocity;
use terrell::spectrum::Index;

/// Every ray from within a closed body ends on it, wherever the camera is and however fast both are.
#[test]
fn closed_body_has_no_leak_from_inside() {
    let bodies = [
        Body::new(&built(cube()), glowing(flat(1.0))),
        Body::new(&built(icosphere(3)), glowing(flat(1.0))),
        Body::of(ball(1.0, DVec3::ZERO), glowing(flat(1.0))),
        Body::of(cuboid(DVec3::splat(-1.0), DVec3::ONE), glowing(flat(1.0))),
    ];
    for body in bodies {
        for gamma in [1.0, 2.0, 1e3, 1e6] {
            let moves = Velocity::from_gamma(gamma, v(0.48, -0.6, 0.64));
            for place in [DVec3::ZERO, v(0.3, -0.4, 0.2), v(0.0, 0.0, 0.9)] {
                // The body's centre is beside the camera by this much of its own lengths.
                let body = body.clone().mapped(DAffine3::from_translation(-place)).moving(moves);
                for eye in [
                    Eye::at(0.0, DVec3::ZERO).wide(150.0),
                    Eye::at(0.0, DVec3::ZERO).wide(150.0).moving(moves),
                ] {
                    let scene = Stage::of([body.clone()]).seen_by(&eye);
                    let view = scene.observer.view(0.0, 24, 24);
                    let seen =
                        |number: usize| scene.lit().first(&view.ray(pixel_centre(number, 24))).is_some();
                    assert!((0..24 * 24).all(seen), "{gamma}, {place}");
                    sound_picture(&scene);
                }
            }
        }
    }
}

/// Pictures from the origin in three directions.
fn look_around(stage: &Stage) {
    for toward in [DVec3::NEG_Z, DVec3::Z, DVec3::X] {
        sound_picture(&stage.seen_by(&Eye::at(0.0, DVec3::ZERO).toward(toward)));
    }
}

/// Exactly on a face, an edge, a corner, a pole: either side, but no number is lost.
#[test]
fn camera_on_a_surface_sees_only_numbers() {
    let places = [DVec3::Z, v(1.0, 0.0, 1.0), DVec3::ONE, DVec3::NEG_Y, v(0.5, 0.5, 1.0)];
    let surfaces = [diffuse(0.5), mirror(0.9), glass(), glowing(flat(1.0))];
    for surface in surfaces {
        let bodies = [
            Body::new(&built(cube()), surface.clone()),
            Body::of(ball(1.0, DVec3::ZERO), surface.clone()),
            Body::of(cuboid(DVec3::splat(-1.0), DVec3::ONE), surface.clone()),
        ];
        for body in bodies {
            for place in places {
                for gamma in [1.0, 3.0, 1e4] {
                    let moves = Velocity::from_gamma(gamma, v(0.0, 0.6, 0.8));
                    let body =
                        body.clone().filled(Index::Constant(1.5)).mapped(DAffine3::from_translation(-place));
                    let lamp = crate::support::Lantern::at(0.0, v(3.0, 4.0, 5.0), flat(1.0));
                    let stage = Stage::of([body.moving(moves)]).lit_by([lamp]);
                    look_around(&stage);
                }
            }
        }
    }
}

/// Exposure by exposure through a plate, which is bright, to what is black behind: before it all is bright, beyond it all
/// is black, at any speed, and exactly on it nothing is lost.
#[test]
fn camera_that_passes_through_a_plate_sees_what_is_behind_it() {
    for gamma in [1.0 + 1e-6, 2.0, 1e3] {
        let moves = Velocity::from_gamma(gamma, DVec3::NEG_Z);
        let plate = Body::new(&built(square()), glowing(flat(1.0))).sized(1e6);
        let wall = Body::new(&built(square()), black()).sized(1e6).at(0.0, v(0.0, 0.0, -10.0));
        let eye = Eye::at(0.0, DVec3::ZERO).moving(moves).wide(40.0 / gamma);
        let scene = Stage::of([plate, wall]).seen_by(&eye);
        for step in -20..=20 {
            let tau = f64::from(step) * 1e-3 / gamma;
            let picture = crate::support::exposed::<8>(&scene, tau, (9, 9));
            assert!(picture.iter().all(|xyz| xyz.is_finite()));
            let bright = picture.iter().filter(|xyz| xyz.y > 0.0).count();
            // Exactly on the plate either side is right.
            if step != 0 {
                assert_eq!(bright, if step < 0 { 81 } else { 0 }, "{gamma} {step}");
            }
        }
    }
}
