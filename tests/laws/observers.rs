//! Worldlines: rockets, circles, and boosts that follow one another.

use super::{FORWARD, Worst, chapter, gamma};
use crate::support::{
    Body, Dice, Stage, along, angle, ball, black, built, edge, first, icosphere, light_from, v,
};
use glam::{DQuat, DVec3};
use terrell::spacetime::{Boost, Circle, Course, Event, Lab, Lorentz, Rest, Tetrad, Velocity, Worldline};

chapter! {
    "Observers":
    rocket_moves_on_a_hyperbola, "V9", "t = sinh(aτ)/a, x = (cosh(aτ) − 1)/a, v = tanh(aτ)", "Rindler, Relativity", 1e-12;
    rocket_sees_ahead_blue, "V9", "D = exp(aτ) straight ahead, exp(−aτ) astern", "Rindler, Relativity", 1e-11;
    one_g_reaches_the_stars, "V9", "t, x, γ after 1, 2, 5, 8, 12 years at 9.80665 m/s², v after 1 and 2 (six digits)", "Rindler, Relativity", 4e-6;
    circling_clock_runs_slow, "V9", "t = γτ", "Einstein 1905 §4", 1e-12;
    circling_observer_sees_the_centre_blue, "V9", "D = γ", "Einstein 1905 §7", 1e-12;
    centre_sees_what_circles_red, "V9", "D = 1/γ", "Einstein 1905 §7", 1e-12;
    rindler_observers_see_each_other_shifted, "V9", "D = Xₑ/Xₒ", "Rindler, Relativity", 1e-12;
    crossed_boosts_turn_by_the_wigner_angle, "V14", "cos Ω = (γ₁ + γ₂)/(1 + γ₁γ₂), γ = γ₁γ₂", "Wigner 1939", 1e-12;
    any_two_boosts_turn_by_the_wigner_angle, "V14", "1 + cos Ω = (1 + γ + γ₁ + γ₂)²/[(1 + γ)(1 + γ₁)(1 + γ₂)]", "Macfarlane 1962", 1e-12;
    camera_keeps_the_turn_of_its_crossed_motions, "V14", "seen by who has all the speed at once, turned by Ω from the first motion to the second", "Wigner 1939", 1e-12;
    composed_velocity_is_the_sum_of_einstein, "V14", "β = [β₁ + β₂/γ₁ + γ₁β₁(β₁·β₂)/(1 + γ₁)]/(1 + β₁·β₂)", "Einstein 1905 §5", 1e-12;
}

fn rocket(acceleration: DVec3) -> Worldline {
    Worldline::new(Event::ORIGIN, Velocity::REST, DQuat::IDENTITY, Course::Rocket { acceleration })
}

/// For many accelerations and times: (a, τ, aτ, direction, the rocket then).
fn rockets(mut each: impl FnMut(f64, f64, DVec3, Tetrad)) {
    let mut dice = Dice(9);
    for _ in 0..200 {
        let (a, tau) = (dice.between(0.01, 2.0), dice.between(-3.0, 3.0));
        let along = dice.direction();
        each(a, tau / a, along, rocket(along * a).at(tau / a));
    }
}

fn rocket_moves_on_a_hyperbola() -> f64 {
    let mut worst = Worst::default();
    rockets(|a, tau, along, tetrad| {
        worst.part(tetrad.event.t, libm::sinh(a * tau) / a);
        worst.error(
            (tetrad.event.x - along * ((libm::cosh(a * tau) - 1.0) / a)).length() * a / libm::cosh(a * tau),
        );
        let u = tetrad.velocity();
        worst.places(u.x / u.t, along * libm::tanh(a * tau));
    });
    worst.0
}

fn rocket_sees_ahead_blue() -> f64 {
    let mut worst = Worst::default();
    let sky = Body::new(&built(icosphere(2)), black()).sized(1e4);
    let scene = Stage::of([sky]).scene();
    rockets(|a, tau, along, tetrad| {
        for (side, doppler) in [(along, libm::exp(a * tau)), (-along, libm::exp(-a * tau))] {
            let found = first(&scene, &tetrad.sight_ray(side));
            worst.part(found.doppler.factor(), doppler);
            worst.must((found.emission.x - tetrad.event.x).dot(side) > 0.0);
        }
    });
    worst.0
}

