//! Light takes time: moving things are seen where they were.
//!
//! ~~~text
//! tₑ = γ² [tₒ + β x₀ - √((β tₒ + x₀)² + ρ²/γ²)]        x_app = x₀ + β tₑ
//! ~~~
//!
//! for something at x = x₀ + βt, a distance ρ beside the observer, seen at tₒ. Müller and Boblest 2014.

use crate::support::{
    Body, Dice, Stage, beta, black_body, built, close, cube, emission_time, first, glowing, icosphere,
    light_from, near, near_vector, speed, v,
};
use glam::{DQuat, DVec3};
use terrell::spacetime::{Event, Velocity};

/// Every scene is turned by this, so that no axis is special.
fn turn() -> DQuat {
    DQuat::from_axis_angle(v(1.0, 2.0, -2.0) / 3.0, 0.8)
}

fn dot(radius: f64) -> Body {
    Body::new(&built(icosphere(2)), glowing(black_body(5000.0))).sized(radius)
}

#[test]
fn bodies_are_seen_where_they_were() {
    let table = [
        (
            0.3,
            [
                (-10.0, -15.545_146, -4.663_544),
                (0.0, -3.144_855, -0.943_456),
                (5.0, 1.943_847, 0.583_154),
                (10.0, 6.432_876, 1.929_863),
            ],
        ),
        (
            0.6,
            [
                (-10.0, -25.722_184, -15.433_310),
                (0.0, -3.75, -2.25),
                (5.0, 1.809_571, 1.085_743),
                (10.0, 5.527_816, 3.316_690),
            ],
        ),
        (
            0.8,
            [
                (-10.0, -50.555_556, -40.444_444),
                (0.0, -5.0, -4.0),
                (5.0, 1.704_604, 1.363_683),
                (10.0, 5.0, 4.0),
            ],
        ),
    ];
    let small = 1e-6;
    for (b, row) in table {
        for (seen_at, emitted, apparent) in row {
            let gamma_squared: f64 = 1.0 / (1.0 - b * b);
            let formula =
                gamma_squared * (seen_at - (b * seen_at * b * seen_at + 9.0 / gamma_squared).sqrt());
            near(formula, emitted, 5.1e-7);
            near(b * formula, apparent, 5.1e-7);
            let body = dot(small).at(0.0, turn() * v(0.0, 3.0, 0.0)).moving(speed(b, turn() * DVec3::X));
            let scene = Stage::of([body]).scene();
            let place = turn() * v(b * formula, 3.0, 0.0);
            let eye = Event::new(seen_at, DVec3::ZERO);
            let hit = first(&scene, &light_from(place, eye));
            near(hit.emission.t, formula, 3.0 * small);
            near_vector(hit.emission.x, place, 3.0 * small);
            // Where it "is" there is nothing.
            assert!(
                scene.lit().first(&light_from(turn() * v(b * seen_at, 3.0, 0.0), eye)).is_none()
                    || seen_at == 0.0 && b < 1e-9
            );
        }
    }
}

/// Not along an axis, not through the origin, at any speed: the past light cone alone decides.
#[test]
fn past_light_cone_finds_every_body() {
    let (mut dice, small) = (Dice(21), 1e-5);
    let mesh = built(icosphere(2));
    for _ in 0..300 {
        let velocity = Velocity::from_gamma(1.0 + libm::exp(dice.between(-3.0, 4.6)), dice.direction());
        let start: Event = Event::new(dice.between(-5.0, 5.0), dice.in_cube() * 6.0);
        let eye = Event::new(dice.between(-3.0, 9.0), dice.in_cube() * 9.0);
        let path = |t: f64| start.x + velocity.beta() * (t - start.t);
        let emitted = emission_time(eye, path);
        let body =
            Body::new(&mesh, glowing(black_body(5000.0))).sized(small).at(start.t, start.x).moving(velocity);
        let scene = Stage::of([body]).scene();
        let hit = first(&scene, &light_from(path(emitted), eye));
        // The ray passes the centre; the surface is a radius before it, in the rest frame.
        let rest = velocity.gamma() * 2.0 * small;
        near(hit.emission.t, emitted, rest);
        near_vector(hit.emission.x, path(emitted), rest);
        // The hit lies on the observer's past light cone.
        close((hit.emission.x - eye.x).length(), eye.t - hit.emission.t, 1e-12);
    }
}

