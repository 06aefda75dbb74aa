//! Files altered and cut off anywhere: never a panic, never an allocation beyond the limit.

use super::*;
use proptest::collection::vec;
use proptest::prelude::*;

fn rich() -> Model {
    let mut model = Model::triangle();
    model.textured(&png(2, &[[9; 4], [8; 4]]));
    let uvs = model.accessor(U8, "VEC2", 3, &[0, 255, 51, 0, 0, 0]);
    model.json["accessors"][uvs]["normalized"] = json!(true);
    model.attribute("TEXCOORD_0", uvs);
    let normals = model.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    model.attribute("NORMAL", normals);
    let tangents = model.floats("VEC4", &[1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0]);
    model.attribute("TANGENT", tangents);
    let bumps =
        json!({ "index": 0, "scale": 1, "extensions": { "KHR_texture_transform": { "offset": [1, 2] } } });
    model.json["materials"][0]["normalTexture"] = bumps.clone();
    model.json["materials"][0]["alphaMode"] = json!("MASK");
    model.json["materials"][0]["extensions"] = json!({
        "KHR_materials_ior": { "ior": 2 },
        "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": 3, "attenuationColor": [1, 0, 1] },
        "KHR_materials_transmission": { "transmissionFactor": 1, "transmissionTexture": { "index": 0 } },
        "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatNormalTexture": bumps },
        "KHR_materials_sheen": {},
    });
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]);
    model.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    model.json["nodes"] =
        json!([{ "children": [1, 2] }, { "mesh": 0 }, { "camera": 0, "extensions": light }]);
    model
}

const OBJ: &str = "mtllib m.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n\
    usemtl red\nf 1/1/1 2/2/1 3/1/1 4/2/1\ng b\nf -4 -3 -2\n";
const MTL: &str =
    "newmtl red\nKd 1 0 0\nKe 1 2 3\nd 0.5\nNi 1.5\nPm 0.5\nPr 0.25\nmap_Kd -s 2 2 -o 0.5 p.png\n";

/// A place and what is written over it.
fn changes() -> impl Strategy<Value = Vec<(prop::sample::Index, u8)>> {
    let byte = prop_oneof![any::<u8>(), Just(b'-'), Just(b'9'), Just(b' '), Just(b'"'), Just(0), Just(255)];
    vec((any::<prop::sample::Index>(), byte), 0..6)
}

fn change(bytes: &mut Vec<u8>, changes: &[(prop::sample::Index, u8)], cut: Option<prop::sample::Index>) {
    for (place, byte) in changes {
        let place = place.index(bytes.len());
        bytes[place] = *byte;
    }
    if let Some(cut) = cut {
        bytes.truncate(cut.index(bytes.len()));
    }
}

/// Neither a panic nor the fence around one.
fn holds(result: &Result<Asset, Error>) -> Result<(), TestCaseError> {
    match result {
        Ok(asset) => {
            for mesh in &asset.meshes {
                let vertices = mesh.positions.len();
                prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
                prop_assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
                prop_assert_eq!(mesh.normals.len(), vertices);
                prop_assert!(mesh.uvs.iter().all(|uvs| uvs.is_empty() || uvs.len() == vertices));
                prop_assert!(mesh.tangents.is_empty() || mesh.tangents.len() == vertices);
                let length = |t: &[f32; 4]| t[..3].iter().map(|c| c * c).sum::<f32>();
                prop_assert!(mesh.tangents.iter().all(|t| (length(t) - 1.0).abs() < 1e-4));
                prop_assert!(mesh.tangents.iter().all(|t| t[3].abs() == 1.0));
                prop_assert!(mesh.colors.is_empty() || mesh.colors.len() == vertices);
                prop_assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < vertices));
                prop_assert_eq!(mesh.parts.last().map_or(0, |part| part.end as usize), mesh.triangles.len());
                prop_assert!(mesh.parts.iter().all(|part| (part.material as usize) < asset.materials.len()));
            }
            for m in &asset.materials {
                prop_assert!(
                    (0.0..=1.0).contains(&m.metal.metallic) && (0.0..=1.0).contains(&m.metal.roughness)
                );
                prop_assert!(m.ior.is_finite() && (m.ior == 0.0 || m.ior >= 1.0));
                prop_assert!(m.volume.is_none_or(|v| v.thickness > 0.0 && v.attenuation_distance > 0.0));
                prop_assert!(m.transmission.as_ref().is_none_or(|t| t.amount > 0.0 && t.amount <= 1.0));
                prop_assert!(m.clearcoat.as_ref().is_none_or(|c| c.strength > 0.0 && c.strength <= 1.0));
            }
            prop_assert!(
                asset.instances.iter().all(|i| i.mesh < asset.meshes.len() && i.node < asset.nodes.len())
            );
        }
        Err(error) => prop_assert!(!error.to_string().contains("foreseen"), "{error}"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn glb_altered_anywhere_is_read_or_refused(
        changes in changes(), cut in any::<Option<prop::sample::Index>>(),
    ) {
        let mut bytes = rich().glb();
        change(&mut bytes, &changes, cut);
        holds(&load_files("m.glb", &[("m.glb", &bytes)]))?;
    }

    #[test]
    fn numbers_of_a_gltf_replaced_by_others_are_read_or_refused(
        place in any::<prop::sample::Index>(),
        number in prop_oneof![
            Just("0"), Just("1"), Just("2"), Just("3"), Just("-1"), Just("5120"), Just("5125"), Just("1e300"),
            Just("4294967295"), Just("4294967296"), Just("18446744073709551615"), Just("0.5"), Just("[]"),
        ],
    ) {
        let model = rich();
        let text = String::from_utf8(model.gltf("m.bin")).unwrap();
        // Every run of digits outside of names.
        let starts: Vec<_> = text.match_indices([':', '[', ',']).map(|(i, _)| i + 1)
            .filter(|&i| text[i..].starts_with(|c: char| c.is_ascii_digit())).collect();
        let start = starts[place.index(starts.len())];
        let end = start + text[start..].find(|c: char| !c.is_ascii_digit()).unwrap();
        let text = format!("{}{number}{}", &text[..start], &text[end..]);
        holds(&load_files("m.gltf", &[("m.gltf", text.as_bytes()), ("m.bin", &model.bin)]))?;
    }

    #[test]
    fn obj_and_mtl_altered_anywhere_are_read_or_refused(
        in_obj in changes(), in_mtl in changes(), cut in any::<Option<prop::sample::Index>>(),
    ) {
        let (mut obj, mut mtl) = (OBJ.as_bytes().to_vec(), MTL.as_bytes().to_vec());
        change(&mut obj, &in_obj, cut);
        change(&mut mtl, &in_mtl, None);
        let picture = png(1, &[[1, 2, 3, 4]]);
        holds(&load_files("m.obj", &[("m.obj", &obj), ("m.mtl", &mtl), ("p.png", &picture)]))?;
    }
}
