//! Two eyes beside one another.
//!
//! They are `apart` in the momentary rest frame of the observer, to the left and the right of its place along the picture's
//! own right, at one time of that frame; both look the same way, so what is infinitely far away is at the same place in
//! both pictures.

use crate::color::{RGB_FROM_XYZ, XYZ_FROM_RGB};
use crate::film::Negative;
use glam::DVec3;

/// Two eyes, and how their pictures are put together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stereo {
    /// From one eye to the other, metres.
    pub apart: f64,
    /// Where their pictures go.
    pub layout: Layout,
}

/// How the pictures of two eyes are put together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// Two films, in folders `left` and `right`.
    LeftRight,
    /// In one picture, the left eye's in its left half.
    SideBySide,
    /// In one picture, for glasses that are red on the left and cyan on the right.
    Anaglyph,
}

/// One of two eyes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Side {
    /// Both, in their order.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// As folders are named.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// How far to the right it is, metres, of eyes that are `apart`.
    pub fn offset(self, apart: f64) -> f64 {
        match self {
            Self::Left => -0.5 * apart,
            Self::Right => 0.5 * apart,
        }
    }
}

/// Both eyes' pixels, as they are shown (linear sRGB), in one: red is the left one's luminance, green and blue are the right
/// one's. What is grey stays as bright as it is. (Made one before they are shown, either eye would see what is too bright for the other.)
pub fn shown([left, right]: [DVec3; 2]) -> DVec3 {
    DVec3::new((*XYZ_FROM_RGB * left).y, right.y, right.z)
}

/// The same of light, cd/m².
pub fn anaglyph(left: &Negative, right: &Negative) -> Negative {
    let both = |(left, right): (&[f32; 3], &[f32; 3])| {
        let right = *RGB_FROM_XYZ * DVec3::from(right.map(f64::from));
        let rgb = DVec3::new(f64::from(left[1]), right.y, right.z).max(DVec3::ZERO);
        (*XYZ_FROM_RGB * rgb).as_vec3().to_array()
    };
    let xyz = left.xyz.iter().zip(&right.xyz).map(both).collect();
    Negative { width: left.width, height: left.height, xyz }
}
