//! What may be exchanged, turned, boosted or added without changing what is seen.

use super::{Worst, chapter, seen_by};
use crate::equivalence::{Props, SIZE, changes_by_slow_motion, eyes, flown, stopped};
use crate::light_equivalence;
use crate::support::{
    Body, Dice, Eye, Heaven, Lantern, Stage, along, ball, beta, black, black_body, boosted, built,
    difference, diffuse, emission_time, exposed, first, flat, frequency, icosphere, light_from, look, square,
    v,
};
use crate::terrell::{fitted_cone, outline};
use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::PI;
use terrell::lamp::Beam;
use terrell::observer::Aim;
use terrell::spacetime::{Event, Poincare, Velocity};
use terrell::spectrum::{Wavelengths, planck};

chapter! {
    "Symmetries":
    flying_camera_equals_flying_world, "V15 (a)", "the same picture; part of a pixel's light", "relativity", 1e-10;
    boosting_everything_changes_nothing, "V15 (b)", "the same picture; part of a pixel's light", "relativity", 1e-9;
    slow_motion_is_classical, "V15 (c)", "change ∝ β: order 1, fitted from 0.0001 to 0.001 c", "β → 0", 0.05;
    sphere_of_triangles_converges_with_the_square_of_its_edges, "V15 (d)", "outline's error ∝ h²: order 2, fitted over 320 to 20,480 triangles", "chord and arc", 0.1;
    order_of_bodies_and_lamps_changes_nothing, "V15 (e)", "the same picture; part of a pixel's light", "light adds", 1e-12;
    lamps_add, "V15 (g)", "picture of A and B = picture of A + picture of B", "linearity", 1e-12;
    rest_is_isotropic, "", "in a ball about lamp and eye that move along: D = 1, L = ρI/πr²; under a sky: L = L′", "isotropy of space", 1e-11;
    turning_everything_changes_nothing, "", "scene and camera turned together: the same picture", "isotropy of space", 1e-10;
    turning_glass_and_skies_changes_nothing, "", "the same with glass, panoramas, stars and clocks", "isotropy of space", 1e-9;
    lamp_and_pinhole_may_be_exchanged, "", "time reversed: H(λ)/I(Dλ) = D⁸ H(Dλ)/I(λ), D from lamp to pinhole", "Helmholtz reciprocity; k·u", 1e-11;
}

/// The largest difference of two pictures; pixels that an edge passes may differ, one in a thousand.
fn differ(worst: &mut Worst, a: &[DVec3], b: &[DVec3]) {
    let (part, edges) = difference(a, b);
    worst.error(part);
    worst.must(edges * 1000 <= a.len() && a.iter().filter(|xyz| xyz.y > 0.0).count() * 20 > a.len());
}

fn flying_camera_equals_flying_world() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(5));
    let still = stopped(&Props::new().stage(&mut dice, 0.5));
    let eye = Eye::at(0.0, DVec3::ZERO).wide(80.0);
    for velocity in [beta(0.0, 0.0, -0.8), beta(0.3, 0.2, -0.5), beta(-0.6, 0.0, 0.1)] {
        let camera = exposed::<8>(&still.seen_by(&eye.moving(velocity)), 0.0, SIZE);
        let world = exposed::<8>(&flown(velocity, &still).seen_by(&eye), 0.0, SIZE);
        differ(&mut worst, &camera, &world);
    }
    worst.0
}

fn boosting_everything_changes_nothing() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(2025));
    let props = Props::new();
    for fast in [0.5, 0.9] {
        let stage = props.stage(&mut dice, fast);
        for (eye, tau) in eyes(&mut dice).into_iter().skip(1) {
            let by = dice.velocity(0.9);
            let moved = boosted::stage(by, &stage).seen_by(&boosted::eye(by, &eye));
            let here = exposed::<8>(&stage.seen_by(&eye), tau, SIZE);
            differ(&mut worst, &here, &exposed::<8>(&moved, tau, SIZE));
        }
    }
    worst.0
}

fn slow_motion_is_classical() -> f64 {
    let [slow, slower] = changes_by_slow_motion([1e-3, 1e-4]);
    (libm::log10(slow / slower) - 1.0).abs()
}

/// The slope of a line fitted to points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let (mut across, mut square) = (0.0, 0.0);
    for (x, y) in points {
        across += (x - mean.0) * (y - mean.1);
        square += (x - mean.0) * (x - mean.0);
    }
    across / square
}

/// The half angle of the outline of a ball that passes at 0.8 c, against Penrose's circle.
fn sphere_of_triangles_converges_with_the_square_of_its_edges() -> f64 {
    let place = v(0.0, 5.0, 0.0);
    let moves = beta(0.8, 0.0, 0.0);
    let (_, seer) = seen_by(moves, (0.0, -place));
    let far = seer.length();
    let (cos, axis) = seen_by(-moves, ((1.0 - 1.0 / (far * far)).sqrt(), seer / far));
    let exact = libm::acos(cos / axis.length());
    let points = [2, 3, 4, 5].map(|level| {
        let body = Body::new(&built(icosphere(level)), black()).at(0.0, place).moving(moves);
        let seen = outline(&Stage::of([body]).scene(), Event::ORIGIN, -axis, 400);
        (-f64::from(level), libm::log2(exact - fitted_cone(&seen).1))
    });
    (slope(&points) - 2.0).abs()
}

