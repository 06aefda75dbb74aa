//! Velocity, kept as proper velocity so that no digit of γ is lost near the speed of light.

use super::{FourVector, Frame};
use glam::DVec3;

/// The velocity of something in the lab, kept as proper velocity `u = γβ`.
///
/// ~~~text
/// γ = √(1 + u²)        β = u / γ        rapidity = asinh |u|
/// ~~~
///
/// Units: of c.  Accuracy: γ to rounding for every γ (from β it would lose half its digits at γ = 1e4).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Velocity {
    u: DVec3,
}

/// A speed that is not below that of light, or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotSlowerThanLight;

impl Velocity {
    /// At rest.
    pub const REST: Self = Self { u: DVec3::ZERO };

    /// From the proper velocity `u = γβ`, any finite vector.
    pub const fn from_proper(u: DVec3) -> Self {
        Self { u }
    }

    /// From β, with `γ = 1/√((1 - |β|)(1 + |β|))`.
    ///
    /// Errors: |β| not below 1.
    pub fn from_beta(beta: DVec3) -> Result<Self, NotSlowerThanLight> {
        let speed = beta.length();
        if speed < 1.0 {
            Ok(Self { u: beta / ((1.0 - speed) * (1.0 + speed)).sqrt() })
        } else {
            Err(NotSlowerThanLight)
        }
    }

    /// From γ ≥ 1 and a direction (of any length above zero), with `|u| = √((γ - 1)(γ + 1))`.
    pub fn from_gamma(gamma: f64, along: DVec3) -> Self {
        Self { u: along / along.length() * ((gamma - 1.0) * (gamma + 1.0)).sqrt() }
    }

    /// From a rapidity and a direction (of any length above zero), with `|u| = sinh(rapidity)`.
    pub fn from_rapidity(rapidity: f64, along: DVec3) -> Self {
        Self { u: along / along.length() * libm::sinh(rapidity) }
    }

    /// The proper velocity `γβ`.
    pub const fn proper(self) -> DVec3 {
        self.u
    }

    /// The Lorentz factor γ.
    pub fn gamma(self) -> f64 {
        (1.0 + self.u.length_squared()).sqrt()
    }

    /// β = v/c.
    pub fn beta(self) -> DVec3 {
        self.u / self.gamma()
    }

    /// The rapidity, `atanh |β|`.
    pub fn rapidity(self) -> f64 {
        libm::asinh(self.u.length())
    }

    /// The four-velocity `(γ, γβ)` in the frame in which the velocity was given.
    pub fn four<F: Frame>(self) -> FourVector<F> {
        FourVector::new(self.gamma(), self.u)
    }
}

impl std::ops::Neg for Velocity {
    type Output = Self;
    fn neg(self) -> Self {
        Self { u: -self.u }
    }
}
