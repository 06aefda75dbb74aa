//! Only what the scene needs: which methods it takes to render it, and why. Derived before rendering; `terrell check` shows
//! it.

use super::Plan;
use crate::scene::Scene;
use crate::spacetime::{Course, FourVector, Velocity};
use crate::spectrum::Tone;
use crate::surface::{Scatter, Surface};
use crate::surroundings::Part as SkyPart;

/// One choice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// What is chosen.
    pub name: &'static str,
    /// The choice.
    pub choice: String,
    /// Why.
    pub why: String,
}

impl Part {
    fn new(name: &'static str, choice: impl Into<String>, why: impl Into<String>) -> Self {
        Self { name, choice: choice.into(), why: why.into() }
    }
}

/// A yes or a no with its reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Because {
    /// Whether it is so.
    pub yes: bool,
    /// What decides it.
    pub why: &'static str,
}

const fn yes(why: &'static str) -> Because {
    Because { yes: true, why }
}

const fn no(why: &'static str) -> Because {
    Because { yes: false, why }
}

/// Largest difference of four-velocities that counts as rest: shifts of 1e-12 are rounding.
const AT_REST: f64 = 1e-12;

/// Whether nothing moves relative to the observer, by more than `most`, that shines, is seen or throws light back; the sky
/// counts if it is to.
fn at_rest(scene: &Scene, sky: bool, most: f64) -> bool {
    let observer = &scene.observer.worldline;
    if !matches!(observer.course(), Course::Inertial | Course::Ring { .. }) {
        return false;
    }
    let seer = observer.at(0.0).velocity();
    let rests = |velocity: Velocity| {
        let FourVector { t, x, .. }: FourVector = velocity.four();
        (t - seer.t).abs().max((x - seer.x).abs().max_element()) <= most
    };
    let bodies = scene.world.frames.iter().map(|rest| rest.rest_from_lab.boost().velocity());
    let lamps = scene.lamps.iter().map(|lamp| lamp.rest_from_lab.boost().velocity());
    let skies = scene.surroundings.iter().filter(|_| sky).map(|sky| sky.rest_from_lab.velocity());
    bodies.chain(lamps).chain(skies).all(rests)
}

/// Whether three wavelengths give the same picture as many.
///
/// The weights make XYZ of daylight through each sRGB primary exact for any number of wavelengths, three included. So they suffice where all
/// light is daylight through at most one colour, and no wavelength is shifted.
pub fn three_wavelengths(scene: &Scene) -> Because {
    if scene.effects.doppler && !at_rest(scene, true, AT_REST) {
        return no("light is shifted between the frames");
    }
    if !scene.lines.is_empty() {
        return no("there are spectral lines");
    }
    if scene.media.iter().any(|medium| medium.index.disperses() || medium.absorption.is_some()) {
        return no("there is glass that parts or takes colours");
    }
    let all = || scene.surfaces.iter().flat_map(Surface::all);
    if all().any(|surface| filter(&surface.scatter) > Tone::Grey) {
        return no("a mirror or glass is coloured, and colours multiply");
    }
    let lit = scene.lamps.iter().flat_map(|lamp| &lamp.light).map(|(_, source)| source).chain(&scene.ambient);
    let lit = lit.map(crate::spectrum::Source::tone).max().unwrap_or(Tone::Grey);
    let scattered = all().map(|surface| scattered(&surface.scatter)).max().unwrap_or(Tone::Grey);
    let glow = all().filter_map(|surface| surface.glow.as_ref()).map(|glow| {
        let paint = glow.paint.as_ref().map_or(Tone::Grey, crate::surface::Paint::tone);
        glow.radiance.tone().times(paint)
    });
    let sky = scene.surroundings.iter().flat_map(|sky| &sky.sky.parts).map(|part| match part {
        SkyPart::Uniform(source) => source.tone(),
        SkyPart::Panorama(_) => Tone::Color,
        SkyPart::Stars(_) => Tone::Spectrum,
    });
    let single = glow.chain(sky).chain([lit, scattered]).max().unwrap_or(Tone::Grey);
    match single.max(lit.times(scattered)) {
        Tone::Grey | Tone::Color => {
            yes("all light is daylight through one colour at most, and none is shifted")
        }
        Tone::Spectrum if single < Tone::Spectrum => {
            no("coloured light falls on colours, and colours multiply")
        }
        Tone::Spectrum => no("there are spectra that are no colour of daylight"),
    }
}

/// What diffuse parts and highlights do to a lamp's light.
fn scattered(scatter: &Scatter) -> Tone {
    match scatter {
        Scatter::Diffuse(paint) => paint.tone(),
        Scatter::Gloss(gloss) => {
            let specular = gloss.specular_color.as_ref().map_or(Tone::Grey, crate::surface::Paint::tone);
            gloss.base.tone().max(specular)
        }
        Scatter::Metal(_) => Tone::Spectrum,
        Scatter::Glass(glass) => glass.color.as_ref().map_or(Tone::Grey, crate::surface::Paint::tone),
        Scatter::Absorb | Scatter::Mirror(_) | Scatter::Mixed(_) => Tone::Grey,
    }
}

