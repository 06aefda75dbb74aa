//! A picture asked for by its error: each pixel gets the samples and the wavelengths that it needs.
//!
//! How far its samples lie apart tells how far a pixel is settled, and a second rule over its wavelengths tells whether they are
//! enough. What is not settled is measured again, as finely as follows from that. Every pixel decides by itself and by what its
//! neighbours were in the pass before, so the picture is the same on any number of threads.

use super::{BRIGHTEST, Sampling, by_pixel_until, phase};
use crate::color::{Discrimination, Lab};
use crate::film::{Development, Negative};
use crate::observer::View;
use crate::spectrum::Wavelengths;
use crate::stop::Stop;
use crate::trace::{Cone, Lit};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Samples of the first pass; the others double them.
const FIRST: u32 = 4;
/// Most samples of a pixel.
const MOST: u32 = 1024;
/// A pass has at most so many times the samples of the one before: the fewer there are, the less they say how many it takes.
const GROWTH: f64 = 4.0;
/// Footprints of textures are at most as wide as for so many samples: wider ones blur, which no sample tells.
const SHARP: u32 = 16;
/// How far the mean of n samples is off at an edge, at least, in parts of `σ n^-3/4`. (Of random samples it would be `σ n^-1/2`.)
const SPREAD: f64 = 0.8;
/// The same in parts of the difference between the means of two halves of the samples.
const HALVES: f64 = 0.6;
/// So many columns and rows away what is met matters to a pixel that has been looked at but once.
const REACH: usize = 2;
/// The part of a neighbour's spread that is a pixel's own, once it has been looked at again.
const DOUBT: f64 = 0.5;
/// What multiplies all estimates, so that they hold for 99 pixels of 100 of every committed manifest.
const SAFETY: f64 = 1.7;
/// The error of a rule over wavelengths, in parts of its difference from that with half of them.
const RULES: f64 = 0.2;
/// The part of the tolerance that may go to the wavelengths.
const RESOLVED: f64 = 0.4;

/// A picture that is settled, and how far.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Settled {
    /// The picture.
    pub negative: Negative,
    /// Its estimated error.
    pub error: Uncertainty,
    /// Samples taken, for each pixel in the mean.
    pub samples: f64,
}

/// How far a picture may be from the converged one, in CIEDE2000 as it is shown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
    sums: Sums,
    // The standard deviation of its samples, XYZ.
    spread: DVec3,
    // How different the two halves of its samples look.
    halves: f64,
    wavelengths: u32,
    // All samples that were taken of it, also those of fewer wavelengths.
    taken: u32,
    // What its samples may be off: as they say themselves, and as their neighbours' make it doubtful.
    own: f64,
    unsettled: f64,
    // What its wavelengths may be off.
    unresolved: f64,
}

impl Pixel {
    fn error(&self) -> f64 {
        self.unsettled + self.unresolved
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

    /// How many samples and wavelengths it is to have next; none if it needs nothing more.
    fn more(&self, error: f64) -> Option<(u32, u32)> {
        let for_wavelengths = RESOLVED * error;
        let room = error - self.unresolved.min(for_wavelengths);
        let times = libm::pow((self.unsettled / room).max(1.0), 4.0 / 3.0).min(GROWTH);
        // After the first pass rather too few: then it is looked at again, and what is too much is never given back.
        let doublings = match libm::log2(times) {
            none if none <= 0.0 => 0,
            some if self.sums.samples == FIRST => some.ceil() as u32,
            some => (some as u32).max(1),
        };
        let samples = (self.sums.samples << doublings).min(MOST);
        let wavelengths = self.wavelengths_for(for_wavelengths);
        let better = samples > self.sums.samples || wavelengths > self.wavelengths;
        (self.error() > error && better).then_some((samples, wavelengths))
    }
}

/// Sums over samples, XYZ.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    xyz: DVec3,
    squared: DVec3,
    // Of the first half of the samples; both halves are evenly spread.
    half: DVec3,
    // By a rule of half as many wavelengths.
    coarse: DVec3,
    samples: u32,
}

impl Sums {
    fn mean(&self) -> DVec3 {
        self.xyz / f64::from(self.samples)
    }

    /// The standard deviation of the samples.
    fn spread(&self) -> DVec3 {
        let (mean, share) = (self.mean(), 1.0 / f64::from(self.samples));
        let variance = (self.squared * share - mean * mean).max(DVec3::ZERO);
        DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt())
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
    let tolerance = (tolerance, &Stop::never());
    expose_settled_until(lit, view, sampling, development, tolerance).unwrap_or_default()
}

