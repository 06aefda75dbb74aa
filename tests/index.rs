//! Refractive indices: published values, and wavelengths that nobody measured.

use crate::support::{close, near};
use terrell::fresnel::conductor;
use terrell::spectrum::{Index, Metal};

/// Fraunhofer's lines d, F and C, and the mean of the sodium lines, nm.
const D_LINE: f64 = 587.5618;
const F_LINE: f64 = 486.1327;
const C_LINE: f64 = 656.2725;
const SODIUM: f64 = 589.2938;

fn named(name: &str) -> Index {
    Index::named(name).unwrap()
}

fn abbe(index: Index) -> f64 {
    (index.at(D_LINE) - 1.0) / (index.at(F_LINE) - index.at(C_LINE))
}

/// Schott's data sheets; Malitson; Peter; Daimon and Masumura.
#[test]
fn published_glasses_have_their_published_indices() {
    near(named("BK7").at(D_LINE), 1.516_80, 5e-6);
    near(abbe(named("BK7")), 64.17, 5e-3);
    near(named("SF11").at(D_LINE), 1.784_72, 5e-6);
    near(abbe(named("SF11")), 25.68, 5e-3);
    near(named("fused_silica").at(D_LINE), 1.458_46, 5e-6);
    near(abbe(named("fused_silica")), 67.82, 1e-2);
    near(named("diamond").at(SODIUM), 2.417, 5e-4);
    near(named("water").at(SODIUM), 1.333_35, 2e-5);
    assert!(Index::named("unobtainium").is_none());
    for name in Index::NAMES {
        assert!(named(name).disperses(), "{name}");
    }
}

#[test]
fn group_index_is_what_the_slope_of_the_index_makes_it() {
    near(named("BK7").group(589.0), 1.5412, 1e-4);
    near(named("BK7").group(800.0), 1.5267, 1e-4);
    let cauchy = Index::cauchy(1.5, 0.004, 1e-4).unwrap();
    let all = Index::NAMES.iter().map(|name| named(name)).chain([cauchy, Index::from_dispersion(1.7, 0.8)]);
    for index in all {
        let (first, last) = index.range_nm().unwrap();
        for i in 1..40 {
            let nm = first + (last - first) * f64::from(i) / 40.0;
            let slope = (index.at(nm + 0.01) - index.at(nm - 0.01)) / 0.02;
            near(index.group(nm), index.at(nm) - nm * slope, 1e-8);
        }
    }
}

#[test]
fn index_beyond_its_range_is_that_of_the_end() {
    for name in Index::NAMES {
        let index = named(name);
        let (first, last) = index.range_nm().unwrap();
        for (end, beyond) in [(first, first * 0.999), (first, 1.0), (last, last * 1.001), (last, 1e9)] {
            near(index.at(beyond), index.at(end), 0.0);
            near(index.group(beyond), index.at(end), 0.0);
        }
    }
}

#[test]
fn no_index_is_below_one_or_not_a_number() {
    let odd = [
        Index::Constant(0.2),
        Index::Constant(f64::NAN),
        Index::from_dispersion(1.05, 400.0),
        Index::from_dispersion(1.5, 0.0),
        Index::Cauchy { a: 1.2, b: -0.5, c: 0.3, range_nm: (1.0, 1e9) },
        Index::Sellmeier {
            b: [1.0, -3.0, 0.0, 0.0, 0.0, 0.0],
            c: [0.25, 0.36, 0.0, 0.0, 0.0, 0.0],
            range_nm: (1.0, 1e9),
        },
    ];
    for index in odd.into_iter().chain(Index::NAMES.iter().map(|name| named(name))) {
        for nm in (0..9000).map(|i| libm::pow(10.0, f64::from(i) / 1000.0)).chain([500.0, 600.0]) {
            let (n, group) = (index.at(nm), index.group(nm));
            assert!(n >= 1.0 && n.is_finite() && group >= 1.0, "{index:?} at {nm}: {n}, {group}");
        }
    }
}

