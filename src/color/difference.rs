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

/// What looks different around one colour: CIEDE2000 for small steps from it, for which it is quicker to reckon.
#[derive(Debug, Clone, Copy)]
pub struct Discrimination {
    around: Lab,
    // What a is stretched by, and the direction of more chroma in the stretched plane.
    stretch: f64,
    outwards: (f64, f64),
    // Just noticeable steps of lightness, chroma and hue.
    steps: (f64, f64, f64),
    turned: f64,
}

impl Discrimination {
    /// Around a colour.
    pub fn around(lab: Lab) -> Self {
        let stretch = stretch(libm::hypot(lab.a, lab.b));
        let a = lab.a * stretch;
        let c = libm::hypot(a, lab.b);
        let outwards = if c > 0.0 { (a / c, lab.b / c) } else { (1.0, 0.0) };
        let (steps, turned) = weights(lab.l, c, hue(lab.b, a));
        Self { around: lab, stretch, outwards, steps, turned }
    }

    /// How different a colour near it looks.
    pub fn distance(&self, lab: Lab) -> f64 {
        let (a, b) = ((lab.a - self.around.a) * self.stretch, lab.b - self.around.b);
        let (x, y) = self.outwards;
        let l = (lab.l - self.around.l) / self.steps.0;
        let (c, h) = ((a * x + b * y) / self.steps.1, (b * x - a * y) / self.steps.2);
        (l * l + c * c + h * h + self.turned * c * h).max(0.0).sqrt()
    }
}

fn suppressed(chroma: f64) -> f64 {
    let to_seventh = |c: f64| {
        let cubed = c * c * c;
        cubed * cubed * c
    };
    (to_seventh(chroma) / (to_seventh(chroma) + to_seventh(25.0))).sqrt()
}

fn stretch(chroma: f64) -> f64 {
    1.0 + 0.5 * (1.0 - suppressed(chroma))
}

/// Degrees, 0 to 360.
fn hue(b: f64, a: f64) -> f64 {
    let degrees = libm::atan2(b, a).to_degrees();
    if degrees < 0.0 { degrees + 360.0 } else { degrees }
}

/// The steps of lightness, chroma and hue that look alike at a lightness, chroma and hue, and the term that turns them in the blue.
fn weights(l: f64, c: f64, h: f64) -> ((f64, f64, f64), f64) {
    let cosine = |degrees: f64| libm::cos(degrees.to_radians());
    let t = 1.0 - 0.17 * cosine(h - 30.0) + 0.24 * cosine(2.0 * h) + 0.32 * cosine(3.0 * h + 6.0)
        - 0.20 * cosine(4.0 * h - 63.0);
    let off = (l - 50.0) * (l - 50.0);
    let steps = (1.0 + 0.015 * off / (20.0 + off).sqrt(), 1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let blue = (h - 275.0) / 25.0;
    (steps, -2.0 * suppressed(c) * libm::sin((60.0 * libm::exp(-blue * blue)).to_radians()))
}

/// The difference CIEDE2000 of two colours: about 1 is just noticeable side by side.
///
/// Source: CIE 142:2001, as stated by Sharma, Wu and Dalal, Color Research and Application 30(1), 2005.
pub fn ciede2000(one: Lab, two: Lab) -> f64 {
    let mean_chroma = 0.5 * (libm::hypot(one.a, one.b) + libm::hypot(two.a, two.b));
    let stretch = stretch(mean_chroma);
    let (a1, a2) = (one.a * stretch, two.a * stretch);
    let (c1, c2) = (libm::hypot(a1, one.b), libm::hypot(a2, two.b));
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
    let ((sl, sc, sh), turned) = weights(l, c, h);
    let (l, c, h) = (dl / sl, dc / sc, dh / sh);
    (l * l + c * c + h * h + turned * c * h).max(0.0).sqrt()
}
