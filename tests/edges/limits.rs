//! Beyond a guaranteed limit `check` says so, and what cannot be right is refused.

use std::process::Command;

/// What `check` says of a ball and who looks at it, and its exit code.
fn checked(body: &str, observer: &str, more: &str) -> (String, i32) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.yaml");
    let text = format!(
        "light_speed: 1 m/s\nassets: {{ ball: {{ sphere: {{ radius: 0.5 m }} }} }}\nbodies:\n  - {{ asset: ball, material: {{ emission: {{ luminance: 100 cd/m2 }} }}, {body} }}\n\
         observer: {{ {observer} }}\nexposures: {{ at: 0 s }}\noutput: out\n{more}"
    );
    std::fs::write(&path, text).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_terrell")).arg("check").arg(&path).output().unwrap();
    let said =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (said, output.status.code().unwrap())
}

#[test]
fn what_is_within_the_limits_is_not_spoken_of() {
    for (body, observer) in [
        ("at: 0 0 -10 m, velocity: { gamma: 1e8, along: 1 0 0 }", "at: 0 0 0 m"),
        ("at: 0 0 -10 m", "at: 0 0 0 m, velocity: { gamma: 1e8, along: 1 0 0 }"),
        ("at: 1e9 1e9 -1e9 m, scale: 0.01", "at: 1e9 1e9 -999999999 m"),
        ("at: 0 0 -1e9 m, velocity: 0.9 0 0 c", "at: 0 0 0 m"),
    ] {
        let (said, code) = checked(body, observer, "");
        // At γ of 1e8 it is seen elsewhere, or nothing of its light is; that is another thing.
        let unseen = ["warning: the observer sees no body", "warning: bodies are seen, but no light"];
        let beyond = said
            .lines()
            .filter(|line| line.contains("warning") && !unseen.iter().any(|u| line.starts_with(u)));
        assert!(code == 0 && beyond.count() == 0, "{body}: {said}");
    }
}

#[test]
fn body_whose_place_is_known_to_a_thousandth_of_its_size_or_worse_is_warned_of() {
    let (said, code) = checked("at: 0 0 -1e5 m, velocity: { gamma: 1e8, along: 1 0 0 }", "at: 0 0 0 m", "");
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("place is known to") && said.contains("nearer to one another"), "{said}");
}

#[test]
fn body_whose_place_is_known_less_well_than_its_size_is_refused() {
    for (body, observer) in [
        ("at: 0 0 -1e9 m, velocity: { gamma: 1e8, along: 1 0 0 }", "at: 0 0 0 m"),
        ("at: 0 0 -1 m, at_time: 1e9 s, velocity: { gamma: 1e8, along: 1 0 0 }", "at: 0 0 0 m"),
        ("at: 0 0 -1 m, scale: 1e-9", "at: 1e9 0 0 m"),
    ] {
        let (said, code) = checked(body, observer, "");
        assert_eq!(code, 2, "{said}");
        assert!(said.contains("more than its own size") && said.contains("m.yaml:4"), "{said}");
    }
}

#[test]
fn light_of_other_rest_frames_on_what_is_too_fast_is_warned_of() {
    let body = "at: 0 0 -10 m, velocity: { gamma: 1e8, along: 1 0 0 }";
    let lamp = |moves: &str| format!("lights: [{{ lamp: {{ intensity: 100 cd }}, at: 0 3 0 m{moves} }}]\n");
    let (said, code) = checked(body, "at: 0 0 0 m", &lamp(""));
    assert!(code == 0 && said.contains("where on its way"), "{said}");
    let (said, code) = checked(body, "at: 0 0 0 m", &lamp(", velocity: { gamma: 1e8, along: 1 0 0 }"));
    assert!(code == 0 && !said.contains("where on its way"), "{said}");
}

