//! Boosts, and the transforms that boosts and rotations make together.

use super::{Event, FourVector, Frame, Lab, Velocity};
use glam::{DMat4, DQuat, DVec3, DVec4};
use std::marker::PhantomData;
use std::ops::Mul;

/// A pure boost to the frame that moves with proper velocity `u`, axes kept as parallel as they can be.
///
/// ~~~text
/// t' = γ t - u·x            x' = x + (u·x / (γ + 1) - t) u
/// ~~~
///
/// Two boosts compose to a boost *and a rotation*: there is no `Boost * Boost`, compose [`Lorentz`] maps.
/// Source: Jackson, Classical Electrodynamics §11.3, in terms of γβ.    Law: tests `boost::*`.
#[derive(Debug, Clone, Copy)]
pub struct Boost<To: Frame, From: Frame> {
    u: DVec3,
    gamma: f64,
    role: PhantomData<(To, From)>,
}

impl<To: Frame, From: Frame> Boost<To, From> {
    /// To the frame `To` that moves with `velocity` in the frame `From`.
    pub fn to_moving(velocity: Velocity) -> Self {
        Self { u: velocity.proper(), gamma: velocity.gamma(), role: PhantomData }
    }

    /// The way back.
    pub fn inverse(self) -> Boost<From, To> {
        Boost { u: -self.u, gamma: self.gamma, role: PhantomData }
    }

    /// The velocity of `To` in `From`.
    pub fn velocity(self) -> Velocity {
        Velocity::from_proper(self.u)
    }

    fn apply(self, t: f64, x: DVec3) -> (f64, DVec3) {
        let along = self.u.dot(x);
        (self.gamma * t - along, x + self.u * (along / (self.gamma + 1.0) - t))
    }
}

impl<To: Frame, From: Frame> Mul<FourVector<From>> for Boost<To, From> {
    type Output = FourVector<To>;
    fn mul(self, v: FourVector<From>) -> FourVector<To> {
        let (t, x) = self.apply(v.t, v.x);
        FourVector::new(t, x)
    }
}

/// A proper orthochronous Lorentz map, closed under composition: the Wigner rotation is kept.
#[derive(Debug, Clone, Copy)]
pub struct Lorentz<To: Frame, From: Frame> {
    // Columns in the order x, y, z, t.
    matrix: DMat4,
    role: PhantomData<(To, From)>,
}

impl<To: Frame, From: Frame> Lorentz<To, From> {
    /// A pure rotation of the axes.
    pub fn rotation(turn: DQuat) -> Self {
        Self { matrix: DMat4::from_quat(turn), role: PhantomData }
    }

    /// The inverse, from the metric: `Λ⁻¹ = η Λᵀ η`.
    pub fn inverse(self) -> Lorentz<From, To> {
        let eta = DMat4::from_diagonal(DVec4::new(-1.0, -1.0, -1.0, 1.0));
        Lorentz { matrix: eta * self.matrix.transpose() * eta, role: PhantomData }
    }

    /// Written as a pure boost followed by a rotation in `To`: `Λ = R B(u)`.
    ///
    /// The velocity is that of `To` in `From`; the rotation takes the axes that the pure boost would give to
    /// those of `To`.
    pub fn boost_then_rotation(self) -> (Velocity, DQuat) {
        // The time row of Λ is (γ, -u): what `To`'s clock reads.
        let u = -self.matrix.row(3).truncate();
        let velocity = Velocity::from_proper(u);
        let back = Self::from(Boost::<To, From>::to_moving(-velocity)).matrix;
        let turn = self.matrix * back;
        let turn =
            glam::DMat3::from_cols(turn.x_axis.truncate(), turn.y_axis.truncate(), turn.z_axis.truncate());
        (velocity, DQuat::from_mat3(&turn).normalize())
    }
}

impl<To: Frame, From: Frame> std::convert::From<Boost<To, From>> for Lorentz<To, From> {
    fn from(boost: Boost<To, From>) -> Self {
        let column = |t: f64, x: DVec3| {
            let (t, x) = boost.apply(t, x);
            x.extend(t)
        };
        let matrix = DMat4::from_cols(
            column(0.0, DVec3::X),
            column(0.0, DVec3::Y),
            column(0.0, DVec3::Z),
            column(1.0, DVec3::ZERO),
        );
        Self { matrix, role: PhantomData }
    }
}

impl<To: Frame, Between: Frame, From: Frame> Mul<Lorentz<Between, From>> for Lorentz<To, Between> {
    type Output = Lorentz<To, From>;
    fn mul(self, first: Lorentz<Between, From>) -> Lorentz<To, From> {
        Lorentz { matrix: self.matrix * first.matrix, role: PhantomData }
    }
}

impl<To: Frame, From: Frame> Mul<FourVector<From>> for Lorentz<To, From> {
    type Output = FourVector<To>;
    fn mul(self, v: FourVector<From>) -> FourVector<To> {
        let v = self.matrix * v.x.extend(v.t);
        FourVector::new(v.w, v.truncate())
    }
}

/// A pure boost about an event of the source frame, which becomes the origin of the destination.
///
/// Differences of events are taken before the boost, so that far from the lab's origin nothing is lost.
#[derive(Debug, Clone, Copy)]
pub struct Poincare<To: Frame, From: Frame = Lab> {
    boost: Boost<To, From>,
    origin: Event<From>,
}

impl<To: Frame, From: Frame> Poincare<To, From> {
    /// To the frame that moves with `velocity` and has its origin at the event `origin`.
    pub fn to_moving(velocity: Velocity, origin: Event<From>) -> Self {
        Self { boost: Boost::to_moving(velocity), origin }
    }

    /// The linear part: moves vectors.
    pub fn boost(self) -> Boost<To, From> {
        self.boost
    }

    /// The event of the source frame that is the destination's origin.
    pub fn origin(self) -> Event<From> {
        self.origin
    }

    /// The way back, for events.
    pub fn undo(self, event: Event<To>) -> Event<From> {
        self.origin + self.boost.inverse() * (event - Event::ORIGIN)
    }
}

impl<To: Frame, From: Frame> Mul<Event<From>> for Poincare<To, From> {
    type Output = Event<To>;
    fn mul(self, event: Event<From>) -> Event<To> {
        Event::ORIGIN + self.boost * (event - self.origin)
    }
}

impl<To: Frame, From: Frame> Mul<FourVector<From>> for Poincare<To, From> {
    type Output = FourVector<To>;
    fn mul(self, vector: FourVector<From>) -> FourVector<To> {
        self.boost * vector
    }
}
