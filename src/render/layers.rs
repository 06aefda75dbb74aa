//! What was measured of each pixel, as channels of an `OpenEXR` file.

use super::Print;
use crate::color::RGB_FROM_XYZ;
use crate::exposure::{first_colors, first_hits, middles};
use crate::manifest::{Depth, Layer};
use crate::observer::View;
use crate::output::{Channel, ExrForm, Measured};
use crate::plan::{self, Picture, Plan};
use crate::scene::Scene;
use crate::trace::First;
use glam::{DVec2, DVec3};

/// What is seen at a pixel's centre beside its light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    first: First,
    // Metres.
    distance: f64,
    normal: DVec3,
    albedo: DVec3,
}

/// What is seen at each pixel's centre.
pub(super) fn seen(scene: &Scene, plan: &Plan, view: &View) -> Vec<Option<Seen>> {
    let (width, height) = (plan.sampling.width, plan.sampling.height);
    let colored = plan.outputs.exr.as_ref().is_some_and(|exr| exr.layers.contains(&Layer::Albedo));
    let firsts: Vec<Option<(First, DVec3)>> = if colored {
        first_colors(scene, view, width, height)
    } else {
        let firsts = first_hits(scene, view, width, height).into_iter();
        firsts.map(|first| first.map(|first| (first, DVec3::ZERO))).collect()
    };
    let seen = |(number, first): (usize, Option<(First, DVec3)>)| {
        let (first, albedo) = first?;
        let (column, row) = (number % width as usize, number / width as usize);
        let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        Some(Seen {
            distance: first.s * view.frequency(&view.ray(centre)),
            normal: view.apparent_normal(centre, first.normal),
            albedo,
            first,
        })
    };
    firsts.into_iter().enumerate().map(seen).collect()
}

/// Whether what is wanted is told by rays to the pixels' centres.
pub(super) fn asks_rays(plan: &Plan) -> bool {
    let outputs = &plan.outputs;
    let measured = |layer: &Layer| !matches!(layer, Layer::Radiance | Layer::Xyz | Layer::Spectrum);
    let exr = outputs.exr.as_ref().is_some_and(|exr| exr.layers.iter().any(measured));
    exr || outputs.pictures.iter().any(|picture| matches!(picture, Picture::Doppler | Picture::EmissionTime))
}

/// A number of what is seen at each pixel's centre, for false colours.
pub(super) fn shown(plan: &Plan, print: &Print, picture: Picture) -> Vec<Option<f64>> {
    let number = |seen: &Seen| match picture {
        Picture::EmissionTime => seen.first.emission.t * plan.seconds_per_metre,
        _ => seen.first.doppler.factor(),
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
        "doppler" => number(0.0, &|seen| seen.first.doppler.factor()),
        "emission_time" => number(0.0, &|seen| seen.first.emission.t * plan.seconds_per_metre),
        "distance" => number(0.0, &|seen| seen.distance),
        "normal.X" => number(0.0, &|seen| seen.normal.x),
        "normal.Y" => number(0.0, &|seen| seen.normal.y),
        "normal.Z" => number(0.0, &|seen| seen.normal.z),
        "albedo.R" => number(0.0, &|seen| seen.albedo.x),
        "albedo.G" => number(0.0, &|seen| seen.albedo.y),
        "albedo.B" => number(0.0, &|seen| seen.albedo.z),
        "body" => number(-1.0, &|seen| f64::from(seen.first.body)),
        "material" => number(-1.0, &|seen| f64::from(seen.first.surface)),
        _ => {
            let number =
                print.bands.as_ref().and_then(|bands| bands.nm.iter().position(|nm| band(*nm) == name));
            number.zip(print.bands.as_ref()).map_or_else(Vec::new, |(i, bands)| bands.radiance[i].clone())
        }
    }
}
