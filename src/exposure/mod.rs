//! One picture: from sight rays to a negative.

mod progressive;
mod settle;
mod shared;
mod spectral;
mod square;

pub use progressive::{Grain, expose_coarse_to_fine};
pub use settle::{Settled, Uncertainty, expose_settled, expose_settled_until};
pub use shared::expose_converged;
pub use spectral::{Bands, expose_spectral, middles};

use crate::film::{Negative, Reconstruction};
use crate::observer::View;
use crate::scene::Scene;
use crate::spacetime::SightRay;
use crate::spectrum::Wavelengths;
use crate::stop::Stop;
use crate::trace::{Cone, First, Light, Lit};
use crate::tree::MANY;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use smallvec::SmallVec;
use std::ops::Range;

/// How finely a picture is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples per pixel; one is the pixel's centre.
    pub samples: u32,
    /// The filter over them.
    pub reconstruction: Reconstruction,
    /// Wavelengths per sample: 3 (where that is enough), 8, 16, 32 or 64.
    pub wavelengths: u32,
}

impl Sampling {
    /// The same, of the same shape and at most so many columns wide.
    #[must_use]
    pub fn within(self, columns: u32) -> Self {
        let width = self.width.min(columns);
        let height = (u64::from(self.height) * u64::from(width) / u64::from(self.width)).max(1) as u32;
        Self { width, height, ..self }
    }
}

/// What is brighter (cd/m²) is as bright as this: numbers in 32 bits, sRGB's among them, go no further.
const BRIGHTEST: f64 = 1e37;

/// Columns and rows of a tile; a row of tiles is a task of the pool.
pub(crate) const TILE: usize = 8;

/// Exposes a picture. The same bytes on any number of threads.
pub fn expose(scene: &Scene, view: &View, sampling: &Sampling) -> Negative {
    expose_lit(&scene.lit(), view, sampling)
}

/// The same with the methods of the light loop chosen by hand.
pub fn expose_lit(lit: &Lit<'_>, view: &View, sampling: &Sampling) -> Negative {
    expose_until(lit, view, sampling, &Stop::never()).unwrap_or_default()
}

/// The same; none if it was stopped.
pub fn expose_until(lit: &Lit<'_>, view: &View, sampling: &Sampling, stop: &Stop) -> Option<Negative> {
    let lit = &lit.seen_from(view.tetrad.event);
    let size = (sampling.width, sampling.height);
    let of = pixels(lit, view, sampling);
    let xyz = by_tile_until(size, stop, |places, tell| of(places, tell), |_, _| {})?;
    Some(Negative { width: sampling.width, height: sampling.height, xyz })
}

/// A column and a row.
type Place = (usize, usize);

/// What tells the XYZ of some pixels near one another, in their order.
type Pixels<'a> = Box<dyn Fn(&[Place], &mut dyn FnMut([f32; 3])) + Sync + 'a>;

fn pixels<'a>(lit: &'a Lit<'a>, view: &'a View, sampling: &Sampling) -> Pixels<'a> {
    match sampling.wavelengths {
        0..=3 => pixels_with::<3>(lit, view, sampling),
        4..=8 => pixels_with::<8>(lit, view, sampling),
        9..=16 => pixels_with::<16>(lit, view, sampling),
        17..=32 => pixels_with::<32>(lit, view, sampling),
        _ => pixels_with::<64>(lit, view, sampling),
    }
}

fn pixels_with<'a, const N: usize>(lit: &'a Lit<'a>, view: &'a View, sampling: &Sampling) -> Pixels<'a> {
    let exposing = Exposing::<N>::new(view, sampling);
    Box::new(move |places, tell| exposing.pixels(places, lit, tell))
}

/// What is the same for all pixels of a picture.
struct Exposing<'a, const N: usize> {
    view: &'a View,
    wavelengths: Wavelengths<N>,
    offsets: Vec<DVec2>,
    phases: Vec<f64>,
    share: f64,
}

