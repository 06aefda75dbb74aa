//! `turntable` and `flyby`: observer and exposures in short.

use super::exposures::{Clock, MOST_EXPOSURES};
use super::motion::{Placement, Speed};
use super::node::{Content, Node};
use super::observer::{LookAt, Observer, Orbit, Ring, View, Worldline};
use super::plain::{Count, Direction, Real};
use super::quantity::{Angle, Instant, Length, Offset};
use super::reader::{Read, Reader, Reported};
use super::record::{Kind, Record, Shape, choice, record};
use super::{Exposures, Manifest};
use crate::spacetime::Velocity;
use glam::DVec3;
use std::rc::Rc;

choice! {
    /// Observer and exposures in short.
    pub Shorthand, "a shorthand", otherwise(Shorthand::None) {
        @unit None, "All is written out.";
        /// Once round something, or how often you like, looking at it: in place of `exposures` and of where the `observer` is.
        turntable => Turntable(Turntable) = Turntable, "{ around: monkey, radius: 4 m }";
        /// Past something, looking at it, or something's way past: in place of `exposures` and of where the `observer` is.
        flyby => Flyby(Flyby) = Flyby, "{ past: monkey, distance: 5 m, speed: 0.9 c }";
    }
}

record! {
    /// A circle around something. With a `speed` one observer goes round, and takes pictures at even times by its own clock; around
    /// a body that moves, it goes along with it. Without, a ring of observers at rest in the lab take one picture each, all at the
    /// same instant. The last picture stands one step before the first, so that the film can be looped. Angles count
    /// right-handedly about the axis, from the direction of +z (of +x if the axis is along z).
    pub Turntable, "a turntable" {
        /// A body, whose origin at the lab time `at` is the middle, or a place.
        around: LookAt = LookAt, required, "monkey";
        /// How far from the axis.
        radius: f64 = Length, required, "4 m";
        /// How far above the middle, along the axis: 0 m unless said.
        height: f64 = Offset, default(0.0), "1 m";
        /// The axis, which is up in the pictures unless `observer` says otherwise: 0 1 0 unless said.
        axis: DVec3 = Direction, default(DVec3::Y), "0 1 0";
        /// Where on the circle the first picture is taken: 0 deg unless said.
        start: f64 = Angle, default(0.0), "30 deg";
        /// How often it goes round, below zero for the other way round: 1 unless said.
        turns: f64 = Real, default(1.0), "1";
        /// How fast an observer goes round; none unless said, but a ring of observers at rest.
        speed: Option<f64> = Going, optional, "0.5 c";
        /// The lab time of the first picture (of a ring, of all): 0 s unless said.
        at: f64 = Instant, default(0.0), "4 s";
        /// How many pictures: 96 unless said.
        count: u32 = Count<1, MOST_EXPOSURES>, default(96), "96";
    }
}

record! {
    /// A straight way past something. With a `speed` the observer goes past, and takes pictures at even times by its own clock, the
    /// middle one where it is nearest. Without, the observer stands, and what moves at constant velocity goes past; the pictures
    /// show it from the beginning to the end of its way as it is seen, late by the time that its light takes.
    pub Flyby, "a flyby" {
        /// A body, or a place if the observer goes past it. The middle of the way is where the body's origin is at the lab time `at`.
        past: LookAt = LookAt, required, "monkey";
        /// How far from it the observer is where it is nearest.
        distance: f64 = Length, required, "5 m";
        /// How fast the observer goes past; none unless said, but the body moves and the observer stands.
        speed: Option<f64> = Going, optional, "0.9 c";
        /// Which way the observer goes: 1 0 0 unless said.
        along: Option<DVec3> = Direction, optional, "1 0 0";
        /// On which side of the way it is, seen from the middle: 0 0 1 unless said.
        side: Option<DVec3> = Direction, optional, "0 0.2 1";
        /// How far the way goes to either side of the middle, in distances: 4 unless said.
        reach: f64 = Reach, default(4.0), "4";
        /// The lab time at which the middle is passed: 0 s unless said.
        at: f64 = Instant, default(0.0), "4 s";
        /// How many pictures: 96 unless said.
        count: u32 = Count<1, MOST_EXPOSURES>, default(96), "96";
    }
}

/// A speed that is not zero.
struct Going;

impl Kind for Going {
    type Value = f64;
    fn shape() -> Shape {
        Speed::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let speed = Speed::read(node, reader)?;
        if speed.abs() > 1e-30 {
            return Ok(speed);
        }
        let hint = reader.typed("0.5 c, or leave it out");
        Err(reader.fault(&node.place, "the observer does not move", hint))
    }
}

