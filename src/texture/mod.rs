//! Texels as they came from the file, and how a pair of texture coordinates finds them.
//!
//! Texels are kept in the width of the file (8 or 16 bits or float) and decoded when they are looked up.
//! All values that leave this module are linear: sRGB is decoded here and nowhere else.
//!
//! [`Texture::rgba`] is the value at a point, [`Texture::over`] the mean over what a sample sees.

mod filter;
mod pyramid;

use glam::{DAffine2, DVec2, Vec4};
use std::fmt;
use std::sync::{Arc, LazyLock};

pub use filter::Footprint;
use filter::Taps;
pub use pyramid::Pyramid;

/// How stored numbers become linear ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// IEC 61966-2-1, for colours in 8 or 16 bits; alpha is linear.
    Srgb,
    /// As stored.
    Linear,
}

/// The numbers of a picture, row by row from the top, four channels each.
#[derive(Clone)]
pub enum Texels {
    /// 8 bits a channel.
    Byte(Vec<[u8; 4]>),
    /// 16 bits a channel.
    Word(Vec<[u16; 4]>),
    /// Floating point, linear.
    Float(Vec<[f32; 4]>),
}

impl fmt::Debug for Texels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Byte(v) => write!(f, "Byte({} texels)", v.len()),
            Self::Word(v) => write!(f, "Word({} texels)", v.len()),
            Self::Float(v) => write!(f, "Float({} texels)", v.len()),
        }
    }
}

/// A decoded picture file.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// `width * height` texels.
    pub texels: Texels,
    /// What the numbers mean.
    pub encoding: Encoding,
    pyramid: pyramid::Lazy,
}

/// What happens beyond the edge of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The texture is repeated.
    #[default]
    Repeat,
    /// The texture is repeated, every other time mirrored.
    Mirror,
    /// The edge goes on.
    Clamp,
}

/// How values between texel centres are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Filter {
    /// Bilinear.
    #[default]
    Linear,
    /// The nearest texel.
    Nearest,
}

/// A picture with the way it is laid on a surface.
#[derive(Debug, Clone)]
pub struct Texture {
    /// Its texels, shared by all textures made from the same file.
    pub picture: Arc<Picture>,
    /// Beyond the edges, along u and along v.
    pub wrap: [Wrap; 2],
    /// Between the texels.
    pub filter: Filter,
    /// Which of the mesh's sets of texture coordinates (0 or 1).
    pub uv_set: u8,
    /// Applied to the texture coordinates first (`KHR_texture_transform`, or OBJ's `-o` and `-s`).
    pub transform: DAffine2,
}

/// The linear value of an sRGB-encoded one, both from 0 to 1.
pub fn linear_from_srgb(c: f32) -> f32 {
    crate::color::srgb_decode(f64::from(c)) as f32
}

/// All 8-bit sRGB values, decoded.
static SRGB_BYTES: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| linear_from_srgb(i as f32 / 255.0)));

/// All 16-bit sRGB values, decoded.
static SRGB_WORDS: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=u16::MAX).map(|i| linear_from_srgb(f32::from(i) / 65535.0)).collect());

/// The linear value of a texel of 8-bit sRGB, by the table of all of them.
#[inline]
fn srgb_byte(table: &[f32; 256], [r, g, b, a]: [u8; 4]) -> Vec4 {
    let value = |c: u8| table[usize::from(c)];
    Vec4::new(value(r), value(g), value(b), f32::from(a) / 255.0)
}

impl Picture {
    /// A picture of `width * height` texels, row by row from the top.
    pub fn new(width: u32, height: u32, texels: Texels, encoding: Encoding) -> Self {
        Self { width, height, texels, encoding, pyramid: pyramid::Lazy::default() }
    }

    /// Columns and rows.
    fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height))
    }

    /// The linear RGBA of the texel at a column and a row, which must be inside.
    fn texel(&self, column: usize, row: usize) -> Vec4 {
        let at = row * self.width as usize + column;
        let srgb = self.encoding == Encoding::Srgb;
        match &self.texels {
            Texels::Byte(v) => {
                if srgb {
                    srgb_byte(&SRGB_BYTES, v[at])
                } else {
                    Vec4::from(v[at].map(f32::from)) / 255.0
                }
            }
            Texels::Word(v) => {
                let [r, g, b, a] = v[at];
                let value = |c: u16| {
                    if srgb { SRGB_WORDS[usize::from(c)] } else { f32::from(c) / 65535.0 }
                };
                Vec4::new(value(r), value(g), value(b), f32::from(a) / 65535.0)
            }
            Texels::Float(v) => Vec4::from(v[at]),
        }
    }
}

impl Wrap {
    /// A texture coordinate brought near to the picture, so that texel numbers stay small and exact.
    fn coordinate(self, u: f64) -> f64 {
        match self {
            Self::Clamp if u.is_finite() => u.clamp(0.0, 1.0),
            // Not finite, or so large that all numbers are even.
            _ if !(u.abs() < 9_007_199_254_740_992.0) => 0.0,
            Self::Mirror => u - 2.0 * floor(u / 2.0),
            _ => u - floor(u),
        }
    }

