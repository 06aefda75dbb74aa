//! What manifests mean.
#![expect(clippy::float_cmp, reason = "what is written exactly is kept exactly")]

use super::{close, complete, read, read_with};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;
use terrell::error::{Place, Report};
use terrell::manifest::{
    self, Amount, Clock, Filter, Illuminant, LightSource, Line, LookAt, Manifest, MaterialKind, Paint,
    Presence, Shape, Spectrum, Strength, View, White, Worldline,
};

pub(super) fn load(name: &str) -> Manifest {
    let mut report = Report::default();
    let manifest = manifest::load(&Path::new("tests/manifests/good").join(name), &mut report);
    assert_eq!((&report.faults, &report.warnings), (&vec![], &vec![]));
    manifest.unwrap()
}

#[test]
fn the_flyby_means_what_it_says() {
    let flyby = load("flyby.yaml");
    assert_eq!(flyby.light_speed, 1.0);
    assert_eq!(
        flyby.assets["monkey"].file().unwrap().file.value,
        Path::new("tests/manifests/assets/monkey.glb")
    );
    assert_eq!(
        flyby.assets["floor"].file().unwrap().node.as_ref().map(|node| node.value.as_str()),
        Some("Floor")
    );
    let [monkey, floor] = flyby.bodies.as_slice() else { panic!("two bodies") };
    assert_eq!(monkey.asset.value, "monkey");
    assert_eq!(monkey.placement.at, DVec3::new(-6.0, 1.0, 0.0));
    assert!(close(monkey.placement.velocity.beta().x, 0.9));
    assert_eq!(floor.placement.velocity.proper(), DVec3::ZERO);
    let LightSource::Lamp(lamp) = &flyby.lights[0].source else { panic!("a lamp") };
    assert_eq!(lamp.intensity, Strength::Intensity(Amount::Photometric(300.0)));
    assert_eq!(*lamp.spectrum, Spectrum::BlackBody(5600.0));
    assert_eq!(flyby.lights[0].placement.at, DVec3::new(0.0, 4.0, 3.0));
    assert!(matches!(&flyby.observer.view, View::LookAt(LookAt::Body(body)) if body.value == 0));
    assert!(matches!(flyby.observer.worldline, Worldline::Rest));
    assert!(close(flyby.observer.field_of_view.unwrap(), 50.0 / 180.0 * PI));
    assert_eq!((flyby.exposures.from, flyby.exposures.to, flyby.exposures.count), (-4.0, 9.0, 96));
    assert_eq!((flyby.picture.size.value, flyby.picture.samples), ((1280, 720), 4));
    assert_eq!(flyby.film.map(|film| film.rate.value), Some(24.0));
    assert_eq!(flyby.output.folder, Path::new("tests/manifests/out/flyby"));
}

