//! Solids without triangles, as scenes show them.

use crate::support::{
    Body, Dice, Eye, Lantern, Stage, along, angle, ball, beta, black, black_body, close, cuboid, diffuse,
    edge, first, flat, frequency, glowing, is_bright, light_from, light_to, look, near, plane, v,
};
use glam::{DAffine3, DQuat, DVec3};
use terrell::exposure::{Sampling, expose};
use terrell::film::Reconstruction;
use terrell::lamp::Beam;
use terrell::scene::Scene;
use terrell::solid::{Shape, Solid};
use terrell::spacetime::{Event, FourVector, SightRay};
use terrell::spectrum::{Reflectance, Wavelengths, planck};
use terrell::surface::{Checker, Paint, Scatter, Surface};

/// The direction at `angle` from `axis`, turned by `turn` about it.
fn beside(axis: DVec3, angle: f64, turn: f64) -> DVec3 {
    let a = axis.any_orthonormal_vector();
    let (sin, cos) = libm::sincos(angle);
    let (sin_t, cos_t) = libm::sincos(turn);
    axis * cos + (a * cos_t + axis.cross(a) * sin_t) * sin
}

fn arriving(n: DVec3, t: f64) -> SightRay {
    SightRay { event: Event::new(t, DVec3::ZERO), k: FourVector::new(1.0, -n) }
}

/// V4: an exact circle, of a known half width and in a known direction.
#[test]
fn outline_of_a_moving_ball_is_the_circle_of_penrose() {
    let table = [
        (0.5, [(0.0, 10.0250, -29.4962_f64), (5.0, 11.5364, 0.5773), (10.0, 10.4727, 24.6555)]),
        (0.8, [(0.0, 6.9825, -52.5672), (5.0, 11.5355, 0.9200), (10.0, 9.6246, 33.2843)]),
        (0.9, [(0.0, 5.0845, -63.6964), (5.0, 11.5351, 1.0332), (10.0, 9.3826, 35.3997)]),
        (0.0, [(0.0, 11.536_96, 0.0), (5.0, 11.536_96, 0.0), (10.0, 11.536_96, 0.0)]),
    ];
    // No axis is special.
    let turn = DQuat::from_axis_angle(v(2.0, 3.0, 6.0) / 7.0, 0.8);
    for (b, rows) in table {
        let moves = terrell::spacetime::Velocity::from_beta(turn * v(b, 0.0, 0.0)).unwrap();
        let body = Body::of(ball(1.0, DVec3::ZERO), glowing(flat(1.0)));
        let scene = Stage::of([body.at(0.0, turn * v(0.0, 5.0, 0.0)).moving(moves)]).scene();
        for (t, half, centre) in rows {
            let (sin, cos) = libm::sincos(centre.to_radians());
            let axis = turn * v(sin, cos, 0.0);
            // Points of the outline; their plane says what circle it is.
            let points: Vec<DVec3> = (0..36)
                .map(|i| {
                    let round = f64::from(i) * 10.0_f64.to_radians();
                    let sees =
                        |angle: f64| scene.lit().first(&arriving(beside(axis, angle, round), t)).is_some();
                    beside(axis, edge(0.0, 0.6, sees), round)
                })
                .collect();
            let normal = (points[12] - points[0]).cross(points[24] - points[0]).normalize();
            let normal = normal * normal.dot(axis).signum();
            for point in &points {
                near(angle(*point, normal).to_degrees(), half, 1e-4);
                near(point.dot(normal), points[0].dot(normal), 1e-12);
            }
            near(angle(normal, axis).to_degrees(), 0.0, 1e-4);
        }
    }
}

