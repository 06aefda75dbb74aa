//! Nodes and what hangs on them, placed in the asset's space.

use super::document::Document;
use crate::import::{Camera, Instance, Job, Light, LightKind, Node, Pose};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use gltf::json;
use gltf::json::extensions::scene::khr_lights_punctual::{Light as WrittenLight, Type as WrittenKind};
use gltf::json::validation::Checked;

/// How flat an instance may be: the volume between the unit vectors along its axes.
const FLAT: f64 = 1e-12;

/// The contents of a scene.
#[derive(Default)]
pub(super) struct Placed {
    pub nodes: Vec<Node>,
    /// Their numbers in the file.
    pub numbers: Vec<usize>,
    /// Meshes by their number in the file.
    pub instances: Vec<Instance>,
    pub lights: Vec<Light>,
    pub cameras: Vec<Camera>,
}

/// Walks through the default scene (or the first, or all nodes where there is none), parents first.
pub(super) fn place(document: &Document<'_>, job: &mut Job) -> Option<Placed> {
    let before = job.faults;
    let parents = parents(document, job)?;
    let mut waiting: Vec<(usize, Option<usize>)> = Vec::new();
    for root in roots(document, &parents, job)?.into_iter().rev() {
        waiting.push((root, None));
    }
    let mut placed = Placed::default();
    // A stack of its own: files may be nested deeper than the program's.
    while let Some((number, parent)) = waiting.pop() {
        let Some(node) = document.root.nodes.get(number) else { continue };
        let outer = parent.map_or(DAffine3::IDENTITY, |p| placed.nodes[p].asset_from_node);
        let pose = pose(node, number, job);
        let inner = pose.map();
        let asset_from_node = outer * inner;
        if inner.is_finite() && !asset_from_node.is_finite() {
            let what = "its place is beyond all numbers, together with its parents'";
            job.fault(format!("nodes[{number}]"), what, "");
        }
        let here = placed.nodes.len();
        placed.nodes.push(Node { name: super::name(node.name.as_ref()), parent, pose, asset_from_node });
        placed.numbers.push(number);
        contents(document, node, (number, here), &mut placed, job);
        let children = node.children.iter().flatten().rev();
        waiting.extend(children.map(|child| (child.value(), Some(here))));
    }
    if placed.instances.is_empty() {
        job.warn("scenes", "no node of the scene has a mesh", "");
    }
    (job.faults == before).then_some(placed)
}

/// The parent of each node, checked to make trees (glTF 2.0 §3.5.2).
fn parents(document: &Document<'_>, job: &mut Job) -> Option<Vec<Option<usize>>> {
    let nodes = &document.root.nodes;
    let before = job.faults;
    let mut parents = vec![None; nodes.len()];
    for (i, node) in nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let Some(parent) = parents.get_mut(child.value()) else { continue };
            match *parent {
                None => *parent = Some(i),
                Some(other) => job.fault(
                    format!("nodes[{}]", child.value()),
                    format!("is a child of both nodes[{other}] and nodes[{i}]"),
                    "a node has one parent: export the model again",
                ),
            }
        }
    }
    if job.faults > before {
        return None;
    }
    // With one parent each, whatever is not below a root goes round in a circle.
    let mut reached = vec![false; nodes.len()];
    let mut waiting: Vec<usize> = (0..nodes.len()).filter(|&i| parents[i].is_none()).collect();
    while let Some(i) = waiting.pop() {
        reached[i] = true;
        waiting.extend(nodes[i].children.iter().flatten().map(json::Index::value));
    }
    if let Some(i) = reached.iter().position(|&reached| !reached) {
        job.fault(format!("nodes[{i}]"), "is its own ancestor, or below such a node", "");
        return None;
    }
    Some(parents)
}

fn roots(document: &Document<'_>, parents: &[Option<usize>], job: &mut Job) -> Option<Vec<usize>> {
    let number = document.root.scene.map_or(0, |scene| scene.value());
    let Some(scene) = document.root.scenes.get(number) else {
        return Some((0..parents.len()).filter(|&i| parents[i].is_none()).collect());
    };
    let roots: Vec<usize> = scene.nodes.iter().map(json::Index::value).collect();
    let mut seen = vec![false; parents.len()];
    let before = job.faults;
    for (i, &root) in roots.iter().enumerate() {
        let element = format!("scenes[{number}].nodes[{i}]");
        if let Some(parent) = parents.get(root).copied().flatten() {
            job.fault(element, format!("nodes[{root}] is no root but a child of nodes[{parent}]"), "");
        } else if seen.get_mut(root).is_some_and(|seen| std::mem::replace(seen, true)) {
            job.fault(element, format!("nodes[{root}] is named twice"), "");
        }
    }
    (job.faults == before).then_some(roots)
}

