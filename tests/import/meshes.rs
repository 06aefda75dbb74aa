//! Meshes of glTF files: accessors of all kinds, modes, attributes made up where they are missing.

use super::*;
use glam::{Vec2, Vec3};

fn close(a: &[f32], b: &[f32]) {
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} is not {b:?}");
}

#[test]
fn triangle_in_a_glb_arrives_whole() {
    let asset = Model::triangle().asset();
    let mesh = &asset.meshes[0];
    assert_eq!(mesh.name, "Tri");
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.material_of(0), 0);
    assert_eq!(asset.materials.len(), 1);
    assert_eq!(asset.materials[0].base_color, [1.0; 4]);
    assert_eq!(asset.instances.len(), 1);
    assert!(asset.path.ends_with("model.glb"));
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
}

#[test]
fn buffers_come_from_files_and_from_data_uris() {
    let model = Model::triangle();
    let files = [("a b.gltf", &model.gltf("data/the%20bytes.bin")[..]), ("data/the bytes.bin", &model.bin)];
    let asset = load_files("a b.gltf", &files).unwrap();
    assert_eq!(asset.meshes[0].positions[1], Vec3::X);
    let asset = load_files("x.gltf", &[("x.gltf", &model.gltf(&model.data_uri()))]).unwrap();
    assert_eq!(asset.meshes[0].positions[1], Vec3::X);
}

#[test]
fn extension_in_capitals_and_glb_named_gltf_are_read() {
    let glb = Model::triangle().glb();
    assert!(load_files("X.GLB", &[("X.GLB", &glb)]).is_ok());
    assert!(load_files("x.gltf", &[("x.gltf", &glb)]).is_ok());
}

#[test]
fn byte_order_mark_is_passed_over() {
    let model = Model::triangle();
    let text = [b"\xef\xbb\xbf".to_vec(), model.gltf(&model.data_uri())].concat();
    assert!(load_files("x.gltf", &[("x.gltf", &text)]).is_ok());
}

#[test]
fn mesh_without_normals_gets_flat_ones_of_its_own_for_each_triangle() {
    let mut model = Model::triangle();
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let accessor = model.floats("VEC3", &positions);
    model.attribute("POSITION", accessor);
    let indices = model.accessor(U8, "SCALAR", 6, &[0, 1, 2, 0, 2, 3]);
    model.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let mesh = model.asset().meshes[0].clone();
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(mesh.normals, [[Vec3::Z; 3], [Vec3::X; 3]].concat());
    assert_eq!(mesh.positions[5], Vec3::Z);
}

#[test]
fn normals_come_at_unit_length_and_lost_ones_from_the_triangles() {
    let mut model = Model::triangle();
    let normals = model.floats("VEC3", &[0.0, 3.0, 4.0, 0.0, 0.0, 0.0, 1e-30, 0.0, 0.0]);
    model.attribute("NORMAL", normals);
    let asset = model.asset();
    assert_eq!(asset.meshes[0].normals, [Vec3::new(0.0, 0.6, 0.8), Vec3::Z, Vec3::X]);
    assert!(warns(&asset, "meshes[0].primitives[0].attributes.NORMAL: 1 normals"), "{:?}", asset.warnings);
}

#[test]
fn triangles_without_indices_take_the_vertices_in_order() {
    let mut model = Model::triangle();
    model.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    assert_eq!(model.asset().meshes[0].triangles, [[0, 1, 2]]);
}

/// Five vertices with normals, so that they are not split, joined in a mode.
fn joined(mode: u32, indices: &[u8]) -> Vec<[u32; 3]> {
    let mut model = Model::triangle();
    let positions: Vec<f32> = (0..5).flat_map(|i| [i as f32, (i * i) as f32, 0.0]).collect();
    let positions = model.floats("VEC3", &positions);
    let normals = model.floats("VEC3", &[0.0, 0.0, 1.0].repeat(5));
    model.attribute("POSITION", positions);
    model.attribute("NORMAL", normals);
    let indices = model.accessor(U8, "SCALAR", indices.len(), indices);
    model.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    model.json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
    model.asset().meshes[0].triangles.clone()
}

