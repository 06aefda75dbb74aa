//! What was measured of each pixel, as channels of an `OpenEXR` file.

use super::Print;
use crate::color::RGB_FROM_XYZ;
use crate::exposure::{first_seen, middles};
use crate::manifest::{Depth, Layer};
use crate::observer::View;
use crate::output::{Channel, ExrForm, Measured};
use crate::plan::{self, Picture, Plan};
use crate::scene::Scene;
use crate::surface::{Look, Surface};
use glam::{DVec3, Vec3};

/// What is seen at a pixel's centre beside its light, as finely as it is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    doppler: f64,
    // The lab's time, metres.
    emission: f64,
    // Metres.
    distance: f32,
    normal: Vec3,
    albedo: Vec3,
    body: u32,
    material: u32,
}

/// What is seen at each pixel's centre.
pub(super) fn seen(scene: &Scene, plan: &Plan, view: &View) -> Vec<Option<Seen>> {
    let colored = plan.outputs.exr.as_ref().is_some_and(|exr| exr.layers.contains(&Layer::Albedo));
    let color = |surface: Option<&Surface>, look: &Look<'_>| {
        surface.map_or(DVec3::ZERO, |surface| surface.albedo(look))
    };
    first_seen(scene, view, (plan.sampling.width, plan.sampling.height), |lit, centre, ray| {
        let (first, albedo) =
            if colored { lit.first_and(ray, color)? } else { (lit.first(ray)?, DVec3::ZERO) };
        Some(Seen {
            doppler: first.doppler.factor(),
            emission: first.emission.t,
            distance: (first.s * view.frequency(ray)) as f32,
            normal: view.apparent_normal(centre, first.normal).as_vec3(),
            albedo: albedo.as_vec3(),
            body: first.body,
            material: first.surface,
        })
    })
}

/// Whether what is wanted is told by rays to the pixels' centres.
pub(crate) fn asks_rays(plan: &Plan) -> bool {
    let outputs = &plan.outputs;
    let measured = |layer: &Layer| !matches!(layer, Layer::Radiance | Layer::Xyz | Layer::Spectrum);
    let exr = outputs.exr.as_ref().is_some_and(|exr| exr.layers.iter().any(measured));
    exr || outputs.pictures.iter().any(|picture| matches!(picture, Picture::Doppler | Picture::EmissionTime))
}

/// A number of what is seen at each pixel's centre, for false colours.
pub(super) fn shown(plan: &Plan, print: &Print, picture: Picture) -> Vec<Option<f64>> {
    let number = |seen: &Seen| match picture {
        Picture::EmissionTime => seen.emission * plan.seconds_per_metre,
        _ => seen.doppler,
    };
    print.seen.as_deref().unwrap_or(&[]).iter().map(|seen| seen.as_ref().map(number)).collect()
}

/// What the file of any exposure is like.
pub(super) fn form(plan: &Plan, wanted: &plan::Measured) -> ExrForm {
    let (width, height) = (plan.sampling.width, plan.sampling.height);
    let names = wanted.layers.iter().flat_map(|layer| names(plan, *layer));
    let channel = |name: String| (name.clone(), wanted.depth == Depth::Half && is_light(&name));
    let mut channels: Vec<_> = names.map(channel).collect();
    channels.sort();
    channels.dedup();
    ExrForm { size: (width, height), channels }
}

/// How many channels the file of any exposure has.
pub(crate) fn channels(plan: &Plan, wanted: &plan::Measured) -> usize {
    form(plan, wanted).channels.len()
}

/// The channels of a layer.
fn names(plan: &Plan, layer: Layer) -> Vec<String> {
    let known: &[&str] = match layer {
        Layer::Radiance => &["R", "G", "B"],
        Layer::Xyz => &["cie.X", "cie.Y", "cie.Z"],
        Layer::Doppler => &["doppler"],
        Layer::EmissionTime => &["emission_time"],
        Layer::Distance => &["distance"],
        Layer::Normal => &["normal.X", "normal.Y", "normal.Z"],
        Layer::Body => &["body"],
        Layer::Material => &["material"],
        Layer::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
        Layer::Spectrum => return middles(plan.sampling.wavelengths).into_iter().map(band).collect(),
    };
    known.iter().map(|name| (*name).to_owned()).collect()
}

