//! Where a moving observer sees what stands still.
//!
//! ~~~text
//! cos θ' = (cos θ + β)/(1 + β cos θ)
//! ~~~
//!
//! θ: from the observer's velocity to the source, θ' the same as the observer sees it. Einstein 1905 §7.

use crate::support::{
    Body, Eye, Stage, angle, black_body, built, edge, first, glowing, icosphere, light_from, near, picture,
    pixel_centre, speed, v,
};
use glam::{DQuat, DVec3};
use terrell::spacetime::Event;

/// θ in degrees, then θ' for the speeds.
const SPEEDS: [f64; 4] = [0.5, 0.8, 0.9, 0.99];
const TABLE: [(f64, [f64; 4]); 4] = [
    (30.0, [17.5880, 10.2078, 7.0353, 2.1763]),
    (60.0, [36.8699, 21.7868, 15.0902, 4.6873]),
    (90.0, [60.0000, 36.8699, 25.8419, 8.1096]),
    (120.0, [90.0000, 60.0000, 43.3418, 13.9997]),
];

/// Off every axis.
const FORWARD: DVec3 = v(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);

/// The direction at an angle from `FORWARD`, to the side `around` of it.
fn at_angle(degrees: f64, around: f64) -> DVec3 {
    let side = DQuat::from_axis_angle(FORWARD, around) * FORWARD.any_orthonormal_vector();
    let (sin, cos) = libm::sincos(degrees.to_radians());
    FORWARD * cos + side * sin
}

fn seen_at(theta: f64, beta: f64) -> f64 {
    libm::acos((libm::cos(theta) + beta) / (1.0 + beta * libm::cos(theta)))
}

#[test]
fn light_of_a_star_arrives_at_the_aberrated_place_of_the_picture() {
    let here = Event::new(3.0, v(-5.0, 1.0, 2.0));
    for (row, (theta, seen)) in TABLE.iter().enumerate() {
        for (beta, expected) in SPEEDS.iter().zip(seen) {
            let star = at_angle(*theta, row as f64);
            // The camera looks between the course and the star, somewhat aside.
            let eye = Eye::at(here.t, here.x).moving(speed(*beta, FORWARD)).wide(100.0);
            let eye = eye.toward(at_angle(0.5 * expected, row as f64 + 0.4));
            let view = eye.observer().view(0.0, 640, 480);
            let light = light_from(here.x + star * 1e9, here);
            let pixel = view.pixel_of(light.k).unwrap();
            // Back from the picture to the axes the observer carries.
            let carried = eye.observer().worldline.at(0.0);
            let direction = carried.direction_of(view.ray(pixel).k);
            near(angle(direction, FORWARD).to_degrees(), *expected, 5.1e-5);
            near(angle(direction, FORWARD), seen_at(theta.to_radians(), *beta), 1e-12);
            // In the same half plane as the star itself.
            near(direction.dot(star.cross(FORWARD)), 0.0, 1e-12);
            assert!(direction.dot(star - FORWARD * star.dot(FORWARD)) > 0.0);
        }
    }
}

/// A globe of 0.2° radius among the stars, searched for in the rendered picture.
#[test]
fn small_globes_are_found_where_the_table_says() {
    let globe = built(icosphere(3));
    for (row, (theta, seen)) in TABLE.iter().enumerate() {
        for (beta, expected) in SPEEDS.iter().zip(seen) {
            let place = at_angle(*theta, row as f64) * 1e3;
            let body = Body::new(&globe, glowing(black_body(5000.0))).at(0.0, place);
            let body = body.sized(1e3 * libm::sin(0.2_f64.to_radians()));
            let doppler = speed(*beta, FORWARD).gamma() * (1.0 + beta * libm::cos(theta.to_radians()));
            let apparent = 0.2 / doppler;
            let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(*beta, FORWARD)).wide(12.0 * apparent);
            let eye = eye.toward(at_angle(expected + apparent, row as f64 + 0.001));
            let scene = Stage::of([body]).seen_by(&eye);
            let (view, negative) = picture(&scene, 96, 96);
            let carried = scene.observer.worldline.at(0.0);
            let lit = negative.xyz.iter().enumerate().filter(|(_, xyz)| xyz[1] > 0.0);
            let centre: DVec3 =
                lit.map(|(number, _)| carried.direction_of(view.ray(pixel_centre(number, 96)).k)).sum();
            near(angle(centre, FORWARD).to_degrees(), *expected, 0.01 * apparent + 4e-4);
        }
    }
}

#[test]
fn front_half_of_the_sky_fits_its_cone() {
    let sky = Body::new(&built(icosphere(4)), glowing(black_body(5000.0))).sized(1e3);
    for (beta, degrees) in [(0.5, 60.0), (0.8, 36.870), (0.9, 25.842), (0.99, 8.110)] {
        let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(beta, FORWARD));
        let scene = Stage::of([sky.clone()]).seen_by(&eye);
        for around in [0.0, 1.0, 2.5, 4.0] {
            let ahead = |degrees: f64| {
                first(&scene, &eye.sight(at_angle(degrees, around))).emission.x.dot(FORWARD) > 0.0
            };
            let cone = edge(0.0, 180.0, ahead);
            near(cone, degrees, 5.1e-4);
            near(cone, libm::acos(beta).to_degrees(), 1e-9);
        }
    }
}

/// Bradley 1727: a star square to the Earth's motion of 29.7827 km/s.
#[test]
fn stars_shift_by_twenty_seconds_of_arc_for_the_earth() {
    let orbit = 29.7827e3 / 299_792_458.0;
    let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(orbit, FORWARD));
    let star = light_from(at_angle(90.0, 0.7), Event::ORIGIN);
    let direction = eye.observer().worldline.at(0.0).direction_of(star.k);
    near((90.0 - angle(direction, FORWARD).to_degrees()) * 3600.0, 20.491, 1e-3);
}

/// Circles stay circles: their size divides by D.
#[test]
fn small_cone_of_sight_shrinks_by_the_doppler_factor_and_stays_round() {
    let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(0.8, FORWARD));
    let tetrad = eye.observer().worldline.at(0.0);
    let (star, small) = (at_angle(70.0, 2.0), 1e-4);
    let middle = light_from(star, Event::ORIGIN).k;
    let doppler = middle.dot(tetrad.velocity());
    for around in 0..8 {
        let turn = DQuat::from_axis_angle(star, f64::from(around));
        let off = star + turn * star.any_orthonormal_vector() * libm::tan(small);
        let seen = angle(tetrad.direction_of(light_from(off, Event::ORIGIN).k), tetrad.direction_of(middle));
        near(seen * doppler, small, small * 1e-4);
    }
}
