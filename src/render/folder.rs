//! The folder of a film: which of its pictures are there already, and that nobody else writes into it.
//!
//! The pictures are their own ledger. Each appears under its name when it is whole, with the film's fingerprint in it; what
//! has the fingerprint is kept, and what has another is never mixed with it.

use super::Step;
use crate::error::{Error, Fault, Place};
use crate::output::{self, exposure_name};
use crate::plan::{Fingerprint, Plan};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::Write;
use std::ops::Range;
use std::path::PathBuf;

/// The file that is locked while a film is rendered into the folder.
const LOCK: &str = ".terrell.lock";

/// The keyword under which pictures have the fingerprint.
pub(super) const KEYWORD: &str = "Fingerprint";

/// A folder that is this process's alone until it is dropped.
#[derive(Debug)]
pub(super) struct Folder {
    /// The numbers of those exposures whose pictures are there.
    pub(super) kept: BTreeSet<usize>,
    _lock: Option<Lock>,
}

/// Makes the folder ready for some exposures of the film.
///
/// Faults: pictures of another film that are there, unless the plan says to begin anew.
pub(super) fn open(plan: &Plan, chosen: &Range<usize>, tell: &mut impl FnMut(Step)) -> Result<Folder, Error> {
    std::fs::create_dir_all(&plan.folder)
        .map_err(|source| Error::machine(&plan.folder, "creating the folder", source))?;
    let lock = lock(plan, tell)?;
    output::remove_parts(&plan.folder, |name| number(name).is_some() || name == plan.film_file);
    let there = there(plan);
    let kept = match plan.fingerprint() {
        Some(own) if !plan.restart => {
            refuse_others(plan, &own, &there)?;
            let ours = there.into_par_iter().filter(|one| one.fingerprint.as_ref() == Some(&own));
            ours.filter(|one| chosen.contains(&one.index) && is_whole(plan, one.index))
                .map(|one| one.index)
                .collect()
        }
        own => {
            if chosen.len() == plan.exposures.len() {
                remove_others(own.as_ref(), &there)?;
            }
            BTreeSet::new()
        }
    };
    Ok(Folder { kept, _lock: lock })
}

/// Held while a film is rendered.
#[derive(Debug)]
struct Lock {
    path: PathBuf,
    _file: File,
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Before it is unlocked; whoever waits for it looks whether it is still there.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Waits until no other process renders into the folder. None where the disk knows no locks.
fn lock(plan: &Plan, tell: &mut impl FnMut(Step)) -> Result<Option<Lock>, Error> {
    let path = plan.folder.join(LOCK);
    let wrong = |source| Error::machine(&path, "opening", source);
    let own = std::process::id().to_string();
    loop {
        let mut file =
            OpenOptions::new().create(true).truncate(false).write(true).open(&path).map_err(wrong)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                tell(Step::Waiting(plan.folder.clone()));
                file.lock().map_err(wrong)?;
            }
            Err(TryLockError::Error(_)) => return Ok(None),
        }
        // It may have been removed by the process that was waited for, and another one be there now.
        file.set_len(0).and_then(|()| file.write_all(own.as_bytes())).map_err(wrong)?;
        if std::fs::read_to_string(&path).is_ok_and(|there| there == own) {
            return Ok(Some(Lock { path, _file: file }));
        }
    }
}

/// A file with the name of a picture.
struct There {
    index: usize,
    path: PathBuf,
    // None for what this program has not made.
    fingerprint: Option<Fingerprint>,
}

/// The number that is the name of a picture, or of a file beside it.
fn number(name: &str) -> Option<usize> {
    let (digits, extension) = name.split_once('.')?;
    let is_number = digits.len() >= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
    if is_number && matches!(extension, "png" | "exr") { digits.parse().ok() } else { None }
}

fn there(plan: &Plan) -> Vec<There> {
    let mut there = Vec::new();
    for entry in std::fs::read_dir(&plan.folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "png")
            && let Some(index) = number(&entry.file_name().to_string_lossy())
        {
            let fingerprint = output::png_text(&path, KEYWORD);
            there.push(There {
                index,
                path,
                fingerprint: fingerprint.and_then(|text| Fingerprint::parse(&text)),
            });
        }
    }
    there.sort_by(|a, b| a.path.cmp(&b.path));
    there
}

/// The picture of an exposure.
pub(super) fn picture(plan: &Plan, index: usize) -> PathBuf {
    plan.folder.join(exposure_name(index, plan.exposures.len()))
}

/// Whether the picture of an exposure, and what belongs to it, can be read.
fn is_whole(plan: &Plan, index: usize) -> bool {
    let path = picture(plan, index);
    let size = (plan.sampling.width, plan.sampling.height);
    output::read_png(&path, size).is_ok() && (!plan.exr || path.with_extension("exr").exists())
}

/// A fault if pictures of another film are there.
fn refuse_others(plan: &Plan, own: &Fingerprint, there: &[There]) -> Result<(), Error> {
    let film: BTreeSet<PathBuf> =
        plan.exposures.iter().map(|exposure| picture(plan, exposure.index)).collect();
    let other = there.iter().find(|one| match &one.fingerprint {
        Some(other) => other != own,
        None => film.contains(&one.path),
    });
    let Some(other) = other else { return Ok(()) };
    let name = other.path.file_name().unwrap_or_default().display();
    let why = match &other.fingerprint {
        None => format!("`{name}` is there, and is not from here"),
        Some(other) => {
            let changes = [
                (other.version != own.version, format!("another version ({}) was used", other.version)),
                (other.manifest != own.manifest, "the manifest, or a flag, is another".to_owned()),
                (other.files != own.files, "a file that it reads has changed".to_owned()),
            ];
            let changes: Vec<String> =
                changes.into_iter().filter(|(is, _)| *is).map(|(_, change)| change).collect();
            format!("`{name}` is a picture of another film: {}", changes.join(", and "))
        }
    };
    let hint = "--restart renders all anew; --out FOLDER leaves what is there as it is";
    Err(Fault::new(Place::file(&plan.folder), why, hint).into())
}

/// Removes pictures of other films that would be left among those of this one.
fn remove_others(own: Option<&Fingerprint>, there: &[There]) -> Result<(), Error> {
    for one in there.iter().filter(|one| one.fingerprint.is_some() && one.fingerprint.as_ref() != own) {
        let removed = std::fs::remove_file(&one.path);
        removed.map_err(|source| Error::machine(&one.path, "removing a picture of another film", source))?;
        // If it has one.
        let _ = std::fs::remove_file(one.path.with_extension("exr"));
    }
    Ok(())
}
