//! Where methods fail: what is given there, and up to where it is guaranteed.

mod bright;
mod far;
mod grazing;
mod inside;
mod journeys;
mod limits;
mod numbers;
mod search;
mod thin;

use crate::support::picture;
use terrell::scene::Scene;

/// A small picture without anything that is no number.
#[track_caller]
fn sound_picture(scene: &Scene) -> Vec<[f32; 3]> {
    let (_, negative) = picture(scene, 24, 16);
    let sound = |xyz: &[f32; 3]| xyz.iter().all(|value| value.is_finite());
    assert!(negative.xyz.iter().all(sound), "not a number");
    // Brightest values would hide a NaN of the f64 before them.
    let exact = crate::support::exposed::<8>(scene, 0.0, (24, 16));
    assert!(exact.iter().all(|xyz| xyz.is_finite()), "not a number");
    negative.xyz
}
