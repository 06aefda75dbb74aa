//! What is infinitely far away, as written.

use super::Spanned;
use super::light::{Glow, GlowKind};
use super::motion::{Motion, Rotation};
use super::node::{Content, Node};
use super::plain::{Count, NotNegative, Placed, Real, ThereFile};
use super::quantity::{DiscAngle, Quantity, Temperature};
use super::reader::{Read, Reader};
use super::record::{Kind, List, Shape, record};
use super::units::Dimension;
use crate::error::Place;
use crate::spacetime::Velocity;
use glam::DQuat;
use std::path::PathBuf;

/// Most stars that are made.
const MOST_STARS: u32 = 1_000_000;
/// What white means in a picture, cd/m², unless it is said.
const WHITE: f64 = 100.0;

record! {
    /// What is seen behind everything, infinitely far away, at rest in a frame of its own: one of uniform, picture
    /// and stars, or several of them together.
    pub Surroundings, "surroundings" {
        /// Light that comes from all sides alike.
        uniform: Option<Glow> = GlowKind, optional, "{ black_body: 2.725 K }";
        /// A picture of all directions: longitude across (its middle towards -z, right of it +x), latitude down.
        picture: Option<SkyPicture> = SkyPictureKind, optional, "{ file: sky.exr, luminance: 100 cd/m2 }";
        /// Stars.
        stars: Option<Stars> = StarsKind, optional, "{ seed: 7, count: 5000 }";
        /// The velocity in the lab of the frame in which they are at rest.
        velocity: Velocity = Motion, default(Velocity::REST), "0 0 0.5 c";
        /// How they are turned in that frame, whose axes are the pure boost of the lab's.
        rotation: DQuat = Rotation, default(DQuat::IDENTITY), "30 deg about 0 1 0";
    }
}

/// Surroundings, or a list of them.
pub(crate) struct SurroundingsKind;

