//! Complex refractive indices of metals.

use super::rows;
use std::sync::{Arc, LazyLock};

/// The complex refractive index `n + ik` of a metal, by the wavelength (in vacuum) in its own rest frame.
///
/// Linear between the measured wavelengths; beyond them the values of the end go on.
#[derive(Debug, Clone, PartialEq)]
pub struct Metal {
    /// Wavelength in nm, n, k.
    rows: Arc<[[f64; 3]]>,
}

/// Metals that the program holds, as in [`Metal::NAMES`].
static HELD: LazyLock<[Metal; 4]> = LazyLock::new(|| {
    [
        include_str!("gold.csv"),
        include_str!("silver.csv"),
        include_str!("copper.csv"),
        include_str!("aluminium.csv"),
    ]
    .map(|text| {
        // The first line says where the numbers come from.
        let numbers = text.split_once('\n').map_or("", |(_, numbers)| numbers);
        Metal { rows: rows::<3>(numbers).into() }
    })
});

impl Metal {
    /// The names that [`Metal::named`] knows.
    pub const NAMES: &'static [&'static str] = &["gold", "silver", "copper", "aluminium"];

    /// A measured one by its name ([`Metal::NAMES`]).
    ///
    /// Gold, silver and copper, 188 to 1937 nm: Johnson and Christy, Phys. Rev. B 6, 4370 (1972). Aluminium, 0.12 nm
    /// to 0.2 mm: Rakić, Appl. Opt. 34, 4755 (1995).
    pub fn named(name: &str) -> Option<Self> {
        let place = Self::NAMES.iter().position(|known| *known == name)?;
        HELD.get(place).cloned()
    }

    /// From rows of wavelength (nm), n and k; none if there are fewer than two, if the wavelengths don't rise, if a number
    /// is not finite, an n not above zero or a k below it.
    pub fn new(rows: impl IntoIterator<Item = [f64; 3]>) -> Option<Self> {
        let rows: Arc<[[f64; 3]]> = rows.into_iter().collect();
        let fine = rows.len() >= 2
            && rows.windows(2).all(|pair| pair[0][0] < pair[1][0])
            && rows.iter().all(|row| row.iter().all(|v| v.is_finite()) && row[1] > 0.0 && row[2] >= 0.0);
        fine.then_some(Self { rows })
    }

    /// n and k at a wavelength in vacuum, nm.
    pub fn at(&self, wavelength_nm: f64) -> (f64, f64) {
        let after = self.rows.partition_point(|row| row[0] <= wavelength_nm).clamp(1, self.rows.len() - 1);
        let (a, b) = (&self.rows[after - 1], &self.rows[after]);
        let part = ((wavelength_nm - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0);
        (a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2]))
    }

    /// What part of unpolarised light it throws back at an angle, at a wavelength in vacuum (nm).
    pub fn reflectance(&self, cosine: f64, wavelength_nm: f64) -> f64 {
        let (n, k) = self.at(wavelength_nm);
        crate::fresnel::conductor(cosine, n, k)
    }

    /// n and k at many wavelengths.
    pub fn at_each<const N: usize>(&self, wavelengths_nm: &[f64; N]) -> ([f64; N], [f64; N]) {
        let (mut n, mut k) = ([0.0; N], [0.0; N]);
        for ((n, k), nm) in n.iter_mut().zip(&mut k).zip(wavelengths_nm) {
            (*n, *k) = self.at(*nm);
        }
        (n, k)
    }

    /// First and last wavelength, nm.
    pub fn range_nm(&self) -> (f64, f64) {
        (self.rows[0][0], self.rows[self.rows.len() - 1][0])
    }
}
