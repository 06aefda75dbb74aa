//! Where a moving observer sees what stands still, and at which frequency.

use super::{FORWARD, SPEEDS, Worst, aside, chapter, gamma};
use crate::support::{
    Body, Dice, Eye, Stage, angle, black_body, built, edge, first, frequency, glowing, icosphere, line, look,
    speed, v,
};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::scene::Scene;
use terrell::spacetime::Velocity;
use terrell::spectrum::Source;

chapter! {
    "Directions and frequencies":
    starlight_is_aberrated, "V1", "cos θ′ = (cos θ + β)/(1 + β cos θ), in one plane with the motion", "Einstein 1905 §7", 1e-11;
    half_angles_shrink_by_one_factor, "V1", "tan(θ′/2) = √((1−β)/(1+β)) tan(θ/2)", "Penrose 1959", 1e-10;
    front_half_of_the_sky_is_a_cone, "V1", "half angle arccos β", "Penrose 1959", 1e-12;
    stars_of_the_year_move_by_the_angle_of_bradley, "V1", "sin α = β at right angles to the motion; seconds of arc", "Bradley 1727", 1e-9;
    frequency_goes_by_the_angle_of_the_source, "V2", "D = γ(1 + β cos θ)", "Einstein 1905 §7", 1e-11;
    frequency_goes_by_the_angle_that_is_seen, "V2", "D = 1/[γ(1 − β cos θ′)]", "Einstein 1905 §7", 1e-12;
    approach_and_recession_are_reciprocal, "V2", "D(0) = √((1+β)/(1−β)) = 1/D(π)", "Einstein 1905 §7", 1e-11;
    colours_are_unshifted_on_one_cone, "V2", "cos θ′ = (1 − 1/γ)/β", "D = 1", 1e-12;
    light_seen_square_to_the_motion_is_red, "V2", "D = 1/γ", "Einstein 1905 §7", 1e-11;
    both_ends_may_move, "V2", "D = γₒ(1 − βₒ·n)/[γₛ(1 − βₛ·n)]", "k·u", 1e-12;
    sodium_line_arrives_shifted, "V2", "589 nm at λ/D with the power D⁴", "Einstein 1905 §7", 1e-11;
}

/// A sky at rest that shines, and an observer who moves through it.
fn under_the_sky(source: Source, velocity: Velocity) -> (Scene, Eye) {
    let sky = Body::new(&built(icosphere(2)), glowing(source)).sized(50.0);
    let eye = Eye::at(0.7, v(1.0, 2.0, 3.0)).moving(velocity);
    (Stage::of([sky]).seen_by(&eye), eye)
}

/// For observers of many speeds and for all directions in which they look: (β, direction seen, direction of the star, D).
fn looks(mut each: impl FnMut(f64, DVec3, DVec3, f64)) {
    let mut dice = Dice(1);
    for b in SPEEDS {
        let forward = dice.direction();
        let turn = glam::DQuat::from_rotation_arc(forward, FORWARD);
        let (scene, eye) = under_the_sky(black_body(5000.0), speed(b, forward));
        for _ in 0..200 {
            let n = dice.direction();
            let ray = eye.sight(n);
            let found = first(&scene, &ray);
            // From the place where the light left: not from the ray's own numbers.
            let star = found.emission.x - ray.event.x;
            each(b, turn * n, turn * (star / star.length()), found.doppler.factor());
        }
    }
}

fn starlight_is_aberrated() -> f64 {
    let mut worst = Worst::default();
    looks(|b, seen, star, _| {
        let cos = star.dot(FORWARD);
        worst.apart(seen.dot(FORWARD), (cos + b) / (1.0 + b * cos));
        worst.apart(seen.dot(star.cross(FORWARD)), 0.0);
        worst.must(seen.cross(FORWARD).dot(star.cross(FORWARD)) > 0.0);
    });
    worst.0
}

fn half_angles_shrink_by_one_factor() -> f64 {
    let mut worst = Worst::default();
    looks(|b, seen, star, _| {
        let tan = |n: DVec3| libm::tan(0.5 * angle(n, FORWARD));
        worst.part(tan(seen), ((1.0 - b) / (1.0 + b)).sqrt() * tan(star));
    });
    worst.0
}

fn frequency_goes_by_the_angle_of_the_source() -> f64 {
    let mut worst = Worst::default();
    looks(|b, _, star, doppler| worst.part(doppler, gamma(b) * (1.0 + b * star.dot(FORWARD))));
    worst.0
}

fn frequency_goes_by_the_angle_that_is_seen() -> f64 {
    let mut worst = Worst::default();
    looks(|b, seen, _, doppler| worst.part(doppler, 1.0 / (gamma(b) * (1.0 - b * seen.dot(FORWARD)))));
    worst.0
}

