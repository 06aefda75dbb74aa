//! What is to be rendered: the exposures of a film, how, and where they go.

pub mod cost;
pub mod meaning;
pub mod needs;

mod limits;
mod outputs;

pub use outputs::{Measured, Outputs, Picture};

use crate::error::Report;
use crate::exposure::Sampling;
use crate::film::Reconstruction;
use crate::inputs::{self, Digest};
use crate::manifest::{self, Amount, Clock, Filter, Manifest};
use crate::scene::Scene;
use crate::spacetime::Course;
use crate::spectrum::{Source, Spectrum};
use crate::stereo::Side;
use std::fmt;
use std::path::{Path, PathBuf};

/// One picture of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// Its number, from zero.
    pub index: usize,
    /// The observer's proper time, metres (a ring of observers: part of the film).
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
    /// How far 99 of 100 pixels may be from the converged picture (CIEDE2000), where that is asked for instead of samples.
    pub tolerance: Option<f64>,
    /// Whether all exposures are the same picture.
    pub still: bool,
    /// How bright.
    pub white: White,
    /// How far above white light is still told apart, factors of two; none if the film's brightness shall say it.
    pub headroom: Option<f64>,
    /// How much brighter that is than what is asked for, in factors of two.
    pub stops: f64,
    /// Pictures per second of the film; none if no film is wanted.
    pub film_rate: Option<f64>,
    /// What is written of each exposure.
    pub outputs: Outputs,
    /// The folder for all files.
    pub folder: PathBuf,
    /// The film's files in it, each of another kind or name.
    pub film_files: Vec<String>,
    /// Seconds in a metre of light travel: 1/c of this manifest.
    pub seconds_per_metre: f64,
    /// Written into every picture: what it was made from.
    pub text: Vec<(&'static str, String)>,
    /// What the pictures are made of; none where that is not known, and pictures that are there already are rendered anew.
    pub inputs: Option<(Digest, Digest)>,
    /// Which eye sees them, of two that have a folder each.
    pub eye: Option<Side>,
    /// Whether pictures that are there already are rendered anew.
    pub restart: bool,
}

/// The most exposures of an animation whose number is not said.
const MOST_OF_ANIMATION: f64 = 1e6;

/// This program.
pub const VERSION: &str = concat!("terrell ", env!("CARGO_PKG_VERSION"));

/// By what a picture is known to belong to a film: it is the same in all of its pictures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fingerprint {
    /// Of what the manifest says, and flags.
    pub manifest: String,
    /// Of the files that it reads.
    pub files: String,
    /// The program.
    pub version: String,
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.manifest, self.files, self.version)
    }
}

impl Fingerprint {
    /// As written in a picture.
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = text.splitn(3, ' ').map(str::to_owned);
        Some(Self { manifest: parts.next()?, files: parts.next()?, version: parts.next()? })
    }
}

impl Plan {
    /// By what its pictures are known.
    pub fn fingerprint(&self) -> Option<Fingerprint> {
        let (manifest, files) = self.inputs?;
        // Flags may have taken the tolerance away; and a spectrum is of more than three wavelengths.
        let spectrum = if self.outputs.spectrum() { " spectrum" } else { "" };
        let more = format!("{:?}{spectrum}", self.tolerance);
        let manifest = inputs::digest([&manifest[..], more.as_bytes()].concat());
        let short = |digest: Digest| {
            let [a, b, c, d, e, f, g, h, ..] = digest;
            format!("{:016x}", u64::from_be_bytes([a, b, c, d, e, f, g, h]))
        };
        Some(Fingerprint { manifest: short(manifest), files: short(files), version: VERSION.to_owned() })
    }