/// A moving observer sees a circle too.
#[test]
fn outline_of_a_ball_is_a_circle_for_every_observer() {
    let mut dice = Dice(80);
    for _ in 0..10 {
        let body = Body::of(ball(1.0, DVec3::ZERO), black()).at(-4.0, v(0.0, 4.0, 0.0));
        let scene = Stage::of([body.moving(dice.velocity(0.6))]).scene();
        let eye = Eye::at(0.0, DVec3::ZERO).moving(dice.velocity(0.6));
        // Somewhere inside: light from the centre, at an event when it could be seen.
        let to_centre = v(0.0, 1.0, 0.0);
        let inside = -along(eye.velocity, -to_centre);
        let sees = |n: DVec3| scene.lit().first(&eye.sight(n)).is_some();
        let points: Vec<DVec3> = (0..24)
            .map(|i| {
                let round = f64::from(i) * 15.0_f64.to_radians();
                beside(inside, edge(0.0, 3.0, |angle| sees(beside(inside, angle, round))), round)
            })
            .collect();
        let normal = (points[8] - points[0]).cross(points[16] - points[0]).normalize();
        for point in &points {
            near(point.dot(normal), points[0].dot(normal), 1e-11);
        }
    }
}

/// A floor without end is met at any distance, and its horizon is level.
#[test]
fn plane_goes_on_to_the_horizon() {
    let floor = Body::of(plane(v(0.0, -2.0, 0.0), DVec3::Y), black());
    let scene = Stage::of([floor]).scene();
    for down in [0.9, 1e-2, 1e-6, 1e-9, 1e-12_f64] {
        let ray = arriving(v((1.0 - down * down).sqrt() * 0.6, -down, (1.0 - down * down).sqrt() * 0.8), 0.0);
        close(-first(&scene, &ray).emission.t, 2.0 / down, 1e-6);
        let up = SightRay { k: FourVector::new(1.0, v(ray.k.x.x, -ray.k.x.y, ray.k.x.z)), ..ray };
        assert!(scene.lit().first(&up).is_none());
    }
}

/// A plane that moves along its normal: the sight ray and the plane meet where both are, or never.
#[test]
fn receding_plane_has_its_horizon_where_light_never_caught_up() {
    for b in [-0.9, -0.5, 0.0, 0.3, 0.9] {
        // At y = -2 + b t: going back in time the ray falls by -n.y s, and the plane by b s.
        let floor = Body::of(plane(DVec3::ZERO, DVec3::Y), black());
        let scene = Stage::of([floor.at(0.0, v(0.0, -2.0, 0.0)).moving(beta(0.0, b, 0.0))]).scene();
        let mut dice = Dice(81);
        for _ in 0..100 {
            let n = dice.direction();
            if (n.y + b).abs() < 1e-6 {
                continue;
            }
            let s = -2.0 / (n.y + b);
            let seen = scene.lit().first(&arriving(n, 0.0));
            assert_eq!(seen.is_some(), s > 0.0, "{n} {b}");
            if let Some(seen) = seen {
                close(-seen.emission.t, s, 1e-9);
                near(seen.emission.x.y, -2.0 - b * s, 1e-9 * s.max(1.0));
            }
        }
        let up = |y: f64| arriving(v((1.0 - y * y).sqrt(), y, 0.0), 0.0);
        near(edge(-0.95, 0.95, |y| scene.lit().first(&up(y)).is_some()), -b, 1e-9);
    }
}

/// A floor with squares that slides: the square at each place is where it was when its light left.
#[test]
fn sliding_floor_shows_its_squares_where_they_were() {
    let checker = Checker { size: 0.5, even: Reflectance::Constant(0.2), odd: Reflectance::Constant(0.9) };
    let surface = Surface::new(Scatter::Diffuse(Paint::Checker(Box::new(checker))));
    let moves = beta(0.6, 0.0, -0.5);
    // Its own x and z axes are those of the shape.
    let floor = Body::of(Solid::from(Shape::Plane), surface).moving(moves);
    let mut stage = Stage::of([floor]);
    stage.ambient = Some(flat(1.0));
    let scene = stage.scene();
    let mut dice = Dice(82);
    for _ in 0..300 {
        let at =
            Event::new(dice.between(-5.0, 5.0), v(dice.between(-9.0, 9.0), 0.0, dice.between(-9.0, 9.0)));
        let ray = light_to(at.x + v(dice.between(-1.0, 1.0), 1.0, 0.3), at);
        // The place in the floor's own frame.
        let u = moves.proper();
        let own = at.x + u * (u.dot(at.x) / (moves.gamma() + 1.0) - at.t);
        let square = |c: f64| (c / 0.5).floor() as i64;
        let expected = if (square(own.x) + square(own.z)).rem_euclid(2) == 0 { 0.2 } else { 0.9 };
        let omega = frequency(moves, ray.k.x);
        close(look(&scene, &ray).radiance[5] * omega.powi(5), expected, 1e-9);
    }
}

