//! Shadows of moving bodies: what stands in the light's way when the light passes.

use crate::support::{
    Body, Dice, Lantern, Stage, black, built, cube, diffuse, edge, emission_time, flat, icosphere, is_bright,
    light_at_rest, light_to, look, near, speed, square, v,
};
use glam::{DQuat, DVec3};
use terrell::lamp::Beam;
use terrell::scene::Scene;
use terrell::spacetime::{Event, Velocity};

fn turn() -> DQuat {
    DQuat::from_axis_angle(v(3.0, -2.0, 6.0) / 7.0, 0.5)
}

/// A floor through the origin, up is z.
fn floor() -> Body {
    Body::new(&built(square()), diffuse(0.5)).sized(200.0).mapped(glam::DAffine3::from_quat(turn()))
}

/// Whether the floor's place is lit at its time t, watched from just above it.
fn lit(scene: &Scene, t: f64, place: DVec3) -> bool {
    let spot = Event::new(t, turn() * place);
    look(scene, &light_to(turn() * (place + v(0.05, 0.1, 0.2)), spot)).radiance[0] > 0.0
}

/// Lamp at (0, 5), thin edge x = βt at height 2, floor at 0: at floor time t the shadow's edge X solves
/// 0.6 X = β[t - √((0.4 X)² + 4)].
#[test]
fn shadow_edge_of_a_moving_occluder_lags_behind() {
    for (t, expected) in [(0.0, -1.767_767), (5.0, 2.328_177)] {
        // The screen reaches from its edge, which passes x = 0 at t = 0, to one side.
        for side in [-1.0, 1.0] {
            let screen = Body::new(&built(square()), black()).sized(40.0);
            let screen = screen.mapped(glam::DAffine3::from_translation(v(40.0 * side, 0.0, 0.0)));
            let screen = screen.mapped(glam::DAffine3::from_quat(turn()));
            let screen = screen.at(0.0, turn() * v(0.0, 0.0, 2.0)).moving(speed(0.5, turn() * DVec3::X));
            let lamp = Lantern::at(0.0, turn() * v(0.0, 0.0, 5.0), flat(1.0));
            let scene = Stage::of([floor(), screen]).lit_by([lamp]).scene();
            let border =
                edge(expected - 5.0 * side, expected + 5.0 * side, |x| lit(&scene, t, v(x, 0.0, 0.0)));
            near(border, expected, 5.1e-7);
            let solves = 0.5 * (t - ((0.4 * border).powi(2) + 4.0).sqrt()) - 0.6 * border;
            near(solves, 0.0, 1e-9);
        }
    }
}

/// A moving ball is a flattened one in the lab: whether the light from a moving lamp passes it is a quadratic.
#[test]
fn ball_shades_what_the_light_would_have_reached_through_it() {
    let mut dice = Dice(12);
    let ball = built(icosphere(6));
    let (mut shaded, mut open) = (0, 0);
    for _ in 0..60 {
        let [ball_moves, lamp_moves] =
            [dice.between(0.3, 0.95), dice.between(0.0, 0.9)].map(|b| dice.velocity(b));
        let ball_starts = v(0.0, 0.0, 2.5) + dice.in_cube() * 0.5;
        let lamp_starts = v(0.0, 0.0, 6.0) + dice.in_cube() * 0.5;
        let ball_path = |t: f64| ball_starts + ball_moves.beta() * t;
        let lamp_path = |t: f64| lamp_starts + lamp_moves.beta() * t;
        let lab = |velocity: Velocity| Velocity::from_proper(turn() * velocity.proper());
        let body = Body::new(&ball, black()).at(0.0, turn() * ball_starts).moving(lab(ball_moves));
        let lamp = Lantern::at(0.0, turn() * lamp_starts, flat(1.0)).moving(lab(lamp_moves));
        let scene = Stage::of([floor(), body]).lit_by([lamp]).scene();
        for _ in 0..40 {
            let place = v(dice.between(-6.0, 6.0), dice.between(-6.0, 6.0), 0.0);
            let t = dice.between(-2.0, 8.0);
            let emitted = emission_time(Event::new(t, place), lamp_path);
            let from = lamp_path(emitted);
            // Squared distance from the ball's centre, in its rest frame, along the light: a quadratic in its way.
            let clearance = |part: f64| {
                let (at, when) = (from.lerp(place, part), emitted + part * (t - emitted));
                let d = at - ball_path(when);
                d.length_squared() + d.dot(ball_moves.proper()).powi(2) - 1.0
            };
            let (a, b, c) = (clearance(0.0), clearance(0.5), clearance(1.0));
            let (square, linear) = (2.0 * (a + c - 2.0 * b), 4.0 * b - 3.0 * a - c);
            let nearest = clearance((-linear / (2.0 * square)).clamp(0.0, 1.0));
            if from.z <= 0.0 || nearest.abs() < 2e-3 || a < 0.0 || c < 0.0 {
                continue;
            }
            // The eye must see the floor, past the ball.
            let spot = Event::new(t, turn() * place);
            let ray = light_to(turn() * (place + v(0.0, 0.0, 1e-3)), spot);
            if scene.lit().first(&ray).is_none_or(|first| first.body != 0) {
                continue;
            }
            let bright = look(&scene, &ray).radiance[0] > 0.0;
            assert_eq!(
                bright,
                nearest > 0.0,
                "ball {ball_moves:?}, lamp {lamp_moves:?}, floor {place} at {t}"
            );
            if bright { open += 1 } else { shaded += 1 }
        }
    }
    assert!(shaded > 100 && open > 500, "{shaded} shaded, {open} open");
}

