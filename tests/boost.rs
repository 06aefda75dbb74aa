//! Boosts, and what they make together.

use crate::support::{angle, beta, close, near, near_vector, speed, v, vectors, velocities};
use glam::{DQuat, DVec3};
use proptest::prelude::{ProptestConfig, prop_assert, proptest};
use terrell::spacetime::{Boost, Event, FourVector, Lab, Lorentz, Poincare, Rest, Velocity};

type ToRest = Boost<Rest, Lab>;

/// The textbook's boost: along the motion and across it.
fn textbook(beta: DVec3, t: f64, x: DVec3) -> (f64, DVec3) {
    let direction = beta / beta.length();
    let gamma = 1.0 / (1.0 - beta.length_squared()).sqrt();
    let along = direction * x.dot(direction);
    (gamma * (t - beta.dot(x)), x - along + (along - beta * t) * gamma)
}

fn difference<F: terrell::spacetime::Frame>(a: FourVector<F>, b: FourVector<F>) -> f64 {
    let d = a - b;
    d.t.abs().max(d.x.abs().max_element())
}

#[test]
fn boost_is_the_one_of_the_textbook() {
    let velocity = beta(0.48, -0.6, 0.2);
    let got = ToRest::to_moving(velocity) * FourVector::new(0.7, v(-2.0, 3.0, 0.5));
    let (t, x) = textbook(v(0.48, -0.6, 0.2), 0.7, v(-2.0, 3.0, 0.5));
    near(got.t, t, 1e-14);
    near_vector(got.x, x, 1e-14);
}

/// What moves with the frame is at rest in it.
#[test]
fn own_four_velocity_becomes_pure_time() {
    let velocity = beta(0.3, 0.5, -0.7);
    let own = ToRest::to_moving(velocity) * velocity.four();
    near(own.t, 1.0, 1e-14);
    near_vector(own.x, DVec3::ZERO, 1e-14);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    // Rapidity 7.6 is γ = 1000.
    #[test]
    fn inverse_undoes_boost(velocity in velocities(7.6), t in -1.0..1.0_f64, x in vectors()) {
        let there = ToRest::to_moving(velocity);
        let vector = FourVector::new(t, x);
        let rounding = 8.0 * f64::EPSILON * velocity.gamma().powi(2);
        prop_assert!(difference(there.inverse() * (there * vector), vector) < rounding);
    }

    #[test]
    fn null_vectors_stay_null_and_products_stay(velocity in velocities(7.6), x in vectors(), y in vectors(), t in -1.0..1.0_f64) {
        let there = ToRest::to_moving(velocity);
        let rounding = 32.0 * f64::EPSILON * velocity.gamma().powi(2);
        let light = FourVector::new(x.length(), x);
        let seen = there * light;
        prop_assert!(seen.dot(seen).abs() < rounding);
        prop_assert!(seen.t > 0.0);
        let other = FourVector::new(t, y);
        prop_assert!(((there * other).dot(seen) - other.dot(light)).abs() < rounding);
    }

    #[test]
    fn composition_is_one_map_after_the_other(first in velocities(3.0), second in velocities(3.0), t in -1.0..1.0_f64, x in vectors()) {
        let (a, b) = (ToRest::to_moving(first), Boost::<Lab, Rest>::to_moving(second));
        let vector = FourVector::new(t, x);
        let rounding = 32.0 * f64::EPSILON * first.gamma() * second.gamma();
        let both = Lorentz::from(b) * Lorentz::from(a);
        prop_assert!(difference(both * vector, b * (a * vector)) < rounding);
        let rounding = rounding * first.gamma() * second.gamma();
        prop_assert!(difference(both.inverse() * (both * vector), vector) < 8.0 * rounding);
    }

    #[test]
    fn boost_then_rotation_is_the_map_itself(velocity in velocities(7.6), axis in vectors(), turn in -3.0..3.0_f64, t in -1.0..1.0_f64, x in vectors()) {
        let turn = DQuat::from_axis_angle(axis / axis.length(), turn);
        let map: Lorentz<Rest, Lab> = Lorentz::<Rest, Rest>::rotation(turn) * Lorentz::from(ToRest::to_moving(velocity));
        let (found, rotation) = map.boost_then_rotation();
        prop_assert!((found.proper() - velocity.proper()).length() < 1e-14 * velocity.gamma());
        // The rotation is read off after boosting back: it has the digits that γ² leaves.
        let rounding = 32.0 * f64::EPSILON * velocity.gamma().powi(2);
        prop_assert!(rotation.dot(turn).abs() > 1.0 - rounding);
        prop_assert!(((rotation * x) - (turn * x)).length() < rounding);
        let again = Lorentz::<Rest, Rest>::rotation(rotation) * Lorentz::from(ToRest::to_moving(found));
        let vector = FourVector::new(t, x);
        prop_assert!(difference(again * vector, map * vector) < rounding * velocity.gamma());
    }

    /// cos Ω = (1 + γ + γ₁ + γ₂)² / ((1 + γ)(1 + γ₁)(1 + γ₂)) - 1, with γ of the composite (Macfarlane 1962).
    #[test]
    fn any_two_boosts_turn_by_the_wigner_angle(first in velocities(3.0), second in velocities(3.0)) {
        let both = Lorentz::from(Boost::<Lab, Rest>::to_moving(second)) * Lorentz::from(ToRest::to_moving(first));
        let (velocity, turn) = both.boost_then_rotation();
        let (g, g1, g2) = (velocity.gamma(), first.gamma(), second.gamma());
        prop_assert!((g / (g1 * g2 * (1.0 + first.beta().dot(second.beta()))) - 1.0).abs() < 1e-11);
        let cos = (1.0 + g + g1 + g2).powi(2) / ((1.0 + g) * (1.0 + g1) * (1.0 + g2)) - 1.0;
        prop_assert!((libm::cos(turn_angle(turn)) - cos).abs() < 1e-10);
        // About the axis across both: coordinates turn from the first towards the second.
        let across = first.proper().cross(second.proper());
        if across.length() > 0.1 {
            prop_assert!(angle(turn.xyz() * turn.w.signum(), across) < 1e-6);
        }
    }
}

