//! The eye: CIE 1931 colour matching, and from there to linear sRGB and its encoding. Nothing else knows how
//! light becomes three numbers.

mod difference;

pub use difference::{Discrimination, Lab, ciede2000};

use glam::{DMat3, DVec3};
use std::sync::LazyLock;

use crate::spectrum::D65;

/// Luminous efficacy of radiation at 555 nm, lm/W (SI).
pub const LUMENS_PER_WATT: f64 = 683.0;

/// First wavelength of the colour matching functions, nm.
pub const SHORTEST_NM: f64 = 360.0;
/// Last wavelength of the colour matching functions, nm.
pub const LONGEST_NM: f64 = 830.0;

static MATCHING: LazyLock<Vec<DVec3>> = LazyLock::new(|| {
    let rows = crate::spectrum::rows::<4>(include_str!("color/cie1931.csv"));
    rows.iter().map(|row| DVec3::new(row[1], row[2], row[3])).collect()
});

/// The CIE 1931 2° colour matching functions x̄, ȳ, z̄ at a wavelength in nm; zero outside 360 to 830 nm.
///
/// Source: CIE 018:2019 table 6, 1 nm, linear in between.
pub fn matching(wavelength_nm: f64) -> DVec3 {
    if !(SHORTEST_NM..=LONGEST_NM).contains(&wavelength_nm) {
        return DVec3::ZERO;
    }
    let place = wavelength_nm - SHORTEST_NM;
    let row = (place as usize).min(MATCHING.len() - 2);
    MATCHING[row].lerp(MATCHING[row + 1], place - row as f64)
}

/// XYZ of a spectral quantity, by the trapezium rule over the 1 nm table: in lm, lx, cd or cd/m² for a quantity
/// in W, W/m², W/sr or W/(m² sr), each per nm.
pub fn xyz_of(quantity: impl Fn(f64) -> f64) -> DVec3 {
    let rows = MATCHING.iter().enumerate().map(|(i, weight)| {
        let end = if i == 0 || i + 1 == MATCHING.len() { 0.5 } else { 1.0 };
        *weight * (end * quantity(SHORTEST_NM + i as f64))
    });
    rows.sum::<DVec3>() * LUMENS_PER_WATT
}

/// Linear sRGB to XYZ: primaries of Rec. 709, the white of the D65 table itself.
pub static XYZ_FROM_RGB: LazyLock<DMat3> = LazyLock::new(|| {
    let white = xyz_of(|nm| D65.at(nm));
    let primary = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let primaries = DMat3::from_cols(primary(0.64, 0.33), primary(0.30, 0.60), primary(0.15, 0.06));
    let amounts = primaries.inverse() * (white / white.y);
    primaries * DMat3::from_diagonal(amounts)
});

/// XYZ to linear sRGB, the inverse of [`XYZ_FROM_RGB`].
pub static RGB_FROM_XYZ: LazyLock<DMat3> = LazyLock::new(|| XYZ_FROM_RGB.inverse());

/// From a linear value to the number stored (IEC 61966-2-1), both in 0 to 1.
pub fn srgb_encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// From the number stored to the linear value (IEC 61966-2-1), both in 0 to 1.
pub fn srgb_decode(stored: f64) -> f64 {
    if stored <= 0.040_45 { stored / 12.92 } else { libm::pow((stored + 0.055) / 1.055, 2.4) }
}
