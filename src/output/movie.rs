//! Films: H.264 in MP4, encoded by the built-in `OpenH264`.
//!
//! BT.709 limited range, 4:2:0, High profile with a constant quantiser, a key picture every second. Coded pictures
//! go to a passing file beside the film, so a film of any length needs the memory of one picture (and, while it is
//! finished, twice its size on the disk). One thread does the coding: the same pictures give the same bytes.

#[cfg(feature = "video")]
use super::reel::Reel;
use crate::error::{Error, Fault, Place};
use std::path::Path;

/// Whether this build can write films (feature `video`).
pub const AVAILABLE: bool = cfg!(feature = "video");

/// Smallest side of a film in pixels: a limit of `OpenH264`.
pub const SMALLEST: u32 = 16;

/// Largest long and short side of a film in pixels: a limit of `OpenH264` (level 5.2).
pub const LARGEST: (u32, u32) = (3840, 2160);

/// Slowest and fastest film, in pictures a second.
pub const RATES: (f64, f64) = (0.1, 1000.0);

/// What keeps a film of this size and rate from being written, if anything does: so that a caller can say so
/// before rendering it. The error speaks of the file `path`.
pub fn check(path: &Path, width: u32, height: u32, rate: f64) -> Result<(), Error> {
    let mut faults = Vec::new();
    let mut fault = |what: String, hint: &str| {
        faults.push(Fault::new(Place::file(path), what, hint));
    };
    if !AVAILABLE {
        let hint =
            "build with the feature `video`, or join the pictures with another program, such as ffmpeg";
        fault("this build of terrell cannot write films".into(), hint);
    }
    let (long, short) = (width.max(height), width.min(height));
    if short < SMALLEST {
        let hint =
            "a film is at least 16 pixels wide and high; choose a larger size, or keep to the pictures";
        fault(format!("a film cannot be {width} x {height} pixels"), hint);
    } else if long > LARGEST.0 || short > LARGEST.1 {
        let hint = "a film is at most 3840 x 2160 (or 2160 x 3840) pixels; choose a smaller size, or keep to the \
                    pictures and join them with another program, such as ffmpeg";
        fault(format!("a film cannot be {width} x {height} pixels"), hint);
    }
    if !(RATES.0..=RATES.1).contains(&rate) {
        let hint = "choose a rate from 0.1 to 1000, such as 24";
        fault(format!("a film cannot have {rate} pictures a second"), hint);
    }
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}

/// A film in the making: [`create`](Self::create), then [`push`](Self::push) every picture, then
/// [`finish`](Self::finish), before which no file stands under the film's name. Dropped
/// unfinished, it leaves nothing behind.
#[derive(Debug)]
pub struct Movie {
    reel: Reel,
}

impl Movie {
    /// A film of `width` by `height` pixels and `rate` pictures a second, to be the file `path`. Odd
    /// sizes get a further column or row, as films of 4:2:0 are even. Refused as [`check`] says.
    pub fn create(path: &Path, width: u32, height: u32, rate: f64) -> Result<Self, Error> {
        check(path, width, height, rate)?;
        Ok(Self { reel: Reel::create(path, width as usize, height as usize, rate)? })
    }

    /// The same with something that it says of itself.
    #[must_use]
    pub fn commented(mut self, comment: &str) -> Self {
        self.reel.comment(comment);
        self
    }

    /// Adds a picture: red, green, blue of every pixel, row by row from the top, encoded as sRGB:
    /// `3 * width * height` bytes.
    pub fn push(&mut self, rgb: &[u8]) -> Result<(), Error> {
        self.reel.push(rgb)
    }

    /// Writes the file.
    pub fn finish(self) -> Result<(), Error> {
        self.reel.finish()
    }
}

/// Stands in for the encoder where there is none: it cannot be made.
#[cfg(not(feature = "video"))]
#[derive(Debug)]
enum Reel {}

#[cfg(not(feature = "video"))]
impl Reel {
    fn create(path: &Path, width: usize, height: usize, _rate: f64) -> Result<Self, Error> {
        Err(Error::fault(Place::file(path), format!("no film of {width} x {height} pixels"), ""))
    }

    fn comment(&mut self, _comment: &str) {
        match *self {}
    }

    fn push(&mut self, _rgb: &[u8]) -> Result<(), Error> {
        match *self {}
    }

    fn finish(self) -> Result<(), Error> {
        match self {}
    }
}
