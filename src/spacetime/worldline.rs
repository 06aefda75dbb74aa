//! Worldlines of observers, and the tetrads they carry.

use super::{Boost, Camera, Event, FourVector, Lab, Lorentz, Rest, SightRay, Track, Velocity};
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// How an observer moves, described in the frame in which it starts: at rest there at the origin, with its
/// clock at zero (an orbit and a ring: on the circle).
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Uniform motion: at rest in the starting frame.
    Inertial,
    /// Constant proper acceleration, per metre (g/c²).
    ///
    /// ~~~text
    /// t = sinh(aτ)/a        x = (cosh(aτ) - 1)/a        rapidity = aτ
    /// ~~~
    Rocket {
        /// Proper acceleration, 1/m; not zero.
        acceleration: DVec3,
    },
    /// A circle at constant speed: `t = γτ`.
    Orbit {
        /// Its circle.
        circle: Circle,
        /// Speed as proper speed γβ; negative against the right-handed sense.
        proper_speed: f64,
    },
    /// Observers at rest all round a circle, each for one exposure; `tau` goes from 0 (the first) to 1 (a whole film).
    Ring {
        /// Where they stand.
        circle: Circle,
        /// How often the film goes round.
        turns: f64,
        /// Starting-frame time of the first and of the last, metres; the same for a frozen instant.
        instants: (f64, f64),
    },
    /// Through places at times of the starting frame; the clock is at zero at its time zero.
    Keyed(Arc<Track>),
}

/// A circle in the starting frame, told by two perpendicular radii.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Its centre, metres.
    pub centre: DVec3,
    /// From the centre to the start, metres.
    pub radius: DVec3,
    /// From the centre to the place a quarter turn later, as long as `radius`.
    pub quarter: DVec3,
}

impl Circle {
    /// Around `axis` in the right-handed sense; angle zero lies towards +z as seen from the axis (+x when the axis is
    /// z itself).
    pub fn around(centre: DVec3, axis: DVec3, radius: f64, start_rad: f64) -> Self {
        let axis = axis / axis.length();
        let towards = if axis.z.abs() < 0.999 { DVec3::Z } else { DVec3::X };
        let zero = (towards - axis * axis.dot(towards)).normalize_or(DVec3::X) * radius;
        let ninety = axis.cross(zero);
        let (sin, cos) = libm::sincos(start_rad);
        Self { centre, radius: zero * cos + ninety * sin, quarter: ninety * cos - zero * sin }
    }

    /// Place and direction of motion at an angle from the start.
    fn at(&self, angle_rad: f64) -> (DVec3, DVec3) {
        let (sin, cos) = libm::sincos(angle_rad);
        let place = self.centre + self.radius * cos + self.quarter * sin;
        (place, (self.quarter * cos - self.radius * sin) / self.radius.length())
    }
}

/// An observer's worldline.
///
/// The axes it carries are at every moment the pure boost of the starting frame's (not Fermi-Walker transported:
/// on a circle they do not precess).
#[derive(Debug, Clone)]
pub struct Worldline {
    origin: Event,
    lab_from_start: Lorentz<Lab, Rest>,
    course: Course,
}

impl Worldline {
    /// Starts at the event `origin` with `velocity`; the starting frame's axes are the pure boost of the lab's,
    /// turned by `rotation`.
    pub fn new(origin: Event, velocity: Velocity, rotation: DQuat, course: Course) -> Self {
        let lab_from_boosted: Boost<Lab, Rest> = Boost::<Rest, Lab>::to_moving(velocity).inverse();
        let lab_from_start = Lorentz::from(lab_from_boosted) * Lorentz::<Rest, Rest>::rotation(rotation);
        Self { origin, lab_from_start, course }
    }

    /// How it moves.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// The time of the starting frame at proper time `tau`.
    pub fn start_time(&self, tau: f64) -> f64 {
        self.in_start(tau).0.t
    }

