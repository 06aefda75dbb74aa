//! Where things are and how they move: velocities, rotations, and the keys that bodies, lights and the
//! observer share.

use super::node::{Content, Node};
use super::plain::{Direction, Real, Vector};
use super::quantity::{Angle, Instant, Point, Quantity, VelocityVector, Written, vector};
use super::reader::{LIGHT_SPEED, Read, Reader};
use super::record::{Kind, Shape, choice, record};
use super::units::{self, Dimension};
use crate::spacetime::Velocity;
use glam::{DQuat, DVec3};

/// The greatest Lorentz factor. Up to it the Doppler factor is right to a part 1e-6 (a direction's last digit decides), and
/// a body one metre away appears where it is seen within 1e-7 of that metre.
pub(crate) const GREATEST_GAMMA: f64 = 1e8;
/// The greatest that a speed in units of c can tell: its last digit is a part 1e-6 of γ there.
const GREATEST_GAMMA_OF_SPEED: f64 = 1e5;
const TOO_NEAR_FOR_SPEED: &str = "so near the speed of light a speed in c does not tell how fast it is";
const USE_GAMMA: &str = "up to 0.99999999995 c (γ = 1e5); beyond, `gamma: 1e6` in its place";
const TOO_NEAR: &str = "this is so near the speed of light that the arithmetic cannot follow";

record! {
    /// Where something is, how it moves, and how it is turned.
    pub Placement, "a placement" {
        /// Its origin's place in the lab at the lab time `at_time`.
        at: DVec3 = Point, default(DVec3::ZERO), "0 2 -9.5 m";
        /// When it is there, and its own clock reads zero: 0 s unless said.
        at_time: f64 = Instant, default(0.0), "12 ns";
        /// Its velocity in the lab.
        velocity: Velocity = Motion, default(Velocity::REST), "0.9 0 0 c";
        /// How it is turned in its rest frame, whose axes are the pure boost of the lab's.
        rotation: DQuat = Rotation, default(DQuat::IDENTITY), "30 deg about 0 1 0";
    }
}

choice! {
    /// How fast, by one of the measures that can tell speeds near that of light apart.
    Fast, "a velocity" {
        /// The Lorentz factor γ, 1 or more.
        gamma => Gamma(f64) = LorentzFactor, "50";
        /// The rapidity, artanh β.
        rapidity => Rapidity(f64) = Rapidity, "3";
        /// The proper velocity γβ.
        gamma_beta => Proper(DVec3) = ProperVelocity, "0.3 0 2.06";
    }
}

record! {
    /// A velocity by γ or rapidity and a direction, or by γβ.
    MotionKeys, "a velocity" {
        @include fast: Fast, "How fast.";
        /// The direction of `gamma` or `rapidity`.
        along: Option<DVec3> = Direction, optional, "0 0 1";
    }
}

/// A velocity, as three numbers with a unit or as a map.
pub(crate) struct Motion;

