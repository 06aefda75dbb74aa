//! What is infinitely far away, as it is seen from a moving observer and by way of mirrors and glass.
//!
//! A sky is at rest in one frame. With D the frequency seen over that in its frame, a black body of T looks like one of
//! DT; a star's parallel light comes with `E(λ) = D³ E'(Dλ)`, from the aberrated direction.

use crate::support::{
    Body, Dice, Eye, Heaven, Stage, angle, ball, black, black_body, boosted, built, close, cuboid, flat,
    frequency, glass, line, mirror, near, near_vector, pane, plane, speed, square, v,
};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use terrell::color::{LUMENS_PER_WATT, matching, xyz_of};
use terrell::exposure::{Sampling, expose};
use terrell::film::Reconstruction;
use terrell::fresnel;
use terrell::spacetime::{Event, Velocity};
use terrell::spectrum::{Index, Wavelengths, planck};
use terrell::surroundings::Star;
use terrell::texture::{Encoding, Picture, Texels};
use terrell::trace::Cone;

/// Of light that an eye which moves by `eye` sees coming from the direction `n`: the frequency seen over that for someone
/// who moves by `other`, and where this one sees it come from.
fn seen_by(eye: Velocity, other: Velocity, n: DVec3) -> (f64, DVec3) {
    let in_lab = crate::support::along(-eye, -n);
    let doppler = 1.0 / (frequency(-eye, -n) * frequency(other, in_lab));
    (doppler, -crate::support::along(other, in_lab))
}

/// V2: D = 1/(γ(1 - β cosθ')).
#[test]
fn moving_observer_sees_an_even_sky_hotter_ahead_by_the_table() {
    for b in [0.5, 0.8, 0.9, 0.99_f64] {
        let gamma = 1.0 / ((1.0 - b) * (1.0 + b)).sqrt();
        let forward = v(2.0, -1.0, 2.0) / 3.0;
        let eye = Eye::at(3.0, v(1.0, 2.0, 3.0)).moving(speed(b, forward));
        let scene = Stage::of([]).under(Heaven::uniform(black_body(4000.0))).seen_by(&eye);
        for degrees in [0.0, 7.0353, 30.0, 60.0, 90.0, 150.0, 180.0_f64] {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let ray = eye.sight(forward * cos + forward.any_orthonormal_vector() * sin);
            let doppler = 1.0 / (gamma * (1.0 - b * cos));
            let seen = crate::support::look(&scene, &ray);
            for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(seen.radiance) {
                close(value, planck(*nm, 4000.0 * doppler), 1e-9);
            }
        }
    }
}

#[test]
fn sky_and_observer_may_both_move_any_way() {
    let mut dice = Dice(70);
    for _ in 0..200 {
        let (a, b) = (dice.between(0.0, 0.99), dice.between(0.0, 0.99));
        let (sky_moves, eye_moves) = (dice.velocity(a), dice.velocity(b));
        let (eye, n) = (Eye::at(0.0, DVec3::ZERO).moving(eye_moves), dice.direction());
        let (doppler, _) = seen_by(eye_moves, sky_moves, n);
        let sky = Heaven::uniform(black_body(6000.0)).moving(sky_moves);
        let seen = crate::support::look(&Stage::of([]).under(sky).seen_by(&eye), &eye.sight(n));
        for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(seen.radiance) {
            let expected = planck(*nm, 6000.0 * doppler);
            near(value, expected, 1e-8 * expected);
        }
        // A line of the sky: at λ/D, D⁴ of its power.
        let sky = Heaven::uniform(line(600.0, 2.0)).moving(sky_moves);
        let seen = crate::support::look(&Stage::of([]).under(sky).seen_by(&eye), &eye.sight(n));
        let expected = matching(600.0 / doppler) * (LUMENS_PER_WATT * 2.0 * doppler.powi(4));
        near_vector(seen.lines, expected, 1e-8 * expected.length());
    }
}

