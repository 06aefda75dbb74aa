//! A picture asked for by its error: each square gets the samples and the wavelengths that the pixels around it need.
//!
//! How far samples lie apart tells how far a pixel is settled, and a second rule over wavelengths tells whether they are
//! enough. The squares of what is not settled are measured again, as finely as follows from that: each as the neediest of its pixels
//! wants it, by what all were in the pass before, so the picture is the same on any number of threads.

use super::Sampling;
use super::shared::{Grid, beside, evenly, eyes};
use super::square::{Around, FIRST, MOST, Measuring, Sequence, Square};
use crate::color::{Discrimination, Lab};
use crate::film::{Development, Negative};
use crate::observer::View;
use crate::stop::Stop;
use crate::trace::Lit;
use glam::DVec3;
use rayon::prelude::*;
use std::array::from_fn;

/// A pass has at most so many times the samples of the one before: the fewer there are, the less they say how many it takes.
const GROWTH: u32 = 4;
/// How far the mean of n samples is off at an edge, at least, in parts of `σ n^-3/4`. (Of random samples it would be `σ n^-1/2`.)
const SPREAD: f64 = 0.6;
/// The same in parts of the difference between the means of two halves of the samples.
const HALVES: f64 = 0.6;
/// So many columns and rows away what is met matters to a square that has been looked at but once.
const REACH: usize = 2;
/// The part of a neighbour's spread that is a square's own, once it has been looked at again.
const DOUBT: f64 = 0.25;
/// What multiplies all estimates, so that they hold for 99 pixels of 100 of every committed manifest.
const SAFETY: f64 = 1.7;
/// The error of a rule over wavelengths, in parts of its difference from that with half of them.
const RULES: f64 = 0.2;
/// The part of the error by wavelengths that a square around a pixel may have without being looked at for that.
const NEGLIGIBLE: f64 = 0.05;
/// Of so many pixels it is kept at a time what they want, which takes memory.
const AT_ONCE: usize = 1 << 14;
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
    let wavelengths = if sampling.wavelengths == 3 { 3 } else { 16 };
    let (mut taken, mut errors, mut negatives) = (0, Vec::new(), Vec::new());
    for (view, grid) in eyes(view, sampling) {
        let lit = lit.seen_from(view.tetrad.event);
        let measuring = Measuring::new(&lit, &view, sampling.reconstruction, Sequence::Plain);
        let squares = evenly(&measuring, grid, FIRST, wavelengths, stop)?;
        let doubts = vec![DVec3::ZERO; squares.len()];
        let pixels = vec![Pixel::default(); squares.len()];
        let error = tolerance / SAFETY;
        let mut settling = Settling { measuring, development, grid, error, squares, doubts, pixels };
        settling.settle(stop)?;
        let Settling { squares, pixels, .. } = settling;
        let shown = (0..squares.len()).filter(|number| grid.shows(*number)).map(|number| pixels[number]);
        errors.extend(shown.map(|pixel| SAFETY * (pixel.own + pixel.unresolved)));
        taken += squares.iter().map(|square| u64::from(square.taken)).sum::<u64>();
        negatives.push(grid.negative(&squares));
    }
    let samples = taken as f64 / errors.len().max(1) as f64;
    Some(Settled { negative: beside(&negatives), error: Uncertainty::of(errors), samples })
}

/// How far a pixel is settled.
#[derive(Debug, Clone, Copy, Default)]
struct Pixel {
    // How different the two halves of its samples look.
    halves: f64,
    // What its samples may be off: as they say themselves, and as its neighbours' make it doubtful.
    own: f64,
    unsettled: f64,
    // What its wavelengths may be off.
    unresolved: f64,
}

/// A picture on the way.
struct Settling<'a> {
    measuring: Measuring<'a>,
    development: &'a Development,
    grid: Grid,
    // That is asked for.
    error: f64,
    squares: Vec<Square>,
    // The variances of squares, XYZ, as far as those around make them doubtful.
    doubts: Vec<DVec3>,
    pixels: Vec<Pixel>,
}

/// Samples and wavelengths that a square is to have.
type Finer = (u32, u32);

