//! Up to where a picture is what would be seen: beyond, it is said, and what cannot be right is refused.
//!
//! Everything in the lab is in `f64`. An event that is d metres and metres of time away from a body's origin is known to
//! some ε d there; in the body's rest frame that is ε γ d. Light of Doppler factor D leaves a body D times as uncertainly
//! in the body's time as it arrives, and on the body's way through the lab γ times that: 2 ε γ² d.

use super::Exposure;
use crate::error::Report;
use crate::lamp::Beam;
use crate::manifest::{self, LightSource, Manifest};
use crate::scene::{Scene, placement};
use crate::spacetime::{Course, Event, FourVector, Lab, Poincare, Rest, Velocity};
use crate::spectrum::Source;
use crate::surface::{Scatter, Surface};
use crate::world::{Form, Placed};

/// How many roundings there are at most between what is written and a place in a rest frame.    Law: tests
/// `edges::search::*`.
const ROUNDINGS: f64 = 4.0;

/// A body whose place is less certain than this part of its size is rendered with a warning; one whose place is not as
/// certain as its size is refused.
const WORTH_SAYING: f64 = 1e-3;

/// The greatest Lorentz factor of glass: light in it is no null vector, and by the plain formulas.
const GREATEST_GAMMA_OF_GLASS: f64 = 1e5;

