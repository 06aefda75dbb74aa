//! Surroundings of a scene, from the manifest's words.

use super::materials::Workshop;
use super::{Sky, light};
use crate::error::{Place, Report};
use crate::manifest::{self, StarOrigin};
use crate::spacetime::Boost;
use crate::surroundings::{Kinds, Panorama, Part, Star, Stars, Surroundings, parse_catalogue, seeded};

/// The magnitude of the brightest star from a seed: that of Sirius.
const BRIGHTEST: f64 = -1.46;

pub(super) fn sky(written: &manifest::Surroundings, workshop: &mut Workshop, report: &mut Report) -> Sky {
    let mut parts = Vec::new();
    if let Some(glow) = &written.uniform {
        parts.extend(light::radiance(glow, report).map(Part::Uniform));
    }
    if let Some(picture) = &written.picture {
        let panorama = workshop.picture(&picture.file, report);
        parts.extend(panorama.map(|p| Part::Panorama(Panorama::new(p, picture.luminance, written.rotation))));
    }
    if let Some(stars) = &written.stars {
        let turned = |star: Star| Star {
            direction: written.rotation * star.direction,
            illuminance: star.illuminance * stars.brightness,
            ..star
        };
        let points = Stars::new(origin(&stars.origin, report).into_iter().map(turned));
        parts.push(Part::Stars(match stars.radius {
            Some(radius) => points.as_discs(radius, stars.brightness),
            None => points,
        }));
    }
    Sky { rest_from_lab: Boost::to_moving(written.velocity), sky: Surroundings { parts } }
}

fn origin(origin: &StarOrigin, report: &mut Report) -> Vec<Star> {
    match origin {
        StarOrigin::Seeded { seed, count, faintest, temperature, magnitude } => {
            let kinds = Kinds::Natural { brightest: BRIGHTEST.min(*faintest), faintest: *faintest };
            let alike = |star: Star| match (temperature, magnitude) {
                (None, None) => star,
                (kelvin, magnitude) => {
                    let kelvin = kelvin.unwrap_or(star.kelvin);
                    let own = Star::of_magnitude(star.direction, kelvin, magnitude.unwrap_or_default());
                    let illuminance = if magnitude.is_some() { own.illuminance } else { star.illuminance };
                    Star { illuminance, ..own }
                }
            };
            seeded(u64::from(*seed), *count as usize, kinds).map(alike).collect()
        }
        StarOrigin::Catalogue(file) => match manifest::read_text(&file.value) {
            Ok(text) => {
                report.inputs.add(&file.value, text.as_bytes());
                parse_catalogue(&file.value, &text.into(), report).unwrap_or_default()
            }
            Err(why) => {
                report.inputs.depend(&file.value);
                let place: Place = file.place.clone();
                report.fault(place, format!("the catalogue `{}`: {why}", file.value.display()), "");
                Vec::new()
            }
        },
    }
}
