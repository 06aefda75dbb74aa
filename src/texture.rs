//! Texels as they came from the file, and how a pair of texture coordinates finds them.
//!
//! Texels are kept in the width of the file (8 or 16 bits or float) and decoded when they are looked up.
//! All values that leave this module are linear: sRGB is decoded here and nowhere else.

use glam::DAffine2;
use std::fmt;
use std::sync::Arc;

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

impl Texture {
    /// tmp
    pub fn rgba(&self, _uv: glam::DVec2) -> [f32; 4] {
        [1.0; 4]
    }
}
