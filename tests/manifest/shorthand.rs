//! `turntable` and `flyby`: what they stand for.

use super::{close, faults, read, read_with};
use glam::DVec3;
use std::path::Path;
use terrell::error::Report;
use terrell::manifest::{Clock, LookAt, Manifest, View, Worldline};
use terrell::plan::Plan;
use terrell::scene::{Scene, compose};
use terrell::spacetime::Tetrad;

const BALL: &str = "\
light_speed: 1 m/s
assets: { ball: { sphere: { radius: 1 m } }, cube: { box: { size: 1 m } } }
lights: [{ lamp: { intensity: 300 cd }, at: 0 5 5 m }]
picture: { size: 24 16, samples: 1, wavelengths: 8, white: 20 cd/m2 }
output: out
";

fn staged(text: &str) -> (Manifest, Scene, Plan) {
    let manifest = read(&format!("{BALL}{text}"));
    let mut report = Report::default();
    let scene = compose(&manifest, Path::new("m.yaml"), &mut report).unwrap();
    let plan = Plan::of(&manifest, &scene, Path::new("m.yaml"), &mut report);
    assert_eq!(report.faults, []);
    (manifest, scene, plan)
}

/// Where the observer is at each exposure.
fn stations(text: &str) -> Vec<Tetrad> {
    let (_, scene, plan) = staged(text);
    plan.exposures.iter().map(|exposure| scene.observer.worldline.at(exposure.tau)).collect()
}

/// All pictures.
fn pictures(text: &str) -> Vec<Vec<[f32; 3]>> {
    let (_, scene, plan) = staged(text);
    let picture = |exposure: &terrell::plan::Exposure| {
        let view = scene.observer.view(exposure.tau, plan.sampling.width, plan.sampling.height);
        terrell::exposure::expose(&scene, &view, &plan.sampling).xyz
    };
    plan.exposures.iter().map(picture).collect()
}

const TURNING: &str = "bodies: [{ asset: ball, at: 1 2 3 m }, { asset: cube, at: 2 2 3 m }]\n";

#[test]
fn a_turntable_with_a_speed_is_an_orbit_written_out() {
    let short =
        "turntable: { around: ball, radius: 4 m, height: 1 m, start: 30 deg, speed: 0.6 c, count: 5 }";
    // A turn takes 2 pi r / (gamma v) = 8 pi / 0.75 by the own clock; four fifths of it are shown.
    let long = format!(
        "observer: {{ at: 1 2 3 m, orbit: {{ centre: 0 1 0 m, radius: 4 m, speed: 0.6 c, start: 30 deg }}, look_at: ball }}\n\
         exposures: {{ from: 0 s, to: {} s, count: 5 }}",
        8.0 * std::f64::consts::PI / 0.75 * 4.0 / 5.0
    );
    let (short, long) = (format!("{TURNING}{short}\n"), format!("{TURNING}{long}\n"));
    assert_eq!(pictures(&short), pictures(&long));
    let other = short.replace("radius: 4 m", "radius: 4.5 m");
    assert_ne!(pictures(&short), pictures(&other));
}

#[test]
fn a_turntable_without_a_speed_is_a_ring_written_out() {
    let short = "turntable: { around: 1 2 3 m, radius: 4 m, height: 1 m, turns: -2, at: 7 s, count: 4 }";
    let long = "observer: { ring: { centre: 1 3 3 m, radius: 4 m, turns: -2 }, look_at: 1 2 3 m }\n\
                exposures: { at: 7 s, count: 4 }";
    let moving = TURNING.replace("at: 2 2 3 m", "at: 2 2 3 m, velocity: 0.5 0 0 c");
    assert_eq!(pictures(&format!("{moving}{short}\n")), pictures(&format!("{moving}{long}\n")));
}

