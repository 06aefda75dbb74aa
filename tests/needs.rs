//! What is not needed is not done, and the picture is the same as with everything on.

use crate::support::{manifested, needless, relative_difference};
use terrell::exposure::{Sampling, expose_lit};
use terrell::film::Negative;
use terrell::manifest::Manifest;
use terrell::plan::{Plan, needs};
use terrell::scene::Scene;
use terrell::trace::Lit;

/// A monkey with its texture, on a checkered floor before a grey mirror, in daylight and fill light; all at rest.
const DAYLIGHT: &str = "
light_speed: 1 m/s
assets: { monkey: ../assets/monkey.glb, floor: { plane: {} }, ball: { sphere: { radius: 0.5 m } } }
bodies:
  - { asset: monkey, at: 0 1.05 0 m }
  - { asset: floor, material: { diffuse: { checker: { size: 0.4 m, even: { rgb: 0.8 0.3 0.1 }, odd: { rgb: 0.1 0.2 0.7 } } } } }
  - { asset: ball, at: 1.6 0.6 0 m, material: MATERIAL }
lights:
  - lamp: { intensity: 400 cd, spectrum: LAMP }
    at: 3 5 4 m
ambient: { luminance: 3 cd/m2 }
observer: { at: 0 1.4 5 m, look_at: monkey, field_of_view: 50 deg, velocity: OBSERVER }
exposures: { from: 0 s, to: 2 s, count: 3 }
picture: { size: 64 48, samples: 2, white: 100 cd/m2 }
output: out
";

const MIRROR: &str = "{ mirror: 0.8 }";

fn daylight(material: &str, lamp: &str, observer: &str) -> (Manifest, Scene, Plan) {
    let text = DAYLIGHT.replace("MATERIAL", material).replace("LAMP", lamp).replace("OBSERVER", observer);
    manifested(&text)
}

fn resting() -> (Manifest, Scene, Plan) {
    daylight(MIRROR, "D65", "0 0 0 m/s")
}

fn exposed(scene: &Scene, plan: &Plan, lit: &Lit<'_>, wavelengths: u32) -> Negative {
    let sampling = Sampling { wavelengths, ..plan.sampling };
    let view = scene.observer.view(plan.exposures[0].tau, sampling.width, sampling.height);
    expose_lit(lit, &view, &sampling)
}

#[test]
fn three_wavelengths_serve_a_resting_scene_in_daylight() {
    let (_, scene, plan) = resting();
    assert_eq!(plan.sampling.wavelengths, 3);
    let planned = exposed(&scene, &plan, &scene.lit(), 3);
    for many in [8, 16, 64] {
        let all = exposed(&scene, &plan, &scene.lit(), many);
        let error = relative_difference(&planned, &all);
        assert!(error < 1e-6, "{many} wavelengths: {error:e}");
    }
}

#[test]
fn three_wavelengths_are_refused_where_they_would_show() {
    // Each with the least by which 3 wavelengths differ from 64.
    let black_body = "{ black_body: 3000 K }";
    let sodium = "{ line: 589 nm }";
    let coloured = "{ rgb: 1 0.3 0.1 }";
    let still = "0 0 0 m/s";
    for (material, lamp, observer) in [
        (MIRROR, black_body, still),
        (MIRROR, sodium, still),
        (MIRROR, coloured, still),
        ("{ mirror: { rgb: 0.9 0.5 0.1 } }", "D65", still),
        ("{ metal: gold }", "D65", still),
        ("{ glass: BK7 }", "D65", still),
        (MIRROR, "D65", "0 0 0.1 m/s"),
    ] {
        let (_, scene, plan) = daylight(material, lamp, observer);
        let because = needs::three_wavelengths(&scene);
        assert!(!because.yes, "{material}, {lamp}, {observer}");
        assert_eq!(plan.sampling.wavelengths, 16, "{material}, {lamp}, {observer}");
        let (three, many) =
            (exposed(&scene, &plan, &scene.lit(), 3), exposed(&scene, &plan, &scene.lit(), 64));
        let error = relative_difference(&three, &many);
        // Lines meet no wavelengths; what the sun of the same scene gives does.
        assert!(error > 1e-3 || lamp == sodium, "{material}, {lamp}, {observer}: only {error:e}");
    }
}

