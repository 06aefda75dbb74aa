//! GIF films: one palette of 255 colours for the whole film, so that nothing flickers.
//!
//! `GIF89a` (`CompuServe`, 1990), with Netscape's extension to play for ever. Colours between two of the palette are shown by an
//! ordered pattern, and what is as before in a pixel is not written again.

use super::palette::{COLORS, Histogram, Palette};
use super::write_whole;
use crate::error::{Error, Place};
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use weezl::{BitOrder, encode::Encoder};

/// A GIF film in the making.
pub struct Gif {
    path: PathBuf,
    size: (u32, u32),
    rate: f64,
    comment: String,
    histogram: Histogram,
    pictures: usize,
}

impl fmt::Debug for Gif {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Gif({}, {} pictures)", self.path.display(), self.pictures)
    }
}

impl Gif {
    /// A film of a size (pixels) and a rate (pictures a second).
    pub fn new(path: &Path, size: (u32, u32), rate: f64, comment: &str) -> Self {
        let (path, comment) = (path.to_owned(), comment.to_owned());
        Self { path, size, rate, comment, histogram: Histogram::new(), pictures: 0 }
    }

    /// Adds a picture. Only its colours are kept.
    pub fn push(&mut self, rgb: &[u8]) -> Result<(), Error> {
        self.fitting(rgb)?;
        self.histogram.add(rgb);
        self.pictures += 1;
        Ok(())
    }

    fn fitting(&self, rgb: &[u8]) -> Result<(), Error> {
        if rgb.len() == 3 * self.size.0 as usize * self.size.1 as usize {
            return Ok(());
        }
        let what = io::Error::new(io::ErrorKind::InvalidInput, "the picture is not of the film's size");
        Err(Error::machine(&self.path, "writing the film", what))
    }

    /// Writes the file; `again` gives each picture once more by its number.
    pub fn finish(self, again: &dyn Fn(usize) -> Result<Vec<u8>, Error>) -> Result<(), Error> {
        if self.pictures == 0 {
            let hint = "give it at least one exposure";
            return Err(Error::fault(Place::file(&self.path), "a film cannot be without pictures", hint));
        }
        let palette = self.histogram.palette();
        let mut failed = None;
        let written = write_whole(&self.path, |file| {
            self.begin(file, &palette)?;
            let mut before: Option<Vec<u8>> = None;
            for number in 0..self.pictures {
                let rgb = match again(number).and_then(|rgb| self.fitting(&rgb).map(|()| rgb)) {
                    Ok(rgb) => rgb,
                    Err(error) => {
                        failed = Some(error);
                        return Err(io::Error::other("a picture could not be read again"));
                    }
                };
                let numbers = palette.numbers(&rgb, self.size.0 as usize);
                self.add(file, &changed(&numbers, before.as_deref()), number)?;
                before = Some(numbers);
            }
            file.write_all(b";")
        });
        failed.map_or(written, Err)
    }

    fn begin(&self, file: &mut impl Write, palette: &Palette) -> io::Result<()> {
        file.write_all(b"GIF89a")?;
        file.write_all(&(self.size.0 as u16).to_le_bytes())?;
        file.write_all(&(self.size.1 as u16).to_le_bytes())?;
        file.write_all(&[0xf7, 0, 0])?; // 256 colours of 8 bits; the first behind; pixels are square.
        let mut colors = palette.colors.concat();
        colors.resize(3 * 256, 0);
        file.write_all(&colors)?;
        file.write_all(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\0\0\0")?; // For ever.
        file.write_all(b"\x21\xfe")?;
        blocks(file, self.comment.as_bytes())
    }

    fn add(&self, file: &mut impl Write, numbers: &[u8], number: usize) -> io::Result<()> {
        // Hundredths of a second, so that the whole film is as long as it should be.
        let until = |count: usize| (100.0 * count as f64 / self.rate).round() as u64;
        let lasts = (until(number + 1) - until(number)).min(u64::from(u16::MAX)) as u16;
        let transparent = u8::from(number > 0);
        // What is not written again stays.
        file.write_all(&[0x21, 0xf9, 4, 1 << 2 | transparent])?;
        file.write_all(&lasts.to_le_bytes())?;
        file.write_all(&[AS_BEFORE, 0])?;
        file.write_all(&[0x2c, 0, 0, 0, 0])?;
        file.write_all(&(self.size.0 as u16).to_le_bytes())?;
        file.write_all(&(self.size.1 as u16).to_le_bytes())?;
        file.write_all(&[0, 8])?;
        let coded = Encoder::new(BitOrder::Lsb, 8).encode(numbers).map_err(io::Error::other)?;
        blocks(file, &coded)
    }
}

/// Stands for the pixel's colour in the picture before.
const AS_BEFORE: u8 = COLORS as u8;

fn changed(numbers: &[u8], before: Option<&[u8]>) -> Vec<u8> {
    let Some(before) = before else { return numbers.to_vec() };
    let one = |(new, old): (&u8, &u8)| if new == old { AS_BEFORE } else { *new };
    numbers.iter().zip(before).map(one).collect()
}

/// Bytes in lots of at most 255, each with its length before it, and an empty one at the end.
fn blocks(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    for lot in bytes.chunks(255) {
        file.write_all(&[lot.len() as u8])?;
        file.write_all(lot)?;
    }
    file.write_all(&[0])
}
