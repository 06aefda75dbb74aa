//! Sight rays, and what comes along them.

use glam::{DVec2, DVec3};
use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use std::path::Path;
use terrell::error::Report;
use terrell::exposure::{Sampling, expose};
use terrell::film::{Negative, Reconstruction};
use terrell::manifest::{self, Manifest};
use terrell::observer::View;
use terrell::plan::Plan;
use terrell::scene::{Scene, compose};
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

/// A picture in full precision, pixel by pixel, each sample as wide as a pixel.
pub(crate) fn exposed<const N: usize>(scene: &Scene, tau: f64, (width, height): (u32, u32)) -> Vec<DVec3> {
    let view = scene.observer.view(tau, width, height);
    let wavelengths = Wavelengths::<N>::new();
    let lit = scene.lit();
    let at = |number: usize| {
        let (ray, cone) = view.sight(pixel_centre(number, width), 1.0);
        let light = lit.seen_within(&ray, cone, &wavelengths);
        wavelengths.xyz(&light.radiance) + light.lines
    };
    (0..(width * height) as usize).into_par_iter().map(at).collect()
}

/// The largest relative difference of pixels, and how many of them differ by more than a part in 10,000: those that
/// an edge passes.
pub(crate) fn difference(a: &[DVec3], b: &[DVec3]) -> (f64, usize) {
    let mean = a.iter().map(|xyz| xyz.y).sum::<f64>() / a.len() as f64;
    let (mut worst, mut others) = (0.0_f64, 0);
    for (p, q) in a.iter().zip(b) {
        let part = (p - q).length() / (p.length() + 1e-3 * mean);
        if part < 1e-4 { worst = worst.max(part) } else { others += 1 }
    }
    (worst, others)
}

/// The scene and the plan of a manifest as text, that lies beside the committed ones.
#[track_caller]
pub(crate) fn manifested(text: &str) -> (Manifest, Scene, Plan) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("manifests/manifested.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, text, &mut report);
    let scene = manifest.as_ref().and_then(|manifest| compose(manifest, &path, &mut report));
    assert!(report.faults.is_empty(), "{:?}\n{text}", report.faults);
    let (manifest, scene) = (manifest.unwrap(), scene.unwrap());
    let plan = Plan::of(&manifest, &scene, &path, &mut report);
    assert!(report.faults.is_empty(), "{:?}\n{text}", report.faults);
    (manifest, scene, plan)
}

/// The largest difference of two pictures, in parts of the mean value of the second.
pub(crate) fn relative_difference(a: &Negative, b: &Negative) -> f64 {
    let all = b.xyz.iter().flatten().map(|value| f64::from(*value));
    let mean = all.sum::<f64>() / (3 * b.xyz.len()) as f64;
    let pairs = a.xyz.iter().flatten().zip(b.xyz.iter().flatten());
    pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs()).fold(0.0, f64::max) / mean
}
