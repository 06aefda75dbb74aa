//! How bright: L λ⁵ stays along a ray in vacuum.
//!
//! ~~~text
//! L(λ) = D⁵ L'(Dλ)        a black body at T looks black at DT        all wavelengths together D⁴
//! ~~~

use crate::support::{
    Body, Dice, Eye, Stage, black_body, built, close, first, glowing, icosphere, look, near, near_vector,
    picture, speed, v,
};
use glam::DVec3;
use terrell::color::xyz_of;
use terrell::spacetime::Velocity;
use terrell::spectrum::{Source, Spectrum, Table, Wavelengths, planck};

const FORWARD: DVec3 = v(4.0 / 9.0, -1.0 / 9.0, 8.0 / 9.0);

/// A closed sky at rest, and who flies through it.
fn sky(radiance: Source, velocity: Velocity) -> (Stage, Eye) {
    let sky = Body::new(&built(icosphere(2)), glowing(radiance)).sized(300.0);
    (Stage::of([sky]), Eye::at(0.0, v(20.0, -30.0, 5.0)).moving(velocity))
}

/// The directions of the tests, in the observer's axes, with D there.
fn directions(beta: f64) -> Vec<(DVec3, f64)> {
    let gamma = 1.0 / (1.0 - beta * beta).sqrt();
    let mut dice = Dice(3);
    let many = (0..40).map(|_| dice.direction());
    [FORWARD, -FORWARD]
        .into_iter()
        .chain(many)
        .map(|n| (n, 1.0 / (gamma * (1.0 - beta * n.dot(FORWARD)))))
        .collect()
}

#[test]
fn moving_black_body_is_planck_at_the_shifted_temperature() {
    for beta in [0.1, 0.5, 0.9, 0.99] {
        let (stage, eye) = sky(black_body(5000.0), speed(beta, FORWARD));
        let scene = stage.seen_by(&eye);
        for (n, doppler) in directions(beta) {
            let light = look(&scene, &eye.sight(n));
            for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(light.radiance) {
                // Where D is small the exponent is large, and with it its rounding.
                close(got, planck(*nm, 5000.0 * doppler), 1e-11 / doppler);
            }
        }
    }
}

/// W m⁻² sr⁻¹ nm⁻¹ at 450, 550 and 650 nm.
#[test]
fn planck_has_its_absolute_values() {
    let nm = [450.0, 550.0, 650.0];
    for (beta, expected) in [
        (0.0, [10_801.1, 12_713.0, 12_415.3]),
        (0.5, [164_988.4, 121_332.6, 86_382.0]),
        (-0.5, [99.943, 274.544, 480.265]),
    ] {
        let (stage, eye) = sky(black_body(5000.0), Velocity::from_beta(FORWARD * beta).unwrap());
        let wavelengths = Wavelengths::<3>::new();
        assert!(wavelengths.nm.iter().zip(nm).all(|(got, nm)| (got - nm).abs() < 1e-9));
        let light = stage.seen_by(&eye).lit().seen(&eye.sight(FORWARD), &wavelengths);
        for (got, expected) in light.radiance.iter().zip(expected) {
            close(*got, expected, 6e-6);
        }
    }
}

/// Not only for black bodies: a spectrum with a shape of its own.
#[test]
fn radiance_times_wavelength_to_the_fifth_is_invariant() {
    let shape = |nm: f64| 2.0 + libm::sin(nm / 90.0);
    let table = Table::new((10..400).map(|i| (f64::from(i) * 10.0, shape(f64::from(i) * 10.0)))).unwrap();
    let spectrum = Spectrum::Table(table.clone());
    for beta in [0.3, 0.6, 0.8] {
        let (stage, eye) = sky(Source::new(&spectrum, 3.0), speed(beta, FORWARD));
        let scene = stage.seen_by(&eye);
        for (n, doppler) in directions(beta) {
            let light = look(&scene, &eye.sight(n));
            for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(light.radiance) {
                let emitted_nm = nm * doppler;
                close(got * nm.powi(5), 3.0 * table.at(emitted_nm) * emitted_nm.powi(5), 1e-12);
            }
        }
    }
}

