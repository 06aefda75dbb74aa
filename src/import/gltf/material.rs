//! Materials: the base colour, what glows, and whether it is lit at all.

use super::document::Document;
use super::texture::{self, Pictures};
use crate::import::{Job, Material};
use gltf::json;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;

/// All materials of a file, in its order.
pub(super) fn all(document: &Document<'_>, job: &mut Job) -> Vec<Material> {
    let mut pictures = Pictures::new();
    let mut materials = Vec::new();
    for (i, written) in document.root.materials.iter().enumerate() {
        let colored = document.colored.get(i).copied().unwrap_or(true);
        materials.push(material(document, written, &format!("materials[{i}]"), &mut pictures, job));
        warn(written, colored, &format!("materials[{i}]"), job);
    }
    materials
}

fn material(
    document: &Document<'_>,
    written: &json::Material,
    element: &str,
    pictures: &mut Pictures,
    job: &mut Job,
) -> Material {
    let extensions = written.extensions.as_ref();
    let strength =
        extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    let opaque = written.alpha_mode == Checked::Valid(AlphaMode::Opaque);
    let pbr = &written.pbr_metallic_roughness;
    let mut base_color = pbr.base_color_factor.0;
    check(&base_color, &format!("{element}.pbrMetallicRoughness.baseColorFactor"), job);
    if opaque {
        base_color[3] = 1.0;
    }
    check(&written.emissive_factor.0, &format!("{element}.emissiveFactor"), job);
    let emissive = written.emissive_factor.0.map(|c| c * strength);
    check(&emissive, &format!("{element}.extensions.KHR_materials_emissive_strength.emissiveStrength"), job);
    let mut read = |info: &Option<json::texture::Info>, opaque, key: &str| {
        let element = format!("{element}.{key}");
        texture::read(document, info.as_ref()?, opaque, &element, pictures, job)
    };
    Material {
        name: super::name(written.name.as_ref()),
        base_color,
        base_texture: read(&pbr.base_color_texture, opaque, "pbrMetallicRoughness.baseColorTexture"),
        emissive,
        // Its alpha means nothing.
        emissive_texture: read(&written.emissive_texture, opaque, "emissiveTexture"),
        unlit: extensions.is_some_and(|e| e.unlit.is_some()),
    }
}

/// Colours are finite and not negative.
fn check(color: &[f32], element: &str, job: &mut Job) {
    if !color.iter().all(|c| c.is_finite() && *c >= 0.0) {
        job.fault(element, format!("{color:?} is not a colour"), "numbers from 0 on are colours");
    }
}

/// Says what of a material will look different here.
fn warn(written: &json::Material, colored: bool, element: &str, job: &mut Job) {
    let extensions = written.extensions.as_ref();
    let explicit = written.emissive_texture.is_some()
        || written.emissive_factor.0.iter().any(|&c| c > 0.0)
        || extensions.is_some_and(|e| e.unlit.is_some());
    if !colored && !explicit {
        let name = written.name.as_deref().unwrap_or("");
        let what = format!("material `{name}` has no colour in the file: was it a Principled BSDF?");
        job.warn(
            element,
            what,
            "in Blender, only the Principled BSDF's colour is exported; the rest is white",
        );
    }
    if written.alpha_mode != Checked::Valid(AlphaMode::Opaque) {
        let what = "coverage (alphaMode) is passed over: the surface is opaque";
        job.warn(format!("{element}.alphaMode"), what, "");
    }
}
