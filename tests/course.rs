//! What blinks or changes does so by its own clock: seen late by the light's way, and at another pace.

use crate::support::{
    Body, Dice, Lantern, Stage, along, ball, beta, black, black_body, blinking, built, close, diffuse, edge,
    emission_time, flat, frequency, glowing, is_bright, light_at_rest, light_from, light_to, line, look,
    mixed, near, plane, square, v,
};
use glam::DVec3;
use std::f64::consts::PI;
use terrell::course::Course;
use terrell::lamp::Beam;
use terrell::scene::Scene;
use terrell::spacetime::{Event, Poincare, Rest, SightRay, Velocity};

/// By hand: whether something is on that is for the first `lit` of every period from `start` on.
fn on(period: f64, lit: f64, start: f64, tau: f64) -> bool {
    ((tau - start) / period).rem_euclid(1.0) < lit
}

/// How far from going on or off, in periods.
fn clear(period: f64, lit: f64, start: f64, tau: f64) -> f64 {
    let phase = ((tau - start) / period).rem_euclid(1.0);
    phase.min(1.0 - phase).min((phase - lit).abs())
}

fn floor() -> Body {
    Body::of(plane(DVec3::ZERO, DVec3::Y), diffuse(0.8))
}

/// Light from a place of the floor at a lab time.
fn from_floor(t: f64, x: f64, z: f64) -> SightRay {
    light_to(v(x + 0.3, 2.0, z - 0.4), Event::new(t, v(x, 0.0, z)))
}

/// A floor under a blinking lamp at 0.9 c: lit where light arrives that left the lamp while it was on.
#[test]
fn floor_is_lit_by_what_the_lamp_was_when_the_light_left() {
    let (mut dice, period, part, start) = (Dice(60), 0.7, 0.4, 0.2);
    let (mut lit, mut dark) = (0, 0);
    for _ in 0..40 {
        let b = dice.between(0.0, 0.95);
        let moves = Velocity::from_beta(v(b, 0.0, 0.1)).unwrap();
        let origin: Event = Event::new(dice.between(-3.0, 3.0), v(dice.between(-3.0, 3.0), 20.0, 0.5));
        let lamp = Lantern::at(origin.t, origin.x, flat(1e3)).moving(moves);
        let scene = Stage::of([floor()]).lit_by([lamp.by(&blinking(period, part, start))]).scene();
        for _ in 0..60 {
            let at = Event::new(
                dice.between(-20.0, 40.0),
                v(dice.between(-30.0, 30.0), 0.0, dice.between(-9.0, 9.0)),
            );
            let path = |t: f64| origin.x + moves.beta() * (t - origin.t);
            let tau = (emission_time(at, path) - origin.t) / moves.gamma();
            if clear(period, part, start, tau) < 1e-9 {
                continue;
            }
            let expected = on(period, part, start, tau);
            assert_eq!(is_bright(&scene, &from_floor(at.t, at.x.x, at.x.z)), expected, "{at:?} {tau}");
            if expected { lit += 1 } else { dark += 1 }
        }
    }
    assert!(lit > 600 && dark > 600, "{lit} {dark}");
}

