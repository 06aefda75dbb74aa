//! Where and how moving bodies are seen: each at the event from which its light arrives.

use super::balls::{
    far_ball_is_seen_turned, outline_of_a_ball_is_the_circle_of_penrose,
    outline_of_a_passing_ball_is_that_of_the_table, texture_of_a_ball_is_seen_where_its_light_left,
};
use super::{FORWARD, Worst, chapter, gamma, seen_by};
use crate::support::{
    Body, Dice, Eye, Stage, along, angle, ball, black, black_body, built, cube, edge, emission_time, first,
    glowing, light_from, plane, speed, v,
};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use terrell::scene::Scene;
use terrell::spacetime::Event;

chapter! {
    "Shapes and places":
    outline_of_a_ball_is_the_circle_of_penrose, "V4", "rim n·c = √(1 − R²/d²) in its rest frame, boosted as a plane; any observer", "Penrose 1959; Boas 1961", 1e-11;
    outline_of_a_passing_ball_is_that_of_the_table, "V4", "half angle and centre of its circle at 0.5, 0.8, 0.9 c (degrees, four decimals), all in one plane", "Penrose 1959", 6e-5;
    texture_of_a_ball_is_seen_where_its_light_left, "V4, V7", "V7 for points of the ball; longitude and latitude there, radians", "Penrose 1959", 1e-7;
    far_ball_is_seen_turned, "V4, V5, V8", "by θ − θ′ with cos θ′ = (cos θ − β)/(1 − β cos θ): arcsin β at 90°", "Terrell 1959", 1e-8;
    far_cube_is_seen_turned, "V5", "front L/γ, trailing side Lβ: the cube at rest turned by arcsin β", "Terrell 1959; Weisskopf 1960", 1e-5;
    far_dice_in_a_row_are_seen_turned_by_their_angle, "V5, V6, V8", "sides L sin θ′ and L |cos θ′|, apart by L₀ sin θ′: cos θ′ = (cos θ − β)/(1 − β cos θ)", "Terrell 1959; Kraus", 1e-5;
    approaching_rods_are_long_and_receding_ones_short, "V6", "L √((1±β)/(1∓β))", "Lampa 1924", 1e-10;
    apparent_speed_goes_by_the_angle, "V6", "β sin θ/(1 − β cos θ) across, β cos θ/(1 − β cos θ) along", "Rees 1966", 1e-6;
    fastest_apparent_speed_is_at_the_angle_of_beaming, "V6", "βγ at cos θ = β", "Rees 1966", 1e-8;
    bodies_are_seen_where_they_were, "V7", "t = γ²[tₒ + βx₀ − √((βtₒ + x₀)² + ρ²/γ²)], x = x₀ + βt", "Müller & Boblest 2014", 1e-8;
    line_square_to_its_motion_is_a_hyperbola, "V8", "(x/γβd)² − (y/d)² = 1, x < 0", "Kraus", 1e-8;
    line_along_its_motion_is_straight, "V8", "y and z stay", "Kraus", 1e-9;
    plane_square_to_its_motion_is_a_hyperboloid, "V8", "z = βt, (z − zₒ)² + x² + y² = t²", "Müller & Boblest 2014", 1e-11;
    edges_of_dice_in_a_row_are_where_light_left_them, "V8", "V7 for points of the edges; pixels of a picture 1000 wide", "Kraus", 1e-10;
}

pub(super) const SPEEDS: [f64; 7] = [0.1, 0.3, 0.5, 0.6, 0.8, 0.9, 0.99];
/// For the dots that stand for points.
const SMALL: f64 = 1e-10;

pub(super) fn turn() -> DQuat {
    DQuat::from_axis_angle(v(1.0, 2.0, -2.0) / 3.0, 0.8)
}

fn dot() -> Body {
    Body::of(ball(SMALL, DVec3::ZERO), black())
}

/// Far enough away for its light to be parallel.
pub(super) const FAR: f64 = 1e6;