/// The channel of a part of the spectrum by its middle, nm. (The layout wants a comma.)
fn band(nm: f64) -> String {
    format!("S0.{}nm", nm.to_string().replace('.', ","))
}

/// Whether the digits of 16 bits are enough for a channel: not for places, times and whole numbers.
fn is_light(name: &str) -> bool {
    !["doppler", "emission_time", "distance", "body", "material"].contains(&name) && !name.starts_with("S0.")
}

/// The file of an exposure.
pub(super) fn measured<'a>(plan: &Plan, wanted: &plan::Measured, print: &'a Print) -> Measured<'a> {
    let form = form(plan, wanted);
    let channel =
        |(name, half): (String, bool)| Channel { values: values(plan, wanted, print, &name), name, half };
    Measured {
        width: print.negative.width as usize,
        height: print.negative.height as usize,
        channels: form.channels.into_iter().map(channel).collect(),
        white_luminance: unit(wanted, print) as f32,
        spectral: wanted.layers.contains(&Layer::Spectrum),
        text: &print.text,
    }
}

/// The luminance that is 1 in the file, cd/m².
fn unit(wanted: &plan::Measured, print: &Print) -> f64 {
    if wanted.depth == Depth::Half { print.white } else { 1.0 }
}

fn values(plan: &Plan, wanted: &plan::Measured, print: &Print, name: &str) -> Vec<f32> {
    let unit = unit(wanted, print);
    let light = |of: &dyn Fn(DVec3) -> f64| -> Vec<f32> {
        let xyz = |xyz: &[f32; 3]| DVec3::from(xyz.map(f64::from)) / unit;
        print.negative.xyz.iter().map(|pixel| of(xyz(pixel)) as f32).collect()
    };
    let number = |nothing: f64, of: &dyn Fn(&Seen) -> f64| -> Vec<f32> {
        let seen = print.seen.as_deref().unwrap_or(&[]);
        seen.iter().map(|seen| seen.as_ref().map_or(nothing, of) as f32).collect()
    };
    match name {
        "R" => light(&|xyz| RGB_FROM_XYZ.row(0).dot(xyz)),
        "G" => light(&|xyz| RGB_FROM_XYZ.row(1).dot(xyz)),
        "B" => light(&|xyz| RGB_FROM_XYZ.row(2).dot(xyz)),
        "cie.X" => light(&|xyz| xyz.x),
        "cie.Y" => light(&|xyz| xyz.y),
        "cie.Z" => light(&|xyz| xyz.z),
        "doppler" => number(0.0, &|seen| seen.doppler),
        "emission_time" => number(0.0, &|seen| seen.emission * plan.seconds_per_metre),
        "distance" => number(0.0, &|seen| seen.distance.into()),
        "normal.X" => number(0.0, &|seen| seen.normal.x.into()),
        "normal.Y" => number(0.0, &|seen| seen.normal.y.into()),
        "normal.Z" => number(0.0, &|seen| seen.normal.z.into()),
        "albedo.R" => number(0.0, &|seen| seen.albedo.x.into()),
        "albedo.G" => number(0.0, &|seen| seen.albedo.y.into()),
        "albedo.B" => number(0.0, &|seen| seen.albedo.z.into()),
        "body" => number(-1.0, &|seen| f64::from(seen.body)),
        "material" => number(-1.0, &|seen| f64::from(seen.material)),
        _ => {
            let number =
                print.bands.as_ref().and_then(|bands| bands.nm.iter().position(|nm| band(*nm) == name));
            number.zip(print.bands.as_ref()).map_or_else(Vec::new, |(i, bands)| bands.radiance[i].clone())
        }
    }
}