impl Kind for Motion {
    type Value = Velocity;
    fn shape() -> Shape {
        Shape::Either(vec![VelocityVector::shape(), MotionKeys::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Velocity> {
        if !matches!(node.content, Content::Map(_)) {
            let beta = VelocityVector::read(node, reader)?;
            let velocity = Velocity::from_beta(beta).map_err(|_| too_fast(node, beta, reader))?;
            if velocity.gamma() > GREATEST_GAMMA_OF_SPEED {
                return Err(reader.fault(&node.place, TOO_NEAR_FOR_SPEED, USE_GAMMA));
            }
            return Ok(velocity);
        }
        let keys = MotionKeys::read(node, reader)?;
        let along = |reader: &mut Reader<'_>| match keys.along {
            Some(along) => Ok(along),
            None => Err(reader.fault(&node.place, "this velocity has no direction", "along: 0 0 1")),
        };
        match keys.fast {
            Fast::Gamma(gamma) => {
                let along = along(reader)?;
                Ok(Velocity::from_gamma(gamma, along))
            }
            Fast::Rapidity(rapidity) => {
                let along = along(reader)?;
                Ok(Velocity::from_proper(along * libm::sinh(rapidity)))
            }
            Fast::Proper(u) => {
                if keys.along.is_some() {
                    let hint = "`gamma_beta` has a direction already: remove `along`";
                    return Err(reader.fault(&node.place, "this velocity has two directions", hint));
                }
                Ok(Velocity::from_proper(u))
            }
        }
    }
}

/// Says how fast what was written would be, and what to type.
fn too_fast(node: &Node, beta: DVec3, reader: &mut Reader<'_>) -> super::reader::Reported {
    let (speed, text) = (beta.length(), node.text().unwrap_or_default());
    let largest = beta.abs().max_element();
    let along = beta / largest;
    let slower = (along / along.length() * 0.99).to_array().map(rounded).join(" ");
    let along = along.to_array().map(rounded).join(" ");
    let hint = format!("{}, or {{ gamma: 50, along: {along} }}", reader.typed(&format!("{slower} c")));
    reader.fault(&node.place, format!("`{text}` is {} c, not below the speed of light", rounded(speed)), hint)
}

/// Four decimals at most.
fn rounded(x: f64) -> String {
    let text = format!("{x:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A Lorentz factor.
struct LorentzFactor;

impl Kind for LorentzFactor {
    type Value = f64;
    fn shape() -> Shape {
        Real::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let gamma = Real::read(node, reader)?;
        if (1.0..=GREATEST_GAMMA).contains(&gamma) {
            return Ok(gamma);
        }
        if gamma < 1.0 {
            let what = format!("a Lorentz factor is 1 or more; here is {gamma}");
            return Err(reader.fault(&node.place, what, "gamma: 2 (1 is rest, 2 is 0.866 c)"));
        }
        Err(reader.fault(&node.place, TOO_NEAR, "gamma: 1e8 (at most)"))
    }
}

/// Declares kinds that are too near the speed of light beyond some γβ.
macro_rules! proper {
    ($( $(#[doc = $doc:literal])* $name:ident: $kind:ty, $of:expr; )*) => {$(
        $(#[doc = $doc])*
        struct $name;
        impl Kind for $name {
            type Value = <$kind as Kind>::Value;
            fn shape() -> Shape {
                <$kind>::shape()
            }
            fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
                let value = <$kind>::read(node, reader)?;
                proper(node, ($of)(value), reader)?;
                Ok(value)
            }
        }
    )*};
}

proper! {
    /// artanh β.
    Rapidity: Real, libm::sinh;
    /// γβ.
    ProperVelocity: Vector, DVec3::length;
    /// γβ along a path.
    ProperSpeed: Real, |u: f64| u;
}

fn proper(node: &Node, u: f64, reader: &mut Reader<'_>) -> Read<f64> {
    if u.abs() <= GREATEST_GAMMA {
        return Ok(u);
    }
    Err(reader.fault(&node.place, TOO_NEAR, "a Lorentz factor of 1e8, or a rapidity of 19.1, is the most"))
}

/// A speed along a known path: what comes of it is γβ, negative for the other way round.
pub(crate) struct Speed;

impl Speed {
    const QUANTITY: Quantity =
        Quantity { what: "a speed", count: 1, dimensions: &[Dimension::Speed], unit: "c" };
}

impl Kind for Speed {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Text("a speed with its unit, as in 0.8 c"), FastAlong::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        if matches!(node.content, Content::Map(_)) {
            return match FastAlong::read(node, reader)? {
                FastAlong::Gamma(gamma) => Ok(((gamma - 1.0) * (gamma + 1.0)).sqrt()),
                FastAlong::Rapidity(rapidity) => Ok(libm::sinh(rapidity)),
                FastAlong::Proper(u) => Ok(u),
            };
        }
        let (numbers, _) = reader.quantity(node, &Self::QUANTITY)?;
        let beta = numbers.first().copied().unwrap_or_default();
        let velocity = Velocity::from_beta(DVec3::X * beta).map_err(|_| {
            let text = node.text().unwrap_or_default();
            let what = format!("`{text}` is {} c, not below the speed of light", rounded(beta));
            let hint = format!("{}, or {{ gamma: 50 }}", reader.typed("0.99 c"));
            reader.fault(&node.place, what, hint)
        })?;
        if velocity.gamma() > GREATEST_GAMMA_OF_SPEED {
            return Err(reader.fault(&node.place, TOO_NEAR_FOR_SPEED, USE_GAMMA));
        }
        Ok(velocity.proper().x)
    }
}

choice! {
    /// How fast along a known path.
    FastAlong, "a speed" {
        /// The Lorentz factor γ, 1 or more.
        gamma => Gamma(f64) = LorentzFactor, "50";
        /// The rapidity, artanh β.
        rapidity => Rapidity(f64) = Rapidity, "3";
        /// The proper speed γβ.
        gamma_beta => Proper(f64) = ProperSpeed, "2.06";
    }
}

/// The speed of light, in metres per second of this manifest. Reading it changes what a second is.
pub(crate) struct LightSpeed;

impl Kind for LightSpeed {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Text("a speed in m/s")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        const QUANTITY: Quantity =
            Quantity { what: "the speed of light", count: 1, dimensions: &[Dimension::Speed], unit: "m/s" };
        let text = reader.text(node, QUANTITY.what, "299792458 m/s")?;
        // In terms of itself it says nothing.
        if matches!(units::plain(Written::of(text).rest).as_str(), "c" | "ls/s" | "ly/yr") {
            let number = Written::of(text).numbers.first().copied().unwrap_or(1.0);
            let hint = reader.typed(&format!("{} m/s", number * LIGHT_SPEED));
            return Err(reader.fault(
                &node.place,
                "the speed of light cannot be given in terms of itself",
                hint,
            ));
        }
        let usual = std::mem::replace(&mut reader.light_speed, 1.0);
        let read = reader.quantity(node, &QUANTITY);
        reader.light_speed = usual;
        let speed = read?.0.first().copied().unwrap_or_default();
        if !(1e-20..=1e20).contains(&speed) {
            let hint = reader.typed("299792458 m/s (from 1e-20 to 1e20)");
            return Err(reader.fault(&node.place, format!("light cannot have the speed `{text}`"), hint));
        }
        reader.light_speed = speed;
        Ok(speed)
    }
}

/// A rotation: `30 deg about 0 1 0`, a list of those in the order in which they are done, or a quaternion.
pub(crate) struct Rotation;

record! {
    /// A rotation as a unit quaternion, for manifests written by programs.
    QuaternionKeys, "a rotation" {
        /// Its components in the order x y z w, of any length above zero.
        quaternion: DQuat = Quaternion, required, "0 0.7071 0 0.7071";
    }
}

impl Kind for Rotation {
    type Value = DQuat;
    fn shape() -> Shape {
        let about = || Shape::Text("an angle and an axis, as in 30 deg about 0 1 0");
        Shape::Either(vec![about(), Shape::List(about), QuaternionKeys::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DQuat> {
        match &node.content {
            Content::Scalar { .. } => turn(node, reader),
            Content::Map(_) => Ok(QuaternionKeys::read(node, reader)?.quaternion),
            Content::List(items) => {
                let turns: Vec<_> = items.iter().map(|item| turn(item, reader)).collect();
                let all = turns.into_iter().try_fold(DQuat::IDENTITY, |done, next| Ok(next? * done));
                all.map(DQuat::normalize)
            }
        }
    }
}

/// `30 deg about 0 1 0`.
fn turn(node: &Node, reader: &mut Reader<'_>) -> Read<DQuat> {
    let text = reader.text(node, "a rotation", "30 deg about 0 1 0")?;
    let Some((angle, axis)) = text.split_once("about") else {
        let written = Written::of(text);
        let angle = if written.numbers.len() == 1 && written.rest == "deg" { text } else { "30 deg" };
        let hint = reader.typed(&format!("{angle} about 0 1 0"));
        return Err(reader.fault(&node.place, "a rotation is an angle about an axis", hint));
    };
    let part = |text: &str| {
        let content = Content::Scalar { text: text.trim().to_owned(), quoted: true };
        Node::new(node.place.clone(), content)
    };
    let (before, after) = (format!("{}about ", angle.trim_start()), format!(" about{}", axis.trim_end()));
    let angle = reader.between("", &after, |reader| Angle::read(&part(angle), reader));
    let axis = reader.between(&before, "", |reader| Direction::read(&part(axis), reader));
    let (angle, axis) = (angle?, axis?);
    let (sin, cos) = libm::sincos(angle / 2.0);
    Ok(DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos))
}

struct Quaternion;

impl Kind for Quaternion {
    type Value = DQuat;
    fn shape() -> Shape {
        Shape::Text("four bare numbers x y z w")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DQuat> {
        let numbers = reader.bare(node, "a quaternion", 4)?;
        let largest = numbers.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if largest > 0.0 {
            let w = numbers.get(3).copied().unwrap_or_default() / largest;
            let v = vector(&numbers) / largest;
            return Ok(DQuat::from_xyzw(v.x, v.y, v.z, w).normalize());
        }
        let hint = reader.typed("0 0 0 1");
        Err(reader.fault(&node.place, "a quaternion cannot be zero", hint))
    }
}
