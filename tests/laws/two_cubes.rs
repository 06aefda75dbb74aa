//! A lamp that passes between two cubes: their shadows on the floor, worked out here from the light's way past them.
//!
//! For a place X of the floor at its time t: the lamp's light that arrives there left at
//!
//! ~~~text
//! tₑ = t − γ²[√((R·β)² + R²/γ²) − R·β]        R = p(t) − X, with the lamp at p(t) = p₀ + βt
//! ~~~
//!
//! and went straight. A cube stands in its way if it is there when the light passes: less where it is then, and γ times as
//! long along the cube's motion, the light's way is a straight line that meets or misses a cube of side 2.

use super::Worst;
use crate::support::{
    Body, Dice, Eye, Lantern, Stage, black, built, cube, diffuse, edge, flat, light_to, plane, v,
};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use terrell::scene::Scene;
use terrell::spacetime::{Event, SightRay, Velocity};
use terrell::spectrum::Wavelengths;

/// When and where, with +y up.
type Moment = (f64, DVec3);

/// A cube of side 2 that stands on the floor: its centre at time zero, and how it slides.
struct Cube {
    centre: DVec3,
    moves: Velocity,
}

impl Cube {
    /// Whether it is in the way of light that goes straight from one event to another.
    fn stops(&self, from: Moment, to: Moment) -> bool {
        // From its centre, in its rest frame: what is aside at the same time of the lab, γ times as far along its motion.
        let beside = |(t, x): Moment| {
            let (aside, u) = (x - self.centre - self.moves.beta() * t, self.moves.proper());
            aside + u * (u.dot(aside) / (self.moves.gamma() + 1.0))
        };
        let (start, end) = (beside(from), beside(to));
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            let at = |face: f64| (face - start[axis]) / (end[axis] - start[axis]);
            enters = enters.max(at(-1.0).min(at(1.0)));
            leaves = leaves.min(at(-1.0).max(at(1.0)));
        }
        enters < leaves
    }
}

/// What is seen of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Hidden,
    Dark,
    Lit,
}

/// Above the floor y = 0: a lamp, and two cubes.
struct Passing {
    start: DVec3,
    lamp: Velocity,
    cubes: [Cube; 2],
}

impl Passing {
    fn lamp_at(&self, t: f64) -> DVec3 {
        self.start + self.lamp.beta() * t
    }

    /// Where the lamp's light left that arrives at a place at a time.
    fn departure(&self, (t, x): Moment) -> Moment {
        let (apart, beta) = (self.lamp_at(t) - x, self.lamp.beta());
        let (along, square) = (apart.dot(beta), self.lamp.gamma().powi(2));
        let late = square * ((along * along + apart.length_squared() / square).sqrt() - along);
        (t - late, self.lamp_at(t - late))
    }

    fn open(&self, from: Moment, to: Moment) -> bool {
        !self.cubes.iter().any(|cube| cube.stops(from, to))
    }

    /// What someone sees of a place of the floor: it is lit if light from the lamp got there in time.
    fn state(&self, eye: Moment, place: DVec3) -> State {
        let floor = (eye.0 - (place - eye.1).length(), place);
        if !self.open(floor, eye) {
            State::Hidden
        } else if self.open(self.departure(floor), floor) {
            State::Lit
        } else {
            State::Dark
        }
    }

    /// The same if light took no time.
    fn state_at_once(&self, eye: Moment, place: DVec3) -> State {
        let lamp = self.lamp_at(eye.0);
        if self.open((eye.0, lamp), (eye.0, place)) { State::Lit } else { State::Dark }
    }

    /// The same for the program, turned so that no axis is special.
    fn stage(&self) -> Stage {
        let lab = |velocity: Velocity| Velocity::from_proper(turn() * velocity.proper());
        let floor = Body::of(plane(DVec3::ZERO, turn() * DVec3::Y), diffuse(0.5));
        let cubes = self.cubes.each_ref().map(|Cube { centre, moves }| {
            let body = Body::new(&built(cube()), black()).mapped(DAffine3::from_quat(turn()));
            body.at(0.0, turn() * *centre).moving(lab(*moves))
        });
        let lamp = Lantern::at(0.0, turn() * self.start, flat(1.0)).moving(lab(self.lamp));
        Stage::of([floor].into_iter().chain(cubes)).lit_by([lamp])
    }
}

fn turn() -> DQuat {
    DQuat::from_axis_angle(v(2.0, -6.0, 3.0) / 7.0, 2.3)
}

/// What the program shows along a ray. (Wavelengths take longer to choose than to look at.)
fn shown(scene: &Scene, wavelengths: &Wavelengths<8>, ray: &SightRay) -> State {
    match scene.lit().first(ray) {
        Some(first) if first.body == 0 => {
            if scene.lit().seen(ray, wavelengths).radiance[0] > 0.0 {
                State::Lit
            } else {
                State::Dark
            }
        }
        _ => State::Hidden,
    }
}

