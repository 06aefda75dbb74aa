//! The mean of a texture over the ellipse that a sample of the picture stands for.

use super::pyramid::{Pyramid, Stored, divided, linear, multiplied, square};
use super::{Encoding, Filter, SRGB_BYTES, Texels, Texture, Wrap, floor, mix, srgb_byte};
use crate::simd::whole_and_part;
use glam::{DVec2, Vec4};

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

/// The variance of the filter along an axis, in squares of the half axis.
///
/// Measured with a checkerboard to the horizon, 4 samples per pixel and the Gaussian film, against 4096 samples
/// per pixel: 1 lets fine patterns crawl, 3 blurs coarse ones; at 2 no contrast is lost, and errors are least.
const VARIANCE: f64 = 2.0;

/// The square of half a texel: a sample that sees no more than one texel across is not filtered.
const SHARP: f64 = 0.25;

/// The row of taps ends before this many steps to each side: 15 taps at the most.
const REACH: f64 = 8.0;

/// An ellipse in texels.
struct Ellipse {
    /// The unit vector along the major axis.
    direction: DVec2,
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
            direction: along.normalize_or(DVec2::X),
            // Not `mean - length`, which cancels.
            squares: [larger, area * area / larger],
        }
    }
}

/// A row of taps along the major axis.
pub(super) struct Taps {
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
    /// One tap in the picture itself.
    pub(super) const POINT: Self = Self { step: DVec2::ZERO, reach: 1.0, level: 0, above: 0.0 };

    /// None if the ellipse is wider than the level of one texel, or no ellipse.
    ///
    /// A level whose texels are n of the picture's wide has the variance (n² - 1)/4 along both axes: (n² - 1)/12
    /// from the mean of its texels, n²/6 from the mixing of neighbours, less 1/6 from that in the picture
    /// itself. Taps with the weights of a tent add (reach² - 1)/6 squares of their step along the major axis.
    /// So all variances can be had without a jump: nothing changes abruptly with the footprint.
    fn new(ellipse: &Ellipse, top: usize) -> Option<Self> {
        if !ellipse.squares[0].is_finite() {
            return None;
        }
        let [larger, smaller] = ellipse.squares.map(|square| SHARP + VARIANCE * (square - SHARP).max(0.0));
        // The longest row of taps is as long as this; a longer ellipse is made wider.
        let smaller = smaller.max(larger / (1.0 + (REACH * REACH - 1.0) / 1.5));
        let step_squared = 4.0 * smaller;
        let level = libm::ilogb(step_squared) as usize / 2;
        if level >= top {
            return None;
        }
        let texel_squared = (1_u64 << (2 * level)) as f64;
        Some(Self {
            step: ellipse.direction * step_squared.sqrt(),
            reach: (1.0 + 6.0 * (larger - smaller) / step_squared).sqrt(),
            level,
            above: ((step_squared / texel_squared - 1.0) / 3.0) as f32,
        })
    }
}

impl Texture {
    /// The linear RGBA over a footprint around a pair of the mesh's texture coordinates: the mean with the
    /// weights of a bell that has the footprint's shape.
    ///
    /// Where the footprint is no longer than a texel this is [`Texture::rgba`], to the bit. Otherwise up to 15
    /// taps along the major axis are taken in two levels of the [`Pyramid`], whose texels are as wide as the
    /// minor one; an ellipse more than 6.5 times as long as wide is made wider. One that is wider than the
    /// texture, or has an axis that is no number, gets the mean of the picture. Nearest texels and colours with
    /// transparent parts, which are mixed in another way here than by `rgba`, change over between footprints of
    /// one texel and of two.
    ///
    /// It is linear in the texels (of colours with transparent parts, multiplied by alpha). For normals and other
    /// data each channel is the mean of that channel.
    pub fn over(&self, uv: DVec2, footprint: &Footprint) -> [f32; 4] {
        let size = self.picture.size();
        let [u, v] = [footprint.u, footprint.v].map(|axis| self.transform.transform_vector2(axis) * size);
        let ellipse = Ellipse::new(u, v);
        if ellipse.squares[0] <= SHARP {
            return self.rgba(uv);
        }
        let pyramid = self.picture.pyramid();
        let Some(taps) = Taps::new(&ellipse, pyramid.top()) else {
            return pyramid.mean();
        };
        let place = self.transform.transform_point2(uv);
        let mut mean = self.in_level(pyramid, taps.level, place, &taps);
        if taps.above > 0.0 {
            mean = mix(mean, self.in_level(pyramid, taps.level + 1, place, &taps), taps.above);
        }
        if pyramid.premultiplied() {
            mean = divided(mean);
        }
        let length = ellipse.squares[0].sqrt();
        if length < 1.0 && (pyramid.premultiplied() || self.filter == Filter::Nearest) {
            mean = mix(Vec4::from(self.rgba(uv)), mean, (2.0 * length - 1.0) as f32);
        }
        mean.to_array()
    }

