//! Frequency seen over frequency emitted, read from hits and from lines.
//!
//! ~~~text
//! D = γ(1 + β cos θ) = 1/[γ(1 - β cos θ')]
//! ~~~

use crate::support::{
    Body, Dice, Eye, Stage, black_body, built, close, edge, first, glowing, icosphere, light_from, line,
    look, near, near_vector, speed, v,
};
use glam::{DQuat, DVec3};
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::scene::Scene;
use terrell::spacetime::{Event, Velocity};

const FORWARD: DVec3 = v(-6.0 / 7.0, 2.0 / 7.0, 3.0 / 7.0);

fn aside(theta: f64, around: f64) -> DVec3 {
    let side = DQuat::from_axis_angle(FORWARD, around) * FORWARD.any_orthonormal_vector();
    FORWARD * libm::cos(theta) + side * libm::sin(theta)
}

/// A sky at rest and an observer that moves through it.
fn under_the_sky(velocity: Velocity) -> (Scene, Eye) {
    let sky = Body::new(&built(icosphere(2)), glowing(black_body(5000.0))).sized(50.0);
    let eye = Eye::at(0.0, v(1.0, 2.0, 3.0)).moving(velocity);
    (Stage::of([sky]).seen_by(&eye), eye)
}

/// The sky's D in the direction `theta` (as the observer sees it).
fn sky_doppler(scene: &Scene, eye: &Eye, theta: f64, around: f64) -> f64 {
    first(scene, &eye.sight(aside(theta, around))).doppler.factor()
}

#[test]
fn sky_is_shifted_as_the_table_says() {
    let table = [
        (0.5, [1.65470, 1.44338, 1.15470, 0.86603]),
        (0.8, [2.82137, 2.33333, 1.66667, 1.00000]),
        (0.9, [4.08228, 3.32653, 2.29416, 1.26179]),
        (0.99, [13.16651, 10.59777, 7.08881, 3.57985]),
    ];
    for (beta, row) in table {
        let (scene, eye) = under_the_sky(speed(beta, FORWARD));
        for (theta, expected) in [30.0_f64, 60.0, 90.0, 120.0].iter().zip(row) {
            let cos = libm::cos(theta.to_radians());
            let gamma = 1.0 / (1.0 - beta * beta).sqrt();
            let seen = libm::acos((cos + beta) / (1.0 + beta * cos));
            let doppler = sky_doppler(&scene, &eye, seen, *theta);
            near(doppler, expected, 5.1e-6);
            close(doppler, gamma * (1.0 + beta * cos), 1e-12);
            close(doppler, 1.0 / (gamma * (1.0 - beta * libm::cos(seen))), 1e-12);
        }
    }
}

#[test]
fn approach_and_recession_are_reciprocal() {
    let table = [
        (0.3, 1.362_770),
        (0.5, 3.0_f64.sqrt()),
        (0.6, 2.0),
        (0.8, 3.0),
        (0.9, 4.358_899),
        (0.99, 14.106_736),
    ];
    for (beta, expected) in table {
        let (scene, eye) = under_the_sky(speed(beta, FORWARD));
        let (ahead, astern) =
            (sky_doppler(&scene, &eye, 0.0, 0.0), sky_doppler(&scene, &eye, std::f64::consts::PI, 0.0));
        close(ahead, expected, 5e-7);
        close(ahead, ((1.0 + beta) / (1.0 - beta)).sqrt(), 1e-12);
        close(ahead * astern, 1.0, 1e-12);
    }
}

/// cos θ' = (1 - 1/γ)/β.
#[test]
fn colours_are_unchanged_on_their_cone() {
    for (beta, degrees) in [(0.5, 74.458), (0.8, 60.0), (0.9, 51.186), (0.99, 29.818)] {
        let (scene, eye) = under_the_sky(speed(beta, FORWARD));
        let cone = edge(0.0, 3.0, |theta| sky_doppler(&scene, &eye, theta, 1.0) > 1.0);
        near(cone.to_degrees(), degrees, 5.1e-4);
        let gamma = 1.0 / (1.0 - beta * beta).sqrt();
        near(libm::cos(cone), (1.0 - 1.0 / gamma) / beta, 1e-11);
    }
}

