//! Moving mirrors. Einstein 1905 §8.
//!
//! For a mirror that recedes along its normal at β, light at φ to the normal leaves at φ'' with another frequency:
//!
//! ~~~text
//! cos φ'' = [(1 + β²) cos φ - 2β]/(1 - 2β cos φ + β²)        ν''/ν = (1 - 2β cos φ + β²)/(1 - β²)
//! ~~~

use crate::support::{
    Body, Dice, Eye, Stage, beta, black_body, built, close, edge, flat, glowing, icosphere, is_bright,
    light_from, look, mirror, near, speed, square, v,
};
use glam::{DQuat, DVec3};
use terrell::scene::Scene;
use terrell::spacetime::{Event, SightRay, Velocity};
use terrell::spectrum::{Wavelengths, planck};

fn turn() -> DQuat {
    DQuat::from_axis_angle(v(6.0, 2.0, -3.0) / 7.0, 1.9)
}

/// A large mirror whose normal is the (turned) x axis, that recedes from x > 0 at β; at x = 0 at time 0.
fn receding(beta: f64) -> Body {
    let surface = Body::new(&built(square()), mirror(1.0)).sized(1e4).facing(turn() * DVec3::X);
    surface.moving(Velocity::from_beta(turn() * DVec3::NEG_X * beta).unwrap())
}

/// Light that left the mirror's place at time 0 at φ'' to the normal, arriving 2 m away.
fn leaving(outgoing: f64) -> SightRay {
    let (sin, cos) = libm::sincos(outgoing);
    let n = turn() * v(cos, sin, 0.0);
    light_from(DVec3::ZERO, Event::new(2.0, n * 2.0))
}

/// By how much the temperature of a black body has changed on the way.
fn temperature_ratio(scene: &Scene, ray: &SightRay, kelvin: f64) -> f64 {
    // Two wavelengths: the ratio of radiances gives the temperature, and then the amount must fit too.
    let light = look(scene, ray);
    let nm = Wavelengths::<64>::new().nm;
    let falls = |ratio: f64| {
        planck(nm[0], kelvin * ratio) / planck(nm[63], kelvin * ratio)
            < light.radiance[0] / light.radiance[63]
    };
    let ratio = edge(0.02, 50.0, falls);
    for (nm, value) in nm.iter().zip(light.radiance) {
        close(value, planck(*nm, kelvin * ratio), 1e-8);
    }
    ratio
}

#[test]
fn moving_mirror_turns_and_shifts_light_as_einstein_found() {
    let table = [(-0.1, 24.7308, 1.195_157), (0.1, 36.2666, 0.845_247), (0.5, 77.5880, 0.511_966)];
    let incidence = 30.0_f64.to_radians();
    let (sin, cos) = libm::sincos(incidence);
    for (b, outgoing, ratio) in table {
        // A far black body of 0.01 rad, in the direction from which the light has to come.
        let from = turn() * v(cos, -sin, 0.0) * 1e6;
        let star = Body::new(&built(icosphere(5)), glowing(black_body(5000.0))).at(0.0, from).sized(1e4);
        let scene = Stage::of([receding(b), star]).scene();
        let centre = outgoing_angle(b, incidence);
        near(centre.to_degrees(), outgoing, 5.1e-5);
        let sees = |angle: f64| is_bright(&scene, &leaving(angle));
        // From edge to edge: a small circle stays one, its middle off by the square of its size.
        let (low, high) = (edge(centre, centre - 0.1, sees), edge(centre, centre + 0.1, sees));
        near(low, outgoing_angle(b, incidence - 0.01), 2e-5);
        near(high, outgoing_angle(b, incidence + 0.01), 2e-5);
        let got = temperature_ratio(&scene, &leaving(centre), 5000.0);
        near(got, ratio, 5.1e-7);
        close(got, (1.0 - 2.0 * b * cos + b * b) / (1.0 - b * b), 1e-12);
        // Off the plane of incidence there is nothing.
        let aside = leaving(centre).event.x + turn() * v(0.0, 0.0, 0.1);
        let aside = light_from(DVec3::ZERO, Event::new(aside.length(), aside));
        assert!(!is_bright(&scene, &aside));
    }
}