#[test]
fn one_colour_from_lamp_to_eye_is_no_reason_for_spectra() {
    let grey_world = DAYLIGHT
        .replace("{ rgb: 0.8 0.3 0.1 }", "0.8")
        .replace("{ rgb: 0.1 0.2 0.7 }", "0.2")
        .replace(
            "{ asset: monkey, at: 0 1.05 0 m }",
            "{ asset: monkey, at: 0 1.05 0 m, material: { diffuse: 0.5 } }",
        )
        .replace("MATERIAL", MIRROR)
        .replace("LAMP", "{ rgb: 1 0.3 0.1 }")
        .replace("OBSERVER", "0 0 0 m/s");
    let (_, scene, plan) = manifested(&grey_world);
    assert_eq!(plan.sampling.wavelengths, 3, "{:?}", needs::three_wavelengths(&scene));
    let error = relative_difference(
        &exposed(&scene, &plan, &scene.lit(), 3),
        &exposed(&scene, &plan, &scene.lit(), 64),
    );
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn scenes_that_move_as_one_with_the_observer_need_no_spectra_either() {
    let moving = DAYLIGHT
        .replace("at: 0 1.05 0 m }", "at: 0 1.05 0 m, velocity: 0 0 0.8 c }")
        .replace("floor, material", "floor, velocity: 0 0 0.8 c, material")
        .replace("at: 1.6 0.6 0 m, material", "at: 1.6 0.6 0 m, velocity: 0 0 0.8 c, material")
        .replace("at: 3 5 4 m", "at: 3 5 4 m\n    velocity: 0 0 0.8 c")
        .replace("MATERIAL", MIRROR)
        .replace("LAMP", "D65")
        .replace("OBSERVER", "0 0 0.8 c");
    let (_, scene, plan) = manifested(&moving);
    assert_eq!(plan.sampling.wavelengths, 3, "{:?}", needs::three_wavelengths(&scene));
    assert!(needs::still(&scene).yes);
}

#[test]
fn what_is_left_out_of_the_light_loop_changes_nothing() {
    let (_, scene, plan) = daylight("{ diffuse: 0.5 }", "D65", "0 0 0.3 m/s");
    let planned = scene.lit();
    assert_eq!((planned.depth, planned.see_through), (0, false));
    assert!(planned.footprints, "the floor is checkered");
    let picture = exposed(&scene, &plan, &planned, 16);
    let everything = Lit { depth: 8, see_through: true, footprints: true, ..scene.lit() };
    assert_eq!(exposed(&scene, &plan, &everything, 16), picture);

    let plain = DAYLIGHT
        .replace("{ checker: { size: 0.4 m, even: { rgb: 0.8 0.3 0.1 }, odd: { rgb: 0.1 0.2 0.7 } } }", "0.5")
        .replace(
            "{ asset: monkey, at: 0 1.05 0 m }",
            "{ asset: monkey, at: 0 1.05 0 m, material: { diffuse: 0.5 } }",
        )
        .replace("MATERIAL", MIRROR)
        .replace("LAMP", "D65")
        .replace("OBSERVER", "0 0 0.3 m/s");
    let (_, scene, plan) = manifested(&plain);
    assert!(!scene.lit().footprints && scene.lit().depth == 8);
    let everything = Lit { footprints: true, ..scene.lit() };
    assert_eq!(exposed(&scene, &plan, &everything, 16), exposed(&scene, &plan, &scene.lit(), 16));
}

#[test]
fn footprints_are_kept_where_a_texture_shows() {
    let (_, scene, plan) = resting();
    let points = Lit { footprints: false, ..scene.lit() };
    let error =
        relative_difference(&exposed(&scene, &plan, &points, 3), &exposed(&scene, &plan, &scene.lit(), 3));
    assert!(error > 1e-3, "only {error:e}");
}

#[test]
fn film_in_which_nothing_moves_is_one_picture() {
    let (_, scene, plan) = resting();
    assert!(plan.still);
    let at = |tau: f64| {
        let view = scene.observer.view(tau, plan.sampling.width, plan.sampling.height);
        expose_lit(&scene.lit(), &view, &plan.sampling)
    };
    assert_eq!(at(plan.exposures[0].tau), at(plan.exposures[2].tau));

    // Slower than a part 1e-12 of light, and yet 1 cm further at the film's end.
    let slow = DAYLIGHT
        .replace("light_speed: 1 m/s\n", "")
        .replace("at: 0 1.05 0 m }", "at: 0 1.05 0 m, velocity: 0.0001 0 0 m/s }")
        .replace("to: 2 s", "to: 100 s")
        .replace("MATERIAL", MIRROR)
        .replace("LAMP", "D65")
        .replace("OBSERVER", "0 0 0 m/s");
    assert!(!manifested(&slow).2.still);

    let blinking = "{ blinking: { period: 2 s, on: { diffuse: 0.9 }, off: { diffuse: 0.02 } } }";
    for (material, observer) in [(blinking, "0 0 0 m/s"), (MIRROR, "0 0 0.2 m/s")] {
        let (_, _, plan) = daylight(material, "D65", observer);
        assert!(!plan.still, "{material}, {observer}");
    }
}

#[test]
fn what_nobody_sees_changes_the_plan_and_not_the_picture() {
    for pair in needless::all((64, 36)) {
        let needless::Needless { part, what, .. } = pair;
        let of = |text: &str| {
            let (_, scene, plan) = manifested(text);
            let parts = needs::parts(&scene, &plan);
            let choice = parts.iter().find(|other| other.name == part).map(|found| found.choice.clone());
            let sampling = plan.sampling;
            let view = scene.observer.view(plan.exposures[0].tau, sampling.width, sampling.height);
            let picture = expose_lit(&scene.lit(), &view, &sampling);
            (choice.unwrap_or_else(|| panic!("no part {part}")), picture)
        };
        let (planned, everything) = (of(&pair.plain), of(&pair.with));
        assert_ne!(planned.0, everything.0, "{part}: {what}");
        let error = relative_difference(&planned.1, &everything.1);
        assert!(error <= pair.tolerance, "{part}, {what}: {error:e}");
    }
}

#[test]
fn plan_says_each_choice_with_its_reason() {
    let (_, scene, plan) = resting();
    let parts = needs::parts(&scene, &plan);
    let of = |name: &str| parts.iter().find(|part| part.name == name).map(|part| part.choice.as_str());
    assert_eq!(of("rest frames"), Some("one"));
    assert_eq!(of("spectra"), Some("3 wavelengths"));
    assert_eq!(of("exposures"), Some("one picture serves all exposures"));
    assert_eq!(of("shadows"), Some("the first thing on the way ends it"));
    assert_eq!(of("recursion"), Some("8 deep"));
    assert_eq!(of("lines"), Some("none"));
    assert_eq!(of("dispersion"), Some("none"));
    assert_eq!(of("surroundings"), Some("black"));
    assert!(parts.iter().all(|part| !part.why.is_empty()));
}
