//! When pictures are taken, what they are like, and where they go.

use super::Spanned;
use super::light::{Amount, Luminance};
use super::node::{Content, Node};
use super::plain::{Count, FilePath, Placed, Real, Switch, Text, whole, words};
use super::quantity::{Instant, Written};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, record};
use crate::error::Place;
use std::path::{Path, PathBuf};

/// Most pixels of a picture.
const MOST_PIXELS: u64 = 1 << 28;
/// Greatest width and height.
const LONGEST_SIDE: u32 = 65_536;
/// Most exposures.
pub(super) const MOST_EXPOSURES: u32 = 1_000_000;

words! {
    /// The clock by which exposures are timed.
    Clock, "a clock" {
        /// The observer's own.
        "own" => Own;
        /// That of the lab.
        "lab" => Lab;
    }
}

record! {
    /// When pictures are taken: `count` of them from `from` to `to`, both included, or one `at` a time.
    ExposuresKeys, "the exposures" {
        /// The first.
        from: Option<f64> = Instant, optional, "-4 s";
        /// The last.
        to: Option<Spanned<f64>> = Placed<Instant>, optional, "9 s";
        /// The only one (or that of a ring of observers).
        at: Option<Spanned<f64>> = Placed<Instant>, optional, "2 s";
        /// How many.
        count: Option<u32> = Count<1, MOST_EXPOSURES>, optional, "96";
        /// By whose clock: `own` (the observer's proper time) unless said.
        clock: Clock = Clock, default(Clock::Own), "lab";
    }
}

/// When pictures are taken. Metres of light travel.
#[derive(Debug, Clone)]
pub struct Exposures {
    /// Where it is written.
    pub place: Place,
    /// The first; with a `count` of 1 the only one.
    pub from: f64,
    /// The last.
    pub to: f64,
    /// How many, evenly spaced.
    pub count: u32,
    /// By whose clock.
    pub clock: Clock,
}

/// Exposures, checked.
pub(crate) struct ExposuresKind;

impl Kind for ExposuresKind {
    type Value = Exposures;
    fn shape() -> Shape {
        ExposuresKeys::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Exposures> {
        let keys = ExposuresKeys::read(node, reader)?;
        let (from, to) = span(&keys, reader)?;
        let Some(to) = to else {
            let count = keys.count.unwrap_or(1);
            if count == 1 || reader.ring {
                return Ok(Exposures { place: keys.place, from, to: from, count, clock: keys.clock });
            }
            let what = format!("{count} exposures need a time from which and one to which");
            return Err(reader.fault(&keys.place, what, "from: 0 s, to: 4 s"));
        };
        let Some(count) = keys.count else {
            return Err(reader.fault(&keys.place, "how many exposures?", "count: 96"));
        };
        let instant_ring = reader.ring && to.value >= from;
        if count > 1 && to.value <= from && !instant_ring {
            let text = |key: &str| node.get(key).and_then(|node| node.text()).unwrap_or("0 s").to_owned();
            let hint = format!("from: {}, to: {}", text("to"), text("from"));
            return Err(reader.fault(&to.place, "`to` is not later than `from`", hint));
        }
        Ok(Exposures { place: keys.place, from, to: to.value, count, clock: keys.clock })
    }
}

/// The first time, and the last if it is written.
fn span(keys: &ExposuresKeys, reader: &mut Reader<'_>) -> Read<(f64, Option<Spanned<f64>>)> {
    match (&keys.from, &keys.to, &keys.at) {
        (None, None, at) => Ok((at.as_ref().map_or(0.0, |at| at.value), None)),
        (Some(_), _, Some(at)) | (None, Some(_), Some(at)) => {
            let what = "exposures are either `at` a time or `from` one `to` another";
            Err(reader.fault(&at.place, what, "remove `at`, or `from` and `to`"))
        }
        (None, Some(to), None) => {
            Err(reader.fault(&to.place, "exposures have a `to` but no `from`", "from: 0 s"))
        }
        (Some(from), to, None) => Ok((*from, to.clone())),
    }
}

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
        let text = reader.text(node, "a size", "1280 720")?;
        if let Some((width, height)) = text.split_once(['x', '×'])
            && !Written::of(width).numbers.is_empty()
        {
            let hint = reader.typed(&format!("{} {}", width.trim(), height.trim()));
            return Err(reader.fault(&node.place, "width and height are separated by a blank", hint));
        }
        let numbers = reader.bare(node, "a size", 2)?;
        let sides: Option<Vec<u32>> = numbers.iter().map(|side| whole(*side, 1, LONGEST_SIDE)).collect();
        let hint = reader.typed("1280 720");
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

/// A small part of the light.
struct Faintest;

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
        size: (u32, u32) = Size, default((1280, 720)), "1280 720";
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
        /// just noticeable). Each gets the samples and wavelengths that it needs, whatever `samples` and `wavelengths` say.
        tolerance: Option<f64> = Tolerance, optional, "1";
        /// How samples are weighed: `gaussian` (unless said), `tent` or `box`.
        filter: Filter = Filter, default(Filter::Gaussian), "tent";
        /// The luminance that is shown as white, or `auto` (unless said): from the brightness of the whole film.
        white: White = White, default(White::Auto), "250 cd/m2";
        /// Brighter (above zero) or darker, in factors of two.
        stops: f64 = Stops, default(0.0), "-1";
    }
}

