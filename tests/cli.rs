//! The program as a user meets it: what it leaves on the disk, what it says, how it ends.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn top(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

pub(crate) fn terrell(arguments: &[&str]) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_terrell")).current_dir(top("")).args(arguments).output();
    program.unwrap()
}

pub(crate) fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Renders into a folder of its own.
fn rendered(arguments: &[&str]) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap().to_owned();
    let output = terrell(&[&["render"], arguments, &["--out", &out]].concat());
    (folder, output)
}

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

const SMALL: [&str; 5] = ["manifests/flyby.yaml", "--size", "32x18", "--samples", "2"];

#[test]
fn rendering_leaves_every_picture_and_the_film_and_nothing_else() {
    let (folder, output) = rendered(&[&SMALL[..], &["--set", "exposures.count=3"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let film: &[&str] = if cfg!(feature = "video") { &["flyby.mp4"] } else { &[] };
    assert_eq!(names(&folder), [&["0000.png", "0001.png", "0002.png"], film].concat());
    let picture = image::open(folder.path().join("0001.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (32, 18));
}

#[test]
fn one_thread_and_two_leave_the_same_bytes() {
    let arguments =
        [&SMALL[..], &["--set", "exposures.count=4", "--set", "output={ folder: x, exr: on }"]].concat();
    let bytes = |threads: &str| {
        let (folder, output) = rendered(&[&arguments[..], &["--threads", threads]].concat());
        assert!(output.status.success(), "{}", said(&output));
        let read = |name: String| (std::fs::read(folder.path().join(&name)).unwrap(), name);
        names(&folder).into_iter().map(read).collect::<Vec<_>>()
    };
    let one = bytes("1");
    assert!(one.len() >= 8);
    assert!(one == bytes("2"));
}

#[test]
fn one_exposure_alone_is_the_same_as_in_the_film() {
    let film = rendered(&[&SMALL[..], &["--set", "exposures.count=4"]].concat()).0;
    let (alone, _) = rendered(&[&SMALL[..], &["--set", "exposures.count=4", "--exposure", "2"]].concat());
    assert_eq!(names(&alone), ["0002.png"]);
    let read = |folder: &tempfile::TempDir| std::fs::read(folder.path().join("0002.png")).unwrap();
    assert!(read(&film) == read(&alone));
}

#[test]
fn faults_are_all_said_at_their_places_and_the_exit_code_is_two() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.yaml");
    std::fs::write(
        &path,
        "assets: { head: nowhere.glb }\nbodies:\n  - { asset: head, velocty: 0.9 0 0 c }\n  - { asset: head, at: 1 2 3 }\n\
         observer: { velocity: 1.2 0 0 c }\noutput: out\n",
    )
    .unwrap();
    for command in ["check", "render"] {
        let output = terrell(&[command, path.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        let said = said(&output);
        for words in
            ["m.yaml:3:20", "did you mean `velocity`?", "m.yaml:4:24", "at: 1 2 3 m", "m.yaml:5:23", "1.2 c"]
        {
            assert!(said.contains(words), "{words} is missing in\n{said}");
        }
    }
}

#[test]
fn missing_model_node_and_material_are_named_with_what_there_is() {
    let set = |key_value: &str| said(&terrell(&["check", "manifests/flyby.yaml", "--set", key_value]));
    assert!(set("assets.monkey=../assets/monky.glb").contains("monky.glb"));
    let node = set("assets.studio={ file: ../assets/studio.glb, node: Flor }");
    assert!(node.contains("no node named `Flor`") && node.contains("did you mean `Floor`?"), "{node}");
    let material = set("bodies.0.materials={ Skinn: mirror }");
    assert!(material.contains("no material named `Skinn`") && material.contains("`Skin`"), "{material}");
}

#[test]
fn folder_that_cannot_be_written_is_the_machines_fault() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = folder.path().join("file");
    std::fs::write(&blocked, "").unwrap();
    let out = blocked.join("in").to_str().unwrap().to_owned();
    let output = terrell(&[&["render"], &SMALL[..], &["--exposure", "0", "--out", &out]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("file"));
}

#[test]
fn check_says_what_the_scene_needs() {
    let output = terrell(&["check", "manifests/flyby.yaml"]);
    let said = said(&output);
    assert!(output.status.success());
    for words in ["no faults", "2 in 2 rest frames", "96 of 1280 x 720", "flyby.mp4"] {
        assert!(said.contains(words), "{words} is missing in\n{said}");
    }
}

/// A grey and a skin-coloured ball in daylight, of which the lamp and the balls recede or rest.
fn receding(beta: f64) -> String {
    let skin = "{ table: [[400, 0.18], [450, 0.22], [500, 0.28], [570, 0.32], [600, 0.5], [700, 0.6]] }";
    format!(
        "light_speed: 1 m/s
assets: {{ ball: {{ sphere: {{ radius: 1 m }} }} }}
bodies:
  - {{ asset: ball, at: 0 0 0 m, velocity: 0 0 -{beta} c, material: {{ diffuse: {skin} }} }}
lights: [ {{ sun: {{ illuminance: 50000 lx, spectrum: LIGHT }}, velocity: 0 0 -{beta} c }} ]
observer: {{ at: 0 0 4 m, look_at: 0 0 0 m }}
exposures: {{ from: 0 s, to: 0 s, count: 1 }}
picture: {{ size: 64 36 }}
output: out
"
    )
}

#[test]
fn check_says_when_more_wavelengths_are_needed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.yaml");
    let check = |light: &str| {
        std::fs::write(&path, receding(0.3).replace("LIGHT", light)).unwrap();
        said(&terrell(&["check", path.to_str().unwrap()]))
    };
    // A spectrum of teeth that 16 wavelengths cannot see, and one as smooth as can be.
    let teeth: Vec<String> = (0..46).map(|i| format!("[{}, {}]", 300 + 10 * i, i % 2)).collect();
    let rough = check(&format!("{{ table: [{}] }}", teeth.join(", ")));
    assert!(rough.contains("write `wavelengths: "), "{rough}");
    let smooth = check("{ black_body: 5000 K }");
    assert!(smooth.contains("would differ by less") && !smooth.contains("write `wavelengths: "), "{smooth}");
}

#[test]
fn pictures_too_small_for_a_film_can_be_made_alone() {
    let small = ["manifests/flyby.yaml", "--size", "12x8"];
    let film = terrell(&[&["render"], &small[..]].concat());
    assert!(!film.status.success() && said(&film).contains("a film cannot be 12 x 8"), "{}", said(&film));
    let (folder, output) = rendered(&[&small[..], &["--exposure", "3"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(names(&folder), ["0003.png"]);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let chart =
        terrell(&[&["chart"], &small[..], &["--runs", "1", "--reference", "8", "--out", out]].concat());
    assert!(chart.status.success(), "{}", said(&chart));
}

#[test]
fn inspect_names_what_can_be_copied_into_a_manifest() {
    let tree = said(&terrell(&["inspect", "assets/studio.glb"]));
    assert!(tree.contains("Floor") && tree.contains("Backdrop") && tree.contains("materials"));
    let json = terrell(&["inspect", "--json", "assets/street.glb"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(json["cameras"][0], "Camera");
    assert_eq!(json["lights"], 10);
}

#[test]
fn inspect_says_what_each_material_is_and_what_is_passed_over() {
    let materials = serde_json::json!([
        { "name": "Glass", "alphaMode": "MASK", "doubleSided": true,
          "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0.25 },
          "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1 },
            "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": [1, 0, 0] },
            "KHR_materials_ior": { "ior": 1.75 }, "KHR_materials_dispersion": { "dispersion": 0.5 },
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.5 }, "KHR_materials_sheen": {},
        } },
        { "name": "Clay", "pbrMetallicRoughness": { "metallicFactor": 0 },
          "extensions": { "KHR_materials_specular": { "specularFactor": 0 } } },
    ]);
    let model = serde_json::json!({ "asset": { "version": "2.0" }, "materials": materials });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    std::fs::write(&path, model.to_string()).unwrap();
    let output = terrell(&["inspect", path.to_str().unwrap()]);
    let tree = said(&output);
    let words = [
        "cut out where alpha is below 0.500",
        "metallic 0.000",
        "roughness 0.250",
        "refractive index 1.750",
        "solid glass, transmission 1.000",
        "absorbs to 1.000 0.000 0.000 in 0.5000 m",
        "dispersion 0.500",
        "clearcoat 0.500 of roughness 0.000",
        "two-sided; passed over: KHR_materials_sheen",
        "Clay: colour 1.000 1.000 1.000 (linear), diffuse\n",
    ];
    for words in words {
        assert!(tree.contains(words), "{words}: {tree}");
    }
    let json = terrell(&["inspect", "--json", path.to_str().unwrap()]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let [glass, clay] = [&json["materials"][0], &json["materials"][1]];
    assert_eq!((&glass["coverage"], &glass["cutoff"]), (&"mask".into(), &0.5.into()));
    assert_eq!((&glass["ior"], &glass["transmission"]), (&1.75.into(), &1.0.into()));
    assert_eq!(glass["volume"]["attenuation_distance"], 0.5);
    assert_eq!(glass["clearcoat"]["strength"], 0.5);
    assert_eq!(glass["ignored"][0], "KHR_materials_sheen");
    assert_eq!((&clay["clearcoat"], &clay["specular"]["strength"]), (&serde_json::Value::Null, &0.0.into()));
}

#[test]
fn every_committed_manifest_is_without_fault() {
    let found = |folder: &str| {
        let entries = std::fs::read_dir(top(folder)).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        paths.filter(|path| path.extension().is_some_and(|e| e == "yaml")).collect::<Vec<_>>()
    };
    let manifests = [found("manifests"), found("tools/mitsuba")].concat();
    assert!(manifests.len() >= 6);
    for manifest in manifests {
        let output = terrell(&["check", manifest.to_str().unwrap()]);
        assert!(output.status.success(), "{}", said(&output));
    }
}

#[test]
fn both_importers_read_what_blender_wrote_of_the_same_head() {
    let extent = |model: &str| {
        let json = terrell(&["inspect", "--json", model]);
        let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
        let number = |end: usize, axis: usize| json["extent"][end][axis].as_f64().unwrap();
        std::array::from_fn::<f64, 6, _>(|i| number(i / 3, i % 3))
    };
    let (glb, obj) = (extent("assets/monkey.glb"), extent("assets/monkey.obj"));
    // The OBJ is coarser, so it is a little smaller.
    assert!(glb.iter().zip(obj).all(|(a, b)| (a - b).abs() < 0.05 * a.abs()), "{glb:?} {obj:?}");
}

#[test]
fn chart_leaves_a_drawing_and_a_table_and_names_settings() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let small = ["manifests/flyby.yaml", "--size", "32x18", "--runs", "1", "--reference", "8"];
    let output = terrell(&[&["chart"], &small[..], &["--out", out]].concat());
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(names(&folder), ["chart.csv", "chart.svg"]);
    for words in ["the default, 4 samples, 16 wavelengths", "--tolerance 1", "just noticeable"] {
        assert!(said(&output).contains(words), "{words}: {}", said(&output));
    }
    let beyond = terrell(&[&["chart"], &small[..], &["--exposure", "96"]].concat());
    assert_eq!(beyond.status.code(), Some(2));
    assert!(said(&beyond).contains("numbered from 0 to 95"), "{}", said(&beyond));
}

#[test]
fn tolerance_is_told_how_it_was_met_and_refuses_what_is_none() {
    let (_, output) =
        rendered(&["manifests/flyby.yaml", "--size", "32x18", "--exposure", "40", "--tolerance", "8"]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("99 of 100 pixels are within CIEDE2000"), "{}", said(&output));
    for wrong in ["0.01", "much"] {
        let (_, output) = rendered(&["manifests/flyby.yaml", "--tolerance", wrong]);
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains("tolerance"), "{}", said(&output));
    }
}

#[test]
fn faults_of_flags_name_the_flags() {
    for (flag, wrong, right) in [
        ("--tolerance", "banana", "--tolerance 1"),
        ("--tolerance", "-1", "--tolerance 1"),
        ("--samples", "0", "--samples "),
        ("--samples", "x", "--samples "),
    ] {
        let (_, output) = rendered(&["manifests/unseen.yaml", &format!("{flag}={wrong}")]);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(&format!("{flag}: `{wrong}`")) && !said.contains("--set"), "{said}");
        assert!(said.contains(right), "{said}");
    }
}

#[test]
fn scale_makes_what_the_size_would() {
    // The film that `--size` began is the one that `--scale` goes on with.
    let few = ["manifests/flyby.yaml", "--samples", "1", "--no-video", "--set", "exposures.count=2"];
    let (folder, output) = rendered(&[&few[..], &["--size", "32x18"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let out = folder.path().to_str().unwrap();
    let again = terrell(&[&["render"], &few[..], &["--scale", "0.025", "--out", out]].concat());
    assert!(again.status.success() && said(&again).contains("2 of 2 pictures"), "{}", said(&again));
    // Rounded, at least 1; halves for two eyes stay halves, and a panorama twice as wide as high.
    let eyes = "observer={ stereo: { apart: 6 cm } }";
    let panorama = "observer={ lens: panorama }";
    for (size, scale, observer, sides) in [
        ("33 9", "0.5", "observer.at=0 0 5 m", (17, 5)),
        ("40 3", "0.1", "observer.at=0 0 5 m", (4, 1)),
        ("12 9", "2", "observer.at=0 0 5 m", (24, 18)),
        ("42 20", "0.5", eyes, (22, 10)),
        ("42 21", "0.5", panorama, (22, 11)),
    ] {
        let size = format!("picture.size={size}");
        let arguments =
            ["manifests/flyby.yaml", "--exposure", "0", "--set", &size, "--set", observer, "--scale", scale];
        let (folder, output) = rendered(&arguments);
        assert!(output.status.success(), "{}", said(&output));
        let picture = image::open(folder.path().join("0000.png")).unwrap();
        assert_eq!((picture.width(), picture.height()), sides, "{arguments:?}");
    }
    for wrong in ["0", "-1", "nan", "inf", "a quarter", "1e9"] {
        let (_, output) = rendered(&["manifests/flyby.yaml", "--scale", wrong]);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        assert!(said(&output).contains("help: --scale "), "{wrong}: {}", said(&output));
    }
    let both = terrell(&["render", "manifests/flyby.yaml", "--scale", "0.5", "--size", "32x18"]);
    assert!(said(&both).contains("cannot be used with"), "{}", said(&both));
}

#[test]
fn of_several_manifests_all_are_checked_before_the_first_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let lit = "ambient: { luminance: 20 cd/m2 }\nassets: { a: { sphere: { radius: 1 m } } }\nbodies: [{ asset: a }]\n\
               picture: { size: 16 16 }\nobserver: { at: 0 0 5 m }\n";
    let one = write("one.yaml", &format!("{lit}output: one\n"));
    let two = write("two.yaml", &format!("{lit}output: two\n"));
    let faulty = write("faulty.yaml", &format!("{lit}output: three\nliights: []\n"));
    let fast = write("fast.yaml", &format!("{lit}output: four\nexposures: {{ at: 0 s, counnt: 1 }}\n"));
    let output = terrell(&["render", &one, &faulty, &two, &fast]);
    assert_eq!(output.status.code(), Some(2));
    for words in ["faulty.yaml:7:1", "`liights`", "fast.yaml:7:23", "`counnt`"] {
        assert!(said(&output).contains(words), "{words}: {}", said(&output));
    }
    assert!(!folder.path().join("one").exists());
    // A fault of the command is told once.
    let output = terrell(&["render", &one, &two, "--exposure", "1"]);
    assert_eq!(said(&output).matches("there is no exposure 1").count(), 1, "{}", said(&output));
    // Pictures of another film stay, and the others are rendered.
    assert!(terrell(&["render", &one]).status.success());
    let output = terrell(&["render", &one, &two, "--samples", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("--restart") && folder.path().join("two/0000.png").exists());
    assert!(!folder.path().join("three").exists());
}

/// A ball that a fisheye, a panorama or two eyes look at.
const LOOKING: &str = "ambient: { luminance: 20 cd/m2 }
assets: { a: { sphere: { radius: 1 m } } }
bodies: [{ asset: a }]
observer: { at: 0 0 5 m, OBSERVER }
exposures: { from: 0 s, to: 1 s, count: 2 }
picture:
  samples: 1
  size: SIZE
film: { file: f.gif, rate: RATE }
output: out
";

#[test]
fn faults_of_the_size_are_told_where_it_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.yaml");
    let file = path.to_str().unwrap();
    let write = |observer: &str, size: &str, rate: &str| {
        let text = LOOKING.replace("OBSERVER", observer).replace("SIZE", size).replace("RATE", rate);
        std::fs::write(&path, text).unwrap();
    };
    let render = |arguments: &[&str]| {
        let one = ["render", file, "--exposure", "0"];
        said(&terrell(&[&one, arguments].concat()))
    };
    let tell = |said: &str, words: &[&str]| {
        for word in words {
            assert!(said.contains(word), "{word}: {said}");
        }
    };
    // In the file, in its line.
    write("stereo: { apart: 6 cm }", "33 16", "24");
    tell(&render(&[]), &["m.yaml:8:9", "help: size: 34 16"]);
    write("lens: panorama", "32 9", "24");
    tell(&render(&[]), &["m.yaml:8:9", "squeezed", "help: size: 18 9"]);
    write("lens: fisheye", "32 16", "24");
    tell(&render(&[]), &["m.yaml:8:9", "cut above and below", "help: size: 16 16"]);
    // By the flag.
    write("stereo: { apart: 6 cm }", "32 16", "24");
    tell(&render(&["--size", "33x16"]), &["error: --size: ", "the command line", "help: --size 34x16"]);
    write("lens: panorama", "32 16", "24");
    tell(&render(&["--size", "40x10"]), &["warning: --size: ", "help: --size 20x10"]);
    assert!(!render(&["--scale", "0.3"]).contains("warning"));
    write("lens: fisheye", "16 16", "24");
    tell(&render(&["--size", "40x10"]), &["warning: --size: ", "help: --size 10x10"]);
    tell(&render(&["--size", "100000x100000"]), &["error: --size: ", "help: --size 1280x720"]);
    // A fisheye that fills its picture is as it is meant.
    write("lens: fisheye, field_of_view: 120 deg", "32 16", "24");
    assert!(!render(&[]).contains("warning"), "{}", render(&[]));
    // Films.
    write("direction: 0 0 -1", "32 16", "60");
    tell(&said(&terrell(&["render", file])), &["m.yaml:9:28", "at most 50", "help: rate: 50"]);
    if cfg!(feature = "video") {
        write("direction: 0 0 -1", "32 16", "24");
        let film = ["render", file, "--set", "film.file=f.mp4", "--size", "8x4"];
        tell(
            &said(&terrell(&film)),
            &["--size: a film cannot be 8 x 4", "help: --size 32x16, or --no-video"],
        );
        let film = ["render", file, "--set", "film.file=f.mp4", "--scale", "0.25"];
        tell(
            &said(&terrell(&film)),
            &["--scale: a film cannot", "help: --size 32x16 in place of --scale, or"],
        );
    }
}

#[test]
fn what_is_no_manifest_and_no_folder_is_said_with_what_to_type() {
    for command in ["check", "render"] {
        let output = terrell(&[command, "assets/die.glb"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains("terrell new assets/die.glb"), "{}", said(&output));
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "text").unwrap();
    let out = file.to_str().unwrap();
    for command in [&["render"][..], &["chart", "--runs", "1"]] {
        let output = terrell(&[command, &["manifests/flyby.yaml", "--exposure", "0", "--out", out]].concat());
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("help: --out FOLDER"), "{}", said(&output));
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "text");
    // What is wrong with a model is told before that its manifest is there.
    let new = |model: &str| said(&terrell(&["new", model, "-o", out]));
    assert!(new("README.md").contains("not a kind of model file"), "{}", new("README.md"));
    assert!(new("assets/die.glb").contains("--force"));
}

#[test]
fn one_thing_is_said_in_the_singular() {
    let inspected = said(&terrell(&["inspect", "assets/monkey.glb"]));
    assert!(inspected.contains("triangles shown, 1 mesh\n"), "{inspected}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.yaml");
    let text =
        LOOKING.replace("OBSERVER", "direction: 0 0 -1").replace("SIZE", "16 16").replace("RATE", "24");
    let monkey = top("assets/monkey.glb");
    std::fs::write(&path, text.replace("{ sphere: { radius: 1 m } }", monkey.to_str().unwrap())).unwrap();
    let checked = said(&terrell(&["check", path.to_str().unwrap()]));
    for words in ["1 in 1 rest frame\n", "1 mesh with a tree\n", "1 sample each pixel\n"] {
        assert!(checked.contains(words), "{words}: {checked}");
    }
}

#[test]
fn new_writes_a_manifest_that_is_sound_and_never_over_another() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("die.yaml");
    let path = file.to_str().unwrap();
    let new = ["new", "assets/die.glb", "--flyby", "-o", path];
    let output = terrell(&new);
    assert!(output.status.success(), "{}", said(&output));
    let first = std::fs::read(&file).unwrap();
    assert!(terrell(&["check", path]).status.success());
    let again = terrell(&["new", "assets/die.glb", "--turntable", "-o", path]);
    assert_eq!(again.status.code(), Some(2));
    assert!(said(&again).contains("--force") && std::fs::read(&file).unwrap() == first);
    assert!(terrell(&["new", "assets/die.glb", "--turntable", "-o", path, "--force"]).status.success());
    assert!(std::fs::read_to_string(&file).unwrap().contains("\nturntable:"));
}

#[test]
fn faults_of_a_manifest_its_models_and_its_limits_are_told_together() {
    let folder = tempfile::tempdir().unwrap();
    let monkey = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/monkey.glb");
    let write = |text: &str| {
        let file = folder.path().join("m.yaml");
        std::fs::write(&file, text.replace("MONKEY", monkey.to_str().unwrap())).unwrap();
        said(&terrell(&["check", file.to_str().unwrap()]))
    };
    let faulty = write(
        "assets: { a: { file: MONKEY, node: Suzane }, b: absent.glb }\nbodies: [{ asset: a }, { asset: b }, { asset: a, at: 3 }]\n\
         observer: { up: 0 0 0 }\noutput: out\n",
    );
    for fault in ["a place is 3 numbers", "cannot be zero", "no node named `Suzane`", "there is no file"] {
        assert!(faulty.contains(fault), "{fault}: {faulty}");
    }
    let limits = write(
        "assets: { a: { file: MONKEY, node: Suzane } }\nbodies: [{ asset: a }]\n\
         observer: { rocket: { acceleration: 0 0 1 c/s } }\nexposures: { at: 100 s }\noutput: out\n",
    );
    assert!(limits.contains("Lorentz factor is") && limits.contains("no node named"), "{limits}");
}
