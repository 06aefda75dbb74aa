//! `terrell inspect`: what is in a model file, to copy names from.

use crate::error::{Error, Place, counted};
use crate::import::{self, Asset, Coverage, LightKind, Material, NormalMap};
use clap::Args;
use serde_json::{Map, Value, json};
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
    super::say(&super::warnings(&asset.warnings));
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
    if let Some((lo, hi)) = asset.extent() {
        let size = hi - lo;
        text += &format!("size {:.3} x {:.3} x {:.3} m, ", size.x, size.y, size.z);
    }
    let shown: usize = asset.instances.iter().map(|i| asset.meshes[i.mesh].triangles.len()).sum();
    let meshes = counted(asset.meshes.len(), "mesh", "meshes");
    text += &format!("{} shown, {meshes}\n\nnodes\n", counted(shown, "triangle", "triangles"));
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
    for (number, material) in asset.materials.iter().enumerate() {
        text += &format!("  {}: {}", name(&material.name), describe(material));
        if let Some(ignored) = asset.ignored.get(&number) {
            text += &format!("; passed over: {}", ignored.join(", "));
        }
        text += "\n";
    }
    for animation in &asset.animations {
        text += &format!(
            "\nanimation {} ({})\n",
            name(&animation.name),
            if animation.channels.is_empty() { "not played" } else { "moves a camera" }
        );
    }
    text
}

/// What hangs on each node.
fn contents(asset: &Asset) -> Vec<Vec<String>> {
    let mut contents = vec![Vec::new(); asset.nodes.len()];
    for instance in &asset.instances {
        let mesh = &asset.meshes[instance.mesh];
        contents[instance.node].push(format!(
            "mesh {}, {}",
            name(&mesh.name),
            counted(mesh.triangles.len(), "triangle", "triangles")
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

/// What a material is, in words, without what it is not.
fn describe(material: &Material) -> String {
    let [r, g, b, a] = material.base_color;
    let mut words = vec![format!("colour {r:.3} {g:.3} {b:.3} (linear)")];
    if a < 1.0 {
        words.push(format!("alpha {a:.3}"));
    }
    match material.coverage {
        Coverage::Opaque => {}
        Coverage::Mask { cutoff } => words.push(format!("cut out where alpha is below {cutoff:.3}")),
        Coverage::Blend => words.push("alpha is coverage".to_owned()),
    }
    if material.unlit {
        words.push("unlit".to_owned());
    } else {
        words.extend(reflection(material));
        words.extend(glass(material));
    }
    if material.emissive.iter().any(|channel| *channel > 0.0) {
        let [r, g, b] = material.emissive;
        words.push(format!("emits {r:.3} {g:.3} {b:.3} cd/m2"));
    }
    if material.double_sided {
        words.push("two-sided".to_owned());
    }
    for (purpose, texture) in material.textures() {
        let picture = &texture.picture;
        words.push(format!("texture of {purpose} {} x {}", picture.width, picture.height));
    }
    words.join(", ")
}

fn reflection(material: &Material) -> Vec<String> {
    let (metal, specular) = (&material.metal, &material.specular);
    let layered = material.clearcoat.is_some() || material.transmission.is_some();
    if metal.metallic == 0.0 && specular.strength == 0.0 && !layered {
        return vec!["diffuse".to_owned()];
    }
    let mut words =
        vec![format!("metallic {:.3}", metal.metallic), format!("roughness {:.3}", metal.roughness)];
    if metal.metallic < 1.0 && specular.strength < 1.0 {
        words.push(format!("specular {:.3}", specular.strength));
    }
    if specular.color != [1.0; 3] {
        let [r, g, b] = specular.color;
        words.push(format!("specular colour {r:.3} {g:.3} {b:.3}"));
    }
    if let Some(coat) = &material.clearcoat {
        words.push(format!("clearcoat {:.3} of roughness {:.3}", coat.strength, coat.roughness));
    }
    words
}

fn glass(material: &Material) -> Vec<String> {
    let mut words = Vec::new();
    if material.ior != 1.5 || material.transmission.is_some() {
        words.push(format!("refractive index {:.3}", material.ior));
    }
    if let Some(transmission) = &material.transmission {
        let body = if material.volume.is_some() { "solid" } else { "thin-walled" };
        words.push(format!("{body} glass, transmission {:.3}", transmission.amount));
    }
    if let Some(volume) = material.volume.filter(|volume| volume.attenuation_distance.is_finite()) {
        let [r, g, b] = volume.attenuation_color;
        words.push(format!("absorbs to {r:.3} {g:.3} {b:.3} in {:.4} m", volume.attenuation_distance));
    }
    if material.dispersion > 0.0 {
        words.push(format!("dispersion {:.3}", material.dispersion));
    }
    words
}

fn as_json(asset: &Asset) -> Value {
    let nodes: Vec<Value> = asset
        .nodes
        .iter()
        .zip(contents(asset))
        .map(|(node, holds)| json!({ "name": node.name, "parent": node.parent, "holds": holds }))
        .collect();
    let materials: Vec<Value> =
        (0..asset.materials.len()).map(|number| material_json(asset, number)).collect();
    let meshes: Vec<Value> = asset
        .meshes
        .iter()
        .map(|mesh| {
            json!({ "name": mesh.name, "triangles": mesh.triangles.len(), "vertices": mesh.positions.len(),
                "tangents": !mesh.tangents.is_empty() })
        })
        .collect();
    let size = asset.extent().map(|(lo, hi)| [lo.to_array(), hi.to_array()]);
    json!({ "file": asset.path, "extent": size, "nodes": nodes, "meshes": meshes, "materials": materials,
        "lights": asset.lights.len(), "cameras": asset.cameras.iter().map(|c| &c.name).collect::<Vec<_>>(),
        "animations": asset.animations.iter().map(|animation| &animation.name).collect::<Vec<_>>() })
}

fn material_json(asset: &Asset, number: usize) -> Value {
    let m = &asset.materials[number];
    let (coverage, cutoff) = match m.coverage {
        Coverage::Opaque => ("opaque", None),
        Coverage::Mask { cutoff } => ("mask", Some(cutoff)),
        Coverage::Blend => ("blend", None),
    };
    let textures: Map<String, Value> = m
        .textures()
        .map(|(purpose, t)| (purpose.to_owned(), json!([t.picture.width, t.picture.height])))
        .collect();
    let normal = |map: &Option<NormalMap>| map.as_ref().map(|map| json!({ "scale": map.scale }));
    json!({
        "name": m.name, "base_color": m.base_color, "emissive": m.emissive, "unlit": m.unlit,
        "textured": m.base_texture.is_some(), "textures": textures,
        "coverage": coverage, "cutoff": cutoff, "double_sided": m.double_sided,
        "metallic": m.metal.metallic, "roughness": m.metal.roughness, "normal": normal(&m.normal),
        "ior": m.ior, "dispersion": m.dispersion,
        "specular": { "strength": m.specular.strength, "color": m.specular.color },
        "clearcoat": m.clearcoat.as_ref().map(|coat| json!({
            "strength": coat.strength, "roughness": coat.roughness, "normal": normal(&coat.normal),
        })),
        "transmission": m.transmission.as_ref().map(|transmission| transmission.amount),
        // JSON has no infinity: null is a distance without end.
        "volume": m.volume.map(|volume| json!({
            "attenuation_distance": volume.attenuation_distance, "attenuation_color": volume.attenuation_color,
        })),
        "ignored": asset.ignored.get(&number).cloned().unwrap_or_default(),
    })
}
