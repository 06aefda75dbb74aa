//! Pictures whose pixels share their samples with their neighbours.

use super::square::{Around, FIRST, MOST, Measuring, Sequence, Square};
use super::{BRIGHTEST, Sampling, TILE};
use crate::film::{Negative, Reconstruction};
use crate::observer::View;
use crate::stop::Stop;
use crate::trace::Lit;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::array::from_fn;

/// Exposes a picture that others are compared with: with so many samples in each square of a pixel's size (the next power of two, 4
/// to 1024), each of which counts for all pixels whose filters reach it, at 3, 16, 32 or 64 wavelengths (64 in place of others). It
/// has no sample in common with what is asked for by an error.
pub fn expose_converged(lit: &Lit<'_>, view: &View, sampling: &Sampling) -> Negative {
    let samples = sampling.samples.clamp(FIRST, MOST).next_power_of_two();
    let of_eye = |view: &View, grid: Grid| {
        let lit = lit.seen_from(view.tetrad.event);
        let measuring = Measuring::new(&lit, view, sampling.reconstruction, Sequence::Turned);
        let squares = evenly(&measuring, grid, samples, sampling.wavelengths, &Stop::never());
        grid.negative(&squares.unwrap_or_default())
    };
    let eyes: Vec<Negative> = eyes(view, sampling).map(|(view, grid)| of_eye(&view, grid)).collect();
    beside(&eyes)
}

/// What each eye sees whose picture is in this one, and the squares of its picture.
pub(super) fn eyes(view: &View, sampling: &Sampling) -> impl Iterator<Item = (View, Grid)> {
    let (rows, filter) = (sampling.height as usize, sampling.reconstruction);
    view.eyes().map(move |(view, width)| (view, Grid::new((width as usize, rows), filter)))
}

/// Pictures of equal height, from left to right, as one.
pub(super) fn beside(pictures: &[Negative]) -> Negative {
    let height = pictures.first().map_or(0, |picture| picture.height);
    let of = |picture: &Negative, row: u32| {
        let (first, end) = (row * picture.width, (row + 1) * picture.width);
        picture.xyz[first as usize..end as usize].to_vec()
    };
    let xyz = (0..height).flat_map(|row| pictures.iter().flat_map(move |picture| of(picture, row)));
    let width = pictures.iter().map(|picture| picture.width).sum();
    Negative { width, height, xyz: xyz.collect() }
}

/// All squares with so many samples and wavelengths; none if it was stopped.
pub(super) fn evenly(
    measuring: &Measuring<'_>,
    grid: Grid,
    samples: u32,
    wavelengths: u32,
    stop: &Stop,
) -> Option<Vec<Square>> {
    let mut squares = vec![Square::default(); grid.columns * grid.rows];
    let band = |(band, squares): (usize, &mut [Square])| {
        // Tile by tile, since rays that are near one another meet the same things.
        for first in (0..grid.columns).step_by(TILE) {
            for (row, squares) in squares.chunks_mut(grid.columns).enumerate() {
                for (column, square) in squares.iter_mut().enumerate().skip(first).take(TILE) {
                    let centre = grid.centre(column, band * TILE + row);
                    *square = measuring.square(centre, None, samples, wavelengths);
                }
            }
            if stop.is_set() {
                return None;
            }
        }
        Some(())
    };
    let bands = squares.par_chunks_mut(grid.columns * TILE).enumerate().with_max_len(1);
    bands.map(band).collect::<Option<()>>()?;
    Some(squares)
}

/// Squares of a picture and, where filters reach beyond it, beside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    columns: usize,
    rows: usize,
    margin: usize,
}

impl Grid {
    fn new((width, height): (usize, usize), filter: Reconstruction) -> Self {
        let margin = usize::from(filter != Reconstruction::Box);
        Self { columns: width + 2 * margin, rows: height + 2 * margin, margin }
    }

    fn place(&self, number: usize) -> (usize, usize) {
        (number % self.columns, number / self.columns)
    }

    fn centre(&self, column: usize, row: usize) -> DVec2 {
        DVec2::new(column as f64, row as f64) + 0.5 - self.margin as f64
    }

    /// The middle of a square, pixels.
    pub(super) fn middle(&self, number: usize) -> DVec2 {
        let (column, row) = self.place(number);
        self.centre(column, row)
    }

    /// Whether a square is one of the picture's pixels.
    pub(super) fn shows(&self, number: usize) -> bool {
        let (column, row) = self.place(number);
        let within = |place: usize, end: usize| place >= self.margin && place + self.margin < end;
        within(column, self.columns) && within(row, self.rows)
    }

    /// The numbers of the squares up to so many columns and rows away.
    pub(super) fn around(&self, number: usize, reach: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, (column, row)) = (self.columns, self.place(number));
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// The numbers of the squares that give a pixel its light.
    pub(super) fn givers(&self, number: usize) -> Around<Option<usize>> {
        let (column, row) = self.place(number);
        from_fn(|i| {
            let (column, row) = ((column + i % 3).checked_sub(1)?, (row + i / 3).checked_sub(1)?);
            (column < self.columns && row < self.rows).then_some(row * self.columns + column)
        })
    }

    /// The sum of something over the squares that give a pixel its light, each by its number and by which it is to the pixel.
    pub(super) fn sum(&self, number: usize, of: impl Fn(usize, usize) -> DVec3) -> DVec3 {
        let givers = self.givers(number).into_iter().enumerate();
        givers.filter_map(|(i, giver)| Some(of(giver?, i))).sum()
    }

    /// The light of a pixel, XYZ.
    pub(super) fn xyz(&self, squares: &[Square], number: usize) -> DVec3 {
        // To a square the pixel is on the other side.
        self.sum(number, |giver, i| squares[giver].given[8 - i].as_dvec3())
    }

    /// The picture.
    pub(super) fn negative(&self, squares: &[Square]) -> Negative {
        let shown = (0..squares.len()).filter(|number| self.shows(*number));
        let xyz = |number| self.xyz(squares, number).min(DVec3::splat(BRIGHTEST)).as_vec3().to_array();
        Negative {
            width: (self.columns - 2 * self.margin) as u32,
            height: (self.rows - 2 * self.margin) as u32,
            xyz: shown.map(xyz).collect(),
        }
    }
}