/// The shadow that a moving ball throws on a floor: where the light's way meets the ball when it passes.
#[test]
fn moving_ball_throws_the_shadow_that_light_needs() {
    let (mut dice, mut counts) = (Dice(83), [0; 2]);
    for _ in 0..30 {
        let moves = dice.velocity(0.85);
        let lamp_place = v(1.0, 6.0, -0.5);
        let body = Body::of(ball(1.0, DVec3::ZERO), black()).at(0.0, v(0.0, 3.0, 0.0)).moving(moves);
        let floor = Body::of(plane(DVec3::ZERO, DVec3::Y), diffuse(0.5));
        let scene = Stage::of([floor, body]).lit_by([Lantern::at(0.0, lamp_place, flat(1.0))]).scene();
        for _ in 0..100 {
            let at = Event::new(dice.between(-1.0, 9.0), dice.in_cube() * v(6.0, 0.0, 6.0));
            // Events of the light on its way, from the lamp on; the ball in the lab is flat along its motion.
            let way = at.x - lamp_place;
            let n = way / way.length();
            let sent = at.t - way.length();
            let (u, gamma) = (moves.proper(), moves.gamma());
            // To the ball's rest frame: place as a line in s.
            let rest = |t: f64, x: DVec3| x + u * (u.dot(x) / (gamma + 1.0) - t);
            let start = rest(sent, lamp_place - v(0.0, 3.0, 0.0));
            let step = rest(1.0, n);
            let nearest = (-start.dot(step) / step.length_squared()).clamp(0.0, way.length());
            let distance = (start + step * nearest).length();
            // The camera must see the floor and not the ball.
            let ray = light_to(at.x + v(0.0, 1e-3, 1e-4), at);
            if (distance - 1.0).abs() < 1e-6 || first(&scene, &ray).body != 0 {
                continue;
            }
            assert_eq!(is_bright(&scene, &ray), distance > 1.0, "{at:?}: {distance}");
            counts[usize::from(distance > 1.0)] += 1;
        }
    }
    assert!(counts[0] > 100 && counts[1] > 1000, "{counts:?}");
}

/// A body with a hole in it that is as long for its own clock as for nobody else: light passes along the hole's axis.
#[test]
fn hole_through_a_moving_block_lets_light_through_in_the_direction_of_its_rest_frame() {
    let drill = Solid::from(Shape::Cylinder).placed(DAffine3::from_scale(v(0.1, 9.0, 0.1))).unwrap();
    let block = cuboid(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 1.0)).difference([drill]);
    for moves in [beta(0.0, 0.0, 0.0), beta(0.8, 0.0, 0.0), beta(0.5, 0.6, 0.3)] {
        let body = Body::of(block.clone(), black()).moving(moves);
        let sky = crate::support::Heaven::uniform(black_body(5000.0));
        let scene = Stage::of([body]).under(sky).scene();
        // In the block's frame the light goes along y; in the lab along what aberration makes of it.
        let n = along(-moves, DVec3::Y);
        let through = |off: f64, n: DVec3| {
            let ray = light_from(DVec3::ZERO, Event::new(4.0, n * 4.0));
            let event = Event::new(ray.event.t, ray.event.x + v(0.0, 0.0, off));
            is_bright(&scene, &SightRay { event, ..ray })
        };
        assert!(through(0.0, n));
        let tilted = (n + v(0.0, 0.0, 0.3)).normalize();
        assert!(!through(0.0, tilted));
        assert!(!through(0.2, n));
        if moves.gamma() > 1.0 {
            assert!(!through(0.0, DVec3::Y));
        }
        let ray = light_from(DVec3::ZERO, Event::new(4.0, n * 4.0));
        for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &ray).radiance) {
            close(value, planck(*nm, 5000.0), 1e-12);
        }
    }
}

