//! A model file, as written, becomes an [`Asset`]: meshes, materials, lights and cameras in the asset's own
//! space (metres, y up), with every number checked.
//!
//! By extension: `.glb` and `.gltf`, and `.obj` with its `.mtl`. A model file is not trusted: [`load`] reads
//! nothing outside of one folder, checks counts against what is there before it allocates, and gives an
//! error with the place of every fault it finds.
//!
//! Of glTF 2.0: the default scene with its nodes, triangles, tangents, lights and cameras; materials with base
//! and emissive colours, metalness and roughness, normal maps, coverage (`alphaMode`), and by extensions
//! refractive index, dispersion, transmission, volume, specular and clearcoat, each with its textures. Skinned
//! and morphed meshes stand in their rest pose; animations move cameras and nothing else; the other extensions of materials (sheen,
//! iridescence, anisotropy, diffuse transmission, specular-glossiness), are passed over with a warning.
//! Ambient occlusion is left out for good: whoever follows the light finds what hides it. So are textures of
//! thickness: the mesh has the true one.
//!
//! Of OBJ: polygons, concave ones too, with normals as written or flat (smoothing groups are not read), the
//! colours of vertices (sRGB, as Blender writes them), and of MTL `Kd`, `Ke`, `d` or `Tr`, `Ni`, `map_Kd`,
//! `map_Ke`, and `Pm` and `Pr`. A material without the latter two scatters alike to all sides.

mod animation;
mod files;
mod gltf;
mod material;
mod obj;
mod picture;
mod shape;

use crate::error::{Error, Fault, Place, Report};
use crate::inputs::Inputs;
use crate::mesh::Mesh;
pub use animation::{Animation, Channel, Interpolation, Moving, Pose, Rig};
use files::Files;
use glam::{DAffine3, DVec3};
pub use material::{Clearcoat, Coverage, Material, MetalRough, NormalMap, Specular, Transmission, Volume};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A mesh placed in the asset's space.
#[derive(Debug, Clone)]
pub struct Instance {
    /// Index into [`Asset::meshes`].
    pub mesh: usize,
    /// Any affine map, mirrored and non-uniformly scaled ones included.
    pub asset_from_mesh: DAffine3,
    /// Index into [`Asset::nodes`].
    pub node: usize,
}

/// What kind of light the file describes. Directions are along -z of its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightKind {
    /// Shines alike to all sides; intensity in cd.
    Point,
    /// A cone; intensity in cd along the axis; half angles in radians.
    Spot {
        /// Full brightness within this angle from the axis.
        inner: f64,
        /// No light outside this angle from the axis.
        outer: f64,
    },
    /// Parallel light; illuminance in lx.
    Sun,
}

/// A light of the file (`KHR_lights_punctual`).
#[derive(Debug, Clone)]
pub struct Light {
    /// The file's name for it.
    pub name: String,
    /// What it is.
    pub kind: LightKind,
    /// Linear sRGB.
    pub color: [f32; 3],
    /// cd or lx, for the colour white.
    pub intensity: f64,
    /// Where it stands: its position, and the direction -z in which it shines.
    pub asset_from_light: DAffine3,
    /// Index into [`Asset::nodes`].
    pub node: usize,
}

/// A camera of the file; looks along -z with +y up.
#[derive(Debug, Clone)]
pub struct Camera {
    /// The file's name for it.
    pub name: String,
    /// Where it stands.
    pub asset_from_camera: DAffine3,
    /// Vertical field of view in radians; none for an orthographic camera.
    pub vertical_fov: Option<f64>,
    /// Width over height, where the file says.
    pub aspect: Option<f64>,
    /// Index into [`Asset::nodes`].
    pub node: usize,
}

/// A node of the file's hierarchy, kept to name and choose parts.
#[derive(Debug, Clone)]
pub struct Node {
    /// The file's name for it; may be empty.
    pub name: String,
    /// Its parent, an index into [`Asset::nodes`] smaller than its own.
    pub parent: Option<usize>,
    /// Its place in its parent.
    pub pose: Pose,
    /// Its place in the asset's space.
    pub asset_from_node: DAffine3,
}

/// Everything that a model file contributes.
#[derive(Debug, Clone, Default)]
pub struct Asset {
    /// The file.
    pub path: PathBuf,
    /// Nodes, parents before children.
    pub nodes: Vec<Node>,
    /// Meshes, each once however often it is placed.
    pub meshes: Vec<Arc<Mesh>>,
    /// Materials; a mesh without one uses a last, default one.
    pub materials: Vec<Material>,
    /// Extensions that are passed over, by the number of the material that has them.
    pub ignored: BTreeMap<usize, Vec<String>>,
    /// Where the meshes stand.
    pub instances: Vec<Instance>,
    /// Lights in the order of their nodes.
    pub lights: Vec<Light>,
    /// Cameras in the order of their nodes.
    pub cameras: Vec<Camera>,
    /// The file's animations, as far as cameras hang on what moves.
    pub animations: Vec<Animation>,
    /// What the file has and this program passes over, and what looks like a mistake.
    pub warnings: Vec<Fault>,
    /// The file and all others that it names.
    pub inputs: Inputs,
}

impl Asset {
    /// The least and the greatest coordinates of all that is placed; none if nothing is.
    pub fn extent(&self) -> Option<(DVec3, DVec3)> {
        let points = self.instances.iter().flat_map(|instance| {
            let place = instance.asset_from_mesh;
            self.meshes[instance.mesh].positions.iter().map(move |p| place.transform_point3(p.as_dvec3()))
        });
        points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }
}

/// The most faults (and warnings) that one file may report; the rest are only counted.
const REPORT_LIMIT: usize = 50;

