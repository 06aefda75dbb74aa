//! CIE daylight at any wavelength, and daylight through a filter of one colour.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::blackbody::planck_with_slope;
use super::table::{add, rows};
use super::{Reflectance, planck};
use crate::simd::whole_and_part;
use std::sync::LazyLock;

/// CIE standard illuminant D65, 100 at 560 nm.
///
/// 300 to 830 nm from CIE 15:2018, 5 nm, linear in between. Beyond, where the CIE says nothing and a Doppler shift
/// may ask, it goes on as a black body of 6504 K that meets the table's ends: exactly below 80 and above 4130 nm, to a part 2e-5 up to
/// 120 nm, and to 2e-6 in between.
#[derive(Debug)]
pub struct Daylight {
    pieces: Pieces,
    below: f64,
    above: f64,
}

/// CIE standard illuminant D65, at any wavelength.
pub static D65: LazyLock<Daylight> = LazyLock::new(Daylight::new);

/// A power of two, and no less than all pieces.
const ROWS: usize = 512;

/// Polynomials of the third order in the part of the way from one wavelength to the next.
type Pieces = Box<[[f64; 4]; ROWS]>;

/// Wavelengths that are equally far apart: the first (nm), how far, and the number of the piece that begins there.
struct Even {
    nm: f64,
    step: f64,
    row: f64,
}

const ULTRAVIOLET: Even = Even { nm: 80.0, step: 1.0, row: 0.0 };
const TABLE: Even = Even { nm: 300.0, step: 5.0, row: 220.0 };
const INFRARED: Even = Even { nm: 830.0, step: 20.0, row: 326.0 };
const LAST_NM: f64 = 4130.0;
const LAST_ROW: usize = 491;

/// What black body daylight is beyond the table.
const KELVIN: f64 = 6504.0;

/// The piece in which a wavelength (nm) lies, and the part of the way through it.
#[inline(always)]
fn piece(nm: f64) -> (usize, f64) {
    let of = |even: Even| (nm - even.nm) * (1.0 / even.step) + even.row;
    let beyond = if nm < TABLE.nm { of(ULTRAVIOLET) } else { of(INFRARED) };
    whole_and_part(if (TABLE.nm..=INFRARED.nm).contains(&nm) { of(TABLE) } else { beyond })
}

/// Where a piece begins and how long it is, nm.
fn beginning(row: usize) -> (f64, f64) {
    let row = row as f64;
    let even = [INFRARED, TABLE, ULTRAVIOLET].into_iter().find(|even| even.row <= row).unwrap_or(ULTRAVIOLET);
    (even.nm + (row - even.row) * even.step, even.step)
}

/// Whether pieces know all of them. (No early end, so that all are compared at once.)
#[inline]
fn all_in_pieces<const N: usize>(nm: &[f64; N]) -> bool {
    nm.iter().fold(true, |all, nm| all & (ULTRAVIOLET.nm..=LAST_NM).contains(nm))
}

#[inline(always)]
fn at_piece(pieces: &[[f64; 4]; ROWS], nm: f64) -> f64 {
    let (row, part) = piece(nm);
    let [a, b, c, d] = pieces[row % ROWS];
    a + part * (b + part * (c + part * d))
}

impl Daylight {
    fn new() -> Self {
        let table: Vec<f64> = rows::<2>(include_str!("d65.csv")).iter().map(|row| row[1]).collect();
        let (first, last) = (table[0], table[table.len() - 1]);
        let (below, above) = (first / planck(TABLE.nm, KELVIN), last / planck(INFRARED.nm, KELVIN));
        let of = |row: usize| {
            let (nm, step) = beginning(row);
            if (TABLE.row..INFRARED.row).contains(&(row as f64)) {
                let i = row - TABLE.row as usize;
                return [table[i], table[i + 1] - table[i], 0.0, 0.0];
            }
            // Hermite's, which has the values and the slopes at both ends.
            let scale = if nm < TABLE.nm { below } else { above };
            let [(a, slope), (b, last)] = [nm, nm + step].map(|nm| {
                let (value, slope) = planck_with_slope(nm, KELVIN);
                (scale * value, scale * step * slope)
            });
            [a, slope, 3.0 * (b - a) - 2.0 * slope - last, 2.0 * (a - b) + slope + last]
        };
        let pieces = Box::new(std::array::from_fn(|row| if row < LAST_ROW { of(row) } else { [0.0; 4] }));
        Self { pieces, below, above }
    }