/// What is done to light that comes from other bodies.
fn filter(scatter: &Scatter) -> Tone {
    match scatter {
        Scatter::Mirror(paint) => paint.tone(),
        Scatter::Metal(_) => Tone::Spectrum,
        Scatter::Gloss(gloss) => {
            let specular = gloss.specular_color.as_ref().map_or(Tone::Grey, crate::surface::Paint::tone);
            if gloss.metallic > 0.0 { gloss.base.tone().max(specular) } else { specular }
        }
        Scatter::Glass(glass) => glass.color.as_ref().map_or(Tone::Grey, crate::surface::Paint::tone),
        Scatter::Absorb | Scatter::Diffuse(_) | Scatter::Mixed(_) => Tone::Grey,
    }
}

/// Whether every exposure of the film is the same picture.
pub fn still(scene: &Scene) -> Because {
    let steady = |course: &crate::course::Course| *course == crate::course::Course::Steady;
    if !matches!(scene.observer.worldline.course(), Course::Inertial) || scene.observer.filmed.is_some() {
        return no("the observer's motion or place changes");
    }
    // Exactly: what is as slow as can be gets somewhere in time.
    if !at_rest(scene, false, 0.0) {
        return no("something moves relative to the observer");
    }
    let lamps = scene.lamps.iter().flat_map(|lamp| &lamp.light).all(|(course, _)| steady(course));
    let surfaces = scene.surfaces.iter().flat_map(Surface::all).all(|surface| match &surface.scatter {
        Scatter::Mixed(parts) => parts.iter().all(|(course, _)| steady(course)),
        _ => true,
    });
    if lamps && surfaces {
        yes("nothing moves relative to the observer, and nothing blinks")
    } else {
        no("something blinks or is keyed")
    }
}

/// All choices with their reasons, in the order of the light's way.
pub fn parts(scene: &Scene, plan: &Plan) -> Vec<Part> {
    let lit = scene.lit();
    let mut parts = vec![frames(scene)];
    let still = still(scene);
    let choice =
        if still.yes { "one picture serves all exposures" } else { "each exposure is a picture of its own" };
    if plan.exposures.len() > 1 {
        parts.push(Part::new("exposures", choice, still.why));
    }
    parts.push(shadows(scene));
    parts.push(if lit.depth > 0 {
        Part::new("recursion", format!("{} deep", lit.depth), "there are mirrors, gloss or glass")
    } else {
        Part::new("recursion", "none", "nothing mirrors and nothing refracts")
    });
    let wavelengths = match (plan.sampling.wavelengths, plan.tolerance) {
        (3, _) | (_, None) => format!("{} wavelengths", plan.sampling.wavelengths),
        (_, Some(_)) => "16 to 64 wavelengths, as each pixel needs".to_owned(),
    };
    let three = three_wavelengths(scene);
    let why = if three.yes && plan.outputs.spectrum() { "their spectrum is written" } else { three.why };
    parts.push(Part::new("spectra", wavelengths, why));
    parts.push(lines(scene));
    let dispersing = scene.media.iter().any(|medium| medium.index.disperses());
    parts.push(if dispersing {
        Part::new(
            "dispersion",
            "each wavelength goes its own way",
            "there is glass whose index depends on it",
        )
    } else {
        Part::new("dispersion", "none", "no index depends on the wavelength")
    });
    parts.push(if lit.footprints {
        Part::new("footprints", "means over what a sample sees", "there are textures or checkers")
    } else {
        Part::new("footprints", "none", "nothing is textured")
    });
    let skies = scene.surroundings.len();
    parts.push(match skies {
        0 => Part::new("surroundings", "black", "the manifest names none"),
        _ => Part::new("surroundings", format!("{skies}"), "seen where no body is"),
    });
    parts.push(Part::new(
        "precision",
        "f64",
        "boxes of trees alone are f32, padded by more than their rounding",
    ));
    parts
}

fn frames(scene: &Scene) -> Part {
    match scene.world.frames.len() {
        0 => Part::new("rest frames", "none", "there are no bodies"),
        1 => Part::new("rest frames", "one", "all bodies have the same velocity"),
        many => Part::new("rest frames", format!("{many}"), "one for each velocity, one tree each"),
    }
}

fn shadows(scene: &Scene) -> Part {
    if scene.lamps.is_empty() {
        Part::new("shadows", "none", "there are no lamps")
    } else if scene.lit().see_through {
        Part::new("shadows", "everything on the way counts", "there is glass, or surfaces with holes")
    } else {
        Part::new("shadows", "the first thing on the way ends it", "nothing lets light through")
    }
}

fn lines(scene: &Scene) -> Part {
    match scene.lines.len() {
        0 => Part::new("lines", "none", "no source has one"),
        1 => Part::new("lines", "one, carried exactly", "a source has it"),
        many => Part::new("lines", format!("{many}, carried exactly"), "sources have them"),
    }
}
