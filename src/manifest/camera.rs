//! A camera of a model file as the observer.

use super::Spanned;
use super::body::AssetName;
use super::node::Node;
use super::plain::{Placed, Real, Text};
use super::quantity::Instant;
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, record};

record! {
    /// A camera of a model file, standing or moved by the file's animations; S is the file's space. Through its places at the keys
    /// goes a smooth path, as through `keys`; it looks where the file says at each moment, with the file's field of view.
    pub Camera, "a camera of a file" {
        /// The asset in whose file it is.
        asset: Spanned<String> = AssetName, required, "street";
        /// The file's name for it, or for its node; need not be said if it is the only one.
        name: Option<Spanned<String>> = Placed<Text>, optional, "Camera";
        /// Only this animation of the file moves it: all of them unless said.
        animation: Option<Spanned<String>> = Placed<Text>, optional, "CameraAction";
        /// When, in S's time, the animation's time is zero: 0 s unless said.
        start: f64 = Instant, default(0.0), "2 s";
        /// Seconds of the animation in a second of S's time: 1 unless said; 0.5 is half as fast.
        rate: f64 = Pace, default(1.0), "0.5";
    }
}

/// A bare number above zero.
struct Pace;

impl Kind for Pace {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a bare number above zero")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let number = Real::read(node, reader)?;
        if (1e-20..=1e20).contains(&number) {
            return Ok(number);
        }
        let hint = reader.typed("1 (above zero)");
        Err(reader.fault(&node.place, format!("`{number}` is not above zero"), hint))
    }
}

/// Faults what a camera of a file has of its own.
pub(super) fn check(observer: &Node, reader: &mut Reader<'_>) -> Read<()> {
    let mut sound = Ok(());
    for key in ["direction", "look_at", "up"] {
        let Some(value) = observer.get(key).filter(|_| observer.get("camera").is_some()) else { continue };
        let what = format!("a camera of a file looks where the file says, and here is `{key}`");
        sound = Err(reader.fault(&value.place, what, format!("remove `{key}`, or `camera`")));
    }
    sound
}