impl Kind for SurroundingsKind {
    type Value = Vec<Surroundings>;
    fn shape() -> Shape {
        Shape::Either(vec![Surroundings::shape(), List::<Surroundings>::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        if matches!(node.content, Content::List(_)) {
            return List::<One>::read(node, reader);
        }
        Ok(vec![One::read(node, reader)?])
    }
}

/// Surroundings that are not empty.
struct One;

impl Kind for One {
    type Value = Surroundings;
    fn shape() -> Shape {
        Surroundings::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Surroundings> {
        let read = <Surroundings as Kind>::read(node, reader)?;
        if read.uniform.is_some() || read.picture.is_some() || read.stars.is_some() {
            reader.rest.surroundings.push(read.clone());
            return Ok(read);
        }
        let what = "surroundings need uniform, picture or stars, or several of these";
        Err(reader.fault(&node.place, what, "stars: { seed: 7, count: 5000 }"))
    }
}

record! {
    /// A picture of all directions, equirectangular.
    pub SkyPicture, "a sky picture" {
        /// The file: `.exr`, `.hdr`, `.png` or `.jpg`.
        file: Spanned<PathBuf> = Placed<ThereFile>, required, "sky.exr";
        /// The luminance of its white (of 1 in an `.exr`), cd/m2: 100 cd/m2 unless said.
        luminance: f64 = WhiteLuminance, default(WHITE), "100 cd/m2";
    }
}

/// A picture of all directions: its path, or a map.
struct SkyPictureKind;

impl Kind for SkyPictureKind {
    type Value = SkyPicture;
    fn shape() -> Shape {
        Shape::Either(vec![ThereFile::shape(), SkyPicture::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<SkyPicture> {
        if matches!(node.content, Content::Map(_)) {
            return <SkyPicture as Kind>::read(node, reader);
        }
        let file = Placed::<ThereFile>::read(node, reader)?;
        Ok(SkyPicture { place: node.place.clone(), file, luminance: WHITE })
    }
}

/// What white means, cd/m².
struct WhiteLuminance;

impl Kind for WhiteLuminance {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Text("a luminance with its unit, in cd/m2")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        const QUANTITY: Quantity =
            Quantity { what: "a luminance", count: 1, dimensions: &[Dimension::Luminance], unit: "cd/m2" };
        let luminance = reader.quantity(node, &QUANTITY)?.0.first().copied().unwrap_or_default();
        if (0.0..=1e30).contains(&luminance) {
            return Ok(luminance);
        }
        let hint = reader.typed("100 cd/m2 (zero or more)");
        Err(reader.fault(&node.place, "white cannot be darker than dark", hint))
    }
}

record! {
    /// Stars: made up from a number, or those of a catalogue.
    StarsKeys, "the stars" {
        /// Whichever number it is, others make other stars: 1 unless said.
        seed: Option<Spanned<u32>> = Placed<Count<0, { u32::MAX }>>, optional, "7";
        /// How many.
        count: Option<Spanned<u32>> = Placed<Count<1, MOST_STARS>>, optional, "5000";
        /// The magnitude of the faintest: 6.5 unless said.
        faintest: Option<Spanned<f64>> = Placed<Magnitude>, optional, "6.5";
        /// The temperature of all of them; as it is among the stars unless said.
        temperature: Option<Spanned<f64>> = Placed<Temperature>, optional, "5800 K";
        /// The magnitude of all of them; as many of each as there are among the stars unless said.
        magnitude: Option<Spanned<f64>> = Placed<Magnitude>, optional, "2";
        /// The angular radius of all of them, who are then discs as bright as black bodies of their temperatures; points unless
        /// said.
        radius: Option<Spanned<f64>> = Placed<DiscAngle>, optional, "0.6 deg";
        /// A CSV file of stars, instead of all of these.
        catalogue: Option<Spanned<PathBuf>> = Placed<ThereFile>, optional, "stars.csv";
        /// Multiplies the brightness of all: 1 unless said.
        brightness: f64 = NotNegative, default(1.0), "10";
    }
}

/// Stars.
#[derive(Debug, Clone)]
pub struct Stars {
    /// Where they are written.
    pub place: Place,
    /// Where they come from.
    pub origin: StarOrigin,
    /// Multiplies their brightness.
    pub brightness: f64,
    /// Their angular radius, radians, if they are discs as bright as black bodies.
    pub radius: Option<f64>,
}

/// Where stars come from.
#[derive(Debug, Clone)]
pub enum StarOrigin {
    /// They are made up.
    Seeded {
        /// Others make other stars.
        seed: u32,
        /// How many.
        count: u32,
        /// The magnitude of the faintest.
        faintest: f64,
        /// The temperature of all of them, kelvin; as it is among the stars if none.
        temperature: Option<f64>,
        /// The magnitude of all of them; as it is among the stars if none.
        magnitude: Option<f64>,
    },
    /// They are in a CSV file.
    Catalogue(Spanned<PathBuf>),
}

/// Stars, checked.
struct StarsKind;

impl Kind for StarsKind {
    type Value = Stars;
    fn shape() -> Shape {
        StarsKeys::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Stars> {
        let keys = StarsKeys::read(node, reader)?;
        let origin = match &keys.catalogue {
            Some(catalogue) => StarOrigin::Catalogue(only(catalogue, node, reader)?),
            None => seeded(&keys, reader)?,
        };
        let radius = keys.radius.map(|radius| radius.value);
        Ok(Stars { place: keys.place, origin, brightness: keys.brightness, radius })
    }
}

/// A catalogue beside which nothing is said of made-up stars.
fn only(catalogue: &Spanned<PathBuf>, node: &Node, reader: &mut Reader<'_>) -> Read<Spanned<PathBuf>> {
    let others = ["seed", "count", "faintest", "temperature", "magnitude", "radius"];
    for key in others {
        if let Some(value) = node.get(key) {
            let what = format!("the stars of a catalogue have no `{key}`: it says what each of them is like");
            let hint = format!("remove `{key}`, or `catalogue`");
            return Err(reader.fault(&value.place, what, hint));
        }
    }
    Ok(catalogue.clone())
}

fn seeded(keys: &StarsKeys, reader: &mut Reader<'_>) -> Read<StarOrigin> {
    let Some(count) = &keys.count else {
        return Err(reader.fault(&keys.place, "the stars need `count` or `catalogue`", "count: 5000"));
    };
    if let (Some(faintest), Some(_)) = (&keys.faintest, &keys.magnitude) {
        let what = "stars that are all of one `magnitude` have no `faintest`";
        return Err(reader.fault(&faintest.place, what, "remove `faintest`, or `magnitude`"));
    }
    if let (Some(magnitude), Some(_)) = (keys.faintest.as_ref().or(keys.magnitude.as_ref()), &keys.radius) {
        let what = "stars that are discs are as bright as their temperatures make them";
        return Err(reader.fault(
            &magnitude.place,
            what,
            "remove it, or `radius`; `brightness` makes all of them brighter",
        ));
    }
    Ok(StarOrigin::Seeded {
        seed: keys.seed.as_ref().map_or(1, |seed| seed.value),
        count: count.value,
        faintest: keys.faintest.as_ref().map_or(6.5, |faintest| faintest.value),
        temperature: keys.temperature.as_ref().map(|temperature| temperature.value),
        magnitude: keys.magnitude.as_ref().map(|magnitude| magnitude.value),
    })
}

/// The magnitude of a star.
struct Magnitude;

impl Kind for Magnitude {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a magnitude, smaller for brighter, from -30 to 30")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let magnitude = Real::read(node, reader)?;
        if magnitude.abs() <= 30.0 {
            return Ok(magnitude);
        }
        let hint = reader.typed("6.5 (from -30 to 30)");
        Err(reader.fault(&node.place, format!("`{magnitude}` is out of range"), hint))
    }
}
