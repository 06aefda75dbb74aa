//! Shapes that are described in the manifest itself.

use super::motion::Rotation;
use super::node::{Content, Node};
use super::quantity::{Length, Point, Written};
use super::reader::{Read, Reader};
use super::record::{Kind, List, Record, Shape, choice, record};
use glam::{DQuat, DVec3};

/// Most shapes that one is made of, itself included.
const MOST_SHAPES: usize = 1000;
/// Most shapes within one another.
const DEEPEST: usize = 16;

record! {
    /// Where a shape is within what it is a part of: an asset, or another shape.
    pub Pose, "a shape" {
        /// Where its origin is, metres.
        at: DVec3 = Point, default(DVec3::ZERO), "0 1 0 m";
        /// How it is turned about its origin.
        rotation: DQuat = Rotation, default(DQuat::IDENTITY), "30 deg about 0 1 0";
    }
}

record! {
    /// A shape. Its material is white (diffuse, 0.8) unless the body says another.
    pub Solid, "a shape" {
        @include form: SolidForm, "What it is.";
        @include pose: Pose, "Where it is in what it is a part of.";
    }
}

choice! {
    /// What a shape is.
    pub SolidForm, "a shape" {
        /// A ball about its origin.
        sphere => Sphere(Sphere) = Sphere, "{ radius: 1 m }";
        /// A box about its origin.
        r#box => Box(Cuboid) = Cuboid, "{ size: 2 m }";
        /// A closed cylinder about its origin, along y.
        cylinder => Cylinder(Cylinder) = Cylinder, "{ radius: 1 m, height: 2 m }";
        /// A closed cone about its origin, its point towards +y.
        cone => Cone(Cone) = Cone, "{ radius: 1 m, height: 2 m }";
        /// All that is below y = 0, without end.
        plane => Plane(Plane) = Plane, "{}";
        /// What is in any of these.
        union => Union(Vec<Solid>) = Parts<1>, "[{ sphere: { radius: 1 m } }, { box: { size: 2 m }, at: 0 1 0 m }]";
        /// What is in all of these.
        intersection => Intersection(Vec<Solid>) = Parts<1>, "[{ sphere: { radius: 1 m } }, { box: { size: 1.5 m } }]";
        /// The first without the others.
        difference => Difference(Vec<Solid>) = Parts<2>, "[{ box: { size: 2 m } }, { sphere: { radius: 1.2 m } }]";
    }
}

record! {
    /// A ball.
    pub Sphere, "a sphere" {
        /// Metres.
        radius: f64 = Length, required, "1 m";
    }
}

record! {
    /// A box.
    pub Cuboid, "a box" {
        /// Its whole sides along x, y and z, metres; one number for a cube.
        size: DVec3 = Extent, required, "2 1 3 m";
    }
}

record! {
    /// A cylinder along y.
    pub Cylinder, "a cylinder" {
        /// Metres.
        radius: f64 = Length, required, "1 m";
        /// From end to end, metres.
        height: f64 = Length, required, "2 m";
    }
}

record! {
    /// A cone along y.
    pub Cone, "a cone" {
        /// Of its foot, at y = -height/2, metres.
        radius: f64 = Length, required, "1 m";
        /// From its foot to its point, metres.
        height: f64 = Length, required, "2 m";
    }
}

/// All that is below y = 0. There is nothing to say about it: `plane: {}`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plane;

impl Kind for Plane {
    type Value = Self;
    const MAY_BE_EMPTY: bool = true;
    fn shape() -> Shape {
        Shape::Text("nothing, or {}")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        match &node.content {
            Content::Map(entries) if entries.is_empty() => Ok(Self),
            _ if node.is_nothing() => Ok(Self),
            _ => {
                let what = "nothing is said of a plane: it is y = 0, turned and moved by keys beside it";
                Err(reader.fault(&node.place, what, "plane: {}, at: 0 1 0 m, rotation: 30 deg about 1 0 0"))
            }
        }
    }
}

