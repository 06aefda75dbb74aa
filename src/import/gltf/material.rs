//! Materials: metallic-roughness, normal maps, coverage, what glows, and the extensions.

use super::document::{Document, SUPPORTED};
use super::extension::{Extension, Range, placed};
use super::texture::{self, Pictures, Use};
use crate::import::{
    Clearcoat, Coverage, Job, Material, MetalRough, NormalMap, Specular, Transmission, Volume,
};
use crate::texture::Texture;
use gltf::json;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Materials that a warning names; the rest are counted.
const NAMED: usize = 5;

/// Materials in the order of the file, and the extensions of each that are passed over.
pub(super) type Materials = (Vec<Material>, BTreeMap<usize, Vec<String>>);

/// All materials of a file.
pub(super) fn all(document: &Document<'_>, job: &mut Job) -> Materials {
    let mut reader = Reader { document, pictures: Pictures::new(), job };
    let mut materials = Vec::new();
    let mut ignored = BTreeMap::new();
    for (i, written) in document.root.materials.iter().enumerate() {
        let element = format!("materials[{i}]");
        let material = reader.material(written, &element);
        if !document.colored.get(i).copied().unwrap_or(true) {
            warn_of_missing_color(&material, &element, reader.job);
        }
        materials.push(material);
        let passed_over: Vec<String> =
            others(written).into_iter().flat_map(Map::keys).filter(|name| unknown(name)).cloned().collect();
        if !passed_over.is_empty() {
            ignored.insert(i, passed_over);
        }
    }
    warn_of_ignored(&materials, &ignored, job);
    (materials, ignored)
}

/// Extensions that the crate leaves as they are.
fn others(written: &json::Material) -> Option<&Map<String, Value>> {
    written.extensions.as_ref().map(|extensions| &extensions.others)
}

/// Whether [`Material::has_normal_map`] will be true of it.
pub(super) fn has_normal_map(written: &json::Material) -> bool {
    let coat = others(written).and_then(|others| others.get("KHR_materials_clearcoat"));
    let coat = coat.filter(|coat| coat["clearcoatFactor"].as_f64().is_some_and(|strength| strength > 0.0));
    written.normal_texture.is_some() || coat.is_some_and(|coat| coat.get("clearcoatNormalTexture").is_some())
}

fn unknown(extension: &str) -> bool {
    !SUPPORTED.contains(&extension)
}

/// Reads materials and what they refer to.
struct Reader<'a, 'b> {
    document: &'a Document<'b>,
    pictures: Pictures,
    job: &'a mut Job,
}

impl Reader<'_, '_> {
    fn material(&mut self, written: &json::Material, element: &str) -> Material {
        let extensions = written.extensions.as_ref();
        let find = |name, job: &mut Job| Extension::find(others(written), name, element, job);
        let pbr = &written.pbr_metallic_roughness;
        let coverage = self.coverage(written, element);
        let mut base_color = pbr.base_color_factor.0;
        check_color(&base_color, &format!("{element}.pbrMetallicRoughness.baseColorFactor"), self.job);
        if coverage == Coverage::Opaque {
            base_color[3] = 1.0;
        }
        let base_use = if coverage == Coverage::Opaque { Use::Opaque } else { Use::Color };
        let base_texture = pbr.base_color_texture.as_ref();
        let ior = find("KHR_materials_ior", self.job);
        let dispersion = find("KHR_materials_dispersion", self.job);
        let specular = find("KHR_materials_specular", self.job);
        let transmission = find("KHR_materials_transmission", self.job);
        let volume = find("KHR_materials_volume", self.job);
        let clearcoat = find("KHR_materials_clearcoat", self.job);
        Material {
            name: super::name(written.name.as_ref()),
            base_color,
            base_texture: self.texture(
                base_texture,
                base_use,
                &format!("{element}.pbrMetallicRoughness.baseColorTexture"),
            ),
            coverage,
            emissive: self.emissive(written, element),
            // Its alpha means nothing.
            emissive_texture: self.texture(
                written.emissive_texture.as_ref(),
                Use::Opaque,
                &format!("{element}.emissiveTexture"),
            ),
            unlit: extensions.is_some_and(|e| e.unlit.is_some()),
            metal: self.metal(pbr, &format!("{element}.pbrMetallicRoughness")),
            normal: self.normal_map(written.normal_texture.as_ref(), &format!("{element}.normalTexture")),
            double_sided: written.double_sided,
            ior: ior.number("ior", Range::RefractiveIndex, 1.5, self.job),
            dispersion: dispersion.number("dispersion", Range::FromZero, 0.0, self.job),
            specular: self.specular(&specular),
            clearcoat: self.clearcoat(&clearcoat),
            transmission: self.transmission(&transmission),
            volume: self.volume(&volume),
        }
    }

    fn coverage(&mut self, written: &json::Material, element: &str) -> Coverage {
        match written.alpha_mode {
            Checked::Valid(AlphaMode::Mask) => {
                let cutoff = written.alpha_cutoff.unwrap_or_default().0;
                let element = format!("{element}.alphaCutoff");
                Coverage::Mask { cutoff: Range::FromZero.check(cutoff, 0.5, &element, self.job) }
            }
            Checked::Valid(AlphaMode::Blend) => Coverage::Blend,
            _ => Coverage::Opaque,
        }
    }

