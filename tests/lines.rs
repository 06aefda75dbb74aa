//! Spectral lines are carried exactly: light of one wavelength stays light of one wavelength, however it goes.

use crate::support::{
    Body, Dice, Heaven, Lantern, Stage, along, ball, built, diffuse, emission_time, frequency, glowing,
    light_at_rest, light_from, line, mirror, near_vector, pane, plane, square,
};
use glam::DVec3;
use std::f64::consts::PI;
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::fresnel;
use terrell::scene::Scene;
use terrell::spacetime::{Event, Poincare, Rest, SightRay};
use terrell::spectrum::{Index, Source, Spectrum, Wavelengths};

/// The sodium lamp's.
pub(crate) const SODIUM: f64 = 589.0;

/// XYZ of a line as it is seen.
pub(crate) fn xyz(nm: f64, power: f64) -> DVec3 {
    matching(nm) * (power * LUMENS_PER_WATT)
}

/// XYZ of all that comes along a sight ray, at `N` wavelengths.
pub(crate) fn all<const N: usize>(scene: &Scene, ray: &SightRay) -> DVec3 {
    let wavelengths = Wavelengths::<N>::new();
    let light = scene.lit().seen(ray, &wavelengths);
    wavelengths.xyz(&light.radiance) + light.lines
}

/// XYZ of all that comes along a sight ray, which is the same for any number of wavelengths but for `tolerance`.
#[track_caller]
pub(crate) fn any(scene: &Scene, ray: &SightRay, tolerance: f64) -> DVec3 {
    let seen = all::<16>(scene, ray);
    for other in [all::<8>(scene, ray), all::<32>(scene, ray), all::<64>(scene, ray)] {
        near_vector(other, seen, tolerance * seen.length());
    }
    seen
}

fn wide_line(nm: f64, width_nm: f64, power: f64) -> Source {
    Source::new(&Spectrum::Line { centre_nm: nm, width_nm }, power)
}

/// A ball that moves, lit by a lamp that moves, seen from the lab: at each of its points the light has one wavelength,
/// twice shifted.
#[test]
fn moving_body_in_sodium_light_shows_at_each_point_one_colour() {
    let (mut dice, mut seen) = (Dice(589), 0);
    for _ in 0..300 {
        let (a, b) = (dice.between(0.0, 0.6), dice.between(0.0, 0.6));
        let (body_moves, lamp_moves) = (dice.velocity(a), dice.velocity(b));
        let (start, normal) = (dice.direction() * 4.0, dice.direction());
        let into: Poincare<Rest> = Poincare::to_moving(body_moves, Event::ORIGIN);
        let to_eye = (normal + dice.direction() * 0.7).normalize();
        let eye = Event::new(3.0 * to_eye.length(), normal + 3.0 * to_eye);
        let ray = light_at_rest(&into, normal, eye);
        let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
        // In terms of the lab: when and where the light left the ball, and the lamp.
        let left = into.undo(Event::new(0.0, normal));
        let path = |t: f64| start + lamp_moves.beta() * t;
        let sent = emission_time(left, path);
        let way = left.x - path(sent);
        let n = way / way.length();
        let at_body = frequency(body_moves, n) / frequency(lamp_moves, n);
        let cosine = -along(body_moves, n).dot(normal);
        let omega = frequency(body_moves, ray.k.x);
        let r = way.length() * frequency(lamp_moves, n);
        let nm = SODIUM / at_body * omega;
        if cosine < 0.05 || !(430.0..680.0).contains(&nm) {
            continue;
        }
        seen += 1;
        let expected =
            xyz(nm, 5.0 * at_body * at_body * cosine / (r * r) * 0.6 / PI / (omega * omega * omega * omega));
        let scene = |source: Source| {
            let lamp = Lantern::at(0.0, start, source).moving(lamp_moves);
            let body = Body::of(ball(1.0, DVec3::ZERO), diffuse(0.6)).moving(body_moves);
            Stage::of([body]).lit_by([lamp]).scene()
        };
        near_vector(any(&scene(line(SODIUM, 5.0)), &ray, 1e-12), expected, 1e-9 * expected.length());
        let wide = any(&scene(wide_line(SODIUM, 0.1, 5.0)), &ray, 1e-12);
        near_vector(wide, expected, 1e-4 * expected.length());
    }
    assert!(seen > 30, "{seen}");
}

