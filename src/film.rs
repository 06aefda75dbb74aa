//! Samples of a pixel, and the way from light to the numbers of a picture.

mod development;

pub use development::{Development, encode, encode_finely};

use crate::color::RGB_FROM_XYZ;
use glam::{DVec2, DVec3};

/// How much light around a pixel's centre counts for it. The weights are carried by the density of samples, or, where neighbours share
/// them, by each.
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
    /// The weight of what is so far from the centre along one axis, a pixel: its integral is one.
    pub fn density(self, away: f64) -> f64 {
        match self {
            Self::Box => f64::from(away.abs() <= 0.5),
            Self::Tent => (1.0 - away.abs()).max(0.0),
            Self::Gaussian if away.abs() > 1.5 => 0.0,
            Self::Gaussian => {
                let all = libm::erf(3.0 * std::f64::consts::FRAC_1_SQRT_2);
                (2.0 / std::f64::consts::PI).sqrt() * libm::exp(-2.0 * away * away) / all
            }
        }
    }

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
}

/// Where the sample of this number lies in a pixel's square, from its middle, of a sequence that is spread evenly whichever power of two
/// it stops at. From the first to the fourth, and from each power of two to the next, the mean is the middle.
///
/// Sobol's first two dimensions (SIAM J. Numer. Anal. 13(5), 1976). In each of the four columns (and rows) of a square they are
/// moved, by turns to one and to the other side, alike for all pixels of one `place` in squares of 4 by 4: there the samples of
/// one column of pixels lie in all sixteen parts of a pixel's width, and what is thin does not slip through.
pub fn scattered(number: u32, place: (u32, u32)) -> DVec2 {
    let directions = std::iter::successors(Some(1_u32 << 31), |direction| Some(direction ^ (direction >> 1)));
    let chosen = directions.take(32).enumerate().filter(|(bit, _)| number >> bit & 1 == 1);
    let down = chosen.fold(0, |down, (_, direction)| down ^ direction);
    let part = |digits: u32, (moved, other): (u32, u32)| {
        // Any digits that have nothing to do with one another.
        let finer = (4 * moved + other + 1).wrapping_mul(0x9e37_79b9) >> 4;
        let moved = [0, 2, 3, 1][moved as usize % 4] << 28 | finer;
        let moved = if digits >> 30 & 1 == 1 { !moved } else { moved };
        (f64::from(digits ^ (moved & 0x3fff_ffff)) + 0.5) / 4_294_967_296.0 - 0.5
    };
    let (column, row) = place;
    DVec2::new(part(number.reverse_bits(), (row, column)), part(down, (column, row)))
}

/// An exposed picture before anything is done to it: XYZ in cd/m², row by row from the top.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Negative {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` values.
    pub xyz: Vec<[f32; 3]>,
}

/// How bright a film is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brightness {
    /// The luminance that should become white, cd/m²: 85 in 100 of the lit pixels lie below 60 % of it.
    pub white: f64,
    /// How bright the brightest are, cd/m² of the screen's greatest channel: 999 in 1000 of the lit pixels are less so.
    pub brightest: f64,
}

impl Brightness {
    /// Of these pixels (XYZ, cd/m²); none if nothing is lit.
    ///
    /// By quantiles, because a film at 0.9 c holds brightnesses from 1e-5 to 1e5 that no mean should follow.
    pub fn of(pixels: impl IntoIterator<Item = [f32; 3]>) -> Option<Self> {
        let pixels = pixels.into_iter().map(|xyz| DVec3::from(xyz.map(f64::from)));
        let lit: Vec<DVec3> = pixels.filter(|xyz| xyz.y > 0.0 && xyz.is_finite()).collect();
        let quantile = |of: &dyn Fn(&DVec3) -> f64, thousandths: usize| {
            let mut values: Vec<f64> = lit.iter().map(of).collect();
            let place = values.len() * thousandths / 1000;
            *values.select_nth_unstable_by(place, f64::total_cmp).1
        };
        (!lit.is_empty()).then(|| Self {
            white: quantile(&|xyz| xyz.y, 850) / 0.6,
            brightest: quantile(&|xyz| (*RGB_FROM_XYZ * *xyz).max_element(), 999),
        })
    }

    /// The headroom above this white that the brightest need.
    pub fn headroom(&self, white: f64) -> f64 {
        libm::log2(self.brightest / white).clamp(LEAST_HEADROOM, MOST_HEADROOM)
    }
}

/// Headroom where the film says it: at least so much that highlights end softly, at most what a searchlight at γ = 50 needs.
const LEAST_HEADROOM: f64 = 1.0;
const MOST_HEADROOM: f64 = 24.0;