/// A low lamp at 0.9 c: ahead of it stripes as wide as period/D, with D = √((1 + β)/(1 - β)), behind it period D.
#[test]
fn stripes_on_the_floor_are_narrow_ahead_and_wide_behind() {
    let (b, period, height): (f64, f64, f64) = (0.9, 3.0, 1e-3);
    let lamp = Lantern::at(0.0, v(0.0, height, 0.0), flat(1.0)).moving(beta(b, 0.0, 0.0));
    let scene = Stage::of([floor()]).lit_by([lamp.by(&blinking(period, 0.5, 0.0))]).scene();
    let doppler = ((1.0 + b) / (1.0 - b)).sqrt();
    let t = 100.0;
    let lit = |x: f64| look(&scene, &from_floor(t, x, 0.0)).radiance[0] > 0.0;
    // Ahead of x = 90 and behind it, from edge to edge.
    let edges = |from: f64, to: f64| {
        let step = (to - from) / 5000.0;
        let changes = (0..5000).map(|i| from + step * f64::from(i)).filter(|x| lit(*x) != lit(x + step));
        let fine = |x: f64| if lit(x) { edge(x, x + step, lit) } else { edge(x + step, x, lit) };
        changes.map(fine).collect::<Vec<f64>>()
    };
    let (ahead, behind) = (edges(91.0, 99.0), edges(20.0, 80.0));
    assert!(ahead.len() > 20 && behind.len() > 8, "{} {}", ahead.len(), behind.len());
    for pair in ahead.windows(2) {
        near(pair[1] - pair[0], 0.5 * period / doppler, 1e-6);
    }
    for pair in behind.windows(2) {
        near(pair[1] - pair[0], 0.5 * period * doppler, 1e-5);
    }
}

/// Keys of a lamp's brightness: linear in its own time, held at the ends.
#[test]
fn keyed_lamp_is_as_bright_as_its_keys_say_when_the_light_left() {
    let mut dice = Dice(61);
    let keys = vec![(-2.0, 0.3), (0.5, 2.0), (1.0, 0.0), (4.0, 1.0)];
    let by_hand = |tau: f64| {
        let pairs = [(-2.0, 0.3, 0.5, 2.0), (0.5, 2.0, 1.0, 0.0), (1.0, 0.0, 4.0, 1.0)];
        let inside = pairs.iter().find(|(a, _, b, _)| (*a..=*b).contains(&tau));
        let end = if tau < 0.0 { 0.3 } else { 1.0 };
        inside.map_or(end, |(a, p, b, q)| p + (q - p) * (tau - a) / (b - a))
    };
    let mut between = 0;
    for _ in 0..300 {
        let b = dice.between(0.0, 0.95);
        let moves = dice.velocity(b);
        let origin: Event = Event::new(dice.between(-3.0, 3.0), v(0.0, 40.0, 0.0) + dice.in_cube() * 2.0);
        let lamp = Lantern::at(origin.t, origin.x, black_body(4000.0)).moving(moves);
        let at = Event::new(origin.t + dice.between(35.0, 45.0), dice.in_cube() * v(3.0, 0.0, 3.0));
        let tau =
            (emission_time(at, |t| origin.x + moves.beta() * (t - origin.t)) - origin.t) / moves.gamma();
        between += u32::from((-2.0..4.0).contains(&tau));
        let ray = from_floor(at.t, at.x.x, at.x.z);
        let seen = |lamp: Lantern| look(&Stage::of([floor()]).lit_by([lamp]).scene(), &ray).radiance[20];
        let (steady, keyed) = (seen(lamp.clone()), seen(lamp.by(&Course::Keyed(keys.clone()))));
        if steady > 0.0 {
            near(keyed / steady, by_hand(tau), 1e-9);
        }
    }
    assert!(between > 50, "{between}");
}

/// From one spectrum to another, its line included.
#[test]
fn keyed_spectrum_goes_over_from_one_to_the_other() {
    let moves = beta(0.3, 0.0, 0.4);
    let origin: Event = Event::new(1.0, v(0.0, 5.0, 0.0));
    let (red, blue) = (black_body(2500.0), line(480.0, 1e4));
    let lamp = Lantern::at(origin.t, origin.x, red.clone()).moving(moves);
    let both = Lantern {
        light: vec![
            (Course::Keyed(vec![(0.0, 1.0), (8.0, 0.0)]), red.clone()),
            (Course::Keyed(vec![(0.0, 0.0), (8.0, 1.0)]), blue.clone()),
        ],
        ..lamp.clone()
    };
    let only = |source| Lantern::at(origin.t, origin.x, source).moving(moves);
    for t in [3.0, 7.0, 9.0, 12.0, 20.0] {
        let ray = from_floor(t, 1.0, 2.0);
        let at = Event::new(t, v(1.0, 0.0, 2.0));
        let tau =
            (emission_time(at, |t| origin.x + moves.beta() * (t - origin.t)) - origin.t) / moves.gamma();
        let share = (tau / 8.0).clamp(0.0, 1.0);
        let seen = |lamp: Lantern| look(&Stage::of([floor()]).lit_by([lamp]).scene(), &ray);
        let (a, b, mix) = (seen(only(red.clone())), seen(only(blue.clone())), seen(both.clone()));
        near(mix.radiance[40], a.radiance[40] * (1.0 - share), 1e-12 * a.radiance[40]);
        near(mix.lines.y, b.lines.y * share, 1e-12 * b.lines.y);
        assert!(a.radiance[40] > 0.0 && b.lines.y > 0.0);
    }
}

