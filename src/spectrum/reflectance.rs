//! Reflectances: what part of the light a surface throws back, at any wavelength.

use super::table::add;
use super::{Table, rows};
use crate::simd::whole_and_part;
use std::sync::LazyLock;

/// The part of the light thrown back, by wavelength in the surface's own rest frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Reflectance {
    /// The same at all wavelengths.
    Constant(f64),
    /// From a colour in linear sRGB, each channel 0 to 1: `r R(λ) + g G(λ) + b B(λ)`.
    ///
    /// The three curves are the smoothest that add up to 1 and that have the colours of the sRGB primaries under
    /// D65. Being linear it commutes with texture filters, and white is exactly 1. Beyond 380 to 780 nm, where
    /// a colour says nothing, the reflectance is the mean of the three channels.
    /// Source: Mallett and Yuksel, EGSR 2019 (curves solved anew, with their ends set to 1/3).
    Rgb([f64; 3]),
    /// The same, with something else said of what no eye sees.
    Extended {
        /// Linear sRGB.
        rgb: [f64; 3],
        /// Below 400 and above 700 nm.
        beyond: Beyond,
    },
    /// Measured; its ends go on.
    Table(Table),
}

/// What a colour means at one end of the visible wavelengths and beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// The mean of the three channels: what is seen in that light is a grey picture, on the average as bright.
    Mean,
    /// As at the end of what is seen.
    Hold,
    /// Known to be this.
    Value(f64),
}

/// What a colour means in the ultraviolet and in the infrared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beyond {
    /// Below 400 nm, fully from 360 nm.
    pub ultraviolet: End,
    /// Above 700 nm, fully from 740 nm.
    pub infrared: End,
}

impl Beyond {
    /// The mean at both ends, which is what the primaries' curves do by themselves.
    pub const MEAN: Self = Self { ultraviolet: End::Mean, infrared: End::Mean };
}

/// Where a colour says something, nm, and over how much it goes over to what is said beyond.
const SAID_NM: (f64, f64) = (400.0, 700.0);
const OVER_NM: f64 = 40.0;

/// First wavelength of the primaries' curves, nm, and the step between their rows.
const FIRST_NM: f64 = 380.0;
const STEP_NM: f64 = 5.0;
const LAST_ROW: f64 = 80.0;
/// A power of two.
const ROWS: usize = 128;

/// The three curves row by row, and their steps to the next row.
struct Primaries([([f64; 3], [f64; 3]); ROWS]);

static PRIMARIES: LazyLock<Primaries> = LazyLock::new(|| {
    let rows = rows::<4>(include_str!("primaries.csv"));
    let row = |i: usize| rows[i.min(LAST_ROW as usize)];
    let step = |i: usize, curve: usize| row(i + 1)[curve] - row(i)[curve];
    Primaries(std::array::from_fn(|i| {
        let [_, r, g, b] = row(i);
        ([r, g, b], [step(i, 1), step(i, 2), step(i, 3)])
    }))
});

/// How far a spectrum is from daylight, or a reflectance from grey.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tone {
    /// Daylight; or the same part of every wavelength.
    Grey,
    /// Daylight through one colour in sRGB; or such a colour.
    Color,
    /// Anything else.
    Spectrum,
}

impl Tone {
    /// One after the other: two colours are no colour, since their spectra multiply.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        if self == Self::Color && other == Self::Color { Self::Spectrum } else { self.max(other) }
    }
}

impl Reflectance {
    /// How far it is from grey where light is seen.
    pub fn tone(&self) -> Tone {
        match self {
            Self::Constant(_) => Tone::Grey,
            Self::Rgb([r, g, b]) | Self::Extended { rgb: [r, g, b], .. } if r == g && g == b => Tone::Grey,
            Self::Rgb(_) | Self::Extended { .. } => Tone::Color,
            Self::Table(_) => Tone::Spectrum,
        }
    }

    /// At one wavelength, nm in the surface's rest frame.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Rgb(rgb) => rgb_at(&PRIMARIES, *rgb, wavelength_nm),
            Self::Extended { rgb, beyond } => extended(*rgb, *beyond, wavelength_nm),
            Self::Table(table) => table.at(wavelength_nm),
        }
    }

    /// At many wavelengths at once.
    #[inline]
    pub fn at_each<const N: usize>(&self, wavelengths_nm: &[f64; N]) -> [f64; N] {
        match self {
            Self::Constant(value) => [*value; N],
            Self::Rgb(rgb) => {
                let primaries = &*PRIMARIES;
                let mut values = [0.0; N];
                add(&mut values, wavelengths_nm, 1.0, |nm| rgb_at(primaries, *rgb, nm));
                values
            }
            Self::Extended { rgb, beyond } => wavelengths_nm.map(|nm| extended(*rgb, *beyond, nm)),
            Self::Table(table) => wavelengths_nm.map(|nm| table.at(nm)),
        }
    }
}

fn extended(rgb: [f64; 3], beyond: Beyond, wavelength_nm: f64) -> f64 {
    let held = wavelength_nm.clamp(SAID_NM.0, SAID_NM.1);
    let end = if wavelength_nm < SAID_NM.0 { beyond.ultraviolet } else { beyond.infrared };
    let over = ((wavelength_nm - held).abs() / OVER_NM).min(1.0);
    let at = |nm: f64| rgb_at(&PRIMARIES, rgb, nm);
    match end {
        _ if over == 0.0 => at(wavelength_nm),
        End::Mean => at(wavelength_nm),
        End::Hold => at(held),
        End::Value(value) => at(held) + (value - at(held)) * over,
    }
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "the inside of the loop over wavelengths")]
fn rgb_at(primaries: &Primaries, rgb: [f64; 3], wavelength_nm: f64) -> f64 {
    let place = ((wavelength_nm - FIRST_NM) * (1.0 / STEP_NM)).clamp(0.0, LAST_ROW);
    let (row, part) = whole_and_part(place);
    let (start, step) = &primaries.0[row % ROWS];
    let curve = |j: usize| start[j] + part * step[j];
    rgb[0] * curve(0) + rgb[1] * curve(1) + rgb[2] * curve(2)
}
