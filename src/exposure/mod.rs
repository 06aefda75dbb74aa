//! One picture: from sight rays to a negative.

mod settle;
mod spectral;

pub use settle::{Settled, Uncertainty, expose_settled};
pub use spectral::{Bands, expose_spectral, middles};

use crate::film::{Negative, Reconstruction};
use crate::observer::View;
use crate::scene::Scene;
use crate::spacetime::SightRay;
use crate::spectrum::Wavelengths;
use crate::surface::{Look, Surface};
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
const TILE: usize = 8;

/// Exposes a picture. The same bytes on any number of threads.
pub fn expose(scene: &Scene, view: &View, sampling: &Sampling) -> Negative {
    expose_lit(&scene.lit(), view, sampling)
}

/// The same with the methods of the light loop chosen by hand.
pub fn expose_lit(lit: &Lit<'_>, view: &View, sampling: &Sampling) -> Negative {
    let lit = &lit.seen_from(view.tetrad.event);
    match sampling.wavelengths {
        0..=3 => expose_with::<3>(lit, view, sampling),
        4..=8 => expose_with::<8>(lit, view, sampling),
        9..=16 => expose_with::<16>(lit, view, sampling),
        17..=32 => expose_with::<32>(lit, view, sampling),
        _ => expose_with::<64>(lit, view, sampling),
    }
}

fn expose_with<const N: usize>(lit: &Lit<'_>, view: &View, sampling: &Sampling) -> Negative {
    let exposing = Exposing::<N>::new(view, sampling);
    let xyz = by_pixel(sampling.width, sampling.height, |column, row| {
        exposing.pixel(column, row, |ray, cone| lit.seen_within(ray, cone, &exposing.wavelengths)).0
    });
    Negative { width: sampling.width, height: sampling.height, xyz }
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
            phases: (0..sampling.samples).map(phase).collect(),
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

/// The phase of a pixel's sample: where colours are parted each takes other wavelengths. Sobol's third dimension, as places in the
/// pixel are the first two.
fn phase(number: u32) -> f64 {
    let directions = std::iter::successors(Some((1_u32 << 31, 3_u32 << 30)), |(last, direction)| {
        Some((*direction, direction ^ last ^ (last >> 2)))
    });
    let chosen = directions.take(32).enumerate().filter(|(bit, _)| number >> bit & 1 == 1);
    let digits = chosen.fold(0x5555_5555, |digits, (_, (direction, _))| digits ^ direction);
    (f64::from(digits) + 0.5) / 4_294_967_296.0
}

/// What stands first in the way at each pixel's centre.
pub fn first_hits(scene: &Scene, view: &View, width: u32, height: u32) -> Vec<Option<First>> {
    first_and(scene, view, (width, height), Lit::first)
}

/// The same with the colours of surfaces by daylight at rest, linear sRGB.
pub fn first_colors(scene: &Scene, view: &View, width: u32, height: u32) -> Vec<Option<(First, DVec3)>> {
    let color = |surface: Option<&Surface>, look: &Look<'_>| {
        surface.map_or(DVec3::ZERO, |surface| surface.albedo(look))
    };
    first_and(scene, view, (width, height), |lit, ray| lit.first_and(ray, color))
}

fn first_and<'s, T: Send + Clone>(
    scene: &'s Scene,
    view: &View,
    (width, height): (u32, u32),
    of: impl Fn(&Lit<'s>, &SightRay) -> Option<T> + Sync,
) -> Vec<Option<T>> {
    let lit = scene.lit().seen_from(view.tetrad.event);
    let first = |column: usize, row: usize| {
        let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        if view.shows(place) { of(&lit, &view.ray(place)) } else { None }
    };
    by_pixel(width, height, first)
}

/// Something of each pixel, row by row. (Found tile by tile, since rays that are near one another meet the same things.)
fn by_pixel<T: Send + Clone>(width: u32, height: u32, of: impl Fn(usize, usize) -> T + Sync) -> Vec<T> {
    let (width, height) = (width as usize, height as usize);
    let tiles = |end: usize| (0..end.div_ceil(TILE)).map(move |i| i * TILE..((i + 1) * TILE).min(end));
    let bands: Vec<Vec<T>> = tiles(height)
        .collect::<Vec<_>>()
        .into_par_iter()
        .with_max_len(1) // Else one thread may be left with many when the others are done.
        .map(|rows| {
            let places = |columns: Range<usize>| {
                rows.clone().flat_map(move |row| columns.clone().map(move |c| (c, row)))
            };
            tiles(width).flat_map(places).map(|(column, row)| of(column, row)).collect()
        })
        .collect();
    let mut all = Vec::with_capacity(width * height);
    for band in bands {
        let rows = band.len() / width.max(1);
        for row in 0..rows {
            for columns in tiles(width) {
                let first = columns.start * rows + row * columns.len();
                all.extend_from_slice(&band[first..first + columns.len()]);
            }
        }
    }
    all
}
