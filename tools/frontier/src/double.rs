//! Numbers of about 32 digits: two f64 that are added.
//!
//! Source: Dekker, Numerische Mathematik 18, 1971; Knuth, TAOCP 2, §4.2.2.

use glam::DVec3;
use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Double {
    pub hi: f64,
    pub lo: f64,
}

fn sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let part = hi - a;
    Double { hi, lo: (a - (hi - part)) + (b - part) }
}

fn product(a: f64, b: f64) -> Double {
    let hi = a * b;
    Double { hi, lo: libm::fma(a, b, -hi) }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Double {
    /// 2π.
    pub const TAU: Self = Self { hi: std::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16 };

    pub fn f64(self) -> f64 {
        self.hi + self.lo
    }

    pub fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return 0.0.into();
        }
        // Two steps of Newton's.
        let mut root: Self = self.hi.sqrt().into();
        for _ in 0..2 {
            root = (root + self / root) * 0.5.into();
        }
        root
    }

    /// What is left of whole numbers.
    pub fn fract(self) -> Self {
        let whole: Self = self.hi.floor().into();
        let left = self - whole;
        let more: Self = left.hi.floor().into();
        left - more
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (s, t) = (sum(self.hi, other.hi), sum(self.lo, other.lo));
        let s = sum(s.hi, s.lo + t.hi);
        sum(s.hi, s.lo + t.lo)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let p = product(self.hi, other.hi);
        sum(p.hi, p.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let left = self - other * first.into();
        let second = left.hi / other.hi;
        let left = left - other * second.into();
        sum(first, second) + (left.hi / other.hi).into()
    }
}

/// A vector of such numbers.
#[derive(Debug, Clone, Copy)]
pub struct Triple(pub [Double; 3]);

impl From<DVec3> for Triple {
    fn from(v: DVec3) -> Self {
        Self(v.to_array().map(Double::from))
    }
}

impl Triple {
    pub fn dot(self, other: Self) -> Double {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    pub fn length(self) -> Double {
        self.dot(self).sqrt()
    }

    pub fn times(self, factor: Double) -> Self {
        Self(self.0.map(|c| c * factor))
    }

    pub fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    pub fn f64(self) -> DVec3 {
        self.0.map(Double::f64).into()
    }
}

/// The boost to the frame that moves with proper velocity `u`.
pub fn boost(u: DVec3, t: Double, x: Triple) -> (Double, Triple) {
    let u = Triple::from(u);
    let gamma = (u.dot(u) + 1.0.into()).sqrt();
    let along = u.dot(x);
    (gamma * t - along, x.plus(u.times(along / (gamma + 1.0.into()) - t)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_times_three_is_one_to_thirty_digits() {
        let third = Double::from(1.0) / 3.0.into();
        let off = third * 3.0.into() - 1.0.into();
        assert!(off.f64().abs() < 1e-31, "{off:?}");
        let root = Double::from(2.0).sqrt();
        assert!((root * root - 2.0.into()).f64().abs() < 1e-30);
    }

    #[test]
    fn a_boost_keeps_the_interval_at_any_speed() {
        let u = DVec3::new(3e7, -2e7, 6e7);
        let (t, x) = boost(u, 5.0.into(), DVec3::new(1.0, 2.0, 3.0).into());
        let interval = (t * t - x.dot(x)).f64();
        // Squares of 1e8 leave sixteen digits of thirty-two.
        assert!((interval - 11.0).abs() < 1e-12, "{interval}");
    }
}
