//! Light of moving lamps on moving surfaces, and the shadows in it.

use super::brightness::mean_over_the_sphere;
use super::two_cubes::{
    light_passes_two_cubes_where_they_are_then, shadows_of_two_cubes_are_seen_later_still,
};
use super::{FORWARD, Worst, chapter};
use crate::support::{
    Body, Dice, Lantern, Stage, along, black, black_body, boosted, built, diffuse, edge, emission_time, flat,
    frequency, light_at_rest, light_to, line, look, speed, square, v,
};
use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::PI;
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::lamp::Beam;
use terrell::scene::Scene;
use terrell::spacetime::{Boost, Event, Lab, Poincare, SightRay, Velocity};
use terrell::spectrum::{Source, Wavelengths, planck};

chapter! {
    "Lamps and shadows":
    irradiance_goes_with_the_third_power_and_the_distance_at_the_lamp, "V12", "E(λ) = D³ I′(Dλ) cos θ/r′²", "invariance of L_ν/ν³, r′ = r/D", 1e-11;
    irradiance_goes_with_the_fifth_power_and_the_distance_at_the_surface, "V12", "E(λ) = D⁵ I′(Dλ)/r²: a black body of DT", "invariance of L_ν/ν³", 1e-11;
    whole_irradiance_goes_with_the_square, "V12", "∫E dλ = D² ∫I′ dλ cos θ/r′²", "invariance of L_ν/ν³", 1e-11;
    passing_lamp_gives_the_light_of_the_table, "V12", "D⁴I/r²: 0.1736111 and 0.0455111 of I (seven digits)", "x = 0.6 t, y = 3", 2e-6;
    cosine_is_that_in_the_rest_frame_of_the_surface, "V12", "light square to the motion arrives at cos θ = 1/γ", "aberration", 1e-12;
    sun_in_motion_shines_with_the_third_power, "V12", "E(λ) = D³ E′(Dλ) cos θ", "invariance of L_ν/ν³", 1e-12;
    photons_of_a_moving_lamp_are_conserved, "V12", "mean of E r²/(D² I′) over the directions of the lab = 1", "∮D² dΩ = 4π: no other power than D³ does it", 1e-12;
    irradiance_is_the_same_from_every_frame, "V12", "boosted lamp, patch and ray", "relativity", 1e-10;
    shadow_edge_lags, "V13", "0.6 X = β[t − √((0.4 X)² + 4)] on the floor", "light's way past the edge", 1e-8;
    shadow_edge_is_seen_later_still, "V13", "the same with t = tₒ − |x − X|", "V7 and V13", 1e-9;
    light_passes_two_cubes_where_they_are_then, "V13", "tₑ = t − γ²[√((R·β)² + R²/γ²) − R·β], R = p(t) − X; straight on past each cube", "V7 for the lamp; slabs", 1e-8;
    shadows_of_two_cubes_are_seen_later_still, "V13", "the same with t = tₒ − |x − X|; pixels of a picture 1000 wide", "V7 and V13", 1e-7;
}

/// Chance: a moving lamp, a patch that moves through the origin, and its light in the direction of the eye.
struct Meeting {
    start: DVec3,
    lamp: Velocity,
    patch: Velocity,
    normal: DVec3,
    ray: SightRay,
    /// D, r' and r, cosine, and the frequency at the patch over what the lab sees.
    doppler: f64,
    distances: (f64, f64),
    cosine: f64,
    omega: f64,
}

impl Meeting {
    fn stage(&self, source: Source) -> Stage {
        let body =
            Body::new(&built(square()), diffuse(1.0)).sized(0.01).facing(self.normal).moving(self.patch);
        Stage::of([body]).lit_by([Lantern::at(0.0, self.start, source).moving(self.lamp)])
    }
}

/// Those meetings in which the lamp is before the patch.
fn meetings(count: u32) -> Vec<Meeting> {
    let mut dice = Dice(99);
    let meeting = |_| {
        let (a, b) = (dice.between(0.0, 0.99), dice.between(0.0, 0.95));
        let (lamp, patch) = (dice.velocity(a), dice.velocity(b));
        let (start, normal) = (dice.in_cube() * 5.0, dice.direction());
        // The light that arrives at the origin at zero.
        let path = |t: f64| start + lamp.beta() * t;
        let way = -path(emission_time(Event::ORIGIN, path));
        let n = way / way.length();
        let to_eye = normal + normal.any_orthonormal_vector() * 0.3;
        let into = Poincare::to_moving(patch, Event::ORIGIN);
        let ray = light_at_rest(&into, DVec3::ZERO, Event::new(to_eye.length(), to_eye));
        let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
        Meeting {
            start,
            lamp,
            patch,
            normal,
            ray,
            doppler: frequency(patch, n) / frequency(lamp, n),
            distances: (way.length() * frequency(lamp, n), way.length() * frequency(patch, n)),
            cosine: -along(patch, n).dot(normal),
            omega: frequency(patch, ray.k.x),
        }
    };
    (0..count).map(meeting).filter(|meeting| meeting.cosine > 0.01).collect()
}

