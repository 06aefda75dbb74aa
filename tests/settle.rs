//! Pictures asked for by their error, and the chart of what settings cost and give.

use crate::support::manifested;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use terrell::chart::{self, Deviation, Method, Setting, Subject};
use terrell::color::{Lab, ciede2000};
use terrell::error::Report;
use terrell::exposure::{Sampling, Uncertainty, expose_lit, expose_settled};
use terrell::film::{Development, Negative};
use terrell::manifest;
use terrell::observer::View;
use terrell::plan::Plan;
use terrell::render::development;
use terrell::scene::{Scene, compose};
use terrell::spectrum::Wavelengths;
use terrell::trace::Cone;

pub(crate) fn committed(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut all: Vec<PathBuf> = folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    all.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    all.sort();
    assert!(all.len() >= 9);
    all
}

pub(crate) fn loaded(path: &Path, size: (u32, u32)) -> (Scene, Plan) {
    let mut report = Report::default();
    let changes = [("picture.size".to_owned(), format!("{} {}", size.0, size.1))];
    let manifest = manifest::load_with(path, &changes, &mut report).unwrap();
    let scene = compose(&manifest, path, &mut report).unwrap();
    let plan = Plan::of(&manifest, &scene, path, &mut report);
    assert!(report.faults.is_empty(), "{:?}", report.faults);
    (scene, plan)
}

/// A picture by what a filter means, on points of a lattice in each square of the picture and around it, each of which counts for all
/// pixels by its distance: nothing of it is how pictures are exposed.
fn by_lattice<const N: usize>(scene: &Scene, view: &View, sampling: &Sampling, points: u32) -> Negative {
    // Powers of 1/1.3247, the plastic ratio: evenly spread in two dimensions.
    const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    let (lit, rule) = (scene.lit().seen_from(view.tetrad.event), Wavelengths::<N>::new());
    let (width, height) = (sampling.width as usize, sampling.height as usize);
    let seen = |square: usize| {
        let (column, row) = ((square % (width + 2)) as f64, (square / (width + 2)) as f64);
        let turned = 0.618 * column + 0.382 * row;
        let point = move |i: u32| {
            let number = f64::from(i) + 0.5;
            let across = (number / f64::from(points) + turned).fract();
            let [down, phase] = STEPS.map(|step| (number * step + 3.0 * turned).fract());
            (DVec2::new(column - 1.0 + across, row - 1.0 + down), phase)
        };
        let light = |(place, phase): (DVec2, f64)| {
            let (ray, cone) = view.sight(place, f64::from(points).sqrt().recip());
            let light = lit.seen_within(&ray, Cone { phase, ..cone }, &rule);
            (place, rule.xyz(&light.radiance) + light.lines)
        };
        (0..points).map(point).map(light).collect::<Vec<_>>()
    };
    let squares: Vec<Vec<(DVec2, DVec3)>> =
        (0..(width + 2) * (height + 2)).into_par_iter().map(seen).collect();
    let pixel = |number: usize| {
        let (column, row) = (number % width, number / width);
        let centre = DVec2::new(column as f64, row as f64) + 0.5;
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for square in (0..9).map(|i| (row + i / 3) * (width + 2) + column + i % 3) {
            for (place, light) in &squares[square] {
                let [across, down] =
                    (*place - centre).to_array().map(|away| sampling.reconstruction.density(away));
                sum += across * down * *light;
                weights += across * down;
            }
        }
        (sum / weights).as_vec3().to_array()
    };
    let xyz = (0..width * height).map(pixel).collect();
    Negative { width: sampling.width, height: sampling.height, xyz }
}

fn converged(scene: &Scene, view: &View, sampling: &Sampling, points: u32) -> Negative {
    match sampling.wavelengths {
        3 => by_lattice::<3>(scene, view, sampling, points),
        _ => by_lattice::<32>(scene, view, sampling, points),
    }
}

fn reported_error_holds(path: &Path, (width, height): (u32, u32), points: u32) {
    let (scene, plan) = loaded(path, (width, height));
    let tau = plan.exposures[plan.exposures.len() / 2].tau;
    let view = scene.observer.view(tau, width, height);
    let development = development(&scene, &plan);
    let reference = converged(&scene, &view, &plan.sampling, points);
    let settled = expose_settled(&scene.lit(), &view, &plan.sampling, &development, 3.0);
    let real = Deviation::between(&settled.negative, &reference, &development).shown;
    let name = path.file_stem().unwrap().display();
    // The reference is not exact either.
    assert!(real.p99 <= 1.1 * settled.error.p99.max(0.1), "{name}: {real:?}, not {:?}", settled.error);
    assert!(real.mean <= 1.1 * settled.error.mean.max(0.05), "{name}: {real:?}, not {:?}", settled.error);
}

