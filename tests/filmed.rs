//! Cameras of model files, standing and animated, as observers.

use crate::import::Model;
use crate::support::{light_from, manifested, near, near_vector};
use glam::{DAffine3, DQuat, DVec3, DVec4};
use serde_json::json;
use std::path::Path;
use terrell::error::Report;
use terrell::import::{Channel, Interpolation, Moving, load};
use terrell::manifest;
use terrell::scene::compose;

/// The observer as `observer` says, of the scene in which the walk is.
fn walk(light_speed: &str, observer: &str, more: &str) -> String {
    format!(
        "{{ light_speed: {light_speed}, assets: {{ walk: ../assets/walk.glb, ball: {{ sphere: {{ radius: 1 m }} }} }}, bodies: [{{ asset: walk }}, {{ asset: ball }}], \
         ambient: {{ luminance: 50 cd/m2 }}, observer: {{ {observer} }}, picture: {{ size: 640 360 }}, {more} output: out }}"
    )
}

fn refused(text: &str) -> Vec<(String, String)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("manifests/filmed.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, text, &mut report);
    let scene = manifest.and_then(|manifest| compose(&manifest, &path, &mut report));
    assert!(scene.is_none(), "{text}");
    report.faults.into_iter().map(|fault| (fault.what, fault.hint)).collect()
}

/// Blender's own pictures of points: `assets/walk.csv`, written by tools/blender/walk.py.
#[test]
fn animated_camera_sees_each_point_where_blender_shows_it() {
    let (_, scene, plan) = manifested(&walk("299792458 m/s", "camera: { asset: walk, name: Camera }", ""));
    assert_eq!(plan.exposures.len(), 49);
    let table = std::fs::read_to_string("assets/walk.csv").unwrap();
    let mut rows = 0;
    for row in table.lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
        let view = scene.observer.view(plan.exposures[numbers[0] as usize].tau, 640, 360);
        let point = DVec3::new(numbers[1], numbers[2], numbers[3]);
        let pixel = view.pixel_of(light_from(point, view.tetrad.event).k).unwrap();
        assert!((pixel - glam::DVec2::new(numbers[4], numbers[5])).length() < 0.01, "{row}: {pixel}");
        rows += 1;
    }
    assert!(rows > 60);
}

#[test]
fn still_camera_sees_what_an_observer_written_by_hand_sees() {
    let asset = load(Path::new("assets/walk.glb"), Path::new("assets")).unwrap();
    let camera = asset.cameras.iter().find(|camera| camera.name == "Still").unwrap();
    let DAffine3 { matrix3, translation } = camera.asset_from_camera;
    let text = |v: DVec3| format!("{:e} {:e} {:e}", v.x, v.y, v.z);
    let across = 2.0 * libm::atan(libm::tan(camera.vertical_fov.unwrap() / 2.0) * 640.0 / 360.0);
    let place = "at: 1 2 3 m, velocity: 0.3 -0.2 0.4 c, rotation: 20 deg about 1 1 0";
    let hand = format!(
        "direction: {}, up: {}, field_of_view: {:e} rad",
        text(-matrix3.z_axis),
        text(matrix3.y_axis),
        across
    );
    let by_hand = manifested(&walk("1 m/s", &format!("{hand}, {place}"), "")).1.observer;
    let (_, scene, plan) =
        manifested(&walk("1 m/s", &format!("camera: {{ asset: walk, name: Still }}, {place}"), ""));
    assert_eq!(plan.exposures.len(), 1);
    for tau in [0.0, 2.5] {
        let (ours, theirs) = (scene.observer.view(tau, 640, 360), by_hand.view(tau, 640, 360));
        // S has the hand-written observer at its origin, and the camera beside it at the same time of S.
        let start = by_hand.worldline.at(tau);
        let offset = start.lab_from_camera * terrell::spacetime::FourVector::new(0.0, translation);
        let event = start.event + offset;
        near(ours.tetrad.event.t, event.t, 1e-12);
        near_vector(ours.tetrad.event.x, event.x, 1e-12);
        for pixel in
            [glam::DVec2::new(0.0, 0.0), glam::DVec2::new(320.0, 180.0), glam::DVec2::new(600.0, 20.0)]
        {
            near_vector(ours.ray(pixel).k.x, theirs.ray(pixel).k.x, 1e-12);
        }
    }
}

