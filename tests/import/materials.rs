//! Materials and textures of glTF files.

use super::*;
use glam::{DVec2, Vec2};
use terrell::import::{Coverage, Material};
use terrell::texture::{Encoding, Filter, Texels, Texture, Wrap};

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];
const GREY: [u8; 4] = [188, 188, 188, 128];

fn with_uvs() -> Model {
    let mut model = Model::triangle();
    for set in ["TEXCOORD_0", "TEXCOORD_1"] {
        let uvs = model.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        model.attribute(set, uvs);
    }
    model
}

#[test]
fn base_colour_texture_is_decoded_from_srgb_with_its_upper_left_corner_first() {
    let mut model = with_uvs();
    model.textured(&png(2, &[RED, GREEN, BLUE, GREY]));
    let asset = model.asset();
    let texture = asset.materials[0].base_texture.as_ref().unwrap();
    assert_eq!(texture.rgba(DVec2::new(0.25, 0.25)), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(texture.rgba(DVec2::new(0.75, 0.25)), [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(texture.rgba(DVec2::new(0.25, 0.75)), [0.0, 0.0, 1.0, 1.0]);
    let grey = texture.rgba(DVec2::new(0.75, 0.75));
    assert!((grey[0] - 0.503).abs() < 1e-3, "188 is half the light of 255, not {}", grey[0]);
    assert_eq!(texture.wrap, [Wrap::Repeat; 2]);
    assert_eq!(texture.filter, Filter::Linear);
}

#[test]
fn alpha_is_kept_only_where_the_material_says_what_it_means() {
    let mut model = with_uvs();
    let material = model.textured(&png(1, &[GREY]));
    let pbr = json!({ "baseColorTexture": { "index": 0 }, "baseColorFactor": [1, 1, 1, 0.5] });
    model.json["materials"][material]["pbrMetallicRoughness"] = pbr;
    let mut blending = model.json["materials"][material].clone();
    blending["alphaMode"] = json!("BLEND");
    push(&mut model.json["materials"], blending);
    let materials = model.asset().materials;
    let alpha = |i: usize| materials[i].base_texture.as_ref().unwrap().rgba(DVec2::ZERO)[3];
    assert_eq!((materials[0].base_color[3], alpha(0)), (1.0, 1.0));
    assert_eq!((materials[1].base_color[3], alpha(1)), (0.5, 128.0 / 255.0));
}

#[test]
fn sampler_says_how_a_texture_goes_on() {
    let mut model = with_uvs();
    model.textured(&png(1, &[RED]));
    model.json["samplers"] =
        json!([{ "magFilter": 9728, "minFilter": 9984, "wrapS": 33071, "wrapT": 33648 }]);
    model.json["textures"][0]["sampler"] = json!(0);
    let asset = model.asset();
    let texture = asset.materials[0].base_texture.as_ref().unwrap();
    assert_eq!(texture.filter, Filter::Nearest);
    assert_eq!(texture.wrap, [Wrap::Clamp, Wrap::Mirror]);
}

#[test]
fn texture_transform_scales_turns_and_moves_in_this_order() {
    let mut model = with_uvs();
    let material = model.textured(&png(1, &[RED]));
    let quarter = std::f64::consts::FRAC_PI_2;
    let transform = json!({ "scale": [2, 3], "rotation": quarter, "offset": [10, 20], "texCoord": 1 });
    model.json["extensionsUsed"] = json!(["KHR_texture_transform"]);
    model.json["extensionsRequired"] = json!(["KHR_texture_transform"]);
    model.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": transform });
    let asset = model.asset();
    let texture = asset.materials[0].base_texture.as_ref().unwrap();
    assert_eq!(texture.uv_set, 1);
    // Counter-clockwise as seen where v points down: +u turns to -v, +v to +u.
    let u = texture.transform.transform_point2(DVec2::X);
    let v = texture.transform.transform_point2(DVec2::Y);
    assert!((u - DVec2::new(10.0, 18.0)).length() < 1e-6, "{u}");
    assert!((v - DVec2::new(13.0, 20.0)).length() < 1e-6, "{v}");
}

#[test]
fn texture_without_coordinates_is_warned_of() {
    let mut model = Model::triangle();
    model.textured(&png(1, &[RED]));
    assert!(warns(&model.asset(), "there is no TEXCOORD_0"));
}

#[test]
fn pictures_keep_their_width_and_are_known_by_their_contents() {
    let wide = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(1, 1, vec![40000_u16]).unwrap();
    let wide = image::DynamicImage::ImageLuma16(wide);
    let float = image::Rgb32FImage::from_raw(1, 1, vec![0.25, 2.0, 4.0]).unwrap();
    let float = image::DynamicImage::ImageRgb32F(float);
    let plain = image::RgbImage::from_raw(1, 1, vec![255, 255, 255]).unwrap();
    let plain = image::DynamicImage::ImageRgb8(plain);
    let encode = |image: &image::DynamicImage, format| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    };
    let decoded = |bytes: Vec<u8>| {
        let mut model = with_uvs();
        model.textured(&png(1, &[RED]));
        model.json["images"] = json!([{ "uri": "wrong name.png" }]);
        let files = [("m.glb", &model.glb()[..]), ("wrong name.png", &bytes)];
        let asset = load_files("m.glb", &files).unwrap_or_else(|error| panic!("{error}"));
        asset.materials[0].base_texture.clone().unwrap().picture
    };
    let picture = decoded(encode(&wide, image::ImageFormat::Png));
    assert!(matches!(&picture.texels, Texels::Word(v) if v[0] == [40000, 40000, 40000, 65535]));
    assert_eq!(picture.encoding, Encoding::Srgb);
    let picture = decoded(encode(&float, image::ImageFormat::OpenExr));
    assert!(matches!(&picture.texels, Texels::Float(v) if v[0] == [0.25, 2.0, 4.0, 1.0]));
    assert_eq!(picture.encoding, Encoding::Linear);
    let picture = decoded(encode(&plain, image::ImageFormat::Jpeg));
    assert!(matches!(&picture.texels, Texels::Byte(v) if v[0] == [255; 4]));
}

#[test]
fn one_picture_is_decoded_once_for_all_materials() {
    let mut model = with_uvs();
    let material = model.textured(&png(1, &[RED]));
    let copy = model.json["materials"][material].clone();
    push(&mut model.json["materials"], copy);
    let materials = model.asset().materials;
    let picture = |i: usize| materials[i].base_texture.as_ref().unwrap().picture.clone();
    assert!(std::sync::Arc::ptr_eq(&picture(0), &picture(1)));
}

#[test]
fn glow_is_factor_times_strength() {
    let mut model = Model::triangle();
    model.json["extensionsUsed"] = json!(["KHR_materials_emissive_strength", "KHR_materials_unlit"]);
    model.json["materials"] = json!([
        { "name": "Lamp", "emissiveFactor": [1, 0.5, 0],
          "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 20 } } },
        { "extensions": { "KHR_materials_unlit": {} } },
    ]);
    let asset = model.asset();
    assert_eq!(asset.materials[0].emissive, [20.0, 10.0, 0.0]);
    assert_eq!((asset.materials[0].unlit, asset.materials[1].unlit), (false, true));
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
}

#[test]
fn material_without_a_colour_is_warned_of_with_blender_in_mind() {
    let mut model = Model::triangle();
    model.json["materials"] = json!([{ "name": "Clay" }, { "name": "White", "pbrMetallicRoughness": {} }]);
    let asset = model.asset();
    assert!(warns(
        &asset,
        "materials[0]: material `Clay` has no colour in the file: was it a Principled BSDF?"
    ));
    assert_eq!(asset.warnings.len(), 1);
}

#[test]
fn vertex_colours_stay_linear() {
    let mut model = Model::triangle();
    let colors = model.floats("VEC3", &[0.5, 0.25, 2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    model.attribute("COLOR_0", colors);
    let mesh = model.asset().meshes[0].clone();
    assert_eq!(mesh.colors[0], [0.5, 0.25, 2.0, 1.0]);
    assert_eq!(mesh.uvs[0], Vec::<Vec2>::new());
}

fn material(model: &Model) -> Material {
    let asset = model.asset();
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
    asset.materials[0].clone()
}

/// The value in the middle of a texture.
fn value(texture: &Texture) -> [f32; 4] {
    texture.rgba(DVec2::splat(0.5))
}

#[test]
fn triangles_without_a_material_are_white_and_purely_diffuse() {
    let material = material(&Model::triangle());
    assert_eq!(material.base_color, [1.0; 4]);
    assert_eq!((material.metal.metallic, material.metal.roughness), (0.0, 1.0));
    assert_eq!(material.specular.strength, 0.0);
    assert!(material.transmission.is_none() && material.clearcoat.is_none() && material.volume.is_none());
}

#[test]
fn empty_material_has_the_specifications_defaults() {
    let material = material(&Model::triangle().with_material(&json!({ "pbrMetallicRoughness": {} })));
    assert_eq!(material.base_color, [1.0; 4]);
    assert_eq!((material.metal.metallic, material.metal.roughness), (1.0, 1.0));
    assert_eq!(material.coverage, Coverage::Opaque);
    assert!(!material.double_sided && !material.unlit);
    assert_eq!((material.ior, material.dispersion), (1.5, 0.0));
    assert_eq!((material.specular.strength, material.specular.color), (1.0, [1.0; 3]));
    assert!(material.normal.is_none() && material.clearcoat.is_none());
    assert!(material.transmission.is_none() && material.volume.is_none());
    assert_eq!(material.textures().count(), 0);
}

#[test]
fn metalness_and_roughness_are_factors_with_a_linear_texture() {
    let mut model = Model::triangle();
    let texture = model.texture(&png(1, &[[0, 188, 51, 7]]));
    let material = material(&model.with_material(&json!({ "doubleSided": true, "pbrMetallicRoughness": {
        "metallicFactor": 0.25, "roughnessFactor": 0.5, "metallicRoughnessTexture": { "index": texture, "texCoord": 1 },
    } })));
    assert!(material.double_sided);
    assert_eq!((material.metal.metallic, material.metal.roughness), (0.25, 0.5));
    let texture = material.metal.texture.unwrap();
    assert_eq!(texture.uv_set, 1);
    let [_, roughness, metallic, _] = value(&texture);
    assert_eq!((roughness, metallic), (188.0 / 255.0, 51.0 / 255.0), "numbers, not colours");
}

#[test]
fn normal_map_is_linear_with_a_scale_of_any_sign_and_a_transform() {
    let mut model = Model::triangle();
    let texture = model.texture(&png(1, &[[188, 0, 255, 255]]));
    let transform = json!({ "KHR_texture_transform": { "offset": [0.25, 0], "texCoord": 1 } });
    let written = json!({ "index": texture, "scale": -2, "extensions": transform });
    let plain = json!({ "index": texture });
    let mut model = model.with_material(&json!({ "normalTexture": written, "pbrMetallicRoughness": {} }));
    push(&mut model.json["materials"], json!({ "normalTexture": plain, "pbrMetallicRoughness": {} }));
    let materials = model.asset().materials;
    assert!(materials[0].has_normal_map());
    let [map, plain] = [0, 1].map(|i| materials[i].normal.clone().unwrap());
    assert_eq!((map.scale, plain.scale), (-2.0, 1.0));
    assert_eq!(value(&map.texture)[0], 188.0 / 255.0);
    assert_eq!((map.texture.uv_set, plain.texture.uv_set), (1, 0));
    assert_eq!(map.texture.transform.translation, DVec2::new(0.25, 0.0));
}

#[test]
fn coverage_is_opaque_masked_or_blended() {
    let coverage = |mut written: Value| {
        written["pbrMetallicRoughness"] = json!({ "baseColorFactor": [1, 1, 1, 0.5] });
        let material = material(&Model::triangle().with_material(&written));
        (material.coverage, material.base_color[3])
    };
    assert_eq!(coverage(json!({ "alphaMode": "OPAQUE", "alphaCutoff": 0.1 })), (Coverage::Opaque, 1.0));
    assert_eq!(coverage(json!({ "alphaMode": "MASK" })), (Coverage::Mask { cutoff: 0.5 }, 0.5));
    let cutoff = json!({ "alphaMode": "MASK", "alphaCutoff": 1.25 });
    assert_eq!(coverage(cutoff), (Coverage::Mask { cutoff: 1.25 }, 0.5));
    assert_eq!(coverage(json!({ "alphaMode": "BLEND" })), (Coverage::Blend, 0.5));
}

#[test]
fn one_image_serves_as_colour_and_as_numbers() {
    for order in [["a", "b"], ["b", "a"]] {
        let mut model = Model::triangle();
        let texture = json!({ "index": model.texture(&png(1, &[GREY])) });
        let of = |kind| match kind {
            "a" => json!({ "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorTexture": texture } }),
            _ => json!({ "pbrMetallicRoughness": { "metallicRoughnessTexture": texture } }),
        };
        let mut model = model.with_material(&of(order[0]));
        push(&mut model.json["materials"], of(order[1]));
        let opaque = json!({ "pbrMetallicRoughness": { "baseColorTexture": texture }, "emissiveTexture": texture,
            "normalTexture": texture });
        push(&mut model.json["materials"], opaque);
        let asset = model.asset();
        let first = |pick: fn(&Material) -> Option<Texture>| asset.materials.iter().find_map(pick).unwrap();
        let data = first(|m| m.metal.texture.clone());
        let color = asset.materials.iter().find(|m| m.coverage == Coverage::Blend).unwrap();
        let color = color.base_texture.clone().unwrap();
        let last = &asset.materials[2];
        let (opaque, emissive) =
            (last.base_texture.as_ref().unwrap(), last.emissive_texture.as_ref().unwrap());
        assert!((value(&color)[0] - 0.503).abs() < 1e-3 && value(&color)[3] == 128.0 / 255.0);
        assert_eq!(value(&data)[0], 188.0 / 255.0);
        assert!((value(opaque)[0] - 0.503).abs() < 1e-3 && value(opaque)[3] == 1.0);
        let same = |a: &Texture, b: &Texture| std::sync::Arc::ptr_eq(&a.picture, &b.picture);
        assert!(same(opaque, emissive), "one copy for one use");
        assert!(same(&data, &last.normal.as_ref().unwrap().texture), "one copy for one use");
    }
}

#[test]
fn floating_point_picture_is_the_same_for_every_use() {
    let float = image::Rgb32FImage::from_raw(1, 1, vec![0.25, 0.5, 0.75]).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::DynamicImage::ImageRgb32F(float).write_to(&mut bytes, image::ImageFormat::OpenExr).unwrap();
    let mut model = Model::triangle();
    let texture = json!({ "index": model.texture(&bytes.into_inner()) });
    let pbr = json!({ "metallicRoughnessTexture": texture, "baseColorTexture": texture });
    let material = material(&model.with_material(&json!({ "pbrMetallicRoughness": pbr })));
    let (base, data) = (material.base_texture.unwrap(), material.metal.texture.unwrap());
    assert!(std::sync::Arc::ptr_eq(&base.picture, &data.picture));
    assert_eq!(value(&data), [0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn picture_at_fault_is_reported_once_however_often_it_is_used() {
    let mut model = Model::triangle();
    let texture = json!({ "index": model.texture(b"no picture") });
    let pbr = json!({ "metallicRoughnessTexture": texture, "baseColorTexture": texture });
    let material =
        json!({ "pbrMetallicRoughness": pbr, "normalTexture": texture, "emissiveTexture": texture });
    assert_eq!(faults(model.with_material(&material).load()).len(), 1);
}
