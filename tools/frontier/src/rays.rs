//! Methods that trace rays through the bodies' own trees: ours, and normalised rays compared by time.

use crate::shade::Found;
use crate::stage::Stage;
use terrell::spacetime::{Event, SightRay};
use terrell::tree::Line;

/// Ours: the wave vector is never normalised, the nearest is the smallest s over all rest frames.
pub fn by_s<'a>(stage: &'a Stage, ray: &SightRay) -> Option<Found<'a>> {
    let mut nearest: Option<Found<'a>> = None;
    for prop in &stage.props {
        let rest = ray.to(&prop.rest_from_lab);
        let line = Line {
            origin: prop.mesh_from_rest.transform_point3(rest.event.x),
            step: prop.mesh_from_rest.transform_vector3(-rest.k.x),
        };
        let limit = nearest.as_ref().map_or(f64::INFINITY, |found| found.s);
        if let Some(met) = prop.triangles.nearest(&line, limit) {
            let facet = prop.facet(met.triangle);
            nearest = Some(Found { facet, weights: met.weights, k: rest.k, s: met.s, body: prop.body });
        }
    }
    nearest
}

/// Unit directions in each rest frame; the nearest of each is transformed back, and the latest event is seen.
pub fn by_time<'a>(stage: &'a Stage, ray: &SightRay) -> Option<Found<'a>> {
    let mut latest: Option<(f64, Found<'a>)> = None;
    for (number, rest) in stage.scene.world.frames.iter().enumerate() {
        let to_rest = rest.rest_from_lab;
        let rest = ray.to(&to_rest);
        let n = -rest.k.x / rest.k.x.length();
        let mut limit = f64::INFINITY;
        let mut nearest = None;
        for prop in stage.props.iter().filter(|prop| prop.number == number) {
            let line = Line {
                origin: prop.mesh_from_rest.transform_point3(rest.event.x),
                step: prop.mesh_from_rest.transform_vector3(n),
            };
            if let Some(met) = prop.triangles.nearest(&line, limit) {
                limit = met.s;
                nearest = Some((prop, met));
            }
        }
        let Some((prop, met)) = nearest else { continue };
        let seen = to_rest.undo(Event::new(rest.event.t - met.s, rest.event.x + n * met.s));
        if latest.as_ref().is_none_or(|(t, _)| seen.t > *t) {
            let s = (ray.event.x - seen.x).length();
            let facet = prop.facet(met.triangle);
            latest = Some((seen.t, Found { facet, weights: met.weights, k: rest.k, s, body: prop.body }));
        }
    }
    latest.map(|(_, found)| found)
}
