//! What a manifest says of courses is what the scene does: keys and blinking, by each one's own clock.

use crate::support::{along, emission_time, frequency, light_at_rest, light_to, look, near, near_vector, v};
use glam::DVec3;
use std::path::Path;
use terrell::error::Report;
use terrell::manifest;
use terrell::scene::{Scene, compose};
use terrell::spacetime::{Event, Poincare, Rest, SightRay, Velocity};
use terrell::spectrum::{Source, Spectrum, Wavelengths};

/// The scene of a manifest in which a second is a metre, seen by nobody in particular.
#[track_caller]
fn scene(text: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("manifests/clockwork.yaml");
    let text = format!("{text}\nlight_speed: 1 m/s\nobserver: {{ at: 0 50 0 m }}\noutput: out");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, &text, &mut report);
    let scene = manifest.and_then(|manifest| compose(&manifest, &path, &mut report));
    assert!(report.faults.is_empty(), "{:?}\n{text}", report.faults);
    scene.unwrap()
}

const FLOOR: &str = "assets: { floor: { plane: {} }, ball: { sphere: { radius: 1 m } } }";

fn from_floor(at: Event) -> SightRay {
    light_to(at.x + v(0.1, 1.0, 0.2), at)
}

/// A lamp whose brightness and spectrum go over from key to key: the sum of both spectra, each with its share.
#[test]
fn keys_of_a_lamp_are_those_of_its_own_clock() {
    let beta = v(0.3, 0.0, -0.6);
    let moves = Velocity::from_beta(beta).unwrap();
    let text = |course: &str, spectrum: &str| {
        let u = moves.proper();
        format!(
            "{FLOOR}\nbodies: [{{ asset: floor, material: {{ diffuse: 0.5 }} }}]\nlights:\n  - {{ lamp: {{ intensity: 100 cd, \
             spectrum: {{ {spectrum} }} }}, at: 1 4 2 m, at_time: 3 s, velocity: {{ gamma_beta: {:e} {:e} {:e} }}{course} }}",
            u.x, u.y, u.z
        )
    };
    let keys = ", keys: [{ at: 1 s, brightness: 0.4 }, { at: 5 s, brightness: 2, spectrum: { line: 500 nm } }, { at: 6 s, brightness: 1 }]";
    let keyed = scene(&text(keys, "black_body: 3000 K"));
    let warm = scene(&text("", "black_body: 3000 K"));
    let green = scene(&text("", "line: 500 nm"));
    // Brightness of each: what the keys on both sides have.
    let by_hand = |tau: f64| -> (f64, f64) {
        match tau {
            tau if tau < 1.0 => (0.4, 0.0),
            tau if tau < 5.0 => (0.4 * (5.0 - tau) / 4.0, 2.0 * (tau - 1.0) / 4.0),
            tau if tau < 6.0 => (0.0, 2.0 + (1.0 - 2.0) * (tau - 5.0)),
            _ => (0.0, 1.0),
        }
    };
    for t in [2.0, 6.0, 8.0, 10.0, 11.0, 12.0, 13.0, 14.0, 30.0] {
        let at = Event::new(t, v(0.5, 0.0, 1.0));
        let path = |t: f64| v(1.0, 4.0, 2.0) + beta * (t - 3.0);
        let tau = (emission_time(at, path) - 3.0) / moves.gamma();
        let ray = from_floor(at);
        let (got, warm, green) = (look(&keyed, &ray), look(&warm, &ray), look(&green, &ray));
        let (a, b) = by_hand(tau);
        for (value, all) in got.radiance.iter().zip(warm.radiance) {
            near(*value, all * a, 1e-9 * all);
        }
        near_vector(got.lines, green.lines * b, 1e-9 * green.lines.length());
    }
}