/// How far a way goes to either side.
struct Reach;

impl Kind for Reach {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a bare number above zero")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let reach = Real::read(node, reader)?;
        if (1e-12..=1e12).contains(&reach) {
            return Ok(reach);
        }
        let hint = reader.typed("4");
        Err(reader.fault(&node.place, "the way past goes nowhere", hint))
    }
}

/// The keys of a shorthand that is written.
pub(super) const KEYS: [&str; 2] = ["turntable", "flyby"];

/// The keys of an observer that a shorthand says.
fn taken() -> Vec<&'static str> {
    Placement::fields().into_iter().chain(Worldline::fields()).map(|field| field.key).collect()
}

/// Takes away what a shorthand says, where one is put on top of another manifest.
pub(super) fn make_way(root: &mut Node) {
    let Content::Map(entries) = &mut root.content else { return };
    entries.retain(|entry| entry.key != "exposures");
    let Some(observer) = entries.iter_mut().find(|entry| entry.key == "observer") else { return };
    let views = View::fields().into_iter().map(|field| field.key);
    let said: Vec<_> = taken().into_iter().chain(views).collect();
    if let Content::Map(entries) = &mut Rc::make_mut(&mut observer.value).content {
        entries.retain(|entry| !said.contains(&entry.key.as_str()));
    }
}

/// Faults what a shorthand says already.
pub(super) fn check(root: &Node, reader: &mut Reader<'_>) -> Read<()> {
    let said = |key| root.get(key).filter(|value| !value.is_nothing());
    let Some((key, short)) = KEYS.into_iter().find_map(|key| Some((key, said(key)?))) else {
        return Ok(());
    };
    let says = (&short.place, "said here");
    let mut sound = Ok(());
    if let Some(exposures) = root.get("exposures") {
        let what = format!("`{key}` says already when pictures are taken");
        let hint = format!("remove `exposures`; how many is said by `count` of `{key}`");
        sound = Err(reader.fault_and(&exposures.place, says, what, hint));
    }
    let Some(Content::Map(entries)) = root.get("observer").map(|node| &node.content) else { return sound };
    let taken = taken();
    for entry in entries.iter().filter(|entry| taken.contains(&entry.key.as_str())) {
        let what = format!("`{key}` says already where the observer is and how it moves");
        let hint = format!("remove `{}` here, or write all out in place of `{key}`", entry.key);
        sound = Err(reader.fault_and(&entry.key_place, says, what, hint));
    }
    sound
}

/// Writes out what a shorthand stands for.
pub(super) fn expand(manifest: &mut Manifest, root: &Node, reader: &mut Reader<'_>) -> Read<()> {
    let (place, view, up) = match manifest.shorthand.clone() {
        Shorthand::None => return Ok(()),
        Shorthand::Turntable(turntable) => {
            let middle = middle(manifest, &turntable.around, turntable.at);
            round(manifest, &turntable, &middle, reader)?;
            (turntable.place, turntable.around, turntable.axis)
        }
        Shorthand::Flyby(flyby) => {
            let middle = middle(manifest, &flyby.past, flyby.at);
            let up = past(manifest, &flyby, &middle, reader)?;
            (flyby.place, flyby.past, up)
        }
    };
    let written = |keys: &[&str]| {
        root.get("observer").is_some_and(|observer| keys.iter().any(|key| observer.get(key).is_some()))
    };
    if root.get("observer").is_none() {
        manifest.observer.place = place.clone();
    }
    manifest.exposures.place = place;
    let views: Vec<_> = View::fields().iter().map(|field| field.key).collect();
    if !written(&views) {
        manifest.observer.view = View::LookAt(view);
    }
    if !written(&["up"]) {
        manifest.observer.up = up;
    }
    Ok(())
}

/// What is gone around or past: where it is at a lab time, metres, and its velocity.
struct Middle {
    at: DVec3,
    velocity: Velocity,
}

fn middle(manifest: &Manifest, target: &LookAt, lab_time: f64) -> Middle {
    match target {
        LookAt::Point(at) => Middle { at: *at, velocity: Velocity::REST },
        LookAt::Body(body) => {
            let placement = &manifest.bodies[body.value].placement;
            let way = placement.velocity.beta() * (lab_time - placement.at_time);
            Middle { at: placement.at + way, velocity: placement.velocity }
        }
    }
}

