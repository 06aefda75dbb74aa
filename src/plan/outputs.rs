//! The files of a film.

use super::Plan;
use crate::manifest::{self, Depth, Layer};
use crate::output::exposure_name;
use std::path::PathBuf;

/// A file that an exposure has. The last one in order is written last: with it the exposure is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Picture {
    /// OpenEXR.
    Exr,
    /// BMP.
    Bmp,
    /// PNG, which is always written.
    Png,
}

impl Picture {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Exr, Self::Bmp, Self::Png];

    /// How names of such files end.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Bmp => "bmp",
            Self::Png => "png",
        }
    }
}

/// What is written of each exposure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outputs {
    /// Whether PNG pictures have 16 bits a channel.
    pub sixteen: bool,
    /// Whether BMP pictures are wanted.
    pub bmp: bool,
    /// What OpenEXR files hold, if they are wanted.
    pub exr: Option<Measured>,
}

/// What an OpenEXR file holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Measured {
    /// How finely light is stored.
    pub depth: Depth,
    /// Its layers.
    pub layers: Vec<Layer>,
}

impl Outputs {
    /// What a manifest asks for.
    pub(super) fn of(output: &manifest::Output) -> Self {
        let measured = |exr: &manifest::Exr| Measured { depth: exr.depth, layers: exr.layers.clone() };
        Self { sixteen: output.png == 16, bmp: output.bmp, exr: output.exr.as_ref().map(measured) }
    }

    /// The files of each exposure, in the order in which they are written.
    pub fn pictures(&self) -> Vec<Picture> {
        let wanted = |picture: &Picture| match picture {
            Picture::Exr => self.exr.is_some(),
            Picture::Bmp => self.bmp,
            Picture::Png => true,
        };
        Picture::ALL.into_iter().filter(wanted).collect()
    }
}

impl Plan {
    /// The file of an exposure.
    pub fn picture(&self, index: usize, picture: Picture) -> PathBuf {
        self.folder.join(exposure_name(index, self.exposures.len())).with_extension(picture.ending())
    }
}
