//! Boosts, and the transforms that boosts and rotations make together.

use super::{Event, FourVector, Frame, Lab, Velocity};
use glam::{DQuat, DVec3};
use std::marker::PhantomData;
use std::ops::Mul;

/// The Lorentz factor from which light is transformed by [`Boost::light`]'s own formulas: below it the plain ones leave
/// an error of 4 ε γ², and through two frames 8 ε γ⁴, which is 5e-13.
const FAST: f64 = 4.0;

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

    /// The proper velocity and the Lorentz factor of `To` in `From`.
    #[inline]
    pub(crate) fn proper_and_gamma(self) -> (DVec3, f64) {
        (self.u, self.gamma)
    }

    /// Whether the plain formulas lose digits of light.
    #[inline]
    pub(crate) fn is_fast(self) -> bool {
        self.gamma > FAST
    }

    // (Rays that go together are moved by the same sums, coordinate by coordinate, in `world/rays.rs`.)
    #[inline]
    fn apply(self, t: f64, x: DVec3) -> (f64, DVec3) {
        let along = self.u.dot(x);
        (self.gamma * t - along, x + self.u * (along / (self.gamma + 1.0) - t))
    }

    /// The wave vector of light, in vacuum, in the other frame: it keeps its digits however fast that is.
    ///
    /// Light that goes the same way as the frame has `γ|x| - u·x` there, which cancels. With the parts along and across
    /// the motion, `S = γ + |u| = exp(rapidity)`:
    ///
    /// ~~~text
    /// p = |x| + x∥     m = |x| - x∥     p m = x⊥²     t' = (p/S + m S)/2     x∥' = (p/S - m S)/2     x⊥' = x⊥
    /// ~~~
    ///
    /// The smaller of p and m is x⊥² over the larger, and x⊥ comes from a cross product without rounding errors but the
    /// last. Light in a medium is not null and goes by the plain formulas (nothing cancels there).
    ///
    /// Accuracy: 1e-12 of each part of the result that matters (t' and |x'|), for the numbers given and all γ up to 1e8.
    /// The numbers' own last digit, a direction of 1e-16, becomes a part γ ε of t'.    Law: tests `edges::numbers::*`.
    #[inline]
    pub fn light(self, k: FourVector<From>) -> FourVector<To> {
        if self.is_fast() {
            // By numbers, so that what is not fast need not be in memory for this.
            let (u, x) = (self.u, k.x);
            let [t, x, y, z] = fast_light([u.x, u.y, u.z, self.gamma, x.x, x.y, x.z, k.t]);
            return FourVector::new(t, DVec3::new(x, y, z));
        }
        self * k
    }
}

/// The boost with proper velocity u and Lorentz factor γ of the vector (t, x), given in the order u γ x t.
#[cold]
#[inline(never)]
fn fast_light([u1, u2, u3, gamma, x1, x2, x3, t]: [f64; 8]) -> [f64; 4] {
    let (u, x) = (DVec3::new(u1, u2, u3), DVec3::new(x1, x2, x3));
    let length = x.length();
    let (t, x) = if (t - length).abs() <= NULL * length && length > 0.0 {
        let square = u.length_squared();
        let speed = square.sqrt();
        let moment = cross(x, u);
        let along = x.dot(u) / speed;
        let larger = length + along.abs();
        let smaller = moment.length_squared() / square / larger;
        let (plus, minus) = if along > 0.0 { (larger, smaller) } else { (smaller, larger) };
        let stretch = gamma + speed;
        let (plus, minus) = (0.5 * plus / stretch, 0.5 * minus * stretch);
        (plus + minus, u.cross(moment) / square + u * ((plus - minus) / speed))
    } else {
        let along = u.dot(x);
        (gamma * t - along, x + u * (along / (gamma + 1.0) - t))
    };
    [t, x.x, x.y, x.z]
}

/// What differs by less than this part from a null vector is one: more than light keeps through frames that are not
/// fast.
const NULL: f64 = 1e-11;

/// The cross product, each component to its last digits.
fn cross(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(
        difference_of_products(a.y, b.z, a.z, b.y),
        difference_of_products(a.z, b.x, a.x, b.z),
        difference_of_products(a.x, b.y, a.y, b.x),
    )
}

/// `a b - c d` as if it were rounded but once or twice (Kahan), with the products' errors by Veltkamp and Dekker: a fused
/// multiplication is slow on machines that do not have it.
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let (first, second) = (a * b, c * d);
    (first - second) + (product_error(a, b, first) - product_error(c, d, second))
}

