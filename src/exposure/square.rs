//! Samples of a square of the picture, as large as a pixel, and what they give to the pixels around it.
//!
//! Filters are wider than a pixel. Where a pixel's samples follow from an error, its neighbours' serve it, too: each square has its
//! own, evenly spread, and each sample has a weight for all pixels whose filters reach it.

use super::{BRIGHTEST, phase};
use crate::film::{Reconstruction, scattered};
use crate::observer::View;
use crate::spectrum::Wavelengths;
use crate::trace::{Cone, Lit};
use glam::{DVec2, DVec3, Vec2Swizzles as _, Vec3};
use std::array::from_fn;
use std::sync::OnceLock;

/// Samples of a square that is looked at for the first time; the others double them.
pub(super) const FIRST: u32 = 4;
/// Most samples of a square.
pub(super) const MOST: u32 = 1024;
/// Footprints of textures are at most as wide as for so many samples: wider ones blur, which no sample tells. (Where glass parts colours
/// each sample follows as few as one of so many would: its neighbours have others.)
const SHARP: u32 = 64;

/// Something for each pixel that a square gives light to: row by row, itself in the middle.
pub(super) type Around<T> = [T; 9];

/// The part of a filter's weight that lies in each square around a pixel, and the mean of its square there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parts {
    pub(super) weight: Around<f64>,
    pub(super) squared: Around<f64>,
}

impl Parts {
    fn of(filter: Reconstruction) -> Self {
        const STEPS: u32 = 256;
        let mean = |of: &dyn Fn(f64) -> f64, away: f64| {
            let at = |step: u32| of(away + (f64::from(step) + 0.5) / f64::from(STEPS) - 0.5);
            (0..STEPS).map(at).sum::<f64>() / f64::from(STEPS)
        };
        let along = |of: &dyn Fn(f64) -> f64| [-1.0, 0.0, 1.0].map(|away| mean(of, away));
        let weight = along(&|place| filter.density(place));
        let squared = along(&|place| filter.density(place) * filter.density(place));
        let all: f64 = weight.iter().sum();
        Self {
            weight: from_fn(|i| weight[i / 3] * weight[i % 3] / (all * all)),
            squared: from_fn(|i| squared[i / 3] * squared[i % 3]),
        }
    }
}

/// Which of two sequences of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sequence {
    /// As they are scattered.
    Plain,
    /// With columns and rows exchanged and otherwise moved, to compare with.
    Turned,
}

/// A sample of a square.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// From the square's middle, pixels.
    offset: DVec2,
    /// What it counts for the pixels around.
    weights: Around<f64>,
}

/// Samples from one power of two to the next.
#[derive(Debug)]
struct Doubling {
    samples: Vec<Sample>,
    /// The digits by which their phases are moved.
    moved: u32,
}

impl Doubling {
    /// Up to so many samples, in a square at one place of squares of four by four.
    fn to(samples: u32, set: (u32, u32), of: &Measuring<'_>) -> Self {
        let Measuring { filter, parts, sequence, .. } = of;
        let turned = *sequence == Sequence::Turned;
        let sample = |number: u32| {
            let offset = if turned {
                scattered(number, ((set.1 + 2) % 4, (set.0 + 1) % 4)).yx()
            } else {
                scattered(number, set)
            };
            let weights = from_fn(|i| {
                let pixel = DVec2::new((i % 3) as f64 - 1.0, (i / 3) as f64 - 1.0);
                filter.density(offset.x - pixel.x) * filter.density(offset.y - pixel.y)
            });
            Sample { offset, weights }
        };
        let first = if samples == FIRST { 0 } else { samples / 2 };
        let mut samples: Vec<Sample> = (first..samples).map(sample).collect();
        // Weights that do not add up would make an even light uneven.
        let count = samples.len() as f64;
        let missing: Around<f64> = from_fn(|i| {
            let all: f64 = samples.iter().map(|sample: &Sample| sample.weights[i]).sum();
            if all > 0.0 { parts.weight[i] * count / all } else { 0.0 }
        });
        for sample in &mut samples {
            sample.weights = from_fn(|i| sample.weights[i] * missing[i]);
        }
        // Neighbours that share samples are to have other wavelengths where colours are parted.
        let moved = (4 * set.0 + set.1).wrapping_mul(0x9e37_79b9);
        Self { samples, moved: if turned { moved ^ 0xb504_f333 } else { moved } }
    }
}

/// A square as far as it is known.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Square {
    pub(super) samples: u32,
    pub(super) wavelengths: u32,
    /// All samples that were taken of it, also those of fewer wavelengths.
    pub(super) taken: u32,
    /// What it gives to the pixels around, XYZ.
    pub(super) given: Around<Vec3>,
    /// The mean of the first half of its samples, less that of all, XYZ.
    pub(super) halved: Vec3,
    /// Its mean by a rule of half as many wavelengths, less its mean, XYZ.
    pub(super) coarser: Vec3,
    // Sums over samples, XYZ.
    xyz: DVec3,
    squared: DVec3,
}

