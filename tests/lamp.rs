//! Light of moving lamps on moving surfaces.
//!
//! ~~~text
//! E(λ) = D³ I(Dλ) cosθ/r'²        all wavelengths together D² I cosθ/r'²
//! ~~~
//!
//! D: frequency at the surface over that at the lamp; r': the light's way in the lamp's rest frame; θ in the
//! surface's. Not five powers but three: a point has no solid angle to aberrate.

use crate::support::{
    Body, Dice, Eye, Lantern, Stage, angle, beta, black_body, boosted, built, close, diffuse, edge,
    emission_time, flat, light_at_rest, light_to, line, look, near, near_vector, speed, square, v,
};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::lamp::Beam;
use terrell::scene::Scene;
use terrell::spacetime::{Boost, Event, Lab, Poincare, SightRay, Velocity};
use terrell::spectrum::{Source, Wavelengths, planck};

/// A turn, so that no axis is special.
fn turn() -> DQuat {
    DQuat::from_axis_angle(v(-2.0, 1.0, 2.0) / 3.0, 1.1)
}

/// A white patch at the origin that faces `normal`.
fn patch(normal: DVec3) -> Body {
    Body::new(&built(square()), diffuse(1.0)).sized(0.01).facing(normal)
}

/// The light that leaves the origin at `t` at a slant to `normal`.
fn leaving(t: f64, normal: DVec3) -> SightRay {
    light_to(normal * 2.0 + normal.any_orthonormal_vector() * 0.7, Event::new(t, DVec3::ZERO))
}

/// The irradiance at each of 64 wavelengths, read from the light of a white patch: E = π L.
fn irradiance(scene: &Scene, ray: &SightRay) -> [f64; 64] {
    look(scene, ray).radiance.map(|radiance| radiance * PI)
}

fn irradiance_of_line(scene: &Scene, ray: &SightRay) -> DVec3 {
    look(scene, ray).lines * PI
}

/// Lamp x = 0.6 t, y = 3; the patch at the origin faces the light.
#[test]
fn moving_lamp_gives_the_irradiance_of_the_table() {
    let path = |t: f64| turn() * v(0.6 * t, 3.0, 0.0);
    for (at, r, doppler, r_rest, all) in
        [(0.0, 3.75, 1.25, 3.0, 0.173_611_1), (3.0, 3.0, 0.8, 3.75, 0.045_511_1)]
    {
        let emitted = emission_time(Event::new(at, DVec3::ZERO), path);
        near(at - emitted, r, 1e-12);
        let facing = path(emitted) / r;
        let scene = |source: Source| {
            let lamp = Lantern::at(0.0, path(0.0), source).moving(speed(0.6, turn() * DVec3::X));
            Stage::of([patch(facing)]).lit_by([lamp]).scene()
        };
        // A flat spectrum: D³ I/r'².
        for value in irradiance(&scene(flat(7.0)), &leaving(at, facing)) {
            close(value, 7.0 * doppler * doppler * doppler / (r_rest * r_rest), 1e-11);
        }
        // A line: all wavelengths together, at λ/D.
        let nm: f64 = 560.0;
        let lines = irradiance_of_line(&scene(line(nm, 1.0)), &leaving(at, facing));
        near_vector(lines, matching(nm / doppler) * (LUMENS_PER_WATT * all), 2e-6 * lines.length());
        // A black body: that of temperature DT, as wide as r says: D⁵ I(Dλ)/r².
        let black = irradiance(&scene(black_body(4000.0)), &leaving(at, facing));
        for (value, nm) in black.iter().zip(Wavelengths::<64>::new().nm) {
            close(*value, planck(nm, 4000.0 * doppler) / (r * r), 1e-10);
        }
    }
}

