//! The colour difference CIEDE2000, written from its definition and apart from the program's own colours.
//!
//! Sharma, Wu and Dalal, Color Research and Application 30, 21 (2005), all three weights 1.

use glam::DVec3;

/// CIELAB (CIE 15:2018, 8.2.1) of XYZ beside a white.
pub(crate) fn lab(xyz: DVec3, white: DVec3) -> DVec3 {
    let f = |t: f64| if t > 216.0 / 24_389.0 { libm::cbrt(t) } else { (24_389.0 / 27.0 * t + 16.0) / 116.0 };
    let [x, y, z] = (xyz / white).to_array().map(f);
    DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

/// Degrees from 0 to 360; 0 for grey.
fn hue(a: f64, b: f64) -> f64 {
    if a == 0.0 && b == 0.0 { 0.0 } else { libm::atan2(b, a).to_degrees().rem_euclid(360.0) }
}

fn cos(degrees: f64) -> f64 {
    libm::cos(degrees.to_radians())
}

/// c⁷/(c⁷ + 25⁷).
fn seventh(c: f64) -> f64 {
    c.powi(7) / (c.powi(7) + 25.0_f64.powi(7))
}

/// ΔE₀₀ between two colours in CIELAB.
pub(crate) fn ciede2000(one: DVec3, two: DVec3) -> f64 {
    let chroma = |lab: DVec3| libm::hypot(lab.y, lab.z);
    let g = 0.5 * (1.0 - seventh(0.5 * (chroma(one) + chroma(two))).sqrt());
    let [(c1, h1), (c2, h2)] = [one, two].map(|lab| {
        let a = (1.0 + g) * lab.y;
        (libm::hypot(a, lab.z), hue(a, lab.z))
    });
    let (grey, turn) = (c1 * c2 == 0.0, h2 - h1);
    let dh = match turn {
        _ if grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let dh = 2.0 * (c1 * c2).sqrt() * libm::sin(0.5 * dh.to_radians());
    let h = match h1 + h2 {
        sum if grey => sum,
        sum if turn.abs() <= 180.0 => 0.5 * sum,
        sum if sum < 360.0 => 0.5 * (sum + 360.0),
        sum => 0.5 * (sum - 360.0),
    };
    let (l, c) = (0.5 * (one.x + two.x), 0.5 * (c1 + c2));
    let t = 1.0 - 0.17 * cos(h - 30.0) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0)
        - 0.20 * cos(4.0 * h - 63.0);
    let (from_middle, from_blue) = ((l - 50.0) * (l - 50.0), (h - 275.0) / 25.0);
    let s_l = 1.0 + 0.015 * from_middle / (20.0 + from_middle).sqrt();
    let (s_c, s_h) = (1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let turned = 30.0 * libm::exp(-from_blue * from_blue);
    let r = -libm::sin(2.0 * turned.to_radians()) * 2.0 * seventh(c).sqrt();
    let (dl, dc, dh) = ((two.x - one.x) / s_l, (c2 - c1) / s_c, dh / s_h);
    (dl * dl + dc * dc + dh * dh + r * dc * dh).sqrt()
}

/// All pairs of the paper's table 1.
#[test]
fn ciede2000_is_that_of_the_published_pairs() {
    let pairs: Vec<[f64; 7]> = include_str!("ciede2000.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let numbers: Vec<f64> = line.split_whitespace().map(|number| number.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    assert_eq!(pairs.len(), 34);
    for [l1, a1, b1, l2, a2, b2, expected] in pairs {
        let (one, two) = (DVec3::new(l1, a1, b1), DVec3::new(l2, a2, b2));
        super::near(ciede2000(one, two), expected, 5.01e-5);
        super::near(ciede2000(two, one), expected, 5.01e-5);
        assert_eq!(ciede2000(one, one).to_bits(), 0);
    }
}
