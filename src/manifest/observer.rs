//! The observer as written.

use super::Spanned;
use super::camera::{self, Camera};
use super::keyed::PathKeys;
use super::lens::{self, FieldOfView, Lens};
use super::motion::{Placement, Speed};
use super::node::Node;
use super::plain::{Direction, Real};
use super::quantity::{Acceleration, Angle, Length, Point, Written};
use super::reader::{Read, Reader, instead};
use super::record::{Kind, Shape, choice, record};
use super::stereo::Stereo;
use crate::spacetime::Track;
use glam::DVec3;
use std::sync::Arc;

record! {
    /// Who looks. The placement says where its start frame S is and how that moves: a frame whose origin is at
    /// the placement's event, and whose axes are the pure boost of the lab's, turned by its rotation. Directions
    /// and the worldline are given in S.
    pub Observer, "the observer" {
        @include placement: Placement, "The start frame S.";
        @include view: View, "Where the observer looks.";
        @include worldline: Worldline, "How the observer moves in S.";
        /// What is up in the picture: 0 1 0 unless said.
        up: DVec3 = Direction, default(DVec3::Y), "0 1 0";
        /// How places in the picture belong to directions: `pinhole` unless said.
        lens: Lens = Lens, default(Lens::Pinhole), "fisheye";
        /// Angle across the width of the picture: of a pinhole below 180 deg, and 50 deg unless said; of a fisheye up to
        /// 360 deg, and 180 deg unless said.
        field_of_view: Option<f64> = FieldOfView, optional, "50 deg";
        /// Two eyes in place of one.
        stereo: Option<Stereo> = Stereo, optional, "{ apart: 6.5 cm }";
    }
}

choice! {
    /// Where the observer looks: `direction: 0 0 -1` unless said.
    pub View, "the observer's view", otherwise(View::Direction(DVec3::NEG_Z)) {
        /// A fixed direction: 0 0 -1 unless said.
        direction => Direction(DVec3) = Direction, "0 0 -1";
        /// A body, where it appears, or a place.
        look_at => LookAt(LookAt) = LookAt, "monkey";
    }
}

choice! {
    /// How the observer moves in its start frame S: not at all unless said.
    pub Worldline, "the observer's worldline", otherwise(Worldline::Rest) {
        @unit Rest, "It stays at the origin of S.";
        /// Constant proper acceleration, beginning at rest at the origin of S.
        rocket => Rocket(Rocket) = Rocket, "{ acceleration: 0 0 0.1 c/s }";
        /// A circle at constant speed.
        orbit => Orbit(Orbit) = Orbit, "{ radius: 4 m, speed: 0.5 c }";
        /// Not one observer but a ring of them, all at rest, one for each exposure: a look around something
        /// that is held at one instant.
        ring => Ring(Ring) = Ring, "{ radius: 4 m }";
        /// Places at times, and between them a smooth path (velocity and acceleration are continuous).
        keys => Keys(Arc<Track>) = PathKeys, "[{ at_time: 0 s, at: 0 1 5 m }, { at_time: 4 s, at: 2 1 4 m }]";
        /// A camera of a model file, standing or moved as in Blender.
        camera => Camera(Camera) = Camera, "{ asset: street, name: Camera }";
    }
}

/// What the observer keeps in the middle of the picture.
#[derive(Debug, Clone)]
pub enum LookAt {
    /// The body with this index in the manifest's list.
    Body(Spanned<usize>),
    /// A place in the lab, metres.
    Point(DVec3),
}

impl Kind for LookAt {
    type Value = Self;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Text("the name of a body"), Point::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        let text = reader.text(node, "what to look at", "0 1 0 m")?;
        let bodies: Vec<_> = reader.bodies.iter().enumerate().filter(|(_, name)| *name == text).collect();
        match bodies.as_slice() {
            [(index, _)] => Ok(Self::Body(Spanned { value: *index, place: node.place.clone() })),
            [] if !Written::of(text).numbers.is_empty() => Ok(Self::Point(Point::read(node, reader)?)),
            [] => {
                let hint = instead(text, reader.bodies.iter().map(String::as_str), "bodies");
                Err(reader.missing(&node.place, format!("there is no body named `{text}`"), hint))
            }
            several => {
                let what = format!("{} bodies are named `{text}`", several.len());
                let hint = format!("give the one meant a name of its own: `name: {text}_1`");
                Err(reader.fault(&node.place, what, hint))
            }
        }
    }
}

record! {
    /// Constant proper acceleration from rest in S.
    pub Rocket, "a rocket" {
        /// What the observer feels, per metre (c² per metre), in the axes of S.
        acceleration: DVec3 = Acceleration, required, "0 0 0.1 c/s";
    }
}

record! {
    /// A circle at constant speed in S.
    ///
    /// Angles count right-handedly about the axis, from the direction of +z as seen along the axis (of +x if
    /// the axis is along z).
    pub Orbit, "an orbit" {
        /// Its centre in S, metres.
        centre: DVec3 = Point, default(DVec3::ZERO), "0 1 0 m";
        /// Its radius in S, metres.
        radius: f64 = Length, required, "4 m";
        /// Its axis; a unit vector.
        axis: DVec3 = Direction, default(DVec3::Y), "0 1 0";
        /// How fast; below zero for the other way round.
        speed: f64 = Speed, required, "0.5 c";
        /// Where on the circle the observer is at its time zero: 0 deg (towards +z) unless said.
        start: f64 = Angle, default(0.0), "30 deg";
    }
}

record! {
    /// A ring of observers at rest in S. Angles count as for an orbit; `exposures` say how many, and `at` which instant.
    pub Ring, "a ring" {
        /// Its centre in S, metres.
        centre: DVec3 = Point, default(DVec3::ZERO), "0 1 0 m";
        /// Its radius, metres.
        radius: f64 = Length, required, "4 m";
        /// Its axis; a unit vector.
        axis: DVec3 = Direction, default(DVec3::Y), "0 1 0";
        /// The angle of the first observer, radians.
        start: f64 = Angle, default(0.0), "30 deg";
        /// How often the ring goes round, below zero for the other way round.
        turns: f64 = Real, default(1.0), "1";
    }
}

/// The observer, checked.
pub(crate) struct ObserverKind;

impl Kind for ObserverKind {
    type Value = Observer;
    fn shape() -> Shape {
        Observer::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Observer> {
        reader.lens = lens::of(node, reader.partial);
        reader.ring = node.get("ring").is_some();
        reader.filmed = node.get("camera").is_some();
        let sound = camera::check(node, reader);
        let observer = <Observer as Kind>::read(node, reader)?;
        sound?;
        let View::Direction(direction) = observer.view else { return Ok(observer) };
        if direction.cross(observer.up).length() > 1e-9 {
            return Ok(observer);
        }
        let culprit = node.get("direction").or_else(|| node.get("up"));
        let place = culprit.map_or(&node.place, |node| &node.place);
        let other = if direction.y.abs() > 0.9 { "up: 0 0 -1" } else { "up: 0 1 0" };
        Err(reader.fault(
            place,
            "the observer looks along its own `up`: what would be up in the picture?",
            other,
        ))
    }
}
