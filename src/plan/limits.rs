//! Up to where a picture is what would be seen: beyond, it is said, and what cannot be right is refused.
//!
//! Everything in the lab is in `f64`. An event that is d metres and metres of time away from a body's origin is known to
//! some ε d there; in the body's rest frame that is ε γ d. Light of Doppler factor D leaves a body D times as uncertainly
//! in the body's time as it arrives, and on the body's way through the lab γ times that: 2 ε γ² d.

use super::Exposure;
use crate::error::Report;
use crate::lamp::Beam;
use crate::manifest::{self, Manifest};
use crate::scene::Scene;
use crate::spacetime::{Course, Event, FourVector, Velocity};
use crate::world::{Placed, RestFrame};

/// How many roundings there are at most between what is written and a place in a rest frame.    Law: tests
/// `edges::search::*`.
const ROUNDINGS: f64 = 4.0;

/// A body whose place is less certain than this part of its size is rendered with a warning; one whose place is not as
/// certain as its size is refused.
const WORTH_SAYING: f64 = 1e-3;

/// The greatest Lorentz factor of glass: light in it is no null vector, and by the plain formulas.
const GREATEST_GAMMA_OF_GLASS: f64 = 1e5;

/// Says at the exposures' ends, where things are farthest apart, what is beyond the limits.
pub(super) fn check(manifest: &Manifest, scene: &Scene, exposures: &[Exposure], report: &mut Report) {
    let faults = report.faults.len();
    let mut ends = vec![];
    for exposure in exposures.first().into_iter().chain(exposures.last()) {
        let tetrad = scene.observer.worldline.at(exposure.tau);
        check_speed(manifest, scene, exposure, tetrad.velocity().t, tetrad.event, report);
        if report.faults.len() > faults {
            return;
        }
        ends.push(tetrad.event);
    }
    check_glass(manifest, scene, report);
    check_bodies(manifest, scene, &ends, report);
}

/// Refuses an observer who is beyond what numbers can follow.
fn check_speed(
    manifest: &Manifest,
    scene: &Scene,
    exposure: &Exposure,
    gamma: f64,
    event: Event,
    report: &mut Report,
) {
    let place = || manifest.exposures.place.clone();
    let index = exposure.index;
    if !(gamma <= manifest::GREATEST_GAMMA * (1.0 + 1e-9) && size(event - Event::ORIGIN).is_finite()) {
        let what = format!("at exposure {index} the observer's Lorentz factor is {gamma:.3e}");
        let hint = "up to 1e8 can be followed: take a shorter time or a smaller acceleration";
        return report.fault(place(), what, hint);
    }
    let of_course = match *scene.observer.worldline.course() {
        Course::Inertial | Course::Ring { .. } => 1.0,
        Course::Rocket { acceleration } => libm::cosh(acceleration.length() * exposure.tau),
        Course::Orbit { proper_speed, .. } => (1.0 + proper_speed * proper_speed).sqrt(),
    };
    let of_start = manifest.observer.placement.velocity.gamma();
    let error = ROUNDINGS * f64::EPSILON * of_start * of_course / gamma;
    if error > 1e-6 {
        let what = format!(
            "at exposure {index} the observer's velocity is what two of γ = {of_start:.1e} and {of_course:.1e} leave of \
             one another: known to a part {error:.0e}"
        );
        report.fault(place(), what, "describe the journey from where the observer is slow");
    }
}

fn check_glass(manifest: &Manifest, scene: &Scene, report: &mut Report) {
    for body in &manifest.bodies {
        let velocity = body.placement.velocity;
        let glass = scene.media.iter().any(|medium| medium.rest_from_lab.velocity() == velocity);
        if glass && velocity.gamma() > GREATEST_GAMMA_OF_GLASS {
            let what = format!("glass at a Lorentz factor of {:.1e}", velocity.gamma());
            report.fault(body.place.clone(), what, "1e5 at most, or describe all from where the glass rests");
        }
    }
}

/// The sum of a difference's parts, metres.
fn size(difference: FourVector) -> f64 {
    difference.t.abs() + difference.x.abs().max_element()
}

/// How uncertain a body is, metres.
#[derive(Debug, Clone, Copy)]
struct Uncertain {
    // In its rest frame.
    place: f64,
    // On its way through the lab, when it shines or is lit.
    way: f64,
}

fn uncertain(rest: &RestFrame, placed: &Placed, observer: Event) -> Uncertain {
    let gamma = rest.rest_from_lab.boost().velocity().gamma();
    let origin = rest.rest_from_lab.origin();
    let apart = size(observer - origin);
    let known = size(observer - Event::ORIGIN).max(size(origin - Event::ORIGIN));
    let unit = ROUNDINGS * f64::EPSILON;
    let place = unit * (gamma * (apart + 0.25 * known) + placed.reach());
    Uncertain { place, way: unit * gamma * gamma * apart }
}

fn check_bodies(manifest: &Manifest, scene: &Scene, ends: &[Event], report: &mut Report) {
    let mut worst = vec![(0.0_f64, 0.0_f64, Uncertain { place: 0.0, way: 0.0 }); manifest.bodies.len()];
    for rest in &scene.world.frames {
        let others = others(scene, rest.rest_from_lab.boost().velocity());
        for placed in &rest.placed {
            let Some(worst) = worst.get_mut(placed.body as usize) else { continue };
            for observer in ends {
                let found = uncertain(rest, placed, *observer);
                let part = found.place / placed.extent();
                if part > worst.0 {
                    *worst = (part, worst.1, Uncertain { place: found.place, ..worst.2 });
                }
                let part = found.way * others / placed.extent();
                if part > worst.1 {
                    *worst = (worst.0, part, Uncertain { way: found.way * others, ..worst.2 });
                }
            }
        }
    }
    for (body, (place_part, way_part, error)) in manifest.bodies.iter().zip(worst) {
        let gamma = body.placement.velocity.gamma();
        let nearer = "bring the body and the observer nearer to one another, and both nearer to the lab's origin and time \
                      zero, or make the body larger or slower";
        if !(place_part <= WORTH_SAYING) {
            let parts = if place_part > 1.0 {
                "more than its own size".into()
            } else {
                format!("{place_part:.1e} of it")
            };
            let what = format!(
                "at γ = {gamma:.3e}, and as far away as the observer gets, this body's place is known to {:.1e} m: {parts}",
                error.place
            );
            let say = if place_part <= 1.0 { Report::warn } else { Report::fault };
            say(report, body.place.clone(), what, nearer);
        } else if !(way_part <= 0.1) {
            let what = format!(
                "at γ = {gamma:.3e} it is known to {:.1e} m where on its way the light seen left this body: as uncertain is \
                 what lamps and bodies of other rest frames do to it",
                error.way
            );
            report.warn(
                body.place.clone(),
                what,
                "let its lamps move with it, or let it glow; or make it slower",
            );
        }
    }
}

/// The greatest Lorentz factor of what lights, or shades, what moves with a velocity, and does not move so itself; 0 if
/// there is nothing of that kind.
fn others(scene: &Scene, velocity: Velocity) -> f64 {
    let lamps = scene.lamps.iter().filter(|lamp| !matches!(lamp.beam, Beam::Sun { .. }));
    let lamps = lamps.map(|lamp| lamp.rest_from_lab.boost().velocity());
    let bodies = scene.world.frames.iter().filter(|_| !scene.lamps.is_empty());
    let bodies = bodies.map(|rest| rest.rest_from_lab.boost().velocity());
    lamps.chain(bodies).filter(|other| *other != velocity).map(Velocity::gamma).fold(0.0, f64::max)
}
