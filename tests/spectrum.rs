//! Spectra and reflectances.

use crate::support::{close, near, near_vector};
use glam::DVec3;
use terrell::color::{RGB_FROM_XYZ, matching, xyz_of};
use terrell::spectrum::{D65, Illuminant, Reflectance, Source, Spectrum, Table, Wavelengths, planck};

/// What linear sRGB a light has, a white of Y = 1 being (1, 1, 1).
fn rgb_under_daylight(reflectance: &Reflectance) -> DVec3 {
    let white = xyz_of(|nm| D65.at(nm));
    *RGB_FROM_XYZ * (xyz_of(|nm| D65.at(nm) * reflectance.at(nm)) / white.y)
}

#[test]
fn colours_come_back_from_their_reflectances() {
    for rgb in [
        [1.0, 1.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.2, 0.7, 0.1],
        [0.9, 0.4, 0.05],
    ] {
        near_vector(rgb_under_daylight(&Reflectance::Rgb(rgb)), rgb.into(), 1e-6);
        // In a picture of any number of wavelengths exactly so.
        let rule = Wavelengths::<8>::new();
        let white = rule.xyz(&rule.nm.map(|nm| D65.at(nm)));
        let seen = rule.xyz(&rule.nm.map(|nm| D65.at(nm) * Reflectance::Rgb(rgb).at(nm)));
        near_vector(*RGB_FROM_XYZ * (seen / white.y), rgb.into(), 1e-6);
    }
}

#[test]
fn reflectances_throw_back_no_more_than_arrives() {
    for i in 0..2000 {
        let nm = f64::from(i) + 100.0;
        let primaries =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|rgb| Reflectance::Rgb(rgb).at(nm));
        assert!(primaries.iter().all(|part| (0.0..=1.0).contains(part)), "{nm}");
        close(primaries.iter().sum(), 1.0, 1e-6);
    }
    // Linear: textures may be filtered before or after.
    for nm in [320.0, 433.0, 551.0, 902.0] {
        let mix = Reflectance::Rgb([0.3, 0.5, 0.4]).at(nm);
        let parts =
            0.5 * (Reflectance::Rgb([0.2, 0.9, 0.1]).at(nm) + Reflectance::Rgb([0.4, 0.1, 0.7]).at(nm));
        close(mix, parts, 1e-12);
    }
}

/// D⁵ B(λD, T) = B(λ, TD), and the displacement law, and Stefan and Boltzmann's.
#[test]
fn black_bodies_obey_planck() {
    for doppler in [0.05, 0.5, 2.0, 30.0] {
        close(
            planck(550.0 * doppler, 5000.0) * f64::powi(doppler, 5),
            planck(550.0, 5000.0 * doppler),
            1e-12,
        );
    }
    // 2.897771955e6 nm K.
    let peak = 2.897_771_955e6 / 5000.0;
    assert!(
        planck(peak, 5000.0) > planck(peak * 1.001, 5000.0)
            && planck(peak, 5000.0) > planck(peak * 0.999, 5000.0)
    );
    let all: f64 = (0..40_000)
        .map(|i| {
            let nm = libm::exp(f64::from(i) * 2.5e-4 + 4.0);
            planck(nm, 5000.0) * nm * 2.5e-4
        })
        .sum();
    close(all, 5.670_374_419e-8 * 5000.0_f64.powi(4) / std::f64::consts::PI, 1e-3);
    close(
        Spectrum::BlackBody(5000.0).total().unwrap(),
        5.670_374_419e-8 * 5000.0_f64.powi(4) / std::f64::consts::PI,
        1e-12,
    );
    // Far ends: no infinity, no NaN.
    for (nm, kelvin) in [(1e-3, 3000.0), (1e-3, 1e9), (1e9, 3.0), (1e9, 1e9), (500.0, 1.0)] {
        let value = planck(nm, kelvin);
        assert!(value.is_finite() && value >= 0.0, "{nm} nm, {kelvin} K: {value}");
    }
}

#[test]
fn white_of_daylight_is_the_white_of_the_screen() {
    let white = xyz_of(|nm| D65.at(nm));
    near(white.x / (white.x + white.y + white.z), 0.312_72, 1e-4);
    near(white.y / (white.x + white.y + white.z), 0.329_03, 1e-4);
    let a = Source::new(&Spectrum::Illuminant(Illuminant::A), 1.0).xyz();
    near(a.x / (a.x + a.y + a.z), 0.447_58, 2e-4);
    near(a.y / (a.x + a.y + a.z), 0.407_45, 2e-4);
    near(matching(555.0).y, 1.0, 1e-3);
}

#[test]
fn sources_have_the_brightness_they_are_given() {
    let spectra = [
        Spectrum::BlackBody(3000.0),
        Spectrum::Line { centre_nm: 589.0, width_nm: 0.0 },
        Spectrum::Line { centre_nm: 520.0, width_nm: 5.0 },
        Spectrum::Line { centre_nm: 520.0, width_nm: 60.0 },
        Spectrum::Rgb([0.9, 0.2, 0.4]),
        Spectrum::Sum(vec![
            Spectrum::Constant(1.0),
            Spectrum::Scaled(5.0, Box::new(Spectrum::BlackBody(2000.0))),
        ]),
    ];
    for spectrum in &spectra {
        close(Source::with_luminous(spectrum, 123.0).unwrap().xyz().y, 123.0, 1e-12);
    }
    assert!(Source::with_luminous(&Spectrum::Line { centre_nm: 1500.0, width_nm: 0.0 }, 1.0).is_none());
    let line = Source::with_total(&spectra[2], 7.0).unwrap();
    close(line.lines().iter().map(|line| line.power).sum(), 7.0, 1e-5);
    assert!(Source::with_total(&Spectrum::Constant(1.0), 1.0).is_none());
    let table = Table::new([(500.0, 0.0), (510.0, 1.0), (530.0, 1.0), (540.0, 0.0)]).unwrap();
    let source = Source::with_total(&Spectrum::Table(table), 60.0).unwrap();
    close(source.at(520.0), 2.0, 1e-6);
    near(source.at(499.0), 0.0, 0.0);
}

/// Narrow and wide lines are the same thing: their light goes over smoothly.
#[test]
fn line_has_the_same_colour_as_points_and_as_a_curve() {
    let line = |width_nm: f64| Source::new(&Spectrum::Line { centre_nm: 545.0, width_nm }, 1.0).xyz();
    near_vector(line(0.0), line(0.5), 1e-2 * line(0.0).length());
    // 17 nm of standard deviation is where points become a curve.
    near_vector(line(39.9), line(40.1), 5e-3 * line(40.0).length());
    let gauss = |nm: f64| {
        let z = (nm - 545.0) * 2.354_820_045 / 40.0;
        libm::exp(-0.5 * z * z) * 2.354_820_045 / 40.0 * 0.398_942_280_4
    };
    near_vector(line(40.0), xyz_of(gauss), 1e-3 * line(40.0).length());
}
