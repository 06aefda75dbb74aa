//! What is to be rendered: the exposures of a film, and where they go.

use crate::exposure::Sampling;
use std::path::PathBuf;

/// One picture of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// Its number, from zero.
    pub index: usize,
    /// The observer's proper time, metres (a ring of observers: turns).
    pub tau: f64,
}

/// Which luminance becomes white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum White {
    /// This one, cd/m².
    Fixed(f64),
    /// From the whole film's brightness, this many times as bright (2 to the power of the stops).
    Auto {
        /// Multiplies the brightness of the pictures.
        gain: f64,
    },
}

/// What is to be rendered, and where it goes.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// All exposures of the film, in order.
    pub exposures: Vec<Exposure>,
    /// How finely.
    pub sampling: Sampling,
    /// How bright.
    pub white: White,
    /// Pictures per second of the film; none if no film is wanted.
    pub film_rate: Option<f64>,
    /// Whether OpenEXR files are wanted.
    pub exr: bool,
    /// The folder for all files.
    pub folder: PathBuf,
    /// The film's name in it, without extension.
    pub name: String,
    /// Seconds in a metre of light travel: 1/c of this manifest.
    pub seconds_per_metre: f64,
    /// Written into every picture: what it was made from.
    pub text: Vec<(&'static str, String)>,
}
