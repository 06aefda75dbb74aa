//! Rockets near their horizon, and orbits almost at the speed of light.

use super::sound_picture;
use crate::support::{
    Body, Eye, Stage, ball, black_body, built, close, exposed, glowing, icosphere, near, plane, v,
};
use glam::{DQuat, DVec3};
use terrell::observer::Aim;
use terrell::spacetime::{Circle, Course, Event, FourVector, Velocity, Worldline};

/// Looking back from a rocket: what rests d behind its start is seen as it was at `(1 - exp(-aτ))/a - d`, redshifted by
/// exp(-aτ). Nothing later than `1/a - d` is ever seen. Bounds: 4 ε γ and 4 ε of the distance.
#[test]
fn rocket_sees_nothing_later_than_its_horizon() {
    let (a, d) = (0.5, 3.0);
    let along = v(2.0, 3.0, -6.0) / 7.0;
    let wall = Body::of(plane(-along * d, along), glowing(black_body(1e9)));
    for way in [0.0, 1.0, 5.0, 10.0, 15.0, 19.0] {
        let tau = way / a;
        let eye = Eye { course: Course::Rocket { acceleration: along * a }, ..Eye::at(0.0, DVec3::ZERO) };
        let eye = Eye { aim: Aim::Along(-along), ..eye };
        let scene = Stage::of([wall.clone()]).seen_by(&eye);
        let tetrad = scene.observer.worldline.at(tau);
        let first = scene.lit().first(&tetrad.sight_ray(-along)).unwrap();
        let allowed = 8.0 * f64::EPSILON * libm::cosh(way);
        close(first.doppler.factor(), libm::exp(-way), allowed + 1e-12);
        let last = 1.0 / a - d;
        near(first.emission.t, last - libm::exp(-way) / a, allowed / a + 1e-12);
        assert!(first.emission.t <= last + allowed / a + 1e-12);
        assert!(exposed::<8>(&scene, tau, (12, 8)).iter().all(|xyz| xyz.is_finite()));
        // And ahead, where stars and walls shine in gamma rays.
        let ahead = Body::of(plane(along * 1e9, -along), glowing(black_body(1e-3)));
        let scene = Stage::of([ahead]).seen_by(&Eye { aim: Aim::Along(along), ..eye });
        let first = scene.lit().first(&tetrad.sight_ray(along)).unwrap();
        close(first.doppler.factor(), libm::exp(way), 1e-12);
        sound_picture(&scene);
        assert!(exposed::<8>(&scene, tau, (12, 8)).iter().all(|xyz| xyz.is_finite()));
    }
}

/// What a rocket has left behind its horizon is not seen, even though it is near: its light has not come yet.
#[test]
fn body_that_is_beyond_the_horizon_is_seen_as_it_was_before() {
    let eye = Eye { course: Course::Rocket { acceleration: DVec3::Z }, ..Eye::at(0.0, DVec3::ZERO) };
    // It falls away from the start, and crosses z = t - 1 at its own lab time 1/1.5.
    let body = Body::of(ball(0.01, DVec3::ZERO), glowing(black_body(1e7)))
        .moving(Velocity::from_beta(v(0.0, 0.0, -0.5)).unwrap());
    for tau in [2.0, 8.0, 16.0] {
        let scene = Stage::of([body.clone()]).seen_by(&eye);
        let tetrad = scene.observer.worldline.at(tau);
        let first = scene.lit().first(&tetrad.sight_ray(DVec3::NEG_Z)).unwrap();
        assert!(first.emission.t < 2.0 / 3.0 + 1e-2, "{}", first.emission.t);
    }
}

/// Round a lamp at 0.9999 c: the lamp is seen cos α = β off the way that the observer goes, its light D = γ.
#[test]
fn orbit_at_0_9999_c_sees_its_centre_by_gamma_and_where_aberration_puts_it() {
    let velocity = Velocity::from_beta(v(0.9999, 0.0, 0.0)).unwrap();
    let (gamma, beta) = (velocity.gamma(), 0.9999);
    let axis = v(2.0, 3.0, -6.0) / 7.0;
    let centre = v(5.0, -1.0, 3.0);
    let circle = Circle::around(centre, axis, 10.0, 0.3);
    for sense in [1.0, -1.0] {
        let course = Course::Orbit { circle, proper_speed: sense * velocity.proper().x };
        let worldline = Worldline::new(Event::ORIGIN, Velocity::REST, DQuat::IDENTITY, course.clone());
        for tau in [0.0, 0.01, 1.7, 300.0, -4e4, 1e6] {
            let tetrad = worldline.at(tau);
            let radius = tetrad.event.x - centre;
            close(radius.length(), 10.0, 1e-14);
            close(tetrad.velocity().t, gamma, 1e-12);
            near(tetrad.velocity().x.dot(radius), 0.0, 1e-10);
            near(tetrad.event.t, gamma * tau, 1e-14 * gamma * f64::abs(tau));
            let body = Body::of(ball(0.1, centre), glowing(black_body(5000.0 / gamma)));
            let eye = Eye { course: course.clone(), aim: Aim::Along(DVec3::X), ..Eye::at(0.0, DVec3::ZERO) };
            let scene = Stage::of([body]).seen_by(&eye);
            let light = FourVector::new(10.0, radius);
            let toward = tetrad.direction_of(light);
            let first = scene.lit().first(&tetrad.sight_ray(toward)).unwrap();
            close(first.doppler.factor(), gamma, 1e-10);
            // The axes are the pure boost of the lab's: the way is the same in both.
            let way = tetrad.velocity().x / tetrad.velocity().x.length();
            near(toward.dot(way), beta, 1e-10);
            assert!(exposed::<8>(&scene, tau, (12, 8)).iter().all(|xyz| xyz.is_finite()));
        }
    }
}

/// Out and back again at γ = 1e8, among bodies at rest: pictures of numbers all the way.
#[test]
fn journey_at_gamma_1e8_leaves_only_numbers() {
    let mesh = built(icosphere(2));
    for along in [DVec3::NEG_Z, v(2.0, 3.0, -6.0) / 7.0] {
        for sign in [1.0, -1.0] {
            let moves = Velocity::from_gamma(1e8, along * sign);
            let bodies = (1..6).map(|i| {
                let i = f64::from(i);
                Body::new(&mesh, glowing(black_body(1e-3))).at(0.0, along * (10.0 * i) + v(0.0, 3.0, 0.0))
            });
            let eye = Eye::at(0.0, DVec3::ZERO).moving(moves).toward(along);
            let scene = Stage::of(bodies).seen_by(&eye);
            for tau in [-1.0, -1e-7, -1e-8, 0.0, 1e-8, 1e-7, 1.0] {
                assert!(exposed::<8>(&scene, tau, (12, 8)).iter().all(|xyz| xyz.is_finite()));
            }
        }
    }
}
