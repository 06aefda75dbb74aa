//! Nodes: places, scenes, and hierarchies of any depth.

use super::*;
use glam::DVec3;

fn close(a: DVec3, b: DVec3) {
    assert!((a - b).length() < 1e-6, "{a} is not {b}");
}

#[test]
fn places_compose_from_the_root_down_with_any_scale() {
    let mut model = Model::triangle();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    model.json["nodes"] = json!([
        // A quarter turn about z, then mirrored and stretched along x, then moved.
        { "name": "top", "translation": [10, 0, 0], "scale": [-2, 1, 1], "children": [1] },
        { "name": "leaf", "rotation": [0, 0, half, half], "translation": [0, 1, 0], "mesh": 0 },
    ]);
    let asset = model.asset();
    let place = asset.instances[0].asset_from_mesh;
    close(place.transform_point3(DVec3::ZERO), DVec3::new(10.0, 1.0, 0.0));
    close(place.transform_point3(DVec3::X), DVec3::new(10.0, 2.0, 0.0));
    close(place.transform_point3(DVec3::Y), DVec3::new(12.0, 1.0, 0.0));
    assert!(place.matrix3.determinant() < 0.0);
    assert_eq!(asset.nodes[1].parent, Some(0));
    assert_eq!(asset.nodes[asset.instances[0].node].name, "leaf");
}

#[test]
fn matrix_means_the_same_as_its_parts() {
    let mut model = Model::triangle();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    model.json["nodes"] = json!([
        { "mesh": 0, "translation": [1, 2, 3], "rotation": [half, 0, 0, half], "scale": [2, 3, 4] },
        { "mesh": 0, "matrix": [2, 0, 0, 0, 0, 0, 3, 0, 0, -4, 0, 0, 1, 2, 3, 1] },
    ]);
    model.json["scenes"] = json!([{ "nodes": [0, 1] }]);
    let asset = model.asset();
    for axis in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z] {
        let places = [0, 1].map(|i| asset.instances[i].asset_from_mesh.transform_point3(axis));
        close(places[0], places[1]);
    }
}

#[test]
fn many_nodes_share_one_mesh() {
    let mut model = Model::triangle();
    let nodes: Vec<_> = (0..100).map(|i| json!({ "mesh": 0, "translation": [i, 0, 0] })).collect();
    model.json["nodes"] = json!(nodes);
    model.json["scenes"] = json!([{ "nodes": (0..100).collect::<Vec<_>>() }]);
    let asset = model.asset();
    assert_eq!(asset.meshes.len(), 1);
    assert_eq!(asset.instances.len(), 100);
    assert!(asset.instances.iter().all(|instance| instance.mesh == 0));
    close(asset.instances[99].asset_from_mesh.translation, DVec3::new(99.0, 0.0, 0.0));
}

#[test]
fn default_scene_is_shown_else_the_first_else_all_roots() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{ "name": "a", "mesh": 0 }, { "name": "b", "mesh": 0, "children": [2] }, { "name": "c", "mesh": 0 }]);
    model.json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1] }]);
    let names = |model: &Model| model.asset().nodes.iter().map(|node| node.name.clone()).collect::<Vec<_>>();
    model.json["scene"] = json!(1);
    assert_eq!(names(&model), ["b", "c"]);
    model.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(names(&model), ["a"]);
    model.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(names(&model), ["a", "b", "c"]);
}

#[test]
fn instance_scaled_to_nothing_is_left_out_with_a_warning() {
    let mut model = Model::triangle();
    model.json["nodes"] =
        json!([{ "mesh": 0 }, { "mesh": 0, "scale": [1, 0, 1] }, { "mesh": 0, "scale": [1e-9, 1e-9, 1e-9] }]);
    model.json["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    let asset = model.asset();
    assert_eq!(asset.instances.iter().map(|i| i.node).collect::<Vec<_>>(), [0, 2]);
    assert!(warns(&asset, "nodes[1]: is scaled to nothing"));
}

#[test]
fn hierarchy_may_be_a_hundred_thousand_deep() {
    let mut model = Model::triangle();
    let deep = 100_000;
    let mut nodes: Vec<_> = (1..deep).map(|i| json!({ "children": [i], "translation": [1, 0, 0] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    model.json["nodes"] = json!(nodes);
    let asset = model.asset();
    close(asset.instances[0].asset_from_mesh.translation, DVec3::new(f64::from(deep - 1), 0.0, 0.0));
}

#[test]
fn custom_properties_and_an_empty_scene_are_no_hindrance() {
    let mut model = Model::triangle();
    let extras =
        json!({ "beta": [0.8, 0, 0], "mesh": 5_000_000_000_u64, "deep": { "list": [1, "two", null] } });
    for list in ["nodes", "meshes", "accessors", "scenes"] {
        model.json[list][0]["extras"] = extras.clone();
    }
    assert_eq!(model.asset().instances.len(), 1);
    model.json["scenes"] = json!([{ "name": "Empty" }]);
    let asset = model.asset();
    assert!(asset.instances.is_empty());
    assert!(warns(&asset, "scenes: no node of the scene has a mesh"));
}

#[test]
fn parents_come_before_their_children() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{ "children": [2] }, { "mesh": 0 }, { "children": [1] }]);
    let asset = model.asset();
    assert_eq!(asset.nodes.len(), 3);
    assert!(asset.nodes.iter().enumerate().all(|(i, node)| node.parent.is_none_or(|parent| parent < i)));
}

#[test]
fn animations_are_named_even_those_that_only_extensions_describe() {
    let mut model = Model::triangle();
    let pointer =
        json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": "/nodes/0" } } });
    model.json["extensionsUsed"] = json!(["KHR_animation_pointer"]);
    model.json["animations"] = json!([
        { "name": "Turn", "channels": [{ "sampler": 0, "target": pointer }], "samplers": [{ "input": 9, "output": 9 }] },
        { "channels": [], "samplers": [] },
    ]);
    let asset = model.asset();
    assert_eq!(asset.animations.iter().map(|a| a.name.as_str()).collect::<Vec<_>>(), ["Turn", ""]);
    assert!(warns(&asset, "KHR_animation_pointer"));
}
