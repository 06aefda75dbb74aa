//! The floor below the sodium lamp that moves.

use super::Exhibit;
use crate::support::{emission_time, light_from, v};
use glam::DVec3;
use std::f64::consts::PI;
use terrell::color::xyz_of;
use terrell::spacetime::Event;

/// A Gaussian of 20 nm at half of its height.
fn line(nm: f64) -> f64 {
    let deviation = 20.0 / (8.0 * libm::log(2.0)).sqrt();
    libm::exp(-0.5 * ((nm - 589.0) / deviation).powi(2))
}

/// White squares along the lamp's way, 2.5 m beside it. With n the way of the light from the lamp to the floor, r as long in the
/// lab, and the lamp's distance r/D in its own rest frame:
///
/// ~~~text
/// D = 1/(γ(1 - β·n))        L(λ) = D³ I(Dλ) cos θ / (π (r/D)²)        cos θ = 4/r
/// ~~~
#[test]
fn colours_of_the_floor_are_those_of_the_shifted_line() {
    let exhibit = Exhibit::of("sodium_still");
    let (eye, beta) = (v(2.0, 3.0, 0.0), v(0.0, 0.0, -0.3));
    let lamp = |t: f64| v(0.0, 4.0, 2.0) + beta * t;
    let intensity = 1000.0 / xyz_of(line).y;
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    let expected = |place: DVec3| {
        let t = -(place - eye).length();
        let way = place - lamp(emission_time(Event::new(t, place), lamp));
        let (r, gamma) = (way.length(), 1.0 / (1.0 - beta.length_squared()).sqrt());
        let doppler = 1.0 / (gamma * (1.0 - beta.dot(way) / r));
        let brightness = intensity * doppler.powi(5) * (4.0 / r) / (r * r) / PI;
        (doppler, xyz_of(|nm| brightness * line(nm * doppler)))
    };
    for z in (-8..=8).map(|z| 2.0 * f64::from(z) + 0.5) {
        let place = v(2.5, 0.0, z);
        let got = exhibit.seen(&light_from(place, Event::new(0.0, eye))).lines;
        let (doppler, expected) = expected(place);
        // Lines are sampled a standard deviation apart at most.
        let error = (got - expected).length() / expected.length();
        assert!(error < 5e-3, "z = {z}, {:.0} nm: {got} for {expected}", 589.0 / doppler);
        let [got, expected] = [got, expected].map(|xyz| xyz.truncate() / xyz.element_sum());
        assert!((got - expected).length() < 2e-3, "z = {z}: chromaticity {got} for {expected}");
        (shortest, longest) = (shortest.min(589.0 / doppler), longest.max(589.0 / doppler));
    }
    assert!(shortest < 460.0 && longest > 740.0, "{shortest} to {longest} nm");
}
