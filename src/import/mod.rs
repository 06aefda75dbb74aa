//! A model file, as written, becomes an [`Asset`]: meshes, materials, lights and cameras in the asset's own
//! space (metres, y up), with every number checked.
//!
//! By extension: `.glb` and `.gltf` ([`gltf`]), `.obj` ([`obj`]).

use crate::error::Fault;
use crate::mesh::Mesh;
use crate::texture::Texture;
use glam::DAffine3;
use std::path::PathBuf;
use std::sync::Arc;

/// A surface as the file describes it. Colours are linear sRGB.
#[derive(Debug, Clone)]
pub struct Material {
    /// The file's name for it.
    pub name: String,
    /// Reflectance (RGB) and coverage (A), multiplied with the texture's and the vertices' colours.
    pub base_color: [f32; 4],
    /// Multiplies `base_color`.
    pub base_texture: Option<Texture>,
    /// Emitted light, cd/m² for a white of 1, strength included.
    pub emissive: [f32; 3],
    /// Multiplies `emissive`.
    pub emissive_texture: Option<Texture>,
    /// Shows its base colour whatever the lighting (`KHR_materials_unlit`).
    pub unlit: bool,
}

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
    /// Where the meshes stand.
    pub instances: Vec<Instance>,
    /// Lights in the order of their nodes.
    pub lights: Vec<Light>,
    /// Cameras in the order of their nodes.
    pub cameras: Vec<Camera>,
    /// Names of the file's animations.
    pub animations: Vec<String>,
    /// What the file has and this program passes over, and what looks like a mistake.
    pub warnings: Vec<Fault>,
}