#[test]
fn a_turntable_comes_back_one_step_after_its_last_picture() {
    for turns in [1.0, -1.0, 3.0] {
        let text = format!(
            "{TURNING}turntable: {{ around: ball, radius: 4 m, axis: 1 2 0, turns: {turns}, speed: 0.9 c, count: 24 }}\n"
        );
        let (manifest, scene, plan) = staged(&text);
        let step = plan.exposures[1].tau - plan.exposures[0].tau;
        let [first, again] = [0.0, plan.exposures[23].tau + step].map(|tau| scene.observer.worldline.at(tau));
        assert!((first.event.x - again.event.x).length() < 1e-12);
        let speed = first.velocity() - again.velocity();
        assert!(speed.x.length() < 1e-12);
        assert_eq!(manifest.observer.up, DVec3::new(1.0, 2.0, 0.0).normalize());
        let second = scene.observer.worldline.at(step).event.x - first.event.x;
        let way_round = manifest.observer.up.cross(first.event.x - DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(second.dot(way_round) > 0.0, turns > 0.0);
    }
}

#[test]
fn a_turntable_goes_along_with_a_body_that_moves() {
    let moving = "bodies: [{ asset: ball, at: 1 2 3 m, at_time: 2 s, velocity: 0 0 0.8 c }]\n";
    let all = stations(&format!(
        "{moving}turntable: {{ around: ball, radius: 4 m, speed: 0.5 c, at: 5 s, count: 6 }}\n"
    ));
    // At 5 s the body is 0.8 * 3 m further on; in its rest frame the observer is always 4 m away.
    let middle = DVec3::new(1.0, 2.0, 3.0 + 2.4);
    let gamma = 1.0 / 0.6;
    for who in all {
        let (t, x) = (who.event.t - 5.0, who.event.x - middle);
        let at_rest = DVec3::new(x.x, x.y, gamma * (x.z - 0.8 * t));
        assert!((at_rest.length() - 4.0).abs() < 1e-12 && at_rest.y.abs() < 1e-12);
    }
}

#[test]
fn an_observer_who_flies_past_is_nearest_in_the_middle_picture() {
    let text = "bodies: [{ asset: ball, at: 1 2 3 m }]\n\
                flyby: { past: ball, distance: 5 m, speed: 0.8 c, along: 0 0 -1, side: 1 0 1, reach: 3, at: 4 s, count: 7 }\n";
    let all = stations(text);
    let place = |i: usize| all[i].event.x - DVec3::new(1.0, 2.0, 3.0);
    assert!((place(3) - DVec3::new(5.0, 0.0, 0.0)).length() < 1e-12);
    assert!((place(0) - DVec3::new(5.0, 0.0, 15.0)).length() < 1e-12);
    assert!((place(6) - DVec3::new(5.0, 0.0, -15.0)).length() < 1e-12);
    assert!(close(all[3].event.t, 4.0));
    let (manifest, _, plan) = staged(text);
    // 30 m at 0.8 c take 37.5 s, of which the observer's clock shows 0.6.
    assert!(close(plan.exposures[6].tau - plan.exposures[0].tau, 22.5));
    assert!(matches!(&manifest.observer.view, View::LookAt(LookAt::Body(_))));
    let alone = stations(&text.replace("count: 7", "count: 1"));
    assert!((alone[0].event.x - all[3].event.x).length() < 1e-12);
}

#[test]
fn what_flies_past_is_seen_from_one_end_of_its_way_to_the_other() {
    let text = "bodies: [{ asset: ball, at: 1 2 3 m, at_time: 1 s, velocity: 0.6 0 0.6 c }]\n\
                flyby: { past: ball, distance: 5 m, reach: 3, at: 4 s, count: 9 }\n";
    let all = stations(text);
    let velocity = DVec3::new(0.6, 0.0, 0.6);
    let body = |t: f64| DVec3::new(1.0, 2.0, 3.0) + velocity * (t - 1.0);
    let half = 15.0 / velocity.length();
    for (who, emission) in [(&all[0], 4.0 - half), (&all[8], 4.0 + half)] {
        let late = (who.event.x - body(emission)).length();
        assert!(close(who.event.t - emission, late), "{} after {emission}", who.event.t);
    }
    assert!(all.iter().all(|who| (who.event.x - all[0].event.x).length() < 1e-12));
    let side = all[0].event.x - body(4.0);
    assert!((side.length() - 5.0).abs() < 1e-12 && side.dot(velocity).abs() < 1e-12 && side.z > 0.0);
}

#[test]
fn what_the_observer_says_of_the_picture_stays() {
    let m = read(
        "light_speed: 1 m/s\nbodies: []\nobserver: { field_of_view: 90 deg, direction: 0 0 -1, up: 1 0 0 }\n\
         flyby: { past: 0 0 0 m, distance: 1 m, speed: 0.5 c }\noutput: out\n",
    );
    assert!(matches!(m.observer.view, View::Direction(along) if along == DVec3::NEG_Z));
    assert_eq!((m.observer.up, m.exposures.count, m.exposures.clock), (DVec3::X, 96, Clock::Own));
    assert!(close(m.observer.field_of_view.unwrap(), std::f64::consts::FRAC_PI_2));
    assert!(m.film.is_some() && matches!(m.observer.worldline, Worldline::Rest));
    // From straight above nothing of the usual `up` would be seen: the way goes up.
    let m = read("flyby: { past: 0 0 0 m, distance: 1 m, speed: 0.5 c, side: 0 1 0 }\noutput: out\n");
    assert_eq!(m.observer.up, DVec3::X);
}

#[test]
fn shorthands_on_the_command_line_take_the_place_of_what_is_written() {
    let text = "observer: { orbit: { radius: 1 m, speed: 0.1 c }, direction: 1 0 0, field_of_view: 30 deg }\n\
                exposures: { at: 3 s }\noutput: out\n";
    let m = read_with(text, &[("turntable", "{ around: 0 0 0 m, radius: 2 m, count: 7 }")]);
    assert!(matches!(&m.observer.worldline, Worldline::Ring(ring) if ring.radius == 2.0));
    assert!(matches!(m.observer.view, View::LookAt(LookAt::Point(DVec3::ZERO))));
    assert_eq!(m.exposures.count, 7);
    assert!(close(m.observer.field_of_view.unwrap(), std::f64::consts::FRAC_PI_6));
    let m = read_with(
        "turntable: { around: 0 0 0 m, radius: 2 m }\noutput: out\n",
        &[("flyby", "{ past: 0 0 0 m, distance: 1 m, speed: 0.5 c }"), ("flyby.count", "5")],
    );
    assert!(matches!(m.observer.worldline, Worldline::Rest) && m.exposures.count == 5);
}

#[test]
fn shorthands_that_go_nowhere_are_faults() {
    let said = |text: &str| {
        let bodies = "assets: { a: plane }\nbodies: [{ asset: a, name: still }, { asset: a, name: fast, velocity: 0 0 0.5 c }]";
        let report = faults(&format!("{bodies}\n{text}\noutput: out\n"));
        report
            .faults
            .iter()
            .map(|fault| format!("{}; {}", fault.what, fault.hint))
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert!(
        said("flyby: { past: still, distance: 1 m }")
            .starts_with("neither the observer moves nor what it looks at")
    );
    assert!(said("flyby: { past: 0 0 0 m, distance: 1 m }").ends_with("speed: 0.9 c"));
    assert!(said("flyby: { past: fast, distance: 1 m, speed: 0.5 c }").starts_with("the body moves itself"));
    assert!(said("flyby: { past: fast, distance: 1 m, along: 1 0 0 }").ends_with("remove `along`"));
    assert!(said("flyby: { past: fast, distance: 1 m, side: 0 0 1 }").starts_with("`side` is along the way"));
    assert!(said("flyby: { past: fast, distance: 1 m, reach: -1 }").ends_with("reach: 4"));
    assert!(
        said("flyby: { past: still, distance: 1 m, speed: 0 c }").starts_with("the observer does not move")
    );
    assert!(
        said("turntable: { around: still, radius: 1 m, speed: 0 c }")
            .starts_with("the observer does not move")
    );
    assert!(
        said("turntable: { around: still, radius: 1 m, speed: 0.5 c, turns: 0 }")
            .starts_with("the observer does not")
    );
    assert_eq!(said("turntable: { around: fast, radius: 1 m }\nobserver: { field_of_view: 60 deg }"), "");
}
