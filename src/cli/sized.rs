//! `--size` and `--scale`: how large the pictures are, whatever the manifest says.

use crate::error::{Error, Place, Report};
use crate::manifest::{self, Manifest};
use std::path::Path;

/// The change that `--size` asks for.
pub(super) fn size_change(size: Option<&str>) -> Result<Option<(String, String)>, Error> {
    let Some(size) = size else { return Ok(None) };
    let sides = size.split(['x', 'X', '×']).filter(|side| side.parse::<u32>().is_ok_and(|side| side > 0));
    if sides.count() != 2 {
        let what = format!("`--size {size}` is not a width and a height in pixels");
        return Err(Error::fault(Place::Command, what, "--size 1280x720"));
    }
    Ok(Some(("picture.size".to_owned(), size.replace(['x', 'X', '×'], " "))))
}

/// What `--scale` multiplies the sides by.
fn factor(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|scale: &f64| scale.is_finite() && *scale > 0.0)
}

/// Faults what is no scale.
pub(super) fn check_scale(scale: Option<&str>) -> Result<(), Error> {
    match scale.filter(|text| factor(text).is_none()) {
        Some(text) => {
            let what = format!("`--scale {text}` is not a number above zero");
            Err(Error::fault(Place::Command, what, "--scale 0.25"))
        }
        None => Ok(()),
    }
}

/// The changes with the one that a scale asks for. None if there is no scale, or the manifest has faults: they are told when it is
/// read.
pub(super) fn scaled(
    path: &Path,
    changes: &[(String, String)],
    scale: Option<&str>,
) -> Option<Vec<(String, String)>> {
    let scale = scale.and_then(factor)?;
    let manifest = manifest::load_with(path, changes, &mut Report::default())?;
    let (width, height) = scaled_size(&manifest, scale);
    let change = ("picture.size".to_owned(), format!("{width} {height}"));
    Some(changes.iter().cloned().chain([change]).collect())
}

/// The sides times the scale, rounded. What has two halves keeps them; a panorama keeps its shape.
fn scaled_size(manifest: &Manifest, scale: f64) -> (f64, f64) {
    let (width, height) = manifest.picture.size.value;
    let halves = manifest.eye_width() < width
        || manifest.observer.lens == manifest::Lens::Panorama && width == 2 * height;
    let parts = if halves { 2.0 } else { 1.0 };
    let side = |side: f64| (side * scale).round().max(1.0);
    (parts * side(f64::from(width) / parts), side(f64::from(height)))
}

/// What to type for a size that a hint says, `1280 720` and maybe another way out, where a flag said it.
pub(super) fn typed(size: &str, flag: &str) -> String {
    if flag == "--scale" && size == manifest::USUAL_SIZE {
        return "--scale 1".to_owned();
    }
    let (size, else_) = size.split_once(", or ").unwrap_or((size, ""));
    let instead = if flag == "--scale" { " in place of --scale" } else { "" };
    let no_film = if else_.is_empty() { "" } else { ", or --no-video for pictures alone" };
    format!("--size {}{instead}{no_film}", size.replace(' ', "x"))
}
