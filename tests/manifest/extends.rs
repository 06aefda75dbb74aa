//! Manifests that begin from others.

use std::path::{Path, PathBuf};
use terrell::error::{Place, Report};
use terrell::manifest::{self, Manifest};

/// A folder with some files.
struct Files(tempfile::TempDir);

impl Files {
    fn of(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn read(&self, name: &str) -> (Option<Manifest>, Report) {
        let mut report = Report::default();
        let manifest = manifest::load(&self.path(name), &mut report);
        (manifest, report)
    }

    fn sound(&self, name: &str) -> (Manifest, Report) {
        let (manifest, report) = self.read(name);
        assert_eq!(report.faults, []);
        (manifest.unwrap(), report)
    }

    /// The faults: file, line, what.
    fn faults(&self, name: &str) -> Vec<(String, usize, String)> {
        let (manifest, report) = self.read(name);
        assert!(manifest.is_none() && report.faults.iter().all(|fault| !fault.hint.is_empty()));
        let told = report.faults.into_iter().map(|fault| {
            let Place::Text { path, .. } = &fault.place else { panic!("{fault:?}") };
            let file = path.file_name().unwrap().to_string_lossy().into_owned();
            (file, fault.place.line_column().unwrap().0, fault.what)
        });
        told.collect()
    }
}

/// What a manifest says, without where.
fn meaning(manifest: &Manifest) -> String {
    let manifest = Manifest { extends: Vec::new(), ..manifest.clone() };
    let mut text = format!("{manifest:?}");
    while let Some(from) = text.find("Text { path: ") {
        let span = from + text[from..].find(", span: ").unwrap();
        let to = span + text[span..].find('}').unwrap();
        text.replace_range(from..=to, "here");
    }
    text
}

const BASE: &str = "\
light_speed: 1 m/s
spectra: { sodium: { line: 589 nm } }
materials: { red: { diffuse: { rgb: 1 0 0 } }, blue: { diffuse: { rgb: 0 0 1 } } }
assets: { ball: { sphere: { radius: 1 m } }, cube: { box: { size: 1 m } }, floor: plane }
bodies:
  - { asset: ball, at: 0 1 0 m, velocity: 0.5 0 0 c }
  - { asset: cube, name: left, at: -3 1 0 m }
  - { asset: cube, name: right, at: 3 1 0 m }
lights: [{ lamp: { intensity: 300 cd } }, { sun: { illuminance: 10 lx, direction: 0 -1 0 } }]
observer: { orbit: { radius: 4 m, speed: 0.5 c }, look_at: ball, field_of_view: 40 deg }
exposures: { from: 0 s, to: 4 s, count: 3 }
film: { rate: 12 }
output: out/base
";

#[test]
fn a_manifest_that_only_extends_another_says_the_same() {
    let files = Files::of(&[
        ("base.yaml", BASE),
        ("m.yaml", "extends: base.yaml\n"),
        ("n.yaml", "extends: [m.yaml]\n"),
    ]);
    let (base, of_base) = files.sound("base.yaml");
    for name in ["m.yaml", "n.yaml"] {
        let (manifest, report) = files.sound(name);
        assert_eq!(meaning(&manifest), meaning(&base));
        assert_eq!(report.inputs.manifest, of_base.inputs.manifest);
    }
}

#[test]
fn what_is_said_is_what_the_merged_text_says() {
    let change = "\
extends: base.yaml
light_speed: ~
materials: { red: { mirror: 0.9 }, green: { diffuse: { rgb: 0 1 0 } }, blue: ~ }
bodies:
  ball: { velocity: 0 0 0.9 c, material: red }
  left: ~
  2: { at: 4 1 0 m }
  +: [{ asset: floor }]
lights: { 1: { sun: { illuminance: 20 lx } }, 0: { spot: { intensity: 1 cd, cone: 40 deg } } }
observer: { rocket: { acceleration: 0 0 0.1 g }, look_at: ~ }
exposures: { count: 7 }
film: ~
output: out/other
";
    let merged = "\
spectra: { sodium: { line: 589 nm } }
materials: { red: { mirror: 0.9 }, green: { diffuse: { rgb: 0 1 0 } } }
assets: { ball: { sphere: { radius: 1 m } }, cube: { box: { size: 1 m } }, floor: plane }
bodies:
  - { asset: ball, at: 0 1 0 m, velocity: 0 0 0.9 c, material: red }
  - { asset: cube, name: right, at: 4 1 0 m }
  - { asset: floor }
lights:
  - { spot: { intensity: 1 cd, cone: 40 deg } }
  - { sun: { illuminance: 20 lx, direction: 0 -1 0 } }
observer: { rocket: { acceleration: 0 0 0.1 g }, field_of_view: 40 deg }
exposures: { from: 0 s, to: 4 s, count: 7 }
output: out/other
";
    let files = Files::of(&[("base.yaml", BASE), ("m.yaml", change), ("whole.yaml", merged)]);
    let ((manifest, report), (whole, of_whole)) = (files.sound("m.yaml"), files.sound("whole.yaml"));
    assert_eq!(meaning(&manifest), meaning(&whole));
    assert_eq!(report.inputs.manifest, of_whole.inputs.manifest);
    assert_eq!(report.warnings, []);
    assert_eq!(manifest.extends, [files.path("base.yaml")]);
}

#[test]
fn a_shorthand_takes_the_place_of_the_observers_way_and_the_exposures_below_it() {
    let files = Files::of(&[
        ("base.yaml", BASE),
        ("m.yaml", "extends: base.yaml\nturntable: { around: ball, radius: 4 m }\noutput: out/m\n"),
        ("n.yaml", "extends: m.yaml\nflyby: { past: ball, distance: 2 m }\noutput: out/n\n"),
    ]);
    let (manifest, _) = files.sound("m.yaml");
    assert!((manifest.observer.field_of_view.unwrap().to_degrees() - 40.0).abs() < 1e-12);
    assert_eq!(manifest.exposures.count, 96);
    files.sound("n.yaml");
}

#[test]
fn one_time_takes_the_place_of_many_and_many_that_of_one() {
    let still = "extends: base.yaml\nexposures: { at: 2 s }\noutput: out/still\n";
    let film = "extends: still.yaml\nexposures: { from: 1 s, to: 3 s, count: 5 }\noutput: out/film\n";
    let ring = "extends: base.yaml\nobserver: { ring: { radius: 4 m } }\nexposures: { at: 0 s, count: 7 }\noutput: out/ring\n";
    let later = "extends: ring.yaml\nexposures: { at: 2 s }\noutput: out/later\n";
    let files = Files::of(&[
        ("base.yaml", BASE),
        ("still.yaml", still),
        ("film.yaml", film),
        ("ring.yaml", ring),
        ("later.yaml", later),
    ]);
    let exposures = |name: &str| {
        let exposures = files.sound(name).0.exposures;
        (exposures.from, exposures.to, exposures.count)
    };
    assert_eq!(exposures("still.yaml"), (2.0, 2.0, 1));
    assert_eq!(exposures("film.yaml"), (1.0, 3.0, 5));
    // A ring of observers takes its pictures at one time.
    assert_eq!(exposures("ring.yaml"), (0.0, 0.0, 7));
    assert_eq!(exposures("later.yaml"), (2.0, 2.0, 7));
}

#[test]
fn later_manifests_of_a_list_stand_above_earlier_ones() {
    let files = Files::of(&[
        ("a.yaml", "light_speed: 1 m/s\npicture: { samples: 1, depth: 2 }\n"),
        ("b.yaml", "extends: c.yaml\npicture: { samples: 2 }\n"),
        ("c.yaml", "picture: { samples: 3, wavelengths: 8 }\nobserver: {}\n"),
        ("m.yaml", "extends: [a.yaml, b.yaml]\noutput: out\n"),
    ]);
    let (manifest, report) = files.sound("m.yaml");
    let picture = &manifest.picture;
    assert_eq!((picture.samples, picture.depth, picture.wavelengths, manifest.light_speed), (2, 2, 8, 1.0));
    let bases: Vec<_> = ["a.yaml", "b.yaml", "c.yaml"].iter().map(|name| files.path(name)).collect();
    assert_eq!(report.inputs.bases.into_iter().collect::<Vec<_>>(), bases);
    assert_eq!(report.inputs.files.len(), 0);
}

#[test]
fn paths_are_relative_to_the_file_that_names_them() {
    let files = Files::of(&[
        (
            "studio/base.yaml",
            "assets: { a: models/a.glb, b: models/b.glb }\nbodies: [{ asset: a }, { asset: b }]\n",
        ),
        ("m.yaml", "extends: studio/base.yaml\nassets: { b: models/b.glb }\nobserver: {}\noutput: out\n"),
    ]);
    let (manifest, _) = files.sound("m.yaml");
    let file = |name: &str| manifest.assets[name].file().unwrap().file.value.clone();
    assert_eq!(file("a"), files.path("studio/models/a.glb"));
    assert_eq!(file("b"), files.path("models/b.glb"));
}

#[test]
fn faults_are_shown_in_the_file_in_which_they_are() {
    let files = Files::of(&[
        ("base.yaml", "picture: { samples: 0 }\nobserver:\n  at: 0 0 0\n  up: 0 0 0\n"),
        ("m.yaml", "# m\nextends: base.yaml\nobserver: { up: 0 1 }\nfilm: { rate: 0 }\noutput: out\n"),
    ]);
    let told = files.faults("m.yaml");
    let places: Vec<_> = told.iter().map(|(file, line, _)| (file.as_str(), *line)).collect();
    assert_eq!(places, [("m.yaml", 3), ("m.yaml", 4), ("base.yaml", 1), ("base.yaml", 3)], "{told:?}");
}

#[test]
fn items_that_are_not_in_the_list_are_faults_with_the_nearest_name() {
    let change = "extends: base.yaml\nbodies:\n  bal: {}\n  cube: {}\n  7: {}\nlights: { lamp: {} }\n";
    let files = Files::of(&[("base.yaml", BASE), ("m.yaml", change)]);
    let (_, report) = files.read("m.yaml");
    let said: Vec<_> = report.faults.iter().map(|fault| format!("{}; {}", fault.what, fault.hint)).collect();
    assert_eq!(
        said,
        [
            "`bodies`: `bal` is no item of this list of 3; did you mean `ball`?",
            "`bodies`: `cube` is no item of this list of 3; items are named, or numbered from 0 to 2; `+` adds to them",
            "`bodies`: `7` is no item of this list of 3; items are named, or numbered from 0 to 2; `+` adds to them",
            "`lights`: `lamp` is no item of this list of 2; items are named, or numbered from 0 to 1; `+` adds to them",
        ]
    );
}

#[test]
fn an_item_that_is_changed_by_name_and_by_number_is_a_fault_with_both_places() {
    let change = |lines: &str| format!("extends: base.yaml\nbodies:\n{lines}");
    let files = Files::of(&[
        ("base.yaml", BASE),
        ("m.yaml", &change("  ball: { scale: 2 }\n  1: { scale: 3 }\n  0: { at: 0 0 0 m }\n")),
        ("n.yaml", &change("  2: ~\n  right: { scale: 2 }\n")),
        ("sound.yaml", &change("  ball: { scale: 2 }\n  1: { scale: 3 }\n  right: ~\n")),
    ]);
    assert_eq!(files.sound("sound.yaml").0.bodies.len(), 2);
    for (name, line, other, what) in [
        ("m.yaml", 5, 3, "`ball` and `0` are the same item"),
        ("n.yaml", 4, 3, "`2` and `right` are the same item"),
    ] {
        let (_, report) = files.read(name);
        let [fault] = &report.faults[..] else { panic!("{:?}", report.faults) };
        assert!(fault.what.contains(what), "{fault}");
        assert_eq!(fault.place.line_column().unwrap().0, line, "{fault}");
        assert_eq!(fault.also[0].0.line_column().unwrap().0, other, "{fault}");
    }
}

#[test]
fn a_manifest_that_is_missing_hides_no_other_fault_and_makes_none() {
    // All that could be in the missing one is taken to be there; what is wrong in itself is told.
    let sound = "\
bodies: { ball: { velocity: 0 0 0.9 c }, 3: ~, +: [{ asset: cube }] }
lights: { 0: { lamp: { spectrum: sodium } } }
materials: { red: { gloss: { base: blue } }, glass: { glass: { index: 1.5, distance: 1 cm } } }
turntable: { around: ball }
observer: { field_of_view: 220 deg }
exposures: { count: 7 }
picture: { size: 64 64 }
";
    let wrong = "\
observer: { look_at: ball, up: 0 0 0 }
picture: { samples: 0 }
exposures: { to: 1 s }
assets: { cube: { box: { size: 2 } } }
colour: red
";
    let files = Files::of(&[
        ("sound.yaml", &format!("extends: absent.yaml\n{}", sound.replace("exposures: { count: 7 }\n", ""))),
        ("wrong.yaml", &format!("extends: [absent.yaml, part.yaml]\n{wrong}")),
        ("part.yaml", "film: { rate: 0 }\n"),
        ("broken.yaml", "extends: torn.yaml\nobserver: { up: 0 0 0 }\n"),
        ("torn.yaml", "observer: [\n"),
    ]);
    let lines = |name: &str| -> Vec<(String, usize)> {
        files.faults(name).into_iter().map(|(file, line, _)| (file, line)).collect()
    };
    let at = |places: &[(&str, usize)]| -> Vec<(String, usize)> {
        places.iter().map(|(file, line)| ((*file).to_owned(), *line)).collect()
    };
    assert_eq!(lines("sound.yaml"), at(&[("sound.yaml", 1)]), "{:?}", files.faults("sound.yaml"));
    let wrong: Vec<_> = (1..=6).filter(|line| *line != 4).map(|line| ("wrong.yaml", line)).collect();
    assert_eq!(lines("wrong.yaml"), at(&[&wrong[..], &[("part.yaml", 1)]].concat()));
    assert_eq!(lines("broken.yaml"), at(&[("broken.yaml", 2), ("torn.yaml", 2)]));
    // A change that may be one of the missing part is none of the faults.
    let mut report = Report::default();
    let set = [("bodies.ball.scale".to_owned(), "2".to_owned())];
    manifest::load_with(&files.path("sound.yaml"), &set, &mut report);
    assert_eq!(report.faults.len(), 1, "{:?}", report.faults);
}

#[test]
fn a_shorthand_that_is_taken_away_says_nothing() {
    let files = Files::of(&[
        ("base.yaml", BASE),
        ("m.yaml", &format!("turntable: ~\n{}", BASE.replace("output: out/base", "output: out/m"))),
        ("n.yaml", "extends: base.yaml\nturntable: ~\n"),
    ]);
    // There is none to be taken away: that is one fault, and not two.
    let told = files.faults("m.yaml");
    assert!(told.len() == 1 && told[0].2.contains("`turntable` has no value"), "{told:?}");
    let told = files.faults("n.yaml");
    assert!(told.len() == 1 && told[0].2.contains("`turntable` has no value"), "{told:?}");
}

#[test]
fn manifests_extend_one_another_up_to_sixteen_deep() {
    let chain = |count: usize| {
        let mut files: Vec<(String, String)> = (1..count)
            .map(|i| (format!("{i}.yaml"), format!("extends: {}.yaml\nspectra: {{ s{i}: D65 }}\n", i + 1)))
            .collect();
        files.push((format!("{count}.yaml"), "observer: {}\noutput: out\n".to_owned()));
        Files::of(&files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect::<Vec<_>>())
    };
    assert_eq!(chain(17).sound("1.yaml").0.spectra.len(), 16);
    let told = chain(18).faults("1.yaml");
    assert_eq!((told[0].0.as_str(), told.len()), ("17.yaml", 1));
    assert!(told[0].2.contains("more than 16 deep"), "{told:?}");
}

#[test]
fn manifests_that_double_at_each_step_are_refused_soon() {
    let mut files: Vec<(String, String)> =
        (0..12).map(|i| (format!("{i}.yaml"), format!("extends: [{0}.yaml, {0}.yaml]\n", i + 1))).collect();
    files.push(("12.yaml".to_owned(), "observer: {}\noutput: out\n".to_owned()));
    let files: Vec<_> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let told = Files::of(&files).faults("0.yaml");
    assert!(told.iter().all(|(_, _, what)| what.contains("64 in all")), "{told:?}");
    assert!(told.len() < 40, "{}", told.len());
}

#[test]
fn circles_are_named_whole() {
    let files = Files::of(&[
        ("a.yaml", "extends: sub/b.yaml\n"),
        ("sub/b.yaml", "light_speed: 1 m/s\nextends: ../sub/../c.yaml\n"),
        ("c.yaml", "extends: sub/b.yaml\n"),
        ("self.yaml", "extends: ./self.yaml\n"),
    ]);
    let told = files.faults("a.yaml");
    let what = "the manifest `b.yaml` extends itself: b.yaml -> c.yaml -> b.yaml".to_owned();
    assert_eq!(told, [("c.yaml".to_owned(), 1, what)]);
    assert!(files.faults("self.yaml")[0].2.ends_with("self.yaml -> self.yaml"));
}

#[test]
fn an_output_that_is_another_manifests_is_warned_of() {
    let files = Files::of(&[
        ("base.yaml", "observer: {}\noutput: { folder: out, exr: on }\n"),
        ("m.yaml", "extends: base.yaml\n"),
        ("n.yaml", "extends: base.yaml\noutput: { folder: other }\n"),
    ]);
    let (_, report) = files.sound("m.yaml");
    assert_eq!(report.warnings[0].what, "the pictures go where those of `base.yaml` go");
    let (manifest, report) = files.sound("n.yaml");
    assert!(report.warnings.is_empty() && manifest.output.exr.is_some());
}

#[test]
fn films_are_known_again_by_what_is_said_and_not_by_how_it_is_divided() {
    let files = Files::of(&[
        ("base.yaml", "observer: {}\noutput: out\n"),
        ("noted.yaml", "# a note\noutput: out\nobserver: {} # another\n"),
        ("other.yaml", "observer: { at: 0 0 1 m }\noutput: out\n"),
        ("a.yaml", "extends: base.yaml\n"),
        ("b.yaml", "extends: noted.yaml\n"),
        ("c.yaml", "extends: other.yaml\n"),
    ]);
    let digest = |name: &str| {
        let inputs = files.sound(name).1.inputs;
        (inputs.manifest, inputs.of_files())
    };
    assert_eq!(digest("a.yaml"), digest("b.yaml"));
    assert_ne!(digest("a.yaml"), digest("c.yaml"));
}

#[test]
fn files_of_one_name_that_change_places_are_other_inputs_and_folders_that_move_are_not() {
    let of = |root: &str, (a, b): (&str, &str)| {
        let mut inputs = terrell::inputs::Inputs::default();
        inputs.add(&Path::new(root).join("a/p.png"), a.as_bytes());
        inputs.add(&Path::new(root).join("b/p.png"), b.as_bytes());
        inputs.of_files()
    };
    assert_ne!(of("/x", ("red", "blue")), of("/x", ("blue", "red")));
    assert_eq!(of("/x", ("red", "blue")), of("/else/where", ("red", "blue")));
}

#[test]
fn what_is_extended_may_be_no_text_at_all() {
    let files = Files::of(&[
        ("list.yaml", "- a\n"),
        ("m.yaml", "extends: [list.yaml, /dev/zero, folder, absent.yaml]\n"),
        ("folder/x", ""),
    ]);
    let told: Vec<_> = files.faults("m.yaml").into_iter().map(|(file, _, what)| (file, what)).collect();
    assert_eq!(told.len(), 4, "{told:?}");
    assert_eq!(told[3], ("list.yaml".to_owned(), "a manifest is a map of keys; this is a list".to_owned()));
    let ends = ["this is not a file", "this is a folder", "there is no such file"];
    for ((_, what), end) in told.iter().zip(ends) {
        assert!(what.ends_with(end), "{what}");
    }
    let set = [("extends".to_owned(), "other.yaml".to_owned())];
    let mut report = Report::default();
    manifest::parse_with(Path::new("m.yaml"), "observer: {}\noutput: out\n", &set, &mut report);
    assert_eq!(report.faults[0].hint, "write `extends: ..` into it");
}
