//! How different two colours look.

use super::XYZ_FROM_RGB;
use glam::DVec3;

/// A colour in CIELAB (CIE 15:2018).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lab {
    /// Lightness, 0 (black) to 100 (white).
    pub l: f64,
    /// From green to red.
    pub a: f64,
    /// From blue to yellow.
    pub b: f64,
}

impl Lab {
    /// Of linear sRGB in which white is 1, seen among that white.
    pub fn of_rgb(rgb: DVec3) -> Self {
        let white = *XYZ_FROM_RGB * DVec3::ONE;
        let xyz = *XYZ_FROM_RGB * rgb / white;
        let f = |t: f64| {
            const KNEE: f64 = 216.0 / 24389.0;
            if t > KNEE { libm::cbrt(t) } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
        };
        let (x, y, z) = (f(xyz.x), f(xyz.y), f(xyz.z));
        Self { l: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) }
    }
}

/// The difference CIEDE2000 of two colours: about 1 is just noticeable side by side.
///
/// Source: CIE 142:2001, as stated by Sharma, Wu and Dalal, Color Research and Application 30(1), 2005.
pub fn ciede2000(one: Lab, two: Lab) -> f64 {
    let to_seventh = |c: f64| {
        let cubed = c * c * c;
        cubed * cubed * c
    };
    let suppressed = |c: f64| (to_seventh(c) / (to_seventh(c) + to_seventh(25.0))).sqrt();
    let mean_chroma = 0.5 * (libm::hypot(one.a, one.b) + libm::hypot(two.a, two.b));
    let stretch = 1.0 + 0.5 * (1.0 - suppressed(mean_chroma));
    let (a1, a2) = (one.a * stretch, two.a * stretch);
    let (c1, c2) = (libm::hypot(a1, one.b), libm::hypot(a2, two.b));
    let hue = |b: f64, a: f64| {
        let degrees = libm::atan2(b, a).to_degrees();
        if degrees < 0.0 { degrees + 360.0 } else { degrees }
    };
    let (h1, h2) = (hue(one.b, a1), hue(two.b, a2));
    let grey = c1 * c2 == 0.0;
    let turn = match h2 - h1 {
        _ if grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let (dl, dc) = (two.l - one.l, c2 - c1);
    let dh = 2.0 * (c1 * c2).sqrt() * libm::sin(0.5 * turn.to_radians());
    let (l, c) = (0.5 * (one.l + two.l), 0.5 * (c1 + c2));
    let h = match h1 + h2 {
        sum if grey => sum,
        sum if (h1 - h2).abs() <= 180.0 => 0.5 * sum,
        sum if sum < 360.0 => 0.5 * (sum + 360.0),
        sum => 0.5 * (sum - 360.0),
    };
    let cosine = |degrees: f64| libm::cos(degrees.to_radians());
    let t = 1.0 - 0.17 * cosine(h - 30.0) + 0.24 * cosine(2.0 * h) + 0.32 * cosine(3.0 * h + 6.0)
        - 0.20 * cosine(4.0 * h - 63.0);
    let off = (l - 50.0) * (l - 50.0);
    let (sl, sc, sh) = (1.0 + 0.015 * off / (20.0 + off).sqrt(), 1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let blue = (h - 275.0) / 25.0;
    let turned = -2.0 * suppressed(c) * libm::sin((60.0 * libm::exp(-blue * blue)).to_radians());
    let (l, c, h) = (dl / sl, dc / sc, dh / sh);
    (l * l + c * c + h * h + turned * c * h).max(0.0).sqrt()
}
