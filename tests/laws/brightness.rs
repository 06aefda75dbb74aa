//! How bright: what becomes of radiance, of solid angles, and of the number of photons.

use super::{FORWARD, Worst, aside, chapter, gamma, gauss_legendre};
use crate::support::{Dice, Eye, Heaven, Stage, black_body, flat, line, look, pixel_centre, speed};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use terrell::color::{LUMENS_PER_WATT, matching, xyz_of};
use terrell::scene::Scene;
use terrell::spacetime::SightRay;
use terrell::spectrum::{Source, Spectrum, Table, Wavelengths, planck};

chapter! {
    "Brightness":
    spectral_radiance_goes_with_the_fifth_power, "V3", "L(λ) = D⁵ L′(Dλ)", "Liouville; L_ν/ν³ invariant", 1e-11;
    moving_black_body_is_black, "V3", "L(λ) = B(λ, DT)", "Planck 1901; L_ν/ν³ invariant", 1e-11;
    whole_radiance_goes_with_the_fourth_power, "V3", "∫L dλ = D⁴ ∫L′ dλ", "L_ν/ν³ invariant", 1e-12;
    solid_angles_shrink_with_the_second_power, "V3", "dΩ′ = dΩ/D²", "Penrose 1959", 1e-7;
    planck_has_its_absolute_values, "V3", "B at 450, 550, 650 nm for 5000 K and ±0.5 c (six digits)", "CODATA 2018", 6e-6;
    sky_ahead_has_its_colour, "V3", "XYZ of B(λ, DT), 64 wavelengths against the 1 nm sum", "CIE 015:2018", 2e-3;
    whole_sky_gains_energy, "V3", "mean of D⁴ over the sphere = γ²(1 + β²/3)", "McKinley 1979", 1e-12;
    whole_sky_pushes_back, "V3", "mean of D⁴ cos θ′ = (4/3)γ²β, in units of u c", "McKinley 1979", 1e-12;
    photons_over_the_sphere_are_conserved, "V15 (f)", "∮∫ L λ dλ dΩ = 4πγ · 2hc² (kT/hc)³ 2ζ(3)", "n⁰ of the photon current is γn", 1e-12;
    photons_of_six_pictures_are_conserved, "V15 (f)", "the same as a sum over the pixels of six pictures", "midpoint rule, 6 × 64²", 1e-3;
    microwave_sky_has_its_dipole, "V3", "½[T(0) − T(π)] = T₀γβ, ½[T(0) + T(π)] = T₀γ", "Planck 2018", 1e-12;
}

const SPEEDS: [f64; 6] = [0.1, 0.3, 0.5, 0.8, 0.9, 0.99];
/// 2hc² in W m² sr⁻¹ and hc/k in m K (CODATA 2018).
const RADIATION_1: f64 = 1.191_042_972_397_188e-16;
const RADIATION_2: f64 = 1.438_776_877_503_933_4e-2;
const ZETA_3: f64 = 1.202_056_903_159_594_2;

fn sky(source: Source, beta: f64) -> (Scene, Eye) {
    let eye = Eye::at(0.0, DVec3::new(3.0, -2.0, 1.0)).moving(speed(beta, FORWARD));
    (Stage::of([]).under(Heaven::uniform(source)).seen_by(&eye), eye)
}

fn doppler(beta: f64, n: DVec3) -> f64 {
    1.0 / (gamma(beta) * (1.0 - beta * n.dot(FORWARD)))
}

/// Directions all over the sky, ahead and astern among them.
fn directions() -> Vec<DVec3> {
    let mut dice = Dice(3);
    [FORWARD, -FORWARD].into_iter().chain((0..60).map(|_| dice.direction())).collect()
}

/// Wavelengths between two, evenly in their logarithms, and the step.
fn in_logarithms<const N: usize>(shortest: f64, longest: f64) -> (Wavelengths<N>, f64) {
    let step = libm::log(longest / shortest) / (N - 1) as f64;
    let mut wavelengths = Wavelengths::new();
    wavelengths.nm = std::array::from_fn(|i| shortest * libm::exp(step * i as f64));
    (wavelengths, step)
}