/// E of a white patch, in its own rest frame: π L, from what the lab sees at each wavelength.
fn irradiance(scene: &Scene, meeting: &Meeting) -> ([f64; 64], [f64; 64]) {
    let omega = meeting.omega;
    let light = look(scene, &meeting.ray).radiance;
    (Wavelengths::<64>::new().nm.map(|nm| nm / omega), light.map(|value| value * PI * omega.powi(5)))
}

fn irradiance_goes_with_the_third_power_and_the_distance_at_the_lamp() -> f64 {
    let mut worst = Worst::default();
    for meeting in meetings(400) {
        let (_, got) = irradiance(&meeting.stage(flat(2.0)).scene(), &meeting);
        let expected = 2.0 * meeting.doppler.powi(3) * meeting.cosine / meeting.distances.0.powi(2);
        got.iter().for_each(|got| worst.part(*got, expected));
    }
    worst.0
}

fn irradiance_goes_with_the_fifth_power_and_the_distance_at_the_surface() -> f64 {
    let mut worst = Worst::default();
    for meeting in meetings(400) {
        let (nm, got) = irradiance(&meeting.stage(black_body(4000.0)).scene(), &meeting);
        for (nm, got) in nm.iter().zip(got) {
            // r: in the frame in which E is told, that of the patch.
            let expected =
                planck(*nm, 4000.0 * meeting.doppler) * meeting.cosine / meeting.distances.1.powi(2);
            if expected > 1e-30 {
                worst.part(got, expected);
            }
        }
    }
    worst.0
}

fn whole_irradiance_goes_with_the_square() -> f64 {
    let mut worst = Worst::default();
    for meeting in meetings(400) {
        // A line that the lab sees at 550 nm.
        let scene = meeting.stage(line(550.0 * meeting.doppler / meeting.omega, 1.0)).scene();
        let expected = meeting.doppler.powi(2) * meeting.cosine / meeting.distances.0.powi(2);
        let in_lab = expected / PI / meeting.omega.powi(4) * LUMENS_PER_WATT;
        worst.part_of_vector(look(&scene, &meeting.ray).lines, matching(550.0) * in_lab);
    }
    worst.0
}

fn turn() -> DQuat {
    DQuat::from_axis_angle(v(-2.0, 1.0, 2.0) / 3.0, 1.1)
}

fn passing_lamp_gives_the_light_of_the_table() -> f64 {
    let mut worst = Worst::default();
    let path = |t: f64| turn() * v(0.6 * t, 3.0, 0.0);
    for (at, doppler, all) in [(0.0, 1.25, 0.173_611_1), (3.0, 0.8, 0.045_511_1)] {
        let facing = path(emission_time(Event::new(at, DVec3::ZERO), path));
        let lamp = Lantern::at(0.0, path(0.0), line(560.0, 1.0)).moving(speed(0.6, turn() * DVec3::X));
        let patch = Body::new(&built(square()), diffuse(1.0)).sized(0.01).facing(facing);
        let eye = facing + facing.any_orthonormal_vector();
        let light =
            look(&Stage::of([patch]).lit_by([lamp]).scene(), &light_to(eye, Event::new(at, DVec3::ZERO)));
        worst.part_of_vector(light.lines * PI, matching(560.0 / doppler) * (LUMENS_PER_WATT * all));
    }
    worst.0
}

fn cosine_is_that_in_the_rest_frame_of_the_surface() -> f64 {
    let mut worst = Worst::default();
    let sun = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: turn() * DVec3::NEG_Y });
    for b in [0.1, 0.5, 0.8, 0.99] {
        let moves = speed(b, turn() * DVec3::X);
        let floor = Body::new(&built(square()), diffuse(1.0)).facing(turn() * DVec3::Y).moving(moves);
        let scene = Stage::of([floor]).lit_by([sun.clone()]).scene();
        let ray = light_to(turn() * v(0.0, 1.0, 0.2), Event::ORIGIN);
        let omega = frequency(moves, ray.k.x);
        for value in look(&scene, &ray).radiance {
            // D = γ, cos θ = 1/γ.
            worst.part(value * PI * omega.powi(5), moves.gamma().powi(3) / moves.gamma());
        }
    }
    worst.0
}

fn sun_in_motion_shines_with_the_third_power() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(4));
    for _ in 0..100 {
        let b = dice.between(0.0, 0.95);
        let (moves, axis, normal) = (dice.velocity(b), dice.direction(), dice.direction());
        let sun = Lantern::at(0.0, DVec3::ZERO, black_body(5000.0)).with(Beam::Sun { axis }).moving(moves);
        let (doppler, way) = (frequency(-moves, axis), along(-moves, axis));
        let patch = Body::new(&built(square()), diffuse(1.0)).facing(normal);
        let scene = Stage::of([patch]).lit_by([sun]).scene();
        let ray = light_to(normal + normal.any_orthonormal_vector() * 0.4, Event::ORIGIN);
        let got = look(&scene, &ray).radiance;
        for (value, nm) in got.iter().zip(Wavelengths::<64>::new().nm) {
            let expected = doppler.powi(3) * planck(nm * doppler, 5000.0) * -way.dot(normal);
            if expected > 1e-30 {
                worst.part(value * PI, expected);
            } else {
                worst.must(*value < 1e-29);
            }
        }
    }
    worst.0
}

