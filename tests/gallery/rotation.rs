//! The observer who goes round.

use super::{CUBES, Exhibit, Pinhole, a_cube_is_between, aberrated, between};
use crate::support::v;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

const BETA: f64 = 0.7;
const RADIUS: f64 = 3.0;
const WIDTH: u32 = 400;

/// The observer at one exposure of 240 at even times of its own clock.
struct Round {
    /// The lab's time.
    t: f64,
    eye: DVec3,
    beta: DVec3,
    pinhole: Pinhole,
}

impl Round {
    /// A turn takes the lab's time `T = 2πR/β`, and `T/γ` of its own; so after τ the lab's time is `t = γτ`, and the way round
    /// `βγτ/R`, from (-6, 1.5, 0) towards +z. The observer looks at where the middle of the circle is seen.
    fn at(exposure: usize) -> Self {
        let gamma = 1.0 / ((1.0 - BETA) * (1.0 + BETA)).sqrt();
        let tau = TAU * RADIUS / (BETA * gamma) * exposure as f64 / 240.0;
        let t = gamma * tau;
        let (sin, cos) = libm::sincos(BETA * t / RADIUS);
        let (out, along) = (v(-cos, 0.0, sin), v(sin, 0.0, cos));
        let beta = along * BETA;
        let pinhole = Pinhole::toward(aberrated(-out, beta), WIDTH);
        Self { t, eye: v(-3.0, 1.5, 0.0) + out * RADIUS, beta, pinhole }
    }

    fn pixel(&self, place: DVec3) -> Option<DVec2> {
        self.pinhole.pixel(aberrated((place - self.eye).normalize(), self.beta))
    }
}

/// The upper corners of those sides of a cube that are seen, and of those that the other cube does not hide.
fn upper_corners(eye: DVec3, cube: usize) -> impl Iterator<Item = DVec3> {
    let (centre, other) = (CUBES[cube], CUBES[1 - cube]);
    let sides =
        [(DVec3::X, DVec3::Z), (DVec3::NEG_X, DVec3::Z), (DVec3::Z, DVec3::X), (DVec3::NEG_Z, DVec3::X)];
    // A side is not seen from behind, and nearly not from its own plane.
    let seen = sides.into_iter().filter(move |(out, _)| (eye - centre - *out).dot(*out) > 0.1);
    let corners = seen.flat_map(move |(out, side)| {
        [-1.0, 1.0].map(|way| centre + out + side * way * (1.0 - NEAR) + DVec3::Y)
    });
    corners.filter(move |corner| !between(other, 1.0, eye, *corner))
}

/// How near to the corners is looked, metres.
const NEAR: f64 = 1e-6;

/// Corners of the cubes' sides, from a micrometre within the side and from one above it. (Light from above the upper edge comes from
/// behind the cube and from below, since we are not as high.)
#[test]
fn corners_of_the_cubes_are_seen_where_the_circling_observer_has_them() {
    let exhibit = Exhibit::of("rotation");
    assert_eq!(exhibit.plan.exposures.len(), 240);
    let mut corners = [0; 2];
    for (exposure, cube) in (0..240).step_by(3).flat_map(|exposure| [(exposure, 0), (exposure, 1)]) {
        let (round, view) = (Round::at(exposure), exhibit.view(exposure, WIDTH));
        // The floor is the first body.
        let shown = |place: DVec3| {
            let ray = view.ray(round.pixel(place)?);
            Some(exhibit.body(&ray) == Some(cube as u32 + 1))
        };
        for corner in upper_corners(round.eye, cube) {
            let [within, above] = [-NEAR, NEAR].map(|height| shown(corner + DVec3::Y * height));
            let lower = shown(corner + DVec3::Y * (NEAR - 2.0));
            assert!(
                within != Some(false) && above != Some(true) && lower != Some(false),
                "{exposure}: {corner}"
            );
            corners[cube] += u32::from(within.is_some());
        }
    }
    assert!(corners.iter().all(|count| *count > 50), "{corners:?}");
}

/// Which of the lamps lights a place of the floor shows what time it was there, and so what time it is for the observer.
#[test]
fn the_circling_observer_sees_the_stripes_of_gamma_times_its_own_time() {
    const PERIOD: f64 = 3.0 * super::NS;
    let exhibit = Exhibit::of("rotation");
    let lamps = [v(3.0, 3.0, 0.0), v(-3.0, 3.0, 0.0)];
    let (mut lit, mut dark) = (0, 0);
    for exposure in (0..240).step_by(7) {
        let (round, view) = (Round::at(exposure), exhibit.view(exposure, WIDTH));
        for (x, z) in (-9..9).flat_map(|x| (-9..9).map(move |z| (f64::from(x), f64::from(z)))) {
            let place = v(0.9 * x + 0.13, 0.0, 0.9 * z + 0.37);
            let (false, Some(pixel)) = (a_cube_is_between(round.eye, place), round.pixel(place)) else {
                continue;
            };
            let t = round.t - (place - round.eye).length();
            let shines = |lamp: &DVec3| {
                let phase = (t - (place - *lamp).length()) / PERIOD;
                phase - phase.floor() < 0.5 && !a_cube_is_between(*lamp, place)
            };
            let shown = exhibit.shows_lamplight(&view.ray(pixel));
            assert_eq!(shown, lamps.iter().any(shines), "{exposure}: {place}");
            if shown { lit += 1 } else { dark += 1 }
        }
    }
    assert!(lit > 500 && dark > 500, "{lit} {dark}");
}