#[test]
fn body_behind_the_lamp_or_behind_the_surface_casts_no_shadow() {
    let plate = Body::new(&built(square()), black()).mapped(glam::DAffine3::from_quat(turn()));
    let lamp = Lantern::at(0.0, turn() * v(0.0, 0.0, 5.0), flat(1.0));
    for (height, shaded) in
        [(5.01, false), (7.0, false), (-0.01, false), (-3.0, false), (4.99, true), (1.0, true)]
    {
        for moves in [Velocity::REST, speed(0.8, turn() * v(0.0, 1.0, 0.0))] {
            // The light passes the height at -(5 - ...) before it is at the floor at time 0.
            let passes: f64 = -f64::abs(height);
            let body = plate.clone().at(passes, turn() * v(0.0, 0.0, height)).moving(moves);
            let scene = Stage::of([floor(), body]).lit_by([lamp.clone()]).scene();
            assert_eq!(!lit(&scene, 0.0, DVec3::ZERO), shaded, "height {height}, {moves:?}");
        }
    }
}

/// A body stands in the way of parallel light from any distance.
#[test]
fn sun_is_shaded_from_any_distance() {
    let sun = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: turn() * v(0.6, 0.0, -0.8) });
    for distance in [1.0, 1e3, 1e6] {
        let moves = speed(0.5, turn() * DVec3::Y);
        let body = Body::new(&built(cube()), black()).at(-distance, turn() * v(-0.6, 0.0, 0.8) * distance);
        let scene = Stage::of([floor(), body.moving(moves)]).lit_by([sun.clone()]).scene();
        assert!(!lit(&scene, 0.0, DVec3::ZERO));
        // It is elsewhere at another time.
        assert!(lit(&scene, 10.0, DVec3::ZERO));
    }
}

/// What faces a sun of its own rest frame is lit, what does not is dark: at every size, speed and distance.
#[test]
fn own_back_is_dark_and_convex_bodies_do_not_shade_themselves() {
    let (ball, mut dice) = (built(icosphere(5)), Dice(8));
    for (size, speed, far) in [
        (1.0, 0.0, 0.0),
        (1e-4, 0.9, 0.0),
        (1.0, 0.9, 1e6),
        (1e5, 0.9, 0.0),
        (1.0, 0.999, 1e3),
        (1e3, 0.999_99, 1e6),
    ] {
        let velocity = dice.velocity(speed);
        let start: Event = Event::new(0.3 * far, v(-0.6, 0.0, 0.8) * far);
        let ball = Body::new(&ball, diffuse(0.5)).sized(size).at(start.t, start.x).moving(velocity);
        let sun =
            Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: DVec3::NEG_Z }).moving(velocity);
        let scene = Stage::of([ball]).lit_by([sun]).scene();
        let into = scene.world.frames[0].rest_from_lab;
        for _ in 0..3000 {
            let n = dice.direction();
            let eye = (n * 3.0 + dice.in_cube() * 0.3) * size;
            let ray = light_at_rest(&into, n * size, Event::new(dice.part() * size, eye));
            if n.z.abs() > 0.05 {
                assert_eq!(is_bright(&scene, &ray), n.z > 0.0, "size {size}, speed {speed}, {n}");
            }
        }
    }
}

/// Walls that meet at an edge: the light of a lamp in the middle reaches every place of the room.
#[test]
fn lamp_in_the_middle_reaches_every_corner_of_its_room() {
    let (room, mut dice) = (built(cube()), Dice(40));
    for speed in [0.0, 0.6, 0.99] {
        let velocity = dice.velocity(speed);
        let start: Event = Event::new(3.0, v(100.0, -20.0, 7.0));
        let body =
            Body::new(&room, diffuse(0.5)).stretched(v(3.0, 1.0, 20.0)).at(start.t, start.x).moving(velocity);
        let lamp = Lantern::at(start.t, start.x, flat(1.0)).moving(velocity);
        let scene = Stage::of([body]).lit_by([lamp]).scene();
        let into = scene.world.frames[0].rest_from_lab;
        for i in 0..6000 {
            let mut place = dice.in_cube();
            place[i % 3] = place[i % 3].signum();
            if i % 2 == 0 {
                // Very near another wall.
                let near = (i / 2 + 1) % 3;
                place[near] = place[near].signum() * (1.0 - libm::pow(10.0, -dice.between(2.0, 12.0)));
            }
            let place = place * v(3.0, 1.0, 20.0);
            let eye = dice.in_cube() * v(2.9, 0.9, 19.0);
            let ray = light_at_rest(&into, place, Event::new(0.0, eye));
            assert!(is_bright(&scene, &ray), "{place} is dark at {speed}");
        }
    }
}
