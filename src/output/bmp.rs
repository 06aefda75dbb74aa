//! BMP pictures: 24 bits a pixel, uncompressed, for programs that read nothing else.

use super::{Picture8, write_whole};
use crate::error::Error;
use image::codecs::bmp::{BmpDecoder, BmpEncoder};
use image::{DynamicImage, ExtendedColorType, ImageDecoder, ImageError};
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

/// Writes a BMP file. It has no room for texts.
pub fn write_bmp(path: &Path, picture: &Picture8<'_>) -> Result<(), Error> {
    write_whole(path, |file| {
        let rgb = ExtendedColorType::Rgb8;
        BmpEncoder::new(file).encode(picture.rgb, picture.width, picture.height, rgb).map_err(machine)
    })
}

/// Red, green and blue of every pixel of a BMP file, `size` pixels across and down.
pub fn read_bmp(path: &Path, size: (u32, u32)) -> Result<Vec<u8>, Error> {
    let read = || -> Result<Vec<u8>, ImageError> {
        let decoder = BmpDecoder::new(BufReader::new(File::open(path)?))?;
        if decoder.dimensions() != size {
            let what = "it is another kind of picture";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what).into());
        }
        Ok(DynamicImage::from_decoder(decoder)?.into_rgb8().into_raw())
    };
    read().map_err(|error| Error::machine(path, "reading", machine(error)))
}

fn machine(error: ImageError) -> io::Error {
    match error {
        ImageError::IoError(source) => source,
        other => io::Error::other(other.to_string()),
    }
}