/// D as seen at an angle from the motion.
fn doppler(scene: &Scene, eye: &Eye, theta: f64, around: f64) -> f64 {
    first(scene, &eye.sight(aside(FORWARD, theta, around))).doppler.factor()
}

fn front_half_of_the_sky_is_a_cone() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(b, FORWARD));
        let sky = Body::new(&built(icosphere(3)), glowing(black_body(5000.0))).sized(1e3);
        let scene = Stage::of([sky]).seen_by(&eye);
        for around in [0.0, 1.0, 2.5, 4.0] {
            let ahead = |theta: f64| {
                first(&scene, &eye.sight(aside(FORWARD, theta, around))).emission.x.dot(FORWARD) > 0.0
            };
            worst.apart(edge(0.0, PI, ahead), libm::acos(b));
        }
    }
    worst.0
}

fn stars_of_the_year_move_by_the_angle_of_bradley() -> f64 {
    let mut worst = Worst::default();
    let orbit = 29.7827e3 / 299_792_458.0;
    let (scene, eye) = under_the_sky(black_body(5000.0), speed(orbit, FORWARD));
    let seconds = |angle: f64| angle.to_degrees() * 3600.0;
    for around in 0..12 {
        // The telescope leans forward by it, and sees the star that stands at right angles.
        let seen = aside(FORWARD, FRAC_PI_2 - libm::asin(orbit), 0.5 * f64::from(around));
        let ray = eye.sight(seen);
        let star = first(&scene, &ray).emission.x - ray.event.x;
        worst.apart(seconds(angle(seen, star)), seconds(libm::asin(orbit)));
        worst.error(seconds((angle(star, FORWARD) - FRAC_PI_2).abs()));
        worst.must((seconds(angle(seen, star)) - 20.491).abs() < 5e-4);
    }
    worst.0
}

fn approach_and_recession_are_reciprocal() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (scene, eye) = under_the_sky(black_body(5000.0), speed(b, FORWARD));
        let (ahead, astern) = (doppler(&scene, &eye, 0.0, 0.0), doppler(&scene, &eye, PI, 0.0));
        worst.part(ahead, ((1.0 + b) / (1.0 - b)).sqrt());
        worst.part(astern, ((1.0 - b) / (1.0 + b)).sqrt());
    }
    worst.0
}

fn colours_are_unshifted_on_one_cone() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS.into_iter().skip(1) {
        let (scene, eye) = under_the_sky(black_body(5000.0), speed(b, FORWARD));
        let cone = edge(0.0, 3.0, |theta| doppler(&scene, &eye, theta, 1.0) > 1.0);
        worst.apart(libm::cos(cone), (1.0 - 1.0 / gamma(b)) / b);
    }
    worst.0
}

fn light_seen_square_to_the_motion_is_red() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (scene, eye) = under_the_sky(black_body(5000.0), speed(b, FORWARD));
        for around in 0..8 {
            worst.part(doppler(&scene, &eye, FRAC_PI_2, f64::from(around)), 1.0 / gamma(b));
        }
    }
    worst.0
}

fn both_ends_may_move() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(7));
    let ball = built(icosphere(2));
    for _ in 0..300 {
        let speeds = [dice.between(0.0, 0.99), dice.between(0.0, 0.99)];
        let [source, observer] = speeds.map(|b| dice.velocity(b));
        let body = Body::new(&ball, glowing(black_body(5000.0))).moving(source).sized(1e3);
        let eye = Eye::at(0.2, dice.in_cube()).moving(observer);
        let scene = Stage::of([body]).seen_by(&eye);
        let ray = eye.sight(dice.direction());
        let found = first(&scene, &ray);
        let way = ray.event.x - found.emission.x;
        let n = way / way.length();
        worst.part(found.doppler.factor(), frequency(observer, n) / frequency(source, n));
    }
    worst.0
}

fn sodium_line_arrives_shifted() -> f64 {
    let mut worst = Worst::default();
    for b in [0.05, 0.1, 0.2, 0.3] {
        let (scene, eye) = under_the_sky(line(589.0, 2.0), speed(b, FORWARD));
        for i in 0..=20 {
            let theta = PI * f64::from(i) / 20.0;
            let doppler = 1.0 / (gamma(b) * (1.0 - b * libm::cos(theta)));
            let light = look(&scene, &eye.sight(aside(FORWARD, theta, f64::from(i))));
            let expected = matching(589.0 / doppler) * (LUMENS_PER_WATT * 2.0 * doppler.powi(4));
            worst.part_of_vector(light.lines, expected);
        }
    }
    worst.0
}
