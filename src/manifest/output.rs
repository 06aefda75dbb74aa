//! Where pictures and films go, and as what.

use super::node::{Content, Node};
use super::plain::{FilePath, Real, Switch, Text};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, record};
use crate::error::Place;
use std::path::{Path, PathBuf};

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
