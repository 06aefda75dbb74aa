//! The model files of a manifest, each read once, with a tree for each mesh.

use crate::error::{Error, Report, nearest_name};
use crate::import::{self, Asset};
use crate::manifest::{AssetRef, Body, Manifest, ModelFile, Worldline};
use crate::mesh::Mesh;
use crate::triangles::Triangles;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model file with the trees of its meshes.
pub(super) struct Model {
    pub(super) asset: Asset,
    pub(super) triangles: Vec<Arc<Triangles>>,
}

/// All model files, by path.
pub(super) struct Models(BTreeMap<PathBuf, Model>);

/// The nodes of a file that are wanted.
pub(super) enum Chosen {
    All,
    These(Vec<bool>),
}

impl Chosen {
    pub(super) fn contains(&self, node: usize) -> bool {
        match self {
            Self::All => true,
            Self::These(wanted) => wanted.get(node).copied().unwrap_or(false),
        }
    }
}

impl Models {
    /// Reads the files of all assets that bodies (or the observer) use, side by side.
    pub(super) fn load(manifest: &Manifest, manifest_path: &Path, report: &mut Report) -> Self {
        let camera = match &manifest.observer.worldline {
            Worldline::Camera(camera) => Some(&camera.asset.value),
            _ => None,
        };
        let mut files: Vec<&Path> = manifest
            .bodies
            .iter()
            .map(|body| &body.asset.value)
            .chain(camera)
            .filter_map(|asset| Some(manifest.assets.get(asset)?.file()?.file.value.as_path()))
            .collect();
        files.sort_unstable();
        files.dedup();
        let (there, absent): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| file.exists());
        let files = there;
        for file in absent {
            report.inputs.depend(file);
            missing(file, manifest, report);
        }
        let folder = manifest_path.parent().unwrap_or(Path::new(""));
        let read: Vec<Result<Model, Error>> =
            files.par_iter().map(|file| Model::load(file, trusted_folder(file, folder))).collect();
        let mut models = BTreeMap::new();
        for (file, model) in files.into_iter().zip(read) {
            match model {
                Ok(model) => {
                    report.warnings.extend(model.asset.warnings.iter().cloned());
                    report.inputs.extend(model.asset.inputs.clone());
                    models.insert(file.to_owned(), model);
                }
                Err(error) => {
                    report.inputs.depend(file);
                    match error {
                        Error::Input(faults) => report.faults.extend(faults),
                        error => report.fault(crate::error::Place::file(file), error.to_string(), ""),
                    }
                }
            }
        }
        Self(models)
    }

    /// What is in a file.
    pub(super) fn asset(&self, file: &Path) -> Option<&Asset> {
        self.get(file).map(|model| &model.asset)
    }

    fn get(&self, file: &Path) -> Option<&Model> {
        self.0.get(file)
    }

    /// What a body is made of.
    pub(super) fn of<'a>(
        &'a self,
        manifest: &'a Manifest,
        body: &Body,
    ) -> Option<(&'a ModelFile, &'a Model)> {
        let reference = manifest.assets.get(&body.asset.value)?.file()?;
        Some((reference, self.get(&reference.file.value)?))
    }

    /// The nodes that each asset takes of its file.
    pub(super) fn chosen(&self, manifest: &Manifest, report: &mut Report) -> BTreeMap<String, Chosen> {
        let mut read = |(name, reference): (&String, &AssetRef)| {
            let reference = reference.file()?;
            let model = self.get(&reference.file.value)?;
            Some((name.clone(), Chosen::of(reference, &model.asset, report)))
        };
        manifest.assets.iter().filter_map(&mut read).collect()
    }
}

impl Chosen {
    /// All nodes of a file, or one with what hangs on it.
    fn of(reference: &ModelFile, asset: &Asset, report: &mut Report) -> Self {
        let Some(name) = &reference.node else { return Self::All };
        let mut wanted = vec![false; asset.nodes.len()];
        for (i, node) in asset.nodes.iter().enumerate() {
            // Parents come before their children.
            wanted[i] = node.name == name.value || node.parent.is_some_and(|parent| wanted[parent]);
        }
        if !wanted.contains(&true) {
            let known = asset.nodes.iter().map(|node| node.name.as_str()).filter(|name| !name.is_empty());
            let hint = match nearest_name(&name.value, known) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => format!("`terrell inspect {}` lists its nodes", asset.path.display()),
            };
            let what = format!("`{}` has no node named `{}`", asset.path.display(), name.value);
            report.fault(name.place.clone(), what, hint);
        }
        Self::These(wanted)
    }
}

impl Model {
    fn load(file: &Path, root: &Path) -> Result<Self, Error> {
        let tree = |mesh: &Arc<Mesh>| Arc::new(Triangles::new(mesh.clone()));
        let trees = |meshes: &[Arc<Mesh>]| meshes.par_iter().map(tree).collect();
        import::load_with(file, root, trees).map(|(asset, triangles)| Self { asset, triangles })
    }
}

/// The folder outside of which a model file may name no other: the manifest's, or the model's own where the
/// manifest itself names a model elsewhere.
fn trusted_folder<'a>(model: &'a Path, manifest_folder: &'a Path) -> &'a Path {
    let real = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        path.canonicalize().ok()
    };
    match (real(model), real(manifest_folder)) {
        (Some(inner), Some(outer)) if inner.starts_with(&outer) => manifest_folder,
        _ => model.parent().unwrap_or(Path::new("")),
    }
}

/// Reports a model file that is not there, where the manifest names it.
fn missing(file: &Path, manifest: &Manifest, report: &mut Report) {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let there: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let hint = match nearest_name(&name, there.iter().map(String::as_str)) {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => "paths are relative to the manifest's folder".to_owned(),
    };
    for reference in
        manifest.assets.values().filter_map(AssetRef::file).filter(|reference| reference.file.value == file)
    {
        let what = format!("there is no file `{}`", file.display());
        report.fault(reference.file.place.clone(), what, hint.clone());
    }
}