fn turn_angle(turn: DQuat) -> f64 {
    2.0 * libm::atan2(turn.xyz().length(), turn.w.abs())
}

#[test]
fn crossed_boosts_turn_by_the_wigner_angle() {
    let table = [
        (0.5, 0.5, 7.0_f64.sqrt() / 4.0, 4.0 / 3.0, libm::acos(4.0 * 3.0_f64.sqrt() / 7.0)),
        (0.6, 0.8, 0.877_268_5, 25.0 / 12.0, 18.924_64_f64.to_radians()),
    ];
    let (one, other) = (v(1.0, 2.0, 2.0) / 3.0, v(2.0, 1.0, -2.0) / 3.0);
    for (first, second, total, gamma, turn) in table {
        let a = Lorentz::from(ToRest::to_moving(speed(first, one)));
        let b = Lorentz::from(Boost::<Lab, Rest>::to_moving(speed(second, other)));
        let (velocity, rotation) = (b * a).boost_then_rotation();
        near(velocity.beta().length(), total, 5e-8);
        close(velocity.gamma(), gamma, 1e-13);
        near(turn_angle(rotation), turn, 1e-7);
        let (g1, g2) = (speed(first, one).gamma(), speed(second, other).gamma());
        near(turn_angle(rotation), libm::acos((g1 + g2) / (1.0 + g1 * g2)), 1e-12);
        // Across the first the second's motion is slowed by its γ: β = β₁ + β₂/γ₁.
        near_vector(velocity.beta(), one * first + other * (second / g1), 1e-14);
    }
}

#[test]
fn collinear_rapidities_add_without_a_turn() {
    let along = v(-1.0, 4.0, 8.0);
    let a = Lorentz::from(ToRest::to_moving(Velocity::from_rapidity(0.7, along)));
    let b = Lorentz::from(Boost::<Lab, Rest>::to_moving(Velocity::from_rapidity(1.9, along)));
    let (velocity, turn) = (b * a).boost_then_rotation();
    near(velocity.rapidity(), 2.6, 1e-14);
    near(turn_angle(turn), 0.0, 1e-14);
}

/// A clock far away and long ago: differences are taken before the boost.
#[test]
fn no_digit_is_lost_far_from_the_origin() {
    let origin = Event::new(1e15, v(-3e15, 2e15, 1e15));
    let into: Poincare<Rest> = Poincare::to_moving(Velocity::from_gamma(100.0, v(1.0, 1.0, 0.0)), origin);
    let event = Event::new(origin.t + 2.0, origin.x + v(1.0, 0.5, -3.0));
    let linear = into.boost() * FourVector::new(2.0, v(1.0, 0.5, -3.0));
    let moved = into * event;
    near(moved.t, linear.t, 1e-12);
    near_vector(moved.x, linear.x, 1e-12);
    near_vector(into.undo(moved).x, event.x, 0.5);
}
