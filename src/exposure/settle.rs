//! A picture asked for by its error: each pixel gets the samples and the wavelengths that it needs.
//!
//! How far its samples lie apart tells how far a pixel is settled, and a second rule over its wavelengths tells whether they are
//! enough. What is not settled is measured again, as finely as follows from that. Every pixel decides by itself and by what its
//! neighbours were in the pass before, so the picture is the same on any number of threads.

use super::{BRIGHTEST, Sampling, by_pixel, phases};
use crate::color::{Lab, ciede2000};
use crate::film::{Development, Negative};
use crate::observer::View;
use crate::spectrum::Wavelengths;
use crate::trace::{Cone, Lit};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Samples of the first pass, and of the second where the first leaves doubts.
const FIRST: u32 = 4;
const SECOND: u32 = 16;
/// How samples are moved within the share of the pixel that each stands for, in parts of it.
const MOVES: [(f64, f64); 4] = [(-0.375, 0.125), (0.125, 0.375), (0.375, -0.125), (-0.125, -0.375)];
/// Most samples of a pixel.
const MOST: u32 = 1024;
/// The error of the mean of n samples is about `SPREAD σ n^-3/4` where an edge crosses the pixel and they are spread evenly.
/// (Of random samples it would be `σ n^-1/2`.)
const SPREAD: f64 = 1.6;
/// The same in parts of the difference between the means of two halves of the samples.
const HALVES: f64 = 0.6;
/// The part of a neighbour's doubts that is a pixel's own.
const DOUBT: f64 = 0.5;
/// What multiplies all estimates, so that they hold for 99 pixels of 100 of every committed manifest.
const SAFETY: f64 = 1.6;
/// The error of a rule over wavelengths, in parts of its difference from that with half of them.
const RULES: f64 = 0.25;
/// The part of the tolerance that may go to the wavelengths.
const RESOLVED: f64 = 0.4;

/// A picture that is settled, and how far.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// The picture.
    pub negative: Negative,
    /// Its estimated error.
    pub error: Uncertainty,
    /// Samples taken, for each pixel in the mean.
    pub samples: f64,
}

/// How far a picture may be from the converged one, in CIEDE2000 as it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertainty {
    /// In the mean.
    pub mean: f64,
    /// Of 99 pixels in 100, at most.
    pub p99: f64,
}

impl Uncertainty {
    /// Of the errors of all pixels.
    pub fn of(mut errors: Vec<f64>) -> Self {
        if errors.is_empty() {
            return Self { mean: 0.0, p99: 0.0 };
        }
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let place = (errors.len() * 99).div_ceil(100).min(errors.len()) - 1;
        Self { mean, p99: *errors.select_nth_unstable_by(place, f64::total_cmp).1 }
    }
}

/// A pixel as far as it is known.
#[derive(Debug, Clone, Copy)]
struct Pixel {
    // By the last pass: with those before it, which were coarser, it would be worse.
    xyz: DVec3,
    // Standard deviation of all its samples, XYZ, and their mean.
    spread: DVec3,
    mean: DVec3,
    // Estimated errors by the samples and by the wavelengths.
    unsettled: f64,
    unresolved: f64,
    // Those of the last pass.
    samples: u32,
    wavelengths: u32,
    // All samples that were taken of it.
    taken: u32,
}

impl Pixel {
    fn error(&self) -> f64 {
        SAFETY * (self.unsettled + self.unresolved)
    }

    /// Measured again: no sample is forgotten, so that what few of them met still counts.
    fn again(&self, before: &Self, development: &Development) -> Self {
        let taken = before.taken + self.taken;
        let part = f64::from(self.taken) / f64::from(taken);
        let mean = before.mean.lerp(self.mean, part);
        let squares = |of: &Self| of.spread * of.spread + of.mean * of.mean;
        let variance = (squares(before).lerp(squares(self), part) - mean * mean).max(DVec3::ZERO);
        let spread = DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt());
        let unsettled = self.unsettled.max(swing(development, self.xyz, spread, self.samples));
        Self { spread, mean, unsettled, taken, ..*self }
    }

    /// As many wavelengths as it needs: the error of a rule falls with the square of their number.
    fn wavelengths_for(&self, error: f64) -> u32 {
        let (mut wavelengths, mut unresolved) = (self.wavelengths, self.unresolved);
        while unresolved > error && wavelengths < 64 && wavelengths > 3 {
            wavelengths *= 2;
            unresolved *= 0.25;
        }
        wavelengths
    }

    /// How many samples it needs if it is so far from settled; none if it needs nothing more.
    fn more(&self, unsettled: f64, tolerance: f64) -> Option<u32> {
        let room = tolerance - self.unresolved.min(RESOLVED * tolerance);
        let times = libm::pow((unsettled / room).max(1.0), 4.0 / 3.0);
        let samples = ((f64::from(self.samples) * times).min(f64::from(MOST)) as u32).next_power_of_two();
        let wavelengths = self.wavelengths_for(RESOLVED * tolerance);
        let better = samples > self.samples || wavelengths > self.wavelengths;
        (unsettled + self.unresolved > tolerance && better).then_some(samples)
    }
}