/// E in the terms of the lab alone: D and the cosine from velocities and the way of the light.
#[test]
fn both_lamp_and_surface_may_move_any_way() {
    let mut dice = Dice(99);
    let mut lit = 0;
    for _ in 0..400 {
        let lamp_moves = {
            let b = dice.between(0.0, 0.99);
            dice.velocity(b)
        };
        let patch_moves = {
            let b = dice.between(0.0, 0.99);
            dice.velocity(b)
        };
        let (start, normal) = (dice.in_cube() * 5.0, dice.direction());
        let path = |t: f64| start + lamp_moves.beta() * t;
        // The patch's centre passes the lab's origin at zero, and the light leaves there.
        let emitted = emission_time(Event::ORIGIN, path);
        let way = -path(emitted);
        let n = way / way.length();
        let doppler = frequency(patch_moves, n) / frequency(lamp_moves, n);
        let r_rest = way.length() * frequency(lamp_moves, n);
        // Aberration of the light's way into the patch's rest frame.
        let (u, gamma) = (patch_moves.proper(), patch_moves.gamma());
        let n_rest = (n + u * (u.dot(n) / (gamma + 1.0) - 1.0)) / frequency(patch_moves, n);
        let cosine = -n_rest.dot(normal);
        let body = patch(normal).moving(patch_moves);
        let stage = Stage::of([body]).lit_by([Lantern::at(0.0, start, flat(2.0)).moving(lamp_moves)]);
        // Watched from in front of it, in its own rest frame.
        let to_eye = normal + normal.any_orthonormal_vector() * 0.3;
        let into = Poincare::to_moving(patch_moves, Event::ORIGIN);
        let ray = light_at_rest(&into, DVec3::ZERO, Event::new(to_eye.length(), to_eye));
        let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
        let omega = frequency(patch_moves, ray.k.x);
        let expected = if cosine > 0.0 { 2.0 * doppler.powi(3) * cosine / (r_rest * r_rest) } else { 0.0 };
        lit += u32::from(cosine > 0.0);
        for value in irradiance(&stage.scene(), &ray) {
            // What the lab sees of the patch's own radiance: ω⁻⁵.
            near(value * omega.powi(5), expected, 1e-9 * expected);
        }
        // And from another frame.
        let by = dice.velocity(0.9);
        let moved = boosted::stage(by, &stage);
        let event = boosted::event(by, ray.event);
        let k = Boost::<Lab, Lab>::to_moving(by) * ray.k;
        for value in irradiance(&moved.scene(), &SightRay { event, k }) {
            near(value * omega.powi(5), expected, 1e-9 * expected);
        }
    }
    assert!((100..300).contains(&lit));
}

/// Of light that moves along `n` in the lab with frequency 1 there, for someone who moves.
fn frequency(velocity: Velocity, n: DVec3) -> f64 {
    velocity.gamma() * (1.0 - velocity.beta().dot(n))
}

/// cos: in the surface's rest frame, not in the lab's.
#[test]
fn light_square_to_the_motion_meets_a_fast_floor_from_ahead() {
    // The floor y = 0 moves along x; in the lab the light falls straight down, in the floor's frame at cosθ' = 1/γ.
    let moves = speed(0.8, DVec3::X);
    let sun = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: DVec3::NEG_Y });
    let floor = Body::new(&built(square()), diffuse(1.0)).facing(DVec3::Y).moving(moves);
    let scene = Stage::of([floor]).lit_by([sun]).scene();
    let ray = light_to(v(0.0, 1.0, 0.2), Event::ORIGIN);
    let omega = frequency(moves, ray.k.x);
    let doppler = moves.gamma();
    for value in irradiance(&scene, &ray) {
        close(value * omega.powi(5), doppler.powi(3) / moves.gamma(), 1e-12);
    }
}

/// Parallel light of a sun that moves: D³ and the aberrated axis.
#[test]
fn moving_sun_shines_with_the_third_power() {
    let mut dice = Dice(4);
    for _ in 0..50 {
        let b = dice.between(0.0, 0.95);
        let moves = dice.velocity(b);
        let (axis, normal) = (dice.direction(), dice.direction());
        let sun = Lantern::at(0.0, DVec3::ZERO, black_body(5000.0)).with(Beam::Sun { axis }).moving(moves);
        let scene = Stage::of([patch(normal)]).lit_by([sun]).scene();
        // Where the sun's light goes in the lab, and its D there.
        let doppler = moves.gamma() * (1.0 + moves.beta().dot(axis));
        let (u, gamma) = (moves.proper(), moves.gamma());
        let way = (axis + u * (u.dot(axis) / (gamma + 1.0) + 1.0)) / doppler;
        let cosine = (-way.dot(normal)).max(0.0);
        let got = irradiance(&scene, &leaving(0.0, normal));
        for (value, nm) in got.iter().zip(Wavelengths::<64>::new().nm) {
            let expected = doppler.powi(3) * planck(nm * doppler, 5000.0) * cosine;
            near(*value, expected, 1e-10 / doppler * expected);
        }
    }
}