/// The formula in the extension's own words.
#[test]
fn dispersion_of_gltf_is_its_formula() {
    let (n_d, dispersion) = (1.8, 0.66);
    let index = Index::from_dispersion(n_d, dispersion);
    for nm in [380.0, 450.0, 587.6, 780.0] {
        let n = n_d + (n_d - 1.0) / (20.0 / dispersion) * (523_655.0 / (nm * nm) - 1.5168);
        close(index.at(nm), n, 1e-12);
    }
    near(index.at(D_LINE), n_d, 1e-5);
    close(abbe(index), 20.0 / dispersion, 2e-3);
    assert!(!Index::from_dispersion(1.5, 0.0).disperses());
}

#[test]
fn formulas_that_no_transparent_body_has_are_refused() {
    let bk7 = Index::sellmeier(&[
        [1.039_612_12, 0.006_000_698_67],
        [0.231_792_344, 0.020_017_914_4],
        [1.010_469_45, 103.560_653],
    ]);
    near(bk7.unwrap().at(D_LINE), 1.5168, 1e-6);
    // A resonance in the visible, a negative square, an index below one.
    assert!(Index::sellmeier(&[[1.0, 0.01], [0.1, 0.3], [0.0, 0.0]]).is_none());
    assert!(Index::sellmeier(&[[1.0, 0.01], [0.1, -0.01], [0.0, 0.0]]).is_none());
    assert!(Index::sellmeier(&[[-0.5, 0.01], [0.0, 0.0], [0.0, 0.0]]).is_none());
    assert!(Index::sellmeier(&[[f64::NAN, 0.01], [0.0, 0.0], [0.0, 0.0]]).is_none());
    assert!(Index::cauchy(0.9, 0.0, 0.0).is_none());
    assert!(Index::cauchy(1.5, f64::INFINITY, 0.0).is_none());
    assert!(!Index::cauchy(1.5, 0.0, 0.0).unwrap().disperses());
}

#[test]
fn many_wavelengths_at_once_are_the_same_as_one_by_one() {
    let nm = [1.0, 330.0, 401.0, 587.0, 1200.0, 1e7];
    for index in [named("water"), Index::cauchy(1.5, 0.004, 1e-4).unwrap(), Index::Constant(1.3)] {
        assert_eq!(index.at_each(&nm), nm.map(|nm| index.at(nm)));
        assert_eq!(index.group_each(&nm), nm.map(|nm| index.group(nm)));
    }
    let gold = Metal::named("gold").unwrap();
    let (n, k) = gold.at_each(&nm);
    assert_eq!(n, nm.map(|nm| gold.at(nm).0));
    assert_eq!(k, nm.map(|nm| gold.at(nm).1));
}

/// Reflectances at normal incidence as handbooks give them for these measurements.
#[test]
fn metals_reflect_as_they_are_known_to() {
    let at = |name: &str, nm: f64| {
        let (n, k) = Metal::named(name).unwrap().at(nm);
        conductor(1.0, n, k)
    };
    near(at("gold", 450.0), 0.41, 0.02);
    near(at("gold", 550.0), 0.79, 0.02);
    near(at("gold", 650.0), 0.957, 0.005);
    near(at("silver", 550.0), 0.983, 0.005);
    near(at("copper", 550.0), 0.62, 0.02);
    near(at("copper", 650.0), 0.935, 0.005);
    near(at("aluminium", 550.0), 0.915, 0.003);
    assert!(Metal::named("mithril").is_none());
}

#[test]
fn metals_hold_their_ends() {
    for name in Metal::NAMES {
        let metal = Metal::named(name).unwrap();
        let (first, last) = metal.range_nm();
        assert_eq!(metal.at(1e-3), metal.at(first), "{name}");
        assert_eq!(metal.at(1e9), metal.at(last), "{name}");
        for i in 0..2000 {
            let (n, k) = metal.at(libm::pow(10.0, f64::from(i) / 200.0 - 1.0));
            assert!(n > 0.0 && n < 1000.0 && k > 0.0 && k < 1000.0, "{name}");
        }
    }
    assert_eq!(Metal::named("gold").unwrap().at(520.9), (0.62, 2.081));
    assert!(Metal::new([[500.0, 1.0, 2.0]]).is_none());
    assert!(Metal::new([[500.0, 1.0, 2.0], [500.0, 1.0, 2.0]]).is_none());
    assert!(Metal::new([[500.0, 1.0, 2.0], [600.0, 0.0, 2.0]]).is_none());
    assert_eq!(Metal::new([[500.0, 1.0, 2.0], [600.0, 3.0, 4.0]]).unwrap().at(550.0), (2.0, 3.0));
}