/// The lamp at (0, 3, 0) at zero, cubes about (±3, 1, 0); at rest and in motion.
fn passings() -> Vec<Passing> {
    let rest = DVec3::ZERO;
    let cases = [
        (v(0.0, 0.0, -0.9), [rest, rest]),
        (v(0.0, 0.0, -0.5), [rest, rest]),
        (v(0.0, 0.0, -0.99), [rest, rest]),
        (v(0.0, 0.0, -0.9), [v(0.0, 0.0, -0.3), v(0.0, 0.0, 0.6)]),
        (v(0.1, -0.02, -0.8), [v(0.2, 0.0, -0.1), v(-0.5, 0.0, 0.4)]),
    ];
    let velocity = |beta: DVec3| Velocity::from_beta(beta).unwrap();
    let passing = |(lamp, [one, other]): (DVec3, [DVec3; 2])| Passing {
        start: v(0.0, 3.0, 0.0),
        lamp: velocity(lamp),
        cubes: [
            Cube { centre: v(3.0, 1.0, 0.0), moves: velocity(one) },
            Cube { centre: v(-3.0, 1.0, 0.0), moves: velocity(other) },
        ],
    };
    cases.into_iter().map(passing).collect()
}

/// Along a line, in steps: wherever one of two views of it changes, so does the other, and at the same place.
fn compare(
    worst: &mut Worst,
    (steps, step): (u32, f64),
    ours: impl Fn(f64) -> State,
    shows: impl Fn(f64) -> State,
) -> u32 {
    let mut met = 0;
    let (mut last, mut at_last) = (0.0, ours(0.0));
    worst.must(shows(0.0) == at_last);
    for number in 1..=steps {
        let at = f64::from(number) * step;
        let now = ours(at);
        worst.must(shows(at) == now);
        if now != at_last && worst.0.is_finite() {
            let ends = |of: &dyn Fn(f64) -> State| edge(last, at, |x| of(x) == at_last);
            worst.apart(ends(&shows), ends(&ours));
            met += u32::from(now != State::Hidden && at_last != State::Hidden);
        }
        (last, at_last) = (at, now);
    }
    met
}

/// On the floor, at moments of its own: each place is looked at from 4 m above it, over the cubes.
pub(super) fn light_passes_two_cubes_where_they_are_then() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(131));
    let (mut met, mut naive, wavelengths) = (0, 0, Wavelengths::new());
    for passing in passings() {
        let scene = passing.stage().scene();
        for t in [-4.0, 0.0, 3.0, 7.0, 16.49, 28.0] {
            for _ in 0..12 {
                let start = v(dice.between(-9.0, 9.0), 0.0, dice.between(-12.0, 5.0));
                let (sin, cos) = libm::sincos(dice.between(0.0, 6.3));
                let place = |way: f64| start + v(cos, 0.0, sin) * way;
                let above = v(0.3, 4.0, 0.2);
                let eye = |way: f64| (t + above.length(), place(way) + above);
                let ours = |way: f64| passing.state(eye(way), place(way));
                let shows = |way: f64| {
                    let spot = Event::new(t, turn() * place(way));
                    shown(&scene, &wavelengths, &light_to(turn() * (place(way) + above), spot))
                };
                met += compare(&mut worst, (60, 0.25), ours, shows);
                naive += (0..60)
                    .map(|step| 0.25 * f64::from(step))
                    .filter(|way| {
                        let seen = ours(*way);
                        let at_once = passing.state_at_once((t, DVec3::ZERO), place(*way));
                        seen != State::Hidden && seen != at_once
                    })
                    .count();
            }
        }
    }
    // There is something to see, and it is not where light without delay would throw it.
    worst.must(met > 200 && naive > 3000);
    worst.0
}

/// In pictures 1000 pixels wide: the floor's place of each pixel as a pinhole has it.
pub(super) fn shadows_of_two_cubes_are_seen_later_still() -> f64 {
    let (mut worst, mut met, wavelengths) = (Worst::default(), 0, Wavelengths::new());
    let cameras = [(v(5.0, 5.0, 5.0), v(2.0, 1.0, 0.0)), (v(12.0, 8.0, 0.0), v(5.0, 0.0, -3.0))];
    let (width, height) = (1000, 750);
    for passing in passings() {
        for (eye, target) in cameras {
            for seen_at in [6.0, 16.49, 24.0] {
                let forward = (target - eye) / (target - eye).length();
                let right = forward.cross(DVec3::Y) / forward.cross(DVec3::Y).length();
                // 90° wide: half the width is the distance of the picture.
                let place = |pixel: DVec2| {
                    let aside = (pixel - v2(width, height) / 2.0) / (f64::from(width) / 2.0);
                    let n = forward + right * aside.x - right.cross(forward) * aside.y;
                    (n.y < 0.0).then(|| eye - n * (eye.y / n.y))
                };
                let ours = |pixel: DVec2| {
                    place(pixel).map_or(State::Hidden, |place| passing.state((seen_at, eye), place))
                };
                let camera = Eye { up: turn() * DVec3::Y, ..Eye::at(seen_at, turn() * eye).wide(90.0) };
                let scene = passing.stage().seen_by(&camera.toward(turn() * forward));
                let view = scene.observer.view(0.0, width, height);
                let shows = |pixel: DVec2| shown(&scene, &wavelengths, &view.ray(pixel));
                for row in 0..12 {
                    let row = |x: f64| DVec2::new(x, 60.3 * f64::from(row) + 41.7);
                    met += compare(&mut worst, (199, 5.0), |x| ours(row(x)), |x| shows(row(x)));
                }
                for column in 0..12 {
                    let column = |y: f64| DVec2::new(81.3 * f64::from(column) + 30.1, y);
                    met += compare(&mut worst, (149, 5.0), |y| ours(column(y)), |y| shows(column(y)));
                }
            }
        }
    }
    worst.must(met > 1000);
    worst.0
}

fn v2(width: u32, height: u32) -> DVec2 {
    DVec2::new(f64::from(width), f64::from(height))
}
