//! Far away, long ago, very small beside very large.

use super::sound_picture;
use crate::support::{
    Body, Eye, Lantern, Stage, ball, beta, black_body, built, close, cube, difference, diffuse, edge,
    exposed, flat, glowing, icosphere, is_bright, light_from, light_to, mirror, near, plane, v,
};
use glam::DVec3;
use terrell::lamp::Beam;
use terrell::spacetime::{Event, Velocity};

/// A lamp, a wall, a mirror, a moving cube and a moving ball, and who looks at them: everything by an event.
fn village(by: (f64, DVec3)) -> terrell::scene::Scene {
    let at = |t: f64, x: f64, y: f64, z: f64| (by.0 + t, by.1 + v(x, y, z));
    let put = |body: Body, (t, x): (f64, DVec3)| body.at(t, x);
    let bodies = [
        put(Body::of(plane(DVec3::ZERO, DVec3::Y), diffuse(0.5)), at(0.0, 0.0, -1.0, 0.0)),
        put(Body::new(&built(cube()), diffuse(0.7)), at(-4.0, -1.5, 0.25, -6.0)).moving(beta(0.6, 0.0, 0.1)),
        put(Body::of(ball(1.0, DVec3::ZERO), glowing(black_body(3000.0))), at(-5.0, 2.0, 0.5, -5.0))
            .moving(beta(-0.3, 0.0, 0.8)),
        put(Body::of(ball(1.0, DVec3::ZERO), mirror(0.8)), at(0.0, 0.0, 0.5, -7.0)),
    ];
    let (t, x) = at(0.0, 3.0, 5.0, -2.0);
    let lamps = [Lantern::at(t, x, flat(1.0)), Lantern::at(t, x, flat(1.0)).moving(beta(0.0, 0.0, -0.9))];
    let (t, x) = at(0.0, 0.0, 0.5, 0.0);
    Stage::of(bodies).lit_by(lamps).seen_by(&Eye::at(t, x).moving(beta(0.1, 0.0, 0.3)))
}

/// 1/64 m: exact also beside 1e9.
const DISTANCE: f64 = 1.0 / 64.0;

/// All places are written exactly at both ends, so that what differs is the arithmetic.
#[test]
fn picture_is_the_same_a_thousand_million_metres_and_metres_of_time_away() {
    let size = (120, 80);
    let right = exposed::<8>(&village((0.0, DVec3::ZERO)), 0.0, size);
    for far in [1e3, 1e6, 1e9] {
        let scene = village((far, v(far, -far, 0.5 * far)));
        let (worst, others) = difference(&right, &exposed::<8>(&scene, 0.0, size));
        assert!(worst <= 1e-15 * far + 1e-12 && others <= 3, "{far}: {worst}, {others} pixels differ");
        sound_picture(&scene);
    }
}

/// A ball of 1 mm on one of 1e6 m, whichever is told first, at rest and at γ = 1000: its outline, its shadow.
#[test]
fn ball_of_a_millimetre_lies_on_one_of_a_million_metres() {
    let (small, large) = (5e-4, 1e6);
    for gamma in [1.0, 1e3] {
        let moves = Velocity::from_gamma(gamma, DVec3::X);
        let pebble = Body::of(ball(small, DVec3::ZERO), glowing(flat(1.0))).moving(moves);
        let planet = Body::of(ball(large, v(0.0, -large - small, 0.0)), diffuse(0.5)).moving(moves);
        let sun =
            Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: DVec3::NEG_Y }).moving(moves);
        for bodies in [[pebble.clone(), planet.clone()], [planet.clone(), pebble.clone()]] {
            let stage = Stage::of(bodies).lit_by([sun.clone()]);
            let pebble_number = u32::from(stage.bodies[0].surface.glow.is_none());
            let eye = Eye::at(0.0, v(0.0, 0.0, 0.01)).moving(moves);
            let scene = stage.seen_by(&eye);
            let meets = |angle: f64| {
                let first = scene.lit().first(&eye.sight(v(libm::sin(angle), 0.0, -libm::cos(angle))));
                first.is_some_and(|first| first.body == pebble_number)
            };
            near(edge(0.0, 0.5, meets), libm::asin(small / 0.01), 1e-12 * gamma + 1e-9);
            // Its shadow on the large one, whose numbers end at 1e-10 m.
            let shaded = |x: f64| {
                let place = v(x, -small - x * x / (2.0 * large), 0.0);
                let toward = place - v(0.0, 0.0, 0.01);
                !is_bright(&scene, &eye.sight(toward))
            };
            close(edge(0.9 * small, 1.5 * small, shaded), small, 1e-4);
            sound_picture(&scene);
        }
    }
}

/// A bright ball of 1 mm, at 1e9 m, seen from 10 mm away and by light 1e9 m old.
#[test]
fn ball_of_a_millimetre_is_round_a_thousand_million_metres_away() {
    let centre = v(1e9, -1e9, 5e8);
    for t in [0.0, 1e9] {
        let body = Body::of(ball(1e-3, DVec3::ZERO), glowing(flat(1.0))).at(0.0, centre);
        let scene = Stage::of([body]).scene();
        let eye: Event = Event::new(t, centre + v(0.0, 0.0, DISTANCE));
        let meets = |angle: f64| {
            let toward = v(libm::sin(angle), 0.0, -libm::cos(angle));
            scene.world.nearest(&light_from(eye.x + toward * 1e9, eye)).is_some()
        };
        near(edge(0.0, 0.5, meets), libm::asin(1e-3 / DISTANCE), 1e-8);
    }
    // From a million metres it is still met along its axis.
    let body = Body::of(ball(1e-3, DVec3::ZERO), glowing(flat(1.0)));
    let scene = Stage::of([body]).scene();
    assert!(is_bright(&scene, &light_to(v(0.0, 0.0, 1e9), Event::ORIGIN)));
}

/// A mesh scaled to 1e-6 m and to 1e9 m is the same picture.
#[test]
fn picture_does_not_depend_on_the_unit_of_length() {
    let (ball, cube) = (built(icosphere(3)), built(cube()));
    let picture = |unit: f64| {
        let bodies = [
            Body::new(&ball, diffuse(0.5)).sized(unit).at(0.0, v(-1.5, 0.0, -5.0) * unit),
            Body::new(&cube, diffuse(0.5))
                .sized(unit)
                .at(0.0, v(1.5, -0.5, -6.0) * unit)
                .moving(beta(0.0, 0.3, 0.5)),
        ];
        let sun = Lantern::at(0.0, DVec3::ZERO, flat(1.0)).with(Beam::Sun { axis: v(-0.6, 0.0, -0.8) });
        exposed::<8>(&Stage::of(bodies).lit_by([sun]).scene(), 0.0, (60, 40))
    };
    let right = picture(1.0);
    for unit in [1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9] {
        let (worst, others) = difference(&right, &picture(unit));
        assert!(worst < 1e-10 && others == 0, "{unit}: {worst}, {others}");
    }
}
