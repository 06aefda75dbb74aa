//! The files of a film.

use super::Plan;
use crate::error::Report;
use crate::manifest::{self, Depth, Layer};
use crate::output::{FilmKind, Refusal, Refused, exposure_name, movie};
use std::path::PathBuf;

/// A file that an exposure has. The last one in order is written last: with it the exposure is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Picture {
    /// OpenEXR.
    Exr,
    /// BMP.
    Bmp,
    /// The Doppler factor in false colours, PNG.
    Doppler,
    /// When the light was sent in false colours, PNG.
    EmissionTime,
    /// PNG, which is always written.
    Png,
}

impl Picture {
    /// Every kind.
    pub const ALL: [Self; 5] = [Self::Exr, Self::Bmp, Self::Doppler, Self::EmissionTime, Self::Png];

    /// How names of such files end.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Bmp => "bmp",
            Self::Doppler => "doppler.png",
            Self::EmissionTime => "emission_time.png",
            Self::Png => "png",
        }
    }
}

/// What is written of each exposure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outputs {
    /// Whether PNG pictures have 16 bits a channel.
    pub sixteen: bool,
    /// The files of each exposure, in the order in which they are written.
    pub pictures: Vec<Picture>,
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
    /// Whether the spectrum of pictures is wanted.
    pub fn spectrum(&self) -> bool {
        self.exr.as_ref().is_some_and(|exr| exr.layers.contains(&Layer::Spectrum))
    }

    /// What a manifest asks for.
    pub(super) fn of(output: &manifest::Output) -> Self {
        let measured = |exr: &manifest::Exr| Measured { depth: exr.depth, layers: exr.layers.clone() };
        let wanted = |picture: &Picture| match picture {
            Picture::Exr => output.exr.is_some(),
            Picture::Bmp => output.bmp,
            Picture::Doppler => output.doppler,
            Picture::EmissionTime => output.emission_time,
            Picture::Png => true,
        };
        Self {
            sixteen: output.png == 16,
            pictures: Picture::ALL.into_iter().filter(wanted).collect(),
            exr: output.exr.as_ref().map(measured),
        }
    }
}

impl Plan {
    /// The file of an exposure.
    pub fn picture(&self, index: usize, picture: Picture) -> PathBuf {
        self.folder.join(exposure_name(index, self.exposures.len())).with_extension(picture.ending())
    }
}

/// Those of the films that can be made of so many exposures; a fault where one cannot be.
pub(super) fn films(
    film: Option<&manifest::Film>,
    mut files: Vec<String>,
    exposures: usize,
    manifest: &manifest::Manifest,
    report: &mut Report,
) -> Vec<String> {
    let Some(film) = film.filter(|_| exposures > 1) else { return Vec::new() };
    if !movie::AVAILABLE && files.iter().any(|file| FilmKind::of(file) == Some(FilmKind::Mp4)) {
        let hint = "write a GIF or AVI film, or join the pictures with another program, such as ffmpeg";
        report.warn(film.place.clone(), "this build writes no MP4 films, only their pictures", hint);
        files.retain(|file| FilmKind::of(file) != Some(FilmKind::Mp4));
    }
    files.retain(|file| {
        let size = manifest.picture.size.value;
        let refusal = FilmKind::of(file).and_then(|kind| kind.refusal(size, film.rate.value));
        match &refusal {
            Some(Refusal { of: Refused::Size, what, hint }) => {
                report.fault(manifest.picture.size_place().clone(), what, hint);
            }
            Some(Refusal { of: Refused::Rate, what, hint }) => {
                report.fault(film.rate.place.clone(), what, hint);
            }
            None => {}
        }
        refusal.is_none()
    });
    files
}

/// Faults where a spectrum is wanted of pictures that have none: pixels with other wavelengths one by one, and two eyes in one.
pub(super) fn check_spectrum(manifest: &manifest::Manifest, outputs: &Outputs, report: &mut Report) {
    let Some(exr) = manifest.output.exr.as_ref().filter(|_| outputs.spectrum()) else { return };
    if manifest.picture.tolerance.is_some() {
        let what = "a spectrum needs the same wavelengths in all pixels: with a `tolerance` each has its own";
        let hint = "leave `tolerance` out and say `samples` and `wavelengths`, or leave out `spectrum`";
        report.fault(exr.place.clone(), what, hint);
    }
    let eyes = manifest.observer.stereo.as_ref();
    if eyes.is_some_and(|eyes| eyes.layout == manifest::Layout::Anaglyph) {
        let what = "an anaglyph has no spectrum: it is two pictures in the colours of one";
        report.fault(exr.place.clone(), what, "stereo: { layout: side_by_side }, or leave out `spectrum`");
    }
}
