//! Malformed glTF files: each is refused with the file and the element, none is a panic.

use super::*;

/// A change for the worse, and what the message must say.
pub(crate) type Case = (fn(&mut Model), &'static str);

pub(crate) fn textured(model: &mut Model) {
    model.textured(&png(1, &[[1, 2, 3, 255]]));
}

const ACCESSORS: &[Case] = &[
    (
        |m| m.json["accessors"][0]["count"] = json!(4),
        "primitives[0].attributes.POSITION: accessors[0]: 4 elements",
    ),
    (|m| m.json["accessors"][0]["count"] = json!(u64::MAX), "attributes.POSITION: accessors[0]"),
    (|m| m.json["accessors"][0]["count"] = json!(-1), "accessors[0]: invalid value"),
    (|m| m.json["accessors"][0]["count"] = json!(1.5), "accessors[0]: invalid type"),
    (|m| m.json["accessors"][0]["byteOffset"] = json!(u64::MAX), "attributes.POSITION: accessors[0]"),
    (|m| m.json["accessors"][0]["byteOffset"] = json!(4), "attributes.POSITION: accessors[0]"),
    (|m| m.json["accessors"][0]["type"] = json!("SCALAR"), "attributes.POSITION: Scalar of F32"),
    (|m| m.json["accessors"][0]["type"] = json!("VEC9"), "accessors[0].type"),
    (|m| m.json["accessors"][0]["componentType"] = json!(U8), "attributes.POSITION: Vec3 of U8"),
    (|m| m.json["accessors"][0]["componentType"] = json!(7), "accessors[0].componentType"),
    (|m| m.json["accessors"][0]["componentType"] = json!((1_u64 << 32) + 5126), "accessors[0].componentType"),
    (|m| m.json["accessors"][0]["bufferView"] = json!(9), "accessors[0].bufferView"),
    (|m| m.json["accessors"][0]["bufferView"] = json!(1_u64 << 32), "accessors[0].bufferView"),
    (|m| m.json["accessors"][1]["componentType"] = json!(F32), "primitives[0].indices"),
    (|m| m.json["accessors"][1]["type"] = json!("VEC2"), "primitives[0].indices: "),
    (
        |m| {
            m.json["accessors"][1]["type"] = json!("VEC3");
            m.json["accessors"][1]["count"] = json!(1);
        },
        "primitives[0].indices: Vec3",
    ),
    (|m| m.json["accessors"][1]["count"] = json!(2), "primitives[0].indices: 2 corners"),
    (|m| m.bin[40] = 3, "primitives[0].indices: number 2 is vertex 3"),
    (|m| m.bin[0..4].copy_from_slice(&f32::NAN.to_le_bytes()), "attributes.POSITION: vertex 0 is [NaN"),
    (
        |m| m.bin[16..20].copy_from_slice(&f32::INFINITY.to_le_bytes()),
        "attributes.POSITION: vertex 1 is [1.0, inf",
    ),
    (
        |m| m.json["bufferViews"][0]["byteStride"] = json!(8),
        "attributes.POSITION: accessors[0]: byteStride is 8",
    ),
    (|m| m.json["bufferViews"][0]["byteStride"] = json!(0), "bufferViews[0].byteStride"),
    (
        |m| m.json["bufferViews"][0]["byteLength"] = json!(1000),
        "attributes.POSITION: accessors[0]: bufferViews[0]",
    ),
    (|m| m.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX), "bufferViews[0] wants"),
    (|m| m.json["bufferViews"][0]["buffer"] = json!(1), "bufferViews[0].buffer"),
    (|m| m.json["buffers"] = json!([{ "byteLength": 1000 }]), "buffers[0]: byteLength says 1000"),
    (
        |m| m.json["buffers"] = json!([{ "byteLength": 4, "uri": "data:,%00" }]),
        "buffers[0]: byteLength says 4",
    ),
    (|m| m.json["buffers"] = json!([{ "byteLength": 4, "uri": "data:;base64,?" }]), "buffers[0]: a data URI"),
    (|m| m.json["buffers"] = json!([{ "byteLength": 0 }, { "byteLength": 1 }]), "buffers[1]: has no uri"),
    (
        |m| {
            let normals = m.floats("VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
            m.attribute("NORMAL", normals);
        },
        "attributes.NORMAL: has 2 elements, but POSITION has 3",
    ),
    (
        |m| {
            let colors = m.accessor(U8, "VEC4", 3, &[0; 12]);
            m.attribute("COLOR_0", colors);
        },
        "attributes.COLOR_0: Vec4 of U8",
    ),
    (
        |m| {
            let accessor = json!({ "componentType": F32, "type": "VEC3", "count": 4_000_000_000_u32 });
            m.json["accessors"][0] = accessor;
        },
        "attributes.POSITION: accessors[0]: 4000000000 elements without a bufferView",
    ),
    (|m| sparse(m, 4_000_000_000, 0, 2), "accessors[0]: sparse.indices: 4000000000 elements"),
    (|m| sparse(m, 1, 0, 9), "accessors[0]: sparse.indices: 9 is out of range"),
    (|m| sparse(m, 1, 8, 2), "accessors[0]: sparse.values"),
];

/// Makes the positions sparse.
fn sparse(model: &mut Model, count: u64, offset: u64, place: u8) {
    let places = model.view(&[place, 0]);
    let values = model.view(&[0; 12]);
    model.json["accessors"][0]["sparse"] = json!({
        "count": count,
        "indices": { "bufferView": places, "componentType": U16 },
        "values": { "bufferView": values, "byteOffset": offset },
    });
}

const STRUCTURE: &[Case] = &[
    (|m| m.json["asset"]["version"] = json!("1.0"), "asset.version"),
    (|m| m.json["asset"]["version"] = json!(2), "asset.version"),
    (|m| m.json["asset"] = json!(null), "asset.version"),
    (|m| m.json["asset"]["minVersion"] = json!("2.1"), "asset.minVersion"),
    (|m| m.json["scene"] = json!(5), "scene"),
    (|m| m.json["scenes"][0]["nodes"] = json!([7]), "scenes[0].nodes[0]"),
    (|m| m.json["scenes"][0]["nodes"] = json!([0, 0]), "scenes[0].nodes[1]: nodes[0] is named twice"),
    (|m| m.json["nodes"][0]["mesh"] = json!(5), "nodes[0].mesh"),
    (|m| m.json["nodes"][0]["mesh"] = json!("Tri"), "nodes[0]: invalid type"),
    (|m| m.json["nodes"][0]["children"] = json!([0]), "nodes[0]: is its own ancestor"),
    (|m| m.json["nodes"][0]["children"] = json!([1]), "nodes[0].children[0]"),
    (
        |m| m.json["nodes"] = json!([{ "mesh": 0 }, { "children": [2] }, { "children": [1] }]),
        "nodes[1]: is its own ancestor",
    ),
    (
        |m| m.json["nodes"] = json!([{ "children": [2] }, { "children": [2] }, { "mesh": 0 }]),
        "nodes[2]: is a child of both nodes[0] and nodes[1]",
    ),
    (
        |m| {
            m.json["nodes"] = json!([{ "children": [1] }, { "mesh": 0 }]);
            m.json["scenes"] = json!([{ "nodes": [1] }]);
        },
        "scenes[0].nodes[0]: nodes[1] is no root",
    ),
    (|m| m.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]), "nodes[0].rotation"),
    (|m| m.json["nodes"][0]["translation"] = json!([1e39, 0, 0]), "nodes[0].translation"),
    (|m| m.json["nodes"][0]["translation"] = json!([0, 0]), "nodes[0]: invalid length"),
    (
        |m| m.json["nodes"][0]["matrix"] = json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
        "nodes[0].matrix",
    ),
    (|m| m.json["nodes"][0]["camera"] = json!(0), "nodes[0].camera"),
    (|m| m.json["meshes"][0]["primitives"] = json!(null), "meshes[0]: invalid type"),
    (
        |m| m.json["meshes"][0]["primitives"][0]["attributes"] = json!({}),
        "primitives[0].attributes.POSITION: is missing",
    ),
    (
        |m| m.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(8),
        "attributes.POSITION: there is no accessors[8]",
    ),
    (|m| m.json["meshes"][0]["primitives"][0]["indices"] = json!(8), "meshes[0].primitives[0].indices"),
    (|m| m.json["meshes"][0]["primitives"][0]["mode"] = json!(8), "meshes[0].primitives[0].mode"),
    (|m| m.json["meshes"][0]["primitives"][0]["material"] = json!(0), "meshes[0].primitives[0].material"),
    (|m| m.json["materials"] = json!([{ "emissiveFactor": [-1, 0, 0] }]), "materials[0].emissiveFactor"),
    (
        |m| m.json["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorFactor": [1e39, 0, 0, 1] } }]),
        "materials[0].pbrMetallicRoughness.baseColorFactor",
    ),
    (
        |m| {
            m.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0, "znear": 1 } }]);
            m.json["nodes"][0]["camera"] = json!(0);
        },
        "cameras[0].perspective.yfov",
    ),
    (
        |m| {
            let light = json!({ "type": "spot", "spot": { "innerConeAngle": 1, "outerConeAngle": 0.5 } });
            m.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
            m.json["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
        },
        "lights[0].spot",
    ),
];

