//! The mean of a texture over the ellipse that a sample of the picture stands for.

use super::pyramid::{Pyramid, Stored, divided, linear, multiplied, square};
use super::{Filter, Texture, mix};
use glam::DVec2;

/// The ellipse of a surface that a sample stands for, in the mesh's texture coordinates: two conjugate half
/// axes, the images of any two perpendicular radii of the sample's cone of sight.
///
/// The cone's radius is half the distance to the next sample: a quarter of a pixel for 4 samples per pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// One half axis.
    pub u: DVec2,
    /// The other.
    pub v: DVec2,
}

/// The row of taps ends before this many steps: 15 of them at the most.
const REACH: f64 = 8.0;

/// The variance along the major axis, in squares of the half axis.
fn gain() -> f64 {
    static G: std::sync::LazyLock<f64> =
        std::sync::LazyLock::new(|| std::env::var("GAIN").map_or(1.0, |s| s.parse().unwrap()));
    *G
}
fn minor_gain() -> f64 {
    static G: std::sync::LazyLock<f64> =
        std::sync::LazyLock::new(|| std::env::var("MINOR").map_or(1.0, |s| s.parse().unwrap()));
    *G
}

/// An ellipse in texels.
struct Ellipse {
    /// The major half axis.
    major: DVec2,
    /// The squares of the half axes' lengths.
    squares: [f64; 2],
}

impl Ellipse {
    /// From two conjugate half axes: the singular values of the matrix that they make, and the first direction.
    fn new(u: DVec2, v: DVec2) -> Self {
        let (xx, yy, xy) = (u.x * u.x + v.x * v.x, u.y * u.y + v.y * v.y, u.x * u.y + v.x * v.y);
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let length = (half * half + xy * xy).sqrt();
        let along = if half > 0.0 { DVec2::new(length + half, xy) } else { DVec2::new(xy, length - half) };
        let larger = mean + length;
        let area = u.perp_dot(v);
        Self {
            major: along.normalize_or(DVec2::X) * larger.sqrt(),
            // Not `mean - length`, which cancels.
            squares: [larger, area * area / larger],
        }
    }
}

/// A row of taps along the major axis.
struct Taps {
    /// From one to the next, texels.
    step: DVec2,
    /// The weight of tap `i` is 1 - |i| / reach.
    reach: f64,
    /// The level below the one wanted.
    level: usize,
    /// The share of the level above.
    above: f32,
}

impl Taps {
    /// None if the ellipse is wider than the level of one texel, or no ellipse.
    fn new(ellipse: &Ellipse, top: usize) -> Option<Self> {
        let [larger, smaller] = ellipse.squares;
        if !larger.is_finite() {
            return None;
        }
        let gain = gain();
        let least = larger / (1.0 + (REACH * REACH - 1.0) * 4.0 / (6.0 * gain));
        let smaller = (smaller * minor_gain()).max(least).max(0.25);
        let width = 4.0 * smaller;
        let level = libm::ilogb(width) as usize / 2;
        if level >= top {
            return None;
        }
        let below = (1_u64 << (2 * level)) as f64;
        Some(Self {
            step: ellipse.major * (width / larger).sqrt(),
            reach: (1.0 + 6.0 * gain * (larger - smaller).max(0.0) / width).sqrt(),
            level,
            above: ((width / below - 1.0) / 3.0) as f32,
        })
    }
}

impl Texture {
    /// The linear RGBA over a footprint around a pair of the mesh's texture coordinates.
    pub fn over(&self, uv: DVec2, footprint: &Footprint) -> [f32; 4] {
        let size = DVec2::new(f64::from(self.picture.width), f64::from(self.picture.height));
        let [u, v] = [footprint.u, footprint.v].map(|axis| self.transform.transform_vector2(axis) * size);
        let ellipse = Ellipse::new(u, v);
        if ellipse.squares[0] <= 0.25 {
            return self.rgba(uv);
        }
        let pyramid = self.picture.pyramid();
        let Some(taps) = Taps::new(&ellipse, pyramid.top()) else {
            return pyramid.mean();
        };
        let place = self.transform.transform_point2(uv);
        let mut mean = self.tapped(pyramid, taps.level, place, &taps);
        if taps.above > 0.0 {
            mean = mix(mean, self.tapped(pyramid, taps.level + 1, place, &taps), taps.above);
        }
        if pyramid.premultiplied() {
            mean = divided(mean);
        }
        let length = ellipse.squares[0].sqrt();
        if length < 1.0 && (pyramid.premultiplied() || self.filter == Filter::Nearest) {
            mean = mix(self.rgba(uv), mean, (2.0 * length - 1.0) as f32);
        }
        mean
    }

    /// The mean of the taps in one level.
    fn tapped(&self, pyramid: &Pyramid, level: usize, place: DVec2, taps: &Taps) -> [f32; 4] {
        let picture = &*self.picture;
        if level == 0 {
            let size = [picture.width, picture.height];
            return if pyramid.premultiplied() {
                self.sum(size, place, taps, |column, row| multiplied(picture.texel(column, row)))
            } else {
                self.sum(size, place, taps, |column, row| picture.texel(column, row))
            };
        }
        let level = pyramid.level(level);
        let number = |column, row| row * level.size[0] as usize + column;
        match &level.texels {
            Stored::Root(v) => self.sum(level.size, place, taps, |c, r| square(v[number(c, r)])),
            Stored::Word(v) => self.sum(level.size, place, taps, |c, r| linear(v[number(c, r)])),
            Stored::Float(v) => self.sum(level.size, place, taps, |c, r| v[number(c, r)]),
        }
    }

    #[inline]
    fn sum(
        &self,
        size: [u32; 2],
        place: DVec2,
        taps: &Taps,
        texel: impl Fn(usize, usize) -> [f32; 4],
    ) -> [f32; 4] {
        let middle = self.bilinear(place, size, &texel);
        let side = (taps.reach.ceil() - 1.0).max(0.0);
        if side == 0.0 {
            return middle;
        }
        let step = taps.step / DVec2::new(f64::from(self.picture.width), f64::from(self.picture.height));
        let whole = 1.0 + 2.0 * side - side * (side + 1.0) / taps.reach;
        let mut sum = middle.map(|c| c * (1.0 / whole) as f32);
        for i in 1..=side as u32 {
            let i = f64::from(i);
            let weight = ((1.0 - i / taps.reach) / whole) as f32;
            for at in [place - step * i, place + step * i] {
                let value = self.bilinear(at, size, &texel);
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += value * weight;
                }
            }
        }
        sum
    }
}
