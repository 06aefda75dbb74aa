//! What units mean: metres, radians and fractions of c.
#![expect(clippy::float_cmp, reason = "where a result is exact it is compared exactly")]

use super::{close, complete, faults, observer, read};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use terrell::manifest::{LIGHT_SPEED, Worldline};

const C: f64 = LIGHT_SPEED;

#[test]
fn lengths_are_metres() {
    for (written, metres) in [
        ("2 m", 2.0),
        ("7 cm", 0.07),
        ("3 mm", 0.003),
        ("2 km", 2000.0),
        ("4 um", 4e-6),
        ("4 µm", 4e-6),
        ("589 nm", 589e-9),
        ("1 ls", C),
        ("2 ly", 2.0 * 31_557_600.0 * C),
        ("1 au", 149_597_870_700.0),
        ("1 pc", 3.085_677_581_491_367e16),
        ("-2m", -2.0),
        ("-0 m", 0.0),
        ("+3 m", 3.0),
        (".5 m", 0.5),
        ("5. m", 5.0),
        ("1e3 m", 1000.0),
        ("1.5E-2 m", 0.015),
    ] {
        let at = observer(&format!("{{ at: 0 0 {written} }}")).placement.at;
        assert!(close(at.z, metres) && at.x == 0.0, "{written} is {}", at.z);
    }
    assert_eq!(observer("{ at: 0 2 -9.5 m }").placement.at, DVec3::new(0.0, 2.0, -9.5));
    assert_eq!(observer("{ at: \"0 2   -9.5 m\" }").placement.at, DVec3::new(0.0, 2.0, -9.5));
}

#[test]
fn times_are_metres_of_light_travel() {
    for (written, seconds) in [
        ("1 s", 1.0),
        ("2 ms", 2e-3),
        ("2 us", 2e-6),
        ("12 ns", 12e-9),
        ("5 ps", 5e-12),
        ("1 fs", 1e-15),
        ("2 min", 120.0),
        ("1 h", 3600.0),
        ("1 d", 86_400.0),
        ("1 yr", 31_557_600.0),
        ("1 ls", 1.0),
        ("3 m", 3.0 / C),
        ("1 ly", 31_557_600.0),
    ] {
        let found = observer(&format!("{{ at_time: {written} }}")).placement.at_time;
        assert!(close(found, seconds * C), "{written} is {found}");
    }
}

#[test]
fn angles_are_radians() {
    for (written, radians) in
        [("90 deg", FRAC_PI_2), ("90°", FRAC_PI_2), ("1 rad", 1.0), ("0.25 turn", FRAC_PI_2)]
    {
        assert!(
            close(observer(&format!("{{ field_of_view: {written} }}")).field_of_view.unwrap(), radians),
            "{written}"
        );
    }
}

#[test]
fn speeds_are_fractions_of_c() {
    for (written, beta) in [
        ("0.8 c", 0.8),
        ("-0.8 c", -0.8),
        ("3e7 m/s", 3e7 / C),
        ("300 km/s", 3e5 / C),
        ("36 km/h", 10.0 / C),
        ("0.5 ls/s", 0.5),
        ("0.25 ly/yr", 0.25),
        ("1 au/d", 149_597_870_700.0 / 86_400.0 / C),
    ] {
        let found = observer(&format!("{{ velocity: 0 0 {written} }}")).placement.velocity;
        assert!((found.beta().z - beta).abs() < 1e-15, "{written} is {}", found.beta().z);
        let orbit = observer(&format!("{{ orbit: {{ radius: 1 m, speed: {written} }} }}"));
        let Worldline::Orbit(orbit) = orbit.worldline else { panic!("an orbit") };
        assert!(close(orbit.speed, found.proper().z), "{written}");
    }
}

