//! Paths through places at times: their clocks, their velocities, how fast they are at most.

use crate::support::{
    Dice, Eye, Stage, black_body, built, close, difference, diffuse, exposed, glowing, icosphere, near,
    near_vector, v,
};
use glam::{DQuat, DVec3};
use std::path::Path;
use std::sync::Arc;
use terrell::error::Report;
use terrell::manifest::{self, Manifest};
use terrell::observer::Aim;
use terrell::spacetime::{Course, Event, Poincare, Track, Velocity, Worldline};

type Keys = Vec<(f64, DVec3)>;

fn through(keys: &[(f64, DVec3)]) -> Track {
    Track::through(keys).unwrap_or_else(|too_fast| panic!("{too_fast:?}"))
}

fn worldline(keys: &[(f64, DVec3)]) -> Worldline {
    let course = Course::Keyed(Arc::new(through(keys)));
    Worldline::new(Event::ORIGIN, Velocity::REST, DQuat::IDENTITY, course)
}

/// Places on a curve at even times.
fn sampled(curve: impl Fn(f64) -> DVec3, (from, to): (f64, f64), count: usize) -> Keys {
    let at = |i: usize| from + (to - from) * i as f64 / (count - 1) as f64;
    (0..count).map(|i| (at(i), curve(at(i)))).collect()
}

/// A random path, mostly slower than light.
fn random(dice: &mut Dice, count: usize) -> Keys {
    let mut t = dice.between(-3.0, 0.0);
    let mut step = || {
        t += dice.between(0.5, 2.0);
        (t, dice.in_cube() * 0.35)
    };
    (0..count).map(|_| step()).collect()
}

#[test]
fn keys_on_a_straight_line_are_uniform_motion() {
    let beta = v(0.48, -0.6, 0.36);
    let start = v(1.0, 2.0, -3.0);
    let keys: Keys = [-3.0, -1.0, 0.25, 0.5, 4.0].map(|t| (t, start + beta * t)).to_vec();
    let path = worldline(&keys);
    let velocity = Velocity::from_beta(beta).unwrap();
    let uniform = Worldline::new(Event::new(0.0, start), velocity, DQuat::IDENTITY, Course::Inertial);
    for tau in [-20.0, -1.5, -0.3, 0.0, 0.1, 0.9, 1.7, 30.0] {
        let (a, b) = (path.at(tau), uniform.at(tau));
        near(a.event.t, b.event.t, 1e-12);
        near_vector(a.event.x, b.event.x, 1e-12);
        near_vector(a.velocity().x, b.velocity().x, 1e-12);
    }
}

#[test]
fn picture_from_keys_on_a_straight_line_is_that_of_uniform_motion() {
    let ball = |at: DVec3| glam::DAffine3::from_translation(at);
    let bodies = [
        crate::support::Body::new(&built(icosphere(2)), glowing(black_body(5000.0)))
            .mapped(ball(v(0.0, 0.4, -6.0))),
        crate::support::Body::new(&built(icosphere(2)), glowing(black_body(3000.0)))
            .mapped(ball(v(2.0, 0.0, -5.0))),
    ];
    let stage = Stage::of(bodies);
    let velocity = Velocity::from_beta(v(0.6, 0.0, -0.5)).unwrap();
    let uniform = Eye::at(0.0, DVec3::ZERO).moving(velocity);
    let keys: Keys = [-3.0, -1.0, 0.5, 4.0].map(|t| (t, velocity.beta() * t)).to_vec();
    let keyed = Eye { course: Course::Keyed(Arc::new(through(&keys))), ..Eye::at(0.0, DVec3::ZERO) };
    let pictures = [uniform, keyed].map(|eye| exposed::<8>(&stage.seen_by(&eye), 0.7, (48, 36)));
    assert!(pictures[0].iter().filter(|xyz| xyz.y > 0.0).count() > 10);
    let (worst, others) = difference(&pictures[0], &pictures[1]);
    assert!(worst < 1e-9 && others == 0, "{worst} {others}");
}

