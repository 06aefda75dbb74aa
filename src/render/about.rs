//! What is written into pictures about themselves: keywords and texts, values as manifests have them.

use super::folder;
use crate::plan::{Exposure, Plan};
use crate::scene::Scene;
use crate::spacetime::Course;
use glam::DVec3;

/// What a picture says of itself. The luminance `white` (cd/m²) is shown as white.
pub(super) fn of_picture(
    scene: &Scene,
    plan: &Plan,
    exposure: &Exposure,
    white: f64,
) -> Vec<(&'static str, String)> {
    let worldline = &scene.observer.worldline;
    let carried = worldline.at(exposure.tau);
    let four = carried.velocity();
    let second = plan.seconds_per_metre;
    let is_ring = matches!(worldline.course(), Course::Ring { .. });
    let own_time = (!is_ring).then(|| ("Own time", format!("{} s", number(exposure.tau * second))));
    let mut texts = of_film(plan, white);
    texts.push((folder::EXPOSURE, exposure.index.to_string()));
    texts.extend(own_time);
    texts.push(("Lab time", format!("{} s", number(carried.event.t * second))));
    texts.push(("Place", format!("{} m", numbers(carried.event.x))));
    texts.push(("Velocity", format!("{} c", numbers(four.x / four.t))));
    // Not "Gamma": ImageMagick takes that for the picture's own, and shows it with other colours.
    texts.push(("Lorentz factor", number(four.t)));
    texts
}

/// What a film says of itself.
pub(super) fn of_film(plan: &Plan, white: f64) -> Vec<(&'static str, String)> {
    let fingerprint = plan.fingerprint().map(|fingerprint| (folder::FINGERPRINT, fingerprint.to_string()));
    let own = [
        ("Exposures", plan.exposures.len().to_string()),
        ("White", format!("{} cd/m2", number(white))),
        ("Stops", number(plan.stops)),
    ];
    plan.text.iter().cloned().chain(fingerprint).chain(own).collect()
}

/// A number by as few digits as tell it from all others, without endless zeros.
fn number(value: f64) -> String {
    let value = value + 0.0; // No -0.
    if value == 0.0 || (1e-5..1e15).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn numbers(of: DVec3) -> String {
    of.to_array().map(number).join(" ")
}

/// Keywords and texts, a line each.
pub(super) fn lines(texts: &[(&str, String)]) -> String {
    texts.iter().map(|(key, value)| format!("{key}: {value}")).collect::<Vec<_>>().join("\n")
}