/// Widths of the left and of the right visible side of a far cube.
fn sides(scene: &Scene, left_normal: DVec3) -> (f64, f64) {
    let ray = |x: f64| light_from(v(x, FAR, 0.1), Event::ORIGIN);
    let meets = |x: f64| scene.world.nearest(&ray(x)).is_some();
    let (left, right) = (edge(0.0, -2.0, meets), edge(0.0, 2.0, meets));
    let on_left = |x: f64| {
        let hit = scene.world.nearest(&ray(x));
        hit.is_some_and(|hit| (hit.spot(&ray(x)).facet_normal - left_normal).length() < 1e-6)
    };
    let corner = edge(left + 1e-6, right - 1e-6, on_left);
    (corner - left, right - corner)
}

fn far_cube_is_seen_turned() -> f64 {
    let mut worst = Worst::default();
    let die = built(cube());
    for b in SPEEDS {
        let body = Body::new(&die, glowing(black_body(5000.0))).sized(0.5).at(-FAR, v(0.0, FAR, 0.0));
        let turned = body.clone().mapped(DAffine3::from_rotation_z(libm::asin(b)));
        let (trailing, front) = sides(&Stage::of([body.moving(speed(b, DVec3::X))]).scene(), DVec3::NEG_X);
        worst.apart(trailing, b);
        worst.apart(front, 1.0 / gamma(b));
        let (left, right) = sides(&Stage::of([turned]).scene(), v(-1.0 / gamma(b), -b, 0.0));
        worst.apart(trailing, left);
        worst.apart(front, right);
    }
    worst.0
}

/// Sides of 0.4, 1.5 from one to the next in their rest frame; they move along x, and the light that leaves them at θ to
/// that goes to the origin.
fn far_dice_in_a_row_are_seen_turned_by_their_angle() -> f64 {
    let mut worst = Worst::default();
    let (die, half, apart) = (built(cube()), 0.2, 1.5);
    // The row is longer than a die.
    let far = 20.0 * FAR;
    for b in SPEEDS {
        for at_rest in [0.5, 1.0, FRAC_PI_2, 2.0, 2.6] {
            let (sin, cos) = libm::sincos(at_rest);
            let theta = libm::acos((cos + b) / (1.0 + b * cos));
            let place = v(-libm::cos(theta), -libm::sin(theta), 0.0) * far;
            let across = v(libm::sin(theta), -libm::cos(theta), 0.0);
            let bodies = (-2..=2).map(|number| {
                let body = Body::new(&die, black()).sized(half);
                let body = body.mapped(DAffine3::from_translation(DVec3::X * (apart * f64::from(number))));
                let body = body.mapped(DAffine3::from_quat(turn())).at(-far, turn() * place);
                body.moving(speed(b, turn() * DVec3::X))
            });
            let scene = Stage::of(bodies).scene();
            let ray = |x: f64| light_from(turn() * (place + across * x + v(0.0, 0.0, 0.05)), Event::ORIGIN);
            for number in 0..5_u32 {
                let is_there =
                    |x: f64| scene.world.nearest(&ray(x)).is_some_and(|hit| hit.placed.body == number);
                let on_end = |x: f64| {
                    let hit = scene.world.nearest(&ray(x));
                    hit.is_some_and(|hit| (turn().inverse() * hit.spot(&ray(x)).facet_normal).x.abs() > 0.5)
                };
                let middle = (f64::from(number) - 2.0) * apart * sin;
                let wide = half * (sin + cos.abs());
                for side in [-1.0, 1.0] {
                    let end = middle + side * wide;
                    worst.apart(edge(middle, end + 0.05 * side, is_there), end);
                }
                // What approaches shows its front end on the far side, what recedes its other end on the near side.
                let side = cos.signum();
                let corner = middle + half * (side * sin - cos);
                if cos.abs() > 0.1 {
                    let inside = 1e-4 * side;
                    worst.apart(
                        edge(middle + side * wide - inside, middle - side * wide + inside, on_end),
                        corner,
                    );
                }
            }
        }
    }
    worst.0
}

fn approaching_rods_are_long_and_receding_ones_short() -> f64 {
    let mut worst = Worst::default();
    let along = turn() * DVec3::X;
    for b in SPEEDS {
        for sense in [-1.0, 1.0] {
            // The ends of a rod of length 1, one behind the other: each is looked at by itself.
            let seen = [-0.5, 0.5].map(|end| {
                let dot = dot().mapped(DAffine3::from_translation(along * end));
                let scene = Stage::of([dot.moving(speed(b, along * sense))]).scene();
                let eye = Event::new(100.0, along * -500.0);
                first(&scene, &light_from(DVec3::ZERO, eye)).emission.x.dot(along)
            });
            let stretch = ((1.0 - sense * b) / (1.0 + sense * b)).sqrt();
            worst.part(seen[1] - seen[0], stretch);
        }
    }
    worst.0
}

