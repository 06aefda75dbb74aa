//! Numbers: how near is near, where an edge is, and chance.

use glam::{DQuat, DVec3};
use proptest::prelude::{Strategy, prop};
use terrell::spacetime::{Event, Velocity};

/// A velocity from β.
pub(crate) fn beta(x: f64, y: f64, z: f64) -> Velocity {
    Velocity::from_beta(DVec3::new(x, y, z)).unwrap()
}

/// A velocity from a speed and a direction of any length.
pub(crate) fn speed(beta: f64, along: DVec3) -> Velocity {
    Velocity::from_beta(along / along.length() * beta).unwrap()
}

/// A vector.
pub(crate) const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The angle between two directions, radians, with all its digits at 0 and at π.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// `got` is `expected` but for a part `tolerance` of it.
#[track_caller]
pub(crate) fn close(got: f64, expected: f64, tolerance: f64) {
    let error = (got - expected).abs() / expected.abs();
    assert!(error <= tolerance, "{got} for {expected}: off by a part {error:e} of it");
}

/// `got` is `expected` but for `tolerance`.
#[track_caller]
pub(crate) fn near(got: f64, expected: f64, tolerance: f64) {
    let error = (got - expected).abs();
    assert!(error <= tolerance, "{got} for {expected}: off by {error:e}");
}

/// The vector `got` is `expected` but for `tolerance`.
#[track_caller]
pub(crate) fn near_vector(got: DVec3, expected: DVec3, tolerance: f64) {
    let error = (got - expected).length();
    assert!(error <= tolerance, "{got} for {expected}: off by {error:e}");
}

/// Where between `inside` (where `holds`) and `outside` (where it does not) a property ends.
pub(crate) fn edge(mut inside: f64, mut outside: f64, holds: impl Fn(f64) -> bool) -> f64 {
    assert!(holds(inside) && !holds(outside), "no edge between {inside} and {outside}");
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if holds(middle) { inside = middle } else { outside = middle }
    }
    0.5 * (inside + outside)
}

/// The lab time at which something on the path `place` sent the light that arrives at the event: by halving, in the
/// lab alone.
pub(crate) fn emission_time(arrival: Event, place: impl Fn(f64) -> DVec3) -> f64 {
    let (mut early, mut late) = (arrival.t - 1.0, arrival.t);
    let too_late = |t: f64| arrival.t - t < (place(t) - arrival.x).length();
    while too_late(early) {
        early = arrival.t - 2.0 * (arrival.t - early);
    }
    for _ in 0..200 {
        let middle = 0.5 * (early + late);
        if too_late(middle) { late = middle } else { early = middle }
    }
    0.5 * (early + late)
}

/// A repeatable source of chance (splitmix64).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// Even between 0 and 1.
    pub(crate) fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// Even between two numbers.
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.part()
    }

    /// One of `count` numbers from 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.part() * count as f64) as usize).min(count - 1)
    }

    /// Even in the cube from -1 to 1.
    pub(crate) fn in_cube(&mut self) -> DVec3 {
        v(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A unit vector, even over the sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = libm::sincos(self.between(0.0, std::f64::consts::TAU));
        let across = (1.0 - z * z).sqrt();
        v(across * cos, across * sin, z)
    }

    /// A velocity of a given speed, any direction.
    pub(crate) fn velocity(&mut self, beta: f64) -> Velocity {
        speed(beta, self.direction())
    }

    /// A turn.
    pub(crate) fn turn(&mut self) -> DQuat {
        let axis = self.direction();
        DQuat::from_axis_angle(axis, self.between(-3.0, 3.0))
    }
}

/// Vectors of length up to about 1.7 with no preferred direction, never tiny.
pub(crate) fn vectors() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from).prop_filter("too short", |x| x.length() > 0.1)
}

/// Velocities up to a rapidity, in all directions.
pub(crate) fn velocities(rapidity: f64) -> impl Strategy<Value = Velocity> {
    (vectors(), 1e-3..rapidity).prop_map(|(along, rapidity)| Velocity::from_rapidity(rapidity, along))
}
