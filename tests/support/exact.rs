//! Numbers of twice the length (about 31 digits), and the physics in them by the textbook's formulas: what is right where
//! f64 is not enough.

use glam::DVec3;
use std::ops::{Add, Div, Mul, Neg, Sub};
use terrell::spacetime::{Event, Velocity};

/// The unevaluated sum of two f64.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Long(f64, f64);

fn two_sum(a: f64, b: f64) -> Long {
    let sum = a + b;
    let of_b = sum - a;
    Long(sum, (a - (sum - of_b)) + (b - of_b))
}

impl Long {
    pub(crate) const fn of(x: f64) -> Self {
        Self(x, 0.0)
    }

    pub(crate) const fn value(self) -> f64 {
        self.0
    }

    pub(crate) fn sqrt(self) -> Self {
        if self.0 == 0.0 {
            return self;
        }
        let guess = Self::of(self.0.sqrt());
        let better = guess + (self - guess * guess) / (guess + guess);
        better + (self - better * better) / (better + better)
    }
}

impl Add for Long {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let (high, low) = (two_sum(self.0, b.0), two_sum(self.1, b.1));
        let sum = two_sum(high.0, high.1 + low.0);
        two_sum(sum.0, sum.1 + low.1)
    }
}

impl Neg for Long {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Sub for Long {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Long {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let product = self.0 * b.0;
        let error = self.0.mul_add(b.0, -product);
        two_sum(product, error + (self.0 * b.1 + self.1 * b.0))
    }
}

impl Div for Long {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let first = Self::of(self.0 / b.0);
        let rest = self - b * first;
        let second = Self::of(rest.0 / b.0);
        let rest = rest - b * second;
        first + second + Self::of(rest.0 / b.0)
    }
}

/// Three of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Long3(pub(crate) [Long; 3]);

impl Long3 {
    pub(crate) fn of(v: DVec3) -> Self {
        Self(v.to_array().map(Long::of))
    }

    pub(crate) fn value(self) -> DVec3 {
        DVec3::from(self.0.map(Long::value))
    }

    pub(crate) fn dot(self, b: Self) -> Long {
        let [x, y, z] = std::array::from_fn(|i| self.0[i] * b.0[i]);
        x + y + z
    }

    pub(crate) fn cross(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
        Self([part(1, 2), part(2, 0), part(0, 1)])
    }

    pub(crate) fn times(self, factor: Long) -> Self {
        Self(self.0.map(|x| x * factor))
    }

    pub(crate) fn plus(self, b: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + b.0[i]))
    }
}

/// An event or a wave vector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Long4 {
    pub(crate) t: Long,
    pub(crate) x: Long3,
}

impl Long4 {
    /// Light along a vector of any length.
    pub(crate) fn light(x: DVec3) -> Self {
        let x = Long3::of(x);
        Self { t: x.dot(x).sqrt(), x }
    }

    /// From one event to another.
    pub(crate) fn between(from: Event, to: Event) -> Self {
        let minus = |a: f64, b: f64| Long::of(a) - Long::of(b);
        let x = Long3(std::array::from_fn(|i| minus(to.x[i], from.x[i])));
        Self { t: minus(to.t, from.t), x }
    }

    /// Light in the frame that moves with this velocity, null to its last digit: two boosts of γ = 1e8 one after the
    /// other would take 32 digits from the plain formulas.
    pub(crate) fn light_seen_by(self, velocity: Velocity) -> Self {
        let (u, one) = (Long3::of(velocity.proper()), Long::of(1.0));
        let square = u.dot(u);
        let (speed, gamma) = (square.sqrt(), (one + square).sqrt());
        let moment = self.x.cross(u);
        let along = self.x.dot(u) / speed;
        let length = self.x.dot(self.x).sqrt();
        let across = moment.dot(moment) / square;
        let (plus, minus) = if along.value() > 0.0 {
            (length + along, across / (length + along))
        } else {
            (across / (length - along), length - along)
        };
        let half = Long::of(0.5);
        let (plus, minus) = (half * plus / (gamma + speed), half * minus * (gamma + speed));
        let x = u.cross(moment).times(one / square).plus(u.times((plus - minus) / speed));
        Self { t: plus + minus, x }
    }

    /// In the frame that moves with this velocity.
    pub(crate) fn seen_by(self, velocity: Velocity) -> Self {
        let u = Long3::of(velocity.proper());
        let one = Long::of(1.0);
        let gamma = (one + u.dot(u)).sqrt();
        let along = u.dot(self.x);
        let t = gamma * self.t - along;
        Self { t, x: self.x.plus(u.times(along / (gamma + one) - self.t)) }
    }
}

/// How a ball is seen: the light's frequency at the ball over that in the camera, and the place of the ball (rest frame,
/// from its centre) from which it comes; none if the ray passes by.
pub(crate) fn ball_seen(
    (eye, eye_moves): (Event, Velocity),
    toward: DVec3,
    (centre, moves): (Event, Velocity),
    radius: f64,
) -> Option<(f64, DVec3)> {
    let k = Long4::light(-toward).light_seen_by(-eye_moves).light_seen_by(moves);
    let start = Long4::between(centre, eye).seen_by(moves).x;
    // |start - s k| = radius, the nearer one.
    let (a, b) = (k.x.dot(k.x), k.x.dot(start));
    let c = start.dot(start) - Long::of(radius) * Long::of(radius);
    let square = b * b - a * c;
    if square.value() <= 0.0 {
        return None;
    }
    let s = (b - square.sqrt()) / a;
    let place = start.plus(k.x.times(-s));
    (s.value() > 0.0).then_some((k.t.value(), place.value()))
}