/// Across and along the line of sight, as a distant eye sees it: a dot that moves at θ to its light.
fn apparent_velocity(b: f64, theta: f64) -> (f64, f64) {
    let distance = 1e5;
    let (sin, cos) = libm::sincos(theta);
    let motion = turn() * v(sin, 0.0, cos);
    let scene = Stage::of([Body::of(ball(1e-5, DVec3::ZERO), black()).moving(speed(b, motion))]).scene();
    let place = |seen_at: f64| {
        let eye = Event::new(distance + seen_at, turn() * v(0.0, 0.0, distance));
        let path = |t: f64| motion * (b * t);
        turn().inverse() * first(&scene, &light_from(path(emission_time(eye, path)), eye)).emission.x
    };
    let step = (place(5.0) - place(-5.0)) / 10.0;
    (step.x, step.z)
}

fn apparent_speed_goes_by_the_angle() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        for theta in [0.0, 0.3, 1.0, 1.6, 2.4, PI] {
            let (across, along) = apparent_velocity(b, theta);
            let (sin, cos) = libm::sincos(theta);
            let pace = b / (1.0 - b * cos);
            worst.error((across - pace * sin).abs().max((along - pace * cos).abs()) / pace.max(1.0).powi(2));
        }
    }
    worst.0
}

fn fastest_apparent_speed_is_at_the_angle_of_beaming() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let theta = libm::acos(b);
        worst.part(apparent_velocity(b, theta).0, b * gamma(b));
        // And no faster beside it.
        for off in [-0.05, 0.05] {
            worst.must(apparent_velocity(b, theta + off).0 < b * gamma(b));
        }
    }
    worst.0
}

fn bodies_are_seen_where_they_were() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(70));
    for b in SPEEDS {
        for _ in 0..60 {
            let (start, beside) = (dice.between(-5.0, 5.0), dice.between(0.5, 5.0));
            let seen_at = dice.between(-10.0, 10.0);
            let (sin, cos) = libm::sincos(dice.between(0.0, TAU));
            let at = |x: f64| turn() * v(x, beside * cos, beside * sin);
            let g = gamma(b);
            let ahead = b * seen_at + start;
            let emitted = g * g * (seen_at + b * start - (ahead * ahead + beside * beside / (g * g)).sqrt());
            let scene = Stage::of([dot().at(0.0, at(start)).moving(speed(b, turn() * DVec3::X))]).scene();
            let place = at(start + b * emitted);
            let found = scene.lit().first(&light_from(place, Event::new(seen_at, DVec3::ZERO)));
            worst.must(found.is_some());
            if let Some(found) = found {
                worst.apart(found.emission.t, emitted);
                worst.places(found.emission.x, place);
            }
        }
    }
    worst.0
}

/// A point that passes (0, y, d) at zero, seen from the origin then.
fn line_square_to_its_motion_is_a_hyperbola() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        for d in [0.5, 1.0, 3.0] {
            for y in [-5.0, -1.0, 0.0, 0.3, 2.0, 5.0_f64] {
                let place = turn() * v(-gamma(b) * b * (d * d + y * y).sqrt(), y, d);
                let body = dot().at(0.0, turn() * v(0.0, y, d)).moving(speed(b, turn() * DVec3::X));
                let found = Stage::of([body]).scene().lit().first(&light_from(place, Event::ORIGIN));
                worst.must(found.is_some());
                found.iter().for_each(|found| worst.places(found.emission.x, place));
            }
        }
    }
    worst.0
}

