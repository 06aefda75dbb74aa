//! Files of pictures: what is in them, and that they agree with one another.

use glam::DVec3;
use std::collections::BTreeMap;
use std::path::PathBuf;
use terrell::error::Report;
use terrell::exposure::first_hits;
use terrell::film::{Development, Negative};
use terrell::manifest;
use terrell::output::{eight_of, exr_texts, png_texts, read_bmp, read_png};
use terrell::plan::{Picture, Plan};
use terrell::render::render;
use terrell::scene::{Scene, compose};

/// A film with everything that is written of it.
struct Made {
    folder: tempfile::TempDir,
    scene: Scene,
    plan: Plan,
}

const SCENE: &str = "
light_speed: 1 m/s
assets: { ball: { sphere: { radius: 1 m } }, floor: { plane: {} } }
bodies:
  - { asset: ball, at: 0 1 0 m, velocity: 0.6 0 0 c, material: { diffuse: { rgb: 0.8 0.2 0.1 } } }
  - { asset: floor, material: { diffuse: { rgb: 0.25 0.25 0.25 } } }
lights: [{ lamp: { intensity: 400 cd }, at: 2 5 4 m }]
observer: { at: 0 2 8 m, velocity: 0.3 0 -0.2 c, look_at: 0 1 0 m }
exposures: { from: 4 s, to: 6 s, count: 3 }
picture: { size: 64 48, samples: 1, white: 40 cd/m2, stops: 1 }
";

fn made(text: &str) -> Made {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, text, &mut report);
    assert_eq!(report.faults, []);
    let manifest = manifest.unwrap();
    let scene = compose(&manifest, &path, &mut report).unwrap();
    let plan = Plan::of(&manifest, &scene, &path, &mut report);
    assert_eq!(report.faults, []);
    render(&scene, &plan, 0..plan.exposures.len(), |_| ()).unwrap();
    Made { folder, scene, plan }
}

impl Made {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("out").join(name)
    }

    /// The values of a channel of an OpenEXR file.
    fn channel(&self, index: usize, name: &str) -> Vec<f32> {
        use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
        let path = self.plan.picture(index, Picture::Exr);
        let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = reader.all_attributes().from_file(path).unwrap();
        let found = image.layer_data.channel_data.list.into_iter().find(|one| one.name == *name).unwrap();
        match found.sample_data {
            FlatSamples::F32(values) => values,
            FlatSamples::F16(values) => values.into_iter().map(f32::from).collect(),
            FlatSamples::U32(_) => panic!("{name}"),
        }
    }

    fn vectors(&self, index: usize, names: [&str; 3]) -> Vec<DVec3> {
        let [x, y, z] = names.map(|name| self.channel(index, name));
        let vector = |i: usize| DVec3::new(f64::from(x[i]), f64::from(y[i]), f64::from(z[i]));
        (0..x.len()).map(vector).collect()
    }
}

fn numbers(text: &str, unit: &str) -> Vec<f64> {
    let bare = text.strip_suffix(unit).unwrap_or_else(|| panic!("{text}"));
    bare.split_whitespace().map(|number| number.parse().unwrap()).collect()
}

