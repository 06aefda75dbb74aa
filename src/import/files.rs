//! The importers' only door to the disk: what may be read, and how much.
//!
//! A model file comes from anywhere, so the names in it are not trusted. Nothing outside of one folder is
//! read, whether it is named by `..`, by an absolute path, by a URL or through a link; and what is read or
//! made from it in memory is counted against one limit, so that no file can ask for more than the machine
//! has.

use crate::error::{Error, Fault, Place};
use crate::inputs::Inputs;
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// The most bytes that one asset may take: files as read, plus numbers and pictures as decoded.
const MEMORY_LIMIT: u64 = 8 << 30;

/// Why something cannot be had; becomes a fault once its place is known.
#[derive(Debug)]
pub(super) struct Refusal {
    /// There is no such file (and nothing else is wrong).
    pub missing: bool,
    /// What is wrong.
    pub what: String,
    /// What to do about it.
    pub hint: String,
}

impl Refusal {
    /// Something wrong with a hint.
    pub(super) fn new(what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { missing: false, what: what.into(), hint: hint.into() }
    }

    /// The fault at its place.
    pub(super) fn at(self, place: Place) -> Fault {
        Fault::new(place, self.what, self.hint)
    }
}

/// The folder that may be read and what is left of the memory limit.
#[derive(Debug, Clone)]
pub(super) struct Files {
    /// Without links.
    root: PathBuf,
    /// Shared by all who read the asset at the same time.
    left: Arc<AtomicU64>,
    /// What was read beside the model itself.
    pub(super) inputs: Inputs,
}

impl Files {
    /// Opens a model file inside of `root`; the folder it is in (without links) and its bytes.
    pub(super) fn open(model: &Path, root: &Path) -> Result<(Self, PathBuf, Vec<u8>), Error> {
        let real = |path: &Path| {
            let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
            path.canonicalize().map_err(|source| match source.kind() {
                std::io::ErrorKind::NotFound => {
                    Error::fault(Place::file(path), "there is no such file", "check the name and the folder")
                }
                _ => Error::machine(path, "looking for it", source),
            })
        };
        let mut files =
            Self { root: real(root)?, left: Arc::new(MEMORY_LIMIT.into()), inputs: Inputs::default() };
        let file = real(model)?;
        let at_model = |refusal: Refusal| Error::from(refusal.at(Place::file(model)));
        files.inside(&file).map_err(at_model)?;
        let bytes = files.bytes(&file).map_err(at_model)?;
        let folder = file.parent().map(Path::to_owned).unwrap_or_default();
        Ok((files, folder, bytes))
    }

    /// The file that a model in `folder` (without links) means by a relative `name`.
    pub(super) fn find(&self, folder: &Path, name: &str) -> Result<PathBuf, Refusal> {
        const HINT: &str = "put the file beside the model and name it relative to the model";
        let name = name.replace('\\', "/");
        if name.is_empty() || name.contains('\0') {
            return Err(Refusal::new("the name of a file is empty or has a zero in it", HINT));
        }
        if name.starts_with('/') {
            return Err(Refusal::new(format!("`{name}` is an absolute path"), HINT));
        }
        if let Some(scheme) = scheme(&name) {
            let what = format!("`{name}` is not a relative path: `{scheme}:` is not followed");
            return Err(Refusal::new(what, HINT));
        }
        let mut path = folder.to_owned();
        for component in Path::new(&name).components() {
            match component {
                Component::Normal(part) => path.push(part),
                Component::CurDir => {}
                Component::ParentDir if path != self.root && path.pop() => {}
                _ => return Err(Refusal::new(format!("`{name}` {}", self.leaves()), HINT)),
            }
        }
        let path = path.canonicalize().map_err(|source| Refusal {
            missing: true,
            what: format!("cannot find `{name}`: {source}"),
            hint: "the file belongs to the model: put it where the model expects it".into(),
        })?;
        self.inside(&path)?;
        Ok(path)
    }

    fn leaves(&self) -> String {
        format!("leaves the folder `{}`, outside of which nothing is read", self.root.display())
    }

    fn inside(&self, path: &Path) -> Result<(), Refusal> {
        if path.starts_with(&self.root) {
            return Ok(());
        }
        let what = format!("`{}` {}", path.display(), self.leaves());
        Err(Refusal::new(what, "copy the file into that folder"))
    }

    /// The bytes of a file found by [`Files::find`].
    pub(super) fn read(&mut self, path: &Path) -> Result<Vec<u8>, Refusal> {
        let bytes = self.bytes(path)?;
        self.inputs.add(path, &bytes);
        Ok(bytes)
    }

    fn bytes(&mut self, path: &Path) -> Result<Vec<u8>, Refusal> {
        let wrong = |what: String| Refusal::new(format!("cannot read `{}`: {what}", path.display()), "");
        let length = match path.metadata() {
            Ok(data) if data.is_file() => data.len(),
            Ok(_) => return Err(wrong("it is not a file".into())),
            Err(source) => return Err(wrong(source.to_string())),
        };
        self.take(length)?;
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(length as usize).map_err(|source| wrong(source.to_string()))?;
        let file = File::open(path).map_err(|source| wrong(source.to_string()))?;
        // The file may grow while it is read, but not past what was taken for it.
        file.take(length).read_to_end(&mut bytes).map_err(|source| wrong(source.to_string()))?;
        Ok(bytes)
    }

    /// Counts bytes about to be allocated.
    pub(super) fn take(&mut self, bytes: u64) -> Result<(), Refusal> {
        let taken = self.left.fetch_update(Relaxed, Relaxed, |left| left.checked_sub(bytes));
        taken.map(|_| ()).map_err(|left| {
            Refusal::new(
                format!("needs {bytes} bytes more, and {left} of {MEMORY_LIMIT} are left"),
                "split the model, or make its pictures smaller",
            )
        })
    }
}

/// The scheme of a URL, or the drive letter of a path of Windows.
pub(super) fn scheme(name: &str) -> Option<&str> {
    let (scheme, _) = name.split_once(':')?;
    let starts = scheme.starts_with(|c: char| c.is_ascii_alphabetic());
    let rest = scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+.-".contains(c));
    (starts && rest).then_some(scheme)
}