/// A picture of noise: each texel lies where aberration puts it.
#[test]
fn picture_of_the_sky_is_seen_at_the_aberrated_directions() {
    let mut dice = Dice(71);
    let (width, height) = (64, 32);
    let texels =
        (0..width * height).map(|_| [dice.part() as f32, dice.part() as f32, dice.part() as f32, 1.0]);
    let texels = Texels::Float(texels.collect());
    let picture = Arc::new(Picture::new(width, height, texels, Encoding::Linear));
    for _ in 0..100 {
        let (a, b) = (dice.between(0.0, 0.9), dice.between(0.0, 0.9));
        let (sky_moves, eye_moves) = (dice.velocity(a), dice.velocity(b));
        let sky = Heaven::picture(picture.clone(), 100.0).turned(dice.turn()).moving(sky_moves);
        let (eye, n) = (Eye::at(0.0, DVec3::ZERO).moving(eye_moves), dice.direction());
        let (doppler, d) = seen_by(eye_moves, sky_moves, n);
        let nm = Wavelengths::<64>::new().nm.map(|nm| nm * doppler);
        let there = sky.sky().sky.radiance(d, (0.0, 0.0), &nm);
        let seen = crate::support::look(&Stage::of([]).under(sky).seen_by(&eye), &eye.sight(n));
        for (value, expected) in seen.radiance.iter().zip(there) {
            close(*value, expected * doppler.powi(5), 1e-4);
        }
    }
}

/// A star's light in a picture at one wavelength after another: its irradiance, and the direction of its middle.
fn gathered(stage: &Stage, eye: &Eye, toward: DVec3) -> ([f64; 16], DVec3) {
    let eye = eye.toward(toward).wide(4.0);
    let scene = stage.seen_by(&eye);
    let (size, fine) = (24_u32, 4);
    let view = scene.observer.view(0.0, size, size);
    let (lit, wavelengths) = (scene.lit(), Wavelengths::<16>::new());
    let (mut sum, mut middle) = ([0.0; 16], DVec3::ZERO);
    let width = 2.0 * libm::tan(2.0_f64.to_radians()) / f64::from(size * fine);
    for i in 0..size * fine * size * fine {
        let at = DVec2::new(f64::from(i % (size * fine)) + 0.5, f64::from(i / (size * fine)) + 0.5);
        let at = at / f64::from(fine);
        let (ray, cone) = view.sight(at, 1.0);
        let light = lit.seen_within(&ray, cone, &wavelengths);
        let cosine = -view.direction(at).z;
        let solid = width * width * cosine * cosine * cosine;
        for (sum, value) in sum.iter_mut().zip(light.radiance) {
            *sum += value * solid;
        }
        middle += view.direction(at) * (light.radiance[8] * solid);
    }
    // From the camera's axes to those that the observer carries.
    let turn = terrell::spacetime::looking_along(toward, eye.up);
    (sum, turn * middle.normalize_or(DVec3::ZERO))
}

/// The irradiance of a star at rest, at each wavelength.
fn irradiance(star: &Star, nm: f64) -> f64 {
    planck(nm, star.kelvin) * star.illuminance / xyz_of(|nm| planck(nm, star.kelvin)).y
}

#[track_caller]
fn has_the_light_of(stage: &Stage, eye: &Eye, n: DVec3, star: &Star, (doppler, part): (f64, f64)) {
    let (got, middle) = gathered(stage, eye, n);
    for (nm, got) in Wavelengths::<16>::new().nm.iter().zip(got) {
        close(got, part * doppler.powi(3) * irradiance(star, nm * doppler), 0.01);
    }
    // In the middle of the picture, to a tenth of a pixel.
    assert!(angle(middle, n) < 0.1 * 4.0_f64.to_radians() / 24.0, "{middle} for {n}");
}

/// Where an observer sees a star of a sky, and its D.
fn place_of(star: &Star, sky: &Heaven, eye: Velocity) -> (DVec3, f64) {
    let in_lab = sky.seen_from_lab(star.direction);
    let n = -crate::support::along(eye, -in_lab);
    (n, seen_by(eye, sky.velocity, n).0)
}

#[test]
fn all_light_of_a_star_is_in_the_picture_where_aberration_puts_it() {
    let mut dice = Dice(72);
    for b in [0.0, 0.3, 0.6, 0.9] {
        for _ in 0..4 {
            let star = Star { direction: dice.direction(), kelvin: 6000.0, illuminance: 0.1 };
            let sky = Heaven::stars([star]);
            let eye = Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(b));
            let (n, doppler) = place_of(&star, &sky, eye.velocity);
            // V1, with cos from the velocity.
            if b > 0.0 {
                let forward = eye.velocity.beta() / b;
                let (seen, there) = (n.dot(forward), star.direction.dot(forward));
                near(seen, (there + b) / (1.0 + b * there), 1e-12);
                close(doppler, 1.0 / (eye.velocity.gamma() * (1.0 - b * seen)), 1e-9);
            }
            has_the_light_of(&Stage::of([]).under(sky), &eye, n, &star, (doppler, 1.0));
        }
    }
}

