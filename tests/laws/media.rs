//! Moving mirrors, and light in moving media.

use super::{Worst, aside, chapter, seen_by};
use crate::fizeau::paces;
use crate::glass::{missed_delay, turned_by_moving_plates, within_moving_glass};
use crate::support::{
    Body, Dice, Heaven, Stage, ball, beta, black_body, cube, edge, frequency, glass, glowing, is_bright,
    light_from, line, look, mirror, plane, speed, v,
};
use glam::{DAffine3, DQuat, DVec3};
use terrell::color::matching;
use terrell::scene::Scene;
use terrell::spacetime::{Event, SightRay, Velocity};
use terrell::spectrum::{Index, Wavelengths, planck};

chapter! {
    "Mirrors and media":
    receding_mirror_turns_light, "V10", "cos φ″ = [(1+β²) cos φ − 2β]/(1 − 2β cos φ + β²)", "Einstein 1905 §8", 1e-12;
    receding_mirror_shifts_light, "V10", "ν″/ν = (1 − 2β cos φ + β²)/(1 − β²)", "Einstein 1905 §8", 1e-11;
    receding_mirror_is_caught_within_a_cone, "V10", "cos φ″ > −β, where cos φ > β", "Einstein 1905 §8", 1e-11;
    own_light_comes_back_shifted_twice, "V10", "ν″/ν = (1−β)/(1+β) along the normal", "Einstein 1905 §8", 1e-11;
    mirror_that_slides_in_its_plane_is_a_mirror_at_rest, "V10", "φ″ = φ, ν″ = ν", "Einstein 1905 §8", 1e-12;
    mirror_may_move_any_way, "V10", "k″ = k − 2N (k·N)/(N·N), N the four-normal", "Householder's map", 1e-11;
    flowing_water_carries_light_along, "V11", "u = (1/n + β)/(1 + β/n)", "Fizeau 1851", 1e-10;
    dispersion_is_taken_at_the_wavelength_in_the_water, "V11", "the same with the group index at the shifted wavelength", "Fizeau 1851; Laub 1908", 1e-11;
    light_is_late_by_the_group_index, "V11", "(n_g − 1)L after a plate of L, metres", "group velocity", 1e-5;
    light_refracts_in_the_rest_frame_of_the_glass, "V11", "Snell's law there; velocity in the lab by Einstein's sum", "Gjurchinovski & Skeparovski 2007", 5e-6;
    colours_part_by_the_index_at_the_wavelength_in_the_glass, "V11", "the same with n(Dλ) of SF11, and the group's pace", "Snell's law in the rest frame", 5e-6;
    plate_in_motion_does_not_turn_light, "V11", "out parallel to in, radians", "Gjurchinovski & Skeparovski 2007", 2e-7;
    plate_in_motion_does_not_shift_light, "V11", "λ stays: colour of a 589 nm line through it", "Gjurchinovski & Skeparovski 2007", 1e-11;
}

fn turn() -> DQuat {
    DQuat::from_axis_angle(v(6.0, 2.0, -3.0) / 7.0, 1.9)
}

/// A mirror without end whose normal is the (turned) x axis, at x = 0 at time 0.
fn plate(velocity: DVec3) -> Body {
    let moves = Velocity::from_beta(turn() * velocity).unwrap();
    Body::of(plane(DVec3::ZERO, turn() * DVec3::X), mirror(1.0)).moving(moves)
}

/// Light that left the mirror's place at time 0 at φ'' to the normal, arriving 2 m away.
fn leaving(outgoing: f64) -> SightRay {
    let (sin, cos) = libm::sincos(outgoing);
    let n = turn() * v(cos, sin, 0.0);
    light_from(DVec3::ZERO, Event::new(2.0, n * 2.0))
}

/// φ'' of light that meets the mirror at φ.
fn outgoing(b: f64, incidence: f64) -> f64 {
    let cos = libm::cos(incidence);
    libm::acos(((1.0 + b * b) * cos - 2.0 * b) / (1.0 - 2.0 * b * cos + b * b))
}

/// How far the edges of a star of half a degree, seen in a mirror, are from where they should be.
fn missed_edges(plate: &Body, incidence: f64, expected: impl Fn(f64) -> f64) -> f64 {
    let mut worst = Worst::default();
    let (sin, cos) = libm::sincos(incidence);
    let star = Body::of(ball(1e3, DVec3::ZERO), glowing(black_body(5000.0)));
    let star = star.at(0.0, turn() * v(cos, -sin, 0.0) * 1e5);
    let scene = Stage::of([plate.clone(), star]).scene();
    let sees = |angle: f64| is_bright(&scene, &leaving(angle));
    let centre = expected(incidence);
    worst.must(sees(centre));
    for half in [-libm::asin(0.01), libm::asin(0.01)] {
        let rim = expected(incidence + half);
        worst.apart(edge(centre, 2.0 * rim - centre, sees), rim);
    }
    worst.0
}

