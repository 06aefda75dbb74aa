//! From bytes to a checked JSON document with its buffers.
//!
//! The JSON is parsed twice over: loosely, to check what the `gltf` crate would let pass (versions,
//! extensions, indices beyond 32 bits, which it cuts off) and to drop what is not needed (animations and
//! skins, some of which it cannot parse); then into the crate's own types.

use super::buffer;
use crate::import::Job;
use gltf::json;
use gltf::json::validation::{Error as Wrong, Validate};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeSet;

/// Extensions that are understood.
pub(super) const SUPPORTED: [&str; 11] = [
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Bytes in memory for a byte of JSON, at worst.
const VALUE_BYTES: u64 = 16;

/// A parsed file with its buffers.
pub(super) struct Document<'a> {
    /// The JSON, without animations and skins.
    pub root: json::Root,
    /// The bytes of the buffers, as many as each says; empty for one at fault.
    pub buffers: Vec<Cow<'a, [u8]>>,
    /// The animations as written, not checked.
    pub animations: Vec<Value>,
    /// Whether `KHR_mesh_quantization` allows integers for positions and normals.
    pub quantized: bool,
    /// Which materials have a `pbrMetallicRoughness`, the place of the base colour.
    pub colored: Vec<bool>,
}

/// Parses a file; none if it is so wrong that nothing more can be said about it.
pub(super) fn open<'a>(bytes: &'a [u8], job: &mut Job) -> Option<Document<'a>> {
    let (text, blob) = container(bytes, job)?;
    let mut value = parse(&text, job)?;
    if !versions(&value, job) {
        return None;
    }
    let before = job.faults;
    extensions(&value, job);
    indices(&value, "", false, job);
    if job.faults > before {
        return None;
    }
    let animations = match value["animations"].take() {
        Value::Array(animations) => animations,
        _ => Vec::new(),
    };
    let colored = list(&value["materials"]).iter().map(|m| m.get("pbrMetallicRoughness").is_some()).collect();
    trim(&mut value);
    let root: json::Root = match serde_json::from_value(value) {
        Ok(root) => root,
        Err(error) => {
            explain(&text, &error.to_string(), job);
            return None;
        }
    };
    if !valid(&root, job) {
        return None;
    }
    let buffers = buffer::load(&root, blob, job);
    let quantized = root.extensions_used.iter().any(|name| name == "KHR_mesh_quantization");
    Some(Document { root, buffers, animations, quantized, colored })
}

/// The JSON of a file and its binary chunk.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

/// The JSON of a file, and the binary chunk of a GLB, which it is by its first bytes, not by its name.
fn container<'a>(bytes: &'a [u8], job: &mut Job) -> Option<Chunks<'a>> {
    if !bytes.starts_with(b"glTF") {
        // Some editors put a byte order mark in front.
        return Some((Cow::Borrowed(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)), None));
    }
    let again = "the file was cut off or altered on its way: copy or export it again";
    let length = bytes.get(8..12).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    // The crate subtracts the header from the length without a look.
    let Some(length @ 12..) = length else {
        job.fault("GLB header", "is cut off, or gives a length shorter than itself", again);
        return None;
    };
    match gltf::binary::Glb::from_slice(bytes) {
        Ok(glb) => Some((glb.json, glb.bin)),
        Err(gltf::Error::Binary(error)) => {
            use gltf::binary::Error as E;
            let (element, what) = match error {
                E::Version(version) => ("GLB header", format!("is version {version}, and only 2 is known")),
                E::Length { .. } => {
                    ("GLB header", format!("says {length} bytes, but there are {}", bytes.len()))
                }
                E::Io(_) => ("GLB chunk header", "is cut off".to_owned()),
                other => ("GLB chunk header", other.to_string()),
            };
            job.fault(element, what, again);
            None
        }
        Err(error) => {
            job.fault("GLB header", error.to_string(), again);
            None
        }
    }
}

