//! Animations, as far as cameras hang on what moves. What is wrong with one is said, and it is left out: bodies do not move by
//! them.

use super::accessor;
use super::document::Document;
use super::scene::Placed;
use crate::import::Job;
use crate::import::animation::{Animation, Channel, Interpolation, Moving, Pose};
use glam::DVec4;
use gltf::json;
use gltf::json::accessor::{ComponentType, Type};
use serde_json::Value;

/// All animations by name, with the channels of nodes that a camera hangs on.
pub(super) fn all(document: &Document<'_>, placed: &Placed, job: &mut Job) -> Vec<Animation> {
    let mut carries = vec![false; placed.nodes.len()];
    for camera in &placed.cameras {
        let mut node = Some(camera.node);
        while let Some(number) = node {
            carries[number] = true;
            node = placed.nodes[number].parent;
        }
    }
    let animation = |(number, written): (usize, &Value)| {
        let mut channels: Vec<Channel> = Vec::new();
        for (c, channel) in list(&written["channels"]).iter().enumerate() {
            let target = channel["target"]["node"].as_u64();
            let Some(node) = placed.numbers.iter().position(|number| Some(*number as u64) == target) else {
                continue;
            };
            let Some(moving) = moving(&channel["target"]["path"]).filter(|_| carries[node]) else { continue };
            let sampler =
                channel["sampler"].as_u64().map_or(&Value::Null, |s| &written["samplers"][s as usize]);
            let read = if matches!(placed.nodes[node].pose, Pose::Matrix(_)) {
                Err("its node has a matrix, which cannot move".to_owned())
            } else if channels.iter().any(|known| known.node == node && known.moving == moving) {
                Err("another channel moves the same".to_owned())
            } else {
                read(document, sampler, (node, moving), job)
            };
            match read {
                Ok(channel) => channels.push(channel),
                Err(what) => {
                    let element = format!("animations[{number}].channels[{c}]");
                    job.warn(
                        element,
                        format!("is left out: {what}"),
                        "a camera that hangs on it does not move so",
                    );
                }
            }
        }
        Animation { name: written["name"].as_str().unwrap_or("").to_owned(), channels }
    };
    document.animations.iter().enumerate().map(animation).collect()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn moving(path: &Value) -> Option<Moving> {
    match path.as_str()? {
        "translation" => Some(Moving::Translation),
        "rotation" => Some(Moving::Rotation),
        "scale" => Some(Moving::Scale),
        _ => None,
    }
}

/// The keys of a sampler and their values, every number checked.
fn read(
    document: &Document<'_>,
    sampler: &Value,
    (node, moving): (usize, Moving),
    job: &mut Job,
) -> Result<Channel, String> {
    let interpolation = match sampler["interpolation"].as_str() {
        None | Some("LINEAR") => Interpolation::Linear,
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::CubicSpline,
        Some(other) => return Err(format!("`{other}` is no interpolation")),
    };
    let mut open = |key: &str| {
        let number = sampler[key].as_u64().and_then(|number| u32::try_from(number).ok());
        let number = number.ok_or_else(|| format!("its sampler has no `{key}`"))?;
        let elements = accessor::open(document, json::Index::new(number), job)?;
        Ok::<_, String>(elements)
    };
    let (times, values) = (open("input")?, open("output")?);
    if times.shape != Type::Scalar || times.kind != ComponentType::F32 {
        return Err("its times are not numbers of type SCALAR, FLOAT".into());
    }
    let wanted = if moving == Moving::Rotation { Type::Vec4 } else { Type::Vec3 };
    if values.shape != wanted {
        return Err(format!("its values are {:?} and not {wanted:?}", values.shape));
    }
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if times.count == 0 || values.count != each * times.count {
        return Err(format!("{} keys do not go with {} values", times.count, values.count));
    }
    let keys: Vec<f64> = times.floats::<1>(None, job)?.iter().map(|[t]| f64::from(*t)).collect();
    if !keys.iter().all(|key| key.is_finite()) || !keys.windows(2).all(|pair| pair[0] < pair[1]) {
        return Err("its times do not rise".into());
    }
    let values: Vec<DVec4> =
        values.floats::<4>(None, job)?.iter().map(|v| DVec4::from(v.map(f64::from))).collect();
    let turns =
        moving != Moving::Rotation || values.iter().skip(each / 2).step_by(each).all(|q| q.length() > 1e-6);
    if !values.iter().all(|value| value.is_finite()) || !turns {
        return Err("its values are not finite, or no turns".into());
    }
    let mut values = values;
    if moving == Moving::Rotation && each == 1 {
        values.iter_mut().for_each(|q| *q /= q.length());
    }
    Ok(Channel { node, moving, interpolation, keys, values })
}
