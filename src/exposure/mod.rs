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
use glam::{DVec2, DVec3};
use rayon::prelude::*;
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
    let xyz = by_pixel_until(size, stop, pixels(lit, view, sampling), |_, _| {})?;
    Some(Negative { width: sampling.width, height: sampling.height, xyz })
}

/// What says the XYZ of a pixel, by its column and row.
type Pixels<'a> = Box<dyn Fn(usize, usize) -> [f32; 3] + Sync + 'a>;

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
    Box::new(move |column, row| {
        exposing.pixel(column, row, |ray, cone| lit.seen_within(ray, cone, &exposing.wavelengths)).0
    })
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

    /// The mean of a pixel's samples: XYZ, and the radiances.
    fn pixel(
        &self,
        column: usize,
        row: usize,
        mut seen: impl FnMut(&SightRay, Cone) -> Light<N>,
    ) -> ([f32; 3], [f64; N]) {
        let spacing = self.share.sqrt();
        let (view, centre) = self.view.of_pixel(DVec2::new(column as f64 + 0.5, row as f64 + 0.5));
        let mut radiance = [0.0; N];
        let mut lines = DVec3::ZERO;
        for (offset, phase) in self.offsets.iter().zip(&self.phases) {
            let place = centre + *offset;
            if !view.shows(place) {
                continue;
            }
            let (ray, cone) = view.sight(place, spacing);
            let light = seen(&ray, Cone { phase: *phase, ..cone });
            for (sum, value) in radiance.iter_mut().zip(light.radiance) {
                *sum += value;
            }
            lines += light.lines;
        }
        let xyz = ((self.wavelengths.xyz(&radiance) + lines) * self.share).min(DVec3::splat(BRIGHTEST));
        (xyz.as_vec3().to_array(), radiance.map(|value| value * self.share))
    }
}

/// Exposes some tiles of a picture, by their columns and rows, as [`expose_until`] would, and keeps nothing of them: how many pixels
/// they have. `lit` is ready for the view.
pub(crate) fn expose_tiles(
    lit: &Lit<'_>,
    view: &View,
    sampling: &Sampling,
    tiles: &[(usize, usize)],
) -> usize {
    let pixel = pixels(lit, view, sampling);
    let within = |tile: usize, end: u32| tile * TILE..((tile + 1) * TILE).min(end as usize);
    let exposed = |(column, row): &(usize, usize)| {
        let rows = within(*row, sampling.height);
        let places = rows.flat_map(|row| within(*column, sampling.width).map(move |column| (column, row)));
        let count = |sum, (column, row)| {
            std::hint::black_box(pixel(column, row));
            sum + 1
        };
        places.fold(0, count)
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

/// The same, with what is known at once of some rows given to `band`; none if it was stopped. (Found tile by tile, since rays that
/// are near one another meet the same things.)
fn by_pixel_until<T: Send + Clone>(
    (width, height): (u32, u32),
    stop: &Stop,
    of: impl Fn(usize, usize) -> T + Sync,
    band: impl Fn(Range<usize>, &[T]) + Sync,
) -> Option<Vec<T>> {
    let (width, height) = (width as usize, height as usize);
    let tiles = |end: usize| (0..end.div_ceil(TILE)).map(move |i| i * TILE..((i + 1) * TILE).min(end));
    let bands: Option<Vec<Vec<T>>> = tiles(height)
        .collect::<Vec<_>>()
        .into_par_iter()
        .with_max_len(1) // Else one thread may be left with many when the others are done.
        .map(|rows| {
            let mut found = Vec::with_capacity(width * rows.len());
            for columns in tiles(width) {
                if stop.is_set() {
                    return None;
                }
                let places = rows.clone().flat_map(|row| columns.clone().map(move |column| (column, row)));
                found.extend(places.map(|(column, row)| of(column, row)));
            }
            let found = in_rows(&found, width, rows.len());
            band(rows, &found);
            Some(found)
        })
        .collect();
    Some(bands?.concat())
}

/// A row of tiles, from tile by tile to row by row.
fn in_rows<T: Clone>(tiled: &[T], width: usize, rows: usize) -> Vec<T> {
    let mut all = Vec::with_capacity(tiled.len());
    for row in 0..rows {
        for start in (0..width).step_by(TILE) {
            let columns = TILE.min(width - start);
            let first = start * rows + row * columns;
            all.extend_from_slice(&tiled[first..first + columns]);
        }
    }
    all
}