#[test]
fn every_key_can_be_written() {
    let studio = load("studio.yaml");
    assert_eq!(
        *studio.spectra["measured"],
        Spectrum::Table(Arc::from([(400.0, 0.1), (500.5, 0.25), (700.0, 0.1)]))
    );
    assert_eq!(
        *studio.spectra["steps"],
        Spectrum::Table(Arc::from([(400.0, 0.1), (500.0, 0.5), (600.0, 0.25)]))
    );
    assert!(
        matches!(&studio.materials["paint"].kind, MaterialKind::Diffuse(Paint::Even(paint)) if **paint == Spectrum::Rgb([0.8, 0.2, 0.1]))
    );
    assert!(
        matches!(studio.bodies[1].material.as_deref().map(|material| &material.kind), Some(MaterialKind::Mirror(Paint::Even(part))) if **part == Spectrum::Constant(0.9))
    );
    let names: Vec<_> = studio.bodies[1].materials.iter().map(|(name, _)| name.value.as_str()).collect();
    assert_eq!(names, ["Eyes", "Skin"]);
    assert_eq!(studio.bodies[1].scale, DVec3::new(1.0, 2.0, -1.0));
    assert_eq!(
        studio.bodies.iter().map(manifest::Body::known_as).collect::<Vec<_>>(),
        ["left", "right", "floor"]
    );
    let lights = |name: &str| studio.assets[name].file().unwrap().lights;
    assert!(!lights("floor") && lights("monkey"));
    let strengths: Vec<_> = studio
        .lights
        .iter()
        .map(|light| {
            format!(
                "{:?}",
                match &light.source {
                    LightSource::Lamp(lamp) => lamp.intensity,
                    LightSource::Spot(spot) => spot.lamp.intensity,
                    LightSource::Sun(sun) => Strength::Intensity(sun.illuminance),
                }
            )
        })
        .collect();
    assert_eq!(
        strengths,
        [
            "Intensity(Photometric(300.0))",
            "Intensity(Radiometric(2.0))",
            "Total(Photometric(800.0))",
            "Total(Radiometric(60.0))",
            "Intensity(Photometric(1000.0))",
            "Intensity(Radiometric(1400.0))",
        ]
    );
    let LightSource::Spot(spot) = &studio.lights[3].source else { panic!("a spot") };
    assert_eq!((spot.cone, spot.inner, spot.direction), (1.0, 1.0, DVec3::NEG_Y));
    let Worldline::Orbit(orbit) = &studio.observer.worldline else { panic!("an orbit") };
    assert!(close(orbit.speed, 1.0 / 3.0_f64.sqrt()) && close(orbit.start, PI / 6.0));
    assert_eq!((studio.exposures.clock, studio.picture.filter), (Clock::Lab, Filter::Tent));
    assert_eq!(studio.picture.white, White::Luminance(Amount::Photometric(250.0)));
    assert!(
        studio.output.exr.is_some()
            && studio.effects.aberration
            && !studio.effects.doppler
            && !studio.effects.searchlight
    );
}

#[test]
fn what_is_not_said_has_a_meaning() {
    let m = complete("");
    assert!(m.bodies.is_empty() && m.lights.is_empty() && m.ambient.is_none() && m.film.is_none());
    assert_eq!(m.light_speed, 299_792_458.0);
    assert_eq!(
        (m.exposures.from, m.exposures.to, m.exposures.count, m.exposures.clock),
        (0.0, 0.0, 1, Clock::Own)
    );
    let p = &m.picture;
    assert_eq!((p.size.value, p.samples, p.depth, p.wavelengths), ((1280, 720), 4, 8, 16));
    assert_eq!((p.filter, p.white, p.stops), (Filter::Gaussian, White::Auto, 0.0));
    assert!(matches!(m.observer.view, View::Direction(DVec3::NEG_Z)));
    assert_eq!((m.observer.up, m.observer.placement.rotation), (DVec3::Y, DQuat::IDENTITY));
    assert!(m.effects.aberration && m.effects.doppler && m.effects.searchlight && m.output.exr.is_none());
}

#[test]
fn spectra_are_resolved_to_what_they_are_made_of() {
    let m = complete(
        "spectra: { z: { of: a, scale: 2 }, a: { line: 589 nm }, m: { sum: [E, z] }, w: { line: { centre: 0.5 um, width: 20 nm } }, \
         s: { srgb: \"#ff8000\" }, l: { rgb: 0.25 0.5 4, scale: 3 }, same: m, one: { of: E, scale: 1 } }",
    );
    let line = Arc::new(Spectrum::Line(Line { centre_nm: 589.0, width_nm: None }));
    let double = Arc::new(Spectrum::Scaled { factor: 2.0, of: line });
    assert_eq!(m.spectra["z"], double);
    let equal = Arc::new(Spectrum::Illuminant(Illuminant::E));
    assert_eq!(*m.spectra["m"], Spectrum::Sum(vec![equal.clone(), double]));
    assert_eq!(m.spectra["same"], m.spectra["m"]);
    assert_eq!(m.spectra["one"], equal);
    assert_eq!(*m.spectra["w"], Spectrum::Line(Line { centre_nm: 500.0, width_nm: Some(20.0) }));
    let Spectrum::Rgb([red, green, blue]) = *m.spectra["s"] else { panic!("a colour") };
    assert_eq!((red, blue), (1.0, 0.0));
    // 128/255 by IEC 61966-2-1.
    assert!((green - 0.215_860_500_113_899_26).abs() < 1e-15);
    assert!(matches!(&*m.spectra["l"], Spectrum::Scaled { factor, .. } if *factor == 3.0));
}