/// The normal of a solid decides its light: a moving ball under a lamp, point by point.
#[test]
fn moving_ball_is_shaded_by_its_own_normals() {
    let (mut dice, moves) = (Dice(84), beta(-0.3, 0.5, 0.4));
    let surface = diffuse(1.0);
    let into = terrell::spacetime::Poincare::<terrell::spacetime::Rest>::to_moving(moves, Event::ORIGIN);
    let sun = dice.direction();
    let lamp = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: sun });
    let scene: Scene =
        Stage::of([Body::of(ball(1.5, DVec3::ZERO), surface).moving(moves)]).lit_by([lamp]).scene();
    let doppler = frequency(moves, sun);
    let there = along(moves, sun);
    for _ in 0..100 {
        let normal = dice.direction();
        let ray = crate::support::light_at_rest(&into, 1.5 * normal, Event::new(2.0, 3.5 * normal));
        let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
        let omega = frequency(moves, ray.k.x);
        let expected = doppler.powi(3) * (-there.dot(normal)).max(0.0) / std::f64::consts::PI;
        near(look(&scene, &ray).radiance[5] * omega.powi(5), expected, 1e-10);
    }
}

/// A checkerboard to the horizon, run over at 0.99 c: four samples a pixel show what 256 show, with all of its contrast, and
/// what changes from one picture to the next is what moves.
#[test]
fn checkerboard_to_the_horizon_neither_blurs_nor_crawls_at_099_c() {
    let checker = Checker { size: 1.0, even: Reflectance::Constant(0.9), odd: Reflectance::Constant(0.05) };
    let board = plane(v(0.0, -1.5, 0.0), DVec3::Y);
    let board = Body::of(board, Surface::new(Scatter::Diffuse(Paint::Checker(Box::new(checker)))));
    let axis = v(-1.0, -2.0, -1.0) / 6.0_f64.sqrt();
    let sun = Lantern::at(0.0, DVec3::ZERO, black_body(5600.0)).with(Beam::Sun { axis });
    let eye = Eye::at(0.0, DVec3::ZERO).moving(beta(0.0, 0.0, -0.99)).toward(v(0.0, -0.35, -1.0)).wide(70.0);
    let scene = Stage::of([board]).lit_by([sun]).seen_by(&eye);
    // The eye, by brightness: the searchlight makes the middle a thousand times as bright as the rim.
    let seen = |tau: f64, samples: u32| -> Vec<f64> {
        let (width, height) = (96, 54);
        let reconstruction = Reconstruction::default();
        let sampling = Sampling { width, height, samples, reconstruction, wavelengths: 8 };
        let negative = expose(&scene, &scene.observer.view(tau, width, height), &sampling);
        negative.xyz.iter().map(|xyz| libm::log(1e-6 + f64::from(xyz[1]))).collect()
    };
    let mean = |of: &dyn Fn(usize) -> f64| (0..96 * 54).map(of).sum::<f64>() / f64::from(96 * 54);
    let spread = |a: &[f64]| {
        let middle = mean(&|i| a[i]);
        mean(&|i| (a[i] - middle) * (a[i] - middle)).sqrt()
    };
    let (few, many) = ([seen(0.0, 4), seen(0.02, 4)], [seen(0.0, 256), seen(0.02, 256)]);
    let error = mean(&|i| (few[0][i] - many[0][i]).powi(2)).sqrt();
    let crawl = mean(&|i| ((few[1][i] - few[0][i]) - (many[1][i] - many[0][i])).powi(2)).sqrt();
    let motion = mean(&|i| (many[1][i] - many[0][i]).powi(2)).sqrt();
    let contrast = spread(&few[0]) / spread(&many[0]);
    println!("error {error}, contrast {contrast}, crawl {crawl} of {motion}");
    assert!((contrast - 1.0).abs() < 0.01, "{contrast}");
    assert!(error < 0.15 * spread(&many[0]), "{error} of {}", spread(&many[0]));
    assert!(crawl < 0.4 * motion, "{crawl} of {motion}");
}