/// Drops what is not read, and fills in the one list that the crate demands and glTF does not.
fn trim(value: &mut Value) {
    let Some(object) = value.as_object_mut() else { return };
    object.remove("animations");
    object.remove("skins");
    let scenes = object.get_mut("scenes").and_then(Value::as_array_mut);
    for scene in scenes.into_iter().flatten().filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
}

fn parse(text: &[u8], job: &mut Job) -> Option<Value> {
    if let Err(refusal) = job.files.take(text.len() as u64 * VALUE_BYTES) {
        job.refused("JSON", refusal);
        return None;
    }
    match serde_json::from_slice(text) {
        Ok(value @ Value::Object(_)) => Some(value),
        Ok(_) => {
            job.fault("JSON", "is not an object", "this is not a glTF file: export the model again");
            None
        }
        Err(error) => {
            job.fault("JSON", error.to_string(), "this is not a whole glTF file: export the model again");
            None
        }
    }
}

/// The entries of a list, or none.
fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn strings(value: &Value) -> impl Iterator<Item = &str> {
    list(value).iter().filter_map(Value::as_str)
}

fn versions(value: &Value, job: &mut Job) -> bool {
    let asset = &value["asset"];
    let hint = "export the model as glTF 2.0";
    let known = asset["version"].as_str().is_some_and(|v| v.split('.').next() == Some("2"));
    if !known {
        let found = asset.get("version").map_or("nothing".to_owned(), Value::to_string);
        job.fault("asset.version", format!("must be \"2.0\", found {found}"), hint);
        return false;
    }
    match asset["minVersion"].as_str() {
        None | Some("2.0") => true,
        Some(version) => {
            job.fault("asset.minVersion", format!("asks for glTF {version}, and 2.0 is understood"), hint);
            false
        }
    }
}

/// Refuses what is required and not understood, all of it at once; warns of what is only used, but for what
/// materials have: that is told with their names.
fn extensions(value: &Value, job: &mut Job) {
    let required: BTreeSet<_> = strings(&value["extensionsRequired"]).collect();
    for (i, name) in strings(&value["extensionsRequired"]).enumerate() {
        if !SUPPORTED.contains(&name) {
            let hint = if name == "KHR_draco_mesh_compression" {
                "export the model without compression".to_owned()
            } else {
                format!("export the model without it; understood are {}", SUPPORTED.join(", "))
            };
            let what = format!("the file requires the extension {name}, which is not understood");
            job.fault(format!("extensionsRequired[{i}]"), what, hint);
        }
    }
    let materials = list(&value["materials"]).iter();
    let of_materials: BTreeSet<&str> = materials
        .filter_map(|material| material["extensions"].as_object())
        .flat_map(|extensions| extensions.keys().map(String::as_str))
        .collect();
    let told =
        |name: &str| SUPPORTED.contains(&name) || required.contains(name) || of_materials.contains(name);
    let unknown: Vec<_> = strings(&value["extensionsUsed"]).filter(|name| !told(name)).collect();
    if !unknown.is_empty() {
        job.warn("extensionsUsed", format!("passed over: {}", unknown.join(", ")), "");
    }
}

/// The keys of numbers that the `gltf` crate cuts off to 32 bits when it reads them.
const CUT_OFF: [&str; 23] = [
    "buffer",
    "bufferView",
    "camera",
    "children",
    "componentType",
    "index",
    "indices",
    "light",
    "magFilter",
    "material",
    "mesh",
    "minFilter",
    "mode",
    "nodes",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
    "target",
    "targets",
    "wrapS",
    "wrapT",
];

