//! `terrell inspect`: what is in a model file, to copy names from.

use crate::error::{Error, Place};
use crate::import::{self, Asset, LightKind, Material};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(super) struct InspectArgs {
    /// The model file (.glb, .gltf, .obj)
    model: PathBuf,
    /// As JSON, for other programs
    #[arg(long)]
    json: bool,
}

/// Prints what is in a model file.
pub(super) fn run(args: &InspectArgs) -> Result<(), Error> {
    let folder = args.model.parent().unwrap_or(Path::new(""));
    let asset = import::load(&args.model, folder)?;
    super::warn(&asset.warnings);
    if args.json {
        let text = serde_json::to_string_pretty(&as_json(&asset))
            .map_err(|error| Error::fault(Place::file(&args.model), error.to_string(), ""))?;
        super::print(&(text + "\n"))
    } else {
        super::print(&as_text(&asset))
    }
}

fn name(of: &str) -> &str {
    if of.is_empty() { "(without a name)" } else { of }
}

fn as_text(asset: &Asset) -> String {
    let mut text = format!("{}\n", asset.path.display());
    if let Some((lo, hi)) = extent(asset) {
        let size = hi - lo;
        text += &format!("size {:.3} x {:.3} x {:.3} m, ", size.x, size.y, size.z);
    }
    let shown: usize = asset.instances.iter().map(|i| asset.meshes[i.mesh].triangles.len()).sum();
    text += &format!("{shown} triangles shown, {} meshes\n\nnodes\n", asset.meshes.len());
    let contents = contents(asset);
    let mut depths: Vec<usize> = Vec::with_capacity(asset.nodes.len());
    for (number, things) in contents.iter().enumerate() {
        // Parents come before their children.
        let depth = asset.nodes[number].parent.map_or(0, |parent| depths[parent] + 1);
        depths.push(depth);
        let things = things.join(", ");
        let indent = "  ".repeat(depth.min(40) + 1);
        text += &format!(
            "{indent}{}{}{things}\n",
            name(&asset.nodes[number].name),
            if things.is_empty() { "" } else { ": " }
        );
    }
    text += "\nmaterials\n";
    for material in &asset.materials {
        text += &format!("  {}: {}\n", name(&material.name), describe(material));
    }
    for animation in &asset.animations {
        text += &format!("\nanimation {} (not played)\n", name(animation));
    }
    text
}

/// What hangs on each node.
fn contents(asset: &Asset) -> Vec<Vec<String>> {
    let mut contents = vec![Vec::new(); asset.nodes.len()];
    for instance in &asset.instances {
        let mesh = &asset.meshes[instance.mesh];
        contents[instance.node].push(format!(
            "mesh {}, {} triangles",
            name(&mesh.name),
            mesh.triangles.len()
        ));
    }
    for light in &asset.lights {
        contents[light.node].push(match light.kind {
            LightKind::Point => format!("lamp, {:.4} cd", light.intensity),
            LightKind::Spot { outer, .. } => {
                format!("spot, {:.4} cd, cone {:.1} deg", light.intensity, 2.0 * outer.to_degrees())
            }
            LightKind::Sun => format!("sun, {:.4} lx", light.intensity),
        });
    }
    for camera in &asset.cameras {
        let kind = camera
            .vertical_fov
            .map_or_else(|| "orthographic".to_owned(), |fov| format!("{:.1} deg high", fov.to_degrees()));
        contents[camera.node].push(format!("camera {}, {kind}", name(&camera.name)));
    }
    contents
}

fn describe(material: &Material) -> String {
    let [r, g, b, a] = material.base_color;
    let mut words = vec![format!("colour {r:.3} {g:.3} {b:.3} (linear)")];
    if a < 1.0 {
        words.push(format!("alpha {a:.3}"));
    }
    if let Some(texture) = &material.base_texture {
        words.push(format!("texture {} x {}", texture.picture.width, texture.picture.height));
    }
    if material.emissive.iter().any(|channel| *channel > 0.0) {
        let [r, g, b] = material.emissive;
        words.push(format!("emits {r:.3} {g:.3} {b:.3} cd/m2"));
    }
    if material.unlit {
        words.push("unlit".to_owned());
    }
    words.join(", ")
}

fn extent(asset: &Asset) -> Option<(glam::DVec3, glam::DVec3)> {
    let points = asset.instances.iter().flat_map(|instance| {
        let place = instance.asset_from_mesh;
        asset.meshes[instance.mesh].positions.iter().map(move |p| place.transform_point3(p.as_dvec3()))
    });
    points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn as_json(asset: &Asset) -> Value {
    let nodes: Vec<Value> = asset
        .nodes
        .iter()
        .zip(contents(asset))
        .map(|(node, holds)| json!({ "name": node.name, "parent": node.parent, "holds": holds }))
        .collect();
    let materials: Vec<Value> = asset
        .materials
        .iter()
        .map(|m| {
            json!({ "name": m.name, "base_color": m.base_color, "emissive": m.emissive, "unlit": m.unlit,
            "textured": m.base_texture.is_some() })
        })
        .collect();
    let meshes: Vec<Value> = asset
        .meshes
        .iter()
        .map(|mesh| json!({ "name": mesh.name, "triangles": mesh.triangles.len(), "vertices": mesh.positions.len() }))
        .collect();
    let size = extent(asset).map(|(lo, hi)| [lo.to_array(), hi.to_array()]);
    json!({ "file": asset.path, "extent": size, "nodes": nodes, "meshes": meshes, "materials": materials,
        "lights": asset.lights.len(), "cameras": asset.cameras.iter().map(|c| &c.name).collect::<Vec<_>>(),
        "animations": asset.animations })
}
