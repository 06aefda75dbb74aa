//! Where an index depends on the wavelength each wavelength goes its own way.
//!
//! The observer's wavelengths are followed one by one, as long as they hardly part. Where they do, each sample of a pixel follows others
//! between them, as many as it takes for neighbours to lie a third of a pixel apart (over the samples of the pixel), so that
//! colours change continuously across a picture and its samples tell how far it is settled. Spectral lines are followed at
//! their own wavelength, wherever between the samples that is.

use super::{Gathered, Light, Lit, Path, add_to_band};
use crate::color::{self, LUMENS_PER_WATT};
use crate::spacetime::FourVector;
use crate::spectrum::Line;
use glam::DVec3;

/// A line that a ray of one wavelength has met.
#[derive(Debug, Clone, Copy)]
pub(super) struct Caught {
    // Which of the scene's lines it is.
    of: *const Line,
    wavelength_nm: f64,
    power: f64,
}

impl Caught {
    pub(super) fn new(of: &Line, wavelength_nm: f64, power: f64) -> Self {
        Self { of, wavelength_nm, power }
    }

    pub(super) fn seen(&self) -> super::SeenLine {
        super::SeenLine { of: self.of, wavelength_nm: self.wavelength_nm, power: self.power }
    }
}

/// A line's wavelength has been found when it changes by less than this part.
const FOUND: f64 = 1e-9;
/// Ways on which a line would be met at wavelengths as near as this (nm) are one.
const ALIKE_NM: f64 = 1e-3;
/// Points of a line that are no farther apart (nm) are found from one another.
const BROAD_NM: f64 = 2.0;
/// Steps in which it has to be found.
const STEPS: u32 = 12;
/// Neighbours that part less than this (pixels) do not part.
const TOGETHER: f64 = 0.2;
/// So many wavelengths to a pixel that neighbours part, over the pixel's samples: with one, rainbows have stripes.
const PER_PIXEL: f64 = 3.0;
/// From so many samples of a pixel on their wavelengths are taken in turn between the observer's, also where these do not part.
const SEVERAL: f64 = 4.0;
/// Then a sample follows so many wavelengths, if they do not part further.
const GAPS: usize = 8;
/// The most wavelengths between two neighbours.
const MOST_BETWEEN: f64 = 31.0;

/// Light that is about to be parted.
pub(super) struct Parted<'f> {
    /// Its wave vector before.
    pub(super) wave: FourVector,
    /// How far each wavelength and the next part, in pixels; 0 where it is not known, and for the last.
    pub(super) apart: &'f [f64],
    /// Follows one wavelength.
    pub(super) follow: &'f mut dyn FnMut(f64, &Path<'_, 1>, &mut Gathered<'_, 1>),
}

impl Lit<'_> {
    /// Follows each wavelength by itself, and adds what is found to what is gathered.
    pub(super) fn split<const N: usize>(
        &self,
        lanes: &[f64; N],
        path: &Path<'_, N>,
        gathered: &mut Gathered<'_, N>,
        parted: Parted<'_>,
    ) {
        let Parted { wave, apart, follow } = parted;
        let mut single = |nm: f64| one(nm, path, wave, follow);
        let mut all = Vec::new();
        let mut at = |nm: f64| {
            let (value, lines, _) = single(nm);
            all.extend(lines.into_iter().map(|line| (nm, line)));
            value
        };
        let samples = (path.cone.pixel / path.cone.sample).powi(2).max(1.0);
        if samples < SEVERAL && apart.iter().all(|apart| *apart < TOGETHER) {
            for (sum, nm) in gathered.light.radiance.iter_mut().zip(lanes) {
                *sum += at(*nm);
            }
        } else {
            let stride = if samples < SEVERAL { 1 } else { (N / GAPS).max(1) };
            let mut last = None;
            while last != Some(N) {
                let next = last.map_or(stride - 1, |last| N.min(last + stride));
                let from = last.map_or(color::SHORTEST_NM, |last| lanes[last]);
                let to = lanes.get(next).copied().unwrap_or(color::LONGEST_NM);
                let apart: f64 = apart.iter().take(next).skip(last.unwrap_or(0)).sum();
                let count = (PER_PIXEL * apart / samples).ceil().clamp(1.0, MOST_BETWEEN * stride as f64);
                let bands = gathered.bands.as_deref_mut();
                gathered.light.lines += sampled((from, to), (count as u32, path.cone.phase), bands, &mut at);
                last = Some(next);
            }
        }
        if self.lines.is_empty() {
            return;
        }
        for nm in self.expected(wave, &mut |nm| single(nm).2) {
            all.extend(single(nm).1.into_iter().map(|caught| (nm, caught)));
        }
        for (nm, power) in lines(all, &mut |nm| single(nm).1) {
            gathered.point(nm, power);
        }
    }

    /// Where lines of what is at rest in each frame would be seen, in the direction in which light of that wavelength comes
    /// out of the glass.
    fn expected(&self, wave: FourVector, exit: &mut dyn FnMut(f64) -> FourVector) -> Vec<f64> {
        let mut all = Vec::new();
        for rest in &self.world.frames {
            let shift = |wave: FourVector| self.effects.shift(rest.rest_from_lab.light(wave).t);
            let mut last = f64::NEG_INFINITY;
            for line in self.lines {
                if line - last < BROAD_NM {
                    continue;
                }
                last = *line;
                all.extend(seen_at(*line, shift(wave), &mut |nm| shift(exit(nm))));
            }
        }
        all
    }
}