/// Of the photons that the lamp sends at one moment those per solid angle of the lab are E r²/ν, for a time 1/D as long as
/// the lamp took.
fn photons_of_a_moving_lamp_are_conserved() -> f64 {
    let (mut worst, r) = (Worst::default(), 3.0);
    for b in [0.0, 0.1, 0.5, 0.8, 0.9, 0.99] {
        let moves = speed(b, FORWARD);
        let mean = mean_over_the_sphere(b, |n| {
            let doppler = 1.0 / frequency(moves, n);
            let patch = Body::new(&built(square()), diffuse(1.0)).sized(0.01).facing(-n).at(r, n * r);
            let lamp = Lantern::at(0.0, DVec3::ZERO, line(550.0 * doppler, 1.0)).moving(moves);
            let eye = n * (r - 1.0) + n.any_orthonormal_vector() * 0.7;
            let ray = light_to(eye, Event::new(r, n * r));
            let light = look(&Stage::of([patch]).lit_by([lamp]).scene(), &ray).lines.y;
            PI * light / (LUMENS_PER_WATT * matching(550.0).y) * (r / doppler).powi(2)
        });
        worst.apart(mean, 1.0);
    }
    worst.0
}

fn irradiance_is_the_same_from_every_frame() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(100));
    for meeting in meetings(200) {
        let stage = meeting.stage(black_body(6000.0));
        let by = dice.velocity(0.9);
        let here = look(&stage.scene(), &meeting.ray).radiance;
        // The same units of frequency: who looks is the same.
        let event = boosted::event(by, meeting.ray.event);
        let k = Boost::<Lab, Lab>::to_moving(by) * meeting.ray.k;
        let there = look(&boosted::stage(by, &stage).scene(), &SightRay { event, k }).radiance;
        for (here, there) in here.iter().zip(there) {
            if *here > 1e-30 {
                worst.part(there, *here);
            }
        }
    }
    worst.0
}

/// Lamp at (0, 5), floor at 0, and a screen at height 2 on one side of an edge that moves as βt.
fn screened(b: f64, side: f64) -> Scene {
    let floor = Body::new(&built(square()), diffuse(0.5)).sized(400.0).mapped(DAffine3::from_quat(turn()));
    let screen = Body::new(&built(square()), black()).sized(60.0);
    let screen = screen.mapped(DAffine3::from_translation(v(60.0 * side, 0.0, 0.0)));
    let screen = screen.mapped(DAffine3::from_quat(turn())).at(0.0, turn() * v(0.0, 0.0, 2.0));
    let lamp = Lantern::at(0.0, turn() * v(0.0, 0.0, 5.0), flat(1.0));
    Stage::of([floor, screen.moving(speed(b, turn() * DVec3::X))]).lit_by([lamp]).scene()
}

/// The root of what grows, by halving.
fn root(grows: impl Fn(f64) -> f64) -> f64 {
    edge(-200.0, 200.0, |x| grows(x) < 0.0)
}

fn shadow_edge_lags() -> f64 {
    let mut worst = Worst::default();
    for b in [0.1, 0.5, 0.9] {
        for side in [-1.0, 1.0] {
            let scene = screened(b, side);
            for t in [-5.0, 0.0, 5.0, 12.0] {
                let edge_at = root(|x| 0.6 * x - b * (t - ((0.4 * x).powi(2) + 4.0).sqrt()));
                let lit = |x: f64| {
                    let place = v(x, 0.0, 0.0);
                    let ray = light_to(turn() * (place + v(0.05, 0.1, 0.2)), Event::new(t, turn() * place));
                    look(&scene, &ray).radiance[0] > 0.0
                };
                worst.apart(edge(edge_at - 3.0 * side, edge_at + 3.0 * side, lit), edge_at);
            }
        }
    }
    worst.0
}

fn shadow_edge_is_seen_later_still() -> f64 {
    let mut worst = Worst::default();
    let eye = v(3.0, 4.0, 1.0);
    // Faster, the edge would outrun its own light, and be seen twice.
    for b in [0.1, 0.3, 0.4] {
        for side in [-1.0, 1.0] {
            let scene = screened(b, side);
            for seen_at in [4.0, 8.0, 15.0] {
                let at = |x: f64| seen_at - (v(x, 0.0, 0.0) - eye).length();
                let edge_at = root(|x| 0.6 * x - b * (at(x) - ((0.4 * x).powi(2) + 4.0).sqrt()));
                let lit = |x: f64| {
                    let ray = crate::support::light_from(
                        turn() * v(x, 0.0, 0.0),
                        Event::new(seen_at, turn() * eye),
                    );
                    look(&scene, &ray).radiance[0] > 0.0
                };
                worst.apart(edge(edge_at - 1.0 * side, edge_at + 1.0 * side, lit), edge_at);
            }
        }
    }
    worst.0
}
