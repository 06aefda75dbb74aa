//! Picture files become [`Picture`]s: by what is in them, not by their names.

use super::files::{Files, Refusal};
use crate::texture::{Encoding, Picture, Texels};
use image::{DynamicImage, ImageBuffer, ImageDecoder, ImageFormat, ImageReader, Limits, Pixel};
use std::io::Cursor;

/// The longest side of a picture.
const SIDE_LIMIT: u32 = 16384;
/// The most bytes that decoding one picture may take.
const DECODE_LIMIT: u64 = 1 << 30;

/// Decodes a picture file. `name` matters only for the one format that has no mark of its own (TGA).
///
/// 8 and 16 bits are kept and taken for sRGB, floats are kept and taken for linear. Colour profiles and
/// orientations in the file are passed over, as the glTF specification demands (§3.8.2).
pub(super) fn decode(bytes: &[u8], name: &str, files: &mut Files) -> Result<Picture, Refusal> {
    let wrong = |what: String| {
        Refusal::new(
            format!("this picture cannot be decoded: {what}"),
            "save it again as PNG, JPEG, WebP, TIFF, BMP, TGA, Radiance HDR or OpenEXR",
        )
    };
    let mut reader = ImageReader::new(Cursor::new(bytes));
    let ending = name.rsplit('.').next().unwrap_or("");
    if ending.eq_ignore_ascii_case("tga") {
        reader.set_format(ImageFormat::Tga);
    }
    let mut reader = reader.with_guessed_format().map_err(|e| wrong(e.to_string()))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(SIDE_LIMIT);
    limits.max_image_height = Some(SIDE_LIMIT);
    limits.max_alloc = Some(DECODE_LIMIT);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|e| wrong(e.to_string()))?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 || width > SIDE_LIMIT || height > SIDE_LIMIT {
        return Err(wrong(format!("it is {width} × {height} pixels, and the limit is {SIDE_LIMIT} a side")));
    }
    let channel = match decoder.color_type().bytes_per_pixel() / decoder.color_type().channel_count() {
        1 => 1,
        2 => 2,
        _ => 4,
    };
    let decoded = u64::from(width) * u64::from(height) * channel * 4;
    if decoded.max(decoder.total_bytes()) > DECODE_LIMIT {
        return Err(wrong(format!("it takes {decoded} bytes, and the limit is {DECODE_LIMIT}")));
    }
    files.take(decoded)?;
    let image = DynamicImage::from_decoder(decoder).map_err(|e| wrong(e.to_string()))?;
    picture(image).ok_or_else(|| wrong("its kind of pixels is not known".into()))
}

/// The texels with four channels each, in the width they have.
fn picture(image: DynamicImage) -> Option<Picture> {
    let (width, height) = (image.width(), image.height());
    let (texels, encoding) = match image {
        DynamicImage::ImageLuma8(b) => (Texels::Byte(four(&b, u8::MAX)), Encoding::Srgb),
        DynamicImage::ImageLumaA8(b) => (Texels::Byte(four(&b, u8::MAX)), Encoding::Srgb),
        DynamicImage::ImageRgb8(b) => (Texels::Byte(four(&b, u8::MAX)), Encoding::Srgb),
        DynamicImage::ImageRgba8(b) => (Texels::Byte(four(&b, u8::MAX)), Encoding::Srgb),
        DynamicImage::ImageLuma16(b) => (Texels::Word(four(&b, u16::MAX)), Encoding::Srgb),
        DynamicImage::ImageLumaA16(b) => (Texels::Word(four(&b, u16::MAX)), Encoding::Srgb),
        DynamicImage::ImageRgb16(b) => (Texels::Word(four(&b, u16::MAX)), Encoding::Srgb),
        DynamicImage::ImageRgba16(b) => (Texels::Word(four(&b, u16::MAX)), Encoding::Srgb),
        DynamicImage::ImageRgb32F(b) => (Texels::Float(finite(four(&b, 1.0))), Encoding::Linear),
        DynamicImage::ImageRgba32F(b) => (Texels::Float(finite(four(&b, 1.0))), Encoding::Linear),
        _ => return None,
    };
    Some(Picture::new(width, height, texels, encoding))
}

/// Grey spread over three channels, and full alpha where there is none.
fn four<P, T: Copy>(buffer: &ImageBuffer<P, Vec<T>>, full: T) -> Vec<[T; 4]>
where
    P: Pixel<Subpixel = T>,
{
    let texel = |p: &P| match *p.channels() {
        [l] => [l, l, l, full],
        [l, a] => [l, l, l, a],
        [r, g, b] => [r, g, b, full],
        [r, g, b, a, ..] => [r, g, b, a],
        [] => [full; 4],
    };
    buffer.pixels().map(texel).collect()
}

/// Renderers write infinities into bright spots and NaN into broken ones; neither is a colour.
fn finite(mut texels: Vec<[f32; 4]>) -> Vec<[f32; 4]> {
    for value in texels.as_flattened_mut() {
        *value = if value.is_nan() { 0.0 } else { value.clamp(0.0, f32::MAX) };
    }
    texels
}

/// The same picture with full coverage everywhere.
pub(super) fn opaque(mut picture: Picture) -> Picture {
    match &mut picture.texels {
        Texels::Byte(v) => v.iter_mut().for_each(|texel| texel[3] = u8::MAX),
        Texels::Word(v) => v.iter_mut().for_each(|texel| texel[3] = u16::MAX),
        Texels::Float(v) => v.iter_mut().for_each(|texel| texel[3] = 1.0),
    }
    picture
}

/// Whether every texel has full coverage.
pub(super) fn is_opaque(picture: &Picture) -> bool {
    match &picture.texels {
        Texels::Byte(v) => v.iter().all(|texel| texel[3] == u8::MAX),
        Texels::Word(v) => v.iter().all(|texel| texel[3] == u16::MAX),
        Texels::Float(v) => v.iter().all(|texel| texel[3] >= 1.0),
    }
}