#[test]
fn pictures_say_when_and_where_and_how_fast_the_observer_was() {
    let made = made(&format!("{SCENE}film: {{ video: off }}\noutput: {{ folder: out, exr: on }}\n"));
    for exposure in &made.plan.exposures {
        let texts = png_texts(&made.plan.picture(exposure.index, Picture::Png));
        let said: BTreeMap<String, String> = exr_texts(&made.plan.picture(exposure.index, Picture::Exr));
        assert_eq!(texts, said);
        let carried = made.scene.observer.worldline.at(exposure.tau);
        let four = carried.velocity();
        assert_eq!(numbers(&said["Own time"], " s"), [exposure.tau]);
        assert_eq!(numbers(&said["Lab time"], " s"), [carried.event.t]);
        assert_eq!(numbers(&said["Place"], " m"), carried.event.x.to_array());
        assert_eq!(numbers(&said["Velocity"], " c"), (four.x / four.t).to_array());
        assert_eq!(numbers(&said["Lorentz factor"], ""), [four.t]);
        // ImageMagick takes these for the picture's own.
        assert!(said.keys().all(|key| !["gamma", "density", "units"].contains(&key.to_lowercase().as_str())));
        assert_eq!((&*said["Exposure"], &*said["Exposures"]), (&*exposure.index.to_string(), "3"));
        assert_eq!(numbers(&said["White"], " cd/m2"), [20.0]);
        assert_eq!(said["Stops"], "1");
        assert_eq!(said["Source"], "film");
        assert_eq!(Some(said["Fingerprint"].clone()), made.plan.fingerprint().map(|own| own.to_string()));
    }
    // What is said of the velocity can be typed into a manifest.
    let velocity = &png_texts(&made.path("0000.png"))["Velocity"];
    let other = SCENE.replace("0.3 0 -0.2 c", velocity);
    let mut report = Report::default();
    let again = manifest::parse("m.yaml".as_ref(), &format!("{other}output: out\n"), &mut report).unwrap();
    let typed = again.observer.placement.velocity.beta();
    assert!((typed - DVec3::new(0.3, 0.0, -0.2)).length() < 1e-15, "{typed}");
}

#[test]
fn sixteen_bits_are_a_finer_rounding_of_the_same_picture() {
    let shades = 40_000;
    let xyz = (0..shades).map(|i| [0.9505, 1.0, 1.089].map(|white| white * i as f32 / shades as f32));
    let negative = Negative { width: shades, height: 1, xyz: xyz.collect() };
    let development = Development::new(1.0, 1.0);
    let (eight, sixteen) = (development.develop(&negative), development.develop_finely(&negative));
    assert!(eight.iter().zip(&sixteen).all(|(eight, sixteen)| *eight == eight_of(*sixteen)));
    let steps = |values: Vec<u32>| values.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let green = |i: usize| 3 * i + 1;
    let count = shades as usize;
    assert!(steps((0..count).map(|i| u32::from(eight[green(i)])).collect()) < 256);
    assert!(steps((0..count).map(|i| u32::from(sixteen[green(i)])).collect()) > 20_000);
    assert!((0..count - 1).all(|i| sixteen[green(i)] <= sixteen[green(i + 1)]));
}

#[test]
fn pictures_of_one_exposure_agree() {
    let output = "output: { folder: out, png: 16, bmp: on, exr: on }\n";
    let (fine, plain) = (made(&format!("{SCENE}{output}")), made(&format!("{SCENE}output: out\n")));
    let size = (64, 48);
    for name in ["0000", "0001", "0002"] {
        let sixteen = read_png(&fine.path(&format!("{name}.png")), size).unwrap();
        let eight = read_png(&plain.path(&format!("{name}.png")), size).unwrap();
        assert_eq!((sixteen.sixteen, eight.sixteen), (true, false));
        assert_eq!(sixteen.rgb, eight.rgb);
        assert_eq!(read_bmp(&fine.path(&format!("{name}.bmp")), size).unwrap(), eight.rgb);
    }
}

#[test]
fn half_precision_holds_the_same_light_in_parts_of_white() {
    let output =
        |exr: &str| format!("{SCENE}film: {{ video: off }}\noutput: {{ folder: out, exr: {exr} }}\n");
    let (whole, half) = (made(&output("on")), made(&output("{ depth: half }")));
    for name in ["R", "G", "B", "cie.X", "cie.Y", "cie.Z"] {
        for (whole, half) in whole.channel(1, name).iter().zip(half.channel(1, name)) {
            let off = (f64::from(*whole) - 20.0 * f64::from(half)).abs();
            assert!(off <= f64::from(whole.abs()) / 2047.0 + 2e-6, "{name} {whole} {half}");
        }
    }
    for name in ["doppler", "emission_time", "distance", "body", "material"] {
        assert_eq!(whole.channel(1, name), half.channel(1, name));
    }
}

