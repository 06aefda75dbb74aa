//! Contact sheets: many pictures on one, each with its name below.

use super::font::{HIGH, WIDE, dots};
use crate::color::{srgb_decode, srgb_encode};
use image::imageops::{FilterType, resize};
use image::{Rgb, Rgb32FImage, RgbImage};

/// Pixels between pictures.
const GAP: u32 = 6;
/// Rows below a picture, for its name.
const CAPTION: u32 = HIGH as u32 + 6;
const PAPER: Rgb<u8> = Rgb([20, 20, 20]);
const INK: Rgb<u8> = Rgb([230, 230, 230]);

/// Pictures with their names in rows of `columns`, each made to fit into `width` by three quarters of it. They are made
/// smaller by their light, not by the numbers that stand for it.
pub fn contact_sheet(pictures: &[(String, RgbImage)], columns: u32, width: u32) -> RgbImage {
    let (columns, width) = (columns.max(1), width.max(1));
    let height = (width * 3 / 4).max(1);
    let rows = u32::try_from(pictures.len()).unwrap_or(u32::MAX).div_ceil(columns);
    let size = (GAP + columns * (width + GAP), GAP + rows * (height + CAPTION + GAP));
    let mut sheet = RgbImage::from_pixel(size.0, size.1, PAPER);
    for (place, (name, picture)) in (0_u32..).zip(pictures) {
        let left = GAP + place % columns * (width + GAP);
        let top = GAP + place / columns * (height + CAPTION + GAP);
        let picture = fitted(picture, (width, height));
        let corner = (left + (width - picture.width()) / 2, top + (height - picture.height()) / 2);
        image::imageops::replace(&mut sheet, &picture, corner.0.into(), corner.1.into());
        let room = width as usize / WIDE;
        let caption: String = name.to_lowercase().chars().take(room).collect();
        let indent = (width as usize - caption.chars().count() * WIDE) / 2;
        for (column, row) in dots(&caption) {
            let at = (left + (indent + column) as u32, top + height + 3 + row as u32);
            if at.0 < sheet.width() && at.1 < sheet.height() {
                sheet.put_pixel(at.0, at.1, INK);
            }
        }
    }
    sheet
}

/// The same picture, as large as it can be within some columns and rows.
fn fitted(picture: &RgbImage, (width, height): (u32, u32)) -> RgbImage {
    let (across, down) = (f64::from(picture.width().max(1)), f64::from(picture.height().max(1)));
    let scale = (f64::from(width) / across).min(f64::from(height) / down);
    let of = |side: f64, most: u32| ((side * scale).round() as u32).clamp(1, most);
    let light = Rgb32FImage::from_fn(picture.width(), picture.height(), |column, row| {
        Rgb(picture.get_pixel(column, row).0.map(|value| srgb_decode(f64::from(value) / 255.0) as f32))
    });
    let small = resize(&light, of(across, width), of(down, height), FilterType::Triangle);
    RgbImage::from_fn(small.width(), small.height(), |column, row| {
        let shown = |light: f32| (srgb_encode(f64::from(light)) * 255.0).round().clamp(0.0, 255.0) as u8;
        Rgb(small.get_pixel(column, row).0.map(shown))
    })
}
