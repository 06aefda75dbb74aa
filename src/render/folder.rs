//! The folder of a film: which of its pictures are there already, and that nobody else writes into it.
//!
//! The pictures are their own ledger. Each appears under its name when it is whole, with the film's fingerprint in it; what
//! has the fingerprint is kept, and what has another is never mixed with it.

use super::{Step, files};
use crate::error::{Error, Fault, Place};
use crate::output;
use crate::plan::{Exposure, Fingerprint, Picture, Plan};
use crate::stop::Stop;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs::{File, OpenOptions, TryLockError};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The file that is locked while a film is rendered into the folder.
const LOCK: &str = ".terrell.lock";

/// The keywords under which pictures have the fingerprint and their number.
pub(super) const FINGERPRINT: &str = "Fingerprint";
pub(super) const EXPOSURE: &str = "Exposure";

/// A folder that is this process's alone until it is dropped.
#[derive(Debug)]
pub(super) struct Folder {
    /// The numbers of those exposures whose pictures are there.
    pub(super) kept: BTreeSet<usize>,
    _lock: Option<Lock>,
}

/// Makes the folder ready for some exposures of the film.
///
/// Faults: pictures of another film that are there, unless the plan says to begin anew, and pictures that are not from here.
///
/// None if it was stopped while another process was waited for.
pub(super) fn open(
    plan: &Plan,
    chosen: &Range<usize>,
    stop: &Stop,
    tell: &mut impl FnMut(Step),
) -> Result<Option<Folder>, Error> {
    output::make_folder(&plan.folder)?;
    let own = plan.fingerprint();
    if let Some(own) = &own {
        // Before waiting, and again when nobody else writes.
        refuse_others(plan, own, &there(plan)?)?;
    }
    let lock = lock(plan, stop, tell)?;
    if stop.is_set() {
        return Ok(None);
    }
    if lock.is_some() {
        output::remove_parts(&plan.folder, |name| {
            picture(name).is_some() || plan.film_files.iter().any(|film| film == name)
        });
    }
    let there = there(plan)?;
    let mut kept = BTreeSet::new();
    if let Some(own) = &own {
        refuse_others(plan, own, &there)?;
    }
    if let Some(own) = own.as_ref().filter(|_| !plan.restart) {
        let ours = there.iter().filter(|one| chosen.contains(&one.index) && one.is_of(plan, own));
        let named: BTreeSet<(usize, Picture)> = ours.map(|one| (one.index, one.picture)).collect();
        let texted: Vec<Picture> =
            plan.outputs.pictures.iter().copied().filter(|one| has_texts(*one)).collect();
        let complete = |index: &usize| texted.iter().all(|picture| named.contains(&(*index, *picture)));
        let complete: Vec<usize> = chosen.clone().filter(complete).collect();
        kept = complete.into_par_iter().filter(|index| files::are_whole(plan, *index)).collect();
    } else if chosen.len() == plan.exposures.len() {
        remove_others(own.as_ref(), &there)?;
    }
    Ok(Some(Folder { kept, _lock: lock }))
}

/// Held while a film is rendered. Nothing is written into it: it says by being locked.
#[derive(Debug)]
struct Lock {
    path: PathBuf,
    file: File,
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Before it is unlocked: whoever waits for it looks whether it is still there. Where that cannot be told it stays.
        if cfg!(unix) && is_at(&self.file, &self.path) {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// Whether an open file is the one at a path (elsewhere than on Unix nobody removes it).
fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let known = |about: std::fs::Metadata| (about.dev(), about.ino());
        match (file.metadata().map(known), path.symlink_metadata().map(known)) {
            (Ok(file), Ok(path)) => file == path,
            _ => false,
        }
    }
    #[cfg(not(unix))]
    {
        let _ = (file, path);
        true
    }
}

/// How often it is tried again to lock what another process has locked.
const BETWEEN_TRIES: Duration = Duration::from_millis(50);

