//! How moving balls are seen: their outlines, and what is inside them.

use super::shape::{FAR, SPEEDS, turn};
use super::{Worst, aside, seen_by};
use crate::support::{Body, Dice, Eye, Stage, along, ball, black, edge, emission_time, light_from, speed, v};
use crate::terrell::{fitted_cone, outline};
use glam::{DAffine3, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use terrell::spacetime::Event;

pub(super) fn outline_of_a_ball_is_the_circle_of_penrose() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(44));
    for b in SPEEDS {
        for _ in 0..6 {
            let (moves, fast) = (dice.velocity(b), dice.between(0.0, 0.9));
            let eye = Eye::at(dice.between(-3.0, 12.0), dice.in_cube()).moving(dice.velocity(fast));
            let place = dice.direction() * 5.0;
            let scene = Stage::of([Body::of(ball(1.0, DVec3::ZERO), black()).at(0.0, place).moving(moves)])
                .seen_by(&eye);
            // The ball and who sees it in the ball's rest frame.
            let (_, seer) = seen_by(moves, (eye.origin.t, eye.origin.x - place));
            let far = seer.length();
            if far < 1.5 {
                continue;
            }
            // The rim lies in n·c = cos α; of light k = (1, -n): k·(cos α, -c) = 0, a product of four-vectors.
            let rim = ((1.0 - 1.0 / (far * far)).sqrt(), seer / far);
            let (cos, axis) = seen_by(eye.velocity, seen_by(-moves, rim));
            let (half, axis) = (libm::acos(cos / axis.length()), -axis / axis.length());
            for i in 0..12 {
                let around = f64::from(i) * TAU / 12.0;
                let sees = |off: f64| scene.lit().first(&eye.sight(aside(axis, off, around))).is_some();
                worst.apart(edge(0.0, PI, sees), half);
            }
        }
    }
    worst.0
}

/// R = 1, centre (βt, 5, 0), seen from the origin: half angle, and the circle's centre from +y towards +x.
pub(super) fn outline_of_a_passing_ball_is_that_of_the_table() -> f64 {
    let mut worst = Worst::default();
    let table = [
        (0.5, [(0.0, 10.0250, -29.4962), (5.0, 11.5364, 0.5773), (10.0, 10.4727, 24.6555)]),
        (0.8, [(0.0, 6.9825, -52.5672), (5.0, 11.5355, 0.9200), (10.0, 9.6246, 33.2843)]),
        (0.9, [(0.0, 5.0845, -63.6964), (5.0, 11.5351, 1.0332), (10.0, 9.3826, 35.3997)]),
    ];
    for (b, row) in table {
        let body = Body::of(ball(1.0, DVec3::ZERO), black()).at(0.0, turn() * v(0.0, 5.0, 0.0));
        let scene = Stage::of([body.moving(speed(b, turn() * DVec3::X))]).scene();
        for (seen_at, half, centre) in row {
            let eye = Event::new(seen_at, DVec3::ZERO);
            let path = |t: f64| turn() * v(b * t, 5.0, 0.0);
            let seen = outline(&scene, eye, path(emission_time(eye, path)), 60);
            let (axis, angle, residual) = fitted_cone(&seen);
            let axis = turn().inverse() * axis;
            worst.apart(angle.to_degrees(), half);
            worst.apart(libm::atan2(axis.x, axis.y).to_degrees(), centre);
            worst.must(axis.z.abs() < 1e-12 && residual < 1e-12);
        }
    }
    worst.0
}

/// Points all over a ball that moves any way: their texture coordinates where V7 says that they are seen.
pub(super) fn texture_of_a_ball_is_seen_where_its_light_left() -> f64 {
    let (mut worst, mut dice, mut met) = (Worst::default(), Dice(45), 0);
    for b in SPEEDS {
        for _ in 0..60 {
            let (moves, centre) = (dice.velocity(b), dice.direction() * 5.0);
            let body = Body::of(ball(1.0, DVec3::ZERO), black()).mapped(DAffine3::from_quat(turn()));
            let scene = Stage::of([body.at(0.0, centre).moving(moves)]).scene();
            let (own, eye) = (dice.direction(), Event::new(dice.between(-3.0, 9.0), dice.in_cube()));
            let (rest, u) = (turn() * own, moves.proper());
            // Shorter along its motion.
            let place = rest - u * (u.dot(rest) / (moves.gamma() * (moves.gamma() + 1.0)));
            let path = |t: f64| centre + place + moves.beta() * t;
            let from = path(emission_time(eye, path));
            let way = (eye.x - from) / (eye.x - from).length();
            if along(moves, way).dot(rest) < 0.1 {
                continue;
            }
            met += 1;
            let hit = scene.world.nearest(&light_from(from, eye));
            worst.must(hit.is_some());
            let Some(hit) = hit else { continue };
            let (longitude, from_pole) = (TAU * hit.uv(0).x, PI * hit.uv(0).y);
            let (sin, cos) = libm::sincos(longitude);
            let across = libm::sin(from_pole);
            worst.directions(v(across * cos, libm::cos(from_pole), -across * sin), own);
        }
    }
    worst.must(met > 100);
    worst.0
}

/// A ball that moves along x at θ to the light that leaves it for the origin.
pub(super) fn far_ball_is_seen_turned() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        for theta in [0.3, 1.0, FRAC_PI_2, 2.0, 2.9] {
            let (sin, cos) = libm::sincos(theta);
            let place = turn() * v(-cos, sin, 0.0) * FAR;
            let ball = Body::of(ball(1.0, DVec3::ZERO), black()).at(-FAR, place);
            let scene = Stage::of([ball.moving(speed(b, turn() * DVec3::X))]).scene();
            let ray = light_from(place, Event::ORIGIN);
            let hit = scene.world.nearest(&ray).unwrap();
            let shown = libm::acos((cos - b) / (1.0 - b * cos));
            let (sin, cos) = libm::sincos(shown);
            worst.directions(turn().inverse() * hit.spot(&ray).normal, v(cos, -sin, 0.0));
        }
    }
    worst.0
}