#[test]
fn stars_of_a_sky_that_moves_are_those_seen_by_who_moves_the_other_way() {
    let mut dice = Dice(73);
    for _ in 0..6 {
        let star = Star { direction: dice.direction(), kelvin: 4000.0, illuminance: 0.1 };
        let sky = Heaven::stars([star]).moving(dice.velocity(0.7));
        let eye = Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(0.5));
        let (n, doppler) = place_of(&star, &sky, eye.velocity);
        has_the_light_of(&Stage::of([]).under(sky), &eye, n, &star, (doppler, 1.0));
    }
}

/// In the film's own picture, with its filter: XYZ summed over pixels.
#[test]
fn developed_picture_holds_all_light_of_a_star() {
    let mut dice = Dice(74);
    let (size, field) = (32_u32, 50.0_f64);
    for samples in [1, 16] {
        for b in [0.0, 0.9] {
            let star = Star { direction: dice.direction(), kelvin: 6000.0, illuminance: 0.1 };
            let sky = Heaven::stars([star]);
            let eye = Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(b));
            let (n, doppler) = place_of(&star, &sky, eye.velocity);
            // Off the middle, where pixels are smaller.
            let aside = (n + n.any_orthonormal_vector() * 0.3).normalize();
            let eye = eye.toward(aside).wide(field);
            let scene = Stage::of([]).under(sky).seen_by(&eye);
            let view = scene.observer.view(0.0, size, size);
            let sampling = Sampling {
                width: size,
                height: size,
                samples,
                reconstruction: Reconstruction::Gaussian,
                wavelengths: 64,
            };
            let width = 2.0 * libm::tan(0.5 * field.to_radians()) / f64::from(size);
            let sum: f64 = (0..)
                .zip(&expose(&scene, &view, &sampling).xyz)
                .map(|(i, xyz)| {
                    let cosine = -view.direction(crate::support::pixel_centre(i, size)).z;
                    f64::from(xyz[1]) * width * width * cosine * cosine * cosine
                })
                .sum();
            let expected = doppler.powi(3) * xyz_of(|nm| irradiance(&star, nm * doppler)).y;
            close(sum, expected, if samples == 1 { 0.03 } else { 0.01 });
        }
    }
}

/// By way of a flat mirror that moves: the frequency changes twice, and parallel light stays parallel.
#[test]
fn stars_in_a_flat_mirror_have_all_their_light() {
    let mut dice = Dice(75);
    let mut seen = 0;
    while seen < 8 {
        let b = dice.between(0.0, 0.6);
        let (mirror_moves, eye_moves) = (dice.velocity(b), dice.velocity(0.4));
        let (normal, n) = (dice.direction(), dice.direction());
        // What arrives at the mirror to go to the eye: by the map of the mirror.
        let in_lab = crate::support::along(-eye_moves, -n);
        let (u, gamma) = (mirror_moves.proper(), mirror_moves.gamma());
        let (four_t, four_x) = (u.dot(normal), normal + u * (u.dot(normal) / (gamma + 1.0)));
        let product = four_t - in_lab.dot(four_x);
        if product > -0.2 {
            continue; // From behind, or nearly so.
        }
        seen += 1;
        let before = 1.0 + 2.0 * product * four_t;
        let way = (in_lab + four_x * (2.0 * product)) / before;
        let star = Star { direction: -way, kelvin: 5000.0, illuminance: 0.1 };
        let plate = Body::of(plane(DVec3::ZERO, normal), mirror(0.8)).moving(mirror_moves);
        let eye = Eye::at(2.0, in_lab * 2.0).moving(eye_moves);
        let doppler = 1.0 / (frequency(-eye_moves, -n) * before);
        let stage = Stage::of([plate]).under(Heaven::stars([star]));
        has_the_light_of(&stage, &eye, n, &star, (doppler, 0.8));
    }
}

