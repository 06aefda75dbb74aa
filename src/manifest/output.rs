//! Where pictures and films go, and as what.

use super::Spanned;
use super::node::{Content, Node};
use super::plain::{FilePath, Placed, Real, Switch, Text, whole, words};
use super::reader::{Read, Reader};
use super::record::{Kind, List, Shape, record};
use crate::error::Place;
use crate::output::FilmKind;
use std::path::PathBuf;

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
        if plain && FilmKind::of(&name).is_some() {
            return Ok(name);
        }
        if plain {
            let hint = reader.typed(&format!("{}.mp4", name.split('.').next().unwrap_or("film")));
            let what = format!("a film is an MP4, GIF or AVI file; `{name}` is none");
            return Err(reader.fault(&node.place, what, hint));
        }
        let hint = format!("{}; `output` is where the folder is named", reader.typed("flyby.mp4"));
        Err(reader.fault(&node.place, format!("`{name}` is not the name of a file"), hint))
    }
}

/// Names of films, one or several.
struct FileNames;

impl Kind for FileNames {
    type Value = Vec<String>;
    fn shape() -> Shape {
        Shape::Either(vec![FileName::shape(), Shape::List(FileName::shape)])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Vec<String>> {
        let Content::List(items) = &node.content else { return Ok(vec![FileName::read(node, reader)?]) };
        let names = List::<FileName>::read(node, reader)?;
        if names.is_empty() {
            let hint = reader.typed("[flyby.mp4, flyby.gif]");
            return Err(reader.fault(&node.place, "a film without a file", hint));
        }
        match (1..names.len()).find(|later| names[..*later].contains(&names[*later])) {
            None => Ok(names),
            Some(later) => {
                let what = format!("`{}` is there twice", names[later]);
                Err(reader.fault(&items[later].place, what, "each film needs a name of its own"))
            }
        }
    }
}

const USUAL_RATE: Spanned<f64> = Spanned { value: 24.0, place: Place::Command };

record! {
    /// The film that is made of the exposures.
    pub Film, "the film" {
        /// Pictures in a second.
        rate: Spanned<f64> = Placed<Rate>, default(USUAL_RATE), "24";
        /// Its file in the output folder, or several: MP4, GIF or AVI by their endings.
        file: Vec<String> = FileNames, default(Vec::new()), "[flyby.mp4, flyby.gif]";
        /// Whether a video is made, beside the pictures.
        video: bool = Switch, default(true), "off";
    }
}

impl Film {
    /// The film that is made if nothing is said about it.
    pub(crate) fn usual() -> Self {
        Self { place: Place::Command, rate: USUAL_RATE, file: Vec::new(), video: true }
    }
}

words! {
    /// How finely the light in OpenEXR files is stored.
    Depth, "a depth" {
        /// In 16 bits (11 of them digits), as parts of the film's white.
        "half" => Half;
        /// In 32 bits, in cd/m².
        "float" => Float;
    }
}

words! {
    /// What an OpenEXR file can hold of each pixel.
    Layer, "a layer" {
        /// Linear light in the primaries of sRGB.
        "radiance" => Radiance;
        /// CIE 1931 X, Y, Z.
        "xyz" => Xyz;
        /// Frequency seen over frequency emitted.
        "doppler" => Doppler;
        /// When the light left, lab time in seconds.
        "emission_time" => EmissionTime;
        /// How far away what is seen appears, metres.
        "distance" => Distance;
        /// The normal of what is seen as it appears, in the camera's axes.
        "normal" => Normal;
        /// The number of the body.
        "body" => Body;
        /// The number of its material.
        "material" => Material;
        /// The colour of its surface by daylight at rest.
        "albedo" => Albedo;
        /// The spectral radiance.
        "spectrum" => Spectrum;
    }
}

impl Layer {
    /// All that are written unless said otherwise.
    const USUAL: [Self; 9] = [
        Self::Radiance,
        Self::Xyz,
        Self::Doppler,
        Self::EmissionTime,
        Self::Distance,
        Self::Normal,
        Self::Body,
        Self::Material,
        Self::Albedo,
    ];
}

/// A list of layers, at least one.
struct Layers;

impl Kind for Layers {
    type Value = Vec<Layer>;
    fn shape() -> Shape {
        List::<Layer>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Vec<Layer>> {
        let layers = List::<Layer>::read(node, reader)?;
        if layers.is_empty() {
            let hint = reader.typed("[radiance, doppler]");
            return Err(reader.fault(&node.place, "a file without layers holds nothing", hint));
        }
        Ok(layers)
    }
}

record! {
    /// What is written into OpenEXR files.
    pub Exr, "the OpenEXR files" {
        /// `float` (unless said): light in 32 bits, in cd/m2. `half`: `R G B`, `cie.X cie.Y cie.Z`, normals and albedo in 16 bits,
        /// light as parts of the film's white (which the attribute `whiteLuminance` tells); the rest stays as it is.
        depth: Depth = Depth, default(Depth::Float), "half";
        /// Which layers: `radiance` (`R G B`), `xyz` (`cie.X cie.Y cie.Z`), `doppler` (frequency seen over frequency emitted),
        /// `emission_time` (lab, s), `distance` (m, as the observer sees it), `normal` (`normal.X normal.Y normal.Z`, of what is
        /// seen as it appears, in the camera's axes: right, up, backward), `body` (its number from 0), `material` (a number for
        /// each body's material), `albedo` (`albedo.R albedo.G albedo.B`, at rest in daylight), `spectrum` (`S0.409,375nm` and so on: as many parts of
        /// 400 to 700 nm as `wavelengths`, W/m2/sr/nm, by the layout of Fichet, Pacanowski and Wilkie, JCGT 10(3)). Where no body is, `body` and
        /// `material` are -1 and the others 0. Unless said, all but `spectrum`.
        layers: Vec<Layer> = Layers, default(Layer::USUAL.to_vec()), "[radiance, doppler, distance]";
    }
}

/// OpenEXR files: `on`, `off`, or a map.
struct ExrKind;

impl Kind for ExrKind {
    type Value = Option<Exr>;
    fn shape() -> Shape {
        Shape::Either(vec![Switch::shape(), Exr::shape()])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Option<Exr>> {
        if matches!(node.content, Content::Map(_)) {
            return <Exr as Kind>::read(node, reader).map(Some);
        }
        let usual = Exr { place: node.place.clone(), depth: Depth::Float, layers: Layer::USUAL.to_vec() };
        Ok(Switch::read(node, reader)?.then_some(usual))
    }
}

/// Bits of each channel in PNG.
struct Bits;

impl Kind for Bits {
    type Value = u32;
    fn shape() -> Shape {
        Shape::Words(&["8", "16"])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<u32> {
        let number = Real::read(node, reader)?;
        whole(number, 8, 16).filter(|bits| [8, 16].contains(bits)).ok_or_else(|| {
            let hint = reader.typed(if number > 8.0 { "16 (or 8)" } else { "8 (or 16)" });
            reader.fault(&node.place, format!("a PNG has 8 or 16 bits a channel, not {number}"), hint)
        })
    }
}

record! {
    /// Where everything goes that is written.
    pub Output, "the output" {
        /// The folder.
        folder: PathBuf = FilePath, required, "../out/flyby";
        /// Bits of each channel in the PNG pictures: 8 (unless said) or 16.
        png: u32 = Bits, default(8), "16";
        /// Whether pictures are written as BMP too (8 bits).
        bmp: bool = Switch, default(false), "on";
        /// Whether pictures are written as OpenEXR too, and what of them: `on` for all layers but `spectrum` in 32 bits, or a map.
        exr: Option<Exr> = ExrKind, default(None), "{ depth: half, layers: [radiance, doppler] }";
        /// Whether pictures of the Doppler factor are written: frequency seen over frequency sent as a colour, with a legend. The
        /// colours mean the same in all pictures of a film.
        doppler: bool = Switch, default(false), "on";
        /// Whether pictures of when the light was sent are written (lab time in seconds), in the same way.
        emission_time: bool = Switch, default(false), "on";
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
        let folder = FilePath::read(node, reader)?;
        let place = node.place.clone();
        Ok(Output { place, folder, png: 8, bmp: false, exr: None, doppler: false, emission_time: false })
    }
}
