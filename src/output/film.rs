//! Films of every kind, by the ending of their name.

use super::avi::Avi;
use super::gif::Gif;
use super::movie::{self, Movie};
use crate::error::Error;
use std::path::Path;

/// What a film is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmKind {
    /// H.264 in MP4.
    Mp4,
    /// GIF.
    Gif,
    /// Motion JPEG in AVI.
    Avi,
}

/// Fastest GIF, in pictures a second: what lasts less than 2/100 s most programs show for 10/100 s.
pub(super) const FASTEST_GIF: f64 = 50.0;

/// Longest side of a GIF or of a picture in JPEG.
pub(super) const LONGEST_SIDE: u32 = 65_535;

impl FilmKind {
    /// By the name of a file; none for other endings.
    pub fn of(name: &str) -> Option<Self> {
        match name.rsplit_once('.')?.1 {
            "mp4" => Some(Self::Mp4),
            "gif" => Some(Self::Gif),
            "avi" => Some(Self::Avi),
            _ => None,
        }
    }

    /// Why a film of this kind, size and rate cannot be, if that is so.
    pub fn refusal(self, (width, height): (u32, u32), rate: f64) -> Option<Refusal> {
        let (long, short) = (width.max(height), width.min(height));
        let size = |bounds: &str, (width_then, height_then): (u32, u32)| Refusal {
            of: Refused::Size,
            what: format!("a film cannot be {width} x {height} pixels ({bounds})"),
            hint: format!("size: {width_then} {height_then}, or `film: {{ video: off }}` for pictures alone"),
        };
        match self {
            Self::Mp4 => {
                let fits = short >= movie::SMALLEST && long <= movie::LARGEST.0 && short <= movie::LARGEST.1;
                (!fits).then(|| size("16 x 16 to 3840 x 2160", filmed_size((width, height))))
            }
            Self::Gif if rate > FASTEST_GIF => Some(Refusal {
                of: Refused::Rate,
                what: format!("a GIF cannot show {rate} pictures a second (at most 50)"),
                hint: "rate: 50, or another kind of film".to_owned(),
            }),
            Self::Gif | Self::Avi => {
                let most = |side: u32| side.min(LONGEST_SIDE);
                (long > LONGEST_SIDE).then(|| size("at most 65535 a side", (most(width), most(height))))
            }
        }
    }
}

/// The size nearest to one that an MP4 film can have, of the same shape if there is one.
fn filmed_size((width, height): (u32, u32)) -> (u32, u32) {
    let (long, short) = (f64::from(width.max(height)), f64::from(width.min(height)));
    let (longest, across) = (f64::from(movie::LARGEST.0), f64::from(movie::LARGEST.1));
    let scale = (longest / long).min(across / short).min(1.0).max(f64::from(movie::SMALLEST) / short);
    // Even sides, as films have them.
    let side =
        |side: f64| (2.0 * (0.5 * side * scale).round()).clamp(f64::from(movie::SMALLEST), longest) as u32;
    (side(width.into()), side(height.into()))
}

/// Why a film cannot be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// What it is about.
    pub of: Refused,
    /// What is wrong.
    pub what: String,
    /// What to type.
    pub hint: String,
}

/// What a film cannot have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refused {
    /// Its width and height.
    Size,
    /// Its pictures a second.
    Rate,
}

/// A film in the making: [`push`](Self::push) every picture, then [`finish`](Self::finish), before which no file stands
/// under the film's name. Dropped unfinished, it leaves nothing behind.
#[derive(Debug)]
pub enum Making {
    /// H.264 in MP4.
    Mp4(Box<Movie>),
    /// GIF.
    Gif(Box<Gif>),
    /// Motion JPEG in AVI.
    Avi(Box<Avi>),
}

impl Making {
    /// A film of a size (pixels) and a rate (pictures a second), that says something of itself.
    pub fn create(
        kind: FilmKind,
        path: &Path,
        (width, height): (u32, u32),
        rate: f64,
        comment: &str,
    ) -> Result<Self, Error> {
        Ok(match kind {
            FilmKind::Mp4 => {
                Self::Mp4(Box::new(Movie::create(path, width, height, rate)?.commented(comment)))
            }
            FilmKind::Gif => Self::Gif(Box::new(Gif::new(path, (width, height), rate, comment))),
            FilmKind::Avi => Self::Avi(Box::new(Avi::create(path, (width, height), rate, comment)?)),
        })
    }

    /// Adds a picture: red, green, blue of every pixel, row by row from the top, encoded as sRGB.
    pub fn push(&mut self, rgb: &[u8]) -> Result<(), Error> {
        match self {
            Self::Mp4(movie) => movie.push(rgb),
            Self::Gif(gif) => gif.push(rgb),
            Self::Avi(avi) => avi.push(rgb),
        }
    }

    /// Writes the file. `again` gives a picture once more by its number: a GIF chooses its colours by all of them.
    pub fn finish(self, again: &dyn Fn(usize) -> Result<Vec<u8>, Error>) -> Result<(), Error> {
        match self {
            Self::Mp4(movie) => movie.finish(),
            Self::Gif(gif) => gif.finish(again),
            Self::Avi(avi) => avi.finish(),
        }
    }
}

/// Timescale and duration of a picture for a rate in pictures a second: exact for whole rates, for rates with
/// up to three decimals, and for those of American television, which are n * 1000/1001 and commonly
/// written 23.976, 29.97, 59.94; within 1e-6 / s for others.
pub(super) fn timing(rate: f64) -> (u32, u32) {
    let television = (rate * 1.001).round() * 1000.0;
    if (television / 1001.0 / rate - 1.0).abs() < 2e-5 {
        return (television as u32, 1001);
    }
    let thousandths = (rate * 1000.0).round();
    if (thousandths - rate * 1000.0).abs() < 1e-6 {
        return (thousandths as u32, 1000);
    }
    ((rate * 1e6).round() as u32, 1_000_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_kept_exactly() {
        assert_eq!(timing(24.0), (24_000, 1000));
        assert_eq!(timing(12.5), (12_500, 1000));
        assert_eq!(timing(23.976), (24_000, 1001));
        assert_eq!(timing(29.97), (30_000, 1001));
        assert_eq!(timing(30_000.0 / 1001.0), (30_000, 1001));
        assert_eq!(timing(59.94), (60_000, 1001));
        assert_eq!(timing(0.1), (100, 1000));
        assert_eq!(timing(1.0 / 3.0), (333_333, 1_000_000));
    }
}
