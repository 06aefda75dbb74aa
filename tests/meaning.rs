//! Warnings of what will not be seen, and of nothing else.

use crate::support::manifested;
use terrell::error::Report;
use terrell::plan::meaning;

/// The warnings of a film, text and hint.
fn warned(text: &str) -> Vec<String> {
    let (manifest, scene, plan) = manifested(text);
    let mut report = Report::default();
    meaning::check(&manifest, &scene, &plan, &mut report);
    assert!(report.faults.is_empty());
    report.warnings.iter().map(|warning| format!("{warning}")).collect()
}

/// A ball and a lamp above it, and an observer.
fn ball(light: &str, observer: &str) -> String {
    format!(
        "light_speed: 1 m/s
assets: {{ ball: {{ sphere: {{ radius: 1 m }} }} }}
bodies: [{{ asset: ball }}]
lights: [{{ lamp: {{ intensity: {light} }}, at: 0 3 5 m }}]
observer: {{ {observer} }}
exposures: {{ from: -1 s, to: 1 s, count: 9 }}
picture: {{ size: 64 36 }}
output: out"
    )
}

const SEEN: &str = "at: 0 0 5 m";

#[test]
fn nothing_is_said_where_something_is_seen() {
    assert!(warned(&ball("300 cd", SEEN)).is_empty());
    // In some of the pictures only: in the first and the last it is not in view.
    let passing = ball("300 cd", "at: 0 0 5 m, field_of_view: 3 deg")
        .replace("{ asset: ball }", "{ asset: ball, velocity: 0.5 0 0 c }");
    let passing = passing.replace("from: -1 s, to: 1 s", "from: -10 s, to: 20 s");
    assert!(warned(&passing).is_empty(), "{:?}", warned(&passing));
    assert_eq!(warned(&passing.replace("from: -10 s, to: 20 s", "from: -10 s, to: -5 s")).len(), 1);
}

#[test]
fn observer_who_looks_away_is_told_where_to_look() {
    let said = warned(&ball("300 cd", "at: 0 0 5 m, direction: 0 0 1"));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("the observer sees no body in any of 9 pictures"), "{said:?}");
    assert!(said[0].contains("look_at: ball"), "{said:?}");
}

#[test]
fn body_that_is_too_small_for_small_pictures_is_seen_all_the_same() {
    let far = ball("300 cd", SEEN).replace("radius: 1 m", "radius: 1 mm");
    assert!(warned(&far).is_empty(), "{:?}", warned(&far));
    // In the middle between the pixels' centres of small pictures.
    let moved = far.replace("at: 0 0 5 m", "at: 0.2 0.1 5 m");
    assert!(warned(&moved).is_empty(), "{:?}", warned(&moved));
}

#[test]
fn observer_within_a_dark_body_is_told_so() {
    let said = warned(&ball("300 cd", "at: 0.2 0 0 m"));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("the observer is inside `ball`"), "{said:?}");
    // A lamp in there, too: something is seen.
    assert!(warned(&ball("300 cd", "at: 0.2 0 0 m").replace("0 3 5 m", "0 0.5 0 m")).is_empty());
}

#[test]
fn bodies_in_the_shade_are_told_of() {
    let said = warned(&ball("300 cd", SEEN).replace("at: 0 3 5 m", "at: 0 0 -5 m"));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("no light comes from them that an eye could see"), "{said:?}");
}

/// The observer rests beside the ball; the lamp recedes so fast that its line is seen at this wavelength.
fn receding(seen_nm: f64) -> Vec<String> {
    let ratio = (seen_nm / 589.0_f64).powi(2);
    let beta = (ratio - 1.0) / (ratio + 1.0);
    let light = "1 W/sr, spectrum: { line: 589 nm }";
    warned(&ball(light, SEEN).replace("at: 0 3 5 m", &format!("at: 0 0 30 m, velocity: 0 0 {beta} c")))
}

#[test]
fn line_is_told_of_where_it_is_shifted_out_of_sight_and_not_before() {
    assert!(receding(589.0).is_empty());
    assert!(receding(760.0).is_empty(), "{:?}", receding(760.0));
    let said = receding(800.0);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0].contains("this lamp's light of 589 nm is seen at 79") || said[0].contains("seen at 80"),
        "{said:?}"
    );
    assert!(said[0].contains("no eye sees anything"));
}

#[test]
fn lamp_that_shines_between_its_lines_is_not_told_of() {
    let light = "1 W/sr, spectrum: { sum: [{ line: 589 nm }, { black_body: 5000 K }] }";
    let fast = ball(light, SEEN).replace("at: 0 3 5 m", "at: 0 0 30 m, velocity: 0 0 0.9 c");
    assert!(warned(&fast).is_empty(), "{:?}", warned(&fast));
}

#[test]
fn what_is_suggested_instead_of_a_line_is_seen() {
    let said = receding(1200.0);
    let line = said[0].split("help: line: ").nth(1).unwrap().split(" nm").next().unwrap();
    let light = format!("1 W/sr, spectrum: {{ line: {line} nm }}");
    let ratio = (1200.0_f64 / 589.0).powi(2);
    let beta = (ratio - 1.0) / (ratio + 1.0);
    let text = ball(&light, SEEN).replace("at: 0 3 5 m", &format!("at: 0 0 30 m, velocity: 0 0 {beta} c"));
    assert!(warned(&text).is_empty(), "{:?}", warned(&text));
}
