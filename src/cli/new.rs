//! `terrell new`: a manifest to begin with, for any model.

use crate::error::{Error, Place};
use crate::import;
use crate::output::write_whole;
use crate::starter::{Motion, starter};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// The model file (.glb, .gltf, .obj)
    model: PathBuf,
    /// The observer flies past it (unless said)
    #[arg(long, conflicts_with = "turntable")]
    flyby: bool,
    /// The observer circles it
    #[arg(long)]
    turntable: bool,
    /// The manifest to be written, instead of one in the working folder that is named after the model
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write it over one that is there
    #[arg(long)]
    force: bool,
}

/// Writes a manifest.
pub(super) fn run(args: &NewArgs) -> Result<(), Error> {
    let (motion, word, shows) = if args.turntable {
        (Motion::Turntable, "turntable", "--exposure 0 shows its beginning")
    } else {
        (Motion::Flyby, "flyby", "--exposure 48 shows its middle")
    };
    let stem = args.model.file_stem().map_or_else(|| "model".into(), |stem| stem.to_string_lossy());
    let file = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{stem}-{word}.yaml")));
    if file.exists() && !args.force {
        // What is wrong with the model is told first.
        import::load(&args.model, args.model.parent().unwrap_or(Path::new("")))?;
        let hint = "--force writes over it, -o FILE writes another";
        return Err(Error::fault(Place::file(&file), "this file is there already", hint));
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Error::fault(Place::file(folder), "there is no such folder", "make it first"));
    }
    let text = starter(&args.model, &file, motion)?;
    write_whole(&file, |to| to.write_all(text.as_bytes()))?;
    let file = file.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "-_./\\:".contains(c);
    let typed = if file.chars().all(is_plain) { file.clone() } else { format!("\"{file}\"") };
    super::print(&format!(
        "{file} is written. terrell render {typed} {shows}; terrell render {typed} makes the film.\n"
    ))
}