/// A sun that blinks, by its wave fronts: the same stripes for every one who writes it down. Turned and moving.
#[test]
fn blinking_sun_of_a_manifest_goes_by_its_wave_fronts() {
    let moves = Velocity::from_beta(v(0.4, 0.3, 0.0)).unwrap();
    let u = moves.proper();
    let scene = scene(&format!(
        "{FLOOR}\nbodies: [{{ asset: floor, material: {{ diffuse: 0.5 }} }}]\nlights: [{{ sun: {{ illuminance: 100 lx, \
         direction: 0.36 -0.8 0.48 }}, at: 1 2 3 m, at_time: -2 s, velocity: {{ gamma_beta: {:e} {:e} {:e} }}, \
         blinking: {{ period: 2 s, lit: 0.3, start: 0.5 s }} }}]",
        u.x, u.y, u.z
    ));
    let axis = v(0.36, -0.8, 0.48);
    let (way, doppler) = (along(-moves, axis), frequency(-moves, axis));
    let mut lit = 0;
    for i in 0..200 {
        let at =
            Event::new(0.173 * f64::from(i) - 9.0, v(0.31 * f64::from(i % 17), 0.0, 0.7 * f64::from(i % 5)));
        let tau = doppler * ((at.t + 2.0) - way.dot(at.x - v(1.0, 2.0, 3.0)));
        let expected = ((tau - 0.5) / 2.0).rem_euclid(1.0) < 0.3;
        assert_eq!(look(&scene, &from_floor(at)).radiance[30] > 0.0, expected, "{tau}");
        lit += u32::from(expected);
    }
    assert!((30..120).contains(&lit), "{lit}");
}

/// A material that goes over from one glow to another and to a grey in fill light, by its body's clock.
#[test]
fn keys_of_a_material_are_those_of_its_bodys_clock() {
    let moves = Velocity::from_beta(v(0.3, -0.5, 0.2)).unwrap();
    let u = moves.proper();
    let body = |at: &str, at_time: &str| {
        format!(
            "{{ asset: ball, at: {at}, at_time: {at_time}, velocity: {{ gamma_beta: {:e} {:e} {:e} }}, material: {{ keys: [ \
             {{ at: -1 s, material: {{ emission: {{ luminance: 10 cd/m2, spectrum: {{ black_body: 3000 K }} }} }} }}, \
             {{ at: 1 s, material: {{ emission: {{ luminance: 40 cd/m2, spectrum: {{ black_body: 3000 K }} }} }} }}, \
             {{ at: 3 s, material: {{ diffuse: 0.5 }} }}] }}, ambient: {{ luminance: 8 cd/m2, spectrum: {{ black_body: 3000 K }} }} }}",
            u.x, u.y, u.z
        )
    };
    let places = [(v(1.0, 2.0, 3.0), -4.0), (v(30.0, -5.0, 2.0), 2.5)];
    let scene = scene(&format!(
        "{FLOOR}\nbodies:\n  - {}\n  - {}",
        body("1 2 3 m", "-4 s"),
        body("30 -5 2 m", "2.5 s")
    ));
    assert_eq!(scene.world.frames.len(), 1);
    let unit = Source::with_luminous(&Spectrum::BlackBody(3000.0), 1.0).unwrap();
    for (place, at_time) in places {
        let into: Poincare<Rest> = Poincare::to_moving(moves, Event::new(at_time, place));
        for (tau, luminance) in [
            (-3.0, 10.0),
            (-1.0, 10.0),
            (0.0, 25.0),
            (0.5, 32.5),
            (1.0, 40.0),
            (1.5, 31.0),
            (2.5, 13.0),
            (3.0, 4.0),
            (9.0, 4.0),
        ] {
            let ray = light_at_rest(&into, DVec3::Z, Event::new(tau + 1.0, 2.0 * DVec3::Z));
            let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
            let omega = frequency(moves, ray.k.x);
            for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &ray).radiance) {
                let expected = luminance * unit.at(nm / omega);
                near(value * omega.powi(5), expected, 1e-7 * expected);
            }
        }
    }
}
