//! Extensions of materials.

use super::*;
use glam::DVec2;
use terrell::import::{Material, Volume};
use terrell::texture::Texture;

/// A model whose material has extensions, of which each texture `{ "index": 0 }` is one texel.
fn model(extensions: &Value) -> Model {
    let mut model = Model::triangle();
    model.texture(&png(1, &[[188, 51, 0, 102]]));
    let names: Vec<_> = extensions.as_object().unwrap().keys().cloned().collect();
    model.json["extensionsUsed"] = json!(names);
    model.with_material(&json!({ "name": "M", "pbrMetallicRoughness": {}, "extensions": extensions }))
}

fn material(extensions: &Value) -> Material {
    let asset = model(extensions).asset();
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
    asset.materials[0].clone()
}

fn value(texture: Option<&Texture>) -> [f32; 4] {
    texture.unwrap().rgba(DVec2::ZERO)
}

const LINEAR: [f32; 4] = [188.0 / 255.0, 51.0 / 255.0, 0.0, 102.0 / 255.0];

#[test]
fn refractive_index_is_one_and_a_half_unless_written() {
    let ior = |written: Value| material(&json!({ "KHR_materials_ior": written })).ior;
    assert_eq!(ior(json!({})), 1.5);
    assert_eq!(ior(json!({ "ior": 2.42 })), 2.42);
    assert_eq!(ior(json!({ "ior": 1 })), 1.0);
    assert_eq!(ior(json!({ "ior": 0 })), 0.0, "zero stands for infinite");
}

#[test]
fn dispersion_is_none_unless_written() {
    assert_eq!(material(&json!({ "KHR_materials_dispersion": {} })).dispersion, 0.0);
    assert_eq!(material(&json!({ "KHR_materials_dispersion": { "dispersion": 0.36 } })).dispersion, 0.36);
}

#[test]
fn transmission_has_an_amount_and_a_linear_texture() {
    let written = json!({ "transmissionFactor": 0.75, "transmissionTexture": { "index": 0, "texCoord": 1 } });
    let transmission = material(&json!({ "KHR_materials_transmission": written })).transmission.unwrap();
    assert_eq!(transmission.amount, 0.75);
    assert_eq!(value(transmission.texture.as_ref()), LINEAR);
    assert_eq!(transmission.texture.unwrap().uv_set, 1);
    assert!(material(&json!({ "KHR_materials_transmission": {} })).transmission.is_none());
}

#[test]
fn volume_is_one_where_its_thickness_is_not_zero() {
    let volume = |written: Value| material(&json!({ "KHR_materials_volume": written })).volume;
    let written = json!({ "thicknessFactor": 2, "thicknessTexture": { "index": 0 }, "attenuationDistance": 0.5,
        "attenuationColor": [1, 0.5, 0] });
    let expected = Volume { thickness: 2.0, attenuation_distance: 0.5, attenuation_color: [1.0, 0.5, 0.0] };
    assert_eq!(volume(written), Some(expected));
    let clear = Volume { thickness: 1.0, attenuation_distance: f32::INFINITY, attenuation_color: [1.0; 3] };
    assert_eq!(volume(json!({ "thicknessFactor": 1 })), Some(clear));
    assert_eq!(volume(json!({ "thicknessFactor": 1, "attenuationDistance": null })), Some(clear));
    assert_eq!(volume(json!({ "attenuationDistance": 0.5 })), None);
}

#[test]
fn specular_has_strength_and_colour_with_textures_linear_and_not() {
    let written = json!({ "specularFactor": 0.25, "specularTexture": { "index": 0 },
        "specularColorFactor": [2, 1, 0.5], "specularColorTexture": { "index": 0 } });
    let specular = material(&json!({ "KHR_materials_specular": written })).specular;
    assert_eq!((specular.strength, specular.color), (0.25, [2.0, 1.0, 0.5]));
    assert_eq!(value(specular.texture.as_ref()), LINEAR, "strength is in A, which is kept");
    assert!((value(specular.color_texture.as_ref())[0] - 0.503).abs() < 1e-3, "a colour is sRGB");
    let empty = material(&json!({ "KHR_materials_specular": {} })).specular;
    assert_eq!((empty.strength, empty.color), (1.0, [1.0; 3]));
}

