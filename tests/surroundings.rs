//! Light from infinity.

use crate::support::{Dice, close, near, near_vector, v};
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;
use std::sync::Arc;
use terrell::color::{RGB_FROM_XYZ, xyz_of};
use terrell::error::{Place, Report};
use terrell::spectrum::{Source, Spectrum, planck};
use terrell::surroundings::{
    COOLEST_K, HOTTEST_K, Kinds, MAGNITUDE_ZERO_LX, Panorama, Part, Star, Stars, Surroundings,
    parse_catalogue, seeded,
};
use terrell::texture::{Encoding, Picture, Texels};

const WIDTHS: [f64; 12] = [1e-9, 1e-7, 1e-4, 1e-2, 0.1, 0.3, 0.49, 0.51, 0.8, 1.5, PI, 1e9];

/// A direction at `1 - cos` from an axis.
fn beside(axis: DVec3, versine: f64, dice: &mut Dice) -> DVec3 {
    let across = axis.cross(dice.direction()).normalize();
    axis * (1.0 - versine) + across * (versine * (2.0 - versine)).sqrt()
}

/// The illuminance of a sky with one star, by the midpoint rule over 1 - cos θ.
fn illuminance(stars: &Stars, star: &Star, sigma: f64) -> f64 {
    const STEPS: u32 = 4000;
    let mut dice = Dice(1);
    let end = (8.5 * sigma * sigma).min(2.0);
    let mean = (0..STEPS).map(|i| {
        let versine = end * (f64::from(i) + 0.5) / f64::from(STEPS);
        let d = beside(star.direction, versine, &mut dice);
        stars.radiance(d, sigma, &[550.0])[0] / f64::from(STEPS)
    });
    mean.sum::<f64>() * TAU * end / planck(550.0, star.kelvin) * xyz_of(|nm| planck(nm, star.kelvin)).y
}

/// Also: a star of magnitude 0 gives 2.54e-6 lx.
#[test]
fn all_of_a_stars_light_is_in_its_image_however_wide_that_is() {
    let mut dice = Dice(2);
    for (kelvin, magnitude) in [(9600.0, 0.0), (3000.0, 5.0)] {
        for sigma in WIDTHS {
            let star = Star::of_magnitude(dice.direction(), kelvin, magnitude);
            let expected = 2.54e-6 * libm::pow(100.0, -magnitude / 5.0);
            close(star.illuminance, expected, 1e-12);
            // What lies within 4σ ends between two steps.
            close(illuminance(&Stars::new([star]), &star, sigma), expected, 2e-4);
        }
    }
}

/// Brightness at once from the definition: through the whole sky for every look.
#[test]
fn stars_found_by_cells_are_those_found_one_by_one() {
    let kinds = Kinds::Natural { brightest: 0.0, faintest: 6.0 };
    let mut list: Vec<Star> = seeded(5, 1500, kinds).collect();
    list.push(Star::of_magnitude(v(0.0, 1.0, 0.0), 4000.0, 2.0));
    list.push(Star::of_magnitude(v(0.0, -3.0, 0.0), 5000.0, 2.0));
    let stars = Stars::new(list.iter().copied());
    assert_eq!(stars.len(), 1502);
    let unit: Vec<f64> = list
        .iter()
        .map(|s| s.illuminance / xyz_of(|nm| planck(nm, s.kelvin)).y * planck(700.0, s.kelvin))
        .collect();
    let mut dice = Dice(3);
    for turn in 0..400 {
        let sigma = libm::pow(10.0, dice.between(-6.0, 0.6));
        let near_star = list[dice.below(list.len())].direction.normalize();
        let d =
            if turn % 2 == 0 { dice.direction() } else { (near_star + dice.direction() * sigma).normalize() };
        let kappa = 1.0 / (sigma * sigma);
        let end = (8.0 * sigma * sigma).min(2.5);
        let norm = kappa / (TAU * (1.0 - libm::exp(-kappa * end.min(2.0))));
        let kernel = |star: &Star| {
            let versine = 0.5 * (star.direction.normalize() - d).length_squared();
            if versine < end { norm * libm::exp(-kappa * versine) } else { 0.0 }
        };
        let expected: f64 = list.iter().zip(&unit).map(|(star, unit)| unit * kernel(star)).sum();
        near(stars.radiance(d, sigma, &[700.0])[0], expected, 2e-6 * expected);
    }
}

