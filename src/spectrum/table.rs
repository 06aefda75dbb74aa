//! Tabulated spectra.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use crate::simd::{Lanes, Task, with_best};

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

#[cfg(test)]
mod tests {
    use super::*;

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