    /// The texel of a row of `size` that stands in for number `i`, up to one beyond the range that
    /// [`Wrap::coordinate`] leaves.
    fn texel(self, i: i64, size: u32) -> usize {
        let size = i64::from(size);
        let inside = match self {
            Self::Repeat if i < 0 => i + size,
            Self::Repeat if i >= size => i - size,
            Self::Mirror if i < 0 => -1 - i,
            Self::Mirror if i >= 2 * size => i - 2 * size,
            Self::Mirror if i >= size => 2 * size - 1 - i,
            _ => i,
        };
        inside.clamp(0, size - 1) as usize
    }

    /// The two texels of a row of `size` between whose centres a coordinate lies, and the share of the second.
    #[inline]
    fn between(self, u: f64, size: u32) -> ([usize; 2], f32) {
        let x = self.coordinate(u) * f64::from(size) - 0.5;
        let first = floor(x);
        let texel = |i: f64| self.texel(i as i64, size);
        ([texel(first), texel(first + 1.0)], (x - first) as f32)
    }
}

impl Texture {
    /// The linear RGBA at a pair of the mesh's texture coordinates; the origin is the upper left corner of
    /// the upper left texel, whose centre is half a texel right of and below it.
    ///
    /// Alpha is not multiplied in. Coordinates that are not finite count as zero. Values are decoded
    /// before they are mixed, so that the mean of black and white is half the light of white.
    pub fn rgba(&self, uv: DVec2) -> [f32; 4] {
        let uv = self.transform.transform_point2(uv);
        let picture = &*self.picture;
        let size = [picture.width, picture.height];
        if self.filter == Filter::Nearest {
            let [column, row] = [0, 1].map(|i| {
                let x = self.wrap[i].coordinate(uv[i]) * f64::from(size[i]);
                self.wrap[i].texel(floor(x) as i64, size[i])
            });
            return picture.texel(column, row).to_array();
        }
        self.in_picture(uv, &Taps::POINT, false).to_array()
    }

    /// The value at a pair of the picture's coordinates in a grid of texels of its own or another size.
    #[inline]
    fn bilinear(&self, uv: DVec2, size: [u32; 2], texel: impl Fn(usize, usize) -> Vec4) -> Vec4 {
        let [(columns, right), (rows, down)] =
            [self.wrap[0].between(uv.x, size[0]), self.wrap[1].between(uv.y, size[1])];
        let [upper, lower] = rows.map(|row| mix(texel(columns[0], row), texel(columns[1], row), right));
        mix(upper, lower, down)
    }
}

/// The largest whole number up to `x`, for numbers that fit 64 bits: no call, which `f64::floor` is on a bare x86-64.
#[inline]
fn floor(x: f64) -> f64 {
    let toward_zero = x as i64 as f64;
    if toward_zero > x { toward_zero - 1.0 } else { toward_zero }
}

