//! From light to the numbers of a picture.

use crate::support::{
    Body, Dice, Eye, Stage, beta, black_body, built, close, coloured, cube, diffuse, flat, glowing,
    icosphere, look, near, near_vector, pixel_centre, v,
};
use glam::{DMat3, DVec2, DVec3};
use terrell::color::{RGB_FROM_XYZ, XYZ_FROM_RGB, srgb_decode, srgb_encode};
use terrell::exposure::{Sampling, expose, first_hits};
use terrell::film::{Brightness, Development, Negative, Reconstruction, scattered};
use terrell::scene::Scene;
use terrell::spectrum::Wavelengths;

const FILTERS: [Reconstruction; 3] = [Reconstruction::Box, Reconstruction::Tent, Reconstruction::Gaussian];

fn scene() -> Scene {
    let mut stage = Stage::of([
        Body::new(&built(coloured(cube())), diffuse(0.5))
            .at(-6.0, v(0.5, 0.2, -6.0))
            .moving(beta(0.6, 0.3, -0.1)),
        Body::new(&built(icosphere(3)), glowing(black_body(4000.0))).at(0.0, v(-1.5, -0.5, -6.0)),
    ]);
    stage.ambient = Some(flat(50.0));
    stage.seen_by(&Eye::at(0.0, DVec3::ZERO).moving(beta(0.1, 0.0, 0.2)))
}

fn sampled(samples: u32, reconstruction: Reconstruction, wavelengths: u32) -> Negative {
    let scene = scene();
    let sampling = Sampling { width: 41, height: 30, samples, reconstruction, wavelengths };
    expose(&scene, &scene.observer.view(0.0, 41, 30), &sampling)
}

#[test]
fn single_sample_is_the_centre_of_the_pixel() {
    for filter in FILTERS {
        assert_eq!(filter.offsets(1), [DVec2::ZERO]);
    }
    let (scene, negative) = (scene(), sampled(1, Reconstruction::Tent, 64));
    let view = scene.observer.view(0.0, 41, 30);
    for (number, xyz) in negative.xyz.iter().enumerate() {
        let light = look(&scene, &view.ray(pixel_centre(number, 41)));
        let expected = Wavelengths::<64>::new().xyz(&light.radiance) + light.lines;
        near_vector(DVec3::from(xyz.map(f64::from)), expected, 1e-6 * expected.length());
    }
}

#[test]
fn samples_lie_evenly_about_the_centre() {
    for filter in FILTERS {
        // Standard deviation of one coordinate: box 1/√12, tent 1/√6, Gaussian 1/2 (a little less, being cut).
        let spread = match filter {
            Reconstruction::Box => (1.0 / 12.0_f64).sqrt(),
            Reconstruction::Tent => (1.0 / 6.0_f64).sqrt(),
            Reconstruction::Gaussian => 0.493_1,
        };
        for samples in [2, 3, 4, 16, 25, 64, 1000] {
            let offsets = filter.offsets(samples);
            assert_eq!(offsets.len(), samples as usize);
            let mean = offsets.iter().sum::<DVec2>() / f64::from(samples);
            near(mean.length(), 0.0, 1e-14);
            if samples >= 64 {
                let square = offsets.iter().map(|o| *o * *o).sum::<DVec2>() / f64::from(samples);
                near(square.x.sqrt(), spread, 0.01);
                near(square.y.sqrt(), spread, 0.02);
            }
        }
    }
}

/// Of samples that lie as densely as the filter weighs, the number up to one is the weight up to there.
#[test]
fn weight_up_to_a_sample_is_its_part_of_all() {
    for filter in FILTERS {
        let samples = 1000;
        for (number, offset) in filter.offsets(samples).iter().enumerate().step_by(37) {
            let steps = 20_000;
            let width = (offset.x + 2.0) / f64::from(steps);
            let weight: f64 =
                (0..steps).map(|i| filter.density(-2.0 + (f64::from(i) + 0.5) * width) * width).sum();
            near(weight, (number as f64 + 0.5) / f64::from(samples), 2e-4);
        }
        near(filter.density(1.51) + filter.density(-1.51), 0.0, 0.0);
    }
}

