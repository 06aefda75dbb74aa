//! Whatever is in a file, it is read or refused, soon and without a panic.

use super::faults;
use proptest::prelude::*;
use std::path::Path;
use std::time::{Duration, Instant};
use terrell::diagnostic::render;
use terrell::error::Report;
use terrell::manifest::{self, Worldline};

const FLYBY: &str = include_str!("../manifests/good/flyby.yaml");
const STUDIO: &str = include_str!("../manifests/good/studio.yaml");

/// Reads a text and shows what is said about it.
fn survives(text: &str) {
    render(&faults(text).faults, false, true);
}

/// Pieces of which YAML that goes wrong is made.
const PIECES: &[&str] = &[
    "observer",
    "bodies",
    "at",
    "velocity",
    "spectra",
    "sum",
    "materials",
    ": ",
    ":\n",
    "- ",
    "\n",
    "\n  ",
    "\n    ",
    "{",
    "}",
    "[",
    "]",
    ", ",
    "? ",
    "&a ",
    "*a",
    "!x ",
    "<<",
    "|",
    ">",
    "\"",
    "'",
    "# ",
    "%",
    "@",
    "`",
    "---\n",
    "...\n",
    "\t",
    "\r",
    "\u{feff}",
    "\u{2028}",
    "é",
    "😀",
    "\0",
    "0 2 -9.5 m",
    "1e999",
    "nan",
    "0.9 0 0 c",
    "~",
    "D65",
    "a",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_text_never_panics(text in any::<String>()) {
        survives(&text);
    }

    #[test]
    fn random_pieces_of_yaml_never_panic(pieces in prop::collection::vec(prop::sample::select(PIECES), 0..60)) {
        survives(&pieces.concat());
    }

    #[test]
    fn mutilated_manifests_never_panic(
        flyby in any::<bool>(),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0..6_usize, prop::sample::select(PIECES)), 1..6),
    ) {
        let mut text: Vec<char> = if flyby { FLYBY } else { STUDIO }.chars().collect();
        for (at, length, piece) in cuts {
            let at = at.index(text.len());
            let end = (at + length).min(text.len());
            text.splice(at..end, piece.chars());
        }
        survives(&text.into_iter().collect::<String>());
    }

    #[test]
    fn values_of_any_sort_never_panic(key in prop::sample::select(KEYS), value in prop::sample::select(VALUES)) {
        survives(&format!("{}\n", key.replace('@', value)));
    }

    #[test]
    fn numbers_of_any_size_never_panic(
        x in any::<f64>(),
        unit in prop::sample::select(UNITS),
        key in prop::sample::select(KEYS),
    ) {
        survives(&key.replace('@', &format!("{x:e} {x} 0 {unit}")));
        survives(&key.replace('@', &format!("{x:e} {unit}")));
    }

    #[test]
    fn squares_of_accepted_numbers_are_finite(powers in prop::array::uniform6(-330..330), sign in any::<bool>()) {
        let [light, at, at_time, speed, acceleration, up] = powers.map(|power| format!("1e{power}"));
        let sign = if sign { "-" } else { "" };
        let placement = format!("at: {sign}{at} {at} 0 m, at_time: {sign}{at_time} yr, velocity: 0 {sign}{speed} 0 m/s");
        let text = format!(
            "light_speed: {light} m/s\nobserver: {{ {placement}, up: {up} {sign}{up} 0, rocket: {{ acceleration: {acceleration} 0 \
             {acceleration} g }} }}\noutput: out\n"
        );
        let mut report = Report::default();
        if let Some(m) = manifest::parse(Path::new("m.yaml"), &text, &mut report) {
            let (o, p) = (&m.observer, &m.observer.placement);
            let Worldline::Rocket(rocket) = &o.worldline else { unreachable!("as written") };
            let squares = p.at.length_squared() + p.at_time * p.at_time + p.velocity.gamma();
            prop_assert!((squares + rocket.acceleration.length_squared()).is_finite());
            prop_assert!((o.up.length() - 1.0).abs() < 1e-15);
        }
    }
}

const UNITS: &[&str] =
    &["", "m", "s", "c", "deg", "K", "nm", "cd", "m/s2", "yr", "km/s", "deg about 1e308 0 0"];