/// `a` for a share of 0, `b` for a share of 1.
#[inline]
fn mix(a: Vec4, b: Vec4, share: f32) -> Vec4 {
    a * (1.0 - share) + b * share
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the numbers are binary fractions, and exact")]
mod tests {
    use super::*;

    /// A row of texels whose red is as given, with alpha for the number of the row.
    fn texture(width: u32, reds: &[f32], wrap: Wrap, filter: Filter) -> Texture {
        let height = reds.len() as u32 / width;
        let texels =
            reds.iter().enumerate().map(|(i, &r)| [r, 0.0, 0.0, (i as u32 / width) as f32]).collect();
        let picture = Picture::new(width, height, Texels::Float(texels), Encoding::Linear);
        Texture {
            picture: Arc::new(picture),
            wrap: [wrap; 2],
            filter,
            uv_set: 0,
            transform: DAffine2::IDENTITY,
        }
    }

    fn reds(texture: &Texture, us: &[f64]) -> Vec<f32> {
        us.iter().map(|&u| texture.rgba(DVec2::new(u, 0.5))[0]).collect()
    }

    #[test]
    fn texel_centres_are_half_a_texel_in() {
        let texture = texture(2, &[1.0, 2.0, 3.0, 4.0], Wrap::Clamp, Filter::Linear);
        let at = |u, v| texture.rgba(DVec2::new(u, v));
        assert_eq!(at(0.25, 0.25), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(at(0.75, 0.25), [2.0, 0.0, 0.0, 0.0]);
        assert_eq!(at(0.25, 0.75), [3.0, 0.0, 0.0, 1.0]);
        assert_eq!(at(0.75, 0.75), [4.0, 0.0, 0.0, 1.0]);
        assert_eq!(at(0.5, 0.5), [2.5, 0.0, 0.0, 0.5]);
        assert_eq!(at(0.375, 0.25)[0], 1.25);
    }

    #[test]
    fn repeated_texture_mixes_its_last_texel_with_its_first() {
        let texture = texture(4, &[0.0, 1.0, 2.0, 3.0], Wrap::Repeat, Filter::Linear);
        assert_eq!(reds(&texture, &[0.0, 1.0, -7.0, 0.125, 1.125, -0.125]), [1.5, 1.5, 1.5, 0.0, 0.0, 3.0]);
    }

    #[test]
    fn mirrored_texture_runs_back_every_other_time() {
        let texture = texture(4, &[0.0, 1.0, 2.0, 3.0], Wrap::Mirror, Filter::Linear);
        assert_eq!(
            reds(&texture, &[0.125, -0.125, 2.125, 1.125, 1.875, -1.125]),
            [0.0, 0.0, 0.0, 3.0, 0.0, 3.0]
        );
        assert_eq!(reds(&texture, &[0.0, 1.0, 0.25, -0.25, 1.75]), [0.0, 3.0, 0.5, 0.5, 0.5]);
    }

    #[test]
    fn clamped_texture_goes_on_with_its_edge() {
        let texture = texture(4, &[5.0, 1.0, 2.0, 3.0], Wrap::Clamp, Filter::Linear);
        assert_eq!(reds(&texture, &[0.0, -9.0, 1.0, 1e300, 0.25]), [5.0, 5.0, 3.0, 3.0, 3.0]);
    }

    #[test]
    fn nearest_texel_is_the_one_it_lies_in() {
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            let texture = texture(4, &[0.0, 1.0, 2.0, 3.0], wrap, Filter::Nearest);
            assert_eq!(reds(&texture, &[0.0, 0.2499, 0.25, 0.99]), [0.0, 0.0, 1.0, 3.0], "{wrap:?}");
        }
        let beyond =
            |wrap| reds(&texture(4, &[0.0, 1.0, 2.0, 3.0], wrap, Filter::Nearest), &[-0.1, 1.1, 1.0]);
        assert_eq!(beyond(Wrap::Repeat), [3.0, 0.0, 0.0]);
        assert_eq!(beyond(Wrap::Mirror), [0.0, 3.0, 3.0]);
        assert_eq!(beyond(Wrap::Clamp), [0.0, 3.0, 3.0]);
    }

    #[test]
    fn coordinates_that_are_no_numbers_count_as_zero() {
        let texture = texture(1, &[7.0], Wrap::Repeat, Filter::Linear);
        assert_eq!(reds(&texture, &[f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300]), [7.0; 4]);
    }

    #[test]
    fn transform_comes_before_everything_else() {
        let mut texture = texture(4, &[0.0, 1.0, 2.0, 3.0], Wrap::Repeat, Filter::Linear);
        texture.transform =
            DAffine2::from_scale_angle_translation(DVec2::new(2.0, 1.0), 0.0, DVec2::new(0.25, 0.0));
        assert_eq!(reds(&texture, &[0.0625, 0.1875, 0.4375]), [1.0, 2.0, 0.0]);
    }

    #[test]
    fn colours_are_decoded_before_they_are_mixed_and_alpha_is_not_decoded() {
        let texels = vec![[0, 0, 0, 0], [255, 255, 255, 255]];
        let picture = |texels, encoding| Picture::new(2, 1, texels, encoding);
        let mut texture = texture(1, &[0.0], Wrap::Clamp, Filter::Linear);
        texture.picture = Arc::new(picture(Texels::Byte(texels), Encoding::Srgb));
        assert_eq!(texture.rgba(DVec2::new(0.5, 0.5)), [0.5; 4]);
        let middle = vec![[188, 188, 188, 51]; 2];
        texture.picture = Arc::new(picture(Texels::Byte(middle.clone()), Encoding::Srgb));
        let [red, _, _, alpha] = texture.rgba(DVec2::ZERO);
        assert!((red - 0.502_886).abs() < 1e-6, "{red}");
        assert!((alpha - 0.2).abs() < 1e-7);
        texture.picture = Arc::new(picture(Texels::Byte(middle), Encoding::Linear));
        assert!((texture.rgba(DVec2::ZERO)[0] - 188.0 / 255.0).abs() < 1e-7);
        let words = vec![[188 * 257, 0, 65535, 13107]; 2];
        texture.picture = Arc::new(picture(Texels::Word(words), Encoding::Srgb));
        let [red, green, blue, alpha] = texture.rgba(DVec2::ZERO);
        assert!((red - 0.502_886).abs() < 1e-6, "{red}");
        assert_eq!((green, blue), (0.0, 1.0));
        assert!((alpha - 0.2).abs() < 1e-7);
    }

    #[test]
    fn srgb_has_the_standards_values_at_both_ends_of_each_piece() {
        assert_eq!(linear_from_srgb(0.0), 0.0);
        assert_eq!(linear_from_srgb(1.0), 1.0);
        assert!((linear_from_srgb(0.04045) - 0.003_130_8).abs() < 1e-7);
        assert!((linear_from_srgb(0.040_451) - 0.003_130_8).abs() < 1e-6);
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-6);
    }
}