fn one_g_reaches_the_stars() -> f64 {
    let mut worst = Worst::default();
    let light = 299_792_458.0;
    let year = 365.25 * 86_400.0 * light;
    let g = 9.806_65 / (light * light);
    let table = [
        (1.0, 1.187_312, 0.563_642, 1.581_845),
        (2.0, 3.756_289, 2.910_475, 4.004_470),
        (5.0, 84.4797, 83.5166, 87.2138),
        (8.0, 1869.51, 1868.54, 1929.88),
        (12.0, 116_146.9, 116_146.0, 119_897.9),
    ];
    for (years, t, distance, gamma) in table {
        let tetrad = rocket(FORWARD * g).at(years * year);
        worst.part(tetrad.event.t / year, t);
        worst.part(tetrad.event.x.length() / year, distance);
        worst.part(tetrad.velocity().t, gamma);
    }
    for (years, speed) in [(1.0, 0.774_827), (2.0, 0.968_318)] {
        let u = rocket(FORWARD * g).at(years * year).velocity();
        worst.part(u.x.length() / u.t, speed);
    }
    worst.0
}

/// Someone who circles at a speed, and the circle.
fn circling(b: f64) -> (Worldline, Circle) {
    let circle = Circle::around(v(1.0, 2.0, 3.0), v(1.0, -2.0, 2.0), 4.0, 0.7);
    let course = Course::Orbit { circle, proper_speed: b * gamma(b) };
    (Worldline::new(Event::new(5.0, DVec3::ZERO), Velocity::REST, DQuat::IDENTITY, course), circle)
}

const MOMENTS: [f64; 5] = [-13.0, -1.0, 0.0, 2.0, 31.0];
const SPEEDS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.9, 0.99];

fn circling_clock_runs_slow() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (worldline, circle) = circling(b);
        for tau in MOMENTS {
            let event = worldline.at(tau).event;
            worst.error((event.t - 5.0 - gamma(b) * tau).abs() / (1.0 + gamma(b) * tau.abs()));
            // On the circle, at β: an arc of βγτ.
            let radius = event.x - circle.centre;
            worst.part(radius.length(), 4.0);
            let arc = b * gamma(b) * tau / 4.0;
            let place = circle.radius * libm::cos(arc) + circle.quarter * libm::sin(arc);
            worst.error((radius - place).length() / (1.0 + arc.abs()));
        }
    }
    worst.0
}

fn circling_observer_sees_the_centre_blue() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (worldline, circle) = circling(b);
        let lamp = Body::new(&built(icosphere(3)), black()).sized(1e-3).at(0.0, circle.centre);
        let scene = Stage::of([lamp]).scene();
        for tau in MOMENTS {
            let tetrad = worldline.at(tau);
            let n = tetrad.direction_of(light_from(circle.centre, tetrad.event).k);
            worst.part(first(&scene, &tetrad.sight_ray(n)).doppler.factor(), gamma(b));
        }
    }
    worst.0
}

/// A small body that moves along with someone at a moment.
fn beside(who: &Tetrad) -> Body {
    let moves = Velocity::from_proper(who.velocity().x);
    Body::of(ball(1e-9, DVec3::ZERO), black()).at(who.event.t, who.event.x).moving(moves)
}

fn centre_sees_what_circles_red() -> f64 {
    let mut worst = Worst::default();
    for b in SPEEDS {
        let (worldline, circle) = circling(b);
        for tau in MOMENTS {
            let tetrad = worldline.at(tau);
            let arrival = Event::new(tetrad.event.t + 4.0, circle.centre);
            let found = first(&Stage::of([beside(&tetrad)]).scene(), &light_from(tetrad.event.x, arrival));
            worst.part(found.doppler.factor(), 1.0 / gamma(b));
        }
    }
    worst.0
}

/// At X from the horizon the acceleration is 1/X.
fn rindler_observers_see_each_other_shifted() -> f64 {
    let mut worst = Worst::default();
    let at = |place: f64| {
        let course = Course::Rocket { acceleration: FORWARD / place };
        Worldline::new(Event::new(0.0, FORWARD * place), Velocity::REST, DQuat::IDENTITY, course)
    };
    for (emitter, receiver) in [(1.0, 2.0), (2.0, 1.0), (0.3, 0.7), (5.0, 0.9)] {
        for sent in [-0.7, 0.0, 0.4] {
            let sent = at(emitter).at(sent);
            let way = FORWARD * f64::signum(receiver - emitter);
            let early = |tau: f64| {
                let event = at(receiver).at(tau).event;
                event.t - sent.event.t < (event.x - sent.event.x).dot(way)
            };
            let tau = edge(-20.0 * receiver, 20.0 * receiver, early);
            let seer = at(receiver).at(tau);
            let n = seer.direction_of(light_from(sent.event.x, seer.event).k);
            let found = first(&Stage::of([beside(&sent)]).scene(), &seer.sight_ray(n));
            worst.part(found.doppler.factor(), emitter / receiver);
        }
    }
    worst.0
}

