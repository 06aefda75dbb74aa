//! Texels as they came from the file, and how a pair of texture coordinates finds them.
//!
//! Texels are kept in the width of the file (8 or 16 bits or float) and decoded when they are looked up.
//! All values that leave this module are linear: sRGB is decoded here and nowhere else.

use glam::{DAffine2, DVec2};
use std::fmt;
use std::sync::{Arc, LazyLock};

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
///
/// ~~~text
/// c / 12.92                     for c ≤ 0.04045
/// ((c + 0.055) / 1.055)^2.4     otherwise
/// ~~~
///
/// Source: IEC 61966-2-1.
pub fn linear_from_srgb(c: f32) -> f32 {
    let c = f64::from(c);
    let linear = if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
    linear as f32
}

/// All 8-bit sRGB values, decoded.
static SRGB_BYTES: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| linear_from_srgb(i as f32 / 255.0)));

/// All 16-bit sRGB values, decoded.
static SRGB_WORDS: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=u16::MAX).map(|i| linear_from_srgb(f32::from(i) / 65535.0)).collect());

impl Picture {
    /// The linear RGBA of the texel at a column and a row, which must be inside.
    fn texel(&self, column: usize, row: usize) -> [f32; 4] {
        let at = row * self.width as usize + column;
        let srgb = self.encoding == Encoding::Srgb;
        match &self.texels {
            Texels::Byte(v) => {
                let [r, g, b, a] = v[at];
                let value = |c: u8| {
                    if srgb { SRGB_BYTES[usize::from(c)] } else { f32::from(c) / 255.0 }
                };
                [value(r), value(g), value(b), f32::from(a) / 255.0]
            }
            Texels::Word(v) => {
                let [r, g, b, a] = v[at];
                let value = |c: u16| {
                    if srgb { SRGB_WORDS[usize::from(c)] } else { f32::from(c) / 65535.0 }
                };
                [value(r), value(g), value(b), f32::from(a) / 65535.0]
            }
            Texels::Float(v) => v[at],
        }
    }
}

impl Wrap {
    /// A texture coordinate brought near to the picture, so that texel numbers stay small and exact.
    fn coordinate(self, u: f64) -> f64 {
        match self {
            _ if !u.is_finite() => 0.0,
            Self::Repeat => u - u.floor(),
            Self::Mirror => u - 2.0 * (u / 2.0).floor(),
            Self::Clamp => u.clamp(0.0, 1.0),
        }
    }

    /// The texel of a row of `size` that stands in for number `i`, inside or outside.
    fn texel(self, i: i64, size: u32) -> usize {
        let size = i64::from(size);
        let inside = match self {
            Self::Repeat => i.rem_euclid(size),
            Self::Mirror => {
                let i = i.rem_euclid(2 * size);
                i.min(2 * size - 1 - i)
            }
            Self::Clamp => i.clamp(0, size - 1),
        };
        inside as usize
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
        let x = self.wrap[0].coordinate(uv.x) * f64::from(picture.width);
        let y = self.wrap[1].coordinate(uv.y) * f64::from(picture.height);
        let at = |column: i64, row: i64| {
            let column = self.wrap[0].texel(column, picture.width);
            picture.texel(column, self.wrap[1].texel(row, picture.height))
        };
        if self.filter == Filter::Nearest {
            return at(x.floor() as i64, y.floor() as i64);
        }
        let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (right, down) = ((x - 0.5 - left) as f32, (y - 0.5 - top) as f32);
        let (left, top) = (left as i64, top as i64);
        let upper = mix(at(left, top), at(left + 1, top), right);
        let lower = mix(at(left, top + 1), at(left + 1, top + 1), right);
        mix(upper, lower, down)
    }
}

/// `a` for a share of 0, `b` for a share of 1.
fn mix(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] * (1.0 - share) + b[i] * share)
}
