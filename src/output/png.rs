//! 8-bit PNG pictures.

use super::write_whole;
use crate::error::Error;
use std::io;
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