const PICTURES: &[Case] = &[
    (|m| m.json["images"][0] = json!({}), "images[0]: has neither"),
    (|m| m.json["images"][0] = json!({ "uri": "gone.png" }), "images[0]: cannot find `gone.png`"),
    (|m| m.json["images"][0] = json!({ "uri": "../gone.png" }), "images[0]: `../gone.png` leaves"),
    (|m| m.json["images"][0] = json!({ "uri": "data:image/png;base64,AAAA" }), "images[0]: this picture"),
    (|m| m.json["images"][0]["bufferView"] = json!(77), "images[0].bufferView"),
    (|m| m.json["bufferViews"][2]["byteLength"] = json!(1000), "images[0]: bufferViews[2]"),
    (|m| m.json["bufferViews"][2]["byteLength"] = json!(40), "images[0]: this picture cannot be decoded"),
    (|m| m.json["textures"][0]["source"] = json!(3), "textures[0].source"),
    (|m| m.json["textures"][0] = json!({}), "textures[0].source"),
    (|m| m.json["textures"][0]["sampler"] = json!(3), "textures[0].sampler"),
    (
        |m| m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(3),
        "baseColorTexture.index",
    ),
    (
        |m| m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = json!(2),
        "materials[0].pbrMetallicRoughness.baseColorTexture.texCoord",
    ),
    (huge, "images[0]: this picture cannot be decoded: "),
];