const KEYS: &[&str] = &[
    "observer: { at: @, velocity: @, rotation: @, up: @, field_of_view: @ }",
    "observer: { look_at: @, rocket: { acceleration: @ } }",
    "observer: { direction: @, orbit: { radius: @, speed: @, axis: @, start: @ } }",
    "bodies: [{ asset: @, scale: @, at_time: @, velocity: { gamma: @, along: @ } }]",
    "bodies: [{ velocity: { rapidity: @, along: @ } }, { velocity: { gamma_beta: @ }, rotation: { quaternion: @ } }]",
    "spectra: { a: { black_body: @, scale: @ }, b: { line: @ }, c: { table: @ }, d: { rgb: @ }, e: { sum: @ } }",
    "spectra: { a: { srgb: @ }, b: { constant: @ }, c: { of: @, scale: @ }, d: { line: { centre: @, width: @ } }, e: @ }",
    "materials: { a: { diffuse: @ }, b: { mirror: @ }, c: { emission: { luminance: @ } }, d: @ }",
    "lights: [{ lamp: { intensity: @ } }, { spot: { intensity: @, cone: @, inner: @ } }, { sun: { illuminance: @ } }, @]",
    "exposures: { from: @, to: @, count: @, at: @, clock: @ }",
    "picture: { size: @, samples: @, depth: @, wavelengths: @, filter: @, white: @, stops: @ }\nfilm: { rate: @ }",
    "materials: { a: { metal: @, roughness: @ }, b: { glass: @ }, c: { glass: { cauchy: @, color: @, distance: @ } }, d: { gloss: @ } }",
    "materials: { a: { glass: { sellmeier: @ } }, b: { glass: { sellmeier: [[@, @]] } }, c: { ultraviolet: @ }, d: { keys: @ } }",
    "materials: { a: { diffuse: { checker: @ } }, b: { diffuse: { picture: @, size: @ } }, c: { blinking: { period: @, on: @, off: @ } } }",
    "lights: [{ lamp: { intensity: 1 cd }, blinking: { period: @, lit: @, start: @ } }, { lamp: { intensity: 1 cd }, keys: [{ at: @ }, @] }]",
    "assets: { a: { sphere: { radius: @ } }, b: { box: { size: @ } }, c: { plane: @ }, d: { union: @ }, e: { difference: [@, @] } }",
    "assets: { a: { cone: { radius: 1 m, height: @ }, at: @, rotation: @ }, b: { file: @, node: @ }, c: { cylinder: @ } }",
    "surroundings: [{ uniform: @, velocity: @ }, { picture: @ }, { stars: @ }, { stars: { count: @, seed: @, faintest: @ } }, @]",
    "surroundings: { stars: { catalogue: @, brightness: @ }, picture: { file: @, luminance: @ }, rotation: @ }",
    "light_speed: @\noutput: @\nfilm: @\nassets: @\neffects: @\nambient: @\nsurroundings: @",
];

pub(super) const VALUES: &[&str] = &[
    "x",
    "~",
    "''",
    "[]",
    "{}",
    "[[]]",
    "{ a: b }",
    "[1, 2, 3]",
    "[a, [b]]",
    "-0",
    "+.5e-3",
    "1e-400",
    "-1",
    ".",
    "-",
    "e5",
    "1.2.3",
    "1 2 3 4 5 6 7 8 9",
    "0 0 0",
    "0x10",
    "1:30",
    "on",
    "*b",
    "\"\\u0000\"",
    "\"a\\nb\"",
    "3 m 4 s",
    "3 /s",
    "3 c/",
    "3 /",
    "3 m/s/s",
    "30 deg about",
    "about about",
    "mirror",
    "D65",
    "9e307 9e307 9e307 m",
];

/// Reads a text soon: in much less than a second, but machines are busy.
fn soon(text: &str) -> usize {
    let begun = Instant::now();
    let report = faults(text);
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    assert!(report.faults.len() <= 1001);
    report.faults.len()
}

pub(super) const REST: &str = "observer: {}\noutput: out\n";

#[test]
fn aliases_of_aliases_are_refused_before_they_are_written_out() {
    let mut text = "a0: &a0 [x,x,x,x,x,x,x,x,x,x]\n".to_owned();
    for i in 1..200 {
        text.push_str(&format!("a{i}: &a{i} [{}]\n", vec![format!("*a{}", i - 1); 10].join(",")));
    }
    assert_eq!(soon(&format!("{text}{REST}")), 1);
}

#[test]
fn names_that_double_what_they_stand_for_are_refused() {
    let mut text = "spectra:\n  a0: D65\n".to_owned();
    for i in 1..200 {
        text.push_str(&format!("  a{i}: {{ sum: [a{0}, a{0}] }}\n", i - 1));
    }
    assert!(soon(&format!("{text}{REST}")) > 0);
}

#[test]
fn chains_of_names_are_refused_when_they_are_too_long() {
    let mut text = "spectra:\n".to_owned();
    for i in 0..10_000 {
        text.push_str(&format!("  a{i}: {{ of: a{}, scale: 2 }}\n", i + 1));
    }
    text.push_str("  a10000: D65\n");
    let text = format!("{text}{REST}");
    assert!(soon(&text) > 0);
    assert!(faults(&text).faults.iter().any(|fault| fault.what == "more than 96 keys within one another"));
}

