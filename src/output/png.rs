//! PNG pictures of 8 and 16 bits a channel.

use super::write_whole;
use crate::error::Error;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

/// A picture of 8 bits a channel, encoded as sRGB (IEC 61966-2-1).
#[derive(Debug, Clone, Copy)]
pub struct Picture8<'a> {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue of every pixel, row by row from the top: `3 * width * height` bytes.
    pub rgb: &'a [u8],
    /// What is written into the file as text: keyword (1 to 79 Latin-1 characters) and text.
    pub text: &'a [(&'a str, String)],
}

/// A picture of 16 bits a channel.
#[derive(Debug, Clone, Copy)]
pub struct Picture16<'a> {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// As in [`Picture8`], from 0 to 65535.
    pub rgb: &'a [u16],
    /// As in [`Picture8`].
    pub text: &'a [(&'a str, String)],
}

/// Writes a PNG file with an `sRGB` chunk (rendering intent perceptual) and the texts, `tEXt` where ASCII
/// suffices and `iTXt` (UTF-8) elsewhere. The same picture gives the same bytes.
pub fn write_png(path: &Path, picture: &Picture8<'_>) -> Result<(), Error> {
    let Picture8 { width, height, rgb, text } = *picture;
    let kind = (width, height, png::BitDepth::Eight);
    write_whole(path, |file| encode(file, kind, rgb, text).map_err(io::Error::from))
}

/// Writes a PNG file of 16 bits a channel.
pub fn write_png16(path: &Path, picture: &Picture16<'_>) -> Result<(), Error> {
    let Picture16 { width, height, rgb, text } = *picture;
    let bytes: Vec<u8> = rgb.iter().flat_map(|value| value.to_be_bytes()).collect();
    let kind = (width, height, png::BitDepth::Sixteen);
    write_whole(path, |file| encode(file, kind, &bytes, text).map_err(io::Error::from))
}

/// The 8 bits of a value of 16: both are roundings of the same number.
pub fn eight_of(sixteen: u16) -> u8 {
    ((u32::from(sixteen) + 128) / 257) as u8
}

/// The texts in a PNG file by their keywords; empty if it is no PNG file.
pub fn png_texts(path: &Path) -> BTreeMap<String, String> {
    let decoder = File::open(path).map(|file| png::Decoder::new(BufReader::new(file)));
    let Some(reader) = decoder.ok().and_then(|decoder| decoder.read_info().ok()) else {
        return BTreeMap::new();
    };
    let texts = reader.info().uncompressed_latin1_text.iter();
    texts.map(|text| (text.keyword.clone(), text.text.clone())).collect()
}

/// A PNG picture that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadPng {
    /// Whether it has 16 bits a channel.
    pub sixteen: bool,
    /// Red, green and blue of every pixel, of 8 bits.
    pub rgb: Vec<u8>,
}

/// Reads a PNG file that this program has written, `size` pixels across and down; an error if anything is wrong with it,
/// to its last byte.
pub fn read_png(path: &Path, size: (u32, u32)) -> Result<ReadPng, Error> {
    let read = || -> io::Result<ReadPng> {
        // The texts too: usually what is not of the picture is passed over if its sum is wrong.
        let mut options = png::DecodeOptions::default();
        options.set_skip_ancillary_crc_failures(false);
        let file = BufReader::new(File::open(path)?);
        let mut reader = png::Decoder::new_with_options(file, options).read_info()?;
        let (kind, depth, found) = (reader.info().color_type, reader.info().bit_depth, reader.info().size());
        let sixteen = depth == png::BitDepth::Sixteen;
        let known = kind == png::ColorType::Rgb && (sixteen || depth == png::BitDepth::Eight);
        if !known || found != size {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "it is another kind of picture"));
        }
        let bytes = if sixteen { 6 } else { 3 };
        let mut rgb = vec![0; bytes * size.0 as usize * size.1 as usize];
        reader.next_frame(&mut rgb)?;
        reader.finish()?;
        if sixteen {
            rgb =
                rgb.chunks_exact(2).map(|value| eight_of(u16::from_be_bytes([value[0], value[1]]))).collect();
        }
        Ok(ReadPng { sixteen, rgb })
    };
    read().map_err(|source| Error::machine(path, "reading", source))
}

fn encode(
    file: impl io::Write,
    (width, height, depth): (u32, u32, png::BitDepth),
    rgb: &[u8],
    text: &[(&str, String)],
) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Fast);
    for (keyword, text) in text {
        if text.is_ascii() {
            encoder.add_text_chunk((*keyword).to_owned(), text.clone())?;
        } else {
            encoder.add_itxt_chunk((*keyword).to_owned(), text.clone())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()
}