fn spectral_radiance_goes_with_the_fifth_power() -> f64 {
    let mut worst = Worst::default();
    let shape = |nm: f64| 2.0 + libm::sin(nm / 90.0);
    let table = Table::new((1..1200).map(|i| (f64::from(i) * 10.0, shape(f64::from(i) * 10.0)))).unwrap();
    for b in SPEEDS {
        let (scene, eye) = sky(Source::new(&Spectrum::Table(table.clone()), 3.0), b);
        for n in directions() {
            let d = doppler(b, n);
            for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &eye.sight(n)).radiance) {
                if (10.0..11_990.0).contains(&(nm * d)) {
                    // The table's slope makes errors of D larger: 10 nm a row.
                    worst.part(got, d.powi(5) * 3.0 * table.at(nm * d));
                }
            }
        }
    }
    worst.0
}

fn moving_black_body_is_black() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (scene, eye) = sky(black_body(5000.0), b);
        for n in directions() {
            let d = doppler(b, n);
            for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &eye.sight(n)).radiance) {
                let expected = planck(*nm, 5000.0 * d);
                // Below this there is nothing to see, and the exponent has few digits.
                if expected > 1e-30 {
                    worst.part(got, expected);
                }
            }
        }
    }
    worst.0
}

/// All the power of a line, wherever it arrives.
fn whole_radiance_goes_with_the_fourth_power() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        for n in directions() {
            let d = doppler(b, n);
            let (scene, eye) = sky(line(550.0 * d, 2.0), b);
            let light = look(&scene, &eye.sight(n)).lines;
            worst.part_of_vector(light, matching(550.0) * (LUMENS_PER_WATT * 2.0 * d.powi(4)));
        }
    }
    worst.0
}

/// The area between neighbouring directions in the sky and in what is seen.
fn solid_angles_shrink_with_the_second_power() -> f64 {
    let mut worst = Worst::default();
    let small = 1e-5;
    for b in SPEEDS {
        let (_, eye) = sky(flat(1.0), b);
        let star = |n: DVec3| {
            let k = eye.sight(n).k.x;
            -k / k.length()
        };
        for n in directions() {
            let one = n.any_orthonormal_vector();
            let slope = |side: DVec3| (star(n + side * small) - star(n - side * small)) / (2.0 * small);
            worst.part(slope(one).cross(slope(n.cross(one))).length(), doppler(b, n).powi(2));
        }
    }
    worst.0
}

fn planck_has_its_absolute_values() -> f64 {
    let mut worst = Worst::default();
    let mut wavelengths = Wavelengths::<3>::new();
    wavelengths.nm = [450.0, 550.0, 650.0];
    for (b, expected) in [
        (0.0, [10_801.1, 12_713.0, 12_415.3]),
        (0.5, [164_988.4, 121_332.6, 86_382.0]),
        (-0.5, [99.943, 274.544, 480.265]),
    ] {
        let (scene, eye) = sky(black_body(5000.0), b);
        let light = scene.lit().seen(&eye.sight(FORWARD), &wavelengths);
        light.radiance.iter().zip(expected).for_each(|(got, expected)| worst.part(*got, expected));
    }
    worst.0
}

fn sky_ahead_has_its_colour() -> f64 {
    let mut worst = Worst::default();
    let wavelengths = Wavelengths::<64>::new();
    for b in [-0.8, -0.5, -0.3, -0.1, 0.0, 0.1, 0.2, 0.3, 0.5, 0.8] {
        let (scene, eye) = sky(black_body(5000.0), b);
        let light = scene.lit().seen(&eye.sight(FORWARD), &wavelengths);
        let d = ((1.0 + b) / (1.0_f64 - b)).sqrt();
        worst.part_of_vector(wavelengths.xyz(&light.radiance), xyz_of(|nm| planck(nm, 5000.0 * d)));
    }
    worst.0
}

/// The mean over the observer's sphere of something seen in the direction n. The nodes are Gauss's in the cosine of the
/// source's angle, where powers of D are polynomials; the weights are those of the observer's sphere.
pub(super) fn mean_over_the_sphere(beta: f64, of: impl Fn(DVec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for (place, (cos, weight)) in gauss_legendre(12).into_iter().enumerate() {
        let theta = libm::acos((cos + beta) / (1.0 + beta * cos));
        let weight = weight * (1.0 - beta * beta) / ((1.0 + beta * cos) * (1.0 + beta * cos));
        let around = |i: i32| TAU * f64::from(i) / 3.0 + place as f64;
        sum += (0..3).map(|i| weight / 6.0 * of(aside(FORWARD, theta, around(i)))).sum::<f64>();
    }
    sum
}

/// D⁴ as the power of a line that arrives.
fn power_gain(beta: f64, n: DVec3) -> f64 {
    let (scene, eye) = sky(line(550.0 * doppler(beta, n), 1.0), beta);
    look(&scene, &eye.sight(n)).lines.y / (LUMENS_PER_WATT * matching(550.0).y)
}

fn whole_sky_gains_energy() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let mean = mean_over_the_sphere(b, |n| power_gain(b, n));
        worst.part(mean, gamma(b) * gamma(b) * (1.0 + b * b / 3.0));
    }
    worst.0
}

