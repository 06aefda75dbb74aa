//! Finished pictures to files: PNG and BMP to look at, `OpenEXR` to compute with, MP4, GIF and AVI to play.
//!
//! Everything here takes plain numbers and knows nothing of scenes. A file appears under its name whole or
//! not at all, so a render that was stopped can be resumed by looking at which files are there; and the same
//! numbers give the same bytes.

mod avi;
mod bmp;
mod exr;
mod false_color;
mod film;
mod font;
mod gif;
pub mod movie;
#[cfg(feature = "video")]
mod mp4;
mod palette;
mod png;
#[cfg(feature = "video")]
mod reel;
mod sheet;
#[cfg(feature = "video")]
mod yuv;

pub use self::avi::Avi;
pub use self::bmp::{read_bmp, write_bmp};
pub use self::exr::{Channel, ExrForm, Measured, check_exr, exr_texts, write_exr};
pub use self::false_color::{Scale, false_color, height_with_legend};
pub use self::film::{FilmKind, Making, Refusal, Refused};
pub use self::gif::Gif;
pub use self::movie::Movie;
pub use self::png::{Picture8, Picture16, ReadPng, eight_of, png_texts, read_png, write_png, write_png16};
pub use self::sheet::contact_sheet;

use crate::error::{Error, Place};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes a file so that it is there whole or not at all.
///
/// `write` fills a file of a temporary name in the same folder (which is made if it is missing); that is
/// flushed, handed to the disk and given its name last. If anything fails, the temporary file is removed and
/// a file that stood under the name before is left as it was.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Error> {
    let (temporary, file) = Temporary::beside(path)?;
    fill(file, write)
        .and_then(|()| fs::rename(&temporary.path, path))
        .map_err(|source| Error::machine(path, "writing", source))?;
    temporary.keep();
    // So that its name is on the disk too. Where folders cannot be opened, that is so anyway, or cannot be helped.
    let _ = path.parent().map(File::open).map(|folder| folder.and_then(|folder| folder.sync_all()));
    Ok(())
}

/// Makes a folder if it is not there. A fault where a file has its name.
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    if folder.is_file() {
        let what = "the pictures cannot go there: this is a file, not a folder";
        return Err(Error::fault(
            Place::file(folder),
            what,
            "--out FOLDER, the name of a folder, new or not",
        ));
    }
    fs::create_dir_all(folder).map_err(|source| Error::machine(folder, "creating the folder", source))
}

/// Removes what a process that was killed has left of files of these names. (Nobody may be writing them.)
pub fn remove_parts(folder: &Path, of: impl Fn(&str) -> bool) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let hidden = name.strip_prefix('.').and_then(|name| name.strip_suffix(".part"));
        // The number of the process, and that of the file.
        if hidden.and_then(|name| name.rsplit_once('.')).is_some_and(|(name, _)| of(name)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn fill(file: File, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, file);
    write(&mut writer)?;
    writer.flush()?;
    writer.get_ref().sync_all()
}

/// The file name of one exposure of a film of `count`, counted from zero: `0012.png`. All names of a film
/// have equally many digits, at least four, so that they sort and `%04d` finds them.
pub fn exposure_name(index: usize, count: usize) -> String {
    let digits = count.max(index).to_string().len().max(4);
    format!("{index:0digits$}.png")
}

/// A file of a passing name, removed when dropped.
#[derive(Debug)]
struct Temporary {
    path: PathBuf,
}

impl Temporary {
    /// A new, empty file in the folder of `path`, open for reading and writing.
    fn beside(path: &Path) -> Result<(Self, File), Error> {
        static SERIAL: AtomicU32 = AtomicU32::new(0);
        let name = path.file_name().ok_or_else(|| {
            Error::machine(path, "writing", io::Error::new(io::ErrorKind::InvalidInput, "this names no file"))
        })?;
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder)
                .map_err(|source| Error::machine(folder, "creating the folder", source))?;
        }
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{}.part", std::process::id(), SERIAL.fetch_add(1, Ordering::Relaxed)));
        let hidden = path.with_file_name(hidden);
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(true)
            .open(&hidden)
            .map_err(|source| Error::machine(path, "writing", source))?;
        Ok((Self { path: hidden }, file))
    }

    /// The file has been given its final name: nothing is left to remove.
    fn keep(mut self) {
        self.path = PathBuf::new();
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.path.as_os_str().is_empty() {
            // Nothing can be done about a failure here, and the error that led here is the one to tell.
            let _ = fs::remove_file(&self.path);
        }
    }
}