/// Far from its ends a spline is as near as the fourth power of the step.
#[test]
fn keys_on_a_circle_keep_the_circles_clock_to_the_fourth_order() {
    let (radius, beta) = (2.0, 0.8);
    let rate = beta / radius;
    let circle = |t: f64| v(libm::cos(rate * t), libm::sin(rate * t), 0.0) * radius;
    let error = |count: usize| {
        let track = through(&sampled(circle, (-24.0, 24.0), count));
        let place = [-3.1, 0.4, 2.7].map(|t| (track.at(t).0 - circle(t)).length());
        let slow = (track.own(4.0) - track.own(-4.0)) / 8.0 - (1.0 - beta * beta).sqrt();
        (place.into_iter().fold(0.0, f64::max), slow.abs())
    };
    let (coarse, fine) = (error(97), error(193));
    assert!(fine.0 < 1e-4 && fine.0 * 12.0 < coarse.0, "{coarse:?} {fine:?}");
    assert!(fine.1 < 1e-5 && fine.1 * 12.0 < coarse.1, "{coarse:?} {fine:?}");
}

/// A rocket's own time is asinh(a t)/a.
#[test]
fn keys_on_a_hyperbola_keep_the_rockets_clock() {
    let a = 0.5;
    let hyperbola = |t: f64| v(1.0, 2.0, 2.0) / 3.0 * ((1.0 + a * a * t * t).sqrt() - 1.0) / a;
    let track = through(&sampled(hyperbola, (-12.0, 12.0), 481));
    for t in [-4.0, -1.0, 0.3, 2.0, 5.0] {
        near(track.own(t), libm::asinh(a * t) / a, 1e-7);
        near(Velocity::from_beta(track.at(t).1).unwrap().gamma(), (1.0 + a * a * t * t).sqrt(), 1e-4);
    }
}

#[test]
fn clock_of_a_keyed_path_measures_its_length_and_is_zero_at_time_zero() {
    let mut dice = Dice(7);
    for _ in 0..200 {
        let keys = random(&mut dice, 6);
        let Ok(track) = Track::through(&keys) else { continue };
        near(track.own(0.0), 0.0, 1e-15);
        for _ in 0..8 {
            let t = dice.between(-5.0, 12.0);
            // By Simpson's rule over many small steps.
            let count = 4000;
            let step = t / f64::from(count);
            let rate = |i: i32| (1.0 - track.at(step * f64::from(i)).1.length_squared()).sqrt();
            let weight = |i: i32| {
                if i == 0 || i == count {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                }
            };
            let length: f64 = (0..=count).map(|i| weight(i) * rate(i)).sum::<f64>() * step / 3.0;
            near(track.own(t), length, 1e-6);
            near(track.when(track.own(t)), t, 1e-12 * (1.0 + t.abs()) * 100.0);
        }
    }
}

#[test]
fn path_goes_through_its_keys_and_its_velocity_and_acceleration_have_no_jump() {
    let mut dice = Dice(11);
    let mut tried = 0;
    for _ in 0..100 {
        let keys = random(&mut dice, 7);
        let Ok(track) = Track::through(&keys) else { continue };
        tried += 1;
        for (t, place) in &keys {
            near_vector(track.at(*t).0, *place, 1e-13);
            let step = 1e-5;
            let slope = |t: f64| (track.at(t + step).0 - track.at(t - step).0) / (2.0 * step);
            near_vector(track.at(*t).1, slope(*t), 1e-8);
            let bend = |t: f64| (track.at(t + 1e-4).1 - track.at(t).1) / 1e-4;
            near_vector(bend(*t), bend(t - 1e-4), 3e-3);
        }
    }
    assert!(tried > 50);
}

/// Never below any speed of the path, and hardly above the greatest.
#[test]
fn bound_of_a_paths_speed_is_its_greatest_speed() {
    let mut dice = Dice(3);
    for _ in 0..300 {
        // Straight on in small steps: the bound is to be a property of the cubic, not of where it is looked at.
        let keys = random(&mut dice, 5);
        let slow: Keys = keys.iter().map(|(t, x)| (*t, *x * 0.2)).collect();
        let track = through(&slow);
        for (piece, bound) in Track::fastest(&slow).into_iter().enumerate() {
            let (from, to) = (slow[piece].0, slow[piece + 1].0);
            let speed = |i: i32| track.at(from + (to - from) * f64::from(i) / 1000.0).1.length();
            let most = (0..=1000).map(speed).fold(0.0, f64::max);
            assert!(bound >= most * (1.0 - 1e-14) && bound <= most * (1.0 + 1e-5), "{bound} {most}");
        }
    }
}

