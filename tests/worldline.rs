//! Observers in motion: rockets, circles, and what they carry.

use crate::support::{
    Body, Eye, Stage, beta, black_body, built, close, emission_time, first, glowing, icosphere, light_from,
    near, near_vector, picture, speed, v, vectors, velocities,
};
use glam::{DQuat, DVec2, DVec3};
use proptest::prelude::{ProptestConfig, prop_assert, proptest};
use std::sync::Arc;
use terrell::observer::Aim;
use terrell::spacetime::{
    Camera, Circle, Course, Event, FourVector, Poincare, Tetrad, Track, Velocity, Worldline,
};

fn rocket(acceleration: DVec3) -> Worldline {
    Worldline::new(Event::ORIGIN, Velocity::REST, DQuat::IDENTITY, Course::Rocket { acceleration })
}

/// A winding path through a few places, up to about 0.9 c.
fn keyed(a: DVec3) -> Course {
    let keys = [
        (-2.0, a * 0.2),
        (-0.7, v(0.1, a.x * 0.1, 0.05)),
        (0.4, a * 0.2),
        (1.1, a * 0.05),
        (3.0, v(0.1, 0.4, -0.4)),
    ];
    Course::Keyed(Arc::new(Track::through(&keys).unwrap()))
}

/// The axes e1, e2, e3 and u in the lab.
fn axes(tetrad: &Tetrad) -> [FourVector; 4] {
    let axis = |t: f64, x: DVec3| tetrad.lab_from_camera * FourVector::<Camera>::new(t, x);
    [axis(0.0, DVec3::X), axis(0.0, DVec3::Y), axis(0.0, DVec3::Z), axis(1.0, DVec3::ZERO)]
}

#[test]
fn rocket_moves_on_a_hyperbola() {
    let along = v(2.0, 6.0, -9.0) / 11.0;
    let tetrad = rocket(along * 0.1).at(20.0);
    close(tetrad.event.t, 36.268_604, 2e-8);
    close(tetrad.event.x.length(), 27.621_957, 2e-8);
    near(tetrad.event.x.dot(along), tetrad.event.x.length(), 1e-13);
    close(tetrad.velocity().t, 3.762_195_7, 2e-8);
    near_vector(tetrad.velocity().x / tetrad.velocity().t, along * 0.964_027_6, 1e-7);
    // Light from straight ahead, of what rests in the lab: e^(aτ).
    close(light_from(tetrad.event.x + along, tetrad.event).k.dot(tetrad.velocity()), 7.389_056_1, 2e-8);
    // (x + 1/a)² - t² = 1/a² at all times.
    for tau in [-35.0, -3.0, 1e-6, 0.5, 7.0, 60.0] {
        let event = rocket(along * 0.1).at(tau).event;
        let x = event.x.dot(along);
        near((x + 20.0) * x, event.t * event.t, 1e-13 * event.t * event.t + 1e-20);
    }
}

/// g = 9.80665 m/s² and Julian years.
#[test]
fn one_g_reaches_the_stars() {
    let light = 299_792_458.0;
    let year = 365.25 * 86_400.0 * light;
    let g = v(0.6, 0.0, 0.8) * (9.806_65 / (light * light));
    let table = [
        (1.0, 1.187_312, 0.563_642, 1.581_845, 1e-6),
        (2.0, 3.756_289, 2.910_475, 4.004_470, 1e-6),
        (5.0, 84.4797, 83.5166, 87.2138, 1e-6),
        (8.0, 1869.51, 1868.54, 1929.88, 4e-6),
        (12.0, 116_146.9, 116_146.0, 119_897.9, 1e-6),
    ];
    for (years, t, distance, gamma, tolerance) in table {
        let tetrad = rocket(g).at(years * year);
        close(tetrad.event.t / year, t, tolerance);
        close(tetrad.event.x.length() / year, distance, tolerance);
        close(tetrad.velocity().t, gamma, tolerance);
    }
    near(rocket(g).at(year).velocity().x.length() / 1.581_845, 0.774_827, 1e-6);
}

