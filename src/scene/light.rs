//! Lamps and spectra of a scene, from the manifest's and the model files' words.

use super::Placement;
use super::compose::placement;
use super::materials;
use crate::course::Course;
use crate::error::{Place, Report};
use crate::import;
use crate::lamp::{Beam, Lamp};
use crate::manifest::{self, Amount, LightSource, Strength};
use crate::spectrum::{Illuminant, Reflectance, Source, Spectrum, Table};
use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;

/// A lamp of the manifest; none if its spectrum cannot have the strength that is asked for.
pub(super) fn from_manifest(light: &manifest::Light, report: &mut Report) -> Option<Lamp> {
    let rotation = light.placement.rotation;
    let point = DVec3::ZERO;
    let (beam, spectrum, amount, divide) = match &light.source {
        LightSource::Lamp(lamp) => (Beam::Point { place: point }, &lamp.spectrum, lamp.intensity, 2.0 * TAU),
        LightSource::Spot(spot) => {
            let (cos_inner, cos_outer) = (libm::cos(0.5 * spot.inner), libm::cos(0.5 * spot.cone));
            let beam = Beam::Spot { place: point, axis: rotation * spot.direction, cos_inner, cos_outer };
            // The square of a linear fall has a third of its width's weight.
            let solid_angle = TAU * ((1.0 - cos_inner) + (cos_inner - cos_outer) / 3.0);
            (beam, &spot.lamp.spectrum, spot.lamp.intensity, solid_angle)
        }
        LightSource::Sun(sun) => {
            let beam = Beam::Sun { axis: rotation * sun.direction };
            (beam, &sun.spectrum, Strength::Intensity(sun.illuminance), 1.0)
        }
    };
    let amount = match amount {
        Strength::Intensity(amount) => amount,
        Strength::Total(Amount::Photometric(value)) => Amount::Photometric(value / divide),
        Strength::Total(Amount::Radiometric(value)) => Amount::Radiometric(value / divide),
    };
    let light_of =
        |spectrum: &manifest::Spectrum, report: &mut Report| source(spectrum, amount, &light.place, report);
    let light_parts = match &light.course {
        manifest::Course::Steady => vec![(Course::Steady, light_of(spectrum, report)?)],
        manifest::Course::Blinking(blinking) => {
            vec![(materials::blink(blinking, false), light_of(spectrum, report)?)]
        }
        manifest::Course::Keys(keys) => {
            let mut parts = Vec::new();
            let mut current: &manifest::Spectrum = spectrum;
            let times: Vec<f64> = keys.iter().map(|key| key.at).collect();
            for (i, key) in keys.iter().enumerate() {
                current = key.spectrum.as_deref().unwrap_or(current);
                let course = materials::share_of_key(&times, i).times(key.brightness);
                parts.push((course, light_of(current, report)?));
            }
            parts
        }
    };
    Some(Lamp { rest_from_lab: placement(&light.placement).rest_from_lab(), beam, light: light_parts })
}

/// A lamp of a model file, at rest with the body that it came with.
pub(super) fn from_file(light: &import::Light, body: Placement, rest_from_asset: DAffine3) -> Lamp {
    let rest_from_light = rest_from_asset * light.asset_from_light;
    let place = rest_from_light.translation;
    let axis = rest_from_light.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
    let beam = match light.kind {
        import::LightKind::Point => Beam::Point { place },
        import::LightKind::Spot { inner, outer } => {
            Beam::Spot { place, axis, cos_inner: libm::cos(inner), cos_outer: libm::cos(outer) }
        }
        import::LightKind::Sun => Beam::Sun { axis },
    };
    // A white of intensity I has I cd; a colour is that white through a filter.
    let white = Source::new(&Spectrum::DAYLIGHT, 1.0).xyz().y;
    let source = Source::new(&Spectrum::Rgb(light.color.map(f64::from)), light.intensity / white);
    Lamp { rest_from_lab: body.rest_from_lab(), beam, light: vec![(Course::Steady, source)] }
}

/// A spectral radiance of the manifest.
pub(super) fn radiance(glow: &manifest::Glow, report: &mut Report) -> Option<Source> {
    source(&glow.spectrum, glow.brightness, &glow.place, report)
}

fn source(
    written: &manifest::Spectrum,
    amount: Amount,
    place: &Place,
    report: &mut Report,
) -> Option<Source> {
    let spectrum = spectrum(written);
    let (source, what, hint) = match amount {
        Amount::Photometric(value) => (
            Source::with_luminous(&spectrum, value),
            "no eye sees this spectrum, so its strength cannot be in cd, lx, lm or cd/m2",
            "give it in W/sr, W/m2, W or W/m2/sr",
        ),
        Amount::Radiometric(value) => (
            Source::with_total(&spectrum, value),
            "this spectrum goes on for ever, so its strength cannot be in watts",
            "give it in cd, lx, lm or cd/m2, or use a table",
        ),
    };
    if source.is_none() && spectrum.total() == Some(0.0) {
        report.fault(
            place.clone(),
            "this spectrum is dark at all wavelengths",
            "give it a value above zero somewhere",
        );
    } else if source.is_none() {
        report.fault(place.clone(), what, hint);
    }
    source
}

fn spectrum(written: &manifest::Spectrum) -> Spectrum {
    match written {
        manifest::Spectrum::BlackBody(kelvin) => Spectrum::BlackBody(*kelvin),
        manifest::Spectrum::Line(line) => {
            Spectrum::Line { centre_nm: line.centre_nm, width_nm: line.width_nm.unwrap_or(0.0) }
        }
        manifest::Spectrum::Table(rows) => {
            Table::new(rows.iter().copied()).map_or(Spectrum::Constant(0.0), Spectrum::Table)
        }
        manifest::Spectrum::Constant(value) => Spectrum::Constant(*value),
        manifest::Spectrum::Rgb(rgb) => Spectrum::Rgb(*rgb),
        manifest::Spectrum::Illuminant(manifest::Illuminant::D65) => Spectrum::Illuminant(Illuminant::D65),
        manifest::Spectrum::Illuminant(manifest::Illuminant::A) => Spectrum::Illuminant(Illuminant::A),
        manifest::Spectrum::Illuminant(manifest::Illuminant::E) => Spectrum::Illuminant(Illuminant::E),
        manifest::Spectrum::Sum(parts) => Spectrum::Sum(parts.iter().map(|part| spectrum(part)).collect()),
        manifest::Spectrum::Scaled { factor, of } => Spectrum::Scaled(*factor, Box::new(spectrum(of))),
    }
}

/// A reflectance of the manifest, or why it is none.
pub(super) fn reflectance(written: &manifest::Spectrum) -> Result<Reflectance, &'static str> {
    match written {
        manifest::Spectrum::Constant(value) => Ok(Reflectance::Constant(*value)),
        manifest::Spectrum::Rgb(rgb) => Ok(Reflectance::Rgb(*rgb)),
        manifest::Spectrum::Table(rows) => {
            Table::new(rows.iter().copied()).map(Reflectance::Table).ok_or("this table is no spectrum")
        }
        manifest::Spectrum::Scaled { factor, of } => match reflectance(of)? {
            Reflectance::Constant(value) => Ok(Reflectance::Constant(value * factor)),
            Reflectance::Rgb(rgb) | Reflectance::Extended { rgb, .. } => {
                Ok(Reflectance::Rgb(rgb.map(|channel| channel * factor)))
            }
            Reflectance::Table(table) => Ok(Reflectance::Table(table.scaled(*factor))),
        },
        _ => Err("a reflectance cannot be made from this kind of spectrum"),
    }
}