#[test]
fn reported_error_holds_on_every_committed_manifest() {
    for path in committed("manifests") {
        reported_error_holds(&path, (32, 18), 2039);
    }
}

#[test]
fn reported_error_holds_on_the_gallery() {
    for path in committed("manifests/gallery") {
        reported_error_holds(&path, (64, 36), 509);
    }
}

#[test]
fn reported_error_holds_where_colours_part_within_a_pixel() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("manifests/prism.yaml");
    let (scene, plan) = loaded(&path, (64, 4));
    let tau = plan.exposures[plan.exposures.len() / 2].tau;
    let view = scene.observer.view(tau, 64, 4);
    let development = development(&scene, &plan);
    let reference = converged(&scene, &view, &plan.sampling, 2039);
    for tolerance in [4.0, 1.0] {
        let settled = expose_settled(&scene.lit(), &view, &plan.sampling, &development, tolerance);
        let real = Deviation::between(&settled.negative, &reference, &development).shown;
        println!("{tolerance}: {real:?}, by estimate {:?}, {} samples", settled.error, settled.samples);
        // The reference is not exact either.
        assert!(real.p99 <= 1.1 * settled.error.p99, "{tolerance}: {real:?}, not {:?}", settled.error);
    }
}

/// A disk that shines before darkness: its edge alone needs samples.
const DISK: &str = "
light_speed: 1 m/s
assets: { ball: { sphere: { radius: 1 m } } }
bodies:
  - { asset: ball, material: { emission: { luminance: 50 cd/m2 } } }
observer: { at: 0 0 6 m, look_at: ball, field_of_view: 50 deg }
exposures: { at: 0 s }
picture: { size: 96 96, white: 100 cd/m2 }
output: out
";

#[test]
fn tolerance_costs_less_than_the_even_setting_that_is_as_good() {
    let (_, scene, plan) = manifested(DISK);
    let view = scene.observer.view(0.0, 96, 96);
    let development = Development::new(100.0, 1.0);
    let lit = scene.lit();
    let even = |samples: u32| expose_lit(&lit, &view, &Sampling { samples, ..plan.sampling });
    let reference = even(4096);
    let settled = expose_settled(&lit, &view, &plan.sampling, &development, 1.0);
    let error = |negative: &Negative| Deviation::between(negative, &reference, &development).shown.p99;
    let real = error(&settled.negative);
    assert!(real <= 1.0, "{real}");
    let as_good = (0..12).map(|power| 1_u32 << power).find(|samples| error(&even(*samples)) <= real).unwrap();
    assert!(f64::from(as_good) > 2.0 * settled.samples, "{as_good} samples against {}", settled.samples);
}

/// A shining thing much thinner than a pixel, seen by few samples of few pixels.
const WIRES: &str = "
light_speed: 1 m/s
assets: { wire: { cylinder: { radius: 3 mm, height: 4 m } } }
bodies:
  - { asset: wire, at: -0.51 0 0 m, rotation: 3 deg about 0 0 1, material: { emission: { luminance: 1000 cd/m2 } } }
  - { asset: wire, at: 0.53 0 0 m, rotation: -4 deg about 0 0 1, material: { emission: { luminance: 1000 cd/m2 } } }
surroundings: { uniform: { luminance: 20 cd/m2 } }
observer: { at: 0 0 6 m, look_at: 0 0 0 m, field_of_view: 40 deg }
exposures: { at: 0 s }
picture: { size: 64 36, white: 100 cd/m2 }
output: out
";

#[test]
fn what_few_samples_met_is_not_forgotten() {
    let (_, scene, plan) = manifested(WIRES);
    let view = scene.observer.view(0.0, 64, 36);
    let development = Development::new(100.0, 1.0);
    let reference = converged(&scene, &view, &plan.sampling, 2039);
    for tolerance in [10.0, 4.0, 1.0] {
        let settled = expose_settled(&scene.lit(), &view, &plan.sampling, &development, tolerance);
        let real = Deviation::between(&settled.negative, &reference, &development).shown;
        println!("{tolerance}: {real:?}, by estimate {:?}, {} samples", settled.error, settled.samples);
        assert!(real.p99 <= 1.1 * settled.error.p99, "{tolerance}: {real:?}, not {:?}", settled.error);
    }
}