fn whole_sky_pushes_back() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let push = mean_over_the_sphere(b, |n| power_gain(b, n) * n.dot(FORWARD));
        worst.part(push, 4.0 / 3.0 * gamma(b) * gamma(b) * b);
    }
    worst.0
}

/// ∫ L λ dλ of a black body, λ in nm: photons, but for a factor.
fn photons_at_rest(kelvin: f64) -> f64 {
    RADIATION_1 * 1e9 * (kelvin / RADIATION_2).powi(3) * 2.0 * ZETA_3
}

/// The photons that come along a sight ray: by the trapezium rule in log λ, whose error falls as exp(-π²/step).
fn photons<const N: usize>(
    scene: &Scene,
    ray: &SightRay,
    (wavelengths, step): &(Wavelengths<N>, f64),
) -> f64 {
    let light = scene.lit().seen(ray, wavelengths);
    light.radiance.iter().zip(wavelengths.nm).map(|(radiance, nm)| radiance * nm * nm * step).sum()
}

fn photons_over_the_sphere_are_conserved() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (scene, eye) = sky(black_body(5000.0), b);
        // Wavelengths of each direction from x = 60 to 6e-8 of exp(x): the tails beyond are 1e-14 of it.
        let mean = mean_over_the_sphere(b, |n| {
            let middle = RADIATION_2 * 1e9 / (5000.0 * doppler(b, n));
            photons(&scene, &eye.sight(n), &in_logarithms::<128>(middle / 60.0, middle / 6e-8))
        });
        worst.part(mean, gamma(b) * photons_at_rest(5000.0));
    }
    worst.0
}

fn photons_of_six_pictures_are_conserved() -> f64 {
    let mut worst = Worst::default();
    let size = 64;
    for b in [0.3, 0.6] {
        let (scene, eye) = sky(black_body(5000.0), b);
        let wavelengths = in_logarithms::<64>(20.0, 1e10);
        let mut sum = 0.0;
        for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
            let view = eye.toward(axis).wide(90.0).observer().view(0.0, size, size);
            for number in 0..(size * size) as usize {
                let pixel = pixel_centre(number, size);
                let cosine = -view.direction(pixel).z;
                let side = 2.0 / f64::from(size);
                sum += photons(&scene, &view.ray(pixel), &wavelengths) * side * side * cosine.powi(3);
            }
        }
        worst.part(sum, 4.0 * PI * gamma(b) * photons_at_rest(5000.0));
    }
    worst.0
}

/// By the ratio of radiances at two wavelengths, read back as a temperature by halving.
fn microwave_sky_has_its_dipole() -> f64 {
    let mut worst = Worst::default();
    let b = 369.82e3 / 299_792_458.0;
    let (scene, eye) = sky(black_body(2.7255), b);
    let mut wavelengths = Wavelengths::<2>::new();
    wavelengths.nm = [1e6, 2e6];
    let kelvin = |n: DVec3| {
        let light = scene.lit().seen(&eye.sight(n), &wavelengths).radiance;
        let cooler = |kelvin: f64| planck(1e6, kelvin) / planck(2e6, kelvin) < light[0] / light[1];
        crate::support::edge(2.0, 4.0, cooler)
    };
    let (ahead, astern) = (kelvin(FORWARD), kelvin(-FORWARD));
    worst.apart(0.5 * (ahead - astern), 2.7255 * gamma(b) * b);
    worst.apart(0.5 * (ahead + astern), 2.7255 * gamma(b));
    worst.must((0.5e3 * (ahead - astern) - 3.3621).abs() < 5e-5);
    worst.must((0.5e6 * (ahead + astern - 2.0 * 2.7255) - 2.07).abs() < 0.01);
    worst.0
}