    /// The mean of the taps in the picture itself, with colours multiplied by alpha if asked for.
    pub(super) fn in_picture(&self, place: DVec2, taps: &Taps, premultiplied: bool) -> Vec4 {
        let picture = &*self.picture;
        let size = [picture.width, picture.height];
        let weighed = |texel: Vec4| if premultiplied { multiplied(texel) } else { texel };
        // The common case once more: the choice of the decoding is taken out of the loops.
        if let (Texels::Byte(v), Encoding::Srgb) = (&picture.texels, picture.encoding) {
            let (table, width) = (&*SRGB_BYTES, size[0] as usize);
            return self.sum(size, place, taps, |c, r| weighed(srgb_byte(table, v[r * width + c])));
        }
        self.sum(size, place, taps, |column, row| weighed(picture.texel(column, row)))
    }

    /// The mean of the taps in one level, with colours multiplied by alpha if the pyramid's are.
    fn in_level(&self, pyramid: &Pyramid, level: usize, place: DVec2, taps: &Taps) -> Vec4 {
        if level == 0 {
            return self.in_picture(place, taps, pyramid.premultiplied());
        }
        let level = pyramid.level(level);
        let number = |column, row| row * level.size[0] as usize + column;
        match &level.texels {
            Stored::Root(v) => self.sum(level.size, place, taps, |c, r| square(v[number(c, r)])),
            Stored::Word(v) => self.sum(level.size, place, taps, |c, r| linear(v[number(c, r)])),
            Stored::Float(v) => self.sum(level.size, place, taps, |c, r| Vec4::from(v[number(c, r)])),
        }
    }

    /// The mean of the taps in a grid of texels.
    #[inline]
    fn sum(&self, size: [u32; 2], place: DVec2, taps: &Taps, texel: impl Fn(usize, usize) -> Vec4) -> Vec4 {
        let sizes = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let near = |i: usize| match self.wrap[i] {
            Wrap::Clamp => place[i],
            wrap => wrap.coordinate(place[i]),
        };
        let place = DVec2::new(near(0), near(1));
        let step = taps.step / self.picture.size();
        // Steps to each side; the last has still a weight.
        let side = -floor(1.0 - taps.reach);
        let (middle, along) = (place * sizes - 0.5, step * sizes);
        let ends = along.abs() * side;
        // As a rule all taps are well within the grid.
        if (middle - ends).cmpge(DVec2::ZERO).all() && (middle + ends).cmplt(sizes - 1.0).all() {
            let within = |i: f64| {
                let at = middle + along * i;
                let ((column, right), (row, down)) = (whole_and_part(at.x), whole_and_part(at.y));
                let (right, down) = (right as f32, down as f32);
                let along = |row| mix(texel(column, row), texel(column + 1, row), right);
                mix(along(row), along(row + 1), down)
            };
            weighed(taps.reach, side, within)
        } else {
            weighed(taps.reach, side, |i| self.bilinear(place + step * i, size, &texel))
        }
    }
}

/// The mean of the taps from `-side` to `side`.
#[inline]
fn weighed(reach: f64, side: f64, tap: impl Fn(f64) -> Vec4) -> Vec4 {
    let middle = tap(0.0);
    if side <= 0.0 {
        return middle;
    }
    // The sum of all weights.
    let whole = 1.0 + 2.0 * side - side * (side + 1.0) / reach;
    let mut sum = middle * (1.0 / whole) as f32;
    for i in 1..=side as u32 {
        let i = f64::from(i);
        let weight = ((1.0 - i / reach) / whole) as f32;
        sum += tap(-i) * weight + tap(i) * weight;
    }
    sum
}