/// Seen square to the motion in the observer's own frame: 1/γ. Sent square to the motion in the source's: γ.
#[test]
fn transverse_light_is_redshifted_by_gamma() {
    let quarter = std::f64::consts::FRAC_PI_2;
    for beta in [0.3, 0.8, 0.99] {
        let velocity = speed(beta, FORWARD);
        let (scene, eye) = under_the_sky(velocity);
        close(sky_doppler(&scene, &eye, quarter, 2.0), 1.0 / velocity.gamma(), 1e-12);
        close(sky_doppler(&scene, &eye, libm::acos(beta), 2.0), velocity.gamma(), 1e-12);
    }
}

/// D = γₒ(1 - βₒ·n) / γₑ(1 - βₑ·n), n the way of the light in the lab, for velocities that cross.
#[test]
fn both_ends_may_move_any_way() {
    let ball = built(icosphere(2));
    let mut dice = Dice(7);
    for _ in 0..200 {
        let speeds = [dice.between(0.05, 0.999), dice.between(0.05, 0.999)];
        let [source, observer] = speeds.map(|beta| dice.velocity(beta));
        let (when, place) = (dice.between(-20.0, -5.0), dice.in_cube() * 4.0);
        let body = Body::new(&ball, glowing(black_body(5000.0))).at(when, place).moving(source).sized(1e-3);
        // The light that leaves the body's centre for a place in the lab.
        let there = place + dice.direction() * 9.0;
        let arrival = Event::new(when + (there - place).length(), there);
        let n = (there - place) / 9.0;
        let scene = Stage::of([body]).seen_by(&Eye::at(arrival.t, arrival.x).moving(observer));
        let tetrad = scene.observer.worldline.at(0.0);
        let ray = tetrad.sight_ray(tetrad.direction_of(light_from(place, arrival).k));
        let found = first(&scene, &ray);
        let part = |velocity: Velocity| velocity.gamma() * (1.0 - velocity.beta().dot(n));
        close(found.doppler.factor(), part(observer) / part(source), 1e-12);
        near_vector(found.emission.x, place, 2e-3 * source.gamma());
    }
}

/// 589 nm at 0.3 c: 432.208 nm ahead, 802.672 nm astern.
#[test]
fn sodium_line_arrives_at_its_shifted_wavelength() {
    let sky = Body::new(&built(icosphere(2)), glowing(line(589.0, 2.0))).sized(50.0);
    let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(0.3, FORWARD));
    let scene = Stage::of([sky]).seen_by(&eye);
    for (theta, nm) in [(0.0, 432.208), (std::f64::consts::PI, 802.672), (1.1, f64::NAN)] {
        let gamma = 1.0 / (1.0 - 0.09_f64).sqrt();
        let doppler = 1.0 / (gamma * (1.0 - 0.3 * libm::cos(theta)));
        if nm.is_finite() {
            near(589.0 / doppler, nm, 5e-4);
        }
        let light = look(&scene, &eye.sight(aside(theta, 0.3)));
        // All of a line's power: D⁴.
        let expected = matching(589.0 / doppler) * (LUMENS_PER_WATT * 2.0 * doppler.powi(4));
        near_vector(light.lines, expected, expected.length() * 1e-9);
        assert!(light.radiance.iter().all(|value| *value == 0.0), "a line is no sample");
    }
}

/// Ahead at γ = 1e6: 1/[γ(1 - β cos θ')] with 1 - β = 1/[γ²(1 + β)] and 1 - cos θ' = 2 sin²(θ'/2).
#[test]
fn doppler_factor_ahead_keeps_the_digits_that_gamma_squared_leaves() {
    for gamma in [1e2, 1e4, 1e6] {
        let (scene, eye) = under_the_sky(Velocity::from_gamma(gamma, FORWARD));
        for theta in [0.0, 0.5 / gamma, 20.0 / gamma, 0.7] {
            let beta = ((gamma - 1.0) * (gamma + 1.0)).sqrt() / gamma;
            let missing = 1.0 / (gamma * gamma * (1.0 + beta)) + 2.0 * beta * libm::sin(0.5 * theta).powi(2);
            let doppler = sky_doppler(&scene, &eye, theta, 0.4);
            close(doppler, 1.0 / (gamma * missing), 1e-13 + 4.0 * f64::EPSILON * gamma * gamma);
        }
    }
}
