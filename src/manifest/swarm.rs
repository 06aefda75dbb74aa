//! Many bodies in the place of one, made up from a number.

use super::body::Body;
use super::motion::{Placement, Speed};
use super::node::Node;
use super::plain::Count;
use super::reader::{Read, Reader};
use super::record::record;
use super::solid::Extent;
use crate::spacetime::Velocity;
use crate::surroundings::{draws, on_sphere};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// Most bodies of a swarm.
const MOST: u32 = 100_000;

record! {
    /// Many bodies in the place of one: strewn evenly over a box, turned at random, each with a velocity of its own. Body number i
    /// depends on the seed and i alone.
    pub Swarm, "a swarm" {
        /// Whichever number it is, others make another swarm: 1 unless said.
        seed: u32 = Count<0, { u32::MAX }>, default(1), "7";
        /// How many.
        count: u32 = Count<1, MOST>, required, "10000";
        /// The sides of the box that their origins are in at the lab time `at_time`; its middle is the body's `at`.
        within: DVec3 = Extent, required, "20 4 20 m";
        /// The speed of the fastest: they go to all sides alike, with rapidities even from zero to that of this speed.
        speed: f64 = Speed, required, "0.6 c";
    }
}

impl Swarm {
    /// Where each of them is and how it moves; `middle` is where the body says that it is.
    fn placements(&self, middle: &Placement) -> impl Iterator<Item = Placement> {
        let (seed, within, fastest) = (u64::from(self.seed), self.within, libm::asinh(self.speed.abs()));
        (0..u64::from(self.count)).map(move |i| {
            let [x, y, z, height, around, haste, a, b, c] = draws(seed, i);
            Placement {
                at: middle.at + within * (DVec3::new(x, y, z) - 0.5),
                velocity: Velocity::from_rapidity(haste * fastest, on_sphere(height, around)),
                rotation: turn(a, b, c) * middle.rotation,
                ..middle.clone()
            }
        })
    }

    /// The greatest Lorentz factor of them.
    fn gamma(&self) -> f64 {
        libm::hypot(1.0, self.speed)
    }
}

/// A rotation, all of them alike, of three even numbers. Source: Shoemake, Graphics Gems III (1992), p. 124.
fn turn(a: f64, b: f64, c: f64) -> DQuat {
    let ((sin_b, cos_b), (sin_c, cos_c)) = (libm::sincos(TAU * b), libm::sincos(TAU * c));
    let (near, far) = ((1.0 - a).sqrt(), a.sqrt());
    DQuat::from_xyzw(near * sin_b, near * cos_b, far * sin_c, far * cos_c).normalize()
}

impl Body {
    /// Where it is and how it moves: once, or of a swarm as often as that has bodies.
    pub fn placements(&self) -> Vec<Placement> {
        match &self.swarm {
            Some(swarm) => swarm.placements(&self.placement).collect(),
            None => vec![self.placement.clone()],
        }
    }

    /// How many there are of it.
    pub fn count(&self) -> usize {
        self.swarm.as_ref().map_or(1, |swarm| swarm.count as usize)
    }

    /// Its Lorentz factor; of a swarm the greatest.
    pub(crate) fn gamma(&self) -> f64 {
        self.swarm.as_ref().map_or_else(|| self.placement.velocity.gamma(), Swarm::gamma)
    }
}

/// Faults a velocity beside a swarm: which of two would it be?
pub(super) fn check(item: &Node, reader: &mut Reader<'_>) -> Read<()> {
    match (item.get("swarm"), item.get("velocity")) {
        (Some(_), Some(velocity)) => {
            let what = "the bodies of a swarm have velocities of their own";
            Err(reader.fault(&velocity.place, what, "remove `velocity`, or `swarm`"))
        }
        _ => Ok(()),
    }
}