/// Of so many boxes of equal area, however long and narrow, each has one of the samples.
#[test]
fn scattered_samples_fill_all_boxes_wherever_they_stop() {
    for place in [(0, 0), (1, 0), (2, 3), (3, 1)] {
        for level in 0..=8 {
            let samples: Vec<DVec2> = (0..1 << level).map(|number| scattered(number, place) + 0.5).collect();
            for across in 0..=level {
                let (columns, rows) = (1_usize << across, 1_usize << (level - across));
                let mut filled = vec![false; columns * rows];
                for at in &samples {
                    filled[(at.y * rows as f64) as usize * columns + (at.x * columns as f64) as usize] = true;
                }
                assert!(filled.iter().all(|filled| *filled), "{place:?}, {columns} x {rows}");
            }
            if level >= 2 {
                let mean = (0..1 << level).map(|number| scattered(number, place)).sum::<DVec2>();
                near(mean.length() / f64::from(1 << level), 0.0, 1e-9);
            }
        }
    }
}

/// What is thin and upright passes through no column of pixels between all samples.
#[test]
fn four_samples_of_four_pixels_lie_in_sixteen_columns() {
    for column in 0..4 {
        let mut filled = [false; 16];
        for (row, number) in (0..4).flat_map(|row| (0..4).map(move |number| (row, number))) {
            filled[((scattered(number, (column, row)).x + 0.5) * 16.0) as usize] = true;
        }
        assert_eq!(filled, [true; 16]);
    }
}

#[test]
fn constant_light_stays_constant_under_any_filter() {
    let sky = Body::new(&built(icosphere(1)), glowing(black_body(5000.0))).sized(10.0);
    let scene = Stage::of([sky]).scene();
    for reconstruction in FILTERS {
        for samples in [1, 4, 7, 16] {
            let sampling = Sampling { width: 9, height: 5, samples, reconstruction, wavelengths: 8 };
            let negative = expose(&scene, &scene.observer.view(0.0, 9, 5), &sampling);
            let expected = Wavelengths::<8>::new()
                .xyz(&Wavelengths::<8>::new().nm.map(|nm| terrell::spectrum::planck(nm, 5000.0)));
            for xyz in &negative.xyz {
                near_vector(DVec3::from(xyz.map(f64::from)), expected, 1e-6 * expected.length());
            }
        }
    }
}

#[test]
fn picture_has_the_same_bits_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| sampled(4, Reconstruction::Gaussian, 16))
    };
    let bits = |negative: &Negative| negative.xyz.iter().map(|xyz| xyz.map(f32::to_bits)).collect::<Vec<_>>();
    let one = bits(&on(1));
    assert!(one.iter().any(|xyz| xyz[1] != 0));
    assert_eq!(one, bits(&on(2)));
    assert_eq!(one, bits(&on(5)));
}

/// More wavelengths, more samples: the same picture, more exactly.
#[test]
fn wavelengths_and_samples_converge() {
    let total = |negative: &Negative| negative.xyz.iter().map(|xyz| f64::from(xyz[1])).sum::<f64>();
    let fine = total(&sampled(64, Reconstruction::Box, 64));
    close(total(&sampled(64, Reconstruction::Box, 16)), fine, 0.01);
    close(total(&sampled(64, Reconstruction::Box, 8)), fine, 0.04);
    close(total(&sampled(16, Reconstruction::Box, 64)), fine, 0.01);
    close(total(&sampled(64, Reconstruction::Gaussian, 64)), fine, 0.01);
}

#[test]
fn first_hits_tell_the_body_of_each_pixel() {
    let scene = scene();
    let view = scene.observer.view(0.0, 41, 30);
    let bodies = first_hits(&scene, &view, 41, 30);
    let negative = sampled(1, Reconstruction::Box, 8);
    assert_eq!(bodies.len(), negative.xyz.len());
    for (first, xyz) in bodies.iter().zip(&negative.xyz) {
        assert_eq!(first.is_some(), xyz[1] > 0.0);
        if let Some(first) = first {
            // On the past light cone of the observer.
            let way = first.emission - view.tetrad.event;
            near(way.dot(way), 0.0, 1e-9);
        }
    }
    for body in [0, 1] {
        assert!(bodies.iter().flatten().filter(|first| first.body == body).count() > 20);
    }
}

/// Hue in `OKLab`, degrees, by the matrices from XYZ as they were published (Ottosson 2020; the code has others, from sRGB).
fn hue(xyz: DVec3) -> f64 {
    let cones = DMat3::from_cols_array(&[
        0.818_933_010_1,
        0.032_984_543_6,
        0.048_200_301_8,
        0.361_866_742_4,
        0.929_311_871_5,
        0.264_366_269_1,
        -0.128_859_713_7,
        0.036_145_638_7,
        0.633_851_707_0,
    ]) * xyz;
    let root = DVec3::new(libm::cbrt(cones.x), libm::cbrt(cones.y), libm::cbrt(cones.z));
    let a = v(1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9).dot(root);
    let b = v(0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0).dot(root);
    libm::atan2(b, a).to_degrees()
}