/// A circle around the middle.
fn round(
    manifest: &mut Manifest,
    turntable: &Turntable,
    middle: &Middle,
    reader: &mut Reader<'_>,
) -> Read<()> {
    let &Turntable { radius, axis, start, turns, at, count, .. } = turntable;
    let above = axis * turntable.height;
    let place = turntable.place.clone();
    let Some(speed) = turntable.speed else {
        let ring = Ring { place, centre: middle.at + above, radius, axis, start, turns };
        manifest.observer.worldline = Worldline::Ring(ring);
        expose(&mut manifest.exposures, (at, at), count);
        return Ok(());
    };
    let period = std::f64::consts::TAU * radius * turns.abs() / speed.abs();
    if !(period > 0.0 && period <= 1e30) {
        let hint = "speed: 0.5 c, turns: 1; or without `speed`, a ring of observers at rest";
        return Err(reader.fault(&place, "the observer does not come round", hint));
    }
    let speed = speed * turns.signum();
    manifest.observer.worldline =
        Worldline::Orbit(Orbit { place, centre: above, radius, axis, speed, start });
    start_frame(&mut manifest.observer, middle.at, at, middle.velocity);
    // Written so that the times are those that a reader of the film would write.
    let last = period * f64::from(count - 1) / f64::from(count);
    expose(&mut manifest.exposures, (0.0, last), count);
    Ok(())
}

/// A way past the middle. What is up in the pictures comes of it.
fn past(manifest: &mut Manifest, flyby: &Flyby, middle: &Middle, reader: &mut Reader<'_>) -> Read<DVec3> {
    let &Flyby { distance, at, count, .. } = flyby;
    let reach = flyby.reach * distance;
    let moves = middle.velocity != Velocity::REST;
    let fault = |reader: &mut Reader<'_>, what: &str, hint: &str| Err(reader.fault(&flyby.place, what, hint));
    if !(reach > 0.0 && reach <= 1e30) {
        return fault(reader, "the way past goes nowhere", "reach: 4");
    }
    let way = match (flyby.speed, moves) {
        (Some(_), true) => {
            let what = "the body moves itself: either it goes past the observer, or the observer past it";
            return fault(reader, what, "remove `speed`, or the body's `velocity`");
        }
        (None, true) if flyby.along.is_some() => {
            let what = "the body goes its own way past the observer";
            return fault(reader, what, "remove `along`");
        }
        (None, false) => {
            return fault(reader, "neither the observer moves nor what it looks at", "speed: 0.9 c");
        }
        (None, true) => middle.velocity.beta().normalize(),
        (Some(_), false) => flyby.along.unwrap_or(DVec3::X),
    };
    let side = side(flyby.side, way).or_else(|Reported| {
        fault(
            reader,
            "`side` is along the way: nothing would be passed at a distance",
            "side: 0 1 0, or 1 0 0",
        )
    })?;
    let eye = middle.at + side * distance;
    match flyby.speed {
        Some(speed) => {
            let half = reach / speed.abs();
            if !(half > 0.0 && half <= 1e30) {
                return fault(reader, "the observer does not move", "speed: 0.9 c");
            }
            start_frame(&mut manifest.observer, eye, at, Velocity::from_proper(way * speed));
            expose(&mut manifest.exposures, (-half, half), count);
        }
        None => {
            start_frame(&mut manifest.observer, eye, at, Velocity::REST);
            let (half, late) = (reach / middle.velocity.beta().length(), distance.hypot(reach));
            expose(&mut manifest.exposures, (late - half, late + half), count);
        }
    }
    // Seen from straight above or below, the way goes up.
    Ok(if side.cross(DVec3::Y).length() > 1e-9 { DVec3::Y } else { way })
}

/// Across the way, on the side that is written.
fn side(written: Option<DVec3>, way: DVec3) -> Read<DVec3> {
    let across = |side: DVec3| side - way * side.dot(way);
    let side = match written {
        Some(side) => across(side),
        None if way.cross(DVec3::Z).length() < 1e-9 => across(DVec3::X),
        None => across(DVec3::Z),
    };
    if side.length() > 1e-9 { Ok(side.normalize()) } else { Err(Reported) }
}

fn start_frame(observer: &mut Observer, at: DVec3, at_time: f64, velocity: Velocity) {
    observer.placement.at = at;
    observer.placement.at_time = at_time;
    observer.placement.velocity = velocity;
}

/// Times by the observer's own clock; one picture is that of the middle.
fn expose(exposures: &mut Exposures, (from, to): (f64, f64), count: u32) {
    let only = if count == 1 && from < 0.0 { from.midpoint(to) } else { from };
    (exposures.from, exposures.to) = if count == 1 { (only, only) } else { (from, to) };
    exposures.count = count;
    exposures.clock = Clock::Own;
}
