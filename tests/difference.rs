//! How different two colours look.

use crate::support::near;
use glam::DVec3;
use terrell::color::{Discrimination, Lab, ciede2000};

const fn lab(l: f64, a: f64, b: f64) -> Lab {
    Lab { l, a, b }
}

/// From the table of Sharma, Wu and Dalal (2005): pairs that tell right programs from wrong ones, and their differences.
const PAIRS: [(Lab, Lab, f64); 20] = [
    (lab(50.0, 2.6772, -79.7751), lab(50.0, 0.0, -82.7485), 2.0425),
    (lab(50.0, 3.1571, -77.2803), lab(50.0, 0.0, -82.7485), 2.8615),
    (lab(50.0, 2.8361, -74.0200), lab(50.0, 0.0, -82.7485), 3.4412),
    (lab(50.0, -1.3802, -84.2814), lab(50.0, 0.0, -82.7485), 1.0),
    (lab(50.0, 0.0, 0.0), lab(50.0, -1.0, 2.0), 2.3669),
    (lab(50.0, 2.4900, -0.0010), lab(50.0, -2.4900, 0.0009), 7.1792),
    (lab(50.0, 2.4900, -0.0010), lab(50.0, -2.4900, 0.0011), 7.2195),
    (lab(50.0, -0.0010, 2.4900), lab(50.0, 0.0009, -2.4900), 4.8045),
    (lab(50.0, -0.0010, 2.4900), lab(50.0, 0.0011, -2.4900), 4.7461),
    (lab(50.0, 2.5, 0.0), lab(50.0, 0.0, -2.5), 4.3065),
    (lab(50.0, 2.5, 0.0), lab(73.0, 25.0, -18.0), 27.1492),
    (lab(50.0, 2.5, 0.0), lab(61.0, -5.0, 29.0), 22.8977),
    (lab(50.0, 2.5, 0.0), lab(56.0, -27.0, -3.0), 31.9030),
    (lab(50.0, 2.5, 0.0), lab(58.0, 24.0, 15.0), 19.4535),
    (lab(60.2574, -34.0099, 36.2677), lab(60.4626, -34.1751, 39.4387), 1.2644),
    (lab(63.0109, -31.0961, -5.8663), lab(62.8187, -29.7946, -4.0864), 1.2630),
    (lab(22.7233, 20.0904, -46.6940), lab(23.0331, 14.9730, -42.5619), 2.0373),
    (lab(90.8027, -2.0831, 1.4410), lab(91.1528, -1.6435, 0.0447), 1.4441),
    (lab(6.7747, -0.2908, -2.4247), lab(5.8714, -0.0985, -2.2286), 0.6377),
    (lab(2.0776, 0.0795, -1.1350), lab(0.9033, -0.0636, -0.5514), 0.9082),
];

#[test]
fn ciede2000_is_that_of_the_published_pairs() {
    for (one, two, published) in PAIRS {
        near(ciede2000(one, two), published, 5e-5);
        near(ciede2000(two, one), published, 5e-5);
    }
}

#[test]
fn white_grey_and_black_are_where_cielab_has_them() {
    let white = Lab::of_rgb(DVec3::ONE);
    near(white.l, 100.0, 1e-12);
    near(white.a.hypot(white.b), 0.0, 1e-12);
    near(Lab::of_rgb(DVec3::ZERO).l, 0.0, 1e-12);
    // Half lightness at the reflectance (66/116)^3.
    near(Lab::of_rgb(DVec3::splat((66.0_f64 / 116.0).powi(3))).l, 50.0, 1e-9);
}

#[test]
fn small_steps_around_a_colour_look_as_different_as_ciede2000_says() {
    let mut greatest: f64 = 0.0;
    for (around, ..) in PAIRS.into_iter().chain([(lab(50.0, 0.0, 0.0), lab(0.0, 0.0, 0.0), 0.0)]) {
        let near_it = Discrimination::around(around);
        for (l, a, b) in
            [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.5, -0.7, 0.9), (-0.3, 0.8, 0.6)]
        {
            let step = 1e-3;
            let other = lab(around.l + step * l, around.a + step * a, around.b + step * b);
            let off = near_it.distance(other) / ciede2000(around, other) - 1.0;
            greatest = greatest.max(off.abs());
        }
    }
    assert!(greatest < 2e-3, "{greatest}");
}