#[test]
fn only_the_layers_that_are_asked_for_are_written() {
    let layers = "{ layers: [radiance, body, body] }";
    let made = made(&format!("{SCENE}film: {{ video: off }}\noutput: {{ folder: out, exr: {layers} }}\n"));
    let path = made.plan.picture(0, Picture::Exr);
    let about = exr::meta::MetaData::read_from_file(path, false).unwrap();
    let names: Vec<String> = about.headers[0].channels.list.iter().map(|one| one.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R", "body"]);
}

#[test]
fn distances_and_normals_are_those_of_the_surface_that_is_seen() {
    let text = SCENE.replace("size: 64 48", "size: 160 120");
    let made = made(&format!("{text}film: {{ video: off }}\noutput: {{ folder: out, exr: on }}\n"));
    let view = made.scene.observer.view(made.plan.exposures[1].tau, 160, 120);
    let normals = made.vectors(1, ["normal.X", "normal.Y", "normal.Z"]);
    let distance = made.channel(1, "distance");
    let body = made.channel(1, "body");
    let firsts = first_hits(&made.scene, &view, 160, 120);
    let place = |number: usize| {
        let centre = glam::DVec2::new((number % 160) as f64 + 0.5, (number / 160) as f64 + 0.5);
        view.direction(centre) * f64::from(distance[number])
    };
    let mut of_each = [0, 0];
    for number in (160..normals.len() - 160).filter(|number| (1..159).contains(&(number % 160))) {
        let around = [number - 1, number + 1, number - 160, number + 160];
        let Some(first) = firsts[number].filter(|_| around.iter().all(|i| body[*i] == body[number])) else {
            continue;
        };
        // The observer's own distance: how far away the light was when it left, by the observer's clock.
        let apart = view.tetrad.event - first.emission;
        assert!((apart.dot(view.tetrad.velocity()) - first.s).abs() < 1e-9 * first.s);
        assert!((f64::from(distance[number]) - first.s).abs() < 1e-6 * first.s);
        assert!((normals[number].length() - 1.0).abs() < 1e-6);
        // Along the seen surface: differences over two pixels.
        let [left, right, above, below] = around.map(place);
        let (across, down) = (right - left, below - above);
        let seen = down.cross(across).normalize();
        let slant =
            -view.direction(glam::DVec2::new((number % 160) as f64 + 0.5, (number / 160) as f64 + 0.5));
        // Near the limb of the ball two pixels are a long way.
        if seen.dot(slant) > [0.5, 0.1][body[number] as usize] {
            assert!((seen - normals[number]).length() < 0.05, "{number}: {seen} {}", normals[number]);
            of_each[body[number] as usize] += 1;
        }
    }
    assert!(of_each[0] > 200 && of_each[1] > 200, "{of_each:?}");
}

#[test]
fn normals_of_what_rests_are_those_of_its_form() {
    let text = SCENE.replace("velocity: 0.6 0 0 c, ", "").replace("velocity: 0.3 0 -0.2 c, ", "");
    let made = made(&format!("{text}film: {{ video: off }}\noutput: {{ folder: out, exr: on }}\n"));
    let view = made.scene.observer.view(0.0, 64, 48);
    let firsts = first_hits(&made.scene, &view, 64, 48);
    let normals = made.vectors(0, ["normal.X", "normal.Y", "normal.Z"]);
    let to_camera = |lab: DVec3| {
        let axes = view.tetrad.lab_from_camera.inverse();
        (axes * terrell::spacetime::FourVector::new(0.0, lab)).x
    };
    let mut balls = 0;
    for (first, normal) in firsts.iter().zip(normals) {
        let Some(first) = first else { continue };
        let lab = if first.body == 0 { first.emission.x - DVec3::Y } else { DVec3::Y };
        balls += usize::from(first.body == 0);
        assert!((normal - to_camera(lab)).length() < 1e-6, "{normal} {lab}");
    }
    assert!(balls > 50);
}

#[test]
fn albedo_is_the_colour_that_was_written_whatever_the_light_and_the_motion() {
    let made = made(&format!("{SCENE}film: {{ video: off }}\noutput: {{ folder: out, exr: on }}\n"));
    let albedo = made.vectors(1, ["albedo.R", "albedo.G", "albedo.B"]);
    let (body, material) = (made.channel(1, "body"), made.channel(1, "material"));
    let mut seen = [0, 0, 0];
    for (number, albedo) in albedo.into_iter().enumerate() {
        let expected = match body[number] {
            0.0 => DVec3::new(0.8, 0.2, 0.1),
            1.0 => DVec3::splat(0.25),
            _ => DVec3::ZERO,
        };
        assert!((albedo - expected).length() < 1e-6, "{albedo} {expected}");
        assert_eq!(body[number], material[number]);
        seen[(body[number] + 1.0) as usize] += 1;
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn false_colours_mean_the_same_in_all_pictures_of_a_film_and_in_a_part_of_it() {
    let output = "output: { folder: out, doppler: on, emission_time: on }\n";
    let text = format!("{SCENE}film: {{ video: off }}\n{output}");
    let whole = made(&text);
    for picture in [Picture::Doppler, Picture::EmissionTime] {
        let read = |index: usize| read_png(&whole.plan.picture(index, picture), (64, 86)).unwrap().rgb;
        let (first, second) = (read(0), read(1));
        assert_ne!(first[..3 * 64 * 48], second[..3 * 64 * 48]);
        assert_eq!(first[3 * 64 * 48..], second[3 * 64 * 48..]);
        let texts = png_texts(&whole.plan.picture(1, picture));
        assert_eq!(texts, png_texts(&whole.path("0001.png")));
        let path = whole.plan.picture(2, picture);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        render(&whole.scene, &whole.plan, 2..3, |_| ()).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), bytes);
    }
}

/// A plan, and what is wrong with it.
fn planned(text: &str) -> (Plan, Vec<String>) {
    let path = std::path::Path::new("film.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(path, text, &mut report).unwrap();
    let scene = compose(&manifest, path, &mut report).unwrap();
    let plan = Plan::of(&manifest, &scene, path, &mut report);
    (plan, report.faults.iter().map(ToString::to_string).collect())
}

#[test]
fn a_spectrum_needs_more_than_three_wavelengths_and_the_same_in_all_pixels() {
    let still = SCENE.replace("velocity: 0.6 0 0 c, ", "").replace("velocity: 0.3 0 -0.2 c, ", "");
    let exr = |layers: &str| format!("output: {{ folder: out, exr: {{ layers: [{layers}] }} }}\n");
    let (plain, _) = planned(&format!("{still}{}", exr("radiance")));
    let (spectral, faults) = planned(&format!("{still}{}", exr("radiance, spectrum")));
    assert_eq!((plain.sampling.wavelengths, spectral.sampling.wavelengths), (3, 16));
    assert_eq!(faults, [""; 0]);
    let settled = still.replace("samples: 1", "tolerance: 1");
    assert_eq!(planned(&format!("{settled}{}", exr("radiance"))).1, [""; 0]);
    let (_, faults) = planned(&format!("{settled}{}", exr("radiance, spectrum")));
    assert!(faults[0].contains("a spectrum needs the same wavelengths in all pixels"), "{faults:?}");
    assert!(faults[0].contains("leave `tolerance` out"), "{faults:?}");
}

#[test]
fn films_that_cannot_be_are_faults_of_the_manifest() {
    let film = |film: &str, size: &str| {
        let text = SCENE.replace("size: 64 48", size);
        planned(&format!("{text}film: {film}\noutput: out\n")).1
    };
    assert_eq!(film("{ rate: 50, file: [a.gif, a.avi] }", "size: 8 8"), [""; 0]);
    assert!(film("{ rate: 60, file: [a.gif, a.avi] }", "size: 64 48")[0].contains("at most 50"));
    assert!(film("{ file: [a.gif, a.mp4] }", "size: 8 8")[0].contains("a film cannot be 8 x 8 pixels"));
}