    fn emissive(&mut self, written: &json::Material, element: &str) -> [f32; 3] {
        let strength = written.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |e| e.emissive_strength.0);
        check_color(&written.emissive_factor.0, &format!("{element}.emissiveFactor"), self.job);
        let emissive = written.emissive_factor.0.map(|c| c * strength);
        let element = format!("{element}.extensions.KHR_materials_emissive_strength.emissiveStrength");
        check_color(&emissive, &element, self.job);
        emissive
    }

    fn metal(&mut self, pbr: &json::material::PbrMetallicRoughness, element: &str) -> MetalRough {
        let mut unit = |value, key| Range::Unit.check(value, 1.0, &format!("{element}.{key}"), self.job);
        MetalRough {
            metallic: unit(pbr.metallic_factor.0, "metallicFactor"),
            roughness: unit(pbr.roughness_factor.0, "roughnessFactor"),
            texture: self.texture(
                pbr.metallic_roughness_texture.as_ref(),
                Use::Data,
                &format!("{element}.metallicRoughnessTexture"),
            ),
        }
    }

    fn specular(&mut self, extension: &Extension<'_>) -> Specular {
        Specular {
            strength: extension.number("specularFactor", Range::Unit, 1.0, self.job),
            texture: self.texture_of(extension, "specularTexture", Use::Data),
            color: extension.color("specularColorFactor", Range::FromZero, self.job),
            color_texture: self.texture_of(extension, "specularColorTexture", Use::Opaque),
        }
    }

    fn transmission(&mut self, extension: &Extension<'_>) -> Option<Transmission> {
        let amount = extension.number("transmissionFactor", Range::Unit, 0.0, self.job);
        let texture = self.texture_of(extension, "transmissionTexture", Use::Data);
        (amount > 0.0).then_some(Transmission { amount, texture })
    }

    fn volume(&mut self, extension: &Extension<'_>) -> Option<Volume> {
        let thickness = extension.number("thicknessFactor", Range::FromZero, 0.0, self.job);
        let attenuation_distance =
            extension.number("attenuationDistance", Range::AboveZero, f32::INFINITY, self.job);
        let attenuation_color = extension.color("attenuationColor", Range::Unit, self.job);
        (thickness > 0.0).then_some(Volume { thickness, attenuation_distance, attenuation_color })
    }

    fn clearcoat(&mut self, extension: &Extension<'_>) -> Option<Clearcoat> {
        let normal = extension.normal_texture("clearcoatNormalTexture", self.job);
        let coat = Clearcoat {
            strength: extension.number("clearcoatFactor", Range::Unit, 0.0, self.job),
            texture: self.texture_of(extension, "clearcoatTexture", Use::Data),
            roughness: extension.number("clearcoatRoughnessFactor", Range::Unit, 0.0, self.job),
            roughness_texture: self.texture_of(extension, "clearcoatRoughnessTexture", Use::Data),
            normal: self.normal_map(normal.as_ref(), &extension.at("clearcoatNormalTexture")),
        };
        (coat.strength > 0.0).then_some(coat)
    }

    fn texture(&mut self, info: Option<&json::texture::Info>, usage: Use, element: &str) -> Option<Texture> {
        texture::read(self.document, info?, (element, usage), &mut self.pictures, self.job)
    }

    fn texture_of(&mut self, extension: &Extension<'_>, key: &str, usage: Use) -> Option<Texture> {
        let info = extension.texture(key, self.job);
        self.texture(info.as_ref(), usage, &extension.at(key))
    }

    fn normal_map(
        &mut self,
        written: Option<&json::material::NormalTexture>,
        element: &str,
    ) -> Option<NormalMap> {
        const TRANSFORM: &str = "KHR_texture_transform";
        let written = written?;
        let scale = Range::Finite.check(written.scale, 1.0, &format!("{element}.scale"), self.job);
        // The crate parses the transform of other textures only.
        let transform = written.extensions.as_ref().and_then(|e| e.others.get(TRANSFORM)).and_then(|value| {
            let parsed = serde_json::from_value(value.clone());
            placed(parsed, &format!("{element}.extensions.{TRANSFORM}"), self.job)
        });
        let others = Map::new();
        let extensions = json::extensions::texture::Info { texture_transform: transform, others };
        let info = json::texture::Info {
            index: written.index,
            tex_coord: written.tex_coord,
            extensions: Some(extensions),
            extras: None,
        };
        let texture = self.texture(Some(&info), Use::Data, element)?;
        Some(NormalMap { texture, scale })
    }
}

/// Colours are finite and not negative.
fn check_color(color: &[f32], element: &str, job: &mut Job) {
    if !color.iter().all(|c| c.is_finite() && *c >= 0.0) {
        job.fault(element, format!("{color:?} is not a colour"), "numbers from 0 on are colours");
    }
}

/// Says that a material is white only because the file has no colour for it.
fn warn_of_missing_color(material: &Material, element: &str, job: &mut Job) {
    let emits = material.emissive_texture.is_some() || material.emissive.iter().any(|&c| c > 0.0);
    if !emits && !material.unlit && material.transmission.is_none() {
        let what =
            format!("material `{}` has no colour in the file: was it a Principled BSDF?", material.name);
        job.warn(
            element,
            what,
            "in Blender, only the Principled BSDF's colour is exported; the rest is white",
        );
    }
}

/// Says which materials will look different here, once for each extension.
fn warn_of_ignored(materials: &[Material], ignored: &BTreeMap<usize, Vec<String>>, job: &mut Job) {
    let mut by_extension: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (&number, extensions) in ignored {
        for extension in extensions {
            by_extension.entry(extension).or_default().push(number);
        }
    }
    for (extension, numbers) in by_extension {
        let name = |&i: &usize| match materials[i].name.as_str() {
            "" => format!("materials[{i}]"),
            name => format!("`{name}`"),
        };
        let mut names: Vec<String> = numbers.iter().take(NAMED).map(name).collect();
        if numbers.len() > NAMED {
            names.push(format!("{} more", numbers.len() - NAMED));
        }
        let what = format!("{extension} is passed over; without it shown: {}", names.join(", "));
        job.warn("materials", what, "");
    }
}