/// A node's place in its parent.
fn pose(node: &json::Node, number: usize, job: &mut Job) -> Pose {
    let written = if let Some(matrix) = node.matrix {
        let m = matrix.map(f64::from);
        let last = [m[3], m[7], m[11], m[15] - 1.0];
        if !last.iter().all(|c| c.abs() < 1e-6) {
            let what = "its last row is not 0 0 0 1, so it is not a place in space";
            job.fault(format!("nodes[{number}].matrix"), what, "");
        }
        let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
        let matrix3 = DMat3::from_cols(column(0), column(4), column(8));
        ("matrix", Pose::Matrix(DAffine3 { matrix3, translation: column(12) }))
    } else {
        let vector = |v: Option<[f32; 3]>, or| v.map_or(or, |v| DVec3::from_array(v.map(f64::from)));
        let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
        let rotation = DQuat::from_array(rotation);
        let length = rotation.length();
        if !(length > 0.0 && length.is_finite()) {
            job.fault(format!("nodes[{number}].rotation"), "is not a quaternion with a direction", "");
            return Pose::Matrix(DAffine3::IDENTITY);
        }
        let scale = vector(node.scale, DVec3::ONE);
        let translation = vector(node.translation, DVec3::ZERO);
        ("translation or scale", Pose::Parts { scale, rotation: rotation / length, translation })
    };
    let (key, pose) = written;
    if !pose.map().is_finite() {
        job.fault(format!("nodes[{number}].{key}"), "is not finite", "");
    }
    pose
}

/// Mesh, camera and light of a node (its number in the file, its number here).
fn contents(
    document: &Document<'_>,
    node: &json::Node,
    (number, here): (usize, usize),
    placed: &mut Placed,
    job: &mut Job,
) {
    let place = placed.nodes[here].asset_from_node;
    let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    if node.mesh.is_none() && node.camera.is_none() && light.is_none() {
        return;
    }
    if place.is_finite() && flat(place) {
        let what = "is scaled to nothing in some direction, so what hangs on it is left out";
        job.warn(format!("nodes[{number}]"), what, "give it a scale other than 0");
        return;
    }
    if let Some(mesh) = node.mesh {
        if node.skin.is_some() {
            job.warn(format!("nodes[{number}].skin"), "is passed over: the mesh has its rest shape", "");
        }
        placed.instances.push(Instance { mesh: mesh.value(), asset_from_mesh: place, node: here });
    }
    if let Some(index) = node.camera
        && let Some(written) = super::get(&document.root.cameras, index)
    {
        let name = written.name.as_ref().or(node.name.as_ref());
        let camera = camera(written, index.value(), job);
        let (vertical_fov, aspect) = camera;
        let camera =
            Camera { name: super::name(name), asset_from_camera: place, vertical_fov, aspect, node: here };
        placed.cameras.push(camera);
    }
    let Some(light) = light else { return };
    let lights = document.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let Some(written) = lights.and_then(|l| super::get(&l.lights, light.light)) else { return };
    let kind = light_kind(written, light.light.value(), job);
    placed.lights.push(Light {
        name: super::name(written.name.as_ref().or(node.name.as_ref())),
        kind,
        color: written.color,
        intensity: f64::from(written.intensity),
        asset_from_light: place,
        node: here,
    });
}

fn flat(place: DAffine3) -> bool {
    let m = place.matrix3;
    let directions = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::normalize_or_zero);
    DMat3::from_cols(directions[0], directions[1], directions[2]).determinant().abs() < FLAT
}

/// Vertical field of view and aspect.
fn camera(written: &json::Camera, number: usize, job: &mut Job) -> (Option<f64>, Option<f64>) {
    let element = format!("cameras[{number}]");
    let positive = |value: f32| value.is_finite() && value > 0.0;
    if let Some(perspective) = &written.perspective {
        let fov = perspective.yfov;
        if !positive(fov) || f64::from(fov) >= std::f64::consts::PI {
            let hint = "an angle in radians between 0 and 3.14";
            job.fault(format!("{element}.perspective.yfov"), format!("{fov} is not a field of view"), hint);
        }
        let aspect = perspective.aspect_ratio;
        if let Some(aspect) = aspect.filter(|&aspect| !positive(aspect)) {
            job.fault(format!("{element}.perspective.aspectRatio"), format!("{aspect} is not positive"), "");
        }
        return (Some(f64::from(fov)), aspect.map(f64::from));
    }
    let sides = written.orthographic.as_ref().map(|o| (o.xmag, o.ymag));
    let sides = sides.filter(|&(x, y)| positive(x) && positive(y));
    (None, sides.map(|(x, y)| f64::from(x) / f64::from(y)))
}

fn light_kind(written: &WrittenLight, number: usize, job: &mut Job) -> LightKind {
    let element = format!("extensions.KHR_lights_punctual.lights[{number}]");
    let valid = |value: f32| value.is_finite() && value >= 0.0;
    if !valid(written.intensity) {
        job.fault(format!("{element}.intensity"), format!("{} is not an intensity", written.intensity), "");
    }
    if !written.color.iter().all(|&c| valid(c)) {
        job.fault(format!("{element}.color"), format!("{:?} is not a colour", written.color), "");
    }
    match (&written.type_, &written.spot) {
        (Checked::Valid(WrittenKind::Directional), _) => LightKind::Sun,
        (Checked::Valid(WrittenKind::Spot), Some(spot)) => {
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            let cone = valid(inner) && inner <= outer && outer > 0.0 && outer <= std::f32::consts::FRAC_PI_2;
            if !cone {
                let what = format!("angles of {inner} and {outer} do not make a cone");
                job.fault(format!("{element}.spot"), what, "0 ≤ innerConeAngle ≤ outerConeAngle ≤ 1.5708");
            }
            LightKind::Spot { inner: f64::from(inner), outer: f64::from(outer) }
        }
        _ => LightKind::Point,
    }
}