/// A circling clock runs slow by γ; it sees the centre's lamp blue by γ, and the centre sees it red by γ.
#[test]
fn circling_observer_sees_the_centre_blue_by_gamma() {
    let circle = Circle::around(v(1.0, 2.0, 3.0), v(1.0, -2.0, 2.0), 4.0, 0.7);
    let gamma = 1.0 / (1.0 - 0.49_f64).sqrt();
    near(gamma, 1.400_280, 5e-7);
    let course = Course::Orbit { circle, proper_speed: 0.7 * gamma };
    let worldline = Worldline::new(Event::new(5.0, DVec3::ZERO), Velocity::REST, DQuat::IDENTITY, course);
    let lamp =
        Body::new(&built(icosphere(3)), glowing(black_body(5000.0))).sized(1e-3).at(0.0, v(1.0, 2.0, 3.0));
    let scene = Stage::of([lamp]).scene();
    for tau in [-13.0, 0.0, 2.0, 31.0] {
        let tetrad = worldline.at(tau);
        near(tetrad.event.t - 5.0, gamma * tau, 1e-13);
        near((tetrad.event.x - v(1.0, 2.0, 3.0)).length(), 4.0, 1e-13);
        near((tetrad.event.x - v(1.0, 2.0, 3.0)).dot(v(1.0, -2.0, 2.0)), 0.0, 1e-13);
        let n = tetrad.direction_of(light_from(v(1.0, 2.0, 3.0), tetrad.event).k);
        close(first(&scene, &tetrad.sight_ray(n)).doppler.factor(), gamma, 1e-12);
        // Its velocity is that of its path, and right-handed about the axis.
        let step = 1e-5;
        let (a, b) = (worldline.at(tau - step).event, worldline.at(tau + step).event);
        near_vector((b.x - a.x) / (2.0 * step), tetrad.velocity().x, 1e-8);
        let radius = tetrad.event.x - v(1.0, 2.0, 3.0);
        assert!(radius.cross(tetrad.velocity().x).dot(v(1.0, -2.0, 2.0)) > 0.0);
    }
}