#[test]
fn the_word_mirror_is_a_perfect_mirror_unless_it_is_given_another_meaning() {
    let perfect = complete("materials: { a: mirror }");
    assert!(
        matches!(&perfect.materials["a"].kind, MaterialKind::Mirror(Paint::Even(part)) if **part == Spectrum::Constant(1.0))
    );
    let dull = complete("materials: { a: mirror, mirror: { mirror: 0.5 } }");
    assert!(
        matches!(&dull.materials["a"].kind, MaterialKind::Mirror(Paint::Even(part)) if **part == Spectrum::Constant(0.5))
    );
}

#[test]
fn reflectances_may_have_names_that_begin_with_a_digit() {
    let m = complete("spectra: { 18%: { constant: 0.18 } }\nmaterials: { card: { diffuse: 18% } }");
    assert!(
        matches!(&m.materials["card"].kind, MaterialKind::Diffuse(Paint::Even(part)) if **part == Spectrum::Constant(0.18))
    );
}

#[test]
fn exposures_are_one_or_a_row_or_a_ring() {
    let exposures = |text: &str, observer: &str| {
        let m = read(&format!("light_speed: 1 m/s\nobserver: {observer}\nexposures: {text}\noutput: out\n"));
        (m.exposures.from, m.exposures.to, m.exposures.count, m.film.is_some())
    };
    assert_eq!(exposures("{ at: 3 s }", "{}"), (3.0, 3.0, 1, false));
    assert_eq!(exposures("{ from: 3 s, count: 1 }", "{}"), (3.0, 3.0, 1, false));
    assert_eq!(exposures("{ from: 3 s, to: 5 s, count: 4 }", "{}"), (3.0, 5.0, 4, true));
    let ring = "{ ring: { radius: 4 m, turns: -2 } }";
    assert_eq!(exposures("{ count: 36 }", ring), (0.0, 0.0, 36, true));
    assert_eq!(exposures("{ at: 2 s, count: 36 }", ring), (2.0, 2.0, 36, true));
    assert_eq!(exposures("{ from: 2 s, to: 2 s, count: 36 }", ring), (2.0, 2.0, 36, true));
    assert_eq!(exposures("{ from: 2 s, to: 3 s, count: 36 }", ring), (2.0, 3.0, 36, true));
}

#[test]
fn the_observer_looks_at_bodies_by_their_name_and_at_places() {
    let view = |name: &str| {
        let bodies = "assets: { a: a.glb, b: b.glb }\nbodies: [{ asset: a, name: left }, { asset: a, name: 0 1 0 m }, { asset: b }]\n";
        match read(&format!("{bodies}observer: {{ look_at: {name} }}\noutput: out\n")).observer.view {
            View::LookAt(LookAt::Body(body)) => format!("body {}", body.value),
            View::LookAt(LookAt::Point(at)) => format!("place {at}"),
            View::Direction(_) => "ahead".to_owned(),
        }
    };
    assert_eq!(view("left"), "body 0");
    assert_eq!(view("b"), "body 2");
    assert_eq!(view("0 1 0 m"), "body 1");
    assert_eq!(view("0 2 0 m"), "place [0, 2, 0]");
}

#[test]
fn values_on_the_command_line_take_the_place_of_written_ones() {
    let text = "assets: { a: a.glb }\nbodies: [{ asset: a }, { asset: a, at: 0 0 1 m }]\nobserver: { velocity: 0 0 0 c }\noutput: out\nfilm:\n";
    let m = read_with(
        text,
        &[
            ("observer.velocity", "0 0 0.6 c"),
            ("bodies.1.at", "0 0 2 m"),
            ("bodies.0", "{ asset: a, scale: 3 }"),
            ("film.rate", "12"),
            ("picture", "{ samples: 1 }"),
            ("picture.samples", "2"),
            ("output", "elsewhere"),
        ],
    );
    assert!(close(m.observer.placement.velocity.gamma(), 1.25));
    assert_eq!((m.bodies[0].scale, m.bodies[1].placement.at), (DVec3::splat(3.0), DVec3::new(0.0, 0.0, 2.0)));
    assert_eq!((m.film.map(|film| film.rate.value), m.picture.samples), (Some(12.0), 2));
    assert_eq!(m.output.folder, Path::new("folder/elsewhere"));
}

