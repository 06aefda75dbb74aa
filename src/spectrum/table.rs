//! Tabulated spectra, and the CIE daylight that the program holds.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::{Reflectance, planck};
use crate::simd::{Lanes, Task, with_best};
use std::sync::LazyLock;

/// Values at wavelengths, linear in between and holding their ends beyond.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    nm: Vec<f64>,
    value: Vec<f64>,
}

impl Table {
    /// From rows of increasing wavelength (nm); none if there are fewer than two, if they don't increase, or
    /// if a number is not finite.
    pub fn new(rows: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let (nm, value): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
        let fine = nm.len() >= 2
            && nm.windows(2).all(|pair| pair[0] < pair[1])
            && nm.iter().chain(&value).all(|v| v.is_finite());
        fine.then_some(Self { nm, value })
    }

    /// The value at a wavelength in nm; beyond the ends the end value.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let after = self.nm.partition_point(|nm| *nm <= wavelength_nm).clamp(1, self.nm.len() - 1);
        let (a, b) = (self.nm[after - 1], self.nm[after]);
        let part = ((wavelength_nm - a) / (b - a)).clamp(0.0, 1.0);
        self.value[after - 1] + part * (self.value[after] - self.value[after - 1])
    }

    /// The same wavelengths with all values multiplied.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.value.iter_mut().for_each(|value| *value *= factor);
        self
    }

    /// The integral over the table's wavelengths (nm), exact for what is linear between the rows.
    pub fn integral(&self) -> f64 {
        let piece = |i: usize| 0.5 * (self.value[i] + self.value[i - 1]) * (self.nm[i] - self.nm[i - 1]);
        (1..self.nm.len()).map(piece).sum()
    }

    /// The width at half height of the narrowest peak (nm) that rises above what is around it by a quarter of the table's
    /// greatest value; none if there is no such peak.
    pub fn narrowest_peak_nm(&self) -> Option<f64> {
        let most = self.value.iter().copied().fold(0.0, f64::max);
        let peaks = 1..self.value.len() - 1;
        let peaks =
            peaks.filter(|i| self.value[*i] > self.value[i - 1] && self.value[*i] >= self.value[i + 1]);
        let width = |i: usize| {
            let top = self.value[i];
            let lower = |value: &&f64| **value <= top;
            let left = self.value[..i].iter().rev().take_while(lower).copied().fold(top, f64::min);
            let right = self.value[i + 1..].iter().take_while(lower).copied().fold(top, f64::min);
            let foot = left.max(right);
            let half = 0.5 * (foot + top);
            // Where the value crosses the half between two neighbours.
            let crossing = |out: usize, within: usize| {
                let part = (half - self.value[out]) / (self.value[within] - self.value[out]);
                self.nm[out] + part * (self.nm[within] - self.nm[out])
            };
            let before = (0..i).rev().find(|j| self.value[*j] <= half)?;
            let after = (i + 1..self.value.len()).find(|j| self.value[*j] <= half)?;
            (top - foot > 0.25 * most).then(|| crossing(after, after - 1) - crossing(before, before + 1))
        };
        peaks.filter_map(width).reduce(f64::min)
    }

    /// First and last wavelength, nm.
    pub fn range(&self) -> (f64, f64) {
        (self.nm[0], self.nm[self.nm.len() - 1])
    }
}

/// The numbers of a table held by the program: lines of `N` numbers between commas.
pub fn rows<const N: usize>(text: &str) -> Vec<[f64; N]> {
    let row = |line: &str| {
        let mut numbers = line.split(',').map(|number| number.trim().parse().unwrap_or(f64::NAN));
        std::array::from_fn(|_| numbers.next().unwrap_or(f64::NAN))
    };
    text.lines().filter(|line| !line.is_empty()).map(row).collect()
}

/// The number of rows that places between them are looked up in, a power of two.
pub(super) const ROWS: usize = 128;