/// One boost after the other: the first velocity, the second as seen from the first, all that, and the turn.
fn composed(mut each: impl FnMut(Velocity, Velocity, Velocity, DQuat), crossed: bool) {
    let mut dice = Dice(14);
    for _ in 0..300 {
        let (b1, b2) = (dice.between(0.01, 0.95), dice.between(0.01, 0.95));
        let one = dice.direction();
        let other = if crossed { one.cross(dice.direction()).normalize() } else { dice.direction() };
        let [first, second] = [(b1, one), (b2, other)].map(|(b, n)| crate::support::speed(b, n));
        let a = Lorentz::from(Boost::<Rest, Lab>::to_moving(first));
        let both = Lorentz::from(Boost::<Lab, Rest>::to_moving(second)) * a;
        let (velocity, turn) = both.boost_then_rotation();
        each(first, second, velocity, turn);
    }
}

/// cos of the angle of a turn.
fn cosine(turn: DQuat) -> f64 {
    1.0 - 2.0 * turn.xyz().length_squared()
}

fn crossed_boosts_turn_by_the_wigner_angle() -> f64 {
    let mut worst = Worst::default();
    composed(
        |first, second, both, turn| {
            let (g1, g2) = (first.gamma(), second.gamma());
            worst.apart(cosine(turn), (g1 + g2) / (1.0 + g1 * g2));
            worst.part(both.gamma(), g1 * g2);
            // About the axis across both, from the first to the second.
            worst.must(angle(turn.xyz() * turn.w, first.proper().cross(second.proper())) < 1e-3);
        },
        true,
    );
    worst.0
}

fn any_two_boosts_turn_by_the_wigner_angle() -> f64 {
    let mut worst = Worst::default();
    composed(
        |first, second, both, turn| {
            let (g, g1, g2) = (both.gamma(), first.gamma(), second.gamma());
            let sum = 1.0 + g + g1 + g2;
            worst.apart(1.0 + cosine(turn), sum * sum / ((1.0 + g) * (1.0 + g1) * (1.0 + g2)));
        },
        false,
    );
    worst.0
}

/// A camera in motion starts as a rocket at right angles to that: its picture of the sky is that of a pure boost, turned.
fn camera_keeps_the_turn_of_its_crossed_motions() -> f64 {
    let (mut worst, mut dice) = (Worst::default(), Dice(140));
    let scene = Stage::of([Body::new(&built(icosphere(2)), black()).sized(1e3)]).scene();
    for (b1, b2, degrees) in
        [(0.5, 0.5, 8.2132), (0.6, 0.8, 18.924_64), (0.9, 0.3, f64::NAN), (0.1, 0.95, f64::NAN)]
    {
        let one = dice.direction();
        let acceleration = one.cross(dice.direction()).normalize();
        let course = Course::Rocket { acceleration };
        let start = crate::support::speed(b1, one);
        let seer = Worldline::new(Event::ORIGIN, start, DQuat::IDENTITY, course).at(libm::atanh(b2));
        let (g1, g2) = (gamma(b1), gamma(b2));
        let angle = libm::acos((g1 + g2) / (1.0 + g1 * g2));
        worst.must(degrees.is_nan() || (angle.to_degrees() - degrees).abs() < 5e-5);
        let turn = DQuat::from_axis_angle(one.cross(acceleration), angle);
        // All the speed at once, across the first as slow as that frame's clocks: β₁ + β₂/γ₁, γ = γ₁γ₂.
        let all = Velocity::from_proper((one * b1 + acceleration * (b2 / g1)) * (g1 * g2));
        for _ in 0..30 {
            let n = dice.direction();
            let star = first(&scene, &seer.sight_ray(n)).emission.x - seer.event.x;
            worst.directions(n, turn * -along(all, -star / star.length()));
        }
    }
    worst.0
}

fn composed_velocity_is_the_sum_of_einstein() -> f64 {
    let mut worst = Worst::default();
    composed(
        |first, second, both, _| {
            let (one, other, g) = (first.beta(), second.beta(), first.gamma());
            let sum = one + other / g + one * (g / (1.0 + g) * one.dot(other));
            worst.places(both.beta(), sum / (1.0 + one.dot(other)));
        },
        false,
    );
    worst.0
}
