//! How far a picture is from another: relative RMSE of linear XYZ, and CIEDE2000 of the developed pictures.

use glam::DVec3;
use terrell::color::{Lab, ciede2000};
use terrell::film::{Brightness, Development};

/// The differences of a picture from the reference.
#[derive(Debug, Clone, Copy, Default)]
pub struct Errors {
    /// √(Σ|Δ|²/Σ|XYZ|²)
    pub rmse: f64,
    pub mean: f64,
    pub p99: f64,
}

/// Judges pictures by a reference.
pub struct Judge {
    reference: Vec<DVec3>,
    development: Development,
    lab: Vec<Lab>,
}

impl Judge {
    pub fn new(reference: Vec<DVec3>) -> Self {
        let brightness = Brightness::of(reference.iter().map(|xyz| xyz.as_vec3().to_array()))
            .unwrap_or(Brightness { white: 1.0, brightest: 1.0 });
        let development = Development::new(brightness.white, brightness.headroom(brightness.white));
        let lab = reference.iter().map(|xyz| lab(development, *xyz)).collect();
        Self { reference, development, lab }
    }

    pub fn errors(&self, picture: &[DVec3]) -> Errors {
        let sum: f64 = self.reference.iter().map(|xyz| xyz.length_squared()).sum();
        let off: f64 = self.reference.iter().zip(picture).map(|(a, b)| (*a - *b).length_squared()).sum();
        let mut deltas: Vec<f64> =
            self.lab.iter().zip(picture).map(|(a, b)| ciede2000(*a, lab(self.development, *b))).collect();
        deltas.sort_unstable_by(f64::total_cmp);
        let mean = deltas.iter().sum::<f64>() / deltas.len() as f64;
        Errors { rmse: (off / sum).sqrt(), mean, p99: deltas[deltas.len() * 99 / 100] }
    }
}

fn lab(development: Development, xyz: DVec3) -> Lab {
    Lab::of_rgb(development.display(xyz))
}