fn shuffled<T>(of: &mut [T], dice: &mut Dice) {
    for i in (1..of.len()).rev() {
        of.swap(i, dice.below(i + 1));
    }
}

fn order_of_bodies_and_lamps_changes_nothing() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(8));
    let mut stage = Props::new().stage(&mut dice, 0.8);
    let eye = Eye::at(0.0, DVec3::ZERO).moving(beta(0.1, 0.4, -0.3)).wide(80.0);
    let first = exposed::<8>(&stage.seen_by(&eye), 0.0, SIZE);
    for _ in 0..3 {
        shuffled(&mut stage.bodies, &mut dice);
        shuffled(&mut stage.lamps, &mut dice);
        let other = exposed::<8>(&stage.seen_by(&eye), 0.0, SIZE);
        worst.must(difference(&first, &other).1 == 0);
        differ(&mut worst, &first, &other);
    }
    worst.0
}

fn lamps_add() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(15));
    for fast in [0.0, 0.8] {
        let stage = Props::new().stage(&mut dice, fast);
        let eye = Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(0.5)).wide(100.0);
        let with = |lamps: &[Lantern]| {
            let stage = Stage { lamps: lamps.to_vec(), ..stage.clone() };
            exposed::<8>(&stage.seen_by(&eye), 0.0, SIZE)
        };
        let (a, b) = stage.lamps.split_at(2);
        let sum = |p: &[DVec3], q: &[DVec3]| p.iter().zip(q).map(|(p, q)| p + q).collect::<Vec<_>>();
        // What shines by itself is on both sides twice.
        differ(&mut worst, &sum(&with(a), &with(b)), &sum(&with(&stage.lamps), &with(&[])));
    }
    worst.0
}

/// Lamp, eye, a ball around them and a sky, all at rest beside each other, at any velocity in the lab.
fn rest_is_isotropic() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(16));
    for b in [0.0, 0.3, 0.8, 0.99] {
        let (moves, t, place) = (dice.velocity(b), dice.between(-5.0, 5.0), dice.in_cube() * 5.0);
        let shell = Body::of(ball(2.0, DVec3::ZERO), diffuse(0.7)).at(t, place).moving(moves);
        let lamp = Lantern::at(t, place, flat(3.0)).moving(moves);
        let eye = Eye::at(t, place).moving(moves);
        let inside = Stage::of([shell]).lit_by([lamp]).seen_by(&eye);
        let sky = Heaven::uniform(black_body(5000.0)).moving(moves);
        let outside = Stage::of([]).under(sky).seen_by(&eye);
        for _ in 0..100 {
            let ray = eye.sight(dice.direction());
            worst.part(first(&inside, &ray).doppler.factor(), 1.0);
            for value in look(&inside, &ray).radiance {
                worst.part(value, 0.7 * 3.0 / (PI * 4.0));
            }
            for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(look(&outside, &ray).radiance) {
                worst.part(value, planck(*nm, 5000.0));
            }
        }
    }
    worst.0
}

/// Everything turned about the lab's origin.
fn turned(turn: DQuat, stage: &Stage) -> Stage {
    let mut stage = stage.clone();
    let event = |event: Event| Event::new(event.t, turn * event.x);
    for body in &mut stage.bodies {
        body.placement.origin = event(body.placement.origin);
        body.placement.velocity = turned_velocity(turn, body.placement.velocity);
        *body = body.clone().mapped(DAffine3::from_quat(turn));
    }
    for lamp in &mut stage.lamps {
        lamp.origin = event(lamp.origin);
        lamp.velocity = turned_velocity(turn, lamp.velocity);
        match &mut lamp.beam {
            Beam::Point { place } => *place = turn * *place,
            Beam::Sun { axis } => *axis = turn * *axis,
            Beam::Spot { place, axis, .. } => (*place, *axis) = (turn * *place, turn * *axis),
        }
    }
    for sky in &mut stage.skies {
        *sky = sky.clone().turned(turn).moving(turned_velocity(turn, sky.velocity));
    }
    stage
}

fn turned_velocity(turn: DQuat, velocity: Velocity) -> Velocity {
    Velocity::from_proper(turn * velocity.proper())
}

/// The axes that the eye carries turn with it: what is told in them stays.
fn turned_eye(turn: DQuat, eye: &Eye) -> Eye {
    let aim = match eye.aim {
        Aim::Along(direction) => Aim::Along(direction),
        Aim::At { rest_from_lab, place } => {
            let moves = turned_velocity(turn, rest_from_lab.boost().velocity());
            let origin = rest_from_lab.origin();
            let origin = Event::new(origin.t, turn * origin.x);
            Aim::At { rest_from_lab: Poincare::to_moving(moves, origin), place: turn * place }
        }
    };
    let (origin, velocity) = (eye.origin, turned_velocity(turn, eye.velocity));
    let origin = Event::new(origin.t, turn * origin.x);
    Eye { origin, velocity, rotation: turn * eye.rotation, aim, ..eye.clone() }
}

