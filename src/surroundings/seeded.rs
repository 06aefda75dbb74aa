//! Stars from a number: the same sky for the same seed, on every machine.

use super::stars::Star;
use glam::DVec3;
use std::f64::consts::TAU;

/// What stars are strewn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kinds {
    /// All of one temperature and one magnitude.
    Alike {
        /// Temperature.
        kelvin: f64,
        /// Visual magnitude.
        magnitude: f64,
    },
    /// Magnitudes and temperatures as stars have them.
    ///
    /// Between the two magnitudes the number of stars brighter than m grows as `10^(m/2)`, as it does for those
    /// that the naked eye sees; equally far stars in empty space would give `10^(0.6 m)`. Temperatures are
    /// between 2500 and 30,000 K, in shares near those of the spectral classes among such stars.
    Natural {
        /// The magnitude of the brightest: Sirius has -1.46.
        brightest: f64,
        /// The magnitude of the faintest: the naked eye's is 6.5, with some 9000 stars.
        faintest: f64,
    },
}

impl Default for Kinds {
    fn default() -> Self {
        Self::Natural { brightest: -1.5, faintest: 6.5 }
    }
}

/// Part of the stars that are cooler, and the temperature: ends of the classes M, K, G, F, A, and of B with O.
const CLASSES: [(f64, f64); 7] = [
    (0.0, 2500.0),
    (0.07, 3800.0),
    (0.33, 5200.0),
    (0.46, 6000.0),
    (0.61, 7400.0),
    (0.82, 10_000.0),
    (1.0, 30_000.0),
];

/// `count` stars, evenly strewn over the sphere. Star number i depends on the seed and i alone.
pub fn seeded(seed: u64, count: usize, kinds: Kinds) -> impl Iterator<Item = Star> {
    let seed = mixed(seed);
    (0..count as u64).map(move |i| {
        let [height, around, brightness, heat] = draws_of(seed, i);
        // The first is ahead, at -z.
        let direction = DVec3::new(1.0, 1.0, -1.0) * on_sphere(height, around);
        let (kelvin, magnitude) = match kinds {
            Kinds::Alike { kelvin, magnitude } => (kelvin, magnitude),
            Kinds::Natural { brightest, faintest } => {
                (temperature(heat), natural_magnitude(brightness, brightest, faintest))
            }
        };
        Star::of_magnitude(direction, kelvin, magnitude)
    })
}

/// The magnitude than which a part of the stars is brighter.
fn natural_magnitude(part: f64, brightest: f64, faintest: f64) -> f64 {
    // The number of stars up to the brightest, for one up to the faintest.
    let first = libm::pow(10.0, 0.5 * (brightest - faintest));
    faintest + 2.0 * libm::log10(first + part * (1.0 - first))
}

/// The temperature than which a part of the stars is cooler.
fn temperature(part: f64) -> f64 {
    let after = CLASSES.partition_point(|(share, _)| *share <= part).clamp(1, CLASSES.len() - 1);
    let ((share, cool), (next, hot)) = (CLASSES[after - 1], CLASSES[after]);
    cool * libm::pow(hot / cool, (part - share) / (next - share))
}

/// A direction, all of them alike, of two even numbers from 0 to 1: heights on a sphere are even (Archimedes).
pub(crate) fn on_sphere(height: f64, around: f64) -> DVec3 {
    let y = 2.0 * height - 1.0;
    let across = ((1.0 - y) * (1.0 + y)).sqrt();
    let (sin, cos) = libm::sincos(TAU * around);
    DVec3::new(across * sin, y, across * cos)
}

/// `N` numbers, even from 0 to below 1, for thing number i of a seed.
pub(crate) fn draws<const N: usize>(seed: u64, i: u64) -> [f64; N] {
    draws_of(mixed(seed), i)
}

fn draws_of<const N: usize>(seed: u64, i: u64) -> [f64; N] {
    std::array::from_fn(|j| even(seed, i.wrapping_mul(N as u64).wrapping_add(j as u64)))
}

/// Draw number `i` of a seed, even from 0 to below 1.
fn even(seed: u64, i: u64) -> f64 {
    let bits = mixed(seed.wrapping_add(i.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    (bits >> 11) as f64 / 9_007_199_254_740_992.0
}

/// Bits well mixed: the last step of splitmix64. Source: Steele, Lea and Flood, OOPSLA 2014.
fn mixed(bits: u64) -> u64 {
    let z = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
