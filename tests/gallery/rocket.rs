//! The stars from the rocket.

use super::{Exhibit, aberrated};
use crate::support::{angle, close, v};
use glam::DVec3;
use terrell::manifest::StarOrigin;
use terrell::scene::WorldBuilder;
use terrell::spectrum::planck;
use terrell::surroundings::{Kinds, seeded};

/// Where the stars are at rest. (Star number i depends on seed and number alone.)
fn stars(exhibit: &Exhibit) -> Vec<DVec3> {
    let written = exhibit.manifest.surroundings[0].stars.as_ref().unwrap();
    let StarOrigin::Seeded { seed, count, .. } = written.origin else { panic!() };
    seeded(u64::from(seed), count as usize, Kinds::default()).map(|star| star.direction).collect()
}

/// The rapidity of the rocket is aτ, so after 20 s it moves with β = tanh 2. Of stars that are strewn evenly the share
///
/// ~~~text
/// (1 - cos θ)/2        tan(θ/2) = e² tan(θ'/2)
/// ~~~
///
/// is seen within θ' of the way. Each is looked for where aberration puts it: it is a disc whose edge at rest is 0.6° from its
/// middle, as bright as a black body at 5800 K times D = cosh 2 + sinh 2 cos θ.
#[test]
fn stars_crowd_ahead_after_twenty_seconds() {
    let mut exhibit = Exhibit::of("rocket_2");
    // The panel would hide some.
    exhibit.scene.world = WorldBuilder::default().build();
    let (stars, tetrad) =
        (stars(&exhibit), exhibit.scene.observer.worldline.at(exhibit.plan.exposures[0].tau));
    let beta = DVec3::Z * libm::tanh(2.0);
    let nm = exhibit.wavelengths.nm;
    let radiance = |n: DVec3| exhibit.seen(&tetrad.sight_ray(aberrated(n, beta))).radiance;
    let mut seen = Vec::new();
    for star in &stars {
        let kelvin = 5800.0 * (libm::cosh(2.0) + libm::sinh(2.0) * star.z);
        radiance(*star).iter().zip(nm).for_each(|(got, nm)| close(*got, planck(nm, kelvin), 1e-3));
        let side = star.cross(v(0.3, 0.9, 0.1)).normalize();
        let beside = |degrees: f64| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            *star * cos + side * sin
        };
        assert!(radiance(beside(0.599))[8] > 1e-3 * planck(nm[8], kelvin));
        // Unless another star is there.
        if stars.iter().filter(|other| angle(**other, beside(0.601)) < 0.6_f64.to_radians()).count() == 0 {
            assert!(radiance(beside(0.601))[8] < 1e-3 * planck(nm[8], kelvin));
        }
        seen.push(angle(aberrated(*star, beta), DVec3::Z));
    }
    for within in [3.0_f64, 7.0, 15.0, 30.0, 60.0] {
        let half = 0.5 * within.to_radians();
        let theta = 2.0 * libm::atan(libm::exp(2.0) * libm::tan(half));
        let share = 0.5 * (1.0 - libm::cos(theta));
        let count = seen.iter().filter(|angle| **angle < 2.0 * half).count() as f64;
        // Three standard deviations of an even strewing.
        let spread = 3.0 * (1000.0 * share * (1.0 - share)).sqrt();
        assert!((count - 1000.0 * share).abs() < spread, "{count} stars within {within} deg, not {share}");
    }
    assert_eq!(stars.len(), 1000);
}