#[test]
fn what_is_faster_than_can_be_followed_is_refused_with_its_number() {
    let still = "at: 0 0 -10 m";
    let rocket = "rocket: { acceleration: 1 0 0 m/s2 }";
    for (body, observer, more, part) in [
        ("velocity: { gamma: 1.1e8, along: 1 0 0 }", "at: 0 0 5 m", "", "gamma: 1e8"),
        ("velocity: 0.99999999999 0 0 c", "at: 0 0 5 m", "", "does not tell how fast"),
        (still, &format!("at: 0 0 0 m, {rocket}")[..], "exposures: { at: 20 s }", "Lorentz factor is 2.4"),
        (
            still,
            &format!("velocity: {{ gamma: 1e6, along: -1 0 0 }}, {rocket}")[..],
            "exposures: { at: 14 s }",
            "leave of one another",
        ),
        (
            "velocity: { gamma: 1e6, along: 1 0 0 }, material: { glass: { index: 1.5 } }",
            "at: 0 0 5 m",
            "",
            "glass at a Lorentz factor",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.yaml");
        let exposures = if more.is_empty() { "exposures: { at: 0 s }" } else { more };
        let text = format!(
            "light_speed: 1 m/s\nassets: {{ ball: {{ sphere: {{ radius: 0.5 m }} }} }}\nbodies: [{{ asset: ball, {body} }}]\n\
             observer: {{ {observer} }}\n{exposures}\nlights: [{{ sun: {{ illuminance: 1 lx }} }}]\noutput: out\n"
        );
        std::fs::write(&path, text).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_terrell")).arg("check").arg(&path).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{body}: {said}");
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn time_is_no_doubt_about_what_rests() {
    let (said, code) = checked("at: 0 0 -3 m, at_time: -1e13 s, scale: 0.01", "at: 0 0 0 m", "");
    assert!(code == 0 && !said.contains("warning"), "{said}");
    let (said, code) = checked("at: 0 0 -3 m, at_time: -1e13 s, velocity: 0.5 0 0 c", "at: 0 0 0 m", "");
    assert!(code == 0 && said.contains("place is known to"), "{said}");
}

#[test]
fn lamp_whose_place_is_not_known_is_warned_of_or_refused() {
    let lamp = |time: &str, speed: &str| {
        let text = format!(
            "lights: [{{ lamp: {{ intensity: 9 cd }}, at: 0 3 0 m, at_time: {time}, velocity: {speed} }}]\n"
        );
        checked("at: 0 0 -3 m", "at: 0 0 0 m", &text)
    };
    let (said, code) = lamp("-1e4 s", "0.5 0 0 c");
    assert!(code == 0 && !said.contains("warning"), "{said}");
    let (said, code) = lamp("-1e15 s", "0 0 0 c");
    assert!(code == 0 && !said.contains("warning"), "{said}");
    let (said, code) = lamp("-5e14 s", "0.5 0 0 c");
    assert!(code == 0 && said.contains("its place is known to"), "{said}");
    let (said, code) = lamp("-1e17 s", "0.5 0 0 c");
    assert!(code == 2 && said.contains("at_time") && said.contains("m.yaml:8"), "{said}");
}

#[test]
fn clock_that_cannot_be_read_is_warned_of() {
    let blinking = |period: &str| {
        let text = format!(
            "lights: [{{ lamp: {{ intensity: 9 cd }}, at: 0 3 0 m, blinking: {{ period: {period} }} }}]\n"
        );
        checked("at: 0 0 -3 m", "at: 0 0 0 m", &text)
    };
    let (said, code) = blinking("1e-6 s");
    assert!(code == 0 && !said.contains("warning"), "{said}");
    let (said, code) = blinking("1e-14 s");
    assert!(code == 0 && said.contains("its clock can be read to"), "{said}");
}

#[test]
fn body_of_which_a_scale_leaves_nothing_is_refused() {
    for scale in ["1e-120", "1e-200 1 1"] {
        let (said, code) = checked(&format!("at: 0 0 -3 m, scale: {scale}"), "at: 0 0 0 m", "");
        assert!(code == 2 && said.contains("m.yaml:4"), "{scale}: {said}");
    }
}

#[test]
fn peaks_that_wavelengths_may_miss_are_warned_of() {
    let lamp = |rows: &str, picture: &str| {
        let spectrum = format!("spectrum: {{ table: [{rows}] }}");
        let light = format!("lights: [{{ lamp: {{ intensity: 9 W/sr, {spectrum} }}, at: 0 3 0 m }}]\n");
        checked("at: 0 0 -3 m", "at: 0 0 0 m", &(light + picture))
    };
    let spike = "[400, 1], [529, 1], [531, 20], [533, 1], [700, 1]";
    let hill = "[400, 1], [500, 1], [531, 20], [560, 1], [700, 1]";
    let (said, code) = lamp(spike, "");
    assert!(code == 0 && said.contains("a peak 2.0 nm wide"), "{said}");
    let (said, code) = lamp(hill, "");
    assert!(code == 0 && !said.contains("warning"), "{said}");
    let narrower = "[400, 1], [520, 1], [526, 20], [532, 1], [700, 1]";
    assert!(lamp(narrower, "").0.contains("a peak 6.0 nm"));
    assert!(!lamp(narrower, "picture: { wavelengths: 64 }").0.contains("warning"));
}
