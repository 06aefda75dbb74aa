//! Sight rays, and what comes along them.

use glam::{DVec2, DVec3};
use terrell::exposure::{Sampling, expose};
use terrell::film::{Negative, Reconstruction};
use terrell::observer::View;
use terrell::scene::Scene;
use terrell::spacetime::{Event, FourVector, Poincare, Rest, SightRay, Velocity};
use terrell::spectrum::Wavelengths;
use terrell::trace::{First, Light};

/// The light that arrives at an event of the lab from the direction of another place, frequency 1 in the lab.
pub(crate) fn light_from(place: DVec3, arrival: Event) -> SightRay {
    let n = (place - arrival.x) / (place - arrival.x).length();
    SightRay { event: arrival, k: FourVector::new(1.0, -n) }
}

/// The light that leaves an event of the lab for a place; it arrives there at a later time.
pub(crate) fn light_to(place: DVec3, departure: Event) -> SightRay {
    let distance = (place - departure.x).length();
    light_from(departure.x, Event::new(departure.t + distance, place))
}

/// The light that goes from a place in a rest frame to an event there, as the lab sees it: s is 1 at the place.
pub(crate) fn light_at_rest(rest_from_lab: &Poincare<Rest>, place: DVec3, arrival: Event<Rest>) -> SightRay {
    let way = arrival.x - place;
    let k = FourVector::<Rest>::new(way.length(), way);
    SightRay { event: rest_from_lab.undo(arrival), k: rest_from_lab.boost().inverse() * k }
}

/// What comes along a sight ray, at 64 wavelengths.
pub(crate) fn look(scene: &Scene, ray: &SightRay) -> Light<64> {
    scene.lit().seen(ray, &Wavelengths::new())
}

/// Whether any light of the visible range comes along a sight ray.
pub(crate) fn is_bright(scene: &Scene, ray: &SightRay) -> bool {
    scene.lit().seen(ray, &Wavelengths::<8>::new()).radiance.iter().any(|value| *value > 0.0)
}

/// What stands first in the way of a sight ray.
#[track_caller]
pub(crate) fn first(scene: &Scene, ray: &SightRay) -> First {
    scene.lit().first(ray).unwrap_or_else(|| panic!("the ray meets nothing"))
}

/// A picture at the eye's proper time zero, one sample a pixel.
pub(crate) fn picture(scene: &Scene, width: u32, height: u32) -> (View, Negative) {
    let view = scene.observer.view(0.0, width, height);
    let sampling =
        Sampling { width, height, samples: 1, reconstruction: Reconstruction::default(), wavelengths: 8 };
    let negative = expose(scene, &view, &sampling);
    (view, negative)
}

/// The centre of a pixel by its number.
pub(crate) fn pixel_centre(number: usize, width: u32) -> DVec2 {
    let width = width as usize;
    DVec2::new((number % width) as f64 + 0.5, (number / width) as f64 + 0.5)
}

/// The frequency, for someone who moves, of light that moves along the unit vector `n` in the lab with frequency 1 there.
pub(crate) fn frequency(velocity: Velocity, n: DVec3) -> f64 {
    velocity.gamma() - velocity.proper().dot(n)
}

/// Aberration: the direction, in the rest frame of someone who moves, of light that moves along the unit vector `n` in
/// the lab.
pub(crate) fn along(velocity: Velocity, n: DVec3) -> DVec3 {
    let u = velocity.proper();
    (n + u * (u.dot(n) / (velocity.gamma() + 1.0) - 1.0)) / frequency(velocity, n)
}
