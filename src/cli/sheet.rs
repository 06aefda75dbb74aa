//! `terrell sheet`: a contact sheet of pictures.

use crate::error::{Error, Place, counted};
use crate::output::{Picture8, contact_sheet, write_png};
use clap::Args;
use image::RgbImage;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(super) struct SheetArgs {
    /// Pictures (PNG, JPEG, BMP), or folders of pictures, of which the middle one is shown
    #[arg(required = true, value_name = "PICTURE")]
    pictures: Vec<PathBuf>,
    /// Pictures in a row
    #[arg(long, value_name = "N", default_value = "6", value_parser = clap::value_parser!(u32).range(1..=100))]
    columns: u32,
    /// Pixels across each
    #[arg(long, value_name = "PIXELS", default_value = "200", value_parser = clap::value_parser!(u32).range(16..=2000))]
    width: u32,
    /// The file (PNG)
    #[arg(short, long, value_name = "FILE", default_value = "sheet.png")]
    out: PathBuf,
}

/// Most pixels of a sheet.
const MOST: u64 = 1 << 28;

pub(super) fn run(args: &SheetArgs) -> Result<(), Error> {
    if args.out.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("png")) {
        let hint = format!("--out {}", args.out.with_extension("png").display());
        return Err(Error::fault(Place::Command, "a sheet is a PNG file", hint));
    }
    let rows = (args.pictures.len() as u64).div_ceil(args.columns.into());
    if rows * u64::from(args.columns) * u64::from(args.width).pow(2) > MOST {
        let hint = format!("--width {}", (args.width / 4).max(16));
        return Err(Error::fault(Place::Command, "the sheet would be too large", hint));
    }
    let pictures = args.pictures.iter().map(|path| picture(path)).collect::<Result<Vec<_>, _>>()?;
    let sheet = contact_sheet(&pictures, args.columns, args.width);
    let (width, height) = sheet.dimensions();
    write_png(&args.out, &Picture8 { width, height, rgb: sheet.as_raw(), text: &[] })?;
    let shown = counted(pictures.len(), "picture", "pictures");
    super::print(&format!("{shown} in {}\n", args.out.display()))
}

/// A picture with its name: that of its folder, where a folder is meant.
fn picture(path: &Path) -> Result<(String, RgbImage), Error> {
    let file = if path.is_dir() { middle(path)? } else { path.to_owned() };
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    match image::open(&file) {
        Ok(picture) => Ok((name, picture.to_rgb8())),
        Err(why) => Err(Error::fault(Place::file(&file), why.to_string(), "name a picture (PNG, JPEG, BMP)")),
    }
}

/// The middle one of a folder's pictures; of those beside them (Doppler factors) none is one.
fn middle(folder: &Path) -> Result<PathBuf, Error> {
    let entries = folder.read_dir().map_err(|error| Error::machine(folder, "reading", error))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        name.strip_suffix(".png")
            .is_some_and(|name| !name.is_empty() && name.bytes().all(|one| one.is_ascii_digit()))
    });
    files.sort();
    let hint = "name pictures, or a folder that `terrell render` has written";
    let middle = files.len() / 2;
    (files.len() > middle)
        .then(|| files.swap_remove(middle))
        .ok_or_else(|| Error::fault(Place::file(folder), "there are no pictures in it", hint))
}