/// Also: narrower than a pixel it is spread like a point, and gives the light of its solid angle, 2π (1 - cos r).
#[test]
fn star_that_is_a_disc_is_a_black_body_up_to_its_edge() {
    let mut dice = Dice(4);
    for radius in [1e-5, 0.01, 0.3, 1.5_f64] {
        let star = Star::of_magnitude(dice.direction(), 5800.0, 3.0);
        let disc = Stars::new([star]).as_discs(radius, 2.5);
        let seen = |part: f64| {
            let versine = 2.0 * libm::sin(0.5 * part * radius).powi(2);
            disc.radiance(beside(star.direction, versine, &mut Dice(5)), 0.1 * radius, &[450.0, 700.0])
        };
        for part in [0.0, 0.5, 0.9999] {
            for (seen, nm) in seen(part).into_iter().zip([450.0, 700.0]) {
                close(seen, 2.5 * planck(nm, 5800.0), 1e-12);
            }
        }
        assert_eq!(seen(1.0001), [0.0; 2]);
        let solid_angle = 2.0 * TAU * libm::sin(0.5 * radius).powi(2);
        let luminance = 2.5 * xyz_of(|nm| planck(nm, 5800.0)).y;
        close(illuminance(&disc, &star, radius), luminance * solid_angle, 2e-4);
    }
}

/// Through the whole list for every look.
#[test]
fn discs_found_by_cells_are_those_found_one_by_one() {
    let kinds = Kinds::Alike { kelvin: 5000.0, magnitude: 0.0 };
    let all: Vec<Star> = seeded(6, 300, kinds).collect();
    for radius in [0.01_f64, 0.05, 0.4] {
        let (discs, mut dice, mut on) = (Stars::new(all.iter().copied()).as_discs(radius, 1.0), Dice(6), 0);
        for _ in 0..2000 {
            let d = dice.direction();
            let expected =
                all.iter().any(|star| (star.direction - d).length() < 2.0 * libm::sin(0.5 * radius));
            assert_eq!(discs.radiance(d, 0.0, &[550.0])[0] > 0.0, expected, "{d}");
            on += u32::from(expected);
        }
        assert!(on > 5, "{on}");
    }
}

#[test]
fn star_is_a_black_body_at_every_wavelength() {
    let star = Star::of_magnitude(v(0.0, 0.0, -2.0), 5000.0, 1.0);
    let nm = [1.0, 50.0, 400.0, 700.0, 1e5, 1e9];
    let seen = Stars::new([star]).radiance(v(0.0, 0.0, -1.0), 1e-3, &nm);
    for (seen, nm) in seen.into_iter().zip(nm) {
        let expected = planck(nm, 5000.0) / planck(550.0, 5000.0);
        let at_550 = Stars::new([star]).radiance(v(0.0, 0.0, -1.0), 1e-3, &[550.0])[0];
        near(seen / at_550, expected, 1e-12 * expected);
    }
}

#[test]
fn stars_that_are_none_are_left_out_and_odd_looks_see_nothing() {
    let star = |direction, illuminance| Star { direction, kelvin: 5000.0, illuminance };
    let x = v(1.0, 0.0, 0.0);
    let odd = [
        star(DVec3::ZERO, 1.0),
        star(DVec3::NAN, 1.0),
        star(x, 0.0),
        star(x, f64::NAN),
        star(x, f64::INFINITY),
    ];
    let none = Stars::new(odd);
    assert!(none.is_empty());
    assert_eq!(none.radiance(x, 0.1, &[500.0]), [0.0]);
    let one = Stars::new([star(x, 1.0)]);
    for (d, sigma) in [(DVec3::NAN, 0.1), (x, f64::NAN), (x, 0.0), (x, f64::INFINITY), (-x, 1e-300)] {
        let seen = one.radiance(d, sigma, &[500.0])[0];
        assert!(seen.is_finite() && seen >= 0.0, "{d} {sigma}: {seen}");
    }
    for kelvin in [f64::NAN, 0.0, 1e300] {
        let seen = Stars::new([Star { kelvin, ..star(x, 1.0) }]).radiance(x, 0.1, &[500.0])[0];
        assert!(seen.is_finite(), "{kelvin}: {seen}");
    }
}

#[test]
fn seeded_stars_are_strewn_evenly() {
    let count = 200_000;
    let stars: Vec<DVec3> = seeded(11, count, Kinds::default()).map(|star| star.direction).collect();
    // Five standard deviations.
    let slack = 5.0 / (count as f64).sqrt();
    let mean = |of: &dyn Fn(DVec3) -> f64| stars.iter().map(|d| of(*d)).sum::<f64>() / count as f64;
    for axis in DVec3::AXES {
        near(mean(&|d| d.dot(axis)), 0.0, slack * 0.578);
        near(mean(&|d| d.dot(axis).powi(2)), 1.0 / 3.0, slack * 0.3);
        near(mean(&|d| d.dot(axis).powi(4)), 0.2, slack * 0.27);
    }
    near(mean(&|d| d.x * d.y), 0.0, slack * 0.26);
    near(mean(&|d| d.y * d.z), 0.0, slack * 0.26);
    near(mean(&|d| d.z * d.x), 0.0, slack * 0.26);
    near(mean(&|d| d.length()), 1.0, 1e-12);
}

