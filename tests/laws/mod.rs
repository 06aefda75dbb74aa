//! The book of laws: closed forms of physics, each measured against the program over a sweep of cases.
//!
//! A law is a function that returns the largest error met. Each has a test of its own; one more writes them all as the
//! table `tests/LAWS.md` and fails where that is stale.

mod balls;
mod brightness;
mod chart;
mod lamps;
mod light;
mod media;
mod observers;
mod shape;
mod symmetry;
mod table;
mod two_cubes;

use crate::support::{angle, edge};
use glam::{DQuat, DVec3};
use std::sync::LazyLock;
use terrell::spacetime::Velocity;

/// A law, and by how much the program misses it.
pub(crate) struct Law {
    name: &'static str,
    /// The number of the line of requirements that it answers.
    number: &'static str,
    form: &'static str,
    source: &'static str,
    /// The largest error; what kind it is of is said by the form of the law.
    error: LazyLock<f64>,
    bound: f64,
}

impl Law {
    fn sentence(&self) -> String {
        let name = self.name.replace('_', " ");
        let names = ["bradley", "einstein", "penrose", "planck", "rindler", "wigner"];
        names.iter().fold(name, |text, name| {
            let capital = name[..1].to_uppercase() + &name[1..];
            text.replace(name, &capital)
        })
    }

    fn holds(&self) {
        let error = *self.error;
        assert!(
            error <= self.bound,
            "{} ({}): off by {error:e}, more than {:e}",
            self.sentence(),
            self.form,
            self.bound
        );
    }
}

/// Laws of one kind.
pub(crate) struct Chapter {
    title: &'static str,
    laws: &'static [&'static Law],
}

/// All of them.
static BOOK: [&Chapter; 7] = [
    &light::CHAPTER,
    &brightness::CHAPTER,
    &shape::CHAPTER,
    &observers::CHAPTER,
    &media::CHAPTER,
    &lamps::CHAPTER,
    &symmetry::CHAPTER,
];

/// A chapter of laws, and a test for each: `name, number, closed form, source, bound`, the name that of its function.
macro_rules! chapter {
    ($title:literal: $($name:ident, $number:literal, $form:literal, $source:literal, $bound:literal;)*) => {
        pub(super) static CHAPTER: crate::laws::Chapter =
            crate::laws::Chapter { title: $title, laws: &[$(&book::$name),*] };

        #[allow(non_upper_case_globals, reason = "laws go by the names of their functions")]
        mod book {
            $(pub(super) static $name: crate::laws::Law = crate::laws::Law {
                name: stringify!($name),
                number: $number,
                form: $form,
                source: $source,
                error: std::sync::LazyLock::new(super::$name),
                bound: $bound,
            };)*
        }

        mod holds {
            $(#[test]
            fn $name() {
                super::book::$name.holds();
            })*
        }
    };
}
use chapter;

/// The largest error so far. What is no number is endlessly wrong.
#[derive(Default)]
struct Worst(f64);

impl Worst {
    fn error(&mut self, error: f64) {
        self.0 = if error.is_nan() { f64::INFINITY } else { self.0.max(error) };
    }

    fn apart(&mut self, got: f64, expected: f64) {
        self.error((got - expected).abs());
    }

    /// As a part of what is expected.
    fn part(&mut self, got: f64, expected: f64) {
        self.error((got - expected).abs() / expected.abs());
    }

    fn places(&mut self, got: DVec3, expected: DVec3) {
        self.error((got - expected).length());
    }

    fn part_of_vector(&mut self, got: DVec3, expected: DVec3) {
        self.error((got - expected).length() / expected.length());
    }

    fn directions(&mut self, got: DVec3, expected: DVec3) {
        self.error(angle(got, expected));
    }

    /// How far from 0 a property ends that holds at `reach` and not at `-reach`.
    fn edge(&mut self, reach: f64, holds: impl Fn(f64) -> bool) {
        let ends = holds(reach) && !holds(-reach);
        self.error(if ends { edge(reach, -reach, holds).abs() } else { f64::INFINITY });
    }

    /// What must hold at all; otherwise no error is large enough.
    fn must(&mut self, holds: bool) {
        self.error(if holds { 0.0 } else { f64::INFINITY });
    }
}

/// Off every axis.
const FORWARD: DVec3 = DVec3::new(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);

/// Speeds from slow to fast, in c.
const SPEEDS: [f64; 8] = [0.01, 0.1, 0.3, 0.5, 0.8, 0.9, 0.99, 0.999];

/// γ of a speed.
fn gamma(beta: f64) -> f64 {
    1.0 / ((1.0 - beta) * (1.0 + beta)).sqrt()
}

/// The direction at an angle from an axis, turned about it.
fn aside(axis: DVec3, theta: f64, around: f64) -> DVec3 {
    let side = DQuat::from_axis_angle(axis, around) * axis.any_orthonormal_vector();
    let (sin, cos) = libm::sincos(theta);
    axis * cos + side * sin
}

/// The boost of the textbook: components of a four-vector for someone who moves.
fn seen_by(velocity: Velocity, (t, x): (f64, DVec3)) -> (f64, DVec3) {
    let (u, g) = (velocity.proper(), velocity.gamma());
    (g * t - u.dot(x), x + u * (u.dot(x) / (g + 1.0) - t))
}

/// Gauss and Legendre's nodes and weights from -1 to 1.
fn gauss_legendre(count: u32) -> Vec<(f64, f64)> {
    let n = f64::from(count);
    let legendre = |x: f64| {
        let (mut before, mut now) = (1.0, x);
        for k in 2..=count {
            let k = f64::from(k);
            (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
        }
        (now, n * (x * now - before) / (x * x - 1.0))
    };
    let node = |i: u32| {
        let mut x = libm::cos(std::f64::consts::PI * (f64::from(i) + 0.75) / (n + 0.5));
        for _ in 0..20 {
            let (value, slope) = legendre(x);
            x -= value / slope;
        }
        let slope = legendre(x).1;
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}