#[test]
fn stars_behind_thin_and_thick_panes_have_what_these_let_through() {
    let mut dice = Dice(76);
    let (plain, hardly) = (Index::Constant(1.5), Index::cauchy(1.5, 1e-9, 0.0).unwrap());
    let kinds = [
        (true, 0.0, plain),
        (true, 0.7, plain),
        (false, 0.0, plain),
        (false, 0.4, plain),
        (false, 0.4, hardly),
    ];
    for (thin, b, index) in kinds {
        let (moves, eye_moves, n) = (dice.velocity(b), dice.velocity(0.3), DVec3::NEG_Z);
        let in_lab = crate::support::along(-eye_moves, -n);
        let normal = v(0.2, 0.1, 1.0).normalize();
        let cosine = crate::support::along(moves, in_lab).dot(normal).abs();
        let r = fresnel::dielectric(cosine, 1.5);
        let place = -in_lab * 5.0;
        let (body, part) = if thin {
            let body = Body::new(&built(square()), pane(index)).sized(60.0).facing(normal);
            (body, 1.0 - r)
        } else {
            let plate = cuboid(v(-60.0, -60.0, -0.05), v(60.0, 60.0, 0.05));
            let body = Body::of(plate, glass()).filled(index).facing(normal);
            (body, (1.0 - r) / (1.0 + r))
        };
        let star = Star { direction: -in_lab, kelvin: 5000.0, illuminance: 0.1 };
        let mut stage = Stage::of([body.at(-5.0, place).moving(moves)]).under(Heaven::stars([star]));
        stage.depth = 12;
        let eye = Eye::at(0.0, DVec3::ZERO).moving(eye_moves);
        let doppler = 1.0 / frequency(-eye_moves, -n);
        has_the_light_of(&stage, &eye, n, &star, (doppler, part));
    }
}

#[test]
fn bodies_hide_the_stars_behind_them() {
    let mut dice = Dice(77);
    for _ in 0..20 {
        let star = Star { direction: dice.direction(), kelvin: 6000.0, illuminance: 0.1 };
        let eye = Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(0.6));
        let (n, _) = place_of(&star, &Heaven::stars([star]), eye.velocity);
        let ray = eye.sight(n);
        let moves = dice.velocity(0.8);
        let met = ray.at(4.0);
        for (off, hidden) in [(0.0, true), (3.0, false)] {
            let across = (ray.k.x / ray.k.t).normalize().any_orthonormal_vector() * off;
            let body = Body::of(ball(1.0, DVec3::ZERO), black()).at(met.t, met.x + across).moving(moves);
            let scene = Stage::of([body]).under(Heaven::stars([star])).seen_by(&eye);
            let cone = Cone { sample: 1e-3, pixel: 1e-3, phase: 0.0 };
            let light = scene.lit().seen_within(&ray, cone, &Wavelengths::<8>::new());
            assert_eq!(light.radiance[3] == 0.0, hidden);
        }
    }
}

/// Whether stars are brought into the new lab's view as they should be: two ways to the same picture.
#[test]
fn boosting_a_sky_and_its_observer_changes_nothing() {
    let mut dice = Dice(78);
    for _ in 0..30 {
        let star = Star { direction: dice.direction(), kelvin: 6000.0, illuminance: 0.1 };
        let sky = Heaven::stars([star]).moving(dice.velocity(0.5));
        let stage = Stage::of([]).under(sky.clone());
        let eye = Eye { rotation: dice.turn(), ..Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(0.6)) };
        let by = dice.velocity(0.9);
        let (n, _) = place_of(&star, &sky, eye.velocity);
        let cone = Cone { sample: 1e-2, pixel: 1e-2, phase: 0.0 };
        // In the axes that the observer carries, which both have.
        let n = (eye.rotation.inverse() * n + v(0.004, -0.003, 0.001)).normalize();
        let look = |stage: &Stage, eye: &Eye| {
            stage.seen_by(eye).lit().seen_within(&eye.sight(n), cone, &Wavelengths::<16>::new()).radiance
        };
        let (a, b) = (look(&stage, &eye), look(&boosted::stage(by, &stage), &boosted::eye(by, &eye)));
        for (a, b) in a.iter().zip(b) {
            close(b, *a, 1e-8);
            assert!(*a > 0.0);
        }
    }
}

/// An event beyond which nothing is: the eye within a ball that hides all.
#[test]
fn nothing_of_the_sky_is_seen_from_within_a_dark_ball() {
    let shell = Body::of(ball(2.0, DVec3::ZERO), black());
    let scene = Stage::of([shell]).under(Heaven::uniform(flat(1.0))).scene();
    let mut dice = Dice(79);
    for _ in 0..20 {
        let ray = crate::support::light_from(dice.direction(), Event::ORIGIN);
        near(crate::support::look(&scene, &ray).radiance[0], 0.0, 0.0);
    }
}
