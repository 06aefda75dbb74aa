//! The spectrum of a picture, in files and against what it should be.

use crate::support::{close, manifested};
use glam::DVec3;
use terrell::exposure::{Bands, Sampling, expose, expose_spectral, middles};
use terrell::film::Negative;
use terrell::spectrum::{Wavelengths, planck};

/// A picture of what a manifest has, and its spectrum.
fn spectral(text: &str, wavelengths: u32) -> (Negative, Bands) {
    let (_, scene, plan) = manifested(&format!("{text}\noutput: out\n"));
    let sampling = Sampling { wavelengths, ..plan.sampling };
    let view = scene.observer.view(plan.exposures[0].tau, sampling.width, sampling.height);
    let (negative, bands) = expose_spectral(&scene, &view, &sampling);
    assert_eq!(negative, expose(&scene, &view, &sampling), "the picture is the same with its spectrum");
    assert_eq!(bands.nm, middles(wavelengths));
    (negative, bands)
}

fn xyz(bands: &Bands, pixel: usize) -> DVec3 {
    let rule = Wavelengths::<64>::new();
    rule.xyz(&std::array::from_fn(|band| f64::from(bands.radiance[band][pixel])))
}

#[test]
fn a_black_body_that_comes_is_a_hotter_one() {
    let text = "
light_speed: 1 m/s
surroundings: { uniform: { black_body: 3000 K } }
observer: { velocity: 0 0 -0.5 c, direction: 0 0 -1 }
picture: { size: 1 1, samples: 1 }";
    for wavelengths in [8, 16, 32, 64] {
        let (_, bands) = spectral(text, wavelengths);
        for (nm, radiance) in bands.nm.iter().zip(&bands.radiance) {
            close(f64::from(radiance[0]), planck(*nm, 3000.0 * 3.0_f64.sqrt()), 1e-6);
        }
    }
}

#[test]
fn a_line_is_in_its_part_with_all_of_its_power() {
    // Seen at 589 nm times the Doppler factor.
    for (beta, seen) in [(0.0, 589.0), (0.1, 589.0 * libm::sqrt(0.9 / 1.1))] {
        let text = format!(
            "
light_speed: 1 m/s
surroundings: {{ uniform: {{ luminance: 50 cd/m2, spectrum: {{ line: 589 nm }} }} }}
observer: {{ velocity: 0 0 {} c, direction: 0 0 -1 }}
picture: {{ size: 1 1, samples: 1 }}",
            -beta
        );
        let (negative, bands) = spectral(&text, 16);
        let width = 300.0 / 16.0;
        let lit: Vec<usize> = (0..16).filter(|band| bands.radiance[*band][0] > 0.0).collect();
        assert_eq!(lit, [((seen - 400.0) / width) as usize]);
        let power = f64::from(bands.radiance[lit[0]][0]) * width;
        let expected = Wavelengths::<16>::line_xyz(seen, power);
        let off = DVec3::from(negative.xyz[0].map(f64::from)) - expected;
        assert!(off.length() < 1e-6 * expected.length(), "{off} of {expected}");
    }
}

#[test]
fn colours_that_glass_parts_are_in_the_spectrum() {
    let prism = std::fs::read_to_string("manifests/prism.yaml").unwrap();
    let text = prism.replace("size: 640 240", "size: 160 60").replace("output: ../out/prism", "");
    let (negative, bands) = spectral(&text, 64);
    let mut sums = [DVec3::ZERO; 2];
    let mut narrow = 0;
    for (pixel, right) in negative.xyz.iter().enumerate() {
        sums[0] += xyz(&bands, pixel);
        sums[1] += DVec3::from(right.map(f64::from));
        // In a rainbow a pixel has a part of the wavelengths alone.
        let lit = bands.radiance.iter().filter(|band| band[pixel] > 0.0).count();
        narrow += usize::from((1..20).contains(&lit));
    }
    let off = (sums[0] - sums[1]).abs() / sums[1];
    assert!(off.max_element() < 0.02, "{sums:?}");
    assert!(narrow > 100, "{narrow}");
}

#[test]
fn files_have_the_published_layout() {
    use exr::prelude::{AttributeValue, FlatSamples, ReadChannels, ReadLayers, read};
    let text = "
light_speed: 1 m/s
surroundings: { uniform: { black_body: 3000 K } }
observer: { velocity: 0 0 -0.5 c }
picture: { size: 4 3, samples: 1, white: 100 cd/m2 }";
    let folder = tempfile::tempdir().unwrap();
    let exr = "{ depth: half, layers: [radiance, spectrum] }";
    let output = format!("output: {{ folder: {}, exr: {exr} }}", folder.path().display());
    let (_, scene, plan) = manifested(&format!("{text}\n{output}\n"));
    terrell::render::render(&scene, &plan, 0..1, |_| ()).unwrap();
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = reader.all_attributes().from_file(folder.path().join("0000.exr")).unwrap();
    let named = |name: &str| match (
        image.attributes.other.iter().find(|(key, _)| **key == *name),
        image.layer_data.attributes.other.iter().find(|(key, _)| **key == *name),
    ) {
        (Some((_, AttributeValue::Text(text))), None) | (None, Some((_, AttributeValue::Text(text)))) => {
            text.to_string()
        }
        _ => panic!("{name}"),
    };
    assert_eq!(named("spectralLayoutVersion"), "1.0");
    assert_eq!(named("emissiveUnits"), "W.m^-2.sr^-1.nm^-1");
    let channels = &image.layer_data.channel_data.list;
    let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names.len(), 19);
    assert_eq!(names[3..5], ["S0.409,375nm", "S0.428,125nm"]);
    // Too faint for 16 bits.
    assert!(matches!(channels[3].sample_data, FlatSamples::F32(_)));
    assert!(matches!(channels[0].sample_data, FlatSamples::F16(_)));
}