#[test]
fn strips_and_fans_keep_the_sense_of_their_triangles() {
    assert_eq!(joined(5, &[0, 1, 2, 3, 4]), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    assert_eq!(joined(6, &[0, 1, 2, 3, 4]), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
    assert_eq!(joined(4, &[0, 1, 2, 4, 3, 2]), [[0, 1, 2], [4, 3, 2]]);
}

#[test]
fn degenerate_triangles_that_join_strips_are_left_out() {
    assert_eq!(joined(5, &[0, 1, 2, 2, 3, 4]), [[0, 1, 2], [2, 4, 3]]);
}

#[test]
fn points_and_lines_are_passed_over_with_a_warning() {
    let mut model = Model::triangle();
    let mut line = model.json["meshes"][0]["primitives"][0].clone();
    line["mode"] = json!(1);
    push(&mut model.json["meshes"][0]["primitives"], line);
    let asset = model.asset();
    assert_eq!(asset.meshes[0].triangles.len(), 1);
    assert!(warns(&asset, "meshes[0].primitives[1]: points and lines"));
}

#[test]
fn primitives_of_a_mesh_become_parts_with_their_materials() {
    let mut model = Model::triangle();
    for color in [[1, 0, 0, 1], [0, 1, 0, 1]] {
        push(&mut model.json["materials"], json!({ "pbrMetallicRoughness": { "baseColorFactor": color } }));
    }
    let primitive = model.json["meshes"][0]["primitives"][0].clone();
    for material in [1, 1, 0] {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(material);
        push(&mut model.json["meshes"][0]["primitives"], primitive);
    }
    let asset = model.asset();
    let mesh = &asset.meshes[0];
    let ends: Vec<_> = mesh.parts.iter().map(|part| (part.end, part.material)).collect();
    assert_eq!(ends, [(1, 2), (3, 1), (4, 0)]);
    assert_eq!(asset.materials.len(), 3, "the default material comes last, and once");
    assert_eq!(asset.materials[2].base_color, [1.0; 4]);
    assert_eq!(mesh.triangles[3], [9, 10, 11]);
}

#[test]
fn attributes_that_only_some_primitives_have_are_filled_up() {
    let mut model = Model::triangle();
    let primitive = model.json["meshes"][0]["primitives"][0].clone();
    push(&mut model.json["meshes"][0]["primitives"], primitive.clone());
    push(&mut model.json["meshes"][0]["primitives"], primitive);
    let uvs = model.floats("VEC2", &[0.0, 0.0, 0.25, 0.5, 0.0, 1.0]);
    let colors = model.floats("VEC3", &[0.5; 9]);
    let attributes = &mut model.json["meshes"][0]["primitives"][1]["attributes"];
    attributes["TEXCOORD_1"] = json!(uvs);
    attributes["COLOR_0"] = json!(colors);
    let mesh = model.asset().meshes[0].clone();
    assert!(mesh.uvs[0].is_empty());
    assert_eq!(mesh.uvs[1].len(), 9);
    assert_eq!(mesh.uvs[1][4], Vec2::new(0.25, 0.5));
    assert_eq!(mesh.uvs[1][8], Vec2::ZERO);
    assert_eq!(mesh.colors[0], [1.0; 4]);
    assert_eq!(mesh.colors[3], [0.5, 0.5, 0.5, 1.0]);
    assert_eq!(mesh.colors[8], [1.0; 4]);
}

#[test]
fn sparse_accessors_replace_single_elements() {
    for with_view in [true, false] {
        let mut model = Model::triangle();
        let places = model.view(&[2, 0]);
        let values = model.view(&bytes_of(&[0.0, 5.0, 0.0]));
        let sparse = json!({
            "count": 1,
            "indices": { "bufferView": places, "componentType": U16 },
            "values": { "bufferView": values },
        });
        model.json["accessors"][0]["sparse"] = sparse;
        if !with_view {
            model.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        }
        let positions = model.asset().meshes[0].positions.clone();
        let second = if with_view { Vec3::X } else { Vec3::ZERO };
        assert_eq!(positions, [Vec3::ZERO, second, Vec3::new(0.0, 5.0, 0.0)]);
    }
}

#[test]
fn accessor_without_a_view_is_zeros() {
    let mut model = Model::triangle();
    let zeros = json!({ "componentType": F32, "type": "VEC2", "count": 3 });
    let zeros = push(&mut model.json["accessors"], zeros);
    model.attribute("TEXCOORD_0", zeros);
    assert_eq!(model.asset().meshes[0].uvs[0], [Vec2::ZERO; 3]);
}

#[test]
fn integer_texture_coordinates_and_colours_are_fractions() {
    let mut model = Model::triangle();
    let uvs = model.accessor(U8, "VEC2", 3, &[0, 255, 51, 0, 0, 0]);
    let words: Vec<u8> =
        [0_u16, 65535, 13107, 65535].repeat(3).iter().flat_map(|w| w.to_le_bytes()).collect();
    let colors = model.accessor(U16, "VEC4", 3, &words);
    for accessor in [uvs, colors] {
        model.json["accessors"][accessor]["normalized"] = json!(true);
    }
    push(&mut model.json["materials"], json!({ "alphaMode": "BLEND", "pbrMetallicRoughness": {} }));
    model.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    model.attribute("TEXCOORD_0", uvs);
    model.attribute("COLOR_0", colors);
    let mesh = model.asset().meshes[0].clone();
    close(&mesh.uvs[0][0].to_array(), &[0.0, 1.0]);
    close(&mesh.uvs[0][1].to_array(), &[0.2, 0.0]);
    close(&mesh.colors[0], &[0.0, 1.0, 0.2, 1.0]);
}

#[test]
fn interleaved_attributes_are_told_apart() {
    let mut model = Model::triangle();
    let mut bytes = Vec::new();
    for (position, uv) in
        [([0.0, 0.0, 0.0], [0.1, 0.2]), ([2.0, 0.0, 0.0], [0.3, 0.4]), ([0.0, 2.0, 0.0], [0.5, 0.6])]
    {
        bytes.extend(bytes_of(&position));
        bytes.extend(bytes_of(&uv));
    }
    let view = model.view(&bytes);
    model.json["bufferViews"][view]["byteStride"] = json!(20);
    for (name, shape, offset) in [("POSITION", "VEC3", 0), ("TEXCOORD_0", "VEC2", 12)] {
        let accessor = json!({
            "bufferView": view, "byteOffset": offset, "componentType": F32, "type": shape, "count": 3,
        });
        let accessor = push(&mut model.json["accessors"], accessor);
        model.attribute(name, accessor);
    }
    let mesh = model.asset().meshes[0].clone();
    assert_eq!(mesh.positions[2], Vec3::new(0.0, 2.0, 0.0));
    assert_eq!(mesh.uvs[0][1], Vec2::new(0.3, 0.4));
}

#[test]
fn quantized_positions_are_read_where_the_extension_allows_them() {
    let mut model = Model::triangle();
    let bytes: Vec<u8> =
        [0_i16, 0, 0, 32767, 0, 0, 0, -32767, 0].iter().flat_map(|w| w.to_le_bytes()).collect();
    let positions = model.accessor(I16, "VEC3", 3, &bytes);
    model.json["accessors"][positions]["normalized"] = json!(true);
    model.attribute("POSITION", positions);
    let refused = faults(model.load());
    assert!(refused[0].to_string().contains("meshes[0].primitives[0].attributes.POSITION"), "{refused:?}");
    model.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert_eq!(model.asset().meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::NEG_Y]);
}

#[test]
fn primitive_takes_only_its_own_vertices_out_of_a_large_accessor() {
    let mut model = Model::triangle();
    let many: Vec<f32> = (0..1000).flat_map(|i| [i as f32, (i % 7) as f32, 0.0]).collect();
    let positions = model.floats("VEC3", &many);
    let normals = model.floats("VEC3", &[0.0, 0.0, 1.0].repeat(1000));
    model.attribute("POSITION", positions);
    model.attribute("NORMAL", normals);
    let indices: Vec<u8> = [900_u16, 3, 14].iter().flat_map(|i| i.to_le_bytes()).collect();
    let indices = model.accessor(U16, "SCALAR", 3, &indices);
    model.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let mesh = model.asset().meshes[0].clone();
    assert_eq!(mesh.positions.len(), 3);
    let xs: Vec<_> = mesh.triangles[0].iter().map(|&i| mesh.positions[i as usize].x).collect();
    assert_eq!(xs, [900.0, 3.0, 14.0]);
}

#[test]
fn skinned_and_morphed_meshes_rest_with_a_warning() {
    let mut model = Model::triangle();
    let target = model.floats("VEC3", &[9.0; 9]);
    model.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    model.json["meshes"][0]["weights"] = json!([1.0]);
    model.json["skins"] = json!([{ "joints": [0] }]);
    model.json["nodes"][0]["skin"] = json!(0);
    let asset = model.asset();
    assert_eq!(asset.meshes[0].positions[0], Vec3::ZERO);
    assert!(warns(&asset, "meshes[0].primitives[0]: its morph targets"));
    assert!(warns(&asset, "nodes[0].skin"));
}

/// A triangle with normals and tangents, whose material has a normal map.
fn tangled(tangents: &[f32]) -> Model {
    let mut model = Model::triangle();
    let normals = model.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    model.attribute("NORMAL", normals);
    let tangents = model.floats("VEC4", tangents);
    model.attribute("TANGENT", tangents);
    let texture = model.texture(&png(1, &[[128, 128, 255, 255]]));
    model.with_material(&json!({ "pbrMetallicRoughness": {}, "normalTexture": { "index": texture } }))
}

const TANGENTS: [f32; 12] = [3.0, 4.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0];

#[test]
fn tangents_come_at_unit_length_with_their_handedness() {
    let asset = tangled(&TANGENTS).asset();
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
    let expected = [[0.6, 0.8, 0.0, 1.0], [1.0, 0.0, 0.0, -1.0], [0.0, -1.0, 0.0, 1.0]];
    assert_eq!(asset.meshes[0].tangents, expected);
    assert!(Model::triangle().asset().meshes[0].tangents.is_empty());
}

#[test]
fn tangents_that_are_none_are_all_passed_over_with_a_warning() {
    for (place, value) in [(4, 0.0), (5, f32::NAN), (4, f32::INFINITY), (7, 0.0), (7, 0.5), (7, f32::NAN)] {
        let mut tangents = TANGENTS;
        tangents[place] = value;
        let asset = tangled(&tangents).asset();
        assert!(asset.meshes[0].tangents.is_empty());
        assert!(warns(&asset, "primitives[0].attributes.TANGENT: vertex 1 is ["), "{:?}", asset.warnings);
    }
}

#[test]
fn tangents_of_a_wrong_type_or_number_are_faults() {
    let mut model = tangled(&TANGENTS);
    let three = model.floats("VEC3", &TANGENTS[..9]);
    model.attribute("TANGENT", three);
    let said = faults(model.load())[0].to_string();
    assert!(said.contains("primitives[0].attributes.TANGENT: Vec3 of F32"), "{said}");
    let said = faults(tangled(&TANGENTS[..8]).load())[0].to_string();
    assert!(said.contains("attributes.TANGENT: has 2 elements, but POSITION has 3"), "{said}");
}

#[test]
fn tangents_without_normals_do_not_count() {
    let mut model = tangled(&TANGENTS);
    model.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    assert!(model.asset().meshes[0].tangents.is_empty());
}

#[test]
fn mesh_keeps_its_tangents_unless_a_part_with_a_normal_map_has_none() {
    let mut model = tangled(&TANGENTS);
    let mut without = model.json["meshes"][0]["primitives"][0].clone();
    without["attributes"].as_object_mut().unwrap().remove("TANGENT");
    push(&mut model.json["meshes"][0]["primitives"], without);
    assert!(model.asset().meshes[0].tangents.is_empty());
    let plain = push(&mut model.json["materials"], json!({ "pbrMetallicRoughness": {} }));
    model.json["meshes"][0]["primitives"][1]["material"] = json!(plain);
    let mesh = model.asset().meshes[0].clone();
    assert_eq!((mesh.positions.len(), mesh.tangents.len()), (6, 6));
    assert_eq!(mesh.tangents[1], [1.0, 0.0, 0.0, -1.0]);
}

#[test]
fn missing_texture_coordinates_are_warned_of_for_any_texture_once() {
    let mut model = tangled(&TANGENTS);
    let textures = json!({ "clearcoatFactor": 1, "clearcoatTexture": { "index": 0 } });
    model.json["materials"][0]["extensions"] = json!({ "KHR_materials_clearcoat": textures });
    model.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    let asset = model.asset();
    assert!(warns(&asset, "primitives[0]: its material `` has a texture, but there is no TEXCOORD_0"));
    assert_eq!(asset.warnings.len(), 1, "{:?}", asset.warnings);
}