impl<'a, const N: usize> Exposing<'a, N> {
    fn new(view: &'a View, sampling: &Sampling) -> Self {
        Self {
            view,
            wavelengths: Wavelengths::new(),
            offsets: sampling.reconstruction.offsets(sampling.samples),
            phases: (0..sampling.samples).map(|number| phase(number, 0)).collect(),
            share: 1.0 / f64::from(sampling.samples),
        }
    }

    /// The means of the samples of some pixels near one another, XYZ: as many rays go together as may.
    fn pixels(&self, places: &[Place], lit: &Lit<'_>, tell: &mut dyn FnMut([f32; 3])) {
        for places in places.chunks((MANY / self.offsets.len()).max(1)) {
            let mut sums: SmallVec<[([f64; N], DVec3); MANY]> = SmallVec::new();
            let mut rays: SmallVec<[(SightRay, Cone); MANY]> = SmallVec::new();
            let mut of: SmallVec<[usize; MANY]> = SmallVec::new();
            for (number, place) in places.iter().enumerate() {
                sums.push(([0.0; N], DVec3::ZERO));
                for sight in self.sights(*place) {
                    rays.push(sight); // `extend` is not inlined.
                }
                of.resize(rays.len(), number);
            }
            lit.seen_many(&rays, &self.wavelengths, |i, light| add(&mut sums[of[i]], &light));
            sums.iter().for_each(|(radiance, lines)| tell(self.mean(radiance, *lines)));
        }
    }

    /// The sight rays of a pixel's samples.
    fn sights(&self, (column, row): Place) -> impl Iterator<Item = (SightRay, Cone)> {
        let spacing = self.share.sqrt();
        let (view, centre) = self.view.of_pixel(DVec2::new(column as f64 + 0.5, row as f64 + 0.5));
        self.offsets.iter().zip(&self.phases).filter_map(move |(offset, phase)| {
            let place = centre + *offset;
            view.shows(place).then(|| {
                let (ray, cone) = view.sight(place, spacing);
                (ray, Cone { phase: *phase, ..cone })
            })
        })
    }

    /// XYZ of the mean of samples with this sum.
    fn mean(&self, radiance: &[f64; N], lines: DVec3) -> [f32; 3] {
        let xyz = ((self.wavelengths.xyz(radiance) + lines) * self.share).min(DVec3::splat(BRIGHTEST));
        xyz.as_vec3().to_array()
    }

    /// The mean of a pixel's samples: XYZ, and the radiances.
    fn pixel(&self, place: Place, mut seen: impl FnMut(&SightRay, Cone) -> Light<N>) -> ([f32; 3], [f64; N]) {
        let mut sum = ([0.0; N], DVec3::ZERO);
        self.sights(place).for_each(|(ray, cone)| add(&mut sum, &seen(&ray, cone)));
        let (radiance, lines) = sum;
        (self.mean(&radiance, lines), radiance.map(|value| value * self.share))
    }
}

/// Adds light to a sum of radiances and lines.
fn add<const N: usize>((radiance, lines): &mut ([f64; N], DVec3), light: &Light<N>) {
    for (sum, value) in radiance.iter_mut().zip(light.radiance) {
        *sum += value;
    }
    *lines += light.lines;
}

/// Exposes some tiles of a picture, by their columns and rows, as [`expose_until`] would, and keeps nothing of them: how many pixels
/// they have. `lit` is ready for the view.
pub(crate) fn expose_tiles(
    lit: &Lit<'_>,
    view: &View,
    sampling: &Sampling,
    tiles: &[(usize, usize)],
) -> usize {
    let of = pixels(lit, view, sampling);
    let within = |tile: usize, end: u32| tile * TILE..((tile + 1) * TILE).min(end as usize);
    let exposed = |(column, row): &Place| {
        let places = in_tile(within(*column, sampling.width), within(*row, sampling.height));
        of(&places, &mut |xyz| {
            std::hint::black_box(xyz);
        });
        places.len()
    };
    tiles.par_iter().with_max_len(1).map(exposed).sum()
}