/// Looks for indices beyond 32 bits. `checked`: whether numbers at this place are indices. The depth is
/// bounded by the parser's.
fn indices(value: &Value, path: &str, checked: bool, job: &mut Job) {
    match value {
        Value::Number(number) if checked && number.as_u64().is_some_and(|n| n >= u64::from(u32::MAX)) => {
            job.fault(path, format!("{number} is no index or constant of glTF"), "");
        }
        Value::Array(entries) => {
            for (i, entry) in entries.iter().enumerate() {
                if checked || entry.is_object() || entry.is_array() {
                    indices(entry, &format!("{path}[{i}]"), checked, job);
                }
            }
        }
        Value::Object(entries) => {
            let attributes = path.ends_with("attributes") || path.contains("].targets[");
            for (key, entry) in entries.iter().filter(|(key, _)| *key != "extras") {
                let checked = attributes || CUT_OFF.contains(&key.as_str());
                if checked || entry.is_object() || entry.is_array() {
                    let dot = if path.is_empty() { "" } else { "." };
                    indices(entry, &format!("{path}{dot}{key}"), checked, job);
                }
            }
        }
        _ => {}
    }
}

/// A parser for one kind of element, which says what is wrong with it.
type Element = fn(&Value) -> Option<String>;

macro_rules! element {
    ($kind:ty) => {
        |value| serde_json::from_value::<$kind>(value.clone()).err().map(|error| error.to_string())
    };
}

/// Finds the elements at which the parser stumbled, since it does not say.
fn explain(text: &[u8], error: &str, job: &mut Job) {
    let kinds: [(&str, Element); 12] = [
        ("accessors", element!(json::Accessor)),
        ("buffers", element!(json::Buffer)),
        ("bufferViews", element!(json::buffer::View)),
        ("cameras", element!(json::Camera)),
        ("extensionsUsed", element!(String)),
        ("images", element!(json::Image)),
        ("materials", element!(json::Material)),
        ("meshes", element!(json::Mesh)),
        ("nodes", element!(json::Node)),
        ("samplers", element!(json::texture::Sampler)),
        ("scenes", element!(json::Scene)),
        ("textures", element!(json::Texture)),
    ];
    let before = job.faults;
    let value: Value = serde_json::from_slice(text).unwrap_or_default();
    for (key, wrong) in kinds {
        for (i, entry) in list(&value[key]).iter().enumerate() {
            if let Some(what) = wrong(entry) {
                job.fault(format!("{key}[{i}]"), what, "");
            }
        }
    }
    if job.faults == before {
        let element = value.get("extensions").map_or("JSON", |_| "JSON (perhaps in extensions)");
        job.fault(element, error, "");
    }
}

/// Checks what the crate can check: that indices are in range and constants known.
fn valid(root: &json::Root, job: &mut Job) -> bool {
    let before = job.faults;
    // The crate looks at the positions' accessor without a check of its index.
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            for (semantic, index) in &primitive.attributes {
                if index.value() >= root.accessors.len() {
                    let semantic = semantic.to_string();
                    let element = format!("meshes[{m}].primitives[{p}].attributes.{semantic}");
                    job.fault(element, format!("there is no accessors[{}]", index.value()), "");
                }
            }
        }
    }
    if job.faults > before {
        return false;
    }
    root.validate(root, json::Path::new, &mut |path, wrong| {
        let element = path().0.replace("[\"", ".").replace("\"]", "");
        let what = match wrong {
            Wrong::IndexOutOfBounds => "there is no element of this index",
            Wrong::Invalid => "is not a value that glTF knows",
            Wrong::Missing => "is missing",
            Wrong::Oversize => "is beyond what this machine can address",
            Wrong::Unsupported => return,
        };
        // Bounds are not needed here, and an accessor without a view is legal: it is all zeros.
        // Skins are not kept.
        let list = element.split_once('[').unwrap_or_default().0;
        let key = element.rsplit_once('.').unwrap_or_default().1;
        let bounds = element.contains(".POSITION.") && (key == "min" || key == "max");
        let zeros = list == "accessors" && key == "bufferView";
        let skin = list == "nodes" && key == "skin";
        if bounds || skin || (zeros && wrong == Wrong::Missing) {
            return;
        }
        if element.contains("<invalid semantic name>") {
            job.warn(element, "an attribute of a name unknown to glTF is passed over", "");
        } else {
            job.fault(element, what, "");
        }
    });
    job.faults == before
}