/// The row below a place, and how far beyond it, for places that are not negative: at a row it may be the end of the one below.
/// (No conversion to an integer, so that many places are found at once.)
#[inline(always)]
pub(super) fn between_rows(place: f64) -> (usize, f64) {
    // From here on numbers are whole.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let row = (place - 0.5).max(0.0) + WHOLE;
    (row.to_bits() as usize % ROWS, place - (row - WHOLE))
}

/// CIE standard illuminant D65, 100 at 560 nm.
///
/// 300 to 830 nm from CIE 15:2018, 5 nm, linear in between. Beyond, where the CIE says nothing and a Doppler shift
/// may ask, it goes on as a black body of 6504 K that meets the table's ends.
#[derive(Debug)]
pub struct Daylight {
    // With the step to the next row.
    table: [[f64; 2]; ROWS],
    below: f64,
    above: f64,
}

/// CIE standard illuminant D65, at any wavelength.
pub static D65: LazyLock<Daylight> = LazyLock::new(|| {
    let table: Vec<f64> = rows::<2>(include_str!("d65.csv")).iter().map(|row| row[1]).collect();
    let (first, last) = (table[0], table[table.len() - 1]);
    let row = |i: usize| table.get(i).copied().unwrap_or(last);
    let steps = std::array::from_fn(|i| [row(i), row(i + 1) - row(i)]);
    Daylight { below: first / planck(300.0, 6504.0), above: last / planck(830.0, 6504.0), table: steps }
});

#[inline(always)]
fn in_table(nm: f64) -> bool {
    (300.0..=830.0).contains(&nm)
}

/// (No early end, so that all are compared at once.)
fn all_in_table<const N: usize>(nm: &[f64; N]) -> bool {
    nm.iter().fold(true, |all, nm| all & in_table(*nm))
}

#[inline(always)]
fn place(nm: f64) -> f64 {
    (nm - 300.0) * (1.0 / 5.0)
}

/// Adds a spectrum, so many times, in vectors.
#[inline]
pub(super) fn add<const N: usize>(
    sum: &mut [f64; N],
    nm: &[f64; N],
    factor: f64,
    value: impl Fn(f64) -> f64,
) {
    with_best(Adding { sum, nm, factor, value });
}

/// A spectrum to be added.
struct Adding<'a, F, const N: usize> {
    sum: &'a mut [f64; N],
    nm: &'a [f64; N],
    factor: f64,
    value: F,
}

impl<F: Fn(f64) -> f64, const N: usize> Task for Adding<'_, F, N> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        let mut values = [0.0; N];
        for (value, nm) in values.iter_mut().zip(self.nm) {
            *value = (self.value)(*nm);
        }
        for (sum, value) in self.sum.iter_mut().zip(values) {
            *sum += self.factor * value;
        }
    }
}

/// Daylight through a filter of one colour. (The rows of both are the same, so that one search finds both.)
#[derive(Debug, Clone)]
pub(super) struct Filtered {
    filter: Reflectance,
    // Daylight and its step to the next row, the filter and its step.
    rows: Box<[[f64; 4]; ROWS]>,
}

impl Filtered {
    /// Through a filter of linear sRGB.
    pub(super) fn new(rgb: [f64; 3]) -> Self {
        let filter = Reflectance::Rgb(rgb);
        let part = |i: usize| filter.at(300.0 + 5.0 * i as f64);
        let row = |i: usize| {
            let [value, step] = D65.table[i];
            [value, step, part(i), part(i + 1) - part(i)]
        };
        let rows = Box::new(std::array::from_fn(row));
        Self { filter, rows }
    }

    /// Adds it, so many times, at many wavelengths.
    #[inline]
    pub(super) fn add_each<const N: usize>(&self, sum: &mut [f64; N], nm: &[f64; N], factor: f64) {
        if !all_in_table(nm) {
            let filter = self.filter.at_each(nm);
            let mut daylight = [0.0; N];
            D65.add_each(&mut daylight, nm, factor);
            for ((sum, value), filter) in sum.iter_mut().zip(daylight).zip(filter) {
                *sum += value * filter;
            }
            return;
        }
        add(sum, nm, factor, |nm| {
            let (row, part) = between_rows(place(nm));
            let [value, step, filter, filter_step] = self.rows[row];
            (value + part * step) * (filter + part * filter_step)
        });
    }
}

