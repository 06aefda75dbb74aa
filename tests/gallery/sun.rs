//! The sun from 0.5 c.

use super::{Exhibit, aberrated};
use crate::support::{close, edge, near, v};
use glam::DVec3;
use std::f64::consts::TAU;
use terrell::spectrum::planck;

/// Metres.
const RADIUS: f64 = 6.955e8;
const BETA: f64 = 0.5;

/// The observer is at (4 R, 0, βt) at the lab's time t = γτ.
fn observer(exhibit: &Exhibit, exposure: usize) -> (f64, DVec3) {
    let tau = exhibit.plan.exposures[exposure].tau;
    let t = tau / ((1.0 - BETA) * (1.0 + BETA)).sqrt();
    (tau, v(4.0 * RADIUS, 0.0, BETA * t))
}

/// Directions to the outline make a cone of half angle asin(R/d) about that to the centre, at an angle θ off our way; aberration
/// makes a cone of it through the directions
///
/// ~~~text
/// tan(θ'/2) = √((1 - β)/(1 + β)) tan(θ/2)        for θ ± asin(R/d)
/// ~~~
///
/// The lines are 100 km above the sun, and stand out as far.
#[test]
fn outline_of_the_sun_is_a_circle_where_aberration_puts_it() {
    for name in ["sun_1", "sun_3"] {
        let exhibit = Exhibit::of(name);
        let (first, last) = (observer(&exhibit, 0).1.z, observer(&exhibit, 239).1.z);
        close(first, -5.0 * RADIUS, 1e-9);
        close(last, 5.0 * RADIUS, 1e-9);
        for exposure in (0..240).step_by(17) {
            let (tau, eye) = observer(&exhibit, exposure);
            let (distance, to_centre) = (eye.length(), -eye.normalize());
            let theta = libm::acos(to_centre.z);
            let seen =
                |angle: f64| 2.0 * libm::atan(((1.0 - BETA) / (1.0 + BETA)).sqrt() * libm::tan(0.5 * angle));
            let circle = |radius: f64| {
                let half = libm::asin(radius / distance);
                let (inner, outer) = (seen(theta - half), seen(theta + half));
                (0.5 * (inner + outer), 0.5 * (outer - inner))
            };
            let ((middle, sun), (_, lines)) = (circle(RADIUS), circle(RADIUS + 1e5));
            let across = to_centre.with_z(0.0).normalize();
            let axis = DVec3::Z * libm::cos(middle) + across * libm::sin(middle);
            let tetrad = exhibit.scene.observer.worldline.at(tau);
            let mut smallest = f64::INFINITY;
            for around in (0..60).map(|i| TAU * f64::from(i) / 60.0) {
                let side = DVec3::Y * libm::cos(around) + axis.cross(DVec3::Y) * libm::sin(around);
                let hits = |angle: f64| {
                    let n = axis * libm::cos(angle) + side * libm::sin(angle);
                    exhibit.body(&tetrad.sight_ray(n)).is_some()
                };
                let outline = edge(0.0, 0.5, hits);
                assert!(outline > sun - 1e-9 && outline < lines + 1e-9 + (lines - sun), "{outline}: {sun}");
                smallest = smallest.min(outline);
            }
            near(smallest, sun, 1e-9);
        }
    }
}

/// A place between lines near the middle of what is seen of the sun, which shines towards us at D = γ(1 + β cos θ): black at T D.
#[test]
fn middle_of_the_sun_is_black_at_its_temperature_times_the_doppler_factor() {
    let exhibit = Exhibit::of("sun_3");
    let gamma = 1.0 / ((1.0 - BETA) * (1.0 + BETA)).sqrt();
    let mut most = (f64::INFINITY, 0.0_f64);
    for exposure in (0..240).step_by(17) {
        let (tau, eye) = observer(&exhibit, exposure);
        // Lines are at multiples of R/2.3, a fifteenth of R wide; half a line more is left free.
        let clear = |place: DVec3| {
            place.to_array().iter().all(|x| {
                let from_line = x - (x / (RADIUS / 2.3)).round() * (RADIUS / 2.3);
                from_line.abs() > RADIUS / 15.0
            })
        };
        let around = |i: i32| {
            let (turn, lean) = (f64::from(i % 40) / 40.0 * TAU, 0.01 * f64::from(i / 40));
            let out = eye.normalize();
            let side = DVec3::Y * libm::cos(turn) + out.cross(DVec3::Y) * libm::sin(turn);
            (out + side * lean).normalize() * RADIUS
        };
        let place = (0..4000).map(around).find(|place| clear(*place)).unwrap();
        assert!((place.normalize() - eye.normalize()).length() < 0.25, "{place}");
        let n = (place - eye).normalize();
        let ray = exhibit.scene.observer.worldline.at(tau).sight_ray(aberrated(n, DVec3::Z * BETA));
        let kelvin = 5778.0 * gamma * (1.0 + BETA * n.z);
        for (nm, got) in exhibit.wavelengths.nm.iter().zip(exhibit.seen(&ray).radiance) {
            close(got, planck(*nm, kelvin), 1e-9);
        }
        most = (most.0.min(kelvin), most.1.max(kelvin));
    }
    assert!(most.0 < 4200.0 && most.1 > 9200.0, "{most:?}");
}