#[test]
fn accelerations_are_per_metre() {
    for (written, seconds) in [
        ("9.8 m/s2", 9.8 / C),
        ("9.8 m/s²", 9.8 / C),
        ("9.8 m/s^2", 9.8 / C),
        ("0.1 c/s", 0.1),
        ("1 g", 9.806_65 / C),
        ("1 ly/yr2", 1.0 / 31_557_600.0),
        ("1 c/yr", 1.0 / 31_557_600.0),
        ("1 km/s2", 1000.0 / C),
        ("36 km/h/s", 0.0),
    ] {
        let text = format!("observer: {{ rocket: {{ acceleration: 0 0 {written} }} }}\noutput: out\n");
        if seconds == 0.0 {
            assert_eq!(faults(&text).faults.len(), 1, "{written}");
            continue;
        }
        let Worldline::Rocket(rocket) = read(&text).observer.worldline else { panic!("a rocket") };
        assert!(close(rocket.acceleration.z, seconds / C), "{written} is {}", rocket.acceleration.z);
    }
}

#[test]
fn a_slower_light_makes_seconds_shorter_ways() {
    let m = read(
        "light_speed: 2 m/s\nobserver: { at: 0 0 1 ls, at_time: 3 s, velocity: 0 0 1 m/s, rocket: { acceleration: 0 0 4 m/s2 } }\noutput: out\n",
    );
    assert_eq!(m.observer.placement.at.z, 2.0);
    assert_eq!(m.observer.placement.at_time, 6.0);
    assert!(close(m.observer.placement.velocity.beta().z, 0.5));
    assert!(matches!(&m.observer.worldline, Worldline::Rocket(rocket) if rocket.acceleration.z == 1.0));
    // Wherever it is written: the order of keys has no meaning.
    assert_eq!(
        read("observer: { at_time: 3 s }\noutput: out\nlight_speed: 2 m/s\n").observer.placement.at_time,
        6.0
    );
    assert_eq!(complete("light_speed: 36 km/h").light_speed, 10.0);
}

#[test]
fn all_ways_to_write_a_velocity_agree() {
    // β = 3/5, γ = 5/4, rapidity ln 2.
    for written in [
        "0 0 0.6 c",
        "{ gamma: 1.25, along: 0 0 7 }",
        "{ rapidity: 0.6931471805599453, along: 0 0 1e-200 }",
        "{ gamma_beta: 0 0 0.75 }",
    ] {
        let u = observer(&format!("{{ velocity: {written} }}")).placement.velocity.proper();
        assert!((u - DVec3::new(0.0, 0.0, 0.75)).length() < 1e-15, "{written} is {u}");
    }
    for written in ["0.6 c", "{ gamma: 1.25 }", "{ rapidity: 0.6931471805599453 }", "{ gamma_beta: 0.75 }"] {
        let observer = observer(&format!("{{ orbit: {{ radius: 1 m, speed: {written} }} }}"));
        assert!(
            matches!(&observer.worldline, Worldline::Orbit(orbit) if close(orbit.speed, 0.75)),
            "{written}"
        );
    }
    assert_eq!(observer("{ velocity: { gamma: 1, along: 1 0 0 } }").placement.velocity.proper(), DVec3::ZERO);
}

#[test]
fn speeds_just_below_light_are_kept() {
    // 1/√(2e-9) for 1 - 1e-9.
    let gamma = observer("{ velocity: 0 0 0.999999999 c }").placement.velocity.gamma();
    assert!((gamma / 22_360.679_8 - 1.0).abs() < 1e-7);
    let gamma = observer("{ velocity: { gamma: 1e5, along: 0 1 0 } }").placement.velocity.gamma();
    assert!((gamma / 1e5 - 1.0).abs() < 1e-15);
}

#[test]
fn rotations_are_done_in_the_order_written() {
    let turned = |text: &str, v: DVec3| observer(&format!("{{ rotation: {text} }}")).placement.rotation * v;
    let same = |a: DVec3, b: DVec3| (a - b).length() < 1e-15;
    assert!(same(turned("90 deg about 0 1 0", DVec3::Z), DVec3::X));
    assert!(same(turned("90 deg about 0 0.001 0", DVec3::Z), DVec3::X));
    assert!(same(turned("[90 deg about 1 0 0, 90 deg about 0 1 0]", DVec3::Y), DVec3::X));
    assert!(same(turned("[90 deg about 0 1 0, 90 deg about 1 0 0]", DVec3::Y), DVec3::Z));
    assert!(same(turned("{ quaternion: 0 5 0 5 }", DVec3::Z), DVec3::X));
    assert!(same(turned("[]", DVec3::Z), DVec3::Z));
}
