//! A search for the worst: a camera and a ball with motions and distances over many decades, changed at random wherever
//! that makes the error larger in parts of what is allowed. The worst found are kept.

use super::numbers::any_velocity;
use crate::support::exact::ball_seen;
use crate::support::{Body, Dice, Eye, Stage, ball, black};
use glam::DVec3;
use terrell::spacetime::{Event, Velocity};

/// A camera that sees a ball.
#[derive(Debug, Clone, Copy)]
struct Case {
    eye: (f64, [f64; 3]),
    // Rapidity and direction, both unscaled.
    eye_moves: (f64, [f64; 3]),
    ball: (f64, [f64; 3]),
    ball_moves: (f64, [f64; 3]),
    radius: f64,
    // Which place of the ball is looked at, part of its radius from its centre.
    aim: [f64; 3],
}

/// What is guaranteed of a ray that meets a ball not too slantingly, in parts of what is allowed: above 1 is a breach.
#[derive(Debug, Clone, Copy, Default)]
struct Breach {
    /// Of the frequency: 4 ε (γ of the camera + γ of the body) + 2e-12 of it.
    doppler: f64,
    /// Of the place, in the rest frame: 4 ε (γ (d + c / 4) + r + w), over the cosine: d the distance from the camera to
    /// the body's origin, in place and time, c the larger of their coordinates, r the radius, and w the way of the light
    /// in the lab, of which 4 ε is an angle that no picture shows.
    place: f64,
}

impl Breach {
    fn worst(self) -> f64 {
        self.doppler.max(self.place)
    }
}

fn velocity((rapidity, along): (f64, [f64; 3])) -> Velocity {
    Velocity::from_rapidity(rapidity, along.into())
}

fn size(t: f64, x: DVec3) -> f64 {
    t.abs() + x.abs().max_element()
}

impl Case {
    fn any(dice: &mut Dice) -> Self {
        let far = |dice: &mut Dice| libm::pow(10.0, dice.between(-1.0, 9.0));
        let (base, apart) = (far(dice), far(dice));
        let start = (dice.between(-base, base), dice.in_cube() * base);
        let moves = |dice: &mut Dice| {
            let velocity = any_velocity(dice);
            (velocity.rapidity(), (velocity.proper() / velocity.proper().length()).to_array())
        };
        Self {
            eye: (start.0, start.1.to_array()),
            eye_moves: moves(dice),
            ball: (start.0 + dice.between(-apart, apart), (start.1 + dice.in_cube() * apart).to_array()),
            ball_moves: moves(dice),
            radius: apart * libm::pow(10.0, dice.between(-2.0, 0.0)),
            aim: (dice.direction() * dice.between(0.0, 0.8)).to_array(),
        }
    }

    /// A little different, or much.
    fn changed(mut self, dice: &mut Dice) -> Self {
        let other = Self::any(dice);
        let little = libm::pow(10.0, -dice.between(0.0, 6.0));
        let nudge = |dice: &mut Dice, x: [f64; 3]| {
            let v = DVec3::from(x);
            (v + dice.direction() * (v.length() * little)).to_array()
        };
        match dice.below(10) {
            0 => self.eye_moves.1 = nudge(dice, self.eye_moves.1),
            1 => self.ball_moves.1 = nudge(dice, self.ball_moves.1),
            2 => self.eye_moves.0 = (self.eye_moves.0 + dice.between(-1.0, 1.0)).clamp(0.01, 19.1),
            3 => self.ball_moves.0 = (self.ball_moves.0 + dice.between(-1.0, 1.0)).clamp(0.01, 19.1),
            4 => self.ball.1 = nudge(dice, self.ball.1),
            5 => self.eye.1 = nudge(dice, self.eye.1),
            6 => self.aim = (dice.direction() * dice.between(0.0, 0.8)).to_array(),
            7 => self.eye_moves = other.eye_moves,
            8 => self.ball_moves = other.ball_moves,
            _ => self.radius *= libm::pow(2.0, dice.between(-1.0, 1.0)),
        }
        self
    }

    /// None where the ball is not seen, or is known less well than its size: there a picture is refused.
    fn breach(&self) -> Option<Breach> {
        let eye: Event = Event::new(self.eye.0, self.eye.1.into());
        let centre: Event = Event::new(self.ball.0, self.ball.1.into());
        let (eye_moves, moves) = (velocity(self.eye_moves), velocity(self.ball_moves));
        let body = Body::of(ball(self.radius, DVec3::ZERO), black()).at(centre.t, centre.x).moving(moves);
        let camera = Eye::at(eye.t, eye.x).moving(eye_moves);
        let scene = Stage::of([body]).scene();
        // Where the aimed place is seen from the camera.
        let place = DVec3::from(self.aim) * self.radius;
        let way = (scene.world.frames[0].rest_from_lab * eye).x - place;
        let k = terrell::spacetime::FourVector::new(way.length(), way);
        let k = scene.world.frames[0].rest_from_lab.boost().inverse().light(k);
        let tetrad = camera.observer().worldline.at(0.0);
        let toward = tetrad.direction_of(k);
        let (omega, exact) = ball_seen((eye, eye_moves), toward, (centre, moves), self.radius)?;
        let unit = 4.0 * f64::EPSILON;
        let apart = size(eye.t - centre.t, eye.x - centre.x);
        let known = size(eye.t, eye.x).max(size(centre.t, centre.x));
        let ray = tetrad.sight_ray(toward);
        let hit = scene.world.nearest(&ray)?;
        let allowed = unit * (moves.gamma() * (apart + 0.25 * known) + self.radius + hit.s * ray.k.t);
        if allowed > 0.1 * self.radius {
            return None;
        }
        let spot = hit.spot(&ray);
        let cosine = exact.dot(spot.k.x) / (exact.length() * spot.k.x.length());
        if cosine < 0.3 {
            return None;
        }
        Some(Breach {
            doppler: (spot.k.t / omega - 1.0).abs() / (unit * (moves.gamma() + eye_moves.gamma()) + 2e-12),
            place: (spot.event.x - exact).length() * cosine / allowed,
        })
    }
}

/// Climbs from random places for so many steps each; the worst of all.
fn climb(seed: u64, starts: u32, steps: u32) -> (f64, Option<Case>, u32) {
    let mut dice = Dice(seed);
    let (mut worst, mut seen) = ((0.0, None), 0);
    for _ in 0..starts {
        let mut here = (0.0, Case::any(&mut dice));
        for _ in 0..steps {
            let next = here.1.changed(&mut dice);
            let Some(breach) = next.breach() else {
                if here.0 == 0.0 {
                    here.1 = Case::any(&mut dice);
                }
                continue;
            };
            seen += 1;
            if breach.worst() >= here.0 {
                here = (breach.worst(), next);
            }
        }
        if here.0 > worst.0 {
            worst = (here.0, Some(here.1));
        }
    }
    (worst.0, worst.1, seen)
}

#[test]
fn search_finds_no_ball_less_well_seen_than_is_guaranteed() {
    let (worst, case, seen) = climb(77, 40, 400);
    assert!(seen > 4000, "only {seen} were seen");
    assert!(worst < 1.0, "{worst} of what is allowed: {case:?} {:?}", case.map(|case| case.breach()));
}