#[test]
fn too_fast_a_piece_is_found_by_its_number_though_its_ends_are_slow() {
    // Straight there in half of the time: the mean speed is 0.95 c, the spline's greatest above c.
    let keys = [(0.0, 0.0), (2.0, 0.0), (3.0, 0.95), (5.0, 0.95)].map(|(t, x)| (t, DVec3::X * x));
    let found = Track::through(&keys).unwrap_err();
    assert_eq!(found.iter().map(|found| found.piece).collect::<Vec<_>>(), [1]);
    assert!(found[0].speed > 1.0 && found[0].speed < 1.3);
    near(found[0].at, 2.5, 1e-6);
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(!Track::through(&[(0.0, DVec3::ZERO), (1.0, DVec3::X * bad)]).unwrap_err().is_empty());
    }
    assert!(Track::through(&[(0.0, DVec3::ZERO), (0.0, DVec3::X)]).is_err());
}

/// A scale of the world is no physics.
#[test]
fn path_in_other_units_is_the_same_path() {
    let mut dice = Dice(5);
    let keys: Keys = random(&mut dice, 6).into_iter().map(|(t, x)| (t, x * 0.5)).collect();
    let track = through(&keys);
    for scale in [1e-9, 1e9] {
        let other = through(&keys.iter().map(|(t, x)| (t * scale, *x * scale)).collect::<Keys>());
        for t in [-4.0, -0.2, 1.3, 3.3, 20.0] {
            close(other.own(t * scale), track.own(t) * scale, 1e-12);
            near_vector(other.at(t * scale).1, track.at(t).1, 1e-12);
        }
    }
}

#[test]
fn single_key_is_a_place_to_stay_at() {
    let path = worldline(&[(3.0, v(1.0, 2.0, 3.0))]);
    for tau in [-2.0, 0.0, 7.0] {
        near(path.at(tau).event.t, tau, 1e-15);
        near_vector(path.at(tau).event.x, v(1.0, 2.0, 3.0), 0.0);
        assert_eq!(path.at(tau).velocity().x, DVec3::ZERO);
    }
}

/// What stands at the centre of a circle of keys is seen blue by γ, and in the direction of aberration: from the velocity
/// of the moment.
#[test]
fn keyed_observer_sees_by_the_velocity_of_the_moment() {
    let (radius, beta) = (2.0, 0.8);
    let rate = beta / radius;
    let circle = |t: f64| v(libm::cos(rate * t), 0.0, libm::sin(rate * t)) * radius;
    let course = Course::Keyed(Arc::new(through(&sampled(circle, (-24.0, 24.0), 400))));
    let rest_from_lab = Poincare::to_moving(Velocity::REST, Event::ORIGIN);
    let aim = Aim::At { rest_from_lab, place: DVec3::ZERO };
    let eye = Eye { course, aim, ..Eye::at(0.0, DVec3::ZERO) };
    let ball = crate::support::Body::new(&built(icosphere(2)), diffuse(0.5)).sized(0.1);
    let scene = Stage::of([ball]).seen_by(&eye);
    for tau in [-1.0, 0.5, 2.0] {
        let view = scene.observer.view(tau, 9, 9);
        let hit = crate::support::first(&scene, &view.ray(glam::DVec2::new(4.5, 4.5)));
        // Light from the ball, nearly from its centre.
        near(hit.doppler.factor(), 1.0 / 0.6, 0.07);
        let direction = scene.observer.worldline.at(tau).direction_of(view.ray(glam::DVec2::new(4.5, 4.5)).k);
        let along = scene.observer.worldline.at(tau).velocity().x.normalize();
        // Across in the lab: the cosine is β forwards.
        near(direction.dot(along), beta, 1e-3);
    }
}

fn parsed(text: &str) -> (Option<Manifest>, Report) {
    let mut report = Report::default();
    (manifest::parse(Path::new("path.yaml"), text, &mut report), report)
}

/// What a fault of speed says to type takes it away.
#[test]
fn time_that_a_too_fast_path_is_told_makes_it_slow_enough() {
    for far in [3.0, 5.0, 500.0] {
        let manifest = |last: &str| {
            format!(
                "{{ light_speed: 1 m/s, observer: {{ keys: [{{ at_time: 0 s, at: 0 0 0 m }}, {{ at_time: 1 s, at: 0.5 0 0 m }}, \
                 {{ {last}, at: {far} 0 0 m }}] }}, output: out }}"
            )
        };
        let (_, report) = parsed(&manifest("at_time: 2 s"));
        let fault = report.faults.last().unwrap();
        assert!(
            fault.what.contains("between key 2 (1 s) and key 3 (2 s) the path reaches"),
            "{}",
            fault.what
        );
        let (read, again) = parsed(&manifest(&fault.hint));
        assert!(read.is_some() && again.faults.is_empty(), "{} {:?}", fault.hint, again.faults);
    }
}
