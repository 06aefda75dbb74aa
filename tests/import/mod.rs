//! What the importers promise, with models made on the spot.
#![allow(clippy::float_cmp, reason = "numbers go in and must come out as they are")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are the tests' own helpers")]

mod extensions;
mod lights;
mod malformed;
mod malformed_materials;
mod materials;
mod meshes;
mod mutation;
mod nodes;
mod obj;
mod policy;

use base64::Engine;
use serde_json::{Value, json};
use std::path::Path;
use terrell::error::{Error, Fault};
use terrell::import::{Asset, load};

pub(crate) const U8: u32 = 5121;
pub(crate) const I16: u32 = 5122;
pub(crate) const U16: u32 = 5123;
pub(crate) const F32: u32 = 5126;

/// A glTF model in the making.
#[derive(Clone)]
pub(crate) struct Model {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

pub(crate) fn bytes_of(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

pub(crate) fn push(list: &mut Value, entry: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(entry);
    list.len() - 1
}

impl Model {
    pub(crate) fn empty() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "buffers": [], "bufferViews": [], "accessors": [], "meshes": [], "nodes": [],
            "materials": [], "textures": [], "images": [], "samplers": [],
        });
        Self { json, bin: Vec::new() }
    }

    /// One triangle: accessors 0 (positions) and 1 (indices, u16), mesh 0, node 0, scene 0.
    pub(crate) fn triangle() -> Self {
        let mut model = Self::empty();
        let positions = model.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let indices = model.accessor(U16, "SCALAR", 3, &[0, 0, 1, 0, 2, 0]);
        let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
        push(&mut model.json["meshes"], json!({ "name": "Tri", "primitives": [primitive] }));
        push(&mut model.json["nodes"], json!({ "name": "Node", "mesh": 0 }));
        model.json["scenes"] = json!([{ "nodes": [0] }]);
        model.json["scene"] = json!(0);
        model
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
        push(&mut self.json["bufferViews"], view)
    }

    pub(crate) fn accessor(&mut self, kind: u32, shape: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({ "bufferView": view, "componentType": kind, "type": shape, "count": count });
        push(&mut self.json["accessors"], accessor)
    }

    pub(crate) fn floats(&mut self, shape: &str, values: &[f32]) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        self.accessor(F32, shape, values.len() / width, &bytes_of(values))
    }

    /// Sets an attribute of the first primitive.
    pub(crate) fn attribute(&mut self, name: &str, accessor: usize) {
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    }

    /// Adds a material with a picture for its base colour and gives it to the first primitive.
    pub(crate) fn textured(&mut self, picture: &[u8]) -> usize {
        let texture = self.texture(picture);
        let material = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } });
        let material = push(&mut self.json["materials"], material);
        self.json["meshes"][0]["primitives"][0]["material"] = json!(material);
        material
    }

    /// Adds a texture of a picture; its number.
    pub(crate) fn texture(&mut self, picture: &[u8]) -> usize {
        let view = self.view(picture);
        let image = push(&mut self.json["images"], json!({ "bufferView": view, "mimeType": "image/png" }));
        push(&mut self.json["textures"], json!({ "source": image }))
    }

    /// Gives the first primitive one material, and both sets of texture coordinates.
    pub(crate) fn with_material(mut self, material: &Value) -> Self {
        for set in ["TEXCOORD_0", "TEXCOORD_1"] {
            let uvs = self.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
            self.attribute(set, uvs);
        }
        self.json["materials"] = json!([material]);
        self.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        self
    }

    /// The JSON with its buffer's length.
    fn finished(&self) -> Value {
        let mut json = self.json.clone();
        if json["buffers"].as_array().is_some_and(Vec::is_empty) {
            json["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        }
        json
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec(&self.finished()).unwrap();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let mut bytes = b"glTF".to_vec();
        for number in [2, (12 + 8 + text.len() + 8 + bin.len()) as u32, text.len() as u32] {
            bytes.extend_from_slice(&number.to_le_bytes());
        }
        bytes.extend_from_slice(b"JSON");
        bytes.extend_from_slice(&text);
        bytes.extend_from_slice(&(bin.len() as u32).to_le_bytes());
        bytes.extend_from_slice(b"BIN\0");
        bytes.extend_from_slice(&bin);
        bytes
    }

    /// A `.gltf` with its buffer at a URI.
    pub(crate) fn gltf(&self, uri: &str) -> Vec<u8> {
        let mut json = self.finished();
        json["buffers"][0]["uri"] = json!(uri);
        serde_json::to_vec(&json).unwrap()
    }

    pub(crate) fn data_uri(&self) -> String {
        format!("data:application/octet-stream;base64,{}", base64(&self.bin))
    }

    pub(crate) fn load(&self) -> Result<Asset, Error> {
        load_files("model.glb", &[("model.glb", &self.glb())])
    }

    /// The asset, which must be without fault.
    pub(crate) fn asset(&self) -> Asset {
        self.load().unwrap_or_else(|error| panic!("{error}"))
    }
}

pub(crate) fn base64(bytes: &[u8]) -> String {
    base64::engine::general_purpose::STANDARD.encode(bytes)
}

/// Writes files into a folder of their own and loads one.
pub(crate) fn load_files(name: &str, files: &[(&str, &[u8])]) -> Result<Asset, Error> {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path(), files);
    load(&folder.path().join(name), folder.path())
}

pub(crate) fn write_files(folder: &Path, files: &[(&str, &[u8])]) {
    for (name, bytes) in files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
}

/// The faults of something that must fail for what the user wrote.
pub(crate) fn faults(result: Result<Asset, Error>) -> Vec<Fault> {
    match result {
        Ok(_) => panic!("should have been refused"),
        Err(Error::Input(faults)) => faults,
        Err(error) => panic!("not a fault of the input: {error}"),
    }
}

/// Whether a warning says something.
pub(crate) fn warns(asset: &Asset, words: &str) -> bool {
    asset.warnings.iter().any(|warning| warning.to_string().contains(words))
}

/// A PNG of RGBA texels.
pub(crate) fn png(width: u32, texels: &[[u8; 4]]) -> Vec<u8> {
    let height = texels.len() as u32 / width;
    let image = image::RgbaImage::from_raw(width, height, texels.concat()).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}