/// Three lengths above zero, or one for all three.
pub(super) struct Extent;

impl Kind for Extent {
    type Value = DVec3;
    fn shape() -> Shape {
        Shape::Text("a length, or three and a unit, as in 2 1 3 m")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DVec3> {
        if node.text().is_some_and(|text| Written::of(text).numbers.len() == 1) {
            return Length::read(node, reader).map(DVec3::splat);
        }
        let size = Point::read(node, reader)?;
        if size.min_element() > 0.0 {
            return Ok(size);
        }
        let hint = reader.typed("2 1 3 m (each above zero)");
        Err(reader.fault(&node.place, "every side of a box is longer than zero", hint))
    }
}

/// The parts of a shape, at least so many.
struct Parts<const LEAST: usize>;

impl<const LEAST: usize> Kind for Parts<LEAST> {
    type Value = Vec<Solid>;
    fn shape() -> Shape {
        List::<Any>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Vec<Solid>> {
        let parts = List::<Any>::read(node, reader)?;
        if parts.len() >= LEAST {
            return Ok(parts);
        }
        let what = match LEAST {
            1 => "here are no shapes to put together",
            _ => "a difference is a shape and what is cut out of it: two shapes or more",
        };
        let hint = reader.typed("[{ box: { size: 2 m } }, { sphere: { radius: 1.2 m } }]");
        Err(reader.fault(&node.place, what, hint))
    }
}

/// A shape: a map, or the word `plane`.
struct Any;

impl Kind for Any {
    type Value = Solid;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Words(&["plane"]), Solid::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Solid> {
        match alone(node, reader)? {
            Some(plane) => Ok(plane),
            None => <Solid as Kind>::read(node, reader),
        }
    }
}

/// The shape that a word alone stands for; a fault for those that need more than a word.
pub(super) fn alone(node: &Node, reader: &mut Reader<'_>) -> Read<Option<Solid>> {
    let Some(word) = node.text() else { return Ok(None) };
    let place = || node.place.clone();
    if word == "plane" {
        let form = SolidForm::Plane(Plane);
        let pose = Pose { place: place(), at: DVec3::ZERO, rotation: DQuat::IDENTITY };
        return Ok(Some(Solid { place: place(), form, pose }));
    }
    let fields = <SolidForm as Record>::fields();
    let Some(field) = fields.iter().find(|field| field.key == word) else { return Ok(None) };
    let what = format!("`{word}` alone does not say which");
    Err(reader.fault(&node.place, what, format!("{{ {word}: {} }}", field.example)))
}

/// Whether an asset is meant to be a shape.
pub(super) fn is_solid(asset: &Node) -> bool {
    match &asset.content {
        Content::Map(entries) => {
            let fields = <SolidForm as Record>::fields();
            entries.iter().any(|entry| fields.iter().any(|field| field.key == entry.key))
        }
        _ => asset.text() == Some("plane"),
    }
}

/// A shape that is not made of too many.
pub(super) fn checked(solid: Solid, reader: &mut Reader<'_>) -> Read<Solid> {
    let (count, depth) = measure(&solid);
    if count > MOST_SHAPES {
        let what = format!("a shape made of {count} shapes; {MOST_SHAPES} are the most");
        return Err(reader.fault(&solid.place, what, "make several bodies of it, or a model file"));
    }
    if depth > DEEPEST {
        let what = format!("shapes within one another {depth} deep; {DEEPEST} are the most");
        return Err(reader.fault(&solid.place, what, "put the parts of a union of unions into one list"));
    }
    Ok(solid)
}

/// How many shapes there are in one, and how deep: each 1 for one alone.
fn measure(solid: &Solid) -> (usize, usize) {
    use SolidForm::{Difference, Intersection, Union};
    let (Union(parts) | Intersection(parts) | Difference(parts)) = &solid.form else { return (1, 1) };
    parts
        .iter()
        .map(measure)
        .fold((1, 2), |(count, depth), (more, below)| (count + more, depth.max(below + 1)))
}
