//! A camera of a model file, as the file moves it.

use crate::import::Rig;
use crate::spacetime::looking_along;
use glam::{DQuat, DVec3};

/// How a camera of a file turns, in its worldline's starting frame, whose space the file's is.
#[derive(Debug, Clone, PartialEq)]
pub struct Filmed {
    /// The camera and all that it hangs on.
    pub rig: Rig,
    /// The starting frame's time at which the file's is zero, metres.
    pub start: f64,
    /// Seconds of the file in a metre of that time.
    pub pace: f64,
    /// The starting frame's times of the first key and of the last.
    pub span: (f64, f64),
}

impl Filmed {
    /// The turn of the camera at a time of the starting frame, metres.
    pub fn turn(&self, t: f64) -> DQuat {
        let place = self.rig.at((t - self.start) * self.pace);
        let turn = looking_along(-place.matrix3.z_axis, place.matrix3.y_axis);
        // Of a camera that is scaled to nothing for a moment nothing says where it looks.
        if turn.is_finite() { turn } else { DQuat::IDENTITY }
    }

    /// The time of the starting frame at a time of the file, seconds.
    pub fn time_of(&self, seconds: f64) -> f64 {
        self.start + seconds / self.pace
    }

    /// Where the camera is in the starting frame at a time of the file.
    pub fn place(&self, seconds: f64) -> DVec3 {
        self.rig.at(seconds).translation
    }
}
