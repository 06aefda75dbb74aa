//! What a film is made of: what the manifest says, and the files that it reads. By that a film is known again.

use sha2::{Digest as _, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The SHA-256 of something.
pub type Digest = [u8; 32];

/// The digest of some bytes.
pub fn digest(bytes: impl AsRef<[u8]>) -> Digest {
    Sha256::digest(bytes).into()
}

/// What was read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Inputs {
    /// What the manifest says that concerns its pictures, however it is written; flags included.
    pub manifest: Option<Digest>,
    /// The manifests that it extends: what they say of the pictures is in `manifest`.
    pub bases: BTreeSet<PathBuf>,
    /// The contents of all other files.
    pub files: BTreeMap<PathBuf, Digest>,
    /// Files on which it depends otherwise: bases of the manifest, and what could not be read.
    pub others: BTreeSet<PathBuf>,
}

impl Inputs {
    /// Takes note of a file.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) {
        self.files.insert(path.to_owned(), digest(bytes));
    }

    /// Takes note of a file whose contents are known otherwise, or not at all.
    pub fn depend(&mut self, path: &Path) {
        self.others.insert(path.to_owned());
    }

    /// Takes over what was read elsewhere.
    pub fn extend(&mut self, other: Self) {
        self.manifest = self.manifest.or(other.manifest);
        self.bases.extend(other.bases);
        self.files.extend(other.files);
        self.others.extend(other.others);
    }

    /// The digest of all files with their names, wherever the folder is that they are in.
    pub fn of_files(&self) -> Digest {
        let mut folder = self.files.keys().next().and_then(|path| path.parent()).unwrap_or(Path::new(""));
        for path in self.files.keys() {
            while !path.starts_with(folder) {
                folder = folder.parent().unwrap_or(Path::new(""));
            }
        }
        let named = |(path, content): (&PathBuf, &Digest)| {
            let name = path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/");
            [digest(name), *content]
        };
        digest(self.files.iter().flat_map(named).flatten().collect::<Vec<u8>>())
    }
}