/// A sun's clock is that of its wave fronts: k·(E - O), with k·u = 1 for those who rest beside it.
#[test]
fn suns_course_goes_by_its_wave_fronts() {
    let (mut dice, period, part, start) = (Dice(62), 0.8, 0.3, -0.1);
    let (mut lit, mut dark) = (0, 0);
    for _ in 0..100 {
        let b = dice.between(0.0, 0.95);
        let moves = dice.velocity(b);
        let axis = dice.direction();
        let origin: Event = Event::new(dice.between(-3.0, 3.0), dice.in_cube() * 3.0);
        // The light's way in the lab, and its frequency there.
        let way = along(-moves, axis);
        let doppler = frequency(-moves, axis);
        if way.y > -0.05 {
            continue;
        }
        let sun = Lantern::at(origin.t, origin.x, flat(1.0)).with(Beam::Sun { axis }).moving(moves);
        let scene = Stage::of([floor()]).lit_by([sun.by(&blinking(period, part, start))]).scene();
        for _ in 0..30 {
            let at: Event = Event::new(dice.between(-9.0, 9.0), dice.in_cube() * v(9.0, 0.0, 9.0));
            let tau = doppler * ((at.t - origin.t) - way.dot(at.x - origin.x));
            if clear(period, part, start, tau) < 1e-9 {
                continue;
            }
            let expected = on(period, part, start, tau);
            assert_eq!(is_bright(&scene, &from_floor(at.t, at.x.x, at.x.z)), expected);
            if expected { lit += 1 } else { dark += 1 }
        }
    }
    assert!(lit > 200 && dark > 200, "{lit} {dark}");
}

/// A glowing surface that blinks, of a moving body: each point shows the body's own time at which its light left.
#[test]
fn blinking_surface_shows_the_bodys_own_time_at_each_point() {
    let (mut dice, period, part, start) = (Dice(63), 0.9, 0.45, 0.3);
    let surface = || {
        let off = Course::Blinking { period, lit: part, start, inverted: true };
        mixed([(blinking(period, part, start), glowing(black_body(5000.0))), (off, black())])
    };
    let mut counts = [0; 2];
    for _ in 0..60 {
        let b = dice.between(0.0, 0.95);
        let moves = dice.velocity(b);
        let origin: Event = Event::new(dice.between(-9.0, 9.0), dice.in_cube() * 9.0);
        let body = Body::of(ball(2.0, DVec3::ZERO), surface()).at(origin.t, origin.x).moving(moves);
        let scene = Stage::of([body]).scene();
        for _ in 0..20 {
            let (normal, tau) = (dice.direction(), dice.between(-9.0, 9.0));
            if clear(period, part, start, tau) < 1e-6 {
                continue;
            }
            let into: Poincare<Rest> = Poincare::to_moving(moves, origin);
            let ray = light_at_rest(&into, 2.0 * normal, Event::new(tau + 5.0, 7.0 * normal));
            let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
            let expected = on(period, part, start, tau);
            assert_eq!(scene_is_lit(&scene, &ray), expected, "{tau}");
            counts[usize::from(expected)] += 1;
        }
    }
    assert!(counts[0] > 200 && counts[1] > 200, "{counts:?}");
}

