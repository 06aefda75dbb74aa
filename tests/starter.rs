//! Manifests to begin with: that they are sound, commented, and that their first pictures are good.

use std::path::{Path, PathBuf};
use terrell::error::Report;
use terrell::exposure::{expose, first_hits};
use terrell::import;
use terrell::manifest;
use terrell::plan::{Plan, White};
use terrell::scene::compose;
use terrell::starter::{Motion, starter};

/// All models that come with the program.
fn models() -> Vec<PathBuf> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["assets", "tests/models/khronos"];
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(top.join(folder)).unwrap());
    let mut models: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    models.retain(|path| path.extension().is_some_and(|kind| kind == "glb" || kind == "obj"));
    models.sort();
    assert!(models.len() >= 20, "{models:?}");
    models
}

/// What a small picture shows of the first body: the part of the picture, and its luminances as parts of white, rising.
struct Shown {
    part: f64,
    model: Vec<f64>,
}

/// The first picture and the middle one.
fn shown(text: &str, file: &Path, known: usize) -> [Shown; 2] {
    let mut report = Report::default();
    let manifest = manifest::parse(file, text, &mut report).unwrap_or_else(|| panic!("{:?}", report.faults));
    let scene = compose(&manifest, file, &mut report).unwrap();
    let plan = Plan::of(&manifest, &scene, file, &mut report);
    assert_eq!(report.faults, []);
    // Glass that is open is the model's own.
    report.warnings.retain(|warning| !warning.what.contains("of glass"));
    assert_eq!(report.warnings.len(), known, "{:?}", report.warnings);
    let White::Fixed(white) = plan.white else { panic!("white is measured") };
    let sampling = plan.sampling.within(48);
    [0, plan.exposures.len() / 2].map(|index| {
        let view = scene.observer.view(plan.exposures[index].tau, sampling.width, sampling.height);
        let hits = first_hits(&scene, &view, sampling.width, sampling.height);
        let pixels = expose(&scene, &view, &sampling).xyz;
        let own = hits.iter().zip(&pixels).filter(|(hit, _)| hit.is_some_and(|hit| hit.body == 0));
        let mut model: Vec<f64> = own.map(|(_, xyz)| f64::from(xyz[1]) / white).collect();
        model.sort_unstable_by(f64::total_cmp);
        Shown { part: model.len() as f64 / pixels.len() as f64, model }
    })
}

fn began(model: &Path, motion: Motion) -> String {
    starter(model, Path::new("begun.yaml"), motion)
        .unwrap_or_else(|error| panic!("{}: {error}", model.display()))
}

#[test]
fn first_pictures_of_all_models_are_good() {
    let mut wrong = Vec::new();
    for model in models() {
        let known = import::load(&model, model.parent().unwrap()).unwrap().warnings.len();
        for motion in [Motion::Flyby, Motion::Turntable] {
            let text = began(&model, motion);
            for line in text.lines() {
                let (_, comment) = line.split_once("# ").unwrap_or_else(|| panic!("{line} has no comment"));
                assert!(comment.trim().len() > 5, "{line}");
            }
            let [first, middle] = shown(&text, Path::new("begun.yaml"), known);
            // Thin things are not seen from all sides; some models are but a ball before a wall.
            let most = if middle.part > first.part { &middle } else { &first };
            let median = most.model.get(most.model.len() / 2).copied().unwrap_or(0.0);
            let clipped = |shown: &Shown| {
                shown.model.iter().filter(|y| **y > 1.05).count() as f64 / shown.model.len().max(1) as f64
            };
            let clipped = clipped(&first).max(clipped(&middle));
            let name = model.file_name().unwrap().to_string_lossy().into_owned();
            let told = format!(
                "{name} {motion:?}: {:.3} and {:.3} of the picture, median {median:.3}, clipped {clipped:.3}\n",
                first.part, middle.part
            );
            let good =
                first.part > 0.005 && (0.015..0.7).contains(&most.part) && median > 0.01 && clipped < 0.05;
            println!("{told}");
            wrong.extend((!good).then_some(told));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

const CUBE: &[(f64, f64, f64)] = &[
    (0., 0., 0.),
    (1., 0., 0.),
    (1., 2., 0.),
    (0., 2., 0.),
    (0., 0., 1.),
    (1., 0., 1.),
    (1., 2., 1.),
    (0., 2., 1.),
];

/// A cuboid of three metres and more, so many times as large, somewhere.
fn cuboid(scale: f64) -> String {
    let corner =
        |(x, y, z): &(f64, f64, f64)| format!("v {} {} {}\n", x * scale + 7.0 * scale, y * scale, z * scale);
    let faces = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";
    CUBE.iter().map(corner).collect::<String>() + faces
}

#[test]
fn the_same_model_of_any_size_gives_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("begun.yaml");
    let all: Vec<[Shown; 2]> = [1.0, 1000.0, 1e-3]
        .into_iter()
        .map(|scale| {
            let model = folder.path().join("cuboid.obj");
            std::fs::write(&model, cuboid(scale)).unwrap();
            shown(&starter(&model, &file, Motion::Flyby).unwrap(), &file, 0)
        })
        .collect();
    for other in &all[1..] {
        for (a, b) in all[0].iter().zip(other) {
            assert!((a.part - b.part).abs() < 0.005, "{} {}", a.part, b.part);
            let median = |shown: &Shown| shown.model[shown.model.len() / 2];
            assert!((median(a) / median(b) - 1.0).abs() < 0.02, "{} {}", median(a), median(b));
        }
    }
}

#[test]
fn models_are_named_as_seen_from_the_manifest_with_what_quotes_it_takes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("mo del: s")).unwrap();
    std::fs::create_dir_all(at("films/new")).unwrap();
    std::fs::write(at("mo del: s/1 \"é\" #.obj"), cuboid(1.0)).unwrap();
    let file = at("films/new/begun.yaml");
    let text = starter(&at("mo del: s/1 \"é\" #.obj"), &file, Motion::Turntable).unwrap();
    assert!(text.contains("model_1: \"../../mo del: s/1 \\\"é\\\" #.obj\""), "{text}");
    shown(&text, &file, 0);
}

#[test]
fn models_with_nothing_to_be_seen_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let said = |name: &str, text: &str| {
        let model = folder.path().join(name);
        std::fs::write(&model, text).unwrap();
        starter(&model, Path::new("begun.yaml"), Motion::Flyby).unwrap_err().to_string()
    };
    assert!(said("a.gltf", "{\"asset\": {\"version\": \"2.0\"}}").contains("nothing to be seen"));
    assert!(said("a.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n").contains("seen"));
}