/// Points of the line at rest-frame places x, all seen at one event.
fn line_along_its_motion_is_straight() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(71));
    for b in SPEEDS {
        let moves = speed(b, turn() * DVec3::X);
        for _ in 0..20 {
            let x = dice.between(-20.0, 20.0);
            // Seen first in any direction: the line's image lies in the plane through the line.
            let path = |t: f64| turn() * v(x + b * t, 2.0, 1.0);
            let eye = Event::new(dice.between(-3.0, 3.0), DVec3::ZERO);
            let scene = Stage::of([dot().at(0.0, path(0.0)).moving(moves)]).scene();
            let found = first(&scene, &light_from(path(emission_time(eye, path)), eye));
            let seen = turn().inverse() * found.emission.x;
            worst.apart(seen.y, 2.0);
            worst.apart(seen.z, 1.0);
        }
    }
    // What differs is the dot's own size.
    worst.0
}

fn plane_square_to_its_motion_is_a_hyperboloid() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(72));
    for b in SPEEDS {
        for sense in [-1.0, 1.0] {
            let wall = Body::of(plane(DVec3::ZERO, turn() * DVec3::Z), black());
            let scene = Stage::of([wall.moving(speed(b, turn() * DVec3::Z * sense))]).scene();
            for _ in 0..20 {
                let (x, y) = (dice.between(-9.0, 9.0), dice.between(-9.0, 9.0));
                // (z - 2)² + x² + y² = t² with z = ±βt.
                let (half, whole) = (-2.0 * sense * b, 4.0 + x * x + y * y);
                let t = (half - (half * half + (1.0 - b * b) * whole).sqrt()) / (1.0 - b * b);
                let place = turn() * v(x, y, sense * b * t);
                let found = first(&scene, &light_from(place, Event::new(0.0, turn() * v(0.0, 0.0, 2.0))));
                worst.part(found.emission.t, t);
                worst.error((found.emission.x - place).length() / t.abs());
            }
        }
    }
    worst.0
}

/// The near sides of a row of dice: points of their edges are where the past light cone has them, to a part of a pixel.
fn edges_of_dice_in_a_row_are_where_light_left_them() -> f64 {
    let mut worst = Worst::default();
    let eye = Eye::at(3.0, v(0.0, 0.0, 1.0)).toward(v(-0.9, 0.4, 0.0)).wide(100.0);
    let view = eye.observer().view(0.0, 1000, 700);
    let corners = [v(-0.5, -0.5, -0.5), v(0.5, -0.5, -0.5), v(0.5, -0.5, 0.5), v(-0.5, -0.5, 0.5)];
    let mut met = 0;
    for b in SPEEDS {
        for place in [-12.0, -8.0, -4.0, 0.0, 4.0] {
            let body = Body::new(&built(cube()), black()).sized(0.5).at(0.0, v(place, 4.0, 0.0));
            let scene = Stage::of([body.moving(speed(b, DVec3::X))]).seen_by(&eye);
            // By V7, from a place in the rest frame.
            let image = |rest: DVec3| {
                let path = |t: f64| v(place + rest.x / gamma(b) + b * t, 4.0 + rest.y, rest.z);
                view.pixel_of(light_from(path(emission_time(eye.origin, path)), eye.origin).k)
            };
            let shows = |pixel: DVec2| {
                let ray = view.ray(pixel);
                let hit = scene.world.nearest(&ray);
                hit.is_some_and(|hit| (hit.spot(&ray).facet_normal - DVec3::NEG_Y).length() < 1e-6)
            };
            for i in 0..20 {
                let (from, to) = (corners[i % 4], corners[(i + 1) % 4]);
                let part = 0.07 + 0.21 * (i / 4) as f64;
                let [at, next, middle] =
                    [from.lerp(to, part), from.lerp(to, part + 1e-4), v(0.0, -0.5, 0.0)].map(image);
                let (Some(at), Some(next), Some(middle)) = (at, next, middle) else { continue };
                let across = (next - at).perp().normalize();
                let across = across * across.dot(middle - at).signum();
                if (middle - at).dot(across) > 2.0 {
                    met += 1;
                    let inside = |off: f64| shows(at + across * off);
                    worst.edge(0.1, inside);
                }
            }
        }
    }
    worst.must(met > 300);
    worst.0
}

/// What `along` of the support says is what the textbook's boost says (the laws here use both).
#[test]
fn textbook_boost_aberrates_as_the_support_does() {
    let moves = speed(0.7, FORWARD);
    let n = v(0.36, -0.48, 0.8);
    let (t, x) = seen_by(moves, (1.0, n));
    assert!(angle(x / t, along(moves, n)) < 1e-15);
}
