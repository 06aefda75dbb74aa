//! Sight rays: light traced back into the past, never rescaled.

use super::{Event, FourVector, Frame, Lab, Poincare};

/// Light that arrives at an event, and with it everything that can have sent it.
///
/// `k` is its wave vector: null, pointing to the future, in units in which the observer of the picture sees
/// the frequency 1. Earlier events of the light are `event - s k`, s > 0. The *same number* s names the same
/// event in every frame, because `k` is transformed and never normalised: the nearest hit over all rest
/// frames is the smallest `s`.
///
/// ~~~compile_fail,E0308
/// use terrell::spacetime::{Rest, SightRay};
/// fn enters(ray: SightRay<Rest>) {}
/// fn leaves(ray: SightRay) { enters(ray) } // a ray in the lab is no ray in a rest frame
/// ~~~
#[derive(Debug, Clone, Copy)]
pub struct SightRay<F: Frame = Lab> {
    /// Where the light arrives.
    pub event: Event<F>,
    /// Its wave vector on arrival.
    pub k: FourVector<F>,
}

impl<F: Frame> SightRay<F> {
    /// The event of the light at `s`; larger `s` is earlier.
    pub fn at(&self, s: f64) -> Event<F> {
        self.event - self.k * s
    }

    /// The same light in another frame.
    pub fn to<To: Frame>(&self, to_from: &Poincare<To, F>) -> SightRay<To> {
        SightRay { event: *to_from * self.event, k: to_from.light(self.k) }
    }
}

/// Frequency seen over frequency emitted: above 1 for what approaches.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Doppler(f64);

impl Doppler {
    /// From the light's frequency where it was emitted, in units of what the observer sees (ω = k·u).
    pub fn from_emitted(omega: f64) -> Self {
        Self(1.0 / omega)
    }

    /// Frequency seen over frequency emitted.
    pub fn factor(self) -> f64 {
        self.0
    }
}
