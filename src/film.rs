//! Samples of a pixel, and the way from light to the numbers of a picture.

use crate::color::{RGB_FROM_XYZ, srgb_encode};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// How much light around a pixel's centre counts for it. The weights are carried by the density of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reconstruction {
    /// The pixel's own square.
    Box,
    /// A tent two pixels wide.
    Tent,
    /// A Gaussian of standard deviation half a pixel, cut at three of them.
    #[default]
    Gaussian,
}

impl Reconstruction {
    /// The offset below which the part `part` (0 to 1) of the filter's weight lies, pixels.
    fn quantile(self, part: f64) -> f64 {
        match self {
            Self::Box => part - 0.5,
            Self::Tent if part < 0.5 => (2.0 * part).sqrt() - 1.0,
            Self::Tent => 1.0 - (2.0 * (1.0 - part)).sqrt(),
            Self::Gaussian => {
                // Φ(3): the part of a Gaussian below three standard deviations.
                let below = |z: f64| 0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2);
                let (tail, all) = (below(-3.0), below(3.0) - below(-3.0));
                let (mut lo, mut hi) = (-3.0, 3.0);
                for _ in 0..60 {
                    let middle = 0.5 * (lo + hi);
                    if (below(middle) - tail) / all < part { lo = middle } else { hi = middle }
                }
                0.5 * (0.5 * (lo + hi))
            }
        }
    }

    /// Where a pixel's samples lie, as offsets from its centre; the same in every pixel, so that nothing flickers.
    ///
    /// A Hammersley set, spread by the filter, with its mean at the centre; one sample is the centre itself.
    pub fn offsets(self, samples: u32) -> Vec<DVec2> {
        let half = 0.5 / f64::from(samples);
        let point = |i: u32| {
            let radical_inverse = f64::from(i.reverse_bits()) / 4_294_967_296.0;
            let across = f64::from(i) / f64::from(samples) + half;
            DVec2::new(self.quantile(across), self.quantile((radical_inverse + half).min(1.0 - half)))
        };
        let mut offsets: Vec<DVec2> = (0..samples).map(point).collect();
        let mean = offsets.iter().sum::<DVec2>() / f64::from(samples);
        for offset in &mut offsets {
            *offset -= mean;
        }
        offsets
    }

    /// Where the sample of this number lies, of a sequence that is spread evenly whichever power of two it stops at. From the
    /// first to the fourth, and from each power of two to the next, the mean is the centre.
    ///
    /// Sobol's first two dimensions (SIAM J. Numer. Anal. 13(5), 1976). In each of the four columns (and rows) of a pixel they are
    /// moved, by turns to one and to the other side, alike for all pixels of one `place` in squares of 4 by 4: there the samples of
    /// one column of pixels lie in all sixteen parts of a pixel's width, and what is thin does not slip through.
    pub fn scattered(self, number: u32, place: (u32, u32)) -> DVec2 {
        let directions =
            std::iter::successors(Some(1_u32 << 31), |direction| Some(direction ^ (direction >> 1)));
        let chosen = directions.take(32).enumerate().filter(|(bit, _)| number >> bit & 1 == 1);
        let down = chosen.fold(0, |down, (_, direction)| down ^ direction);
        let part = |digits: u32, (moved, other): (u32, u32)| {
            // Any digits that have nothing to do with one another.
            let finer = (4 * moved + other + 1).wrapping_mul(0x9e37_79b9) >> 4;
            let moved = [0, 2, 3, 1][moved as usize % 4] << 28 | finer;
            let moved = if digits >> 30 & 1 == 1 { !moved } else { moved };
            (f64::from(digits ^ (moved & 0x3fff_ffff)) + 0.5) / 4_294_967_296.0
        };
        let (column, row) = place;
        DVec2::new(
            self.quantile(part(number.reverse_bits(), (row, column))),
            self.quantile(part(down, (column, row))),
        )
    }
}

/// An exposed picture before anything is done to it: XYZ in cd/m², row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Negative {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` values.
    pub xyz: Vec<[f32; 3]>,
}

/// How light becomes a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Development {
    /// The luminance that becomes full white, cd/m².
    pub white: f64,
}

/// Below this part of white nothing is changed; above, brightness approaches white.
const SHOULDER: f64 = 0.8;

impl Development {
    /// sRGB bytes of a whole picture.
    pub fn develop(&self, negative: &Negative) -> Vec<u8> {
        let steps = EncodingSteps::new();
        let developed = |xyz: &[f32; 3]| {
            let rgb = self.display(DVec3::from(xyz.map(f64::from)));
            rgb.to_array().map(|channel| steps.byte(channel))
        };
        let pixels: Vec<[u8; 3]> = negative.xyz.par_iter().map(developed).collect();
        pixels.into_flattened()
    }

    /// The same in 16 bits a channel; [`crate::output::eight_of`] each of them is what [`Self::develop`] gives.
    pub fn develop_finely(&self, negative: &Negative) -> Vec<u16> {
        let steps = EncodingSteps::new();
        let developed = |xyz: &[f32; 3]| {
            let rgb = self.display(DVec3::from(xyz.map(f64::from)));
            rgb.to_array().map(|channel| steps.fine(channel))
        };
        let pixels: Vec<[u16; 3]> = negative.xyz.par_iter().map(developed).collect();
        pixels.into_flattened()
    }

    /// Linear sRGB in 0 to 1: what is too bright rolls off at its own hue, and colours that no screen can show go
    /// towards grey of the same luminance.
    pub fn display(&self, xyz: DVec3) -> DVec3 {
        let relative = xyz / self.white;
        let y = relative.y;
        if y == f64::INFINITY {
            return DVec3::ONE; // Brighter than numbers go.
        }
        if !(y > 0.0 && relative.is_finite()) {
            return DVec3::ZERO;
        }
        let bright = if y <= SHOULDER {
            y
        } else {
            1.0 - (1.0 - SHOULDER) * libm::exp(-(y - SHOULDER) / (1.0 - SHOULDER))
        };
        let rgb = *RGB_FROM_XYZ * (relative * (bright / y));
        let grey = DVec3::splat(bright);
        let away = rgb - grey;
        let keep = (0..3).fold(1.0_f64, |keep, i| {
            let room = if away[i] > 0.0 { 1.0 - bright } else { -bright };
            if away[i].abs() > room.abs() { keep.min(room / away[i]) } else { keep }
        });
        (grey + away * keep).clamp(DVec3::ZERO, DVec3::ONE)
    }
}

/// The linear values at which the sRGB byte changes: exact rounding without a power per pixel.
struct EncodingSteps {
    edges: [f64; 255],
    guess: Vec<u8>,
}

impl EncodingSteps {
    fn new() -> Self {
        let edges = std::array::from_fn(|i| crate::color::srgb_decode((i as f64 + 0.5) / 255.0));
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

/// The luminance that should become white: 85 in 100 of the lit pixels then lie below 60 % of it.
///
/// A quantile, because a film at 0.9 c holds brightnesses from 1e-5 to 1e5 that no mean should follow. None if nothing
/// is lit.
pub fn meter(luminances: impl IntoIterator<Item = f64>) -> Option<f64> {
    let is_lit = |luminance: &f64| *luminance > 0.0 && luminance.is_finite();
    let mut lit: Vec<f64> = luminances.into_iter().filter(is_lit).collect();
    let place = lit.len() * 85 / 100;
    (!lit.is_empty()).then(|| *lit.select_nth_unstable_by(place, f64::total_cmp).1 / 0.6)
}
