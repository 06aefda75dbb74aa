//! What pictures are like.

use super::Spanned;
use super::light::{Amount, Luminance};
use super::node::Node;
use super::plain::{Count, Placed, Real, Switch, whole, words};
use super::quantity::Written;
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, record};
use crate::error::Place;

/// Most pixels of a picture.
const MOST_PIXELS: u64 = 1 << 28;
/// The size unless it is said.
pub(crate) const USUAL_SIZE: &str = "1280 720";
/// Greatest width and height.
const LONGEST_SIDE: u32 = 65_536;
words! {
    /// How much of its surroundings a pixel shows.
    Filter, "a filter" {
        /// A bell three pixels wide: smooth edges.
        "gaussian" => Gaussian;
        /// A tent of two pixels' width.
        "tent" => Tent;
        /// The pixel's square and nothing else.
        "box" => Box;
    }
}

/// What is shown as white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum White {
    /// What is bright in the film, found by measuring it.
    Auto,
    /// This luminance of the scene: cd/m² or W/m²/sr.
    Luminance(Amount),
}

impl Kind for White {
    type Value = Self;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Words(&["auto"]), Luminance::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self> {
        if node.text() == Some("auto") {
            return Ok(Self::Auto);
        }
        match Luminance::read(node, reader)? {
            Amount::Photometric(x) | Amount::Radiometric(x) if x <= 0.0 => {
                let hint = reader.typed("250 cd/m2, or auto");
                Err(reader.fault(&node.place, "white cannot be darkness", hint))
            }
            amount => Ok(Self::Luminance(amount)),
        }
    }
}

/// The number of wavelengths that are traced.
struct Wavelengths;

impl Kind for Wavelengths {
    type Value = u32;
    fn shape() -> Shape {
        Shape::Words(&["8", "16", "32", "64"])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<u32> {
        let number = Real::read(node, reader)?;
        whole(number, 8, 64).filter(|count| count.is_power_of_two()).ok_or_else(|| {
            let hint = reader.typed("16 (one of 8, 16, 32, 64)");
            reader.fault(&node.place, format!("`{number}` is not a number of wavelengths"), hint)
        })
    }
}

/// Width and height in pixels.
struct Size;

impl Kind for Size {
    type Value = (u32, u32);
    fn shape() -> Shape {
        Shape::Text("width and height in pixels, as in 1280 720")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<(u32, u32)> {
        let text = reader.text(node, "a size", USUAL_SIZE)?;
        if let Some((width, height)) = text.split_once(['x', '×'])
            && !Written::of(width).numbers.is_empty()
        {
            let hint = reader.typed(&format!("{} {}", width.trim(), height.trim()));
            return Err(reader.fault(&node.place, "width and height are separated by a blank", hint));
        }
        let numbers = reader.bare(node, "a size", 2)?;
        let sides: Option<Vec<u32>> = numbers.iter().map(|side| whole(*side, 1, LONGEST_SIDE)).collect();
        let hint = reader.typed(USUAL_SIZE);
        match sides.as_deref() {
            Some(&[width, height]) if u64::from(width) * u64::from(height) <= MOST_PIXELS => {
                Ok((width, height))
            }
            Some(_) => Err(reader.fault(&node.place, "more than 2^28 pixels", hint)),
            None => {
                let what = format!("width and height are whole numbers from 1 to {LONGEST_SIDE}");
                Err(reader.fault(&node.place, what, hint))
            }
        }
    }
}

/// Factors of two of brightness.
struct Stops;

impl Kind for Stops {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("factors of two, from -64 to 64")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let stops = Real::read(node, reader)?;
        if stops.abs() <= 64.0 {
            return Ok(stops);
        }
        let hint = reader.typed("2 (from -64 to 64)");
        Err(reader.fault(&node.place, format!("{stops} stops are out of range"), hint))
    }
}

/// Factors of two above white, or none if they are to be measured.
struct Headroom;

impl Kind for Headroom {
    type Value = Option<f64>;
    fn shape() -> Shape {
        Shape::Either(vec![Shape::Words(&["auto"]), Shape::Number("factors of two, from 0 to 64")])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Option<f64>> {
        if node.text() == Some("auto") {
            return Ok(None);
        }
        let headroom = Real::read(node, reader)?;
        if (0.0..=64.0).contains(&headroom) {
            return Ok(Some(headroom));
        }
        let hint = reader.typed("4 (from 0 to 64), or auto");
        Err(reader.fault(&node.place, format!("a headroom of {headroom} is out of range"), hint))
    }
}

/// A difference of colours in CIEDE2000.
struct Tolerance;

impl Kind for Tolerance {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a difference in CIEDE2000, from 0.2 to 20")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let difference = Real::read(node, reader)?;
        if (0.2..=20.0).contains(&difference) {
            return Ok(difference);
        }
        let hint = reader.typed("1 (from 0.2 to 20; about 1 is just noticeable)");
        Err(reader.fault(&node.place, format!("`{difference}` is not a tolerance"), hint))
    }
}

/// A small part of the light.
struct Faintest;

impl Kind for Faintest {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("a part of the light, from 0.000001 to 0.1")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let part = Real::read(node, reader)?;
        if (1e-6..=0.1).contains(&part) {
            return Ok(part);
        }
        let hint = reader.typed("0.001 (from 0.000001 to 0.1)");
        Err(reader.fault(&node.place, format!("`{part}` is out of range"), hint))
    }
}