/// Exposes a picture until 99 of 100 pixels are within `tolerance` (CIEDE2000) of the converged one, as `development` shows
/// it. Of `sampling` only the size, the filter, and three wavelengths (where they are enough) count.
pub fn expose_settled(
    lit: &Lit<'_>,
    view: &View,
    sampling: &Sampling,
    development: &Development,
    tolerance: f64,
) -> Settled {
    let lit = &lit.seen_from(view.tetrad.event);
    let size = (sampling.width as usize, sampling.height as usize);
    let rules = Rules::default();
    let passes: Vec<OnceLock<Pass<'_>>> = (0..4 * (1 + MOST.ilog2())).map(|_| OnceLock::new()).collect();
    let pass = |samples: u32, variant: usize| Pass {
        lit,
        view,
        development,
        rules: &rules,
        offsets: sampling.reconstruction.offsets_moved(samples, MOVES[variant]),
        phases: phases(samples),
    };
    let measured = |number: usize, samples: u32, wavelengths: u32| {
        let (column, row) = (number % size.0, number / size.0);
        // Neighbours have different ones: what is thinner than a pixel then slips through few pixels, not through a row of them.
        let variant = (column + 3 * row + column / 4 + row / 4) % 4;
        let pass = passes[4 * samples.ilog2() as usize + variant].get_or_init(|| pass(samples, variant));
        pass.measured((column, row), wavelengths)
    };
    let tolerance = tolerance / SAFETY;
    let wavelengths = if sampling.wavelengths == 3 { 3 } else { 16 };
    let mut pixels =
        by_pixel(sampling.width, sampling.height, |c, r| measured(r * size.0 + c, FIRST, wavelengths));
    let mut open: Vec<(usize, u32)> = (0..pixels.len())
        .into_par_iter()
        .filter(|number| {
            doubts(&pixels, size, *number, (2, 1.0), development) + pixels[*number].unresolved > tolerance
        })
        .map(|number| (number, SECOND))
        .collect();
    while !open.is_empty() {
        let again = |(number, samples): &(usize, u32)| {
            let before = &pixels[*number];
            let finer = measured(*number, *samples, before.wavelengths_for(RESOLVED * tolerance));
            finer.again(before, development)
        };
        let finer: Vec<Pixel> = open.par_iter().map(again).collect();
        for ((number, _), pixel) in open.iter().zip(finer) {
            pixels[*number] = pixel;
        }
        let more = |(number, _): (usize, u32)| {
            let pixel = &pixels[number];
            let samples = pixel.more(doubts(&pixels, size, number, (1, DOUBT), development), tolerance)?;
            Some((number, samples))
        };
        open = open.into_par_iter().filter_map(more).collect();
    }
    let taken: f64 = pixels.iter().map(|pixel| f64::from(pixel.taken)).sum();
    Settled {
        error: Uncertainty::of(pixels.iter().map(Pixel::error).collect()),
        samples: taken / pixels.len().max(1) as f64,
        negative: Negative {
            width: sampling.width,
            height: sampling.height,
            xyz: pixels
                .iter()
                .map(|pixel| pixel.xyz.min(DVec3::splat(BRIGHTEST)).as_vec3().to_array())
                .collect(),
        },
    }
}

