//! Spectral lines as they arrive, before they become colours.

use super::{Cone, Gathered, Leg, Light, Lit, Path};
use crate::spacetime::SightRay;
use crate::spectrum::Line;
use glam::DVec3;

/// A line that arrives along a sight ray.
#[derive(Debug, Clone, Copy)]
pub struct SeenLine {
    /// Which of the scene's lines it is.
    pub of: *const Line,
    /// Where it is seen, nm.
    pub wavelength_nm: f64,
    /// How strong, W m⁻² sr⁻¹.
    pub power: f64,
}

impl Lit<'_> {
    /// The lines that arrive along a sight ray, but for those that come through dispersing glass.
    pub fn lines_along(&self, ray: &SightRay) -> Vec<SeenLine> {
        const SOMEWHERE_NM: f64 = 550.0;
        let mut light = Light { radiance: [0.0], lines: DVec3::ZERO };
        let mut gathered =
            Gathered { light: &mut light, caught: Some(Vec::new()), bands: None, exit: (0.0, ray.k) };
        let path = Path::new(self.depth, Cone::default());
        let leg = Leg::of(ray);
        if self.begins_in_vacuum(ray) {
            self.gather(&leg, &[SOMEWHERE_NM], &path, &mut gathered);
        } else {
            self.start_inside(&leg, &[SOMEWHERE_NM], &path, &mut gathered);
        }
        gathered.caught.unwrap_or_default().iter().map(super::split::Caught::seen).collect()
    }
}