/// How pictures differ that should not, after some turns.
fn differ_by_turns(stage: &Stage, eyes: &[(Eye, f64)], dice: &mut Dice, size: (u32, u32)) -> f64 {
    let mut worst = Worst::default();
    for (eye, tau) in eyes {
        let turn = dice.turn();
        let other = turned(turn, stage).seen_by(&turned_eye(turn, eye));
        let here = exposed::<8>(&stage.seen_by(eye), *tau, size);
        differ(&mut worst, &here, &exposed::<8>(&other, *tau, size));
    }
    worst.0
}

fn turning_everything_changes_nothing() -> f64 {
    let mut dice = Dice(360);
    let stage = Props::new().stage(&mut dice, 0.8);
    let eyes = eyes(&mut dice);
    let still: Vec<(Eye, f64)> = eyes[..1].to_vec();
    let moving = differ_by_turns(&stage, &eyes, &mut dice, SIZE);
    moving.max(differ_by_turns(&stopped(&stage), &still, &mut dice, SIZE))
}

fn turning_glass_and_skies_changes_nothing() -> f64 {
    let mut dice = Dice(361);
    let stage = light_equivalence::stage(&mut dice, 0.6);
    let eyes = light_equivalence::eyes(&mut dice);
    // Colours that glass parts take their time: a small picture.
    differ_by_turns(&stage, &eyes[..2], &mut dice, (36, 27))
}

/// Someone who passes a place at a time, and who moves.
#[derive(Clone, Copy)]
struct Passing {
    event: Event,
    velocity: Velocity,
}

impl Passing {
    /// Time turned back.
    fn reversed(self) -> Self {
        Self { event: Event::new(-self.event.t, self.event.x), velocity: -self.velocity }
    }
}

/// Light from the lamp by way of a grey patch at the origin at zero to the pinhole: the irradiance there per area of the
/// patch and per intensity, at each wavelength of a flat spectrum. What the patch's area is seen as: cos θ/r² with r in
/// the pinhole's frame.
fn transport(lamp: Passing, patch: (Velocity, DVec3), pinhole: Passing) -> [f64; 64] {
    let (moves, normal) = patch;
    let body = Body::new(&built(square()), diffuse(0.3)).sized(0.01).facing(normal).moving(moves);
    let lantern = Lantern::at(lamp.event.t, lamp.event.x, flat(2.0)).moving(lamp.velocity);
    let eye = Eye::at(pinhole.event.t, pinhole.event.x).moving(pinhole.velocity);
    let scene = Stage::of([body]).lit_by([lantern]).seen_by(&eye);
    let way = light_from(DVec3::ZERO, pinhole.event).k.x;
    let ray = eye.sight(-along(pinhole.velocity, way));
    let distance = pinhole.event.x.length() * frequency(pinhole.velocity, way);
    let cosine = along(moves, way).dot(normal);
    look(&scene, &ray).radiance.map(|radiance| radiance / 2.0 * cosine / (distance * distance))
}

fn lamp_and_pinhole_may_be_exchanged() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(88));
    let mut met = 0;
    for _ in 0..600 {
        let [a, b, c] = [0.9, 0.9, 0.9].map(|most| dice.between(0.0, most));
        let (patch, normal) = (dice.velocity(a), dice.direction());
        let (from, to) =
            (dice.direction() * dice.between(1.0, 5.0), dice.direction() * dice.between(1.0, 5.0));
        // The light leaves the lamp, meets the patch at the origin at zero, and arrives at the pinhole.
        let lamp = Passing { event: Event::new(-from.length(), from), velocity: dice.velocity(b) };
        let pinhole = Passing { event: Event::new(to.length(), to), velocity: dice.velocity(c) };
        let [inward, outward] = [-from / from.length(), to / to.length()];
        if along(patch, inward).dot(normal) > -0.05 || along(patch, outward).dot(normal) < 0.05 {
            continue;
        }
        met += 1;
        let doppler = frequency(pinhole.velocity, outward) / frequency(patch, outward)
            * (frequency(patch, inward) / frequency(lamp.velocity, inward));
        let there = transport(lamp, (patch, normal), pinhole);
        let back = transport(pinhole.reversed(), (-patch, normal), lamp.reversed());
        for (there, back) in there.iter().zip(back) {
            worst.part(*there, doppler.powi(8) * back);
        }
    }
    worst.must(met > 50);
    worst.0
}

/// The lamp is where the light leaves it: what the law above takes for granted.
#[test]
fn light_of_the_lamp_that_meets_the_patch_leaves_at_the_lamps_event() {
    let lamp = Passing { event: Event::new(-5.0, v(3.0, 0.0, 4.0)), velocity: beta(0.3, -0.5, 0.6) };
    let path = |t: f64| lamp.event.x + lamp.velocity.beta() * (t - lamp.event.t);
    crate::support::near(emission_time(Event::ORIGIN, path), -5.0, 1e-14);
}
