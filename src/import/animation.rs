//! How the nodes of a file move: keys of places, turns and sizes, and what is between them.

use glam::{DAffine3, DQuat, DVec3, DVec4};

/// A node's place in its parent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pose {
    /// Size, turn and place, each of which may move.
    Parts {
        /// Along its own axes.
        scale: DVec3,
        /// A unit quaternion.
        rotation: DQuat,
        /// Metres.
        translation: DVec3,
    },
    /// Any map; it does not move.
    Matrix(DAffine3),
}

impl Pose {
    /// As a map.
    pub fn map(&self) -> DAffine3 {
        match *self {
            Self::Parts { scale, rotation, translation } => {
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
            Self::Matrix(map) => map,
        }
    }
}

/// Which part of a node's pose moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moving {
    /// Its place.
    Translation,
    /// Its turn.
    Rotation,
    /// Its size.
    Scale,
}

/// What is between two keys (glTF 2.0, appendix C).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the earlier one.
    Step,
    /// A straight line, for turns the shortest way at an even pace.
    Linear,
    /// Hermite's cubic; each key has the slope before it, the value, and the slope after it.
    CubicSpline,
}

/// The keys of a part of a node's pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Index into [`super::Asset::nodes`].
    pub node: usize,
    /// Which part.
    pub moving: Moving,
    /// What is between the keys.
    pub interpolation: Interpolation,
    /// Seconds, rising.
    pub keys: Vec<f64>,
    /// Values, one for each key or three; of places and sizes the fourth number means nothing.
    pub values: Vec<DVec4>,
}

/// An animation of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Animation {
    /// The file's name for it; may be empty.
    pub name: String,
    /// What moves: only nodes that a camera hangs on are read.
    pub channels: Vec<Channel>,
}

impl Channel {
    /// The value at a time; held before the first key and after the last.
    pub fn at(&self, seconds: f64) -> DVec4 {
        let after = self.keys.partition_point(|key| *key <= seconds);
        let cubic = self.interpolation == Interpolation::CubicSpline;
        let value = |key: usize, part: usize| {
            let at = if cubic { 3 * key + part } else { key };
            self.values.get(at).copied().unwrap_or_default()
        };
        let (Some(from), Some(to)) = (after.checked_sub(1), self.keys.get(after)) else {
            return value(if after == 0 { 0 } else { after - 1 }, 1);
        };
        let length = to - self.keys[from];
        let part = (seconds - self.keys[from]) / length;
        let (a, b) = (value(from, 1), value(after, 1));
        match self.interpolation {
            Interpolation::Step => a,
            Interpolation::Linear if self.moving == Moving::Rotation => slerp(a, b, part),
            Interpolation::Linear => a + (b - a) * part,
            Interpolation::CubicSpline => {
                let (leaves, arrives) = (value(from, 2) * length, value(after, 0) * length);
                let (square, cube) = (part * part, part * part * part);
                let p = a * (2.0 * cube - 3.0 * square + 1.0) + b * (3.0 * square - 2.0 * cube);
                p + leaves * (cube - 2.0 * square + part) + arrives * (cube - square)
            }
        }
    }
}

/// From one unit quaternion to another the shorter way, at an even pace.
fn slerp(a: DVec4, b: DVec4, part: f64) -> DVec4 {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let angle = 2.0 * libm::atan2((a - b).length(), (a + b).length());
    let sin = libm::sin(angle);
    if sin.abs() < 1e-6 {
        return a + (b - a) * part;
    }
    a * (libm::sin((1.0 - part) * angle) / sin) + b * (libm::sin(part * angle) / sin)
}

/// A camera with all that it hangs on, from the outermost node to its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    pub(crate) links: Vec<(Pose, Vec<Channel>)>,
}

impl Rig {
    /// The camera's place in the asset's space at a time of the file, seconds.
    pub fn at(&self, seconds: f64) -> DAffine3 {
        self.links.iter().fold(DAffine3::IDENTITY, |outer, (pose, channels)| {
            let mut pose = *pose;
            for channel in channels {
                let value = channel.at(seconds);
                if let Pose::Parts { scale, rotation, translation } = &mut pose {
                    match channel.moving {
                        Moving::Translation => *translation = value.truncate(),
                        Moving::Rotation => *rotation = DQuat::from_vec4(value / value.length()),
                        Moving::Scale => *scale = value.truncate(),
                    }
                }
            }
            outer * pose.map()
        })
    }

    /// What moves in it.
    pub fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.links.iter().flat_map(|(_, channels)| channels)
    }

    /// The times of all keys, seconds, rising.
    pub fn keys(&self) -> Vec<f64> {
        let mut keys: Vec<f64> = self.channels().flat_map(|channel| channel.keys.iter().copied()).collect();
        keys.sort_unstable_by(f64::total_cmp);
        keys.dedup();
        keys
    }

    /// Whether its place may bend between keys: cubics, and what hangs on something that turns or grows.
    pub fn bends(&self) -> bool {
        let last = self.links.len().saturating_sub(1);
        let bends = |(link, channel): (usize, &Channel)| {
            channel.interpolation == Interpolation::CubicSpline
                || (link < last && channel.moving != Moving::Translation)
        };
        let links = self.links.iter().enumerate();
        links.flat_map(|(link, (_, channels))| channels.iter().map(move |c| (link, c))).any(bends)
    }
}
