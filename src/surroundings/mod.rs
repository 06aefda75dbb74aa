//! Light from infinity: a sky, a panorama, stars.
//!
//! All of it is said in the rest frame of the surroundings. What a moving observer sees of it follows from the
//! direction of its ray there, from the wavelengths there, and from how wide its cone of sight is there.

mod bands;
mod catalogue;
mod panorama;
mod seeded;
mod stars;

pub use catalogue::parse_catalogue;
pub use panorama::Panorama;
pub use seeded::{Kinds, seeded};
pub(crate) use seeded::{draws, on_sphere};
pub use stars::{COOLEST_K, HOTTEST_K, MAGNITUDE_ZERO_LX, MOST_STARS, Star, Stars};

use crate::spectrum::{Line, Source};
use glam::DVec3;

/// All that shines from infinity; nothing is black.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    /// What shines, one in front of the other without hiding it.
    pub parts: Vec<Part>,
}

/// One kind of light from infinity.
#[derive(Debug, Clone)]
pub enum Part {
    /// The same radiance from all directions.
    Uniform(Source),
    /// A picture all around.
    Panorama(Panorama),
    /// Points, or small discs.
    Stars(Stars),
}

impl Surroundings {
    /// The spectral radiance (W m⁻² sr⁻¹ nm⁻¹) that comes from the direction `d`, without spectral lines.
    ///
    /// `d` is the unit vector towards the sky, `cone` half the angles (radians) between samples and between pixels and `nm` the
    /// wavelengths, all in the rest frame of the surroundings.
    pub fn radiance<const N: usize>(&self, d: DVec3, (sample, pixel): (f64, f64), nm: &[f64; N]) -> [f64; N] {
        let mut sum = [0.0; N];
        for part in &self.parts {
            let radiance = match part {
                Part::Uniform(source) => source.at_each(nm),
                Part::Panorama(panorama) => panorama.radiance(d, sample, nm),
                Part::Stars(stars) => stars.radiance(d, pixel, nm),
            };
            for (sum, radiance) in sum.iter_mut().zip(radiance) {
                *sum += radiance;
            }
        }
        sum
    }

    /// The spectral lines, radiance integrated over the line; the same from all directions.
    pub fn lines(&self) -> impl Iterator<Item = &Line> + '_ {
        let uniform = self.parts.iter().filter_map(|part| match part {
            Part::Uniform(source) => Some(source),
            Part::Panorama(_) | Part::Stars(_) => None,
        });
        uniform.flat_map(Source::lines)
    }
}