/// Waits until no other process renders into the folder. None where the disk knows no locks, or if it was stopped.
fn lock(plan: &Plan, stop: &Stop, tell: &mut impl FnMut(Step)) -> Result<Option<Lock>, Error> {
    let path = plan.folder.join(LOCK);
    if path.symlink_metadata().is_ok_and(|about| !about.is_file()) {
        let what = format!("`{LOCK}` is there, and is no file");
        return Err(Fault::new(Place::file(&plan.folder), what, "remove it, or --out FOLDER").into());
    }
    let mut told = false;
    while !stop.is_set() {
        let wrong = |doing: &str, source| Error::machine(&path, doing, source);
        let open = OpenOptions::new().create(true).truncate(false).write(true).open(&path);
        let file = open.map_err(|source| wrong("opening", source))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                if !told {
                    tell(Step::Waiting(plan.folder.clone()));
                }
                told = true;
                std::thread::sleep(BETWEEN_TRIES);
                continue;
            }
            Err(TryLockError::Error(_)) => {
                tell(Step::Unlocked(plan.folder.clone()));
                return Ok(None);
            }
        }
        // The process that was waited for has removed it, and another one may be there now.
        if is_at(&file, &path) {
            return Ok(Some(Lock { path, file }));
        }
    }
    Ok(None)
}

/// A file with the name of a picture.
struct There {
    index: usize,
    picture: Picture,
    path: PathBuf,
    // None for what this program has not made.
    fingerprint: Option<Fingerprint>,
    exposure: Option<usize>,
}

impl There {
    /// Whether it is a file of its exposure of this film.
    fn is_of(&self, plan: &Plan, own: &Fingerprint) -> bool {
        self.fingerprint.as_ref() == Some(own)
            && self.exposure == Some(self.index)
            && self.path == plan.picture(self.index, self.picture)
    }
}

/// Whether such a file says whose it is. (What does not is compared with what does.)
fn has_texts(picture: Picture) -> bool {
    picture != Picture::Bmp
}

/// The number and the kind of a file that has the name of a picture.
fn picture(name: &str) -> Option<(usize, Picture)> {
    let (digits, ending) = name.split_once('.')?;
    let picture = Picture::ALL.into_iter().find(|picture| picture.ending() == ending)?;
    let is_number = digits.len() >= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { digits.parse().ok().map(|number| (number, picture)) } else { None }
}

/// All files with names of pictures; empty ones are what a loss of power leaves.
fn there(plan: &Plan) -> Result<Vec<There>, Error> {
    let wrong = |source| Error::machine(&plan.folder, "looking what is there", source);
    let mut there = Vec::new();
    for entry in std::fs::read_dir(&plan.folder).map_err(wrong)? {
        let path = entry.map_err(wrong)?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let Some((index, picture)) = picture(&name).filter(|(_, picture)| has_texts(*picture)) else {
            continue;
        };
        if path.metadata().is_ok_and(|about| about.is_file() && about.len() > 0) {
            let texts = files::texts(&path, picture);
            let fingerprint = texts.get(FINGERPRINT).and_then(|text| Fingerprint::parse(text));
            let exposure = texts.get(EXPOSURE).and_then(|text| text.parse().ok());
            there.push(There { index, picture, path, fingerprint, exposure });
        }
    }
    // What is looked at first is told first.
    there.sort_by(|a, b| (a.index, b.picture, &a.path).cmp(&(b.index, a.picture, &b.path)));
    Ok(there)
}

/// How many of the pictures of these exposures are there.
pub(super) fn count(plan: &Plan, exposures: &[Exposure]) -> usize {
    exposures.iter().filter(|exposure| plan.picture(exposure.index, Picture::Png).is_file()).count()
}

/// A fault if pictures of another film are there; if it is begun anew, only of what this program has not made.
fn refuse_others(plan: &Plan, own: &Fingerprint, there: &[There]) -> Result<(), Error> {
    let film: BTreeSet<PathBuf> = plan
        .exposures
        .iter()
        .flat_map(|exposure| {
            plan.outputs.pictures.iter().copied().map(|one| plan.picture(exposure.index, one))
        })
        .collect();
    let other = there.iter().find(|one| match &one.fingerprint {
        Some(other) => other != own && !plan.restart,
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
    let hint = match &other.fingerprint {
        None => "remove it, or --out FOLDER",
        Some(_) => "--restart renders all anew; --out FOLDER leaves what is there as it is",
    };
    Err(Fault::new(Place::file(&plan.folder), why, hint).into())
}

/// Removes pictures of other films that would be left among those of this one.
fn remove_others(own: Option<&Fingerprint>, there: &[There]) -> Result<(), Error> {
    for one in there.iter().filter(|one| one.fingerprint.is_some() && one.fingerprint.as_ref() != own) {
        let removed = std::fs::remove_file(&one.path);
        removed.map_err(|source| Error::machine(&one.path, "removing a picture of another film", source))?;
        if one.picture == Picture::Png {
            // What says nothing of itself goes with it, if it is there.
            let _ = std::fs::remove_file(one.path.with_extension(Picture::Bmp.ending()));
        }
    }
    Ok(())
}