/// Whether a file is glTF, and not OBJ, by its name; none if it is no model.
fn is_gltf(path: &Path) -> Option<bool> {
    match path.extension()?.to_str()?.to_lowercase().as_str() {
        "glb" | "gltf" => Some(true),
        "obj" => Some(false),
        _ => None,
    }
}

/// Whether a file is a model, by its name.
pub fn is_model(path: &Path) -> bool {
    is_gltf(path).is_some()
}

/// Reads a model file and the files it names.
///
/// The extension says which format it is, in capitals or not. No file outside of the folder `root` is read,
/// not even through a link. The error holds all faults found, each with the file and the element.
pub fn load(path: &Path, root: &Path) -> Result<Asset, Error> {
    load_with(path, root, |_| ()).map(|(asset, ())| asset)
}

/// The same, with what is made of its meshes: in a glTF file beside the decoding of its pictures, which takes as long.
pub fn load_with<T: Send>(
    path: &Path,
    root: &Path,
    make: impl FnOnce(&[Arc<Mesh>]) -> T + Send,
) -> Result<(Asset, T), Error> {
    let Some(is_gltf) = is_gltf(path) else {
        let hint = "the supported ones end in .glb, .gltf or .obj: export it as one of these";
        return Err(Error::fault(Place::file(path), "not a kind of model file that is known", hint));
    };
    let (files, folder, bytes) = Files::open(path, root)?;
    let mut job =
        Job { path: path.to_owned(), folder, files, report: Report::default(), faults: 0, warnings: 0 };
    // Two of the crates underneath have been seen to panic on malformed files. Everything that does so is
    // checked before; this is for what nobody has seen yet.
    let read = || {
        if is_gltf {
            return gltf::read(&bytes, &mut job, make);
        }
        let asset = obj::read(&bytes, &mut job)?;
        let made = make(&asset.meshes);
        Some((asset, made))
    };
    let (asset, digest) =
        rayon::join(|| catch_unwind(AssertUnwindSafe(read)), || crate::inputs::digest(&bytes));
    let asset = asset.unwrap_or_else(|_| {
        let what = "reading this file failed in a way that was not foreseen";
        job.found(Fault::new(Place::file(path), what, "please report it with the file"));
        None
    });
    if asset.is_none() && job.faults == 0 {
        job.found(Fault::new(Place::file(path), "this file could not be read", ""));
    }
    let Job { mut report, faults, warnings, files, .. } = job;
    more(&mut report.faults, faults, path, "faults");
    more(&mut report.warnings, warnings, path, "warnings");
    let warnings = std::mem::take(&mut report.warnings);
    let (mut asset, made) = report.finish(asset)?;
    path.clone_into(&mut asset.path);
    asset.warnings = warnings;
    asset.inputs = files.inputs;
    asset.inputs.files.insert(path.to_owned(), digest);
    Ok((asset, made))
}

/// Reads a picture file that the user names, and takes note of it.
pub fn picture_file(path: &Path, inputs: &mut Inputs) -> Result<crate::texture::Picture, Error> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let (mut files, _, bytes) = Files::open(path, folder).inspect_err(|_| inputs.depend(path))?;
    inputs.add(path, &bytes);
    let name = path.to_string_lossy();
    picture::decode(&bytes, &name, &mut files).map_err(|refusal| Error::from(refusal.at(Place::file(path))))
}

/// Says how many were found beyond those kept.
fn more(list: &mut Vec<Fault>, found: usize, path: &Path, of_what: &str) {
    let more = found.saturating_sub(list.len());
    if more > 0 {
        list.push(Fault::new(Place::file(path), format!("{more} more {of_what} like these"), ""));
    }
}

/// One run of an importer: what is read, from where, and what was found.
#[derive(Debug)]
struct Job {
    /// The model file as the user named it.
    path: PathBuf,
    /// The folder it is in, without links.
    folder: PathBuf,
    files: Files,
    /// The first faults and warnings.
    report: Report,
    /// The number of all faults found.
    faults: usize,
    /// The number of all warnings found.
    warnings: usize,
}

impl Job {
    /// A part of the job that is done beside it.
    fn part(&self) -> Self {
        let (path, folder, files) = (self.path.clone(), self.folder.clone(), self.files.clone());
        Self { path, folder, files, report: Report::default(), faults: 0, warnings: 0 }
    }

    /// Takes over what a part of the job has found.
    fn found_by(&mut self, part: Self) {
        self.files.inputs.extend(part.files.inputs);
        let Report { faults, warnings, .. } = part.report;
        self.faults += part.faults - faults.len();
        self.warnings += part.warnings - warnings.len();
        faults.into_iter().for_each(|fault| self.found(fault));
        warnings.into_iter().for_each(|warning| self.noticed(warning));
    }

    /// Takes note of a fault.
    fn found(&mut self, fault: Fault) {
        self.faults += 1;
        if self.report.faults.len() < REPORT_LIMIT {
            self.report.faults.push(fault);
        }
    }

    /// Takes note of a warning.
    fn noticed(&mut self, warning: Fault) {
        self.warnings += 1;
        if self.report.warnings.len() < REPORT_LIMIT {
            self.report.warnings.push(warning);
        }
    }

    fn fault(&mut self, element: impl Into<String>, what: impl Into<String>, hint: impl Into<String>) {
        self.found(Fault::new(Place::element(&self.path, element), what, hint));
    }

    fn warn(&mut self, element: impl Into<String>, what: impl Into<String>, hint: impl Into<String>) {
        self.noticed(Fault::new(Place::element(&self.path, element), what, hint));
    }

    fn refused(&mut self, element: impl Into<String>, refusal: files::Refusal) {
        self.found(refusal.at(Place::element(&self.path, element)));
    }
}
