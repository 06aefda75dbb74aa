//! The scales of false-colour pictures: one for the whole film, so that colours mean the same in all of them.

use super::METER_PICTURES;
use crate::exposure::first_hits;
use crate::output::Scale;
use crate::plan::{Picture, Plan};
use crate::scene::Scene;

/// Columns of the small pictures that are looked at.
const COLUMNS: u32 = 64;

/// What colours stand for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scales {
    pub(super) doppler: Scale,
    pub(super) emission_time: Scale,
}

/// Those of a film, if it has such pictures.
pub(super) fn of(scene: &Scene, plan: &Plan) -> Option<Scales> {
    let pictures = &plan.outputs.pictures;
    if !pictures.iter().any(|picture| matches!(picture, Picture::Doppler | Picture::EmissionTime)) {
        return None;
    }
    let small = plan.sampling.within(COLUMNS);
    let every = plan.exposures.len().div_ceil(METER_PICTURES).max(1);
    let firsts: Vec<_> = plan
        .exposures
        .iter()
        .step_by(every)
        .flat_map(|exposure| {
            let view = scene.observer.view(exposure.tau, small.width, small.height);
            first_hits(scene, &view, small.width, small.height).into_iter().flatten()
        })
        .collect();
    Some(Scales {
        doppler: Scale::of_ratios(firsts.iter().map(|first| first.doppler.factor())),
        emission_time: Scale::of_seconds(
            firsts.iter().map(|first| first.emission.t * plan.seconds_per_metre),
        ),
    })
}
