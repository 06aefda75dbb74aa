//! The look of moving bodies: spheres stay round, cubes look turned. Terrell 1959, Penrose 1959.

use crate::support::{
    Body, Stage, black_body, built, cube, edge, emission_time, first, glowing, icosphere, light_from, near,
    near_vector, speed, v,
};
use glam::{DMat3, DQuat, DVec3};
use terrell::scene::Scene;
use terrell::spacetime::{Event, SightRay};

/// The axis and the half angle of the cone that fits unit vectors best: the plane they lie in.
pub(crate) fn fitted_cone(directions: &[DVec3]) -> (DVec3, f64, f64) {
    let mean = directions.iter().sum::<DVec3>() / directions.len() as f64;
    // The plane's normal: what all differences are square to.
    let mut spread = DMat3::ZERO;
    for n in directions {
        let d = *n - mean;
        spread += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    // Repeated inversion brings out the least direction.
    let nudge = DMat3::from_diagonal(DVec3::splat(1e-12));
    let inverse = (spread + nudge).inverse();
    let axis = (0..60).fold(mean / mean.length(), |axis, _| {
        let next = inverse * axis;
        next / next.length()
    });
    let axis = if axis.dot(mean) < 0.0 { -axis } else { axis };
    let cos = axis.dot(mean);
    let residual = directions.iter().map(|n| (n.dot(axis) - cos).abs()).fold(0.0, f64::max);
    (axis, libm::acos(cos), residual)
}

/// The outline of what is seen around the direction `inside`, by halving between hit and miss.
pub(crate) fn outline(scene: &Scene, eye: Event, inside: DVec3, points: u32) -> Vec<DVec3> {
    let inside = inside / inside.length();
    let side = inside.any_orthonormal_vector();
    let direction = |around: f64, off: f64| {
        let (sin, cos) = libm::sincos(off);
        inside * cos + DQuat::from_axis_angle(inside, around) * side * sin
    };
    let ray = |n: DVec3| light_from(eye.x + n, eye);
    (0..points)
        .map(|i| {
            let around = f64::from(i) * std::f64::consts::TAU / f64::from(points);
            let meets = |off: f64| scene.world.nearest(&ray(direction(around, off))).is_some();
            direction(around, edge(0.0, 0.9, meets))
        })
        .collect()
}

/// R = 1, centre (βt, 5, 0), seen from the origin: half angle, and the circle's centre from +y towards +x, degrees.
#[test]
fn sphere_outline_stays_a_circle() {
    let table = [
        (0.5, [(0.0, 10.0250, -29.4962), (5.0, 11.5364, 0.5773), (10.0, 10.4727, 24.6555)]),
        (0.8, [(0.0, 6.9825, -52.5672), (5.0, 11.5355, 0.9200), (10.0, 9.6246, 33.2843)]),
        (0.9, [(0.0, 5.0845, -63.6964), (5.0, 11.5351, 1.0332), (10.0, 9.3826, 35.3997)]),
    ];
    let turn = DQuat::from_axis_angle(v(2.0, 3.0, 6.0) / 7.0, 2.0);
    let ball = Body::new(&built(icosphere(6)), glowing(black_body(5000.0))).at(0.0, turn * v(0.0, 5.0, 0.0));
    for (beta, row) in table {
        let scene = Stage::of([ball.clone().moving(speed(beta, turn * DVec3::X))]).scene();
        for (seen_at, half_angle, centre) in row {
            let eye = Event::new(seen_at, DVec3::ZERO);
            let path = |t: f64| turn * v(beta * t, 5.0, 0.0);
            let seen = outline(&scene, eye, path(emission_time(eye, path)), 200);
            let (axis, angle, residual) = fitted_cone(&seen);
            let axis = turn.inverse() * axis;
            // The facets cut the sphere's edge by up to h²/8 of it, h = 0.02.
            near(angle.to_degrees(), half_angle, 1e-3);
            near(libm::atan2(axis.x, axis.y).to_degrees(), centre, 1e-3);
            near(axis.z, 0.0, 1e-5);
            assert!(residual < 1.5e-5, "not round: {residual:e}");
        }
    }
}

/// The finer the mesh, the rounder: each halving of the edges leaves a quarter of the error.
#[test]
fn mesh_sphere_converges_with_the_square_of_its_edges() {
    let errors = [2, 3, 4, 5].map(|level| {
        let ball = Body::new(&built(icosphere(level)), glowing(black_body(5000.0)));
        let scene = Stage::of([ball.at(0.0, v(0.0, 5.0, 0.0)).moving(speed(0.8, v(1.0, 0.0, 0.0)))]).scene();
        let seen = outline(&scene, Event::ORIGIN, v(-20.0 / 3.0, 5.0, 0.0), 400);
        let (_, angle, _) = fitted_cone(&seen);
        (6.982_5 - angle.to_degrees()).abs()
    });
    for pair in errors.windows(2).take(2) {
        assert!((3.4..4.7).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    assert!(errors[3] < 0.006, "{errors:?}");
}

/// What is inside the outline is turned: the spot of the sphere that is seen in the middle is another one.
#[test]
fn sphere_passing_by_shows_its_trailing_side() {
    let (beta, distance) = (0.8, 1e4);
    let ball = Body::new(&built(icosphere(5)), glowing(black_body(5000.0)));
    let ball = ball.at(-distance, v(0.0, distance, 0.0)).moving(speed(beta, DVec3::X));
    let scene = Stage::of([ball]).scene();
    let ray = light_from(v(0.0, distance, 0.0), Event::ORIGIN);
    let hit = scene.world.nearest(&ray).unwrap();
    // Turned by arcsin β: the normal there points back by that from the line of sight.
    near_vector(hit.spot(&ray).normal, v(-beta, -0.6, 0.0), 3e-3);
}

/// A cube of side 1, far away, whose light leaves square to its motion: front L/γ wide, trailing side Lβ: that of a
/// cube at rest turned by arcsin β.
#[test]
fn cube_passing_by_looks_turned() {
    let distance = 1e6;
    for (beta, front, trailing, degrees) in [
        (0.5, 0.75_f64.sqrt(), 0.5, 30.0),
        (0.6, 0.8, 0.6, 36.870),
        (0.8, 0.6, 0.8, 53.130),
        (0.9, 0.435_89, 0.9, 64.158),
        (0.99, 0.141_07, 0.99, 81.890),
    ] {
        near(libm::asin(beta).to_degrees(), degrees, 5.1e-4);
        let moving = Body::new(&built(cube()), glowing(black_body(5000.0))).sized(0.5);
        let moving = moving.at(-distance, v(0.0, distance, 0.0));
        let turned = moving.clone().mapped(glam::DAffine3::from_rotation_z(libm::asin(beta)));
        let turned = Stage::of([turned]).scene();
        let moving = Stage::of([moving.moving(speed(beta, DVec3::X))]).scene();
        let ray = |x: f64| light_from(v(x, distance, 0.1), Event::ORIGIN);
        // Edges, from left to right: trailing side, front, nothing.
        let edges = |scene: &Scene, side: DVec3| {
            let shows = |ray: SightRay, normal: DVec3| {
                let hit = scene.world.nearest(&ray);
                hit.is_some_and(|hit| (hit.spot(&ray).facet_normal - normal).length() < 1e-6)
            };
            let meets = |x: f64| scene.world.nearest(&ray(x)).is_some();
            let left = edge(0.0, -2.0, meets);
            let right = edge(0.0, 2.0, meets);
            let corner = edge(left + 1e-5, right - 1e-5, |x| shows(ray(x), side));
            (corner - left, right - corner)
        };
        let (got_trailing, got_front) = edges(&moving, DVec3::NEG_X);
        near(got_front, front, 1e-5);
        near(got_trailing, trailing, 1e-5);
        let (turned_trailing, turned_front) = edges(&turned, v(-libm::cos(libm::asin(beta)), -beta, 0.0));
        near(got_front, turned_front, 1e-5);
        near(got_trailing, turned_trailing, 1e-5);
    }
}

/// Each of a row of dice is turned by its own viewing angle; all their corners are where the past light cone says.
#[test]
fn dice_in_a_row_are_each_seen_at_their_own_time() {
    let beta = 0.9;
    let velocity = speed(beta, DVec3::X);
    let die = built(cube());
    for place in [-12.0, -4.0, 0.0, 4.0, 12.0] {
        let body = Body::new(&die, glowing(black_body(5000.0))).sized(0.5);
        let body = body.at(0.0, v(place, 4.0, 0.0)).moving(velocity);
        let scene = Stage::of([body]).scene();
        let eye = Event::new(3.0, v(0.0, 0.0, 1.0));
        // The corners of the near side are all seen.
        for corner in [v(-0.5, -0.5, 0.5), v(-0.5, -0.5, -0.5), v(0.5, -0.5, 0.5), v(0.5, -0.5, -0.5)] {
            let inward = v(corner.x * (1.0 - 1e-7), corner.y, corner.z * (1.0 - 1e-7));
            let path = |t: f64| v(place + inward.x / velocity.gamma() + beta * t, 4.0 + inward.y, inward.z);
            let emitted = emission_time(eye, path);
            let hit = first(&scene, &light_from(path(emitted), eye));
            near(hit.emission.t, emitted, 1e-9);
            near_vector(hit.emission.x, path(emitted), 1e-9);
        }
    }
}