#[test]
fn aliases_repeat_what_they_stand_for() {
    let m = complete(
        "spectra: { a: &a { line: 589 nm }, b: *a }\nlights: [{ lamp: &l { intensity: 1 cd } }, { lamp: *l, at: 0 0 1 m }]",
    );
    assert_eq!(m.spectra["a"], m.spectra["b"]);
    assert_eq!(m.lights.len(), 2);
}

#[test]
fn places_are_kept_for_later_stages() {
    let m = load("flyby.yaml");
    let at = |place: &Place| place.line_column().unwrap();
    assert_eq!(at(&m.assets["monkey"].file().unwrap().file.place), (4, 11));
    assert_eq!(at(&m.assets["floor"].file().unwrap().node.as_ref().unwrap().place), (5, 47));
    assert_eq!(at(&m.bodies[0].asset.place), (7, 12));
    assert_eq!(at(&m.bodies[1].place), (10, 5));
    assert_eq!(at(&m.lights[0].place), (12, 5));
    assert_eq!(at(&m.output.place), (24, 9));
    assert_eq!(m.effects.place, Place::Command);
}

#[test]
fn assets_that_no_body_is_made_of_are_warned_of() {
    let mut report = Report::default();
    let text = "assets: { a: a.glb }\nobserver: {}\noutput: out\n";
    assert!(manifest::parse(Path::new("m.yaml"), text, &mut report).is_some());
    assert_eq!(report.warnings.len(), 1);
    assert_eq!(report.warnings[0].place.line_column(), Some((1, 14)));
}

/// All records that a shape leads to.
fn records(shape: &Shape, found: &mut Vec<(&'static str, Vec<manifest::Field>)>) {
    match shape {
        Shape::List(of) | Shape::Map(of) => records(&of(), found),
        Shape::Either(shapes) => shapes.iter().for_each(|shape| records(shape, found)),
        Shape::Record(record) if found.iter().all(|(doc, _)| *doc != record.doc) => {
            let fields = (record.fields)();
            found.push((record.doc, fields.clone()));
            for field in fields {
                records(&(field.shape)(), found);
            }
        }
        _ => {}
    }
}

#[test]
fn every_key_is_explained_and_its_example_is_yaml() {
    let mut found = Vec::new();
    records(&manifest::shape(), &mut found);
    assert!(found.len() > 20);
    for (doc, fields) in found {
        assert!(!doc.trim().is_empty());
        for (index, field) in fields.iter().enumerate() {
            assert!(
                fields[..index].iter().all(|other| other.key != field.key),
                "{} is there twice",
                field.key
            );
            assert!(field.doc.trim().ends_with(['.', ')']), "{} is not explained", field.key);
            let yaml = format!("{}: {}", field.key, field.example);
            let value: serde_yaml::Value = serde_yaml::from_str(&yaml).unwrap();
            assert!(!value[field.key].is_null(), "{yaml}");
        }
    }
}

#[test]
fn the_examples_of_the_outermost_keys_make_a_manifest() {
    let mut found = Vec::new();
    records(&manifest::shape(), &mut found);
    let fields = &found[0].1;
    let line = |field: &manifest::Field| format!("{}: {}\n", field.key, field.example);
    let (short, long): (Vec<_>, Vec<_>) =
        fields.iter().filter(|field| field.key != "extends").partition(|field| field.group == "a shorthand");
    let lines: Vec<_> = long.into_iter().map(line).collect();
    read(&lines.concat());
    let apart = lines.iter().filter(|line| !line.starts_with("observer") && !line.starts_with("exposures"));
    let apart: String = apart.cloned().collect();
    short.into_iter().for_each(|field| drop(read(&(apart.clone() + &line(field)))));
    let required: Vec<_> =
        fields.iter().filter(|f| f.presence == Presence::Required).map(|f| f.key).collect();
    assert_eq!(required, ["output"]);
}
