//! Events and four-vectors.

use super::{Frame, Lab};
use glam::DVec3;
use std::marker::PhantomData;
use std::ops::{Add, Mul, Neg, Sub};

/// A point of spacetime. The difference of two events is a [`FourVector`]; events are not added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event<F: Frame = Lab> {
    /// Coordinate time, metres of light travel.
    pub t: f64,
    /// Place, metres.
    pub x: DVec3,
    role: PhantomData<F>,
}

/// A displacement, a four-velocity or a wave vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FourVector<F: Frame = Lab> {
    /// Time component.
    pub t: f64,
    /// Space components.
    pub x: DVec3,
    role: PhantomData<F>,
}

impl<F: Frame> Event<F> {
    /// The origin of the frame.
    pub const ORIGIN: Self = Self::new(0.0, DVec3::ZERO);

    /// The event at time `t` (metres of light travel) and place `x`.
    pub const fn new(t: f64, x: DVec3) -> Self {
        Self { t, x, role: PhantomData }
    }
}

impl<F: Frame> FourVector<F> {
    /// From its components.
    pub const fn new(t: f64, x: DVec3) -> Self {
        Self { t, x, role: PhantomData }
    }

    /// The Minkowski product, signature (+,-,-,-): `a⁰b⁰ - a·b`.
    ///
    /// For a wave vector `k` and a four-velocity `u` this is the frequency seen by `u`.
    pub fn dot(self, other: Self) -> f64 {
        self.t * other.t - self.x.dot(other.x)
    }
}

impl<F: Frame> Sub for Event<F> {
    type Output = FourVector<F>;
    fn sub(self, other: Self) -> FourVector<F> {
        FourVector::new(self.t - other.t, self.x - other.x)
    }
}

impl<F: Frame> Add<FourVector<F>> for Event<F> {
    type Output = Self;
    fn add(self, step: FourVector<F>) -> Self {
        Self::new(self.t + step.t, self.x + step.x)
    }
}

impl<F: Frame> Sub<FourVector<F>> for Event<F> {
    type Output = Self;
    fn sub(self, step: FourVector<F>) -> Self {
        Self::new(self.t - step.t, self.x - step.x)
    }
}

impl<F: Frame> Add for FourVector<F> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.t + other.t, self.x + other.x)
    }
}

impl<F: Frame> Sub for FourVector<F> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.t - other.t, self.x - other.x)
    }
}

impl<F: Frame> Neg for FourVector<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.t, -self.x)
    }
}

impl<F: Frame> Mul<f64> for FourVector<F> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.t * factor, self.x * factor)
    }
}