impl Settling<'_> {
    /// Measures what is not settled until all is, or has as much as anything may have; none if it was stopped.
    fn settle(&mut self, stop: &Stop) -> Option<()> {
        let mut near: Vec<usize> = (0..self.squares.len()).collect();
        loop {
            let wanted = self.look_at(&near);
            // What is met may be near to others, too, and to the squares that they are made of.
            let mut marked = vec![false; self.squares.len()];
            let open = wanted.iter().enumerate().filter(|(_, (samples, _))| *samples > 0);
            for (number, _) in open {
                self.grid.around(number, REACH + 1).for_each(|number| marked[number] = true);
            }
            near = (0..marked.len()).filter(|number| marked[*number]).collect();
            if near.is_empty() {
                return Some(());
            }
            let (measuring, grid) = (&self.measuring, self.grid);
            let finer = |((number, square), (samples, wavelengths)): ((usize, &mut Square), Finer)| {
                if samples > 0 {
                    *square = measuring.square(grid.middle(number), Some(square), samples, wavelengths);
                }
                (!stop.is_set()).then_some(())
            };
            self.squares.par_iter_mut().enumerate().zip(wanted).map(finer).collect::<Option<()>>()?;
        }
    }

    /// How far these pixels are settled, and what each square is to have for that; nothing if it has enough.
    fn look_at(&mut self, near: &[usize]) -> Vec<Finer> {
        let doubts: Vec<DVec3> = near.par_iter().map(|number| self.doubt(*number)).collect();
        for (number, doubt) in near.iter().zip(doubts) {
            self.doubts[*number] = doubt;
        }
        let shown: Vec<usize> = near.iter().copied().filter(|number| self.grid.shows(*number)).collect();
        let pixels: Vec<Pixel> = shown.par_iter().map(|number| self.pixel(*number)).collect();
        for (number, pixel) in shown.iter().zip(pixels) {
            self.pixels[*number] = pixel;
        }
        let unsettled: Vec<f64> = shown.par_iter().map(|number| self.unsettled(*number)).collect();
        for (number, unsettled) in shown.iter().zip(unsettled) {
            self.pixels[*number].unsettled = unsettled;
        }
        let mut most: Vec<Finer> = vec![(0, 0); self.squares.len()];
        for some in shown.chunks(AT_ONCE) {
            let wanted: Vec<_> = some.par_iter().flat_map_iter(|number| self.wanted(*number)).collect();
            for (number, (samples, wavelengths)) in wanted {
                let (more, finer) = &mut most[number];
                (*more, *finer) = (samples.max(*more), wavelengths.max(*finer));
            }
        }
        most
    }

    /// The variance of a square's samples, XYZ, or of those of squares near it. (A few samples may all miss an edge.)
    fn doubt(&self, number: usize) -> DVec3 {
        let own = &self.squares[number];
        let (reach, part) = if own.samples == FIRST { (REACH, 1.0) } else { (1, DOUBT * DOUBT) };
        let around = self.grid.around(number, reach).map(|number| self.squares[number].variance() * part);
        around.fold(own.variance(), DVec3::max)
    }

    fn pixel(&self, number: usize) -> Pixel {
        let xyz = self.grid.xyz(&self.squares, number);
        let seen = Discrimination::around(self.lab(xyz));
        let weight = &self.measuring.parts.weight;
        let off = self.off(number, |number| self.squares[number].variance());
        let (mut halves, mut own) = (0.0, 0.0);
        if off != DVec3::ZERO {
            let halved = |giver: usize, i: usize| self.squares[giver].halved.as_dvec3() * weight[i];
            halves = 2.0 * seen.distance(self.lab((xyz + self.grid.sum(number, halved)).max(DVec3::ZERO)));
            own = (HALVES * halves).max(self.swing(&seen, xyz, off));
        }
        let coarser = |giver: usize, i: usize| self.squares[giver].coarser.as_dvec3() * weight[i];
        let coarser = self.grid.sum(number, coarser);
        let unresolved =
            if coarser == DVec3::ZERO { 0.0 } else { RULES * seen.distance(self.lab(xyz + coarser)) };
        Pixel { halves, own, unsettled: own, unresolved }
    }

    /// How far a pixel's samples may be off, XYZ, if those of the squares around have such variances.
    fn off(&self, number: usize, of: impl Fn(usize) -> DVec3) -> DVec3 {
        let variance = self.grid.sum(number, |giver, i| self.part(giver, i, of(giver)));
        SPREAD * DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt())
    }

    /// What a square adds to the variance of a pixel that has it as its i-th.
    fn part(&self, giver: usize, i: usize, variance: DVec3) -> DVec3 {
        let share = 1.0 / f64::from(self.squares[giver].samples);
        variance * (self.measuring.parts.squared[i] * share * share.sqrt())
    }

    /// How far a pixel may be from settled: by the halves of its samples and of its neighbours', and by how far samples lie apart in
    /// the squares around, or in those near them.
    fn unsettled(&self, number: usize) -> f64 {
        let own = &self.pixels[number];
        let off = self.off(number, |number| self.doubts[number]);
        if off == DVec3::ZERO {
            return 0.0;
        }
        let (mut squared, mut count) = (0.0, 0.0);
        for near in self.grid.around(number, 1).filter(|near| self.grid.shows(*near)) {
            let pixel = &self.pixels[near];
            let samples = f64::from(self.squares[near].samples) / f64::from(self.squares[number].samples);
            squared += pixel.halves * pixel.halves * samples * samples.sqrt();
            count += 1.0;
        }
        let xyz = self.grid.xyz(&self.squares, number);
        let seen = Discrimination::around(self.lab(xyz));
        own.own.max(HALVES * f64::sqrt(squared / count)).max(self.swing(&seen, xyz, off))
    }

    /// How different a pixel looks that is off by so much (XYZ).
    fn swing(&self, seen: &Discrimination, xyz: DVec3, off: DVec3) -> f64 {
        let to = |xyz: DVec3| seen.distance(self.lab(xyz));
        to(xyz + off).max(to((xyz - off).max(DVec3::ZERO)))
    }

    fn lab(&self, xyz: DVec3) -> Lab {
        Lab::of_rgb(self.development.display(xyz))
    }

    /// The squares that are to have more for a pixel, with how many samples and wavelengths.
    fn wanted(&self, number: usize) -> Vec<(usize, Finer)> {
        let pixel = &self.pixels[number];
        if pixel.unsettled + pixel.unresolved <= self.error {
            return Vec::new();
        }
        let for_wavelengths = RESOLVED * self.error;
        let room = self.error - pixel.unresolved.min(for_wavelengths);
        let givers = self.grid.givers(number);
        let mut samples = givers.map(|giver| giver.map_or(0, |giver| self.squares[giver].samples));
        let mut parts: Around<f64> =
            from_fn(|i| givers[i].map_or(0.0, |giver| self.part(giver, i, self.doubts[giver]).element_sum()));
        let most = samples.map(|samples| (GROWTH * samples).min(MOST));
        // Always that which gains most by each sample more.
        let enough = parts.iter().sum::<f64>() * (room / pixel.unsettled).powi(2).min(1.0);
        while parts.iter().sum::<f64>() > enough {
            let gain = |i: usize| if samples[i] < most[i] { parts[i] / f64::from(samples[i]) } else { 0.0 };
            let best = (0..9).max_by(|one, other| gain(*one).total_cmp(&gain(*other))).unwrap_or(4);
            if gain(best) == 0.0 {
                break;
            }
            samples[best] *= 2;
            parts[best] *= 0.5 * std::f64::consts::FRAC_1_SQRT_2;
        }
        let wavelengths = self.wavelengths(number, &givers, for_wavelengths);
        let all = (0..9).filter_map(|i| Some((givers[i]?, (samples[i], wavelengths[i]))));
        let more = |(giver, (samples, wavelengths)): &(usize, Finer)| {
            *samples > self.squares[*giver].samples || *wavelengths > self.squares[*giver].wavelengths
        };
        all.filter(more).collect()
    }

    /// As many wavelengths as the squares around need: the error of a rule falls with the square of their number.
    fn wavelengths(&self, number: usize, givers: &Around<Option<usize>>, error: f64) -> Around<u32> {
        let now = givers.map(|giver| giver.map_or(0, |giver| self.squares[giver].wavelengths));
        let times = (self.pixels[number].unresolved / error).sqrt();
        if times <= 1.0 {
            return now;
        }
        let off = |i: usize| {
            givers[i].map_or(0.0, |giver| {
                self.squares[giver].coarser.as_dvec3().length() * self.measuring.parts.weight[i]
            })
        };
        let all: f64 = (0..9).map(off).sum();
        let times = if times > 2.0 { 4 } else { 2 };
        from_fn(|i| if off(i) > NEGLIGIBLE * all { (now[i] * times).min(64) } else { now[i] })
    }
}