#[test]
fn seeded_stars_have_magnitudes_and_temperatures_of_stars() {
    let count = 100_000;
    let stars: Vec<Star> = seeded(12, count, Kinds::default()).collect();
    let brighter = |magnitude: f64| {
        let limit = Star::of_magnitude(DVec3::X, 5000.0, magnitude).illuminance;
        stars.iter().filter(|star| star.illuminance > limit).count() as f64
    };
    near(brighter(6.5 + 1e-9), count as f64, 0.0);
    near(brighter(-1.5 - 1e-9), 0.0, 0.0);
    for magnitude in [3.5, 4.5, 5.5] {
        close(brighter(magnitude + 1.0) / brighter(magnitude), 10.0_f64.sqrt(), 0.08);
    }
    let hotter = |kelvin: f64| stars.iter().filter(|star| star.kelvin > kelvin).count() as f64 / count as f64;
    near(hotter(2500.0 - 1e-6), 1.0, 0.0);
    near(hotter(30_000.0 + 1e-6), 0.0, 0.0);
    near(hotter(6000.0), 0.54, 0.01);
    // Temperature says nothing of brightness.
    let limit = Star::of_magnitude(DVec3::X, 5000.0, 5.5).illuminance;
    let bright: Vec<&Star> = stars.iter().filter(|star| star.illuminance > limit).collect();
    near(bright.iter().filter(|star| star.kelvin > 6000.0).count() as f64 / bright.len() as f64, 0.54, 0.02);
    let alike = Kinds::Alike { kelvin: 4321.0, magnitude: 3.0 };
    for star in seeded(12, 10, alike) {
        assert_eq!(
            (star.kelvin, star.illuminance),
            (4321.0, Star::of_magnitude(DVec3::X, 1.0, 3.0).illuminance)
        );
    }
}