/// How far a pixel may be from settled: by its own samples, or by a part of what those of its neighbours, up to `reach` pixels away, would do to it. (A few
/// samples may all miss an edge; and beside something very bright a little of it counts.)
fn doubts(
    pixels: &[Pixel],
    (width, height): (usize, usize),
    number: usize,
    (reach, part): (usize, f64),
    development: &Development,
) -> f64 {
    let (column, row) = (number % width, number / width);
    let rows = row.saturating_sub(reach)..(row + reach + 1).min(height);
    let columns = column.saturating_sub(reach)..(column + reach + 1).min(width);
    let around = rows.flat_map(|r| columns.clone().map(move |c| r * width + c));
    let own = &pixels[number];
    let spread = around.map(|i| pixels[i].spread).fold(DVec3::ZERO, DVec3::max);
    own.unsettled.max(swing(development, own.xyz, spread * part, own.samples))
}

/// How much a pixel changes, as it is shown, by what the mean of so many samples with a spread (XYZ) may be off.
fn swing(development: &Development, xyz: DVec3, spread: DVec3, samples: u32) -> f64 {
    if spread == DVec3::ZERO {
        return 0.0;
    }
    let share = 1.0 / f64::from(samples);
    let off = spread * (SPREAD * (share * share.sqrt()).sqrt());
    let lab = |xyz: DVec3| Lab::of_rgb(development.display(xyz));
    let whole = lab(xyz);
    let to = |xyz: DVec3| ciede2000(whole, lab(xyz));
    to(xyz + off).max(to((xyz - off).max(DVec3::ZERO)))
}

/// The rules over wavelengths that a pixel may need.
#[derive(Default)]
struct Rules {
    three: Wavelengths<3>,
    sixteen: Wavelengths<16>,
    more: Wavelengths<32>,
    most: Wavelengths<64>,
}

/// One measurement of pixels.
struct Pass<'a> {
    lit: &'a Lit<'a>,
    view: &'a View,
    development: &'a Development,
    rules: &'a Rules,
    offsets: Vec<DVec2>,
    phases: Vec<f64>,
}

impl Pass<'_> {
    fn measured(&self, place: (usize, usize), wavelengths: u32) -> Pixel {
        match wavelengths {
            3 => self.with(place, &self.rules.three),
            16 => self.with(place, &self.rules.sixteen),
            32 => self.with(place, &self.rules.more),
            _ => self.with(place, &self.rules.most),
        }
    }

    fn with<const N: usize>(&self, (column, row): (usize, usize), rule: &Wavelengths<N>) -> Pixel {
        let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        let share = 1.0 / self.offsets.len() as f64;
        let spacing = share.sqrt();
        let (mut radiance, mut lines) = ([0.0; N], DVec3::ZERO);
        let (mut xyz, mut squared) = (DVec3::ZERO, DVec3::ZERO);
        let mut odd = DVec3::ZERO;
        for (number, (offset, phase)) in self.offsets.iter().zip(&self.phases).enumerate() {
            let (ray, cone) = self.view.sight(centre + *offset, spacing);
            let light = self.lit.seen_within(&ray, Cone { phase: *phase, ..cone }, rule);
            for (sum, value) in radiance.iter_mut().zip(light.radiance) {
                *sum += value;
            }
            lines += light.lines;
            let one = rule.xyz(&light.radiance) + light.lines;
            xyz += one;
            squared += one * one;
            // By the parity of the bits of its number, which leaves both halves of the samples evenly spread.
            if number.count_ones() % 2 == 1 {
                odd += one;
            }
        }
        xyz *= share;
        let lab = |xyz: DVec3| Lab::of_rgb(self.development.display(xyz));
        let whole = lab(xyz);
        let variance = (squared * share - xyz * xyz).max(DVec3::ZERO);
        let spread = DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt());
        let samples = self.offsets.len() as u32;
        let unsettled = if spread == DVec3::ZERO {
            0.0
        } else {
            let half = odd * (2.0 * share);
            let halves = ciede2000(lab(half), lab(xyz * 2.0 - half));
            swing(self.development, xyz, spread, samples).max(HALVES * halves)
        };
        let unresolved = if N > 3 {
            let coarse = (rule.coarse_xyz(&radiance) + lines) * share;
            RULES * ciede2000(whole, lab(coarse))
        } else {
            0.0
        };
        let (mean, taken) = (xyz, samples);
        Pixel { xyz, spread, mean, unsettled, unresolved, samples, wavelengths: N as u32, taken }
    }
}
