//! What is infinitely far away, as data.

use glam::{DQuat, DVec3};
use std::sync::Arc;
use terrell::scene::Sky;
use terrell::spacetime::{Boost, Velocity};
use terrell::spectrum::Source;
use terrell::surroundings::{Panorama, Part, Star, Stars, Surroundings};
use terrell::texture::Picture;

/// Surroundings that can be boosted.
#[derive(Clone)]
pub(crate) struct Heaven {
    pub(crate) velocity: Velocity,
    pub(crate) uniform: Option<Source>,
    /// With its luminance and its turn.
    pub(crate) picture: Option<(Arc<Picture>, f64, DQuat)>,
    pub(crate) stars: Vec<Star>,
}

impl Heaven {
    fn dark() -> Self {
        Self { velocity: Velocity::REST, uniform: None, picture: None, stars: Vec::new() }
    }

    /// The same from all sides.
    pub(crate) fn uniform(radiance: Source) -> Self {
        Self { uniform: Some(radiance), ..Self::dark() }
    }

    /// A picture all around.
    pub(crate) fn picture(picture: Arc<Picture>, luminance: f64) -> Self {
        Self { picture: Some((picture, luminance, DQuat::IDENTITY)), ..Self::dark() }
    }

    /// Points.
    pub(crate) fn stars(stars: impl IntoIterator<Item = Star>) -> Self {
        Self { stars: stars.into_iter().collect(), ..Self::dark() }
    }

    /// It moves.
    pub(crate) fn moving(self, velocity: Velocity) -> Self {
        Self { velocity, ..self }
    }

    /// Turned in its rest frame.
    pub(crate) fn turned(mut self, turn: DQuat) -> Self {
        self.stars.iter_mut().for_each(|star| star.direction = turn * star.direction);
        self.picture = self.picture.map(|(picture, luminance, before)| (picture, luminance, turn * before));
        self
    }

    /// As the scene takes it.
    pub(crate) fn sky(&self) -> Sky {
        let mut parts: Vec<Part> = self.uniform.iter().cloned().map(Part::Uniform).collect();
        parts.extend(self.picture.iter().map(|(picture, luminance, turn)| {
            Part::Panorama(Panorama::new(picture.clone(), *luminance, *turn))
        }));
        if !self.stars.is_empty() {
            parts.push(Part::Stars(Stars::new(self.stars.iter().copied())));
        }
        Sky { rest_from_lab: Boost::to_moving(self.velocity), sky: Surroundings { parts } }
    }

    /// The direction of a star that stands in the direction `d` of its own rest frame, as seen from the lab.
    pub(crate) fn seen_from_lab(&self, d: DVec3) -> DVec3 {
        -super::along(-self.velocity, -d)
    }
}
