//! AVI films: every picture a JPEG of its own (Motion JPEG), for programs that cut films.
//!
//! One RIFF with an index at its end (Microsoft, AVI RIFF file reference), so at most 2 GB.

use super::film::timing;
use super::{Temporary, write_whole};
use crate::error::{Error, Place};
use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;
use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// Quality of the JPEGs, of 100.
const QUALITY: u8 = 95;

/// More bytes of pictures than this are no longer read by all programs.
const MOST_BYTES: u64 = 2_000_000_000;

/// An AVI film in the making.
pub struct Avi {
    path: PathBuf,
    size: (u32, u32),
    rate: f64,
    comment: String,
    // Bytes of each picture.
    lengths: Vec<u32>,
    total: u64,
    spool: BufWriter<File>,
    _name: Temporary,
}

impl fmt::Debug for Avi {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Avi({}, {} pictures)", self.path.display(), self.lengths.len())
    }
}

impl Avi {
    /// A film of a size (pixels) and a rate (pictures a second).
    pub fn create(path: &Path, size: (u32, u32), rate: f64, comment: &str) -> Result<Self, Error> {
        let (name, spool) = Temporary::beside(path)?;
        Ok(Self {
            path: path.to_owned(),
            size,
            rate,
            comment: comment.to_owned(),
            lengths: Vec::new(),
            total: 0,
            spool: BufWriter::with_capacity(1 << 16, spool),
            _name: name,
        })
    }

    /// Adds a picture.
    pub fn push(&mut self, rgb: &[u8]) -> Result<(), Error> {
        self.code(rgb).map_err(|source| Error::machine(&self.path, "writing the film", source))
    }

    fn code(&mut self, rgb: &[u8]) -> io::Result<()> {
        if rgb.len() != 3 * self.size.0 as usize * self.size.1 as usize {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the picture is not of the film's size"));
        }
        let mut coded = Vec::new();
        let mut encoder = JpegEncoder::new_with_quality(&mut coded, QUALITY);
        encoder
            .encode(rgb, self.size.0, self.size.1, ExtendedColorType::Rgb8)
            .map_err(|error| io::Error::other(error.to_string()))?;
        // Chunks begin at even places.
        if coded.len() % 2 == 1 {
            coded.push(0);
        }
        self.total += coded.len() as u64 + 8;
        self.lengths.push(coded.len() as u32);
        // Of a film that is too long the rest is not kept; what it comes to is said in the end.
        if self.total > MOST_BYTES { Ok(()) } else { self.spool.write_all(&coded) }
    }

    /// Writes the file.
    pub fn finish(self) -> Result<(), Error> {
        let place = || Place::file(&self.path);
        if self.lengths.is_empty() {
            let hint = "give it at least one exposure";
            return Err(Error::fault(place(), "a film cannot be without pictures", hint));
        }
        if self.total > MOST_BYTES {
            let what =
                format!("an AVI film has at most 2 GB; this would have {:.1} GB", self.total as f64 / 1e9);
            return Err(Error::fault(place(), what, "write an MP4 film: it has no such limit"));
        }
        let head = self.head();
        let Self { path, lengths, spool, _name, .. } = self;
        let rewound = |spool: BufWriter<File>| -> io::Result<File> {
            let mut file = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
            file.rewind()?;
            Ok(file)
        };
        let mut data = rewound(spool).map_err(|source| Error::machine(&path, "writing the film", source))?;
        write_whole(&path, |file| {
            file.write_all(&head)?;
            let mut index = Vec::new();
            let mut at = 4_u32;
            for length in lengths {
                file.write_all(b"00dc")?;
                file.write_all(&length.to_le_bytes())?;
                if io::copy(&mut Read::by_ref(&mut data).take(u64::from(length)), file)? != u64::from(length)
                {
                    return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the pictures are cut short"));
                }
                index.extend(b"00dc");
                index.extend(words(&[16, at, length])); // Decoding can begin here.
                at += 8 + length;
            }
            file.write_all(&chunk(b"idx1", &index))
        })
    }

    /// All that comes before the first picture.
    fn head(&self) -> Vec<u8> {
        let count = self.lengths.len() as u32;
        let largest = self.lengths.iter().copied().max().unwrap_or_default();
        let (scale, lasts) = timing(self.rate);
        let (width, height) = self.size;
        let each = (1e6 * f64::from(lasts) / f64::from(scale)).round() as u32;
        let speed = (f64::from(largest) * self.rate).min(f64::from(u32::MAX)) as u32;
        // An index is there; one stream.
        let avih = words(&[each, speed, 0, 0x10, count, 0, 1, largest, width, height, 0, 0, 0, 0]);
        let strh = [
            b"vidsMJPG".to_vec(),
            words(&[0, 0, 0, lasts, scale, 0, count, largest, u32::MAX, 0]),
            [0, 0, width as u16, height as u16].into_iter().flat_map(u16::to_le_bytes).collect(),
        ];
        let strf = [
            words(&[40, width, height, 1 | 24 << 16]),
            b"MJPG".to_vec(),
            words(&[3_u32.saturating_mul(width).saturating_mul(height), 0, 0, 0, 0]),
        ];
        let strl = list(b"strl", &[chunk(b"strh", &strh.concat()), chunk(b"strf", &strf.concat())].concat());
        let hdrl = list(b"hdrl", &[chunk(b"avih", &avih), strl].concat());
        let said = |text: &str| [text.as_bytes(), &[0]].concat();
        let software = said(concat!("terrell ", env!("CARGO_PKG_VERSION")));
        let info = list(b"INFO", &[chunk(b"ISFT", &software), chunk(b"ICMT", &said(&self.comment))].concat());
        let movi = 4 + self.total as u32;
        let index = 8 + 16 * count;
        let all = 4 + (hdrl.len() + info.len()) as u32 + 8 + movi + index;
        let mut head = b"RIFF".to_vec();
        head.extend(all.to_le_bytes());
        head.extend(b"AVI ");
        head.extend(hdrl);
        head.extend(info);
        head.extend(b"LIST");
        head.extend(movi.to_le_bytes());
        head.extend(b"movi");
        head
    }
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Name, length, content, and a byte more if that is odd.
fn chunk(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let mut bytes = name.to_vec();
    bytes.extend((content.len() as u32).to_le_bytes());
    bytes.extend(content);
    if content.len() % 2 == 1 {
        bytes.push(0);
    }
    bytes
}

fn list(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    chunk(b"LIST", &[&name[..], content].concat())
}