const CASES: [(f64, f64); 8] =
    [(-0.9, 0.4), (-0.5, 1.0), (-0.1, 0.5), (0.1, 0.5), (0.1, 1.2), (0.3, 0.8), (0.5, 0.5), (0.8, 0.2)];

fn receding_mirror_turns_light() -> f64 {
    let mut worst = Worst::default();
    for (b, incidence) in CASES {
        worst.error(missed_edges(&plate(v(-b, 0.0, 0.0)), incidence, |at| outgoing(b, at)));
    }
    worst.0
}

const KELVIN: f64 = 5000.0;

/// By how much light that was a black body's is not that of another temperature.
fn missed_shift(scene: &Scene, ray: &SightRay, ratio: f64) -> f64 {
    let mut worst = Worst::default();
    for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(look(scene, ray).radiance) {
        worst.part(value, planck(*nm, KELVIN * ratio));
    }
    worst.0
}

fn under_the_sky(bodies: impl IntoIterator<Item = Body>) -> Scene {
    Stage::of(bodies).under(Heaven::uniform(black_body(KELVIN))).scene()
}

fn receding_mirror_shifts_light() -> f64 {
    let mut worst = Worst::default();
    for (b, incidence) in CASES {
        let ratio = (1.0 - 2.0 * b * libm::cos(incidence) + b * b) / (1.0 - b * b);
        let scene = under_the_sky([plate(v(-b, 0.0, 0.0))]);
        worst.error(missed_shift(&scene, &leaving(outgoing(b, incidence)), ratio));
    }
    worst.0
}

/// Light that leaves along with the mirror's own pace along the normal never met it: the mirror is seen this side of that.
fn receding_mirror_is_caught_within_a_cone() -> f64 {
    let mut worst = Worst::default();
    for b in [-0.9, -0.5, -0.1, 0.0, 0.1, 0.5, 0.9] {
        let scene = Stage::of([plate(v(-b, 0.0, 0.0))]).scene();
        let eye = Event::new(0.0, turn() * v(1.0, 0.0, 0.0));
        for around in [0.0, 1.0, 4.0] {
            let shows = |outgoing: f64| {
                let n = aside(turn() * DVec3::X, outgoing, around);
                scene.lit().first(&light_from(eye.x - n, eye)).is_some()
            };
            worst.apart(edge(0.0, std::f64::consts::PI, shows), libm::acos(-b));
        }
        // The last of it had barely caught up: cos φ = β.
        worst.part(outgoing(b, libm::acos(b)), libm::acos(-b));
    }
    worst.0
}

fn own_light_comes_back_shifted_twice() -> f64 {
    let mut worst = Worst::default();
    for b in [-0.8, -0.5, -0.1, 0.1, 0.3, 0.5, 0.8] {
        let scene = under_the_sky([plate(v(-b, 0.0, 0.0))]);
        worst.error(missed_shift(&scene, &leaving(0.0), (1.0 - b) / (1.0 + b)));
    }
    worst.0
}

fn mirror_that_slides_in_its_plane_is_a_mirror_at_rest() -> f64 {
    let mut worst = Worst::default();
    for b in [0.0, 0.3, 0.8, 0.95] {
        let slides = plate(v(0.0, 0.6 * b, 0.8 * b));
        for incidence in [0.2, 0.8, 1.4] {
            worst.error(missed_edges(&slides, incidence, |at| at));
            worst.error(missed_shift(&under_the_sky([slides.clone()]), &leaving(incidence), 1.0));
        }
    }
    worst.0
}

fn mirror_may_move_any_way() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(31));
    for _ in 0..200 {
        let normal = dice.direction();
        let b = dice.between(0.0, 0.9);
        let (moves, n) = (dice.velocity(b), dice.direction());
        let body = Body::of(plane(DVec3::ZERO, normal), mirror(1.0)).moving(moves);
        let ray = light_from(DVec3::ZERO, Event::new(2.0, n * 2.0));
        // N in the lab, N·N = -1; n the light's way after the mirror.
        let (across_t, across) = seen_by(-moves, (0.0, normal));
        let product = across_t - n.dot(across);
        let before = 1.0 + 2.0 * product * across_t;
        // From in front of it only: the light leaves it.
        if -product > 1e-3 {
            worst.error(missed_shift(&under_the_sky([body]), &ray, 1.0 / before));
        }
    }
    worst.0
}