/// Also where it is too cool to be seen: any radiance.
fn scene_is_lit(scene: &Scene, ray: &SightRay) -> bool {
    look(scene, ray).radiance.iter().any(|value| *value > 0.0)
}

/// The period of an approaching, of a receding, and of a crossing lamp of known D: period over D.
#[test]
fn seen_period_is_the_own_one_over_the_doppler_factor() {
    let (period, part) = (0.5, 0.5);
    for b in [0.5, 0.8, 0.9_f64] {
        for (sense, doppler) in
            [(1.0, ((1.0 + b) / (1.0 - b)).sqrt()), (-1.0, ((1.0 - b) / (1.0 + b)).sqrt())]
        {
            // Its centre moves along z toward the eye at z = 0, or away from it.
            let surface = mixed([(blinking(period, part, 0.0), glowing(flat(1.0)))]);
            let body = Body::new(&built(square()), surface).at(0.0, v(0.0, 0.0, -200.0));
            let scene = Stage::of([body.moving(beta(0.0, 0.0, sense * b))]).scene();
            let lit =
                |t: f64| scene_is_lit(&scene, &light_from(v(0.0, 0.0, -1.0), Event::new(t, DVec3::ZERO)));
            // Light of its time 0 arrives at 200.
            let (seen, step) = (period / doppler, 0.0097 * period / doppler);
            let from = 200.0 + 0.05 * seen;
            let changes = (0..400).map(|i| from + step * f64::from(i)).filter(|t| lit(*t) != lit(t + step));
            let fine = |t: f64| if lit(t) { edge(t, t + step, lit) } else { edge(t + step, t, lit) };
            let edges: Vec<f64> = changes.map(fine).collect();
            assert!(edges.len() >= 6, "{}", edges.len());
            for (i, at) in edges.iter().enumerate() {
                near(*at, 200.0 + 0.5 * seen * (i as f64 + 1.0), 1e-9);
            }
        }
    }
}

/// Bodies of one rest frame with clocks of their own, which their own `at` sets.
#[test]
fn bodies_of_one_rest_frame_keep_clocks_of_their_own() {
    let (mut dice, moves) = (Dice(64), beta(0.4, -0.5, 0.3));
    let course = || Course::Keyed(vec![(-20.0, 0.0), (20.0, 1.0)]);
    let bodies: Vec<Body> = (0..8)
        .map(|_| {
            let surface = mixed([(course(), glowing(flat(1.0)))]);
            let body = Body::of(ball(0.3, DVec3::ZERO), surface);
            body.at(dice.between(-5.0, 5.0), dice.in_cube() * 8.0).moving(moves)
        })
        .collect();
    let scene = Stage::of(bodies.iter().cloned()).scene();
    assert_eq!(scene.world.frames.len(), 1);
    for body in &bodies {
        let into: Poincare<Rest> = body.placement.rest_from_lab();
        let (normal, tau) = (dice.direction(), dice.between(-9.0, 9.0));
        // From close by, so that no other body stands between.
        let ray = light_at_rest(&into, 0.3 * normal, Event::new(tau + 0.01, 0.31 * normal));
        let omega = 1.0 / ray.k.t;
        let ray = SightRay { k: ray.k * omega, ..ray };
        let omega = omega * 0.01;
        near(look(&scene, &ray).radiance[3] * omega.powi(5), (tau + 20.0) / 40.0, 1e-12);
    }
}