record! {
    /// What each picture is like.
    pub Picture, "the picture" {
        /// Width and height in pixels: 1280 720 unless said.
        size: Spanned<(u32, u32)> = Placed<Size>, default(Spanned { value: (1280, 720), place: Place::Command }), "1280 720";
        /// Sight rays for each pixel: 4 unless said; 1 is the pixel's centre.
        samples: u32 = Count<1, 65_536>, default(4), "16";
        /// How often light is followed, from mirror to mirror and through glass: 8 unless said.
        depth: u32 = Count<0, 64>, default(8), "4";
        /// Light of which less than this part would reach the observer is not followed by itself: 0.001 unless said, at least
        /// 0.000001, at most 0.1. The smaller, the more of the images within glass are seen, and the longer it takes.
        faintest: f64 = Faintest, default(1e-3), "0.0001";
        /// How many wavelengths are traced: 8, 16 (unless said), 32 or 64.
        wavelengths: u32 = Wavelengths, default(16), "32";
        /// Asks for accuracy instead: 99 of 100 pixels are to be within this of the converged picture, in CIEDE2000 (about 1 is
        /// just noticeable). Each gets the samples (neighbours share them) and wavelengths that it needs, whatever `samples` and
        /// `wavelengths` say.
        tolerance: Option<f64> = Tolerance, optional, "1";
        /// How samples are weighed: `gaussian` (unless said), `tent` or `box`.
        filter: Filter = Filter, default(Filter::Gaussian), "tent";
        /// The luminance that is shown as white, or `auto` (unless said): from the brightness of the whole film.
        white: White = White, default(White::Auto), "250 cd/m2";
        /// Brighter (above zero) or darker, in factors of two.
        stops: f64 = Stops, default(0.0), "-1";
        /// How far above white light is still told apart, in factors of two: the more, the flatter the picture. 0 cuts off at white;
        /// `auto` (unless said) goes by what is brightest in the whole film.
        headroom: Option<f64> = Headroom, default(None), "8";
    }
}

impl Picture {
    /// Where its size is said, or would be.
    pub fn size_place(&self) -> &Place {
        if self.size.place == Place::Command { &self.place } else { &self.size.place }
    }
}

record! {
    /// What is shown of relativity, for teaching: off means as if that factor were one.
    pub Effects, "the effects" {
        /// That directions of light change with the observer's motion.
        aberration: bool = Switch, default(true), "off";
        /// That its colours shift.
        doppler: bool = Switch, default(true), "off";
        /// That its brightness changes.
        searchlight: bool = Switch, default(true), "off";
    }
}
