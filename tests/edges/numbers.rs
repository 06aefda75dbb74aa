//! Light and frames at γ up to 1e8, against numbers of twice the length.

use crate::support::exact::{Long3, Long4};
use crate::support::{Dice, angle, near_vector, v};
use glam::{DQuat, DVec3};
use terrell::spacetime::{Boost, FourVector, Lab, Lorentz, Rest, Velocity};

/// A velocity of γ from 1 to 1e8, even in its logarithm.
pub(super) fn any_velocity(dice: &mut Dice) -> Velocity {
    Velocity::from_rapidity(dice.between(0.01, 19.1), dice.direction())
}

/// A direction that may be anything from all around to within 1e-16 of the velocity, or against it.
pub(super) fn any_way(dice: &mut Dice, velocity: Velocity) -> DVec3 {
    let along = velocity.proper() / velocity.proper().length();
    let off = libm::pow(10.0, -dice.between(0.0, 17.0));
    let way = along * [1.0, -1.0][dice.below(2)] + dice.direction() * off;
    way / way.length()
}

/// The error of light's frequency, and of its wave vector, in parts of what is right.
fn errors(velocity: Velocity, way: DVec3) -> (f64, f64) {
    let k = FourVector::<Lab>::new(way.length(), way);
    let got = Boost::<Rest, Lab>::to_moving(velocity).light(k);
    let right = Long4::light(way).seen_by(velocity);
    let off = Long3::of(got.x).plus(right.x.times(crate::support::exact::Long::of(-1.0)));
    ((got.t / right.t.value() - 1.0).abs(), off.value().length() / right.t.value())
}

#[test]
fn light_keeps_twelve_digits_in_every_frame_up_to_gamma_1e8() {
    let mut dice = Dice(1);
    let mut worst = (0.0_f64, 0.0_f64);
    for _ in 0..50_000 {
        let velocity = any_velocity(&mut dice);
        let found = errors(velocity, any_way(&mut dice, velocity));
        worst = (worst.0.max(found.0), worst.1.max(found.1));
    }
    assert!(worst.0 < 1e-12 && worst.1 < 1e-12, "{worst:?}");
}

#[test]
fn light_straight_ahead_is_redshifted_by_the_whole_stretch() {
    for gamma in [1.5, 31.0, 33.0, 1e3, 1e5, 1e8] {
        let along = v(2.0, -3.0, 6.0) / 7.0;
        let boost = Boost::<Rest, Lab>::to_moving(Velocity::from_gamma(gamma, along));
        let (there, back) = (along * 7.0, along * -7.0);
        let stretch = gamma + ((gamma - 1.0) * (gamma + 1.0)).sqrt();
        // The direction has a last digit: γ ε of it is seen.
        let allowed = 4.0 * f64::EPSILON * gamma + 1e-12;
        let red = boost.light(FourVector::new(there.length(), there)).t;
        let blue = boost.light(FourVector::new(back.length(), back)).t;
        assert!((red * stretch / 7.0 - 1.0).abs() < allowed, "{gamma}: {red}");
        assert!((blue / stretch / 7.0 - 1.0).abs() < 1e-12, "{gamma}: {blue}");
    }
}

/// From the camera to the lab and from there to what moves as the camera does: directions lose γ ε.
#[test]
fn light_comes_back_from_a_fast_frame_with_its_direction() {
    let mut dice = Dice(2);
    let mut worst = 0.0_f64;
    for _ in 0..50_000 {
        let velocity = any_velocity(&mut dice);
        let way = any_way(&mut dice, velocity);
        let there = Boost::<Rest, Lab>::to_moving(velocity);
        let back = there.light(there.inverse().light(FourVector::new(way.length(), way)));
        let allowed = f64::EPSILON * velocity.gamma() + 4e-12;
        let off = angle(back.x, way).max((back.t / way.length() - 1.0).abs());
        worst = worst.max(off / allowed);
    }
    assert!(worst < 4.0, "{worst}");
}

/// A map that is held as a boost and a turn has no γ² in its error: its inverse undoes it, its composite is one after
/// the other.
#[test]
fn composed_maps_move_light_as_one_after_the_other() {
    let mut dice = Dice(3);
    for _ in 0..20_000 {
        let first = Velocity::from_rapidity(dice.between(0.0, 9.0), dice.direction());
        // Not against the first: what two velocities leave of one another has lost its digits.
        let mut second = Velocity::from_rapidity(dice.between(0.0, 9.0), dice.direction());
        if first.proper().dot(second.proper()) < 0.0 {
            second = -second;
        }
        let turn = dice.turn();
        let a = Lorentz::<Rest, Lab>::from(Boost::to_moving(first));
        let b = Lorentz::<Lab, Lab>::rotation(turn) * Lorentz::<Lab, Rest>::from(Boost::to_moving(second));
        let way = dice.direction();
        let k = FourVector::<Lab>::new(1.0, way);
        let (both, stepwise) = ((b * a).light(k), b.light(a.light(k)));
        let gamma = (b * a).boost_then_rotation().0.gamma();
        let allowed = 16.0 * f64::EPSILON * gamma + 1e-11;
        assert!((both.t / stepwise.t - 1.0).abs() < allowed, "{first:?} {second:?}");
        assert!(angle(both.x, stepwise.x) < allowed, "{first:?} {second:?}");
    }
}

#[test]
fn inverse_of_a_turned_boost_is_exact_at_gamma_1e8() {
    let velocity = Velocity::from_gamma(1e8, v(1.0, 2.0, -2.0));
    let turn = DQuat::from_axis_angle(v(0.0, 0.6, 0.8), 1.1);
    let map = Lorentz::<Rest, Rest>::rotation(turn) * Lorentz::<Rest, Lab>::from(Boost::to_moving(velocity));
    let (found, rotation) = map.inverse().inverse().boost_then_rotation();
    near_vector(found.proper() / 1e8, velocity.proper() / 1e8, 1e-15);
    assert!(rotation.dot(turn).abs() > 1.0 - 1e-15);
}