/// Says at the exposures' ends, where things are farthest apart (on a path through keys at all of them), what is beyond the limits.
pub(super) fn check(manifest: &Manifest, scene: &Scene, exposures: &[Exposure], report: &mut Report) {
    let faults = report.faults.len();
    let mut ends = vec![];
    let everywhere = matches!(scene.observer.worldline.course(), Course::Keyed(_));
    let last = exposures.len().saturating_sub(1);
    let ends_or_all = |index: usize| everywhere || index == 0 || index == last;
    for (_, exposure) in exposures.iter().enumerate().filter(|(index, _)| ends_or_all(*index)) {
        let tetrad = scene.observer.worldline.at(exposure.tau);
        check_speed(manifest, scene, exposure, tetrad.velocity().t, tetrad.event, report);
        if report.faults.len() > faults {
            return;
        }
        ends.push(tetrad.event);
    }
    check_glass(manifest, scene, report);
    check_bodies(manifest, scene, &ends, report);
    check_lamps(manifest, scene, &ends, report);
    check_clocks(manifest, scene, &ends, report);
    check_spectra(manifest, scene, report);
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
    let of_course = match scene.observer.worldline.course() {
        Course::Inertial | Course::Ring { .. } => 1.0,
        Course::Rocket { acceleration } => libm::cosh(acceleration.length() * exposure.tau),
        Course::Keyed(track) => 1.0 / (1.0 - track.at(track.when(exposure.tau)).1.length_squared()).sqrt(),
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
    for (number, body) in manifest.bodies.iter().enumerate() {
        let gamma = body.gamma();
        if gamma > GREATEST_GAMMA_OF_GLASS && is_of_glass(scene, number) {
            let what = format!("glass at a Lorentz factor of {gamma:.1e}");
            report.fault(body.place.clone(), what, "1e5 at most, or describe all from where the glass rests");
        }
    }
}

fn is_of_glass(scene: &Scene, body: usize) -> bool {
    let placed = scene.world.frames.iter().flat_map(|rest| &rest.placed);
    let own = placed.filter(|placed| placed.body as usize == body).flat_map(|placed| {
        let last = match &placed.form {
            Form::Mesh(triangles) => triangles.mesh.parts.iter().map(|part| part.material).max(),
            Form::Solid(_) => None,
        };
        placed.surfaces..=placed.surfaces + last.unwrap_or(0)
    });
    let glass = |surface: &Surface| matches!(&surface.scatter, Scatter::Glass(glass) if !glass.thin);
    own.filter_map(|number| scene.surfaces.get(number as usize)).flat_map(Surface::all).any(glass)
}

/// The sum of a difference's parts, metres.
fn size(difference: FourVector) -> f64 {
    difference.t.abs() + difference.x.abs().max_element()
}

/// The same as far as it enters a place in a rest frame, which is γ(x - βt): time counts only for what moves.
fn size_of_place(difference: FourVector, velocity: Velocity) -> f64 {
    velocity.gamma() * difference.x.abs().max_element() + velocity.proper().length() * difference.t.abs()
}

/// How uncertain a body is, metres.
#[derive(Debug, Clone, Copy)]
struct Uncertain {
    // In its rest frame.
    place: f64,
    // On its way through the lab, when it shines or is lit.
    way: f64,
}

/// `reach`: how large its coordinates are in its rest frame.
fn uncertain(rest_from_lab: &Poincare<Rest, Lab>, reach: f64, observer: Event) -> Uncertain {
    let velocity = rest_from_lab.boost().velocity();
    let gamma = velocity.gamma();
    let origin = rest_from_lab.origin();
    let sized = |difference: FourVector| size_of_place(difference, velocity);
    let apart = sized(observer - origin);
    let known = sized(observer - Event::ORIGIN).max(sized(origin - Event::ORIGIN));
    let unit = ROUNDINGS * f64::EPSILON;
    let place = unit * (apart + 0.25 * known + reach);
    Uncertain { place, way: unit * gamma * gamma * size(observer - origin) }
}

fn check_bodies(manifest: &Manifest, scene: &Scene, ends: &[Event], report: &mut Report) {
    let mut worst = vec![(0.0_f64, 0.0_f64, Uncertain { place: 0.0, way: 0.0 }); manifest.bodies.len()];
    for rest in &scene.world.frames {
        let others = others(scene, rest.rest_from_lab.boost().velocity());
        for placed in &rest.placed {
            let Some(worst) = worst.get_mut(placed.body as usize) else { continue };
            for observer in ends {
                let found = uncertain(&rest.rest_from_lab, placed.reach(), *observer);
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
        let gamma = body.gamma();
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

/// Lamps of the manifest: those of files rest with bodies, which are looked at above.
fn check_lamps(manifest: &Manifest, scene: &Scene, ends: &[Event], report: &mut Report) {
    let placed = scene.world.frames.iter().flat_map(|rest| &rest.placed);
    let smallest = placed.map(Placed::extent).fold(f64::INFINITY, f64::min);
    for light in manifest.lights.iter().filter(|light| !matches!(light.source, LightSource::Sun(_))) {
        let velocity = light.placement.velocity;
        let rest_from_lab = placement(&light.placement).rest_from_lab();
        let alone = scene.world.frames.iter().all(|rest| rest.rest_from_lab.boost().velocity() == velocity);
        let error = |observer: &Event| {
            let found = uncertain(&rest_from_lab, 0.0, *observer);
            if alone { found.place } else { found.place.max(found.way * velocity.beta().length()) }
        };
        let worst = ends.iter().map(error).fold(0.0, f64::max);
        if !(worst <= 0.1 * smallest) {
            let what = format!(
                "at γ = {:.3e}, and as far away in place and time as this lamp is, its place is known to {worst:.1e} m, and the \
                 smallest body is {smallest:.1e} m",
                velocity.gamma()
            );
            let hint = "say where it is at a time nearer to the pictures' (`at` and `at_time`)";
            let say = if worst <= smallest { Report::warn } else { Report::fault };
            say(report, light.place.clone(), what, hint);
        }
    }
}

/// What blinks faster than its clock can be read.
fn check_clocks(manifest: &Manifest, scene: &Scene, ends: &[Event], report: &mut Report) {
    let of_surfaces =
        scene.surfaces.iter().flat_map(Surface::all).filter_map(|surface| match &surface.scatter {
            Scatter::Mixed(parts) => Some(parts.iter().map(|(course, _)| course)),
            _ => None,
        });
    let of_lamps = scene.lamps.iter().map(|lamp| lamp.light.iter().map(|(course, _)| course));
    let frames = scene.world.frames.iter().map(|rest| &rest.rest_from_lab);
    let frames = frames.chain(scene.lamps.iter().map(|lamp| &lamp.rest_from_lab));
    let way = |own: &Poincare<Rest, Lab>| {
        ends.iter().map(|observer| uncertain(own, 0.0, *observer).way).fold(0.0, f64::max)
    };
    let known = frames.map(way).fold(0.0, f64::max);
    for course in of_surfaces.flatten().chain(of_lamps.flatten()) {
        let crate::course::Course::Blinking { period, start, .. } = course else { continue };
        let known = known.max(ROUNDINGS * f64::EPSILON * start.abs());
        if known > 0.01 * period {
            let seconds = 1.0 / manifest.light_speed;
            let what = format!(
                "something blinks with a period of {:.1e} s, and its clock can be read to {:.1e} s only",
                period * seconds,
                known * seconds
            );
            let hint = "choose a longer period, or times and places nearer to zero";
            return report.warn(manifest.exposures.place.clone(), what, hint);
        }
    }
}

/// What the wavelengths may miss: peaks of measured spectra that are narrower than they lie apart.
fn check_spectra(manifest: &Manifest, scene: &Scene, report: &mut Report) {
    let finest = if manifest.picture.tolerance.is_some() { 64 } else { manifest.picture.wavelengths };
    let apart = 300.0 / f64::from(finest);
    let narrowest = scene.sources().filter_map(Source::narrowest_peak_nm).fold(f64::INFINITY, f64::min);
    if narrowest < apart {
        let what = format!(
            "a spectrum that shines has a peak {narrowest:.1} nm wide, which wavelengths {apart:.1} nm apart may miss"
        );
        let hint = "write the peak as a line, as in `sum: [ ..., { line: { centre: 546 nm, width: 3 nm } } ]`, or take `wavelengths: 64`";
        report.warn(manifest.picture.place.clone(), what, hint);
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