/// φ'' of light that meets the mirror at φ.
fn outgoing_angle(b: f64, incidence: f64) -> f64 {
    let cos = libm::cos(incidence);
    libm::acos(((1.0 + b * b) * cos - 2.0 * b) / (1.0 - 2.0 * b * cos + b * b))
}

/// A sky at rest around everything, large enough not to reach the mirror's edge.
fn sky() -> Body {
    Body::new(&built(icosphere(3)), glowing(black_body(5000.0))).sized(1e7)
}

#[test]
fn own_light_comes_back_shifted_twice() {
    for (b, expected) in [(0.1, 0.818_182), (0.5, 0.333_333), (-0.1, 1.222_222), (-0.5, 3.0)] {
        let scene = Stage::of([receding(b), sky()]).scene();
        let ratio = temperature_ratio(&scene, &leaving(0.0), 5000.0);
        near(ratio, expected, 5.1e-7);
        close(ratio, (1.0 - b) / (1.0 + b), 1e-12);
    }
}

#[test]
fn mirror_sliding_in_its_own_plane_changes_nothing() {
    for b in [0.0, 0.3, 0.95] {
        let slides = Body::new(&built(square()), mirror(1.0)).sized(1e4).facing(turn() * DVec3::X);
        let slides = slides.moving(speed(b, turn() * v(0.0, 3.0, 4.0)));
        let far = built(icosphere(5));
        for degrees in [10.0_f64, 45.0, 80.0] {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let star = Body::new(&far, glowing(black_body(5000.0)))
                .at(0.0, turn() * v(cos, -sin, 0.0) * 1e5)
                .sized(1e2);
            let scene = Stage::of([slides.clone(), star]).scene();
            close(temperature_ratio(&scene, &leaving(degrees.to_radians()), 5000.0), 1.0, 1e-9);
            let sees = |angle: f64| is_bright(&scene, &leaving(angle));
            let at = degrees.to_radians();
            near(edge(at, at + 0.02, sees) - at, 1e-3, 1e-6);
            near(at - edge(at, at - 0.02, sees), 1e-3, 1e-6);
        }
    }
}

/// For any motion of the mirror: the light's wave vector before it, from the reflection of the mirror's rest frame.
#[test]
fn mirror_may_move_any_way() {
    let mut dice = Dice(31);
    let plane = built(square());
    for _ in 0..100 {
        let normal = dice.direction();
        let b = dice.between(0.0, 0.9);
        let moves = dice.velocity(b);
        let n = dice.direction();
        let plate = Body::new(&plane, mirror(0.7)).sized(1e3).facing(normal).moving(moves);
        let scene = Stage::of([plate, sky().sized(100.0)]).scene();
        let ray = light_from(DVec3::ZERO, Event::new(2.0, n * 2.0));
        // What a mirror does is Householder's map of spacetime with the (space-like) four-normal N: k - 2 N (k·N)/(N·N).
        let (u, gamma) = (moves.proper(), moves.gamma());
        let (normal_t, normal_x) = (u.dot(normal), normal + u * (u.dot(normal) / (gamma + 1.0)));
        let product = normal_t - n.dot(normal_x);
        // N·N = -1: the frequency before the mirror, in units of that after it.
        let before = 1.0 + 2.0 * product * normal_t;
        let light = look(&scene, &ray);
        for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(light.radiance) {
            close(value, 0.7 * planck(*nm, 5000.0 / before), 1e-11);
        }
    }
}

/// A mirror shows an earlier past. At 0 the eye at the origin looks at a mirror that is at x = d + βt, square to it;
/// the light met it at -d/(1 + β), and came from x = -5 at -2d/(1 + β) - 5.
#[test]
fn mirror_shows_an_earlier_past() {
    let (d, small) = (3.0, 1e-3);
    for b in [0.0, 0.5, -0.4] {
        let plate = Body::new(&built(square()), mirror(1.0)).sized(50.0).facing(turn() * DVec3::NEG_X);
        let plate = plate
            .at(0.0, turn() * v(d, 0.0, 0.0))
            .moving(Velocity::from_beta(turn() * v(b, 0.0, 0.0)).unwrap());
        let past = -2.0 * d / (1.0 + b) - 5.0;
        // A thing that dashes along y, at y = 0 only at that moment.
        let moves = speed(0.6, turn() * v(0.0, 4.0, 3.0));
        let thing = Body::new(&built(icosphere(2)), glowing(black_body(5000.0))).sized(small).moving(moves);
        let sees = |moment: f64| {
            let thing = thing.clone().at(moment, turn() * v(-5.0, 0.0, 0.0));
            is_bright(
                &Stage::of([plate.clone(), thing]).scene(),
                &Eye::at(0.0, DVec3::ZERO).sight(turn() * DVec3::X),
            )
        };
        assert!(sees(past), "β = {b}");
        near(edge(past, past + 1.0, sees) - past, 0.0, 3.0 * small / 0.6);
        near(edge(past, past - 1.0, sees) - past, 0.0, 3.0 * small / 0.6);
    }
}

