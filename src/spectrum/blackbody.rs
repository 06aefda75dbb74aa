//! Black bodies.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

/// First radiation constant for spectral radiance, `2hc²`, in W m² sr⁻¹, times 1e-9 for "per nm" (CODATA 2018).
const TWO_H_C2_PER_NM: f64 = 1.191_042_972_397_188e-16 * 1e-9;
/// Second radiation constant `hc/k` in nm K (CODATA 2018, exact).
const HC_OVER_K_NM: f64 = 1.438_776_877_503_933_4e7;

/// The spectral radiance of a black body, W m⁻² sr⁻¹ nm⁻¹, at a wavelength in nm and a temperature in kelvin.
///
/// ~~~text
/// B(λ, T) = 2hc²/λ⁵ / (exp(hc/λkT) - 1)
/// ~~~
///
/// Accuracy: 1e-12 relative.  A moving black body is one of temperature T D: `D⁵ B(λD, T) = B(λ, TD)`.
/// Source: Planck 1901.    Law: tests `radiance::*`.
#[inline(always)]
pub fn planck(wavelength_nm: f64, temperature_k: f64) -> f64 {
    let metres = wavelength_nm * 1e-9;
    let squared = metres * metres;
    TWO_H_C2_PER_NM / (squared * squared * metres * expm1(HC_OVER_K_NM / (wavelength_nm * temperature_k)))
}

/// The same, and its slope, per nm.
///
/// ~~~text
/// dB/dλ = B/λ (x eˣ/(eˣ - 1) - 5),      x = hc/λkT
/// ~~~
pub(super) fn planck_with_slope(wavelength_nm: f64, temperature_k: f64) -> (f64, f64) {
    let value = planck(wavelength_nm, temperature_k);
    let x = HC_OVER_K_NM / (wavelength_nm * temperature_k);
    (value, value / wavelength_nm * (x + x / expm1(x) - 5.0))
}

/// `exp(x) - 1` for x ≥ 0 without a branch, so that a loop over wavelengths runs in vectors.
///
/// Accuracy: 2e-13 relative for x > 1e-3, below that of first order in rounding over x.  Beyond x = 700 it
/// stays at exp(700).
#[inline(always)]
fn expm1(x: f64) -> f64 {
    const LN2_HI: f64 = 0.693_147_180_369_123_8;
    const LN2_LO: f64 = 1.908_214_929_270_587_7e-10;
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52: adding it rounds to an integer
    let x = if x < 700.0 { x } else { 700.0 };
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = x - n * LN2_HI - n * LN2_LO;
    // Taylor to r^11/11!, |r| < 0.347: remainder 7e-15.
    let tail = 1.0 / 362_880.0 + r * (1.0 / 3_628_800.0 + r * (1.0 / 39_916_800.0));
    let tail = 1.0 / 5_040.0 + r * (1.0 / 40_320.0 + r * tail);
    let tail = 1.0 / 120.0 + r * (1.0 / 720.0 + r * tail);
    let tail = 0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * tail));
    let minus_one = r + r * r * tail;
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
    power * minus_one + (power - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vector_expm1_agrees_with_libm() {
        for i in 0..200_000 {
            let x = libm::exp(f64::from(i) / 200_000.0 * 16.0 - 9.4);
            let exact = libm::expm1(x.min(700.0));
            assert!((expm1(x) / exact - 1.0).abs() < 4e-13, "x = {x}: {} for {exact}", expm1(x));
        }
    }
}