/// A rod of rest length 1 along its motion, far away and nearly end on: √((1 + β)/(1 - β)) long on approach.
#[test]
fn rods_look_longer_on_approach_and_shorter_on_recession() {
    let table = [(0.5, 1.7321, 0.5774), (0.6, 2.0, 0.5), (0.8, 3.0, 0.3333), (0.9, 4.3589, 0.2294)];
    let small = 1e-5;
    for (b, approaching, receding) in table {
        for (sense, expected) in [(-1.0, approaching), (1.0, receding)] {
            let velocity = speed(b, turn() * v(sense, 0.0, 0.0));
            let along = turn() * DVec3::X;
            // Two lights at the ends of the rod, in its rest frame half a metre before and behind, somewhat aside.
            let ends = [-0.5, 0.5].map(|end| {
                let place = turn() * v(end, 0.01 * end, 0.0);
                dot(small)
                    .at(0.0, DVec3::ZERO)
                    .moving(velocity)
                    .mapped(glam::DAffine3::from_translation(place))
            });
            // Seen from the origin's surroundings when it is 1000 m away.
            let seen = ends.map(|end| {
                let place = end.rest_from_mesh.translation;
                let eye = Event::new(1000.0, turn() * v(-1000.0, 0.0, 0.0));
                let (start, beta) = (rest_to_lab(velocity, place), velocity.beta());
                let path = |t: f64| start.x + beta * (t - start.t);
                let target = path(emission_time(eye, path));
                first(&Stage::of([end]).scene(), &light_from(target, eye)).emission.x.dot(along)
            });
            near(seen[1] - seen[0], expected, 2e-4 * expected + 6e-5);
        }
    }
}

/// The lab event of a place in a rest frame that shares the lab's origin, at the rest frame's time zero.
fn rest_to_lab(velocity: Velocity, place: DVec3) -> Event {
    let u = velocity.proper();
    let along = u.dot(place);
    Event::new(along, place + u * (along / (velocity.gamma() + 1.0)))
}

/// β sin θ/(1 - β cos θ), faster than light: βγ at most, where cos θ = β.
#[test]
fn apparent_speed_across_may_exceed_light() {
    let table = [(0.6, 0.75), (0.8, 1.3333), (0.9, 2.0647), (0.99, 7.0179)];
    let distance = 1e6;
    for (b, fastest) in table {
        for (degrees, most) in
            [(libm::acos(b).to_degrees(), true), (70.0, false), (20.0, false), (120.0, false)]
        {
            let (sin, cos) = libm::sincos(f64::to_radians(degrees));
            // The light to the observer goes along +z; the body moves at θ to it.
            let motion = turn() * v(sin, 0.0, cos);
            let scene = Stage::of([dot(1e-3).moving(speed(b, motion))]).scene();
            let across = |seen_at: f64| {
                let eye = Event::new(distance + seen_at, turn() * v(0.0, 0.0, distance));
                let path = |t: f64| motion * (b * t);
                let emission = first(&scene, &light_from(path(emission_time(eye, path)), eye)).emission;
                (turn().inverse() * emission.x).x
            };
            let apparent = (across(50.0) - across(-50.0)) / 100.0;
            close(apparent, b * sin / (1.0 - b * cos), 1e-3);
            if most {
                near(apparent, fastest, 1e-3 * fastest);
            }
        }
    }
}