/// The phase of a pixel's sample: where colours are parted each takes other wavelengths. Sobol's third dimension, as places in the
/// pixel are the first two; all digits of `moved` move it.
fn phase(number: u32, moved: u32) -> f64 {
    let directions = std::iter::successors(Some((1_u32 << 31, 3_u32 << 30)), |(last, direction)| {
        Some((*direction, direction ^ last ^ (last >> 2)))
    });
    let chosen = directions.take(32).enumerate().filter(|(bit, _)| number >> bit & 1 == 1);
    let digits = chosen.fold(0x5555_5555 ^ moved, |digits, (_, (direction, _))| digits ^ direction);
    (f64::from(digits) + 0.5) / 4_294_967_296.0
}

/// What stands first in the way at each pixel's centre.
pub fn first_hits(scene: &Scene, view: &View, width: u32, height: u32) -> Vec<Option<First>> {
    first_seen(scene, view, (width, height), |lit, _, ray| lit.first(ray))
}

/// Something of what stands first in the way, of the place of each pixel's centre and the ray through it.
pub(crate) fn first_seen<'s, T: Send + Clone>(
    scene: &'s Scene,
    view: &View,
    (width, height): (u32, u32),
    of: impl Fn(&Lit<'s>, DVec2, &SightRay) -> Option<T> + Sync,
) -> Vec<Option<T>> {
    let lit = scene.lit().seen_from(view.tetrad.event);
    let first = |column: usize, row: usize| {
        let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        if view.shows(place) { of(&lit, place, &view.ray(place)) } else { None }
    };
    by_pixel(width, height, first)
}

/// Something of each pixel, row by row.
fn by_pixel<T: Send + Clone>(width: u32, height: u32, of: impl Fn(usize, usize) -> T + Sync) -> Vec<T> {
    by_pixel_until((width, height), &Stop::never(), of, |_, _| {}).unwrap_or_default()
}

/// The same, with what is known at once of some rows given to `band`; none if it was stopped.
fn by_pixel_until<T: Send + Clone>(
    size: (u32, u32),
    stop: &Stop,
    of: impl Fn(usize, usize) -> T + Sync,
    band: impl Fn(Range<usize>, &[T]) + Sync,
) -> Option<Vec<T>> {
    let each = |places: &[Place], tell: &mut dyn FnMut(T)| {
        places.iter().for_each(|(column, row)| tell(of(*column, *row)));
    };
    by_tile_until(size, stop, each, band)
}

/// The same of the pixels of a tile, told in their order. (Rays that are near one another meet the same things.)
fn by_tile_until<T: Send + Clone>(
    (width, height): (u32, u32),
    stop: &Stop,
    of: impl Fn(&[Place], &mut dyn FnMut(T)) + Sync,
    band: impl Fn(Range<usize>, &[T]) + Sync,
) -> Option<Vec<T>> {
    let (width, height) = (width as usize, height as usize);
    let tiles = |end: usize| (0..end.div_ceil(TILE)).map(move |i| i * TILE..((i + 1) * TILE).min(end));
    let bands: Option<Vec<Vec<T>>> = tiles(height)
        .collect::<Vec<_>>()
        .into_par_iter()
        .with_max_len(1) // Else one thread may be left with many when the others are done.
        .map(|rows| {
            let mut found = vec![None; width * rows.len()];
            for columns in tiles(width) {
                if stop.is_set() {
                    return None;
                }
                let places = in_tile(columns, rows.clone());
                let mut told = places.iter();
                of(&places, &mut |value| {
                    if let Some((column, row)) = told.next() {
                        found[(row - rows.start) * width + column] = Some(value);
                    }
                });
            }
            let found: Vec<T> = found.into_iter().flatten().collect();
            band(rows, &found);
            Some(found)
        })
        .collect();
    Some(bands?.concat())
}

/// The pixels of a tile, by squares within squares, so that those that follow one another are near one another.
fn in_tile(columns: Range<usize>, rows: Range<usize>) -> SmallVec<[Place; TILE * TILE]> {
    let bit = |number: usize, bit: usize| number >> bit & 1;
    let within = |number: usize| {
        let at =
            |first: usize| bit(number, first) | bit(number, first + 2) << 1 | bit(number, first + 4) << 2;
        (columns.start + at(0), rows.start + at(1))
    };
    let places = (0..TILE * TILE).map(within);
    places.filter(|(column, row)| *column < columns.end && *row < rows.end).collect()
}