/// The cone belongs to the lamp: in the lab a fast lamp's beam is narrow.
#[test]
fn spot_shines_into_a_cone_of_its_own_rest_frame() {
    let half: f64 = 1.0;
    for b in [-0.3, 0.0, 0.6, 0.95] {
        let along = turn() * DVec3::NEG_Z;
        let moves = Velocity::from_beta(along * b).unwrap();
        let cos = libm::cos(half);
        let beam = Beam::Spot { place: DVec3::ZERO, axis: along, cos_inner: cos + 1e-9, cos_outer: cos };
        let lamp = Lantern::at(0.0, turn() * v(0.0, 0.0, 2.0), flat(1.0)).moving(moves).with(beam);
        // A floor at z = 0 that the beam meets; the place x of the floor is lit at the floor's time 5.
        let floor = Body::new(&built(square()), diffuse(1.0)).sized(100.0);
        let floor = floor.mapped(glam::DAffine3::from_quat(turn()));
        let scene = Stage::of([floor]).lit_by([lamp]).scene();
        let path = |t: f64| turn() * v(0.0, 0.0, 2.0 - b * t);
        let floor_at = |x: f64| Event::new(1.5, turn() * v(x * 0.6, x * 0.8, 0.0));
        let lit = |x: f64| {
            let ray = light_to(floor_at(x).x + turn() * v(0.1, 0.0, 0.3), floor_at(x));
            look(&scene, &ray).radiance[0] > 0.0
        };
        let border = floor_at(edge(0.0, 90.0, lit));
        let theta = angle(border.x - path(emission_time(border, path)), along);
        let in_lamp = libm::acos((libm::cos(theta) - b) / (1.0 - b * libm::cos(theta)));
        near(in_lamp, half, 1e-7);
    }
}

#[test]
fn spot_fades_from_the_inner_to_the_outer_angle() {
    let beam = Beam::Spot { place: DVec3::ZERO, axis: DVec3::NEG_Z, cos_inner: 0.9, cos_outer: 0.5 };
    let lamp = Lantern::at(0.0, v(0.0, 0.0, 1.0), flat(1.0)).with(beam);
    let floor = Body::new(&built(square()), diffuse(1.0)).sized(10.0);
    let scene = Stage::of([floor]).lit_by([lamp]).scene();
    for (cos, part) in [(0.99, 1.0), (0.9, 1.0), (0.7, 0.25), (0.6, 0.0625), (0.5, 0.0), (0.3, 0.0)] {
        let x = (1.0 / (cos * cos) - 1.0_f64).sqrt();
        let ray = light_to(v(x * 0.6, x * 0.8, 0.2), Event::new(0.0, v(x * 0.6, x * 0.8, 0.0)));
        for value in irradiance(&scene, &ray) {
            // cos/r² = cos³ on a floor at distance 1.
            near(value, part * cos * cos * cos, 1e-9);
        }
    }
}

#[test]
fn lamps_add() {
    let lamps = [
        Lantern::at(0.0, v(1.0, 2.0, 3.0), black_body(3000.0)).moving(beta(0.5, 0.1, 0.0)),
        Lantern::at(1.0, v(-1.0, 0.5, 2.0), flat(1e4)).moving(beta(-0.2, 0.6, 0.3)),
        Lantern::at(0.0, DVec3::ZERO, line(350.0, 1e5)).with(Beam::Sun { axis: v(0.6, 0.0, -0.8) }),
    ];
    let normal = v(0.1, 0.2, 1.0) / v(0.1, 0.2, 1.0).length();
    let stage = Stage::of([patch(normal).moving(beta(0.0, 0.3, -0.4))]);
    let ray = light_to(v(0.2, 0.3, 1.0), Event::ORIGIN);
    let apart = lamps.clone().map(|lamp| look(&stage.clone().lit_by([lamp]).scene(), &ray));
    let together = look(&stage.lit_by(lamps).scene(), &ray);
    for (i, all) in together.radiance.iter().enumerate() {
        close(*all, apart.iter().map(|light| light.radiance[i]).sum(), 1e-14);
    }
    let lines: DVec3 = apart.iter().map(|light| light.lines).sum();
    near_vector(together.lines, lines, 1e-12 * lines.length());
    assert!(lines.length() > 0.0 && apart[0].radiance[0] > 0.0 && apart[1].radiance[0] > 0.0);
}

/// A coloured line on a moving patch, then to a moving observer: two shifts, each in its own frame.
#[test]
fn line_is_shifted_at_the_surface_and_again_on_the_way_to_the_eye() {
    let moves = beta(0.0, 0.0, -0.2);
    let lamp = Lantern::at(0.0, v(0.0, 0.0, 4.0), line(340.0, 1.0));
    let stage = Stage::of([patch(DVec3::Z).moving(moves)]).lit_by([lamp]);
    // The patch recedes from the lamp above it, and from the eye above it.
    let eye = Eye::at(3.0, v(0.0, 0.0, 3.0)).moving(beta(0.0, 0.0, 0.1));
    let step = |b: f64| ((1.0 - b) / (1.0 + b)).sqrt();
    let (to_patch, to_eye) = (step(0.2), step(0.2) * step(0.1));
    let light = look(&stage.seen_by(&eye), &eye.sight(DVec3::NEG_Z));
    // r' = r = 4 in the lamp's frame; D² at the patch, D⁴ for the eye.
    let expected = matching(340.0 / (to_patch * to_eye)) * LUMENS_PER_WATT;
    let expected = expected * (to_patch.powi(2) / 16.0 / PI * to_eye.powi(4));
    assert!(expected.y > 0.0);
    near_vector(light.lines, expected, 1e-10 * expected.length());
}