#[test]
fn field_of_view_and_lens_of_the_manifest_take_the_place_of_the_files() {
    let lens = |more: &str| {
        manifested(&walk("9 m/s", &format!("camera: {{ asset: walk, name: Plan }}, {more}"), ""))
            .1
            .observer
            .lens
    };
    assert_eq!(
        lens("field_of_view: 90 deg"),
        terrell::lens::Lens::Pinhole { across: std::f64::consts::FRAC_PI_2 }
    );
    assert_eq!(lens("lens: panorama"), terrell::lens::Lens::Panorama);
}

fn channel(moving: Moving, interpolation: Interpolation, keys: &[f64], values: &[DVec4]) -> Channel {
    Channel { node: 0, moving, interpolation, keys: keys.to_vec(), values: values.to_vec() }
}

/// glTF 2.0, appendix C.
#[test]
fn values_between_keys_are_those_of_gltf() {
    let four = |x: f64| DVec4::new(x, 2.0 * x, -x, 0.0);
    let keys = [0.5, 1.0, 3.0];
    let step = channel(Moving::Translation, Interpolation::Step, &keys, &[four(1.0), four(5.0), four(2.0)]);
    let linear = Channel { interpolation: Interpolation::Linear, ..step.clone() };
    for (t, held, straight) in [
        (0.0, 1.0, 1.0),
        (0.5, 1.0, 1.0),
        (0.75, 1.0, 3.0),
        (1.0, 5.0, 5.0),
        (2.0, 5.0, 3.5),
        (9.0, 2.0, 2.0),
    ] {
        assert!(
            (step.at(t) - four(held)).length() < 1e-14 && (linear.at(t) - four(straight)).length() < 1e-14,
            "{t}"
        );
    }
    // A cubic is its own Hermite interpolation.
    let (f, slope) = (|t: f64| t * t * t - 2.0 * t + 1.0, |t: f64| 3.0 * t * t - 2.0);
    let values: Vec<_> = keys.iter().flat_map(|t| [four(slope(*t)), four(f(*t)), four(slope(*t))]).collect();
    let cubic = channel(Moving::Scale, Interpolation::CubicSpline, &keys, &values);
    for t in [0.5, 0.7, 0.99, 1.0, 1.4, 2.6, 3.0] {
        assert!((cubic.at(t) - four(f(t))).length() < 1e-12, "{t}");
    }
    assert!(
        (cubic.at(0.0) - four(f(0.5))).length() < 1e-12 && (cubic.at(7.0) - four(f(3.0))).length() < 1e-12
    );
    // Turns go at an even pace, the shorter way, whichever of its two quaternions is written.
    let axis = DVec3::new(1.0, -2.0, 2.0) / 3.0;
    let turn = |angle: f64| DQuat::from_axis_angle(axis, angle);
    for sign in [1.0, -1.0] {
        let written = [DVec4::from(turn(0.2)), sign * DVec4::from(turn(1.4))];
        let turning = channel(Moving::Rotation, Interpolation::Linear, &[0.0, 2.0], &written);
        for (t, angle) in [(0.0, 0.2), (0.5, 0.5), (1.0, 0.8), (1.7, 1.22)] {
            let got = DQuat::from_vec4(turning.at(t));
            near(
                (got * DVec3::Z - turn(angle) * DVec3::Z).length()
                    + (got * DVec3::X - turn(angle) * DVec3::X).length(),
                0.0,
                1e-13,
            );
        }
    }
}

