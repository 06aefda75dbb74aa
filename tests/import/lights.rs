//! Lights, cameras and extensions.

use super::*;
use glam::DVec3;
use terrell::import::LightKind;

#[test]
fn lights_keep_their_kind_their_units_and_their_place() {
    let mut model = Model::triangle();
    model.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    model.json["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    model.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "point", "name": "Bulb", "intensity": 54351.4, "color": [1, 0.5, 0.25] },
        { "type": "spot", "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } },
        { "type": "directional", "intensity": 2049 },
    ] } });
    let node =
        |light: u32| json!({ "name": "Lamp", "extensions": { "KHR_lights_punctual": { "light": light } } });
    let mut sun = node(2);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // Looks down instead of along -z.
    sun["rotation"] = json!([-half, 0, 0, half]);
    model.json["nodes"] = json!([node(0), node(1), sun, { "mesh": 0 }]);
    model.json["scenes"] = json!([{ "nodes": [0, 1, 2, 3] }]);
    let lights = model.asset().lights;
    assert_eq!(lights[0].name, "Bulb");
    assert_eq!(lights[0].kind, LightKind::Point);
    assert_eq!(lights[0].color, [1.0, 0.5, 0.25]);
    assert!((lights[0].intensity - 54351.4).abs() < 0.01);
    assert_eq!(lights[1].kind, LightKind::Spot { inner: 0.25, outer: 0.5 });
    assert_eq!((lights[1].name.as_str(), lights[1].intensity), ("Lamp", 1.0));
    assert_eq!(lights[2].kind, LightKind::Sun);
    let down = lights[2].asset_from_light.transform_vector3(DVec3::NEG_Z);
    assert!((down - DVec3::NEG_Y).length() < 1e-6, "{down}");
    assert_eq!(lights[2].node, 2);
}

#[test]
fn cameras_have_a_place_and_a_field_of_view() {
    let mut model = Model::triangle();
    model.json["cameras"] = json!([
        { "name": "Eye", "type": "perspective", "perspective": { "yfov": 0.5, "aspectRatio": 1.5, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 4, "ymag": 2, "znear": 0.1, "zfar": 9 } },
    ]);
    model.json["nodes"] = json!([
        { "camera": 0, "translation": [1, 2, 3] }, { "name": "Plan", "camera": 1 }, { "mesh": 0 },
    ]);
    model.json["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    let cameras = model.asset().cameras;
    assert_eq!(
        (cameras[0].name.as_str(), cameras[0].vertical_fov, cameras[0].aspect),
        ("Eye", Some(0.5), Some(1.5))
    );
    assert_eq!(cameras[0].asset_from_camera.translation, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(
        (cameras[1].name.as_str(), cameras[1].vertical_fov, cameras[1].aspect),
        ("Plan", None, Some(2.0))
    );
}

#[test]
fn extensions_that_are_required_and_unknown_are_refused_by_name_all_at_once() {
    let mut model = Model::triangle();
    let required =
        ["KHR_draco_mesh_compression", "KHR_texture_transform", "KHR_materials_sheen", "KHR_texture_basisu"];
    model.json["extensionsRequired"] = json!(required);
    model.json["extensionsUsed"] = json!(required);
    let faults = faults(model.load());
    assert_eq!(faults.len(), 3);
    for (fault, name) in faults.iter().zip([required[0], required[2], required[3]]) {
        assert!(fault.to_string().contains(name), "{fault}");
        assert!(fault.to_string().contains("model.glb: extensionsRequired["), "{fault}");
    }
}

#[test]
fn extensions_that_are_only_used_are_warned_of() {
    let mut model = Model::triangle();
    model.json["extensionsUsed"] = json!(["KHR_materials_sheen", "KHR_materials_unlit"]);
    let asset = model.asset();
    assert_eq!(asset.warnings.len(), 1);
    assert!(warns(&asset, "KHR_materials_sheen"));
}