fn flowing_water_carries_light_along() -> f64 {
    let mut worst = Worst::default();
    let cases = [
        (1.5, 0.5),
        (1.5, -0.5),
        (1.333, 0.1),
        (1.333, -0.1),
        (2.4, 0.9),
        (2.4, -0.9),
        (2.4, -0.4),
        // It stands still in the lab.
        (1.5, -1.0 / 1.5),
        (1.1, 0.7),
    ];
    for (n, b) in cases {
        for got in paces(Index::Constant(n), b) {
            worst.apart(got, (1.0 / n + b) / (1.0 + b / n));
        }
    }
    worst.0
}

fn dispersion_is_taken_at_the_wavelength_in_the_water() -> f64 {
    let mut worst = Worst::default();
    for b in [0.1, -0.1, 0.3, -0.3] {
        let omega = frequency(beta(b, 0.0, 0.0), DVec3::X);
        for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(paces(Index::WATER, b)) {
            let n = Index::WATER.group(nm / omega);
            worst.apart(got, (1.0 / n + b) / (1.0 + b / n));
        }
    }
    worst.0
}

fn light_is_late_by_the_group_index() -> f64 {
    missed_delay()
}

/// How far the velocity of light in glass that moves by b is from that of Snell's law in the glass's rest frame.
fn missed_refraction(index: Index, chosen: usize, incidence: f64, b: DVec3) -> f64 {
    let (sin, cos) = libm::sincos(incidence);
    let moves = Velocity::from_beta(b).unwrap();
    let (omega, k) = seen_by(moves, (1.0, v(cos, sin, 0.0)));
    let nm = Wavelengths::<64>::new().nm[chosen] / omega;
    // Along the face sin θ/n; the pace is that of the group.
    let along = v(0.0, k.y, k.z) / (omega * index.at(nm));
    let pace = v((1.0 - along.length_squared()).sqrt(), along.y, along.z) / index.group(nm);
    let (t, way) = seen_by(-moves, (1.0, pace));
    let (took, gone) = within_moving_glass(index, chosen, incidence, b);
    (gone / took - way / t).length()
}

fn light_refracts_in_the_rest_frame_of_the_glass() -> f64 {
    let mut worst = Worst::default();
    let velocities = [
        DVec3::ZERO,
        v(0.1, 0.0, 0.0),
        v(0.5, 0.0, 0.0),
        v(-0.5, 0.0, 0.0),
        v(0.0, 0.1, 0.0),
        v(0.0, 0.5, 0.0),
        v(0.0, 0.9, 0.0),
        v(0.0, -0.5, 0.0),
        v(0.2, 0.3, -0.4),
    ];
    for b in velocities {
        for incidence in [0.1, 30.0_f64.to_radians(), 0.9] {
            worst.error(missed_refraction(Index::Constant(1.5), 0, incidence, b));
        }
    }
    worst.0
}

fn colours_part_by_the_index_at_the_wavelength_in_the_glass() -> f64 {
    let mut worst = Worst::default();
    for b in [v(0.3, 0.0, 0.0), v(-0.4, 0.0, 0.0), v(0.0, 0.5, 0.0), v(-0.2, 0.3, 0.1)] {
        for chosen in [0, 20, 63] {
            worst.error(missed_refraction(Index::SF11, chosen, 0.7, b));
        }
    }
    worst.0
}

fn plate_in_motion_does_not_turn_light() -> f64 {
    turned_by_moving_plates()
}

/// The colour of a yellow line behind a moving plate.
fn plate_in_motion_does_not_shift_light() -> f64 {
    let (mut worst, mut dice, mut seen) = (Worst::default(), Dice(112), 0);
    let slab = crate::support::built(cube());
    let color = matching(589.0) / matching(589.0).length();
    for _ in 0..40 {
        let plate = Body::new(&slab, glass()).stretched(v(0.25, 100.0, 100.0)).filled(Index::BK7);
        let b = dice.between(0.0, 0.8);
        let plate = plate.mapped(DAffine3::from_quat(dice.turn())).moving(speed(b, dice.direction()));
        let n = dice.direction();
        // Ahead only: what the plate throws back, as a moving mirror, is shifted.
        let far = Body::of(ball(10.0, DVec3::ZERO), glowing(line(589.0, 1.0))).at(0.0, n * 1e4);
        let ray = light_from(DVec3::ZERO, Event::new(0.0, n * -10.0));
        let lines = look(&Stage::of([plate, far]).scene(), &ray).lines;
        if lines.length() > 0.0 {
            seen += 1;
            worst.places(lines / lines.length(), color);
        }
    }
    worst.must(seen > 30);
    worst.0
}