/// Temperature and colour of the sky ahead, and how much brighter than at rest it is to the eye.
#[test]
fn sky_ahead_brightens_as_the_table_says() {
    let table = [
        (-0.8, 1666.7, (0.561, 0.407), 4.3e-5, 0.02),
        (-0.5, 2886.8, (0.444, 0.408), 0.02366, 0.002),
        (-0.1, 4522.7, (0.360, 0.363), 0.5792, 0.002),
        (0.1, 5527.7, (0.332, 0.341), 1.6436, 0.002),
        (0.2, 6123.7, (0.320, 0.330), 2.607, 0.002),
        (0.5, 8660.3, (0.290, 0.299), 9.388, 0.002),
        (0.8, 15_000.0, (0.264, 0.267), 38.86, 0.002),
    ];
    let exact = |kelvin: f64| xyz_of(|nm| planck(nm, kelvin));
    for (beta, kelvin, (x, y), ratio, table_accuracy) in table {
        let doppler = ((1.0 + beta) / (1.0_f64 - beta)).sqrt();
        near(5000.0 * doppler, kelvin, 0.06);
        close(exact(5000.0 * doppler).y / exact(5000.0).y, ratio, table_accuracy);
        let velocity = Velocity::from_beta(FORWARD * beta).unwrap();
        let (stage, eye) = sky(black_body(5000.0), velocity);
        let scene = stage.seen_by(&eye.toward(FORWARD).wide(0.01));
        let light = look(&scene, &eye.sight(FORWARD));
        let xyz = Wavelengths::<64>::new().xyz(&light.radiance);
        let expected = exact(5000.0 * doppler);
        near_vector(xyz, expected, expected.length() * 1e-3);
        // (The table's own colours are from a fit, good to some 0.004.)
        near(xyz.x / (xyz.x + xyz.y + xyz.z), x, 0.005);
        near(xyz.y / (xyz.x + xyz.y + xyz.z), y, 0.005);
        // A picture's pixel, with eight wavelengths.
        let (_, negative) = picture(&scene, 4, 4);
        let pixel = DVec3::from(negative.xyz[5].map(f64::from));
        near_vector(pixel, expected, expected.length() * 0.045);
    }
}

/// The mean of D⁴ over the observer's sky is γ²(1 + β²/3), and the net flux (4/3)γ²β in units of u c.
#[test]
fn whole_sky_gains_energy_and_pushes_back() {
    let table = [
        (0.5, 1.444_444_4, 0.888_888_9),
        (0.6, 1.75, 1.25),
        (0.8, 3.370_370_4, 2.962_963),
        (0.9, 6.684_210_5, 6.315_789_5),
    ];
    for (beta, mean, flux) in table {
        let (stage, eye) = sky(black_body(5000.0), speed(beta, FORWARD));
        let scene = stage.seen_by(&eye);
        let side = FORWARD.any_orthonormal_vector();
        let (mut energy, mut push) = (0.0, 0.0);
        let steps = 4000;
        for i in 0..steps {
            let cos = -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(steps);
            let around = glam::DQuat::from_axis_angle(FORWARD, f64::from(i)) * side;
            let n = FORWARD * cos + around * (1.0 - cos * cos).sqrt();
            let power = first(&scene, &eye.sight(n)).doppler.factor().powi(4) / f64::from(steps);
            energy += power;
            push += power * cos;
        }
        close(energy, mean, 2e-4);
        close(push, flux, 2e-4);
        let gamma_squared = 1.0 / (1.0 - beta * beta);
        close(energy, gamma_squared * (1.0 + beta * beta / 3.0), 2e-4);
    }
}

/// A band of light that stays within the visible: its whole radiance goes with D⁴, its photons with D³.
#[test]
fn band_carries_energy_with_the_fourth_power_and_photons_with_the_third() {
    let band = Table::new([(520.0, 0.0), (540.0, 1.0), (560.0, 1.0), (580.0, 0.0)]).unwrap();
    for beta in [-0.15, 0.05, 0.15] {
        let doppler = ((1.0 + beta) / (1.0_f64 - beta)).sqrt();
        let velocity = Velocity::from_beta(FORWARD * beta).unwrap();
        let (stage, eye) = sky(Source::new(&Spectrum::Table(band.clone()), 1.0), velocity);
        let wavelengths = Wavelengths::<3000>::new();
        let light = stage.seen_by(&eye).lit().seen(&eye.sight(FORWARD), &wavelengths);
        let step = 0.1;
        let energy: f64 = light.radiance.iter().sum::<f64>() * step;
        let photons: f64 =
            light.radiance.iter().zip(wavelengths.nm).map(|(l, nm)| l * nm).sum::<f64>() * step;
        close(energy, 40.0 * doppler.powi(4), 1e-4);
        close(photons, 40.0 * 550.0 * doppler.powi(3), 1e-4);
    }
}

/// 369.82 km/s against 2.7255 K: the dipole of 3.3621 mK.
#[test]
fn microwave_sky_has_its_dipole() {
    let beta = 369.82e3 / 299_792_458.0;
    let (stage, eye) = sky(black_body(2.7255), speed(beta, FORWARD));
    let scene = stage.seen_by(&eye);
    let kelvin = |n: DVec3| 2.7255 * first(&scene, &eye.sight(n)).doppler.factor();
    near(0.5 * (kelvin(FORWARD) - kelvin(-FORWARD)) * 1e3, 3.3621, 5e-5);
    near((0.5 * (kelvin(FORWARD) + kelvin(-FORWARD)) - 2.7255) * 1e6, 2.07, 0.01);
}
