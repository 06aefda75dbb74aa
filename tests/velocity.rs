//! Velocity is kept as γβ, so that no digit of γ is lost.

use crate::support::{beta, close, near_vector, v};
use glam::DVec3;
use terrell::spacetime::{Boost, Event, FourVector, Lab, Lorentz, Rest, SightRay, Velocity};

/// 1 - β² would leave four digits of γ at a million.
#[test]
fn gamma_holds_twelve_digits_at_a_million() {
    let along = v(2.0, -1.0, 0.5);
    close(Velocity::from_gamma(1e6, along).gamma(), 1e6, 1e-15);
    close(Velocity::from_rapidity(libm::acosh(1e6), along).gamma(), 1e6, 1e-14);
    // β = 1 - 2⁻⁴⁰ exactly: γ = 2²⁰/√(2 - 2⁻⁴⁰).
    let nearly = 1.0 - libm::ldexp(1.0, -40);
    let gamma = libm::ldexp(1.0, 20) / (2.0 - libm::ldexp(1.0, -40)).sqrt();
    close(beta(0.0, -nearly, 0.0).gamma(), gamma, 1e-15);
    close(
        Velocity::from_gamma(1e6, along).four::<Lab>().dot(Velocity::from_gamma(1e6, -along).four()),
        2e12 - 1.0,
        1e-12,
    );
}

#[test]
fn light_speed_and_more_is_refused() {
    for too_fast in [1.0, 1.0 + f64::EPSILON, 3.0, f64::INFINITY, f64::NAN] {
        assert!(Velocity::from_beta(v(0.0, too_fast, 0.0)).is_err(), "{too_fast}");
    }
    assert!(Velocity::from_beta(v(0.6, 0.6, 0.6)).is_err());
    assert!(Velocity::from_beta(v(0.6, 0.8, 0.0)).is_err());
    assert!(Velocity::from_beta(v(0.6, 0.7999, 0.0)).is_ok());
}

/// 3/5 → 5/4, 4/5 → 5/3, 5/13 → 13/12, 12/13 → 13/5, 15/17 → 17/8.
#[test]
fn pythagorean_speeds_have_their_fractions() {
    let direction = v(2.0, -3.0, 6.0) / 7.0;
    for (a, b, c) in
        [(3.0, 4.0, 5.0), (4.0, 3.0, 5.0), (5.0, 12.0, 13.0), (12.0, 5.0, 13.0), (15.0, 8.0, 17.0)]
    {
        let velocity = Velocity::from_beta(direction * (a / c)).unwrap();
        close(velocity.gamma(), c / b, 1e-15);
        near_vector(velocity.proper(), direction * (a / b), 1e-15 * a / b);
        near_vector(velocity.beta(), direction * (a / c), 3e-16);
        close(velocity.rapidity(), libm::atanh(a / c), 1e-15);
        near_vector(Velocity::from_gamma(c / b, direction * 9.0).beta(), direction * (a / c), 3e-16);
    }
}

#[test]
fn rest_is_exactly_at_rest() {
    assert_eq!(Velocity::REST.gamma().to_bits(), 1.0_f64.to_bits());
    assert_eq!(Velocity::REST.beta(), DVec3::ZERO);
    assert_eq!(beta(0.0, 0.0, 0.0), Velocity::REST);
}

#[test]
fn frames_told_apart_by_type_add_no_bytes() {
    assert_eq!(size_of::<Event<Rest>>(), 32);
    assert_eq!(size_of::<FourVector>(), 32);
    assert_eq!(size_of::<SightRay<Rest>>(), 64);
    assert_eq!(size_of::<Velocity>(), 24);
    assert_eq!(size_of::<Boost<Rest, Lab>>(), 32);
    assert_eq!(size_of::<Lorentz<Rest, Lab>>(), 64);
}
