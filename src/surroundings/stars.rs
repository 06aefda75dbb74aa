//! Stars: points, or discs, that shine as black bodies.

use super::bands::Bands;
use super::seeded::{Kinds, seeded};
use crate::color;
use crate::spectrum::planck;
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

/// The illuminance that a star of visual magnitude 0 gives outside the atmosphere, lx.
///
/// Source: Allen, Astrophysical Quantities, 3rd ed. (1973): 2.54e-10 phot.
pub const MAGNITUDE_ZERO_LX: f64 = 2.54e-6;
/// No star is cooler, kelvin.
pub const COOLEST_K: f64 = 500.0;
/// No star is hotter, kelvin.
pub const HOTTEST_K: f64 = 1e7;
/// Most stars of a sky.
pub const MOST_STARS: usize = 1_000_000;

/// The kernel ends at this many times its width.
const CUT: f64 = 4.0;
/// Narrowest kernel, radians: directions are not known better.
const NARROWEST: f64 = 1e-9;
/// Widest kernel, radians: all around alike.
const WIDEST: f64 = 1e3;

/// A star.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Star {
    /// Where it stands, of any length.
    pub direction: DVec3,
    /// Temperature.
    pub kelvin: f64,
    /// Lux on a surface that faces it.
    pub illuminance: f64,
}

impl Star {
    /// A star of a visual magnitude.
    pub fn of_magnitude(direction: DVec3, kelvin: f64, magnitude: f64) -> Self {
        Self { direction, kelvin, illuminance: MAGNITUDE_ZERO_LX * libm::pow(10.0, -0.4 * magnitude) }
    }
}

/// Stars, sorted by where they stand.
#[derive(Debug, Clone)]
pub struct Stars {
    bands: Bands,
    points: Vec<Point>,
    disc: Option<Disc>,
}

/// What stars are like that are no points.
#[derive(Debug, Clone, Copy)]
struct Disc {
    /// Angular radius, radians.
    radius: f64,
    /// The square of the chord that belongs to it.
    chord2: f64,
    /// Steradians.
    solid_angle: f64,
}

/// A star as it is needed when it is looked at.
#[derive(Debug, Clone, Copy)]
struct Point {
    direction: DVec3,
    kelvin: f64,
    /// Spectral irradiance over the radiance of a black body.
    factor: f64,
}

impl Stars {
    /// The first [`MOST_STARS`] stars, temperatures brought between [`COOLEST_K`] and [`HOTTEST_K`]; those without a direction
    /// or without a finite brightness above zero are left out.
    pub fn new(stars: impl IntoIterator<Item = Star>) -> Self {
        let points: Vec<Point> = stars.into_iter().take(MOST_STARS).filter_map(point).collect();
        let directions: Vec<DVec3> = points.iter().map(|point| point.direction).collect();
        let (bands, order) = Bands::new(&directions);
        Self { bands, points: order.iter().map(|i| points[*i as usize]).collect(), disc: None }
    }

    /// The same stars as discs of an angular radius (radians, up to a right angle), `brightness` times as bright as black
    /// bodies of their temperatures, whatever their magnitudes were.
    #[must_use]
    pub fn as_discs(mut self, radius: f64, brightness: f64) -> Self {
        let half_chord = libm::sin(0.5 * radius);
        let chord2 = 4.0 * half_chord * half_chord;
        let solid_angle = PI * chord2;
        self.points.iter_mut().for_each(|point| point.factor = brightness * solid_angle);
        self.disc = Some(Disc { radius, chord2, solid_angle });
        self
    }

