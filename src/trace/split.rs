//! Where an index depends on the wavelength each wavelength goes its own way.
//!
//! The observer's wavelengths are followed one by one. Where two neighbours differ much (one meets a thing that the other
//! misses), the edge between them is looked for, so that colours change continuously across a picture. Spectral lines
//! are followed at their own wavelength, wherever between the samples that is.

use super::{Gathered, Light, Lit, Path};
use crate::color;
use crate::color::LUMENS_PER_WATT;
use crate::spectrum::{Line, Wavelengths};
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
}

/// Neighbours that differ by more than this part of the larger are looked at more closely.
const JUMP: f64 = 0.2;
/// An edge is found to this part of the distance between neighbours: 2⁻⁵.
const HALVINGS: u32 = 5;
/// A line's wavelength has been found when it changes by less than this part.
const FOUND: f64 = 1e-9;
/// Steps in which it has to be found.
const STEPS: u32 = 12;

/// Follows light of one wavelength.
type Follow<'f> = dyn FnMut(f64, &Path<'_, 1>, &mut Gathered<1>) + 'f;

impl Lit<'_> {
    /// Follows each wavelength by itself, and adds what is found to what is gathered.
    pub(super) fn split<const N: usize>(
        &self,
        lanes: &[f64; N],
        path: &Path<'_, N>,
        gathered: &mut Gathered<N>,
        follow: &mut Follow<'_>,
    ) {
        let mut single = |nm: f64| {
            let throughput = [path.steps.map_or(1.0, |step| step.throughput(nm))];
            let path = Path {
                throughput,
                steps: path.steps,
                depth: path.depth,
                veils: path.veils,
                way: path.way,
                cone: path.cone,
            };
            let light = Light { radiance: [0.0], lines: DVec3::ZERO };
            let mut one = Gathered { light, caught: Some(Vec::new()) };
            if throughput[0] > 0.0 {
                follow(nm, &path, &mut one);
            }
            (one.light.radiance[0], one.caught.unwrap_or_default())
        };
        let mut values = [0.0; N];
        let mut all = Vec::new();
        for (i, nm) in lanes.iter().enumerate() {
            let (value, caught) = single(*nm);
            values[i] = value;
            gathered.light.radiance[i] += value;
            all.extend(caught.into_iter().map(|caught| (*nm, caught)));
        }
        let largest = values.iter().copied().fold(0.0, f64::max);
        for pair in 0..N.saturating_sub(1) {
            let (a, b) = ((lanes[pair], values[pair]), (lanes[pair + 1], values[pair + 1]));
            if (a.1 - b.1).abs() > JUMP * a.1.max(b.1) && (a.1 - b.1).abs() > 0.05 * largest {
                gathered.light.lines += refine(a, b, largest, HALVINGS, &mut |nm| single(nm).0);
            }
        }
        for (nm, power) in lines(&all, &mut single) {
            match &mut gathered.caught {
                Some(_) => {}
                None => gathered.light.lines += Wavelengths::<N>::line_xyz(nm, power),
            }
        }
    }
}

/// What is missing of the XYZ between two neighbours when the radiance is taken as linear there.
fn refine(
    a: (f64, f64),
    b: (f64, f64),
    largest: f64,
    halvings: u32,
    at: &mut dyn FnMut(f64) -> f64,
) -> DVec3 {
    let middle = 0.5 * (a.0 + b.0);
    let value = at(middle);
    let error = value - 0.5 * (a.1 + b.1);
    // A triangle of this height: its integral against the colour functions, by Simpson's rule on each side.
    let half = 0.5 * (b.0 - a.0);
    let quarter = |nm: f64| color::matching(nm) * 2.0;
    let weight = (quarter(middle - 0.5 * half) + color::matching(middle) * 2.0 + quarter(middle + 0.5 * half)) * (half / 6.0);
    let mut sum = weight * (error * LUMENS_PER_WATT);
    if halvings > 1 && error.abs() > 0.02 * largest {
        let m = (middle, value);
        sum += refine(a, m, largest, halvings - 1, at) + refine(m, b, largest, halvings - 1, at);
    }
    sum
}

/// The lines met, each at the wavelength at which light of that wavelength meets it: (nm, power).
fn lines(all: &[(f64, Caught)], single: &mut dyn FnMut(f64) -> (f64, Vec<Caught>)) -> Vec<(f64, f64)> {
    let mut found: Vec<(*const Line, f64, f64)> = Vec::new();
    for (start, first) in all {
        // Every ray of another wavelength that met it leads there; the nearest is the surest.
        let nearer = |(lane, other): &(f64, Caught)| {
            other.of == first.of
                && (other.wavelength_nm - lane).abs() < (first.wavelength_nm - start).abs()
        };
        if all.iter().any(nearer) || found.iter().any(|(of, ..)| *of == first.of) {
            continue;
        }
        let mut nm = first.wavelength_nm;
        for _ in 0..STEPS {
            let (_, caught) = single(nm);
            let same = caught.iter().filter(|caught| caught.of == first.of);
            let nearest = same.min_by(|a, b| (a.wavelength_nm - nm).abs().total_cmp(&(b.wavelength_nm - nm).abs()));
            let Some(next) = nearest.copied() else { break };
            if (next.wavelength_nm - nm).abs() <= FOUND * nm {
                // Several ways of the same light (mirror images within the glass) arrive together.
                let together = caught.iter().filter(|caught| {
                    caught.of == first.of && (caught.wavelength_nm - nm).abs() <= FOUND * nm
                });
                found.push((first.of, nm, together.map(|caught| caught.power).sum()));
                break;
            }
            nm = next.wavelength_nm;
        }
    }
    found.into_iter().map(|(_, nm, power)| (nm, power)).collect()
}
