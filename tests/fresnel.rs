//! Fresnel's equations, against angles and values that can be had without them.

use crate::support::{Dice, close, near};
use terrell::fresnel::{
    conductor, conductor_each, conductor_polarised, dielectric, dielectric_each, dielectric_polarised,
};

#[test]
fn normal_light_is_reflected_alike_from_both_sides() {
    for ratio in [1.333, 1.5168, 2.4175, 1.0 / 1.5168] {
        close(dielectric(1.0, ratio), ((ratio - 1.0) / (ratio + 1.0)).powi(2), 1e-13);
        let both = dielectric_polarised(1.0, ratio);
        close(both.s, both.p, 1e-12);
    }
    // (n - 1)² + k² over (n + 1)² + k².
    let (n, k) = (0.3, 3.2);
    close(conductor(1.0, n, k), (0.49 + k * k) / (1.69 + k * k), 1e-13);
}

#[test]
fn at_brewsters_angle_one_polarisation_is_not_reflected() {
    for ratio in [1.333, 1.5168, 2.4175, 1.0 / 1.5168] {
        let both = dielectric_polarised(libm::cos(libm::atan(ratio)), ratio);
        near(both.p, 0.0, 1e-30);
        // The reflected and the refracted ray are at right angles there.
        close(both.s, ((ratio * ratio - 1.0) / (ratio * ratio + 1.0)).powi(2), 1e-12);
        assert!(dielectric_polarised(0.9 * libm::cos(libm::atan(ratio)), ratio).p > 1e-5);
    }
}

#[test]
fn beyond_the_critical_angle_everything_is_reflected() {
    let ratio: f64 = 1.0 / 1.5168;
    let critical = (1.0 - ratio * ratio).sqrt();
    for cos in [0.0, 1e-9, 0.3, critical * (1.0 - 1e-9)] {
        near(dielectric(cos, ratio), 1.0, 0.0);
    }
    assert!(dielectric(critical * (1.0 + 1e-6), ratio) < 0.999);
    assert!(dielectric(critical * 1.1, ratio) < 0.5);
}

#[test]
fn reflectance_is_the_same_along_the_path_reversed() {
    let mut dice = Dice(1);
    for _ in 0..10_000 {
        let (cos, ratio) = (dice.between(0.01, 1.0), dice.between(1.0, 3.0));
        let cos_beyond = (1.0 - (1.0 - cos * cos) / (ratio * ratio)).sqrt();
        let (there, back) = (dielectric_polarised(cos, ratio), dielectric_polarised(cos_beyond, 1.0 / ratio));
        near(there.s, back.s, 1e-12);
        near(there.p, back.p, 1e-12);
    }
}

#[test]
fn metal_that_absorbs_nothing_is_glass() {
    let mut dice = Dice(2);
    for _ in 0..10_000 {
        let (cos, ratio) = (dice.between(0.0, 1.0), dice.between(0.3, 3.0));
        let (metal, glass) = (conductor_polarised(cos, ratio, 0.0), dielectric_polarised(cos, ratio));
        near(metal.s, glass.s, 1e-9);
        near(metal.p, glass.p, 1e-9);
    }
}

/// By complex arithmetic: `r_s = (cos - q)/(cos + q)`, `r_p = (ñ² cos - q)/(ñ² cos + q)`, `q = √(ñ² - sin²)`.
#[test]
fn metals_obey_fresnel_with_complex_numbers() {
    let mut dice = Dice(3);
    let over = |a: (f64, f64), b: (f64, f64)| (a.0 * a.0 + a.1 * a.1) / (b.0 * b.0 + b.1 * b.1);
    for _ in 0..10_000 {
        let (cos, n, k) = (dice.between(0.0, 1.0), dice.between(0.05, 5.0), dice.between(0.01, 8.0));
        let square = (n * n - k * k, 2.0 * n * k);
        let (re, im) = (square.0 - (1.0 - cos * cos), square.1);
        let length = libm::sqrt(libm::hypot(re, im));
        let half = 0.5 * libm::atan2(im, re);
        let q = (length * libm::cos(half), length * libm::sin(half));
        let both = conductor_polarised(cos, n, k);
        near(both.s, over((cos - q.0, -q.1), (cos + q.0, q.1)), 1e-12);
        let steep = (square.0 * cos, square.1 * cos);
        near(both.p, over((steep.0 - q.0, steep.1 - q.1), (steep.0 + q.0, steep.1 + q.1)), 1e-12);
    }
}

#[test]
fn reflectance_is_a_part_for_any_angle_and_index() {
    let cosines = [-1.0, -0.3, 0.0, 1e-300, 1e-12, 1e-6, 0.5, 1.0, 1.0 + 1e-15];
    let indices = [0.01, 0.5, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.5, 100.0];
    for cos in cosines {
        for n in indices {
            for k in [0.0, 1e-12, 1.0, 500.0] {
                for part in [dielectric(cos, n), conductor(cos, n, k)] {
                    assert!((0.0..=1.0).contains(&part), "{cos} {n} {k}: {part}");
                }
            }
        }
        // Nothing is reflected where nothing changes, at any angle.
        near(dielectric(cos, 1.0), 0.0, 0.0);
        near(conductor(cos, 1.0, 0.0), 0.0, 0.0);
    }
    near(dielectric(0.0, 1.5), 1.0, 1e-11);
    near(conductor(0.0, 0.2, 3.0), 1.0, 1e-11);
}

#[test]
fn many_wavelengths_at_once_are_reflected_as_one_by_one() {
    let (n, k) = ([0.5, 0.9, 1.0, 1.5, 2.4], [3.0, 0.0, 0.1, 2.0, 7.0]);
    assert_eq!(dielectric_each(0.4, &n), n.map(|n| dielectric(0.4, n)));
    let each: [f64; 5] = std::array::from_fn(|i| conductor(0.4, n[i], k[i]));
    assert_eq!(conductor_each(0.4, &n, &k), each);
}