impl Square {
    /// The variance of its samples, XYZ.
    pub(super) fn variance(&self) -> DVec3 {
        let share = 1.0 / f64::from(self.samples);
        let mean = self.xyz * share;
        (self.squared * share - mean * mean).max(DVec3::ZERO)
    }
}

/// The rules over wavelengths that a square may need.
#[derive(Default)]
struct Rules {
    three: Wavelengths<3>,
    sixteen: Wavelengths<16>,
    more: Wavelengths<32>,
    most: Wavelengths<64>,
}

/// How squares are measured.
pub(super) struct Measuring<'a> {
    lit: &'a Lit<'a>,
    view: &'a View,
    filter: Reconstruction,
    sequence: Sequence,
    pub(super) parts: Parts,
    rules: Rules,
    // Of each place in squares of 4 by 4, by the logarithm of the number of samples.
    doublings: [[[OnceLock<Doubling>; 1 + MOST.ilog2() as usize]; 4]; 4],
}

impl<'a> Measuring<'a> {
    pub(super) fn new(lit: &'a Lit<'a>, view: &'a View, filter: Reconstruction, sequence: Sequence) -> Self {
        let (parts, rules) = (Parts::of(filter), Rules::default());
        Self { lit, view, filter, sequence, parts, rules, doublings: Default::default() }
    }

    /// The square around a place of the picture with so many samples and wavelengths, of which those before are not taken again.
    pub(super) fn square(
        &self,
        centre: DVec2,
        before: Option<&Square>,
        samples: u32,
        wavelengths: u32,
    ) -> Square {
        match wavelengths {
            3 => self.with(centre, before, samples, &self.rules.three),
            16 => self.with(centre, before, samples, &self.rules.sixteen),
            32 => self.with(centre, before, samples, &self.rules.more),
            _ => self.with(centre, before, samples, &self.rules.most),
        }
    }

    fn with<const N: usize>(
        &self,
        centre: DVec2,
        before: Option<&Square>,
        samples: u32,
        rule: &Wavelengths<N>,
    ) -> Square {
        let spacing = (1.0 / f64::from(samples.max(SHARP))).sqrt();
        let known = before.filter(|before| before.wavelengths == N as u32);
        let mut square = known.copied().unwrap_or(Square {
            wavelengths: N as u32,
            taken: before.map_or(0, |before| before.taken),
            ..Square::default()
        });
        while square.samples < samples {
            let first = square.samples;
            square.samples = FIRST.max(2 * first);
            let doubling = self.doubling(centre, square.samples);
            let (mut sums, mut half, mut coarser) = ([DVec3::ZERO; 9], square.xyz, DVec3::ZERO);
            for (number, sample) in doubling.samples.iter().enumerate() {
                if first == 0 && 2 * number == doubling.samples.len() {
                    half = square.xyz;
                }
                let place = centre + sample.offset;
                if !self.view.shows(place) {
                    continue;
                }
                let (ray, cone) = self.view.sight(place, spacing);
                let cone = Cone { phase: phase(first + number as u32, doubling.moved), ..cone };
                let light = self.lit.seen_within(&ray, cone, rule);
                let one = rule.xyz(&light.radiance) + light.lines;
                square.xyz += one;
                square.squared += one * one;
                coarser += rule.coarse_xyz(&light.radiance) + light.lines - one;
                for (sum, weight) in sums.iter_mut().zip(sample.weights) {
                    *sum += weight * one;
                }
            }
            let share = 1.0 / doubling.samples.len() as f64;
            let most = DVec3::splat(BRIGHTEST);
            let mean = |sum: DVec3, share: f64| (sum * share).clamp(-most, most).as_vec3();
            square.halved = mean(2.0 * half - square.xyz, 1.0 / f64::from(square.samples));
            // Whatever was known is the other half.
            let part = if first == 0 { 1.0 } else { 0.5 };
            let coarser = if N > 3 { mean(coarser, share) } else { Vec3::ZERO };
            square.coarser += part as f32 * (coarser - square.coarser);
            for (given, sum) in square.given.iter_mut().zip(sums) {
                *given += part as f32 * (mean(sum, share) - *given);
            }
        }
        square.taken += samples - known.map_or(0, |before| before.samples);
        square
    }

    fn doubling(&self, centre: DVec2, samples: u32) -> &Doubling {
        // The squares beside the picture are at -1.
        let place = |centre: f64| (centre + 1.0) as usize % 4;
        let (column, row) = (place(centre.x), place(centre.y));
        self.doublings[row][column][samples.ilog2() as usize]
            .get_or_init(|| Doubling::to(samples, (column as u32, row as u32), self))
    }
}