/// A PNG that says it is 100000 pixels square.
fn huge(model: &mut Model) {
    let mut bytes = png(1, &[[0; 4]]);
    let side = 100_000_u32.to_be_bytes();
    bytes[16..24].copy_from_slice(&[side, side].concat());
    let crc = bytes[12..29].iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1)))
    });
    bytes[29..33].copy_from_slice(&(!crc).to_be_bytes());
    let view = model.view(&bytes);
    model.json["images"][0]["bufferView"] = json!(view);
}

pub(crate) fn check(prepare: fn(&mut Model), cases: &[Case]) {
    for (i, (spoil, element)) in cases.iter().enumerate() {
        let mut model = Model::triangle();
        prepare(&mut model);
        assert!(model.load().is_ok());
        spoil(&mut model);
        let result = model.load();
        assert!(result.is_err(), "case {i} ({element}) was let pass");
        let said: Vec<_> = faults(result).iter().map(ToString::to_string).collect();
        assert!(said.iter().all(|said| said.contains("model.glb: ")), "case {i}: {said:?}");
        assert!(said.iter().any(|said| said.contains(element)), "case {i} ({element}): {said:?}");
        assert!(!said.iter().any(|said| said.contains("foreseen")), "case {i} was a panic");
    }
}

#[test]
fn accessors_at_fault_are_named() {
    check(|_| (), ACCESSORS);
}

#[test]
fn structure_at_fault_is_named() {
    check(|_| (), STRUCTURE);
}

#[test]
fn pictures_at_fault_are_named() {
    check(textured, PICTURES);
}

#[test]
fn every_fault_is_reported_not_only_the_first() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{ "mesh": 5 }, { "camera": 2 }, { "children": [9] }]);
    assert_eq!(faults(model.load()).len(), 3);
    let many: Vec<_> = (0..200).map(|_| json!({ "mesh": 5 })).collect();
    model.json["nodes"] = json!(many);
    let faults = faults(model.load());
    assert_eq!(faults.len(), 51);
    assert!(faults[50].to_string().contains("150 more faults"));
}

#[test]
fn container_at_fault_is_named() {
    let glb = Model::triangle().glb();
    let with = |at: usize, value: u32| {
        let mut bytes = glb.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let cases: [(Vec<u8>, &str); 12] = [
        (Vec::new(), "JSON"),
        (b"glTF".to_vec(), "GLB header"),
        (glb[..11].to_vec(), "GLB header"),
        (glb[..100].to_vec(), "GLB header: says"),
        (with(4, 1), "GLB header: is version 1"),
        (with(8, 3), "GLB header"),
        (with(8, u32::MAX), "GLB header: says 4294967295"),
        (with(12, u32::MAX), "GLB chunk header"),
        (with(12, 8), "GLB chunk header"),
        (with(16, 7), "GLB chunk header"),
        (b"[]".to_vec(), "JSON: is not an object"),
        (vec![b'['; 100_000], "JSON: recursion limit"),
    ];
    for (bytes, element) in cases {
        let said = faults(load_files("m.glb", &[("m.glb", &bytes)]))[0].to_string();
        assert!(said.contains("m.glb: ") && said.contains(element), "{element}: {said}");
    }
}