/// The difference of two angles in degrees.
fn turned(from: f64, to: f64) -> f64 {
    ((to - from + 540.0).rem_euclid(360.0) - 180.0).abs()
}

/// Any real light: also colours that no screen shows.
fn any_colour(dice: &mut Dice) -> DVec3 {
    let nm = dice.between(400.0, 690.0);
    let colour =
        terrell::color::matching(nm) + terrell::color::matching(dice.between(400.0, 690.0)) * dice.part();
    colour / colour.y
}

#[test]
fn display_never_leaves_its_range_and_brighter_stays_brighter() {
    let mut dice = Dice(6);
    for number in 0..300 {
        let headroom = f64::from(number % 25);
        let development = Development::new(100.0, headroom);
        let colour = any_colour(&mut dice);
        let mut before = -1.0;
        for step in 0..120 {
            let rgb = development.display(colour * libm::exp2(f64::from(step) * 0.5 - 6.0));
            assert!(rgb.min_element() >= 0.0 && rgb.max_element() <= 1.0);
            let y = (*XYZ_FROM_RGB * rgb).y;
            assert!(y >= before - 1e-12, "{y} after {before}");
            before = y;
        }
        near(development.display(colour * 1e20).max_element(), 1.0, 1e-12);
    }
}

/// From a ten-thousandth of white to a million times white.
#[test]
fn hue_stays_however_bright_a_colour_is() {
    let mut dice = Dice(7);
    for headroom in [0.0, 1.0, 5.0, 17.0] {
        let development = Development::new(1.0, headroom);
        for _ in 0..200 {
            let rgb = v(dice.part(), dice.part(), dice.part());
            let colour = if dice.part() < 0.5 { *XYZ_FROM_RGB * rgb } else { any_colour(&mut dice) };
            if rgb.max_element() - rgb.min_element() < 0.1 {
                continue; // Greys have none.
            }
            let sent = hue(colour);
            for step in 0..34 {
                let shown = development.display(colour / colour.y * libm::exp2(f64::from(step) - 13.0));
                let seen = hue(*XYZ_FROM_RGB * shown);
                assert!(
                    turned(sent, seen) < 2.0,
                    "{colour} at 2^{}: {sent} became {seen}, {shown}",
                    step - 13
                );
                // And there is some left.
                assert!(shown.max_element() - shown.min_element() > 0.02 * shown.max_element());
            }
        }
    }
}

/// The rainbow has no place at which its hues go back, though no screen shows its colours.
#[test]
fn hues_of_the_spectrum_keep_their_order() {
    let development = Development::new(1.0, 4.0);
    let hues: Vec<f64> = (440..=650)
        .step_by(5)
        .map(|nm| {
            let colour = terrell::color::matching(f64::from(nm));
            hue(*XYZ_FROM_RGB * development.display(colour / colour.y * 0.2))
        })
        .collect();
    for pair in hues.windows(2) {
        let step = (pair[0] - pair[1] + 540.0).rem_euclid(360.0) - 180.0;
        assert!(step > -0.5, "{hues:?}");
    }
    assert!(hues.len() > 40 && turned(hues[0], *hues.last().unwrap()) > 60.0);
}

/// All of the headroom is told apart, what is beyond is not; without headroom nothing is changed up to white.
#[test]
fn headroom_is_what_is_told_apart_above_white() {
    let white = *XYZ_FROM_RGB * DVec3::ONE;
    for headroom in [0.5, 1.0, 4.0, 17.0] {
        let shown = |stops: f64| Development::new(1.0, headroom).display(white * libm::exp2(stops)).y;
        near(shown(headroom), 1.0, 1e-9);
        near(shown(headroom + 0.1), 1.0, 1e-12);
        for step in 0..20 {
            let stops = headroom * (f64::from(step) / 20.0);
            assert!(shown(stops + headroom / 20.0) - shown(stops) > 0.2 / 256.0, "{stops} of {headroom}");
        }
    }
    for rgb in [v(0.1, 1.0, 0.2), DVec3::ONE, v(0.9, 0.95, 0.01)] {
        near_vector(Development::new(2.0, 0.0).display(*XYZ_FROM_RGB * rgb * 2.0), rgb, 1e-9);
    }
}

