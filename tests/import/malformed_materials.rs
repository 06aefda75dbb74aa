//! Materials at fault: each fault has its place and says what to type, none is a panic.

use super::malformed::{Case, check, textured};
use super::*;

/// A material with one extension and a texture 0.
fn extended(m: &mut Model, name: &str, extension: &Value) {
    m.json["materials"][0]["extensions"] = json!({ name: extension });
}

const PBR: &str = "pbrMetallicRoughness";
const IOR: &str = "KHR_materials_ior";
const VOLUME: &str = "KHR_materials_volume";
const SPECULAR: &str = "KHR_materials_specular";
const CLEARCOAT: &str = "KHR_materials_clearcoat";
const TRANSMISSION: &str = "KHR_materials_transmission";

const MATERIALS: &[Case] = &[
    (
        |m| m.json["materials"][0][PBR]["metallicFactor"] = json!(1.5),
        "[0].pbrMetallicRoughness.metallicFactor: 1.5",
    ),
    (
        |m| m.json["materials"][0][PBR]["roughnessFactor"] = json!(-0.1),
        "pbrMetallicRoughness.roughnessFactor: -0.1",
    ),
    (|m| m.json["materials"][0][PBR]["roughnessFactor"] = json!("x"), "materials[0]: invalid type"),
    (
        |m| m.json["materials"][0][PBR]["metallicRoughnessTexture"] = json!({ "index": 9 }),
        "materials[0].pbrMetallicRoughness.metallicRoughnessTexture",
    ),
    (|m| m.json["materials"][0]["normalTexture"] = json!({ "index": 9 }), "materials[0].normalTexture"),
    (
        |m| m.json["materials"][0]["normalTexture"] = json!({ "index": 0, "scale": 1e39 }),
        "materials[0].normalTexture.scale: inf is out of range\n  help: type a finite number",
    ),
    (
        |m| {
            let transform = json!({ "KHR_texture_transform": { "offset": [1] } });
            m.json["materials"][0]["normalTexture"] = json!({ "index": 0, "extensions": transform });
        },
        "materials[0].normalTexture.extensions.KHR_texture_transform: invalid length 1",
    ),
    (|m| m.json["materials"][0]["alphaMode"] = json!("SOLID"), "materials[0].alphaMode"),
    (
        |m| {
            m.json["materials"][0]["alphaMode"] = json!("MASK");
            m.json["materials"][0]["alphaCutoff"] = json!(-1);
        },
        "materials[0].alphaCutoff: -1 is out of range\n  help: type a finite number from 0 on",
    ),
    (|m| m.json["materials"][0]["extensions"] = json!("x"), "materials[0]: invalid type"),
    (|m| extended(m, IOR, &json!(1.5)), "materials[0].extensions.KHR_materials_ior: 1.5 is not an object"),
    (|m| extended(m, IOR, &json!(null)), "materials[0].extensions.KHR_materials_ior: null is not an object"),
    (
        |m| extended(m, IOR, &json!({ "ior": 0.5 })),
        "KHR_materials_ior.ior: 0.5 is out of range\n  help: type a finite",
    ),
    (|m| extended(m, IOR, &json!({ "ior": -1 })), "KHR_materials_ior.ior: -1 is out of range"),
    (|m| extended(m, IOR, &json!({ "ior": 1e39 })), "KHR_materials_ior.ior: inf is out of range"),
    (
        |m| extended(m, IOR, &json!({ "ior": "1.5" })),
        "KHR_materials_ior.ior: a text is not a number\n  help: type",
    ),
    (|m| extended(m, IOR, &json!({ "ior": [1.5] })), "KHR_materials_ior.ior: a list of 1 is not a number"),
    (|m| extended(m, IOR, &json!({ "ior": true })), "KHR_materials_ior.ior: true is not a number"),
    (
        |m| extended(m, "KHR_materials_dispersion", &json!({ "dispersion": -1 })),
        "materials[0].extensions.KHR_materials_dispersion.dispersion: -1 is out of range",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionFactor": u64::MAX })),
        "transmissionFactor: 18446744",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionTexture": { "index": 9 } })),
        "transmissionTexture.index: there is no textures[9]",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionTexture": { "index": u64::MAX } })),
        "transmissionTexture.index: 18446744073709551615",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionTexture": { "index": -1 } })),
        "transmissionTexture: invalid type",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionTexture": {} })),
        "transmissionTexture: missing field `index`",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionTexture": 0 })),
        "KHR_materials_transmission.transmissionTexture: ",
    ),
    (
        |m| extended(m, TRANSMISSION, &json!({ "transmissionTexture": { "index": 0, "texCoord": 2 } })),
        "transmissionTexture.texCoord: TEXCOORD_2",
    ),
    (|m| extended(m, VOLUME, &json!({ "thicknessFactor": -1 })), "KHR_materials_volume.thicknessFactor: -1"),
    (
        |m| extended(m, VOLUME, &json!({ "attenuationDistance": 0 })),
        "KHR_materials_volume.attenuationDistance: 0 is",
    ),
    (
        |m| extended(m, VOLUME, &json!({ "attenuationColor": [1, 2, 1] })),
        "attenuationColor[1]: 2 is out of range",
    ),
    (
        |m| extended(m, VOLUME, &json!({ "attenuationColor": [1, 1] })),
        "attenuationColor: a list of 2 is not a colour",
    ),
    (
        |m| extended(m, SPECULAR, &json!({ "specularFactor": 1.01 })),
        "KHR_materials_specular.specularFactor: 1.01",
    ),
    (
        |m| extended(m, SPECULAR, &json!({ "specularColorFactor": [1, 1, "1"] })),
        "specularColorFactor[2]: a text is not",
    ),
    (
        |m| extended(m, SPECULAR, &json!({ "specularColorFactor": [-1, 1, 1] })),
        "specularColorFactor[0]: -1 is out of range",
    ),
    (
        |m| extended(m, SPECULAR, &json!({ "specularColorFactor": [1, 1, 1, 1] })),
        "specularColorFactor: a list of 4",
    ),
    (
        |m| extended(m, CLEARCOAT, &json!({ "clearcoatFactor": 2 })),
        "KHR_materials_clearcoat.clearcoatFactor: 2",
    ),
    (
        |m| extended(m, CLEARCOAT, &json!({ "clearcoatRoughnessFactor": {} })),
        "clearcoatRoughnessFactor: an object is not",
    ),
    (
        |m| extended(m, CLEARCOAT, &json!({ "clearcoatNormalTexture": { "index": 1 } })),
        "clearcoatNormalTexture.index: there is no textures[1]",
    ),
    (
        |m| extended(m, CLEARCOAT, &json!({ "clearcoatNormalTexture": { "index": 0, "scale": "1" } })),
        "materials[0].extensions.KHR_materials_clearcoat.clearcoatNormalTexture: invalid type",
    ),
];

#[test]
fn materials_at_fault_are_named_with_what_to_type() {
    check(textured, MATERIALS);
}

#[test]
fn every_fault_of_an_extension_is_reported() {
    let mut model = Model::triangle();
    textured(&mut model);
    let specular = json!({ "specularFactor": 2, "specularColorFactor": [-1, "1", 1] });
    let extensions = json!({ SPECULAR: specular, IOR: { "ior": 0.5 } });
    model.json["materials"][0]["extensions"] = extensions;
    assert_eq!(faults(model.load()).len(), 4);
}
