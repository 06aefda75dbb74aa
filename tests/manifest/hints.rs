//! What hints say to type, typed.

use super::faults;
use super::hostile::{REST, VALUES};

/// Places for values, one each.
const SLOTS: &[&str] = &[
    "observer: { at: @ }",
    "observer: { at_time: @ }",
    "observer: { velocity: @ }",
    "observer: { velocity: { gamma: @, along: 1 0 0 } }",
    "observer: { velocity: { gamma: 2, along: @ } }",
    "observer: { velocity: { gamma_beta: @ } }",
    "observer: { rotation: @ }",
    "observer: { rotation: { quaternion: @ } }",
    "observer: { direction: 1 0.1 0.2, up: @ }",
    "observer: { field_of_view: @ }",
    "observer: { rocket: { acceleration: @ } }",
    "observer: { orbit: { radius: @, speed: 0.5 c } }",
    "observer: { orbit: { radius: 1 m, speed: @ } }",
    "observer: { orbit: { radius: 1 m, speed: { rapidity: @ } } }",
    "observer: { ring: { radius: 1 m, turns: @ } }",
    "exposures: { at: @ }",
    "exposures: { from: 0 s, to: 1 s, count: @ }",
    "exposures: { from: 0 s, to: 1 s, count: 2, clock: @ }",
    "picture: { size: @ }",
    "picture: { samples: @ }",
    "picture: { depth: @ }",
    "picture: { wavelengths: @ }",
    "picture: { faintest: @ }",
    "picture: { tolerance: @ }",
    "picture: { filter: @ }",
    "picture: { white: @ }",
    "picture: { stops: @ }",
    "film: { rate: @ }",
    "film: { video: @ }",
    "effects: { doppler: @ }",
    "light_speed: @",
    "spectra: { a: { black_body: @ } }",
    "spectra: { a: { line: @ } }",
    "spectra: { a: { line: { centre: 500 nm, width: @ } } }",
    "spectra: { a: { constant: @ } }",
    "spectra: { a: { rgb: @ } }",
    "lights: [{ lamp: { intensity: @ } }]",
    "lights: [{ spot: { intensity: 1 cd, cone: @ } }]",
    "lights: [{ lamp: { intensity: 1 cd }, blinking: { period: @ } }]",
    "lights: [{ lamp: { intensity: 1 cd }, blinking: { period: 1 s, lit: @ } }]",
    "ambient: { luminance: @ }",
    "assets: { a: { sphere: { radius: @ } } }",
    "assets: { a: { box: { size: @ } } }",
    "assets: { a: { cone: { radius: 1 m, height: @ } } }",
    "materials: { a: { metal: @ } }",
    "materials: { a: { metal: gold, roughness: @ } }",
    "materials: { a: { mirror: @ } }",
    "surroundings: { stars: { count: @ } }",
    "surroundings: { stars: { count: 3, seed: @ } }",
    "surroundings: { stars: { count: 3, faintest: @ } }",
    "turntable: { around: 0 0 0 m, radius: @ }",
    "turntable: { around: 0 0 0 m, radius: 1 m, speed: @ }",
    "flyby: { past: 0 0 0 m, distance: 1 m, speed: 0.5 c, reach: @ }",
];

/// What is nearly right, or is so elsewhere.
const SLIPS: &[&str] = &[
    "nan 0 0 c",
    "inf m",
    "1 2 c",
    "0 0 1 c",
    "2 c",
    "-1 c",
    "0 0 0 c",
    "5",
    "-5",
    "0",
    "0.5",
    "1e9",
    "1280",
    "1280x720",
    "3 4",
    "0 m",
    "-3 m",
    "2 s",
    "0 s",
    "400 deg",
    "0 deg",
    "30",
    "3 cd",
    "-3 cd",
    "0 cd",
    "100 lx",
    "1e400 m",
    "1,5 m",
    "1, 2, 3 m",
    "off",
    "none",
    "gol",
    "7.5",
    "300 K",
    "0 K",
    "589",
    "0 nm",
    "1_000 m",
    "0.9c",
    "1e3 1e3 1e3 km/s",
    "99 lightyears",
    "3 furlongs",
];

#[test]
fn what_hints_say_to_type_is_no_fault() {
    let mut typed = 0;
    for slot in SLOTS {
        let key = slot[..slot.find(": @").unwrap()].rsplit([' ', '{']).next().unwrap();
        let rest = if slot.starts_with("observer") || slot.contains("around") || slot.contains("past") {
            "output: out\n"
        } else {
            REST
        };
        for value in VALUES.iter().chain(SLIPS) {
            let report = faults(&format!("{}\n{rest}", slot.replace('@', value)));
            let [fault] = report.faults.as_slice() else { continue };
            let Some(hint) = fault.hint.strip_prefix(&format!("{key}: ")) else { continue };
            let end = [" (", ", or ", ", and ", "; "].iter().filter_map(|stop| hint.find(stop)).min();
            let hint = &hint[..end.unwrap_or(hint.len())];
            let again = faults(&format!("{}\n{rest}", slot.replace('@', hint)));
            assert_eq!(again.faults, [], "{slot} with `{value}`: {} says `{hint}`", fault.what);
            typed += 1;
        }
    }
    assert!(typed > 1000, "{typed}");
}