    /// What a manifest asks for.
    ///
    /// Faults: a film that cannot be written, and what is beyond the limits of the arithmetic.
    pub fn of(manifest: &Manifest, scene: &Scene, path: &Path, report: &mut Report) -> Self {
        let stem = path.file_stem().map_or_else(|| "film".into(), |stem| stem.to_string_lossy());
        let picture = &manifest.picture;
        let (width, height) = picture.size.value;
        let film = manifest.film.as_ref().filter(|film| film.video);
        let files = film.map(|film| film.file.clone()).filter(|files| !files.is_empty());
        let files = files.unwrap_or_else(|| vec![format!("{stem}.mp4")]);
        let exposures = exposures(manifest, scene);
        let film_files = outputs::films(film, files, exposures.len(), manifest, report);
        let film_rate = film.map(|film| film.rate.value).filter(|_| !film_files.is_empty());
        limits::check(manifest, scene, &exposures, report);
        let outputs = Outputs::of(&manifest.output);
        outputs::check_spectrum(manifest, &outputs, report);
        let three = needs::three_wavelengths(scene).yes && !outputs.spectrum();
        Self {
            exposures,
            sampling: Sampling {
                width,
                height,
                samples: picture.samples,
                reconstruction: match picture.filter {
                    Filter::Gaussian => Reconstruction::Gaussian,
                    Filter::Tent => Reconstruction::Tent,
                    Filter::Box => Reconstruction::Box,
                },
                wavelengths: if three { 3 } else { picture.wavelengths },
            },
            tolerance: picture.tolerance,
            still: needs::still(scene).yes,
            white: white(picture),
            headroom: picture.headroom,
            stops: picture.stops,
            film_rate,
            outputs,
            folder: manifest.output.folder.clone(),
            film_files,
            seconds_per_metre: 1.0 / manifest.light_speed,
            text: vec![("Software", VERSION.to_owned()), ("Source", stem.into_owned())],
            inputs: report.inputs.manifest.map(|manifest| (manifest, report.inputs.of_files())),
            eye: None,
            restart: false,
        }
    }
}

/// The exposures of a camera's animation: from its first key to its last.
fn of_animation(manifest: &Manifest, (from, to): (f64, f64), scene: &Scene) -> Vec<Exposure> {
    let seconds = (to - from) / manifest.light_speed;
    let rate = manifest.film.as_ref().map_or(24.0, |film| film.rate.value);
    let written = &manifest.exposures;
    let count = if written.counted { f64::from(written.count) } else { (seconds * rate).round() + 1.0 };
    let count = if to > from { count.clamp(1.0, MOST_OF_ANIMATION) as usize } else { 1 };
    let last = (count - 1).max(1) as f64;
    let tau =
        |index: usize| scene.observer.worldline.tau_at_start(from + (to - from) * (index as f64 / last));
    (0..count).map(|index| Exposure { index, tau: tau(index) }).collect()
}

fn exposures(manifest: &Manifest, scene: &Scene) -> Vec<Exposure> {
    let written = &manifest.exposures;
    if let Some(filmed) = scene.observer.filmed.as_ref().filter(|_| !written.timed) {
        return of_animation(manifest, filmed.span, scene);
    }
    let count = written.count as usize;
    let worldline = &scene.observer.worldline;
    let tau = |index: usize| {
        if matches!(worldline.course(), Course::Ring { .. }) {
            // Round and round: the last one stands just before the first.
            return index as f64 / count as f64;
        }
        let part = if count > 1 { index as f64 / (count - 1) as f64 } else { 0.0 };
        let moment = written.from + (written.to - written.from) * part;
        match written.clock {
            Clock::Own => moment,
            Clock::Lab => worldline.tau_at_lab(moment).unwrap_or(moment),
        }
    };
    (0..count).map(|index| Exposure { index, tau: tau(index) }).collect()
}

fn white(picture: &manifest::Picture) -> White {
    let gain = libm::exp2(picture.stops);
    match picture.white {
        manifest::White::Auto => White::Auto { gain },
        manifest::White::Luminance(Amount::Photometric(luminance)) => White::Fixed(luminance / gain),
        // In watts: of daylight.
        manifest::White::Luminance(Amount::Radiometric(radiance)) => {
            let daylight = Source::with_total(&Spectrum::DAYLIGHT, radiance);
            White::Fixed(daylight.map_or(radiance, |daylight| daylight.xyz().y) / gain)
        }
    }
}