/// A camera on an arm (node 1) that turns by 90° about y in two seconds while it moves; its own node is 2.
fn crane() -> Model {
    let mut model = Model::triangle();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let seconds = model.floats("SCALAR", &[0.0, 2.0]);
    let turns = model.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half]);
    let places = model.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    model.json["cameras"] =
        json!([{ "name": "Eye", "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }]);
    model.json["nodes"] = json!([
        { "mesh": 0 }, { "name": "Arm", "children": [2] }, { "camera": 0, "translation": [0, 0, 3] },
    ]);
    model.json["scenes"] = json!([{ "nodes": [0, 1] }]);
    model.json["animations"] = json!([{ "name": "Swing", "samplers": [
        { "input": seconds, "output": turns }, { "input": seconds, "output": places, "interpolation": "LINEAR" }], "channels": [
        { "sampler": 0, "target": { "node": 1, "path": "rotation" } }, { "sampler": 1, "target": { "node": 1, "path": "translation" } }] }]);
    model
}

/// The observer in a folder with the model.
fn swung(model: &Model, observer: &str) -> Result<terrell::scene::Scene, Vec<(String, String)>> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("model.glb"), model.glb()).unwrap();
    let text = format!(
        "{{ light_speed: 10 m/s, assets: {{ model: model.glb }}, observer: {{ {observer} }}, output: out }}"
    );
    let path = folder.path().join("m.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, &text, &mut report);
    let scene = manifest.and_then(|manifest| compose(&manifest, &path, &mut report));
    scene.ok_or_else(|| report.faults.into_iter().map(|fault| (fault.what, fault.hint)).collect())
}

/// Where the arm has it: by hand. Light goes 10 m in a second, so the swing ends at 20 m of time.
#[test]
fn camera_on_an_arm_goes_round_with_it() {
    let scene = swung(&crane(), "camera: { asset: model }").unwrap();
    let worldline = &scene.observer.worldline;
    for part in [0.0, 0.125, 0.3, 0.5, 0.81, 1.0] {
        let (sin, cos) = libm::sincos(part * std::f64::consts::FRAC_PI_2);
        let tau = worldline.tau_at_start(20.0 * part);
        let view = scene.observer.view(tau, 40, 30);
        near_vector(view.tetrad.event.x, DVec3::new(part + 3.0 * sin, 0.0, 3.0 * cos), 2e-3);
        near(view.tetrad.event.t, 20.0 * part, 1e-12);
        // It looks along -z of the arm, in the axes that the observer carries.
        let ahead = worldline.at(tau).direction_of(view.ray(glam::DVec2::new(20.0, 15.0)).k);
        near_vector(ahead, DVec3::new(-sin, 0.0, -cos), 1e-6);
    }
    let middle = worldline.at(worldline.tau_at_start(10.0)).velocity();
    let speed = DVec3::new(0.05, 0.0, 0.0)
        + DVec3::new(1.0, 0.0, -1.0) * (0.5_f64.sqrt() * 3.0 * std::f64::consts::FRAC_PI_2 / 20.0);
    near_vector(middle.x / middle.t, speed, 2e-3);
}

#[test]
fn camera_that_is_too_fast_is_refused_with_its_keys_and_the_rate_that_is_not() {
    let faults = refused(&walk("3 m/s", "camera: { asset: walk, name: Camera }", ""));
    assert!(!faults.is_empty());
    for (what, hint) in &faults {
        assert!(what.starts_with("between keys ") && what.contains("`Camera` reaches "), "{what}");
        assert!(hint.starts_with("rate: 0."), "{hint}");
    }
    let slower = format!("camera: {{ asset: walk, name: Camera, {} }}", faults[0].1);
    let (_, scene, plan) = manifested(&walk("3 m/s", &slower, ""));
    let fastest = plan.exposures.iter().map(|exposure| {
        let u = scene.observer.worldline.at(exposure.tau).velocity();
        u.x.length() / u.t
    });
    let fastest = fastest.fold(0.0, f64::max);
    assert!(fastest > 0.85 && fastest < 0.96, "{fastest}");
    // Of an arm that swings 3 m round in 2 s: 2.36 m/s and 0.5 m/s of its own.
    let at_two = swung(&crane(), "camera: { asset: model, rate: 4 }").unwrap_err();
    assert!(at_two[0].0.starts_with("between keys 1 and 2 of the file (0.000 s and 2.000 s)"), "{at_two:?}");
}

#[test]
fn camera_that_jumps_is_refused_and_one_that_turns_at_once_is_not() {
    let mut model = crane();
    model.json["animations"][0]["samplers"][1]["interpolation"] = json!("STEP");
    let faults = swung(&model, "camera: { asset: model }").unwrap_err();
    assert!(faults[0].0.contains("between keys 1 and 2") && faults[0].1.contains("jumps"), "{faults:?}");
    let mut model = crane();
    model.json["animations"][0]["channels"] =
        json!([{ "sampler": 0, "target": { "node": 2, "path": "rotation" } }]);
    model.json["animations"][0]["samplers"][0]["interpolation"] = json!("STEP");
    let observer = swung(&model, "camera: { asset: model }").unwrap().observer;
    let ahead = |tau: f64| {
        let view = observer.view(tau, 40, 30);
        -view.ray(glam::DVec2::new(20.0, 15.0)).k.x
    };
    near_vector(ahead(19.99), DVec3::NEG_Z, 1e-7);
    near_vector(ahead(20.01), DVec3::NEG_X, 1e-6);
}

#[test]
fn exposures_of_an_animated_camera_are_its_animation_unless_said() {
    let camera = "camera: { asset: walk, name: Camera, rate: 0.25 }";
    let film = |more: &str| {
        let (manifest, scene, plan) = manifested(&walk("9 m/s", camera, more));
        let times: Vec<f64> = plan
            .exposures
            .iter()
            .map(|exposure| scene.observer.worldline.at(exposure.tau).event.t / 9.0)
            .collect();
        (manifest.film.is_some(), times)
    };
    let (filmed, times) = film("");
    assert!(filmed && times.len() == 193);
    near(times[0], 0.0, 1e-12);
    near(times[96], 4.0, 1e-12);
    near(times[192], 8.0, 1e-12);
    let (_, times) = film("exposures: { count: 5 },");
    near(times[1], 2.0, 1e-12);
    assert_eq!(times.len(), 5);
    let (_, times) = film("exposures: { at: 3 s, clock: lab },");
    assert_eq!(times.len(), 1);
    near(times[0], 3.0, 1e-12);
}

#[test]
fn camera_that_is_none_is_refused_with_what_to_type() {
    let says = |observer: &str, words: &str, hint: &str| {
        let faults = refused(&walk("9 m/s", observer, ""));
        assert!(faults.len() == 1 && faults[0].0.contains(words) && faults[0].1.contains(hint), "{faults:?}");
    };
    says("camera: { asset: walk }", "has 3 cameras", "name: Camera (its cameras are: Camera, Still, Plan)");
    says(
        "camera: { asset: walk, name: Camra }",
        "no camera named `Camra`",
        "did you mean `Camera`? its cameras are: Camera, ",
    );
    says("camera: { asset: walk, name: Steel }", "no camera named `Steel`", "its cameras are: Still, ");
    says("camera: { asset: walk, name: Drone }", "no camera named `Drone`", "its cameras are: ");
    says("camera: { asset: walk, name: Plan }", "orthographic", "field_of_view: 50 deg");
    let faults = refused(&walk("9 m/s", "camera: { asset: walk, name: Still }", "exposures: { count: 4 },"));
    assert!(faults.len() == 1 && faults[0].0.contains("is not animated"), "{faults:?}");
    says("camera: { asset: ball }", "is a shape", "model file");
    says(
        "camera: { asset: walk, name: Camera, animation: Amr }",
        "no animation named `Amr`",
        "did you mean `Arm`?",
    );
    says("camera: { asset: wlak }", "no asset named `wlak`", "did you mean `walk`?");
}

/// Only one of the two animations.
#[test]
fn animation_that_is_named_moves_the_camera_alone() {
    let camera = "camera: { asset: walk, name: Camera, animation: Arm }";
    let (_, scene, _) = manifested(&walk("9 m/s", camera, ""));
    let rig = &scene.observer.filmed.as_ref().unwrap().rig;
    assert_eq!(rig.channels().count(), 2);
    let mut model = crane();
    let twice = model.json["animations"][0].clone();
    model.json["animations"].as_array_mut().unwrap().push(twice);
    let faults = swung(&model, "camera: { asset: model }").unwrap_err();
    assert!(
        faults[0].0.contains("several animations move `Arm`") && faults[0].1 == "animation: Swing",
        "{faults:?}"
    );
}

#[test]
fn animations_are_read_for_cameras_only_and_broken_ones_are_left_out_with_a_warning() {
    let mut model = crane();
    assert_eq!(model.asset().animations[0].channels.len(), 2);
    model.json["nodes"][2].as_object_mut().unwrap().remove("camera");
    assert!(model.asset().animations[0].channels.is_empty() && model.asset().warnings.is_empty());
    let broken = [
        ("/animations/0/samplers/0/input", json!(99)),
        ("/animations/0/samplers/0/output", json!(null)),
        ("/animations/0/samplers/0/interpolation", json!("BEZIER")),
        ("/animations/0/channels/0/sampler", json!(7)),
        ("/accessors/2/count", json!(1)),
        ("/accessors/3/type", json!("VEC3")),
    ];
    for (at, value) in broken {
        let mut model = crane();
        model.json["animations"][0]["samplers"][0]["interpolation"] = json!("LINEAR");
        *model.json.pointer_mut(at).unwrap() = value;
        let asset = model.asset();
        assert!(crate::import::warns(&asset, "animations[0].channels[0]"), "{at}: {:?}", asset.warnings);
        assert!(asset.animations[0].channels.len() <= 1);
    }
}