#[test]
fn settled_picture_is_the_same_on_any_number_of_threads() {
    let (_, scene, plan) = manifested(DISK);
    let view = scene.observer.view(0.0, 96, 96);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let development = Development::new(100.0, 1.0);
        pool.install(|| expose_settled(&scene.lit(), &view, &plan.sampling, &development, 2.0))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn deviation_of_a_picture_from_itself_is_none_and_of_a_brighter_one_is_known() {
    let (_, scene, plan) = manifested(DISK);
    let view = scene.observer.view(0.0, 96, 96);
    let picture = expose_lit(&scene.lit(), &view, &plan.sampling);
    let development = Development::new(100.0, 1.0);
    let none = Deviation::between(&picture, &picture, &development);
    assert_eq!((none.rmse, none.shown.p99), (0.0, 0.0));
    let mut brighter = picture.clone();
    brighter.xyz.iter_mut().flatten().for_each(|value| *value *= 1.25);
    let off = Deviation::between(&brighter, &picture, &development);
    assert!((off.rmse - 0.25).abs() < 1e-6, "{off:?}");
    // 99 in 100 take in the disk's inside, which is one colour.
    let lab = |y: f64| Lab::of_rgb(DVec3::splat(y));
    assert!((off.shown.p99 - ciede2000(lab(0.5), lab(0.625))).abs() < 0.05, "{off:?}");
}

#[test]
fn ninety_nine_in_a_hundred_are_not_above() {
    let error = Uncertainty::of((1..=200).map(f64::from).collect());
    assert_eq!((error.mean, error.p99), (100.5, 198.0));
}

#[test]
fn ladder_has_the_default_and_names_the_cheapest_that_is_fine() {
    let (_, scene, plan) = manifested(DISK);
    let plan = Plan { sampling: Sampling { width: 24, height: 24, ..plan.sampling }, ..plan };
    let subject = Subject { scene: &scene, tau: 0.0, development: Development::new(100.0, 1.0) };
    let settings = chart::ladder(&scene, &plan);
    assert_eq!(settings.iter().filter(|setting| setting.default).count(), 1);
    assert!(settings.iter().any(|setting| setting.method == Method::Tolerance(1.0)));
    let (reference, ..) = subject.expose(&chart::reference(&scene, &plan, 256));
    let count = settings.len();
    let measured = subject.measure(settings, &reference, 1, |_| {});
    assert_eq!(measured.len(), count);
    let best = chart::cheapest(&measured).unwrap();
    assert!(best.deviation.shown.p99 < 1.0);
    for one in &measured {
        assert!(one.seconds >= best.seconds || one.deviation.shown.p99 >= 1.0);
    }
    let front = chart::front(&measured, |one| one.deviation.rmse);
    for pair in front.windows(2) {
        let [fast, slow] = [pair[0], pair[1]].map(|number| &measured[number]);
        assert!(fast.seconds <= slow.seconds && fast.deviation.rmse > slow.deviation.rmse);
    }
    let rows = chart::csv(&measured);
    assert_eq!(rows.lines().count(), count + 1);
    let drawing = chart::svg("a <disk>", &measured);
    assert!(drawing.contains("a &lt;disk&gt;") && drawing.matches("<circle").count() >= 3 * count);
    let tags = |open: &str| drawing.matches(open).count();
    assert_eq!(tags("<svg"), tags("</svg>"));
    assert_eq!(tags("<text"), tags("</text>"));
}

#[test]
fn default_of_the_ladder_is_what_render_would_do() {
    let (_, scene, plan) = manifested(&DISK.replace("white: 100", "tolerance: 2, white: 100"));
    let settings = chart::ladder(&scene, &plan);
    let default: Vec<_> = settings.iter().filter(|setting| setting.default).collect();
    assert_eq!(default.len(), 1);
    assert_eq!(default[0].method, Method::Tolerance(2.0));
    assert!(
        settings.iter().any(|setting| setting.method == Method::Planned && setting.sampling.samples == 4)
    );
    assert_eq!(chart::reference(&scene, &plan, 8).method, Method::Converged);
}

#[test]
fn steps_change_one_thing_at_a_time() {
    let (_, scene, plan) = manifested(DISK);
    let settings = chart::ladder(&scene, &plan);
    let default = settings.iter().find(|setting| setting.default).unwrap();
    let same = |one: &Setting, other: &Setting| {
        [
            one.sampling.samples == other.sampling.samples,
            one.sampling.wavelengths == other.sampling.wavelengths,
            one.depth == other.depth,
            one.footprints == other.footprints,
            one.method == other.method,
        ]
    };
    for setting in settings.iter().filter(|setting| !setting.default && setting.series != "everything on") {
        let changed = same(setting, default).iter().filter(|same| !**same).count();
        assert_eq!(changed, 1, "{} {}", setting.series, setting.label);
    }
}