/// What the product lacks: `a b - product`, exactly.
fn product_error(a: f64, b: f64, product: f64) -> f64 {
    let halves = |x: f64| {
        let high = x * 134_217_729.0; // 2^27 + 1
        let high = high - (high - x);
        (high, x - high)
    };
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2
}

impl<To: Frame, From: Frame> Mul<FourVector<From>> for Boost<To, From> {
    type Output = FourVector<To>;
    fn mul(self, v: FourVector<From>) -> FourVector<To> {
        let (t, x) = self.apply(v.t, v.x);
        FourVector::new(t, x)
    }
}

/// A proper orthochronous Lorentz map, closed under composition: the Wigner rotation is kept.
///
/// It is held as a boost and a rotation after it, for a matrix has entries of γ, and what cancels among them is lost.
#[derive(Debug, Clone, Copy)]
pub struct Lorentz<To: Frame, From: Frame> {
    boost: Boost<To, From>,
    turn: DQuat,
}

impl<To: Frame, From: Frame> Lorentz<To, From> {
    /// A pure rotation of the axes.
    pub fn rotation(turn: DQuat) -> Self {
        Self { boost: Boost::to_moving(Velocity::REST), turn }
    }

    /// The inverse: `(R B(u))⁻¹ = R⁻¹ B(-R u)`.
    pub fn inverse(self) -> Lorentz<From, To> {
        let boost = Boost { u: -(self.turn * self.boost.u), gamma: self.boost.gamma, role: PhantomData };
        Lorentz { boost, turn: self.turn.conjugate() }
    }

    /// Written as a pure boost followed by a rotation in `To`: `Λ = R B(u)`.
    ///
    /// The velocity is that of `To` in `From`; the rotation takes the axes that the pure boost would give to
    /// those of `To`.
    pub fn boost_then_rotation(self) -> (Velocity, DQuat) {
        (self.boost.velocity(), self.turn)
    }

    /// The wave vector of light, with all its digits: see [`Boost::light`].
    #[inline]
    pub fn light(self, k: FourVector<From>) -> FourVector<To> {
        self.turned(self.boost.light(k))
    }

    #[inline]
    fn turned(self, v: FourVector<To>) -> FourVector<To> {
        FourVector::new(v.t, self.turn * v.x)
    }
}

impl<To: Frame, From: Frame> std::convert::From<Boost<To, From>> for Lorentz<To, From> {
    fn from(boost: Boost<To, From>) -> Self {
        Self { boost, turn: DQuat::IDENTITY }
    }
}

impl<To: Frame, Between: Frame, From: Frame> Mul<Lorentz<Between, From>> for Lorentz<To, Between> {
    type Output = Lorentz<To, From>;

    /// `R₂ B(u₂) R₁ B(u₁) = R₂ R₁ W B(c)`: with `a = R₁⁻¹ u₂` and `b = u₁` the velocity c is a's, seen from before the
    /// boost by b, and W turns by half an angle whose tangent is `|a×b| / ((1 + γa)(1 + γb) + a·b)`.
    ///
    /// Error: ε γa γb / γc of γc, where the two velocities undo one another.
    fn mul(self, first: Lorentz<Between, From>) -> Lorentz<To, From> {
        let (a, gamma_a) = (first.turn.conjugate() * self.boost.u, self.boost.gamma);
        let (b, gamma_b) = (first.boost.u, first.boost.gamma);
        let both = a + b * (b.dot(a) / (gamma_b + 1.0) + gamma_a);
        let axis = b.cross(a);
        let wigner = DQuat::from_xyzw(axis.x, axis.y, axis.z, (1.0 + gamma_a) * (1.0 + gamma_b) + a.dot(b));
        let turn = (self.turn * first.turn * wigner.normalize()).normalize();
        Lorentz { boost: Boost::to_moving(Velocity::from_proper(both)), turn }
    }
}

impl<To: Frame, From: Frame> Mul<FourVector<From>> for Lorentz<To, From> {
    type Output = FourVector<To>;
    fn mul(self, v: FourVector<From>) -> FourVector<To> {
        self.turned(self.boost * v)
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

    /// The wave vector of light, with all its digits: see [`Boost::light`].
    #[inline]
    pub fn light(self, k: FourVector<From>) -> FourVector<To> {
        self.boost.light(k)
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
