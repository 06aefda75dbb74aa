//! 8-bit PNG pictures.

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

/// Writes a PNG file with an `sRGB` chunk (rendering intent perceptual) and the texts, `tEXt` where ASCII
/// suffices and `iTXt` (UTF-8) elsewhere. The same picture gives the same bytes.
pub fn write_png(path: &Path, picture: &Picture8<'_>) -> Result<(), Error> {
    write_whole(path, |file| encode(file, picture).map_err(io::Error::from))
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

/// Red, green and blue of every pixel of a PNG file that [`write_png`] has written, `size` pixels across and down; an error
/// if anything is wrong with it.
pub fn read_png(path: &Path, size: (u32, u32)) -> Result<Vec<u8>, Error> {
    let read = || -> io::Result<Vec<u8>> {
        let mut reader = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
        let info = reader.info();
        if (info.color_type, info.bit_depth, info.size()) != (png::ColorType::Rgb, png::BitDepth::Eight, size)
        {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "it is another kind of picture"));
        }
        let mut rgb = vec![0; 3 * size.0 as usize * size.1 as usize];
        reader.next_frame(&mut rgb)?;
        reader.finish()?;
        Ok(rgb)
    };
    read().map_err(|source| Error::machine(path, "reading", source))
}

fn encode(file: impl io::Write, picture: &Picture8<'_>) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Fast);
    for (keyword, text) in picture.text {
        if text.is_ascii() {
            encoder.add_text_chunk((*keyword).to_owned(), text.clone())?;
        } else {
            encoder.add_itxt_chunk((*keyword).to_owned(), text.clone())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.rgb)?;
    writer.finish()
}