/// A room that shines in sodium light and moves, in a mirror that moves another way.
#[test]
fn line_in_a_moving_mirror_is_shifted_by_the_mirror_too() {
    let (mut dice, mut seen) = (Dice(590), 0);
    for _ in 0..200 {
        let (a, b) = (dice.between(0.0, 0.4), dice.between(0.0, 0.4));
        let (mirror_moves, room_moves) = (dice.velocity(a), dice.velocity(b));
        let (normal, n) = (dice.direction(), dice.direction());
        let ray = light_from(DVec3::ZERO, Event::new(2.0, n * 2.0));
        // The mirror's four-normal N: k - 2 N (k·N)/(N·N), N·N = -1, is the light before it.
        let (u, gamma) = (mirror_moves.proper(), mirror_moves.gamma());
        let (four_t, four_x) = (u.dot(normal), normal + u * (u.dot(normal) / (gamma + 1.0)));
        let product = four_t - n.dot(four_x);
        let (before_t, before_x) = (1.0 + 2.0 * product * four_t, n + four_x * (2.0 * product));
        let omega = room_moves.gamma() * before_t - room_moves.proper().dot(before_x);
        let nm = SODIUM * omega;
        if !(430.0..680.0).contains(&nm) {
            continue;
        }
        seen += 1;
        let scene = |source: Source| {
            let plate = Body::of(plane(DVec3::ZERO, normal), mirror(0.7)).moving(mirror_moves);
            Stage::of([plate]).under(Heaven::uniform(source).moving(room_moves)).scene()
        };
        // Where the mirror is the back of the half space there is nothing but its back, a mirror as well.
        let expected = xyz(nm, 0.7 * 3.0 / (omega * omega * omega * omega));
        near_vector(any(&scene(line(SODIUM, 3.0)), &ray, 1e-12), expected, 1e-9 * expected.length());
        let wide = any(&scene(wide_line(SODIUM, 0.1, 3.0)), &ray, 1e-12);
        near_vector(wide, expected, 1e-4 * expected.length());
    }
    assert!(seen > 30, "{seen}");
}

/// Through a pane the light goes straight on at its own wavelength; what the pane takes is by its index at the wavelength
/// in the pane's own frame.
#[test]
fn line_through_a_moving_pane_is_dimmed_by_the_index_at_its_wavelength_there() {
    let (mut dice, mut seen) = (Dice(591), 0);
    for _ in 0..200 {
        let (a, b) = (dice.between(0.0, 0.7), dice.between(0.0, 0.4));
        let (pane_moves, source_moves) = (dice.velocity(a), dice.velocity(b));
        let (normal, n) = (dice.direction(), dice.direction());
        let ray = light_from(DVec3::ZERO, Event::new(2.0, n * 2.0));
        let omega = frequency(source_moves, n);
        let cosine = along(pane_moves, n).dot(normal).abs();
        let nm = SODIUM * omega;
        if !(400.0..700.0).contains(&nm) || cosine < 0.1 {
            continue;
        }
        seen += 1;
        let in_pane = nm / frequency(pane_moves, n);
        let through = 1.0 - fresnel::dielectric(cosine, Index::SF11.at(in_pane));
        let glow = glowing(line(SODIUM, 2.0));
        // The source passes behind the pane when the light does.
        let target = Body::of(ball(0.3, DVec3::ZERO), glow).at(-3.0, n * -3.0).moving(source_moves);
        let square = built(square());
        let glass = Body::new(&square, pane(Index::SF11)).sized(100.0).facing(normal).moving(pane_moves);
        let scene = Stage::of([glass, target]).scene();
        let expected = xyz(nm, 2.0 * through / (omega * omega * omega * omega));
        near_vector(any(&scene, &ray, 1e-12), expected, 1e-9 * expected.length());
    }
    assert!(seen > 30, "{seen}");
}