/// Between two mirrors light takes one part of each: n of them, if the depth allows n.
#[test]
fn facing_mirrors_are_followed_to_the_depth_and_no_further() {
    let plate = built(square());
    // From y = 0 to 10 at x = ±1.
    let wall =
        |x: f64| Body::new(&plate, mirror(0.5)).sized(5.0).facing(v(-x, 0.0, 0.0)).at(0.0, v(x, 5.0, 0.0));
    let sky = Body::new(&built(icosphere(2)), glowing(flat(1.0))).sized(100.0);
    for bounces in 1..6_i32 {
        // Slanted so that the last of the bounces at y = s, 3s, 5s .. is below 10, the next above.
        let slope = 10.0 / (2.0 * f64::from(bounces));
        let ray = Eye::at(0.0, v(0.0, 0.0, 0.0)).sight(v(1.0, slope, 0.1));
        for depth in 0..7 {
            let mut stage = Stage::of([wall(1.0), wall(-1.0), sky.clone()]);
            stage.depth = depth;
            let expected = if depth >= bounces.cast_unsigned() { libm::ldexp(1.0, -bounces) } else { 0.0 };
            near(look(&stage.scene(), &ray).radiance[9], expected, 1e-15);
        }
    }
}

/// Mirrors closing in on each other heat the light they hold: (1 + β)/(1 - β) each time the moving one is met.
#[test]
fn closing_mirrors_heat_light_at_every_bounce() {
    let plate = built(square());
    let still = Body::new(&plate, mirror(1.0)).sized(50.0).facing(DVec3::X).at(0.0, v(-1.0, 0.0, 0.0));
    let approach = 0.2;
    let moving = Body::new(&plate, mirror(1.0)).sized(50.0).facing(DVec3::NEG_X).at(0.0, v(1.0, 0.0, 0.0));
    let moving = moving.moving(beta(-approach, 0.0, 0.0));
    let mut ratios = Vec::new();
    for slope in [12.0, 30.0, 60.0] {
        let scene = Stage { depth: 60, ..Stage::of([still.clone(), moving.clone(), sky()]) }.scene();
        let ray = Eye::at(0.0, v(0.0, 0.0, 0.0)).sight(v(1.0, slope, 0.0));
        ratios.push(temperature_ratio(&scene, &ray, 5000.0));
    }
    // Backwards in time the mirrors part: the ray meets the moving one a few times, each a Householder map.
    for (slope, ratio) in [12.0, 30.0, 60.0].iter().zip(ratios) {
        close(ratio, 1.0 / followed(*slope, approach), 1e-9);
    }
}

/// The same light followed by hand in the plane: the frequency with which it came in.
fn followed(slope: f64, approach: f64) -> f64 {
    let length = (1.0 + slope * slope).sqrt();
    let (mut t, mut x, mut y) = (0.0, 0.0, 0.0);
    // The light moves against the sight.
    let (mut w, mut kx, ky) = (1.0, -1.0 / length, -slope / length);
    loop {
        // Back to x = -1, or to the mirror at x = 1 - βt.
        let s = if kx > 0.0 { (x + 1.0) / kx } else { (1.0 - approach * t - x) / (-kx - approach * w) };
        if s <= 0.0 || (y - ky * s).abs() > 50.0 {
            return w;
        }
        (t, x, y) = (t - w * s, x - kx * s, y - ky * s);
        if kx > 0.0 {
            kx = -kx;
        } else {
            // Four-normal N = γ(β, -1): k + 2 N (k·N).
            let product = 2.0 * (approach * w + kx) / (1.0 - approach * approach);
            (w, kx) = (w + approach * product, kx - product);
        }
    }
}
