//! How far a picture is from another: relative RMSE of linear XYZ, and CIEDE2000 of the developed pictures.

use glam::DVec3;
use terrell::color::XYZ_FROM_RGB;
use terrell::film::{Development, meter};

/// The differences of a picture from the reference.
#[derive(Debug, Clone, Copy, Default)]
pub struct Errors {
    /// √(Σ|Δ|²/Σ|XYZ|²)
    pub rmse: f64,
    pub mean: f64,
    pub p99: f64,
}

/// Judges pictures by a reference.
pub struct Judge {
    reference: Vec<DVec3>,
    development: Development,
    lab: Vec<DVec3>,
}

impl Judge {
    pub fn new(reference: Vec<DVec3>) -> Self {
        let white = meter(reference.iter().map(|xyz| xyz.y)).unwrap_or(1.0);
        let development = Development { white };
        let lab = reference.iter().map(|xyz| lab(development, *xyz)).collect();
        Self { reference, development, lab }
    }

    pub fn errors(&self, picture: &[DVec3]) -> Errors {
        let sum: f64 = self.reference.iter().map(|xyz| xyz.length_squared()).sum();
        let off: f64 = self.reference.iter().zip(picture).map(|(a, b)| (*a - *b).length_squared()).sum();
        let mut deltas: Vec<f64> =
            self.lab.iter().zip(picture).map(|(a, b)| ciede2000(*a, lab(self.development, *b))).collect();
        deltas.sort_unstable_by(f64::total_cmp);
        let mean = deltas.iter().sum::<f64>() / deltas.len() as f64;
        Errors { rmse: (off / sum).sqrt(), mean, p99: deltas[deltas.len() * 99 / 100] }
    }
}

fn lab(development: Development, xyz: DVec3) -> DVec3 {
    let white = *XYZ_FROM_RGB * DVec3::ONE;
    let relative = (*XYZ_FROM_RGB * development.display(xyz)) / white;
    let f = |t: f64| {
        if t > 216.0 / 24389.0 { libm::cbrt(t) } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
    };
    let (x, y, z) = (f(relative.x), f(relative.y), f(relative.z));
    DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

/// The colour difference ΔE00 of two CIELAB colours.
///
/// Source: Sharma, Wu and Dalal, Color Research and Application 30(1), 2005, whose numbers are the test.
pub fn ciede2000(p: DVec3, q: DVec3) -> f64 {
    let seventh = |c: f64| (c.powi(7) / (c.powi(7) + 25.0_f64.powi(7))).sqrt();
    let mean_c = 0.5 * (p.y.hypot(p.z) + q.y.hypot(q.z));
    let g = 0.5 * (1.0 - seventh(mean_c));
    let (a1, a2) = ((1.0 + g) * p.y, (1.0 + g) * q.y);
    let (c1, c2) = (a1.hypot(p.z), a2.hypot(q.z));
    let hue = |a: f64, b: f64| {
        if a == 0.0 && b == 0.0 { 0.0 } else { libm::atan2(b, a).to_degrees().rem_euclid(360.0) }
    };
    let (h1, h2) = (hue(a1, p.z), hue(a2, q.z));
    let grey = c1 * c2 == 0.0;
    let turn = match h2 - h1 {
        _ if grey => 0.0,
        d if d > 180.0 => d - 360.0,
        d if d < -180.0 => d + 360.0,
        d => d,
    };
    let d_l = q.x - p.x;
    let d_c = c2 - c1;
    let d_h = 2.0 * (c1 * c2).sqrt() * libm::sin((0.5 * turn).to_radians());
    let (l, c) = (0.5 * (p.x + q.x), 0.5 * (c1 + c2));
    let h = match (h1 - h2).abs() {
        _ if grey => h1 + h2,
        d if d <= 180.0 => 0.5 * (h1 + h2),
        _ if h1 + h2 < 360.0 => 0.5 * (h1 + h2 + 360.0),
        _ => 0.5 * (h1 + h2 - 360.0),
    };
    let cos = |degrees: f64| libm::cos(degrees.to_radians());
    let t = 1.0 - 0.17 * cos(h - 30.0) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0)
        - 0.20 * cos(4.0 * h - 63.0);
    let off = (l - 50.0) * (l - 50.0);
    let s_l = 1.0 + 0.015 * off / (20.0 + off).sqrt();
    let (s_c, s_h) = (1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let bend = (h - 275.0) / 25.0;
    let r = -2.0 * seventh(c) * libm::sin((60.0 * libm::exp(-bend * bend)).to_radians());
    let (l, c, h) = (d_l / s_l, d_c / s_c, d_h / s_h);
    (l * l + c * c + h * h + r * c * h).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_differences_are_those_of_the_published_pairs() {
        let pairs = [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
            ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
            ([22.7233, 20.0904, -46.694], [23.0331, 14.973, -42.5619], 2.0373),
            ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
        ];
        for (p, q, expected) in pairs {
            assert!((ciede2000(p.into(), q.into()) - expected).abs() < 1e-4, "{p:?} {q:?}");
        }
    }
}
