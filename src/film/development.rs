//! From light to the numbers of a picture: which luminance is white, how brighter light is told apart, and what becomes of
//! colours that no screen has.

use super::Negative;
use crate::color::{RGB_FROM_XYZ, srgb_decode, srgb_encode};
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::sync::LazyLock;

/// How light becomes a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Development {
    /// The luminance of what is called white, cd/m².
    pub white: f64,
    /// How far above white light is still told apart, factors of two.
    pub headroom: f64,
    curve: Curve,
}

impl Development {
    /// For this white (cd/m²) and headroom (factors of two, at least 0).
    pub fn new(white: f64, headroom: f64) -> Self {
        Self { white, headroom, curve: Curve::new(headroom) }
    }

    /// sRGB bytes of a whole picture.
    pub fn develop(&self, negative: &Negative) -> Vec<u8> {
        encode(negative.xyz.len(), |pixel| self.shown(negative, pixel))
    }

    /// The same in 16 bits a channel; [`crate::output::eight_of`] each of them is what [`Self::develop`] gives.
    pub fn develop_finely(&self, negative: &Negative) -> Vec<u16> {
        encode_finely(negative.xyz.len(), |pixel| self.shown(negative, pixel))
    }

    /// [`Self::display`] of one pixel.
    pub fn shown(&self, negative: &Negative, pixel: usize) -> DVec3 {
        self.display(DVec3::from(negative.xyz[pixel].map(f64::from)))
    }

    /// Linear sRGB in 0 to 1. Each colour keeps its hue (of OKLab): what is too bright is compressed by its greatest channel
    /// and turns part of the way to white, and what no screen can show goes towards grey of the same luminance.
    pub fn display(&self, xyz: DVec3) -> DVec3 {
        let relative = xyz / self.white;
        if relative.y == f64::INFINITY {
            return DVec3::ONE; // Brighter than numbers go.
        }
        if !(relative.y > 0.0 && relative.is_finite()) {
            return DVec3::ZERO;
        }
        let rgb = shown(*RGB_FROM_XYZ * relative, relative.y);
        let peak = rgb.max_element();
        if peak <= self.curve.knee {
            return rgb;
        }
        let compressed = self.curve.at(peak);
        // The same hue whatever its brightness, since OKLab's a and b grow alike with it.
        let rgb = whitened(rgb / peak, white_share(libm::log2(peak / compressed)));
        (rgb * (compressed / rgb.max_element())).clamp(DVec3::ZERO, DVec3::ONE)
    }
}

/// sRGB bytes of so many pixels, given in linear sRGB, 0 to 1.
pub fn encode(pixels: usize, shown: impl Fn(usize) -> DVec3 + Sync) -> Vec<u8> {
    let steps = EncodingSteps::new();
    let encoded = |pixel| shown(pixel).to_array().map(|channel| steps.byte(channel));
    (0..pixels).into_par_iter().map(encoded).collect::<Vec<_>>().into_flattened()
}

/// The same in 16 bits.
pub fn encode_finely(pixels: usize, shown: impl Fn(usize) -> DVec3 + Sync) -> Vec<u16> {
    let steps = EncodingSteps::new();
    let encoded = |pixel| shown(pixel).to_array().map(|channel| steps.fine(channel));
    (0..pixels).into_par_iter().map(encoded).collect::<Vec<_>>().into_flattened()
}

/// What part of the way to white light goes that is compressed by so many factors of two: with white alone some brightness would
/// be seen, with none a lamp would look like paint. Half at 16, so that nothing loses its hue for good.
fn white_share(stops: f64) -> f64 {
    stops / (stops + 16.0)
}

/// What becomes of brightness: unchanged up to the knee, then by its logarithm, to 1 at the end of the headroom.
///
/// x -> k + a ln(1 + (x - k) / a), of slope 1 at the knee k; a is such that 2^headroom becomes 1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Curve {
    knee: f64,
    scale: f64,
}

