//! `terrell render --watch`: again, whenever the manifest or a file that it reads is saved.
//!
//! Files are looked at a few times a second, by length and time of change. That also sees what editors do that write a new
//! file and rename it, works on disks of other machines, and needs no library.

use super::{RenderArgs, signals};
use crate::error::{Error, Report};
use crate::stop::Stop;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// How often files are looked at.
const BETWEEN_LOOKS: Duration = Duration::from_millis(200);

/// Renders a manifest, and again whenever something of it is saved.
pub(super) fn run(path: &Path, changes: &[(String, String)], args: &RenderArgs) -> Result<(), Error> {
    let mut rendered = None;
    let say = super::say;
    signals::gently(|signal| {
        let done = rounds(path, signal, &say, |stop, files| {
            let mut report = Report::default();
            let ready = super::prepared(path, changes, args, &mut report);
            files(&report, ready.is_none());
            say(&super::warnings(&report.warnings));
            let (scene, mut plan) = report.finish(ready)?;
            // What was rendered here before is a picture of how things were; what others have left there stays.
            let fingerprint = plan.fingerprint();
            plan.restart |= rendered.as_ref().is_some_and(|before| *before != fingerprint);
            let done = super::render_ready(&scene, &plan, args, stop);
            if matches!(done, Ok(()) | Err(Error::Stopped { .. })) {
                rendered = Some(fingerprint);
            }
            done?;
            say(&waiting(path));
            Ok(())
        });
        match done {
            Ok(()) => Err(Error::Stopped { there: format!("{} is not watched any more", path.display()) }),
            Err(error) => Err(error),
        }
    })
}

/// What is said while nothing is done.
fn waiting(manifest: &Path) -> String {
    format!("waiting until {} or a file that it reads is saved: Ctrl-C ends this\n", manifest.display())
}

/// What is seen of a file without reading it; none if it is not there.
type Stamp = Option<(u64, Option<SystemTime>)>;

fn stamp(path: &Path) -> Stamp {
    let about = path.metadata().ok()?;
    Some((about.len(), about.modified().ok()))
}

/// Files, and what was seen of them last.
#[derive(Debug, Default)]
struct Files(Mutex<BTreeMap<PathBuf, Stamp>>);

impl Files {
    fn stamps(&self) -> std::sync::MutexGuard<'_, BTreeMap<PathBuf, Stamp>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether one of them is no longer what it was.
    fn have_changed(&self) -> bool {
        self.stamps().iter().any(|(path, seen)| stamp(path) != *seen)
    }

    /// Waits until nobody writes any more, and takes them as they are.
    fn settle(&self) {
        loop {
            let now: BTreeMap<PathBuf, Stamp> =
                self.stamps().keys().map(|path| (path.clone(), stamp(path))).collect();
            let same = now == *self.stamps();
            *self.stamps() = now;
            if same {
                return;
            }
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    /// Looks at these files as well, and at folders if there are any. What was saved since `began`, when reading began, counts as
    /// changed. (A file that was read before and now is not may be about to be written.)
    fn look_at(&self, paths: BTreeSet<PathBuf>, began: SystemTime) {
        let saved_since = |seen: &Stamp| {
            let saved = (*seen).and_then(|(_, saved)| saved);
            saved.is_some_and(|saved| saved > began && saved <= SystemTime::now())
        };
        let mut stamps = self.stamps();
        stamps.retain(|path, _| paths.contains(path) || !path.is_dir());
        for path in paths {
            let seen = stamp(&path);
            stamps.entry(path).or_insert(if saved_since(&seen) { None } else { seen });
        }
    }
}

/// What to look at: all that was read; and, if something is missing, the folders in which it may appear.
fn read(manifest: &Path, report: &Report, failed: bool) -> BTreeSet<PathBuf> {
    let files = || report.inputs.files.keys().chain(&report.inputs.others);
    let folders = files().filter(|_| failed).filter_map(|path| path.parent());
    files().cloned().chain(folders.map(Path::to_owned)).chain([manifest.to_owned()]).collect()
}

/// Is told what has been read, and whether there were faults.
pub(super) type FilesRead<'f> = dyn FnMut(&Report, bool) + 'f;

/// Does a round of work whenever something is saved, until it is stopped; a round that is under way then is stopped, too. The work
/// tells what it has read, and whether it failed for that.
pub(super) fn rounds(
    manifest: &Path,
    stop: &Stop,
    say: &dyn Fn(&str),
    mut work: impl FnMut(&Stop, &mut FilesRead<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let files = Files::default();
    files.look_at([manifest.to_owned()].into(), SystemTime::now());
    let changed = Arc::new(AtomicBool::new(false));
    let ended = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !ended.load(SeqCst) {
                if files.have_changed() {
                    changed.store(true, SeqCst);
                }
                std::thread::sleep(BETWEEN_LOOKS);
            }
        });
        let mut said = String::new();
        let done = loop {
            files.settle();
            changed.store(false, SeqCst);
            let began = SystemTime::now();
            let until = stop.clone().or(changed.clone());
            let mut files_read = |report: &Report, failed: bool| {
                files.look_at(read(manifest, report, failed), began);
            };
            let done = work(&until, &mut files_read);
            if stop.is_set() {
                break done;
            }
            match done {
                Ok(()) => said.clear(),
                Err(Error::Stopped { .. }) => continue,
                Err(error) => {
                    // The same is not said twice: something else in the folder may have changed.
                    let text = super::complaint(&error);
                    if text != said {
                        say(&text);
                        say(&waiting(manifest));
                        said = text;
                    }
                }
            }
            while !changed.load(SeqCst) && !stop.is_set() {
                std::thread::sleep(BETWEEN_LOOKS / 10);
            }
            if stop.is_set() {
                break Ok(());
            }
        };
        ended.store(true, SeqCst);
        done
    })
}