    /// Relative spectral power at a wavelength in nm.
    #[inline]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let mut sum = [0.0];
        self.add_each(&mut sum, &[wavelength_nm], 1.0);
        sum[0]
    }

    /// Adds it, so many times, at many wavelengths.
    #[inline]
    pub(super) fn add_each<const N: usize>(&self, sum: &mut [f64; N], nm: &[f64; N], factor: f64) {
        if all_in_pieces(nm) {
            add(sum, nm, factor, |nm| at_piece(&self.pieces, nm));
        } else {
            self.add_far(sum, nm, factor);
        }
    }

    #[cold]
    fn add_far<const N: usize>(&self, sum: &mut [f64; N], nm: &[f64; N], factor: f64) {
        for (sum, nm) in sum.iter_mut().zip(nm) {
            let far = if *nm < TABLE.nm { self.below } else { self.above };
            let value =
                if all_in_pieces(&[*nm]) { at_piece(&self.pieces, *nm) } else { far * planck(*nm, KELVIN) };
            *sum += factor * value;
        }
    }
}

/// Daylight through a filter of one colour: where daylight is linear, and the filter is, too, of the second order.
#[derive(Debug, Clone)]
pub(super) struct Filtered {
    filter: Reflectance,
    pieces: Pieces,
}

impl Filtered {
    /// Through a filter of linear sRGB.
    pub(super) fn new(rgb: [f64; 3]) -> Self {
        let filter = Reflectance::Rgb(rgb);
        let of = |row: usize| {
            let (nm, step) = beginning(row);
            let [a, b, c, d] = D65.pieces[row];
            // Its own rows are the table's; beyond it is the same everywhere.
            let (first, last) = (filter.at(nm), filter.at(nm + step));
            let more = last - first;
            [a * first, b * first + a * more, c * first + b * more, d * first]
        };
        Self { pieces: Box::new(std::array::from_fn(of)), filter }
    }

    /// Adds it, so many times, at many wavelengths.
    #[inline]
    pub(super) fn add_each<const N: usize>(&self, sum: &mut [f64; N], nm: &[f64; N], factor: f64) {
        if all_in_pieces(nm) {
            add(sum, nm, factor, |nm| at_piece(&self.pieces, nm));
        } else {
            let mut daylight = [0.0; N];
            D65.add_far(&mut daylight, nm, factor);
            for ((sum, value), nm) in sum.iter_mut().zip(daylight).zip(nm) {
                *sum += value * self.filter.at(*nm);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Table;
    use super::*;

    #[test]
    fn daylight_of_many_wavelengths_at_once_is_the_table_within_it_and_a_black_body_beyond() {
        let rows: Vec<(f64, f64)> =
            rows::<2>(include_str!("d65.csv")).into_iter().map(|[nm, value]| (nm, value)).collect();
        let table = Table::new(rows).unwrap();
        let exact = |nm: f64| match table.range() {
            (first, _) if nm < first => table.at(first) * planck(nm, 6504.0) / planck(first, 6504.0),
            (_, last) if nm > last => table.at(last) * planck(nm, 6504.0) / planck(last, 6504.0),
            _ => table.at(nm),
        };
        let bound = |nm: f64| match nm {
            80.0..120.0 => 2e-5,
            120.0..300.0 | 830.0..4130.0 => 2e-6,
            _ => 1e-12,
        };
        let (daylight, reflectance) = (&*D65, Reflectance::Rgb([0.8, 0.3, 0.1]));
        let filtered = Filtered::new([0.8, 0.3, 0.1]);
        // Near and far, in turn, so that lanes do not share what they are; and all of one kind; and by single steps, rows and all.
        let mixed: [f64; 16] = std::array::from_fn(|i| 60.0 + 371.3 * ((7 * i) % 16) as f64);
        let near: [f64; 16] = std::array::from_fn(|i| 92.0 + 190.1 * i as f64);
        let within: [f64; 16] = std::array::from_fn(|i| 300.0 + 33.1 * i as f64);
        let steps = (0..9000).map(|step| std::array::from_fn(|i| 40.0 + 0.5 * f64::from(step) + i as f64));
        for nm in [mixed, near, within].into_iter().chain(steps) {
            let (mut sum, mut coloured) = ([0.0; 16], [0.0; 16]);
            daylight.add_each(&mut sum, &nm, 2.0);
            filtered.add_each(&mut coloured, &nm, 2.0);
            for (i, nm) in nm.into_iter().enumerate() {
                let whole = 2.0 * exact(nm);
                let bound = bound(nm) * whole;
                assert!((sum[i] - whole).abs() <= bound, "{nm} nm: {} {whole}", sum[i]);
                let part = whole * reflectance.at(nm);
                assert!((coloured[i] - part).abs() <= bound, "{nm} nm: {} {part}", coloured[i]);
                assert!((daylight.at(nm) - exact(nm)).abs() <= bound, "{nm} nm");
            }
        }
    }
}