/// Where a line is seen whose shift depends on where it is seen, beginning with a first shift.
fn seen_at(line: f64, first: f64, shift: &mut dyn FnMut(f64) -> f64) -> Option<f64> {
    let mut nm = line * first;
    for _ in 0..STEPS {
        if !(color::SHORTEST_NM..=color::LONGEST_NM).contains(&nm) {
            return None;
        }
        let next = line * shift(nm);
        if (next - nm).abs() <= FOUND * nm {
            return Some(next);
        }
        nm = next;
    }
    None
}

/// Radiance and lines of one wavelength, and the wave vector with which it comes out of the glass.
fn one<const N: usize>(
    nm: f64,
    path: &Path<'_, N>,
    wave: FourVector,
    follow: &mut dyn FnMut(f64, &Path<'_, 1>, &mut Gathered<'_, 1>),
) -> (f64, Vec<Caught>, FourVector) {
    let throughput = [path.steps.map_or(1.0, |step| step.throughput(nm))];
    let path = Path {
        throughput,
        steps: path.steps,
        depth: path.depth,
        veils: path.veils,
        way: path.way,
        cone: path.cone,
    };
    let mut light = Light { radiance: [0.0], lines: DVec3::ZERO };
    let mut gathered =
        Gathered { light: &mut light, bands: None, caught: Some(Vec::new()), exit: (0.0, wave) };
    if throughput[0] > 0.0 {
        follow(nm, &path, &mut gathered);
    }
    let Gathered { caught, exit, .. } = gathered;
    (light.radiance[0], caught.unwrap_or_default(), exit.1)
}

/// XYZ of a radiance between two wavelengths, from as many evenly spaced ones, the first `phase` of a step in.
fn sampled<const N: usize>(
    (from, to): (f64, f64),
    (count, phase): (u32, f64),
    mut bands: Option<&mut [f64; N]>,
    at: &mut dyn FnMut(f64) -> f64,
) -> DVec3 {
    let step = (to - from) / f64::from(count);
    let one = |i: u32| {
        let nm = from + step * (f64::from(i) + phase);
        let power = at(nm) * step;
        if let Some(bands) = &mut bands {
            add_to_band(bands, nm, power);
        }
        color::matching(nm) * (power * LUMENS_PER_WATT)
    };
    (0..count).map(one).sum()
}

/// The lines met, each at the wavelength at which light of that wavelength meets it: (nm, power).
fn lines(mut all: Vec<(f64, Caught)>, single: &mut dyn FnMut(f64) -> Vec<Caught>) -> Vec<(f64, f64)> {
    // Every ray of another wavelength that met a line leads there. Those that would have it at the same wavelength lead to
    // the same; the nearest is the surest.
    let off = |(start, caught): &(f64, Caught)| (caught.wavelength_nm - start).abs();
    all.sort_by(|a, b| off(a).total_cmp(&off(b)));
    let mut starts: Vec<Caught> = Vec::new();
    for (_, caught) in all {
        let known = |other: &Caught| {
            other.of == caught.of && (other.wavelength_nm - caught.wavelength_nm).abs() < ALIKE_NM
        };
        if !starts.iter().any(known) {
            starts.push(caught);
        }
    }
    let mut found: Vec<(*const Line, f64, f64)> = Vec::new();
    for start in starts {
        let Some((nm, power)) = settled(&start, single) else { continue };
        if !found.iter().any(|(of, other, _)| *of == start.of && (other - nm).abs() <= 10.0 * FOUND * nm) {
            found.push((start.of, nm, power));
        }
    }
    found.into_iter().map(|(_, nm, power)| (nm, power)).collect()
}

/// The wavelength at which a line is met by light of that wavelength, and its power.
fn settled(start: &Caught, single: &mut dyn FnMut(f64) -> Vec<Caught>) -> Option<(f64, f64)> {
    let mut nm = start.wavelength_nm;
    for _ in 0..STEPS {
        let caught = single(nm);
        let off = |caught: &Caught| (caught.wavelength_nm - nm).abs();
        let same = || caught.iter().filter(|caught| caught.of == start.of);
        let next = same().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        if off(next) <= FOUND * nm {
            // Several ways of the same light (mirror images within the glass) arrive together.
            let together = same().filter(|caught| off(caught) <= FOUND * nm);
            return Some((nm, together.map(|caught| caught.power).sum()));
        }
        nm = next.wavelength_nm;
    }
    None
}