impl Curve {
    fn new(headroom: f64) -> Self {
        // The more there is above the knee, the more of the screen it is given.
        let knee = 0.8 / (1.0 + headroom / 8.0);
        let above = libm::exp2(headroom) - knee;
        let (mut low, mut high) = (1e-6, 1e12);
        for _ in 0..100 {
            let scale = libm::sqrt(low * high);
            if scale * libm::log1p(above / scale) < 1.0 - knee { low = scale } else { high = scale }
        }
        Self { knee, scale: low }
    }

    fn at(&self, brightness: f64) -> f64 {
        (self.knee + self.scale * libm::log1p((brightness - self.knee) / self.scale)).min(1.0)
    }
}

/// Cone responses of linear sRGB by which `OKLab` is made: its a and b, and so its hue, are linear in their cube roots.
///
/// Source: B. Ottosson, "A perceptual color space for image processing", 2020.
static CONES_FROM_RGB: LazyLock<DMat3> = LazyLock::new(|| {
    DMat3::from_cols_array(&[
        0.412_221_470_8,
        0.211_903_498_2,
        0.088_302_461_9,
        0.536_332_536_3,
        0.680_699_545_1,
        0.281_718_837_6,
        0.051_445_992_9,
        0.107_396_956_6,
        0.629_978_700_5,
    ])
});
static RGB_FROM_CONES: LazyLock<DMat3> = LazyLock::new(|| CONES_FROM_RGB.inverse());

/// A straight line of `OKLab` from a grey to a colour: at all its places the hue is the same.
struct HueLine {
    grey: DVec3,
    away: DVec3,
}

impl HueLine {
    fn new(grey: f64, rgb: DVec3) -> Self {
        let roots = |rgb: DVec3| {
            let cones = *CONES_FROM_RGB * rgb;
            DVec3::new(libm::cbrt(cones.x), libm::cbrt(cones.y), libm::cbrt(cones.z))
        };
        let grey = roots(DVec3::splat(grey));
        Self { grey, away: roots(rgb) - grey }
    }

    /// Linear sRGB at this part of the way from grey.
    fn at(&self, part: f64) -> DVec3 {
        let root = self.grey + self.away * part;
        *RGB_FROM_CONES * (root * root * root)
    }
}

/// A colour without negative channels: itself, or of the same hue the most colourful on the way to the grey of its luminance.
fn shown(rgb: DVec3, luminance: f64) -> DVec3 {
    // Less than any file can hold is rounding.
    if rgb.min_element() >= -1e-6 * rgb.max_element() {
        return rgb.max(DVec3::ZERO);
    }
    let line = HueLine::new(luminance, rgb);
    let (mut within, mut outside) = (0.0, 1.0);
    for _ in 0..30 {
        let part = 0.5 * (within + outside);
        if line.at(part).min_element() >= 0.0 { within = part } else { outside = part }
    }
    line.at(within).max(DVec3::ZERO)
}

/// A colour of peak 1, moved by this share towards white.
fn whitened(rgb: DVec3, share: f64) -> DVec3 {
    HueLine::new(1.0, rgb).at(1.0 - share).max(DVec3::ZERO)
}

/// The linear values at which the sRGB byte changes: exact rounding without a power per pixel.
struct EncodingSteps {
    edges: [f64; 255],
    guess: Vec<u8>,
}

impl EncodingSteps {
    fn new() -> Self {
        let edges = std::array::from_fn(|i| srgb_decode((i as f64 + 0.5) / 255.0));
        let guess = (0..4096).map(|i| (srgb_encode(f64::from(i) / 4096.0) * 255.0 + 0.5) as u8).collect();
        Self { edges, guess }
    }

    fn byte(&self, linear: f64) -> u8 {
        let mut byte = self.guess[((linear * 4096.0) as usize).min(4095)];
        while byte < 255 && linear >= self.edges[usize::from(byte)] {
            byte += 1;
        }
        byte
    }

    /// In 65535 parts; whatever a power rounds to, it stays within those that round to the byte.
    fn fine(&self, linear: f64) -> u16 {
        let byte = 257 * i32::from(self.byte(linear));
        let value = (srgb_encode(linear) * 65535.0).round() as i32;
        value.clamp(byte - 128, byte + 128).clamp(0, 65535) as u16
    }
}