#[test]
fn clearcoat_has_strength_roughness_and_bumps_of_its_own() {
    let transform = json!({ "KHR_texture_transform": { "scale": [2, 2] } });
    let written = json!({
        "clearcoatFactor": 0.5, "clearcoatTexture": { "index": 0 },
        "clearcoatRoughnessFactor": 0.125, "clearcoatRoughnessTexture": { "index": 0, "texCoord": 1 },
        "clearcoatNormalTexture": { "index": 0, "scale": 0.75, "extensions": transform },
    });
    let material_with = |written: &Value| material(&json!({ "KHR_materials_clearcoat": written }));
    let with = material_with(&written);
    assert!(with.has_normal_map() && with.normal.is_none());
    let coat = with.clearcoat.unwrap();
    assert_eq!((coat.strength, coat.roughness), (0.5, 0.125));
    assert_eq!(value(coat.texture.as_ref()), LINEAR);
    assert_eq!(value(coat.roughness_texture.as_ref()), LINEAR);
    assert_eq!((coat.texture.unwrap().uv_set, coat.roughness_texture.unwrap().uv_set), (0, 1));
    let bumps = coat.normal.unwrap();
    assert_eq!((bumps.scale, value(Some(&bumps.texture))), (0.75, LINEAR));
    assert_eq!(bumps.texture.transform.transform_point2(DVec2::ONE), DVec2::splat(2.0));
    let smooth = material_with(&json!({ "clearcoatFactor": 1 })).clearcoat.unwrap();
    assert_eq!((smooth.roughness, smooth.normal.is_none()), (0.0, true));
    assert!(material_with(&json!({})).clearcoat.is_none());
}

#[test]
fn extensions_of_materials_that_are_read_may_be_required() {
    let names = ["clearcoat", "dispersion", "ior", "specular", "transmission", "volume"];
    let names = names.map(|name| format!("KHR_materials_{name}"));
    let extensions: Value =
        names.iter().map(|name| (name.clone(), json!({}))).collect::<serde_json::Map<_, _>>().into();
    let mut model = model(&extensions);
    model.json["extensionsRequired"] = json!(names);
    assert!(model.asset().warnings.is_empty());
}

#[test]
fn occlusion_is_left_out_without_a_word() {
    let mut model = model(&json!({}));
    model.json["materials"][0]["occlusionTexture"] = json!({ "index": 0 });
    let asset = model.asset();
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
    assert_eq!(asset.materials[0].textures().count(), 0);
}

#[test]
fn extensions_passed_over_are_warned_of_once_with_their_materials() {
    let mut model =
        model(&json!({ "KHR_materials_sheen": { "sheenRoughnessFactor": 1 }, "KHR_materials_ior": {} }));
    for i in 0..7 {
        let material = json!({ "name": format!("M{i}"), "pbrMetallicRoughness": {},
            "extensions": { "KHR_materials_sheen": {} } });
        push(&mut model.json["materials"], material);
    }
    model.json["materials"][1]["extensions"]["KHR_materials_anisotropy"] = json!({});
    model.json["materials"][2]["name"] = json!(null);
    model.json["extensionsUsed"] =
        json!(["KHR_materials_sheen", "KHR_materials_anisotropy", "KHR_xmp_json_ld"]);
    let asset = model.asset();
    let said: Vec<_> = asset.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(said.len(), 3, "{said:?}");
    assert!(said[0].contains("extensionsUsed: passed over: KHR_xmp_json_ld"), "{said:?}");
    assert!(said[1].contains("KHR_materials_anisotropy is passed over; without it shown: `M0`"), "{said:?}");
    let names =
        "KHR_materials_sheen is passed over; without it shown: `M`, `M0`, materials[2], `M2`, `M3`, 3 more";
    assert!(said[2].contains(names), "{said:?}");
    assert_eq!(asset.ignored[&0], ["KHR_materials_sheen"]);
    assert_eq!(asset.ignored[&1], ["KHR_materials_anisotropy", "KHR_materials_sheen"]);
}
