//! Events, four-vectors, velocities, boosts, worldlines and sight rays.
//!
//! Conventions, once: c = 1 and times are lengths in metres; signature (+,-,-,-), so that frequencies and
//! proper times come out positive; everything in `f64`.
//!
//! Rest frames are told apart by type, at no cost in bytes: `Event` is an event in the lab, `Event<Rest>`
//! one in the rest frame of a body. Transforms are named `dest_from_source` and put the destination first in
//! their types, so `rest_from_lab: Boost<Rest, Lab>` matches its neighbours by adjacency. What the types do
//! *not* know is which rest frame: every function therefore has at most one in scope.

mod boost;
mod event;
mod keyed;
mod ray;
mod velocity;
mod worldline;

pub use boost::{Boost, Lorentz, Poincare};
pub use event::{Event, FourVector};
pub use keyed::{TooFast, Track};
pub use ray::{Doppler, SightRay};
pub use velocity::{NotSlowerThanLight, Velocity};
pub use worldline::{Circle, Course, Tetrad, Worldline, looking_along};

use std::fmt::Debug;

/// A marker for the role of a reference frame.
pub trait Frame: Copy + Debug + 'static {}

/// The base frame of a manifest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lab {}

/// The rest frame of a body, a lamp, or the start of a worldline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rest {}

/// The momentary rest frame of the observer, with the camera's axes: x right, y up, z backward.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Camera {}

impl Frame for Lab {}
impl Frame for Rest {}
impl Frame for Camera {}