#[test]
fn apparent_speed_along_the_sight_is_up_to_endless() {
    for b in [0.5, 0.9] {
        for (sense, expected) in [(1.0, b / (1.0 - b)), (-1.0, b / (1.0 + b))] {
            let motion = turn() * v(0.0, 0.0, sense);
            let scene = Stage::of([dot(1e-4).moving(speed(b, motion))]).scene();
            let depth = |seen_at: f64| {
                let eye = Event::new(1000.0 + seen_at, turn() * v(0.0, 0.0, 1000.0));
                let emission = first(&scene, &light_from(DVec3::ZERO, eye)).emission;
                (turn().inverse() * emission.x).z
            };
            close((depth(1.0) - depth(0.0)) * sense, expected, 1e-9);
        }
    }
}

/// A straight line square to its motion is seen as (x/γβd)² - (y/d)² = 1, x < 0, at the moment it passes.
#[test]
fn line_square_to_its_motion_is_seen_as_a_hyperbola() {
    let table = [(0.0_f64, -2.064_742), (1.0, -2.919_986), (2.0, -4.616_903), (5.0, -10.528_158)];
    let thin = 1e-4;
    let rod = Body::new(&built(cube()), glowing(black_body(5000.0))).stretched(v(thin, 30.0, thin));
    let rod = rod.mapped(glam::DAffine3::from_quat(turn())).at(0.0, turn() * v(0.0, 0.0, 1.0));
    let scene = Stage::of([rod.moving(speed(0.9, turn() * DVec3::X))]).scene();
    let gamma = 1.0 / (1.0 - 0.81_f64).sqrt();
    for (y, x) in table {
        near(x, -0.9 * gamma * (1.0 + y * y).sqrt(), 5e-7);
        let seen = |x: f64| scene.lit().first(&light_from(turn() * v(x, y, 1.0), Event::ORIGIN));
        let hit = seen(x).unwrap();
        near_vector(turn().inverse() * hit.emission.x, v(x, y, 1.0), 20.0 * thin);
        // Nothing a little beside it, and nothing where the straight line is.
        assert!(seen(x + 0.01).is_none() && seen(x - 0.01).is_none() && seen(0.0).is_none());
    }
}

/// Lines along the motion stay straight: their points are only seen at other times.
#[test]
fn line_along_its_motion_stays_straight() {
    let rod = Body::new(&built(cube()), glowing(black_body(5000.0))).stretched(v(40.0, 1e-4, 1e-4));
    let rod = rod.mapped(glam::DAffine3::from_quat(turn())).at(0.0, turn() * v(0.0, 2.0, 1.0));
    let scene = Stage::of([rod.moving(speed(0.8, turn() * DVec3::X))]).scene();
    for x in [-7.0, -3.0, 0.0, 2.0] {
        let hit = first(&scene, &light_from(turn() * v(x, 2.0, 1.0), Event::ORIGIN));
        near_vector(turn().inverse() * hit.emission.x, v(x, 2.0, 1.0), 2e-3);
    }
}

/// The far side is seen earlier: a plane square to its motion becomes a hyperboloid.
#[test]
fn plane_square_to_its_motion_is_seen_as_a_hyperboloid() {
    let velocity = beta(0.0, 0.0, 0.6);
    let wall = crate::support::square();
    let wall = Body::new(&built(wall), glowing(black_body(5000.0))).sized(100.0).moving(velocity);
    let scene = Stage::of([wall]).scene();
    for (x, y) in [(0.0_f64, 0.0), (3.0, -1.0), (5.0, 12.0)] {
        // At z = 0.6 t, seen from z = 2 at t = 0: 0.6 t is met when (2 - 0.6 t)² + x² + y² = t².
        let eye = Event::new(0.0, v(0.0, 0.0, 2.0));
        let half = 0.6 * 2.0;
        let t = (-half - (half * half + 0.64 * (4.0 + x * x + y * y)).sqrt()) / 0.64;
        let hit = first(&scene, &light_from(v(x, y, 0.6 * t), eye));
        near_vector(hit.emission.x, v(x, y, 0.6 * t), 1e-9);
        near(hit.emission.t, t, 1e-9);
    }
}