    /// In the starting frame at proper time `tau` (metres; a ring: part of the film): the event, and the velocity.
    fn in_start(&self, tau: f64) -> (Event<Rest>, Velocity) {
        match &self.course {
            Course::Inertial => (Event::new(tau, DVec3::ZERO), Velocity::REST),
            &Course::Rocket { acceleration } => {
                let a = acceleration.length();
                let along = acceleration / a;
                // cosh - 1 = 2 sinh²(./2) keeps its digits for short times.
                let half = libm::sinh(0.5 * a * tau);
                let event = Event::new(libm::sinh(a * tau) / a, along * (2.0 * half * half / a));
                (event, Velocity::from_proper(along * libm::sinh(a * tau)))
            }
            &Course::Orbit { circle, proper_speed } => {
                let gamma = (1.0 + proper_speed * proper_speed).sqrt();
                let (place, along) = circle.at(proper_speed * tau / circle.radius.length());
                (Event::new(gamma * tau, place), Velocity::from_proper(along * proper_speed))
            }
            &Course::Ring { circle, turns, instants: (first, last) } => {
                let (place, _) = circle.at(std::f64::consts::TAU * turns * tau);
                (Event::new(first + (last - first) * tau, place), Velocity::REST)
            }
            Course::Keyed(track) => {
                let t = track.when(tau);
                let (place, beta) = track.at(t);
                // A track is slower than light everywhere.
                (Event::new(t, place), Velocity::from_beta(beta).unwrap_or(Velocity::REST))
            }
        }
    }

    /// The proper time at which the starting frame's time is `t`, of a course at rest there or through keys.
    pub fn tau_at_start(&self, t: f64) -> f64 {
        match &self.course {
            Course::Keyed(track) => track.own(t),
            _ => t,
        }
    }

    /// Where the observer is at proper time `tau`, and the axes it carries: those of the starting frame, boosted.
    pub fn at(&self, tau: f64) -> Tetrad {
        let (event, velocity) = self.in_start(tau);
        let start_from_camera: Boost<Rest, Camera> = Boost::<Camera, Rest>::to_moving(velocity).inverse();
        Tetrad {
            event: self.origin + self.lab_from_start * (event - Event::ORIGIN),
            lab_from_camera: self.lab_from_start * Lorentz::from(start_from_camera),
        }
    }

    /// The proper time at which the observer's lab time is `t`, both in metres; none for a ring, whose
    /// observers share an instant.
    pub fn tau_at_lab(&self, t: f64) -> Option<f64> {
        if matches!(self.course, Course::Ring { .. }) {
            return None;
        }
        // Lab time grows with τ at the rate γ ≥ 1: widen until it is enclosed, then halve to the last digit.
        let lab_t = |tau: f64| self.at(tau).event.t - t;
        let mut reach = 1.0_f64.max((t - self.origin.t).abs() * 1e-3);
        while (lab_t(-reach) > 0.0 || lab_t(reach) < 0.0) && reach < 1e300 {
            reach *= 2.0;
        }
        let (mut early, mut late) = (-reach, reach);
        for _ in 0..2100 {
            let middle = 0.5 * (early + late);
            if middle <= early || middle >= late {
                break;
            }
            if lab_t(middle) < 0.0 { early = middle } else { late = middle }
        }
        Some(if lab_t(early).abs() <= lab_t(late).abs() { early } else { late })
    }
}

/// An observer at one moment: the event, and the axes `(u, e1, e2, e3)` of its momentary rest frame.
#[derive(Debug, Clone, Copy)]
pub struct Tetrad {
    /// Where and when.
    pub event: Event,
    /// Columns: right, up, backward and the four-velocity, in the lab.
    pub lab_from_camera: Lorentz<Lab, Camera>,
}

impl Tetrad {
    /// The observer's four-velocity.
    pub fn velocity(&self) -> FourVector {
        self.lab_from_camera * FourVector::new(1.0, DVec3::ZERO)
    }

    /// The same observer with its axes turned: the new axes are `turn` of the old ones.
    pub fn turned(&self, turn: DQuat) -> Self {
        Self { event: self.event, lab_from_camera: self.lab_from_camera * Lorentz::rotation(turn) }
    }

    /// The sight ray in the direction `n` (a unit vector) of the observer's own axes.
    ///
    /// ~~~text
    /// k = u - n¹e₁ - n²e₂ - n³e₃        so that k·u = 1
    /// ~~~
    ///
    /// Aberration is nowhere a formula: it is that sum.
    pub fn sight_ray(&self, n: DVec3) -> SightRay {
        SightRay { event: self.event, k: self.lab_from_camera.light(FourVector::new(1.0, -n)) }
    }

    /// The direction, in the observer's own axes, from which light with the wave vector `k` is seen to come.
    pub fn direction_of(&self, k: FourVector) -> DVec3 {
        let seen = self.lab_from_camera.inverse().light(k);
        -seen.x / seen.x.length()
    }
}

/// The turn that makes a camera's -z look along `forward` with `up` as far up in the picture as can be.
pub fn looking_along(forward: DVec3, up: DVec3) -> DQuat {
    let back = -forward / forward.length();
    let side = up.cross(back);
    let side = if side.length() > 1e-9 * up.length() { side } else { back.any_orthogonal_vector() };
    let right = side / side.length();
    DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back)).normalize()
}