/// The same; none if it was stopped.
pub fn expose_settled_until(
    lit: &Lit<'_>,
    view: &View,
    sampling: &Sampling,
    development: &Development,
    (tolerance, stop): (f64, &Stop),
) -> Option<Settled> {
    let lit = &lit.seen_from(view.tetrad.event);
    let measuring = Measuring::new(lit, view, sampling, development);
    let wavelengths = if sampling.wavelengths == 3 { 3 } else { 16 };
    let first = |column, row| measuring.pixel((column, row), None, FIRST, wavelengths);
    let mut pixels = by_pixel_until((sampling.width, sampling.height), stop, first, |_, _| {})?;
    let mut looked_at: Vec<usize> = (0..pixels.len()).collect();
    loop {
        let unsettled = |number: &usize| measuring.unsettled(&pixels, *number);
        let unsettled: Vec<f64> = looked_at.par_iter().map(unsettled).collect();
        for (number, unsettled) in looked_at.iter().zip(unsettled) {
            pixels[*number].unsettled = unsettled;
        }
        let more = |number: usize| Some((number, pixels[number].more(tolerance / SAFETY)?));
        let open: Vec<(usize, (u32, u32))> = looked_at.into_iter().filter_map(more).collect();
        if open.is_empty() {
            break;
        }
        let finer = |(number, (samples, wavelengths)): &(usize, (u32, u32))| {
            let place = measuring.place(*number);
            (!stop.is_set()).then(|| measuring.pixel(place, Some(&pixels[*number]), *samples, *wavelengths))
        };
        let finer: Vec<Pixel> = open.par_iter().map(finer).collect::<Option<_>>()?;
        // What they have met may be near to others, too.
        let mut near = vec![false; pixels.len()];
        for ((number, _), pixel) in open.iter().zip(finer) {
            pixels[*number] = pixel;
            measuring.around(*number, REACH).for_each(|number| near[number] = true);
        }
        looked_at = (0..pixels.len()).filter(|number| near[*number]).collect();
    }
    let taken: f64 = pixels.iter().map(|pixel| f64::from(pixel.taken)).sum();
    Some(Settled {
        error: Uncertainty::of(pixels.iter().map(|pixel| SAFETY * (pixel.own + pixel.unresolved)).collect()),
        samples: taken / pixels.len().max(1) as f64,
        negative: Negative {
            width: sampling.width,
            height: sampling.height,
            xyz: pixels
                .iter()
                .map(|pixel| pixel.sums.mean().min(DVec3::splat(BRIGHTEST)).as_vec3().to_array())
                .collect(),
        },
    })
}

/// The rules over wavelengths that a pixel may need.
#[derive(Default)]
struct Rules {
    three: Wavelengths<3>,
    sixteen: Wavelengths<16>,
    more: Wavelengths<32>,
    most: Wavelengths<64>,
}

/// How pixels are measured.
struct Measuring<'a> {
    lit: &'a Lit<'a>,
    view: &'a View,
    sampling: &'a Sampling,
    development: &'a Development,
    rules: Rules,
    // Of each place in squares of 4 by 4 pixels, by the logarithm of the number of samples: the later half of that many.
    offsets: [[[OnceLock<Vec<DVec2>>; 1 + MOST.ilog2() as usize]; 4]; 4],
}

impl<'a> Measuring<'a> {
    fn new(lit: &'a Lit<'a>, view: &'a View, sampling: &'a Sampling, development: &'a Development) -> Self {
        Self { lit, view, sampling, development, rules: Rules::default(), offsets: Default::default() }
    }

    /// A pixel with so many samples and wavelengths, of which those before are not taken again.
    fn pixel(&self, place: (usize, usize), before: Option<&Pixel>, samples: u32, wavelengths: u32) -> Pixel {
        match wavelengths {
            3 => self.with(place, before, samples, &self.rules.three),
            16 => self.with(place, before, samples, &self.rules.sixteen),
            32 => self.with(place, before, samples, &self.rules.more),
            _ => self.with(place, before, samples, &self.rules.most),
        }
    }