#[test]
fn colours_that_the_screen_can_show_are_shown_as_they_are() {
    let development = Development::new(250.0, 0.0);
    for rgb in [v(0.1, 0.7, 0.2), v(0.5, 0.5, 0.5), v(0.0, 0.3, 0.0), v(0.79, 0.79, 0.79)] {
        near_vector(development.display(*XYZ_FROM_RGB * rgb * 250.0), rgb, 1e-12);
    }
    for black in [DVec3::ZERO, v(0.0, -1.0, 0.0), DVec3::NAN] {
        assert_eq!(development.display(black), DVec3::ZERO);
    }
    assert_eq!(development.display(DVec3::INFINITY), DVec3::ONE);
}

/// A grey goes through the shoulder without colour and without a step.
#[test]
fn shoulder_is_smooth_and_grey_stays_grey() {
    let development = Development::new(1.0, 2.0);
    let white = *XYZ_FROM_RGB * DVec3::ONE;
    let (mut before, mut slope) = (0.0, 1.0);
    for step in 1..400 {
        let y = f64::from(step) * 0.01;
        let rgb = development.display(white * y);
        near(rgb.max_element() - rgb.min_element(), 0.0, 1e-12);
        let rise = (rgb.y - before) / 0.01;
        assert!(rise <= slope + 1e-9 && rise >= 0.0, "at {y}: {rise} after {slope}");
        assert!(slope - rise < 0.1);
        // No step to less than nothing: up to the knee it is the light itself.
        assert!(y > 0.6 || (rgb.y - y).abs() < 1e-12);
        (before, slope) = (rgb.y, rise);
    }
}

#[test]
fn bytes_are_the_nearest_ones() {
    let white = *XYZ_FROM_RGB * DVec3::ONE;
    let greys: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.0004).collect();
    let xyz = greys.iter().map(|grey| (white * *grey).as_vec3().to_array()).collect();
    let negative = Negative { width: 2000, height: 1, xyz };
    let bytes = Development::new(1.0, 0.0).develop(&negative);
    for (i, grey) in greys.iter().enumerate() {
        let exact = srgb_encode(*grey) * 255.0;
        assert!((f64::from(bytes[3 * i]) - exact).abs() < 0.501, "{grey}");
    }
}

#[test]
fn encoding_is_undone_by_decoding() {
    for i in 0..=1000 {
        let value = f64::from(i) / 1000.0;
        near(srgb_decode(srgb_encode(value)), value, 1e-7);
    }
    near(srgb_encode(0.214_041_14), 0.5, 1e-6);
}

#[test]
fn brightness_follows_neither_the_brightest_nor_the_darkest() {
    let grey = |y: f64| (*XYZ_FROM_RGB * DVec3::splat(y)).as_vec3().to_array();
    let of = |luminances: &[f64]| Brightness::of(luminances.iter().map(|y| grey(*y)));
    // 85 in 100 lie below 60 % of white; a film of one brightness is at 60 % itself.
    close(3.0 / of(&[3.0; 50]).unwrap().white, 0.6, 1e-6);
    let mixed: Vec<f64> = (0..100)
        .map(|i| {
            if i < 10 {
                1e-5
            } else if i < 95 {
                4.0
            } else {
                1e5
            }
        })
        .collect();
    close(4.0 / of(&mixed).unwrap().white, 0.6, 1e-6);
    close(of(&mixed).unwrap().brightest, 1e5, 1e-6);
    close(2.0 / of(&[0.0, f64::NAN, 2.0]).unwrap().white, 0.6, 1e-6);
    assert!(of(&[0.0, 0.0]).is_none());
    // One pixel in a thousand may be a glint.
    let glint: Vec<f64> = (0..2000).map(|i| if i == 7 { 1e6 } else { 5.0 }).collect();
    close(of(&glint).unwrap().brightest, 5.0, 1e-6);
}

#[test]
fn matrices_of_colour_undo_each_other() {
    near_vector(*RGB_FROM_XYZ * (*XYZ_FROM_RGB * v(0.2, 0.5, 0.9)), v(0.2, 0.5, 0.9), 1e-14);
    near((*XYZ_FROM_RGB * DVec3::ONE).y, 1.0, 1e-14);
    // IEC 61966-2-1: luminance of the primaries.
    near_vector((*XYZ_FROM_RGB).row(1), v(0.2126, 0.7152, 0.0722), 2e-4);
}