/// A reflectance that changes: by the body's own time when the light left it, whatever the lamp's was.
#[test]
fn keyed_reflectance_is_by_the_bodys_own_time() {
    let mut dice = Dice(65);
    for _ in 0..50 {
        let b = dice.between(0.0, 0.9);
        let moves = dice.velocity(b);
        let keys = [(-10.0, 0.1), (10.0, 0.9)];
        let from = Course::Keyed(vec![(keys[0].0, 1.0), (keys[1].0, 0.0)]);
        let to = Course::Keyed(vec![(keys[0].0, 0.0), (keys[1].0, 1.0)]);
        let surface = mixed([(from, diffuse(keys[0].1)), (to, diffuse(keys[1].1))]);
        let origin: Event = Event::new(dice.between(-3.0, 3.0), dice.in_cube());
        let into: Poincare<Rest> = Poincare::to_moving(moves, origin);
        let (normal, tau) = (dice.direction(), dice.between(-12.0, 12.0));
        let ray = light_at_rest(&into, normal, Event::new(tau + 2.0, 3.0 * normal));
        let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
        let left = into.undo(Event::new(tau, normal));
        let lamp = Lantern::at(0.0, left.x + normal * 6.0, flat(1.0));
        let seen = |surface| {
            let body = Body::of(ball(1.0, DVec3::ZERO), surface).at(origin.t, origin.x).moving(moves);
            look(&Stage::of([body]).lit_by([lamp.clone()]).scene(), &ray).radiance[7]
        };
        let white = seen(diffuse(1.0));
        if white > 0.0 {
            near(seen(surface) / white, 0.1 + 0.8 * ((tau + 10.0) / 20.0).clamp(0.0, 1.0), 1e-9);
        }
    }
}

/// A door of changing transparency between a lamp and a floor: the shadow is by the door's time when the light passed.
#[test]
fn shadow_of_what_blinks_is_by_its_time_when_the_light_passed() {
    let (period, moves) = (1.0, beta(0.6, 0.0, 0.0));
    let door = |course: Course| {
        // A pane that is there or not; while it is not, nothing is there.
        let gone = Course::Blinking { period, lit: 0.5, start: 0.0, inverted: true };
        let clear = crate::support::pane(terrell::spectrum::Index::Constant(1.0));
        let door = Body::new(&built(square()), mixed([(course, black()), (gone, clear)]));
        door.sized(50.0).facing(DVec3::Y).at(0.0, v(0.0, 2.0, 0.0)).moving(moves)
    };
    let lamp = Lantern::at(0.0, v(0.0, 6.0, 0.0), flat(1.0));
    let scene = Stage::of([floor(), door(blinking(period, 0.5, 0.0))]).lit_by([lamp]).scene();
    let mut dice = Dice(66);
    let mut counts = [0; 2];
    for _ in 0..300 {
        let at = Event::new(dice.between(-5.0, 5.0), dice.in_cube() * v(4.0, 0.0, 4.0));
        // Two thirds of the way down: the event at the door.
        let way = at.x - v(0.0, 6.0, 0.0);
        let x = v(0.0, 6.0, 0.0) + way * (4.0 / 6.0);
        let t = at.t - way.length() * (2.0 / 6.0);
        let tau = moves.gamma() * (t - 0.6 * x.x);
        if clear(period, 0.5, 0.0, tau) < 1e-6 {
            continue;
        }
        let ray = light_to(at.x + v(0.1, 0.5, 0.1), at);
        let expected = !on(period, 0.5, 0.0, tau);
        assert_eq!(is_bright(&scene, &ray), expected, "{tau}");
        counts[usize::from(expected)] += 1;
    }
    assert!(counts[0] > 80 && counts[1] > 80, "{counts:?}");
}

/// A blinking lamp's line blinks too.
#[test]
fn line_of_a_blinking_lamp_is_dark_when_it_is_off() {
    let lamp = Lantern::at(0.0, v(0.0, 3.0, 0.0), line(560.0, 1.0)).by(&blinking(2.0, 0.5, 0.0));
    let scene = Stage::of([floor()]).lit_by([lamp]).scene();
    let at = |t: f64| look(&scene, &from_floor(t + 3.0, 0.0, 0.0)).lines.y;
    assert!(at(0.5) > 0.0 && at(2.5) > 0.0);
    near(at(1.5), 0.0, 0.0);
    close(at(0.5), 0.8 / PI / 9.0 * 683.0 * terrell::color::matching(560.0).y, 1e-9);
}