    fn with<const N: usize>(
        &self,
        (column, row): (usize, usize),
        before: Option<&Pixel>,
        samples: u32,
        rule: &Wavelengths<N>,
    ) -> Pixel {
        let (view, centre) = self.view.of_pixel(DVec2::new(column as f64 + 0.5, row as f64 + 0.5));
        let set = (column % 4, row % 4);
        let spacing = (1.0 / f64::from(samples.max(SHARP))).sqrt();
        let known = before.filter(|before| before.wavelengths == N as u32);
        let mut sums = known.map_or_else(Sums::default, |before| before.sums);
        let taken = before.map_or(0, |before| before.taken) + samples - sums.samples;
        while sums.samples < samples {
            let numbers = sums.samples..FIRST.max(2 * sums.samples);
            for (number, offset) in numbers.clone().zip(self.offsets(set, numbers.end)) {
                if number == numbers.end / 2 {
                    sums.half = sums.xyz;
                }
                let place = centre + *offset;
                if !view.shows(place) {
                    continue;
                }
                let (ray, cone) = view.sight(place, spacing);
                let light = self.lit.seen_within(&ray, Cone { phase: phase(number), ..cone }, rule);
                let one = rule.xyz(&light.radiance) + light.lines;
                sums.xyz += one;
                sums.squared += one * one;
                sums.coarse += rule.coarse_xyz(&light.radiance) + light.lines;
            }
            sums.samples = numbers.end;
        }
        let (xyz, share) = (sums.mean(), 1.0 / f64::from(samples));
        let seen = Discrimination::around(self.lab(xyz));
        let spread = sums.spread();
        let (mut halves, mut own) = (0.0, 0.0);
        if spread != DVec3::ZERO {
            halves = 2.0 * seen.distance(self.lab(sums.half * (2.0 * share)));
            own = (HALVES * halves).max(self.swing(&seen, xyz, spread, samples));
        }
        let unresolved = if N > 3 { RULES * seen.distance(self.lab(sums.coarse * share)) } else { 0.0 };
        Pixel { sums, spread, halves, wavelengths: N as u32, taken, own, unsettled: own, unresolved }
    }

    /// Where the later half of so many samples lie.
    fn offsets(&self, set: (usize, usize), samples: u32) -> &[DVec2] {
        self.offsets[set.1][set.0][samples.ilog2() as usize].get_or_init(|| {
            let first = if samples == FIRST { 0 } else { samples / 2 };
            let of = |number| self.sampling.reconstruction.scattered(number, (set.0 as u32, set.1 as u32));
            (first..samples).map(of).collect()
        })
    }

    fn place(&self, number: usize) -> (usize, usize) {
        let width = self.sampling.width as usize;
        (number % width, number / width)
    }

    /// The numbers of the pixels up to so many columns and rows away.
    fn around(&self, number: usize, reach: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.sampling.width as usize, self.sampling.height as usize);
        let (column, row) = self.place(number);
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(width);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(height);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    fn lab(&self, xyz: DVec3) -> Lab {
        Lab::of_rgb(self.development.display(xyz))
    }

    /// How far a pixel may be from settled: by the halves of its samples and of its neighbours', and by how far its samples lie apart,
    /// or those of pixels near it. (A few samples may all miss an edge; and beside something very bright a little of it counts.)
    fn unsettled(&self, pixels: &[Pixel], number: usize) -> f64 {
        let own = &pixels[number];
        let (reach, part) = if own.sums.samples == FIRST { (REACH, 1.0) } else { (1, DOUBT) };
        let neighbours = self.around(number, reach).map(|number| pixels[number].spread * part);
        let spread = neighbours.fold(own.spread, DVec3::max);
        if spread == DVec3::ZERO {
            return 0.0;
        }
        let (mut squared, mut count) = (0.0, 0.0);
        for number in self.around(number, 1) {
            let pixel = &pixels[number];
            let samples = f64::from(pixel.sums.samples) / f64::from(own.sums.samples);
            squared += pixel.halves * pixel.halves * samples * samples.sqrt();
            count += 1.0;
        }
        let unsettled = own.own.max(HALVES * f64::sqrt(squared / count));
        if spread == own.spread {
            return unsettled;
        }
        let xyz = own.sums.mean();
        unsettled.max(self.swing(&Discrimination::around(self.lab(xyz)), xyz, spread, own.sums.samples))
    }

    /// How different a pixel looks by what the mean of so many samples with a spread (XYZ) may be off.
    fn swing(&self, seen: &Discrimination, xyz: DVec3, spread: DVec3, samples: u32) -> f64 {
        let share = 1.0 / f64::from(samples);
        let off = spread * (SPREAD * (share * share.sqrt()).sqrt());
        let to = |xyz: DVec3| seen.distance(self.lab(xyz));
        to(xyz + off).max(to((xyz - off).max(DVec3::ZERO)))
    }
}