impl Daylight {
    /// Relative spectral power at a wavelength in nm.
    #[inline]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        if in_table(wavelength_nm) { self.within(wavelength_nm) } else { self.beyond(wavelength_nm) }
    }

    #[inline(always)]
    fn within(&self, wavelength_nm: f64) -> f64 {
        let (row, part) = between_rows(place(wavelength_nm));
        let [value, step] = self.table[row];
        value + part * step
    }

    /// Adds it, so many times, at many wavelengths.
    #[inline]
    pub(super) fn add_each<const N: usize>(&self, sum: &mut [f64; N], nm: &[f64; N], factor: f64) {
        if all_in_table(nm) {
            add(sum, nm, factor, |nm| self.within(nm));
        } else {
            let mut beyond = [0.0; N];
            add(&mut beyond, nm, factor, |nm| self.beyond(nm));
            let mut within = [0.0; N];
            add(&mut within, nm, factor, |nm| self.within(nm));
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum += if in_table(nm[i]) { within[i] } else { beyond[i] };
            }
        }
    }

    #[inline(always)]
    fn beyond(&self, wavelength_nm: f64) -> f64 {
        let (below, above) = (self.below, self.above);
        let scale = if wavelength_nm < 300.0 { below } else { above };
        scale * planck(wavelength_nm, 6504.0)
    }
}

#[cfg(test)]
mod tests {
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
        // Below, within and above, in turn, so that lanes do not share what they are; and all of one kind.
        let mixed: [f64; 16] = std::array::from_fn(|i| 120.0 + 97.3 * ((7 * i) % 16) as f64);
        let within: [f64; 16] = std::array::from_fn(|i| 300.0 + 33.1 * i as f64);
        let above: [f64; 16] = std::array::from_fn(|i| 831.0 + 250.0 * i as f64);
        let (daylight, reflectance) = (&*D65, Reflectance::Rgb([0.8, 0.3, 0.1]));
        let filtered = Filtered::new([0.8, 0.3, 0.1]);
        for nm in [mixed, within, above] {
            let (mut sum, mut coloured) = ([1.0; 16], [1.0; 16]);
            daylight.add_each(&mut sum, &nm, 2.0);
            filtered.add_each(&mut coloured, &nm, 2.0);
            for (i, nm) in nm.into_iter().enumerate() {
                let whole = 2.0 * exact(nm);
                assert!((sum[i] - 1.0 - whole).abs() < 1e-9 * (1.0 + whole), "{nm} nm: {} {whole}", sum[i]);
                let part = whole * reflectance.at(nm);
                assert!((coloured[i] - 1.0 - part).abs() < 1e-9 * (1.0 + whole), "{nm} nm: {}", coloured[i]);
                assert!((daylight.at(nm) - exact(nm)).abs() < 1e-9 * (1.0 + whole), "{nm} nm");
            }
        }
    }

    #[test]
    fn narrowest_peak_is_found_between_broad_ones_and_ripples_are_none() {
        let table = |rows: &[(f64, f64)]| Table::new(rows.iter().copied()).unwrap().narrowest_peak_nm();
        let broad = [(400.0, 0.0), (500.0, 2.0), (600.0, 0.0)];
        assert_eq!(table(&broad), Some(100.0));
        let sharp = [(400.0, 0.0), (500.0, 2.0), (540.0, 1.2), (544.0, 3.2), (550.0, 1.2), (600.0, 0.0)];
        assert!((table(&sharp).unwrap() - 8.0).abs() < 1e-9);
        let ripple = [(400.0, 1.0), (500.0, 1.1), (501.0, 1.0), (700.0, 4.0)];
        assert_eq!(table(&ripple), None);
    }
}