/// Rockets with the same horizon: D = X of the emitter over X of the receiver.
#[test]
fn rindler_observers_see_each_other_shifted_by_their_distances_from_the_horizon() {
    let along = v(1.0, 2.0, 2.0) / 3.0;
    // At X from the horizon the acceleration is 1/X; both start where the horizon is the origin's.
    let at = |place: f64| {
        let course = Course::Rocket { acceleration: along / place };
        Worldline::new(Event::new(0.0, along * place), Velocity::REST, DQuat::IDENTITY, course)
    };
    for (emitter, receiver) in [(1.0, 2.0), (2.0, 1.0), (0.3, 0.7)] {
        let sent = at(emitter).at(0.4);
        // Light upwards or downwards meets the receiver: by halving its proper time.
        let way = along * f64::signum(receiver - emitter);
        let early = |tau: f64| {
            let event = at(receiver).at(tau).event;
            event.t - sent.event.t < (event.x - sent.event.x).dot(way)
        };
        let tau = crate::support::edge(-20.0, 20.0, early);
        let k = FourVector::new(1.0, way);
        let doppler = k.dot(at(receiver).at(tau).velocity()) / k.dot(sent.velocity());
        close(doppler, emitter / receiver, 1e-9);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn axes_stay_orthonormal_along_any_course(
        start in velocities(2.0), axis in vectors(), turn in -3.0..3.0_f64, a in vectors(), fast in -3.0..3.0_f64, tau in -2.0..2.0_f64
    ) {
        let circle = Circle::around(a, axis, 2.0, turn);
        for course in [Course::Inertial, Course::Rocket { acceleration: a }, Course::Orbit { circle, proper_speed: fast }, Course::Ring { circle, turns: 1.0, instants: (0.0, 0.0) }, keyed(a)] {
            let turned = DQuat::from_axis_angle(axis / axis.length(), turn);
            let tetrad = Worldline::new(Event::new(1.0, a), start, turned, course.clone()).at(tau);
            let axes = axes(&tetrad);
            let rounding = 1e-13 * tetrad.velocity().t.powi(2) + 1e-13 * start.gamma().powi(4);
            for (i, one) in axes.iter().enumerate() {
                for (j, other) in axes.iter().enumerate() {
                    let expected = if i != j { 0.0 } else if i == 3 { 1.0 } else { -1.0 };
                    prop_assert!((one.dot(*other) - expected).abs() < rounding, "{i} {j} {course:?}");
                }
            }
            // Right-handed, to the future.
            let [x, y, z] = [0, 1, 2].map(|i| axes[i].x);
            prop_assert!(x.cross(y).dot(z) > 0.0 && axes[3].t >= 1.0 - 1e-12);
        }
    }

    #[test]
    fn clock_reads_back_from_lab_time(start in velocities(2.0), a in vectors(), fast in -3.0..3.0_f64, tau in -3.0..3.0_f64) {
        let circle = Circle::around(a, v(1.0, 2.0, 2.0), 2.0, 0.3);
        for course in [Course::Inertial, Course::Rocket { acceleration: a }, Course::Orbit { circle, proper_speed: fast }, keyed(a)] {
            let worldline = Worldline::new(Event::new(4.0, a), start, DQuat::IDENTITY, course.clone());
            let back = worldline.tau_at_lab(worldline.at(tau).event.t).unwrap();
            prop_assert!((back - tau).abs() < 1e-12 * start.gamma() * 10.0, "{course:?}: {back} for {tau}");
        }
    }

    /// Proper time is the length of the path: dτ² = dt² - dx².
    #[test]
    fn clocks_measure_the_length_of_their_path(start in velocities(1.5), a in vectors(), fast in -2.0..2.0_f64, tau in -2.0..2.0_f64) {
        let circle = Circle::around(a, v(1.0, 2.0, 2.0), 2.0, 0.3);
        for course in [Course::Inertial, Course::Rocket { acceleration: a }, Course::Orbit { circle, proper_speed: fast }, keyed(a)] {
            let worldline = Worldline::new(Event::new(4.0, a), start, DQuat::IDENTITY, course.clone());
            let half = 1e-4;
            let step = worldline.at(tau + half).event - worldline.at(tau - half).event;
            prop_assert!((step.dot(step).sqrt() / (2.0 * half) - 1.0).abs() < 1e-6);
            let u = worldline.at(tau).velocity();
            prop_assert!((step * (0.5 / half) - u).x.length() < 1e-5 * u.t);
        }
    }
}

/// A camera that looks at a body looks where its light comes from.
#[test]
fn look_at_puts_the_apparent_body_in_the_middle_of_the_picture() {
    let moves = beta(0.5, -0.3, 0.6);
    let (start, place) = (Event::new(1.0, v(4.0, 5.0, -8.0)), v(0.3, -0.2, 0.9));
    let rest_from_lab = Poincare::to_moving(moves, start);
    let ball = Body::new(&built(icosphere(3)), glowing(black_body(5000.0))).sized(0.02);
    let ball = ball.mapped(glam::DAffine3::from_translation(place)).at(start.t, start.x).moving(moves);
    let courses = [
        Course::Inertial,
        Course::Rocket { acceleration: v(0.2, -0.1, 0.4) },
        Course::Orbit { circle: Circle::around(DVec3::ZERO, v(1.0, 1.0, 0.0), 2.0, 0.0), proper_speed: 1.5 },
    ];
    for course in courses {
        let mut eye = Eye::at(2.0, v(-1.0, 2.0, 0.5)).moving(beta(-0.4, 0.7, 0.1)).wide(2.0);
        (eye.rotation, eye.course) = (DQuat::from_axis_angle(v(0.6, 0.0, 0.8), 1.3), course);
        eye.aim = Aim::At { rest_from_lab, place };
        let scene = Stage::of([ball.clone()]).seen_by(&eye);
        for tau in [-2.0, 0.0, 3.0] {
            let view = scene.observer.view(tau, 33, 21);
            let hit = first(&scene, &view.ray(DVec2::new(16.5, 10.5)));
            // Independent of any boost: the place's own path in the lab.
            let u = moves.proper();
            let along = u.dot(place);
            let (t0, x0) = (start.t + along, start.x + place + u * (along / (moves.gamma() + 1.0)));
            let path = |t: f64| x0 + moves.beta() * (t - t0);
            let event = scene.observer.worldline.at(tau).event;
            let emitted = emission_time(event, path);
            near(hit.emission.t, emitted, 0.02 * 3.0 * moves.gamma());
            let pixel = view.pixel_of(light_from(path(emitted), event).k).unwrap();
            near(pixel.distance(DVec2::new(16.5, 10.5)), 0.0, 1e-8);
        }
        let (_, negative) = picture(&scene, 33, 21);
        assert!(negative.xyz[10 * 33 + 16][1] > 0.0 && negative.xyz[0][1] <= 0.0);
    }
}

/// A ring of observers at rest at one instant, all round.
#[test]
fn ring_stands_still_in_time() {
    let circle = Circle::around(v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0), 3.0, 0.0);
    let ring = Worldline::new(
        Event::new(2.0, DVec3::ZERO),
        Velocity::REST,
        DQuat::IDENTITY,
        Course::Ring { circle, turns: 1.0, instants: (0.0, 0.0) },
    );
    for (turns, place) in
        [(0.0, v(1.0, 0.0, 3.0)), (0.25, v(4.0, 0.0, 0.0)), (0.5, v(1.0, 0.0, -3.0)), (1.0, v(1.0, 0.0, 3.0))]
    {
        near(ring.at(turns).event.t, 2.0, 1e-15);
        near_vector(ring.at(turns).event.x, place, 1e-14);
        near(ring.at(turns).velocity().x.length(), 0.0, 1e-15);
    }
    assert!(ring.tau_at_lab(2.0).is_none());
    near(speed(0.6, DVec3::X).gamma(), 1.25, 1e-15);
}

/// The picture: right is right, up is up, and the width is the field of view.
#[test]
fn picture_has_its_right_and_up_and_its_width() {
    let eye = Eye::at(0.0, DVec3::ZERO).toward(v(0.0, 0.0, -1.0)).wide(90.0);
    let view = eye.observer().view(0.0, 200, 100);
    near_vector(view.direction(DVec2::new(200.0, 50.0)), v(0.5_f64.sqrt(), 0.0, -(0.5_f64.sqrt())), 1e-15);
    near_vector(view.direction(DVec2::new(100.0, 0.0)), v(0.0, 0.5, -1.0) / 1.25_f64.sqrt(), 1e-15);
    let pixel = view.pixel_of(light_from(v(0.3, 0.2, -1.0), Event::ORIGIN).k).unwrap();
    near(pixel.x, 130.0, 1e-12);
    near(pixel.y, 30.0, 1e-12);
    assert!(view.pixel_of(light_from(v(0.3, 0.2, 1.0), Event::ORIGIN).k).is_none());
}