/// Pictures in a second of the film.
struct Rate;

impl Kind for Rate {
    type Value = f64;
    fn shape() -> Shape {
        Shape::Number("pictures in a second")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        let rate = Real::read(node, reader)?;
        if (0.1..=1000.0).contains(&rate) {
            return Ok(rate);
        }
        let hint = reader.typed("24 (from 0.1 to 1000)");
        Err(reader.fault(&node.place, format!("a film cannot run at {rate} pictures a second"), hint))
    }
}

/// The name of a file, without folders.
struct FileName;

impl Kind for FileName {
    type Value = String;
    fn shape() -> Shape {
        Shape::Text("the name of a file, without folders")
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<String> {
        let name = Text::read(node, reader)?;
        let plain = !name.contains(['/', '\\', ':', '\0']) && !name.starts_with('.');
        let is_film = Path::new(&name).extension().is_some_and(|extension| extension == "mp4");
        if plain && is_film {
            return Ok(name);
        }
        if plain {
            let hint = reader.typed(&format!("{}.mp4", name.split('.').next().unwrap_or("film")));
            return Err(reader.fault(&node.place, format!("a film is an MP4 file; `{name}` is not"), hint));
        }
        let hint = format!("{}; `output` is where the folder is named", reader.typed("flyby.mp4"));
        Err(reader.fault(&node.place, format!("`{name}` is not the name of a file"), hint))
    }
}

record! {
    /// The film that is made of the exposures.
    pub Film, "the film" {
        /// Pictures in a second.
        rate: f64 = Rate, default(24.0), "24";
        /// Its file in the output folder.
        file: Option<String> = FileName, optional, "flyby.mp4";
        /// Whether a video is made, beside the pictures.
        video: bool = Switch, default(true), "off";
    }
}

impl Film {
    /// The film that is made if nothing is said about it.
    pub(crate) fn usual() -> Self {
        Self { place: Place::Command, rate: 24.0, file: None, video: true }
    }
}

record! {
    /// Where everything goes that is written.
    pub Output, "the output" {
        /// The folder.
        folder: PathBuf = FilePath, required, "../out/flyby";
        /// Whether pictures are written as OpenEXR too: `R G B` and `cie.X cie.Y cie.Z` in cd/m2, `doppler` (seen over emitted), `emission_time` (lab, s), `body` (its number from 0; -1 for none, where the other two are 0).
        exr: bool = Switch, default(false), "on";
    }
}

/// The output: a folder, or a map.
pub(crate) struct OutputKind;

impl Kind for OutputKind {
    type Value = Output;
    fn shape() -> Shape {
        Shape::Either(vec![FilePath::shape(), Output::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Output> {
        if matches!(node.content, Content::Map(_)) {
            return <Output as Kind>::read(node, reader);
        }
        Ok(Output { place: node.place.clone(), folder: FilePath::read(node, reader)?, exr: false })
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