    /// Stars strewn evenly over the sky: see [`seeded`].
    pub fn seeded(seed: u64, count: usize, kinds: Kinds) -> Self {
        Self::new(seeded(seed, count, kinds))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The spectral radiance (W m⁻² sr⁻¹ nm⁻¹) of the stars near a direction `d` (a unit vector), each spread over the solid
    /// angle by a kernel of width `sigma` (radians):
    ///
    /// ~~~text
    /// L(λ) = Σ E(λ) κ/(2π (1 - exp(-κc))) exp(-κ (1 - cos θ))     for 1 - cos θ < c = 8σ² (at most 2),  κ = 1/σ²
    /// ~~~
    ///
    /// This is von Mises and Fisher's distribution, cut at 4σ: a Gaussian where it is narrow, and for any width a
    /// kernel whose integral over the sphere is 1. So a pixel of any size gets the whole of a star's light, once.
    /// A disc has an edge instead, unless it is narrower than a pixel.
    pub fn radiance<const N: usize>(&self, d: DVec3, sigma: f64, nm: &[f64; N]) -> [f64; N] {
        // σ is half a pixel.
        if let Some(disc) = self.disc.filter(|disc| disc.radius > 2.0 * sigma) {
            return self.on_disc(&disc, d, nm);
        }
        let kernel = Kernel::new(sigma);
        let mut sum = [0.0; N];
        self.bands.near(d, kernel.radius, |stretch| {
            for star in &self.points[stretch] {
                let chord2 = (d - star.direction).length_squared();
                if chord2 < kernel.cut {
                    star.add_to(&mut sum, kernel.at(chord2), nm);
                }
            }
        });
        sum
    }

    /// The radiance of the disc on which a direction lies; of several, of any one of them.
    fn on_disc<const N: usize>(&self, disc: &Disc, d: DVec3, nm: &[f64; N]) -> [f64; N] {
        let mut star: Option<&Point> = None;
        self.bands.near(d, disc.radius, |stretch| {
            let on_it = |star: &&Point| (d - star.direction).length_squared() < disc.chord2;
            star = star.or_else(|| self.points[stretch].iter().find(on_it));
        });
        let mut sum = [0.0; N];
        if let Some(star) = star {
            star.add_to(&mut sum, 1.0 / disc.solid_angle, nm);
        }
        sum
    }
}

impl Point {
    #[inline]
    fn add_to<const N: usize>(&self, sum: &mut [f64; N], weight: f64, nm: &[f64; N]) {
        let weight = weight * self.factor;
        for (sum, nm) in sum.iter_mut().zip(nm) {
            *sum += weight * planck(*nm, self.kelvin);
        }
    }
}

/// How a point is spread, in terms of the squares of chords on the unit sphere: `2 (1 - cos θ)`, without the
/// rounding of that where it is small.
struct Kernel {
    kappa: f64,
    peak: f64,
    /// Where it ends.
    cut: f64,
    /// The same as an angle.
    radius: f64,
}

impl Kernel {
    fn new(sigma: f64) -> Self {
        let sigma = if sigma > NARROWEST { sigma.min(WIDEST) } else { NARROWEST };
        let kappa = 1.0 / (sigma * sigma);
        let chord = CUT * sigma;
        let (cut, radius) = if chord < 2.0 {
            (chord * chord, 2.0 * libm::asin(0.5 * chord))
        } else {
            // The antipode too, whatever rounding makes of its distance.
            (f64::INFINITY, PI)
        };
        let peak = kappa / (TAU * -libm::expm1(-0.5 * kappa * cut.min(4.0)));
        Self { kappa, peak, cut, radius }
    }

    fn at(&self, chord2: f64) -> f64 {
        self.peak * libm::exp(-0.5 * self.kappa * chord2)
    }
}

fn point(star: Star) -> Option<Point> {
    let direction = star.direction.try_normalize()?;
    let kelvin = if star.kelvin > COOLEST_K { star.kelvin.min(HOTTEST_K) } else { COOLEST_K };
    let factor = star.illuminance / luminance(kelvin);
    (factor > 0.0 && factor.is_finite()).then_some(Point { direction, kelvin, factor })
}

/// Steps between the coolest and the hottest, in the logarithm of the temperature.
const STEPS: usize = 1000;

/// The logarithm of the luminance at each step, and of one more before and behind.
static LUMINANCES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let luminance = |i: usize| {
        let kelvin = COOLEST_K * libm::exp((i as f64 - 1.0) * step());
        libm::log(color::xyz_of(|nm| planck(nm, kelvin)).y)
    };
    (0..STEPS + 3).map(luminance).collect()
});

fn step() -> f64 {
    libm::log(HOTTEST_K / COOLEST_K) / STEPS as f64
}

/// The luminance of a black body, cd/m², by cubics through a table: to 1e-6 of it.
fn luminance(kelvin: f64) -> f64 {
    let place = (libm::log(kelvin / COOLEST_K) / step()).clamp(0.0, STEPS as f64);
    let row = (place as usize).min(STEPS - 1);
    let part = place - row as f64;
    let [a, b, c, d] = std::array::from_fn(|i| LUMINANCES[row + i]);
    // Catmull and Rom's.
    let bend = 2.0 * a - 5.0 * b + 4.0 * c - d + part * (3.0 * (b - c) + d - a);
    libm::exp(b + 0.5 * part * (c - a + part * bend))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_from_the_table_is_the_integral() {
        for i in 0..200 {
            let kelvin = COOLEST_K * libm::exp(f64::from(i) / 199.0 * libm::log(HOTTEST_K / COOLEST_K));
            let exact = color::xyz_of(|nm| planck(nm, kelvin)).y;
            let error = luminance(kelvin) / exact - 1.0;
            assert!(error.abs() < 1e-6, "{kelvin}: {error:e}");
        }
    }
}
