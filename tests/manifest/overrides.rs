//! Values of the command line.

use super::read_with;
use std::path::Path;
use terrell::error::Report;
use terrell::manifest::{self, Body, SolidForm, Worldline};

const TEXT: &str = "\
assets: { ball: { sphere: { radius: 1 m } }, cube: { box: { size: 1 m } } }
bodies: [{ asset: ball }, { asset: cube, name: left }, { asset: cube, name: right }]
observer: { orbit: { radius: 4 m, speed: 0.5 c }, up: 1 0 0 }
film: { rate: 12 }
output: out
";

fn refused(key: &str, value: &str) -> String {
    let mut report = Report::default();
    let set = [(key.to_owned(), value.to_owned())];
    assert!(manifest::parse_with(Path::new("m.yaml"), TEXT, &set, &mut report).is_none());
    let fault = report.faults.first().unwrap();
    format!("{}; {}", fault.what, fault.hint)
}

#[test]
fn bodies_are_changed_by_name() {
    let m = read_with(
        TEXT,
        &[("bodies.right.scale", "2"), ("bodies.ball.at", "0 1 0 m"), ("bodies.1.scale", "3")],
    );
    let scales: Vec<_> = m.bodies.iter().map(|body| body.scale.x).collect();
    assert_eq!((scales, m.bodies[0].placement.at.y), (vec![1.0, 3.0, 2.0], 1.0));
    assert_eq!(
        refused("bodies.cube.scale", "2"),
        "`cube` is no item of this list of 3; items are named, or numbered from 0 to 2; `+` adds to them"
    );
    assert!(refused("bodies.rigth.scale", "2").ends_with("did you mean `right`?"));
}

#[test]
fn keys_and_items_are_taken_away() {
    let m = read_with(TEXT, &[("observer.orbit", "~"), ("bodies.left", "~"), ("film", "null")]);
    assert!(matches!(m.observer.worldline, Worldline::Rest) && m.film.is_none());
    assert_eq!(m.bodies.iter().map(Body::known_as).collect::<Vec<_>>(), ["ball", "right"]);
    assert_eq!(refused("observer.obit", "~"), "there is no `obit` to be taken away; did you mean `orbit`?");
    assert_eq!(refused("output", "~"), "a manifest needs `output`; output: ../out/flyby");
    assert!(
        refused("observer.up", "")
            .ends_with("--set observer.up=.., or --set 'observer.up=~' to take it away")
    );
}

#[test]
fn a_key_beside_a_text_is_told_as_the_map_in_which_both_stand() {
    let told = refused("output.png", "16");
    assert_eq!(
        told,
        "there is the text `out` here, which has no `png`; --set output=\"{ folder: out, png: 16 }\""
    );
    let m = read_with(TEXT, &[("output", "{ folder: out, png: 16 }")]);
    assert_eq!(m.output.png, 16);
    let told = refused("output.exr.depth", "half");
    assert!(told.ends_with("--set output=\"{ folder: out, exr: { depth: half } }\""), "{told}");
    // Where no such map is, that there are examples.
    assert!(refused("observer.up.left", "1").contains("--set observer.velocity="));
}

#[test]
fn a_key_that_is_nearly_right_is_told_as_the_whole_argument() {
    assert!(refused("picture.sample", "16").ends_with("; --set picture.samples=16"));
    assert!(refused("observer.fov", "40 deg").ends_with("; --set observer.field_of_view=40 deg"));
    assert!(refused("picture", "{ sample: 16 }").ends_with("; --set picture={ samples: 16 }"));
}

#[test]
fn words_of_other_programs_are_understood() {
    for (text, meant) in [
        ("observer: { fov: 40 deg }", "field_of_view"),
        ("materials: { a: { glass: { index: BK7, colour: { rgb: 1 0 0 } } } }", "color"),
        ("materials: { a: { colour: { rgb: 1 0 0 } } }", "diffuse"),
        ("picture: { resolution: 64 36 }", "size"),
        ("picture: { spp: 4 }", "samples"),
        ("film: { fps: 24 }", "rate"),
        ("camera: { at: 0 0 5 m }", "observer"),
        ("objects: []", "bodies"),
        ("bodies: [{ asset: ball, position: 0 0 0 m }]", "at"),
    ] {
        let mut report = Report::default();
        let text = format!("{{ {text}, assets: {{ ball: {{ sphere: {{ radius: 1 m }} }} }}, output: out }}");
        manifest::parse(Path::new("m.yaml"), &text, &mut report);
        let told =
            report.faults.iter().any(|fault| fault.hint.starts_with(&format!("did you mean `{meant}`?")));
        assert!(told, "{text}: {:?}", report.faults);
    }
}

#[test]
fn items_are_added() {
    let m =
        read_with(TEXT, &[("bodies.+", "{ asset: ball, name: more }"), ("lights.+.lamp.intensity", "3 cd")]);
    assert_eq!((m.bodies.len(), m.bodies[3].known_as(), m.lights.len()), (4, "more", 1));
}

#[test]
fn one_of_several_alternatives_takes_the_others_away() {
    let m = read_with(TEXT, &[("observer.rocket.acceleration", "0 0 1 g")]);
    assert!(matches!(m.observer.worldline, Worldline::Rocket(_)));
    let m = read_with(TEXT, &[("assets.ball.box.size", "2 m")]);
    assert!(matches!(m.assets["ball"].solid().unwrap().form, SolidForm::Box(_)));
}