#[test]
fn nested_sums_and_long_sums_are_refused() {
    let nested = "{ sum: [".repeat(30) + "D65" + &"] }".repeat(30);
    assert_eq!(soon(&format!("spectra: {{ a: {nested} }}\n{REST}")), 0);
    let nested = "{ sum: [".repeat(40) + "D65" + &"] }".repeat(40);
    assert_eq!(soon(&format!("spectra: {{ a: {nested} }}\n{REST}")), 1);
    let long = vec!["D65"; 5000].join(", ");
    assert_eq!(soon(&format!("spectra: {{ a: {{ sum: [{long}] }} }}\n{REST}")), 1);
}

#[test]
fn very_many_keys_are_refused_soon() {
    let mut text = String::new();
    (0..45_000).for_each(|i| text.push_str(&format!("outpu{i}: {{}}\n")));
    assert!(soon(&format!("{text}{REST}")) >= 1000);
}

#[test]
fn very_many_unknown_names_are_refused_soon() {
    let mut text = "assets:\n".to_owned();
    (0..10_000).for_each(|i| text.push_str(&format!("  asset_number_{i}: a.glb\n")));
    text.push_str("bodies:\n");
    (0..10_000).for_each(|i| text.push_str(&format!("  - {{ asset: asset_nummer_{i} }}\n")));
    assert!(soon(&format!("{text}{REST}")) >= 1000);
}

#[test]
fn very_long_texts_are_refused_soon() {
    let long = "x".repeat(3 << 20);
    assert_eq!(soon(&format!("{long}: 1\n{REST}")), 1);
    assert_eq!(soon(&format!("output: {long}\nobserver: {{}}\n")), 1);
    assert_eq!(soon(&format!("a: &a \"{}\"\nb: [{}]\n", "x".repeat(9_000), vec!["*a"; 90_000].join(","))), 1);
    let repeated =
        format!("output: &a \"{}\"\nlights: [{}]\n", "x".repeat(1_000), vec!["lamp: *a"; 4_000].join(","));
    assert!(soon(&repeated) >= 1000);
}

#[test]
fn very_deep_nesting_is_refused_soon() {
    assert_eq!(soon(&"[".repeat(1 << 20)), 1);
    assert_eq!(soon(&"{a: ".repeat(1 << 18)), 1);
    assert_eq!(soon(&"- ".repeat(1 << 18)), 1);
    assert_eq!(soon(&"? ".repeat(1 << 18)), 1);
}

#[test]
fn control_characters_are_refused() {
    assert_eq!(soon(&format!("# \u{7}\n{REST}")), 1);
    assert_eq!(soon(&format!("# \u{85}\n{REST}")), 0);
}

#[test]
fn depth_by_way_of_aliases_is_depth() {
    let mut text = "a0: &a0 [x]\n".to_owned();
    (1..100).for_each(|i| text.push_str(&format!("a{i}: &a{i} [*a{}]\n", i - 1)));
    assert_eq!(soon(&format!("{text}{REST}")), 1);
}

/// Texts of legal size that ask for as much as they can.
fn greedy() -> Vec<String> {
    let lots = |item: &str, count: usize| vec![item; count].join(", ");
    let mut keys = String::new();
    (0..120_000).for_each(|i| keys.push_str(&format!("k{i}: {i}\n")));
    vec![
        format!("bodies: [{}]\n{REST}", lots("{}", 240_000)),
        format!("bodies: [{}]\n{REST}", lots("{a: [b]}", 62_000)),
        format!("bodies: [{}]\n{REST}", lots("{ asset: a }", 80_000)),
        format!("spectra: {{ a: [{}] }}\n{REST}", lots("é", 249_000)),
        keys + REST,
        format!("a: &a [{}]\nb: [{}]\n{REST}", lots("x", 400), lots("*a", 600)),
        format!("a: [{}]\n{REST}", lots("[[[[x]]]]", 49_000)),
        format!("a: [{}]\n{REST}", lots("\"x\"", 249_000)),
        format!("# {}\n{REST}", "é".repeat(2_000_000)),
        format!("bodies: [{}]\n{REST}", lots("1", 2_000_000)),
    ]
}

/// The system counts what a process may write to; more than 100 MB are refused to it, and it ends by a signal.
#[cfg(target_os = "linux")]
#[test]
fn greedy_texts_are_read_or_refused_within_100_megabytes() {
    let folder = tempfile::tempdir().unwrap();
    for (number, text) in greedy().iter().enumerate() {
        let file = folder.path().join(format!("{number}.yaml"));
        std::fs::write(&file, text).unwrap();
        let begun = Instant::now();
        let mut shell = std::process::Command::new("sh");
        let limited = r#"ulimit -d 100000 && exec "$0" check "$1""#;
        let output = shell.args(["-c", limited, env!("CARGO_BIN_EXE_terrell")]).arg(&file).output().unwrap();
        let read = matches!(output.status.code(), Some(0 | 2));
        assert!(read, "{number}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(begun.elapsed() < Duration::from_secs(5), "{number}: {:?}", begun.elapsed());
    }
}