/// All bits of many stars, folded (FNV-1a), as they came out when this was written.
#[test]
fn sky_of_a_seed_never_changes() {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for star in seeded(2024, 5000, Kinds::default()) {
        for value in star.direction.to_array().into_iter().chain([star.kelvin, star.illuminance]) {
            for byte in value.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
    }
    assert_eq!(hash, 0x0116_7c3c_675d_1741, "{hash:#018x}");
    let few: Vec<Star> = seeded(2024, 10, Kinds::default()).collect();
    let many: Vec<Star> = seeded(2024, 1000, Kinds::default()).collect();
    assert_eq!(few, many[..10]);
    let others: Vec<Star> = seeded(2025, 1000, Kinds::default()).collect();
    assert!(many.iter().all(|star| !others.contains(star)));
}

/// A picture whose texels are as a function of their place across and down says.
fn picture(of: impl Fn(f64, f64) -> [f64; 3]) -> Arc<Picture> {
    let (width, height) = (256, 128);
    let texel = |i: u32| {
        let (column, row) = (i % width, i / width);
        let rgb =
            of((f64::from(column) + 0.5) / f64::from(width), (f64::from(row) + 0.5) / f64::from(height));
        [rgb[0] as f32, rgb[1] as f32, rgb[2] as f32, 1.0]
    };
    let texels = Texels::Float((0..width * height).map(texel).collect());
    Arc::new(Picture::new(width, height, texels, Encoding::Linear))
}

/// Linear sRGB of what is seen, cd/m².
fn rgb(surroundings: &Surroundings, d: DVec3) -> DVec3 {
    *RGB_FROM_XYZ * xyz_of(|nm| surroundings.radiance(d, (1e-3, 1e-3), &[nm])[0])
}

fn panorama(picture: Arc<Picture>, luminance: f64, rotation: DQuat) -> Surroundings {
    Surroundings { parts: vec![Part::Panorama(Panorama::new(picture, luminance, rotation))] }
}

#[test]
fn panorama_has_its_centre_ahead_its_right_half_on_the_right_and_its_top_above() {
    let part = |holds: bool| f64::from(u8::from(holds));
    // Red: the right half. Green: the middle half. Blue: the upper half.
    let halves =
        picture(|across, down| [part(across > 0.5), part((0.25..0.75).contains(&across)), part(down < 0.5)]);
    let sky = panorama(halves.clone(), 1.0, DQuat::IDENTITY);
    let look = |x, y, z| rgb(&sky, v(x, y, z).normalize());
    near_vector(look(0.0, 0.0, -1.0), v(0.5, 1.0, 0.5), 1e-5);
    near_vector(look(0.0, 0.0, 1.0), v(0.5, 0.0, 0.5), 1e-5);
    near_vector(look(1.0, 0.0, 0.0), v(1.0, 0.5, 0.5), 1e-5);
    near_vector(look(-1.0, 0.0, 0.0), v(0.0, 0.5, 0.5), 1e-5);
    near(look(0.0, 1.0, 0.0).z, 1.0, 1e-5);
    near(look(0.0, -1.0, 0.0).z, 0.0, 1e-5);
    // Half a turn from the centre the right edge meets the left one.
    near_vector(look(0.1, 0.1, 1.0), v(1.0, 0.0, 1.0), 1e-5);
    near_vector(look(-0.1, -0.1, 1.0), v(0.0, 0.0, 0.0), 1e-5);
    // A quarter turn to the left about +y.
    let turned = panorama(halves, 1.0, DQuat::from_rotation_y(FRAC_PI_2));
    near_vector(rgb(&turned, v(-1.0, 0.1, 0.1).normalize()), v(0.0, 1.0, 1.0), 1e-5);
    near_vector(rgb(&turned, v(-1.0, 0.1, -0.1).normalize()), v(1.0, 1.0, 1.0), 1e-5);
}

#[test]
fn panorama_shows_each_direction_where_it_is() {
    let of = |d: DVec3| 0.5 + 0.5 * d;
    let map = picture(|across, down| {
        let (sin_a, cos_a) = libm::sincos((across - 0.5) * TAU);
        let (sin_p, cos_p) = libm::sincos(down * PI);
        of(v(sin_p * sin_a, cos_p, -sin_p * cos_a)).into()
    });
    let sky = panorama(map, 300.0, DQuat::IDENTITY);
    let mut dice = Dice(7);
    for _ in 0..200 {
        let d = dice.direction();
        // Half a row of texels at the poles, bends between texels elsewhere.
        near_vector(rgb(&sky, d) / 300.0, of(d), if d.y.abs() > 0.999 { 0.02 } else { 1e-3 });
    }
}

#[test]
fn panorama_may_be_brighter_than_white() {
    let sky = panorama(picture(|_, _| [900.0, 20.0, 0.5]), 10.0, DQuat::IDENTITY);
    near_vector(rgb(&sky, v(0.0, 0.6, 0.8)), v(9000.0, 200.0, 5.0), 0.05);
    let negative = panorama(picture(|_, _| [-1.0, -1.0, -1.0]), 10.0, DQuat::IDENTITY);
    near_vector(rgb(&negative, v(0.0, 0.6, 0.8)), DVec3::ZERO, 0.0);
}

#[test]
fn parts_add_up_and_lines_are_kept_apart() {
    let glow = Source::new(&Spectrum::BlackBody(3000.0), 2.0);
    let sodium = Source::new(
        &Spectrum::Sum(vec![
            Spectrum::Constant(0.25),
            Spectrum::Line { centre_nm: 589.0, width_nm: 0.0 },
            Spectrum::Line { centre_nm: 589.6, width_nm: 0.0 },
        ]),
        4.0,
    );
    let star = Stars::new([Star::of_magnitude(DVec3::X, 5000.0, -5.0)]);
    let alone = star.radiance(DVec3::X, 0.1, &[589.0])[0];
    let parts = vec![Part::Uniform(glow), Part::Uniform(sodium), Part::Stars(star)];
    let sky = Surroundings { parts };
    close(sky.radiance(DVec3::Y, (0.1, 0.1), &[589.0])[0], 2.0 * planck(589.0, 3000.0) + 1.0, 1e-12);
    close(sky.radiance(DVec3::X, (0.1, 0.1), &[589.0])[0], 2.0 * planck(589.0, 3000.0) + 1.0 + alone, 1e-12);
    let lines: Vec<(f64, f64)> = sky.lines().map(|line| (line.wavelength_nm, line.power)).collect();
    assert_eq!(lines, [(589.0, 4.0), (589.6, 4.0)]);
    assert_eq!(Surroundings::default().radiance(DVec3::X, (0.1, 0.1), &[500.0, 600.0]), [0.0; 2]);
}

/// Line and column of a fault, what it is, and the hint.
type Told = (Option<(usize, usize)>, String, String);

fn catalogue(text: &str) -> Result<Vec<Star>, Vec<Told>> {
    let mut report = Report::default();
    let stars = parse_catalogue(Path::new("stars.csv"), &Arc::from(text), &mut report);
    assert_eq!(stars.is_none(), !report.faults.is_empty());
    let told = |fault: terrell::error::Fault| (fault.place.line_column(), fault.what, fault.hint);
    stars.ok_or_else(|| report.faults.into_iter().map(told).collect())
}

#[test]
fn catalogue_puts_stars_where_the_sky_has_them() {
    let text = "\u{feff}ra, dec, magnitude, kelvin\r\n# Comment\r\n\r\n0,0,0,5000\r\n90,0,1,6000\n 180 , 0 , -1.5 , 7e3\n270,0,0,500\n0,90,0,10000000\n45,-90,0,5000\n-90,45,0,5000";
    let stars = catalogue(text).unwrap();
    let half = 0.5_f64.sqrt();
    let expected = [
        v(0.0, 0.0, -1.0),
        v(-1.0, 0.0, 0.0),
        v(0.0, 0.0, 1.0),
        v(1.0, 0.0, 0.0),
        v(0.0, 1.0, 0.0),
        v(0.0, -1.0, 0.0),
        v(half, half, 0.0),
    ];
    assert_eq!(stars.len(), expected.len());
    for (star, expected) in stars.iter().zip(expected) {
        near_vector(star.direction, expected, 1e-15);
    }
    close(stars[0].illuminance, MAGNITUDE_ZERO_LX, 1e-15);
    close(stars[1].illuminance, MAGNITUDE_ZERO_LX / libm::pow(100.0, 0.2), 1e-12);
    close(stars[2].illuminance, MAGNITUDE_ZERO_LX * libm::pow(100.0, 0.3), 1e-12);
    assert_eq!([stars[1].kelvin, stars[3].kelvin, stars[4].kelvin], [6000.0, COOLEST_K, HOTTEST_K]);
}

#[test]
fn catalogue_faults_name_the_line_and_what_to_type() {
    let text = "ra,dec,mag,K\n0,0,0,5000\n6h45m,-16.7,-1.46,9940\n10,  95,1,5000\n10,20,nan,5000\n1,2,3\n10, 20, 3, 10, 5\n0,0,0,499\n";
    let faults = catalogue(text).unwrap_err();
    let expected = [
        ((3, 1), "the right ascension `6h45m` is not a number", "15 for each hour, such as 101.287"),
        ((4, 6), "there is no declination of 95", "degrees from -90 to 90"),
        ((5, 7), "there is no magnitude of nan", "such as -1.46"),
        ((6, 1), "this one 3 values", "such as `101.287, -16.716, -1.46, 9940`"),
        ((7, 1), "this one 5 values", "such as `101.287, -16.716, -1.46, 9940`"),
        ((8, 7), "there is no temperature of 499", "kelvin from 500 to 1e7"),
    ];
    assert_eq!(faults.len(), expected.len(), "{faults:?}");
    for ((place, what, hint), expected) in faults.iter().zip(expected) {
        assert_eq!(*place, Some(expected.0), "{what}");
        assert!(what.contains(expected.1) && hint.contains(expected.2), "{what}: {hint}");
    }
}

#[test]
fn catalogue_without_stars_or_with_nothing_but_faults_ends_soon() {
    for text in ["", "# Nothing\n", "ra,dec,mag,K\n"] {
        assert!(catalogue(text).unwrap_err()[0].1.contains("no star"), "{text}");
    }
    let faults = catalogue(&"1,2,3,x\n".repeat(10_000)).unwrap_err();
    assert!((100..110).contains(&faults.len()));
    let mut report = Report::default();
    report.fault(Place::Command, "something else", "");
    let stars = parse_catalogue(Path::new("stars.csv"), &Arc::from("1,2,3,5000"), &mut report);
    assert_eq!(stars.unwrap().len(), 1);
    // Cells of any length and kind.
    for text in ["😀,é,\u{0},1", ",,,", ",", "1e999,0,0,5000", "0,0,0,inf", "+5,-0,.5,5e3"] {
        let _ = catalogue(text);
    }
    assert!(catalogue("0,0,0,5000\n😀,1,2,5000\n").is_err());
    // A mark of UTF-8 is part of no number.
    assert_eq!(catalogue("\u{feff}0,0,0,5000\n").unwrap().len(), 1);
    // Only the first line may be a heading.
    assert!(catalogue("ra,dec,mag,K\nright,up,dim,hot\n0,0,0,5000\n").is_err());
}
