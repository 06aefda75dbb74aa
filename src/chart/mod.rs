//! Speed against accuracy: one exposure under many settings, against a converged reference.

mod draw;
mod ladder;

pub use draw::{csv, svg};
pub use ladder::{Method, Setting, ladder, reference};

use crate::color::{Lab, ciede2000};
use crate::exposure::{Uncertainty, expose_converged, expose_lit, expose_settled};
use crate::film::{Development, Negative};
use crate::scene::Scene;
use crate::trace::Lit;
use glam::DVec3;
use std::time::Instant;

/// A difference in CIEDE2000 that is just noticeable.
pub const JUST_NOTICEABLE: f64 = 1.0;

/// How far a picture is from another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Root of the mean squared difference of XYZ, in parts of that of the reference.
    pub rmse: f64,
    /// CIEDE2000 of the pixels as they are shown.
    pub shown: Uncertainty,
}

impl Deviation {
    /// Of a picture from a reference of the same size, both as `development` shows them.
    pub fn between(picture: &Negative, reference: &Negative, development: &Development) -> Self {
        let pairs = || picture.xyz.iter().zip(&reference.xyz);
        let wide = |xyz: &[f32; 3]| DVec3::from(xyz.map(f64::from));
        let (off, all) = pairs().fold((0.0, 0.0), |(off, all), (one, two)| {
            (off + (wide(one) - wide(two)).length_squared(), all + wide(two).length_squared())
        });
        let lab = |xyz: &[f32; 3]| Lab::of_rgb(development.display(wide(xyz)));
        let shown = pairs().map(|(one, two)| ciede2000(lab(one), lab(two))).collect();
        let rmse = if off > 0.0 { (off / all).sqrt() } else { 0.0 };
        Self { rmse, shown: Uncertainty::of(shown) }
    }
}

/// A setting with what it costs and gives.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The setting.
    pub setting: Setting,
    /// The median of all runs.
    pub seconds: f64,
    /// From the reference.
    pub deviation: Deviation,
    /// What the setting itself says of its error, if it says something.
    pub estimate: Option<Uncertainty>,
    /// Samples for each pixel, in the mean.
    pub samples: f64,
}

/// One exposure of a scene, to be measured.
#[derive(Debug)]
pub struct Subject<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// The observer's proper time, metres.
    pub tau: f64,
    /// How it is shown.
    pub development: Development,
}

impl Subject<'_> {
    /// The picture under a setting, with its own estimate of its error and its samples per pixel.
    pub fn expose(&self, setting: &Setting) -> (Negative, Option<Uncertainty>, f64) {
        let sampling = &setting.sampling;
        let view = self.scene.observer.view(self.tau, sampling.width, sampling.height);
        let planned = self.scene.lit();
        let lit = Lit {
            depth: setting.depth,
            footprints: setting.footprints,
            see_through: planned.see_through || setting.method == Method::Everything,
            ..planned
        };
        if let Method::Tolerance(tolerance) = setting.method {
            let settled = expose_settled(&lit, &view, sampling, &self.development, tolerance);
            return (settled.negative, Some(settled.error), settled.samples);
        }
        let expose = if setting.method == Method::Converged { expose_converged } else { expose_lit };
        (expose(&lit, &view, sampling), None, f64::from(sampling.samples))
    }

    /// Measures all settings against the reference, `runs` times each. They take turns, so that what else the machine does
    /// favours none. `tell` is called with the part that is done.
    pub fn measure(
        &self,
        settings: Vec<Setting>,
        reference: &Negative,
        runs: usize,
        mut tell: impl FnMut(f64),
    ) -> Vec<Measured> {
        let mut seconds = vec![Vec::new(); settings.len()];
        let mut last = Vec::new();
        for run in 0..runs {
            last.clear();
            for (number, setting) in settings.iter().enumerate() {
                let start = Instant::now();
                let exposed = self.expose(setting);
                seconds[number].push(start.elapsed().as_secs_f64());
                last.push(exposed);
                tell((run * settings.len() + number + 1) as f64 / (runs * settings.len()) as f64);
            }
        }
        let all = settings.into_iter().zip(seconds).zip(last);
        let measured = all.map(|((setting, seconds), (negative, estimate, samples))| Measured {
            setting,
            seconds: median(seconds),
            deviation: Deviation::between(&negative, reference, &self.development),
            estimate,
            samples,
        });
        measured.collect()
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        count if count % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

/// The Pareto front: the numbers of those that nothing else beats both in time and in error, from fast to slow.
pub fn front(measured: &[Measured], error: impl Fn(&Measured) -> f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..measured.len()).collect();
    order.sort_by(|a, b| {
        let key = |i: usize| (measured[i].seconds, error(&measured[i]));
        key(*a).0.total_cmp(&key(*b).0).then(key(*a).1.total_cmp(&key(*b).1))
    });
    let mut best = f64::INFINITY;
    order.retain(|number| {
        let error = error(&measured[*number]);
        let beats = error < best;
        best = best.min(error);
        beats
    });
    order
}

/// The cheapest setting of which 99 pixels in 100 differ from the reference by less than is just noticeable.
pub fn cheapest(measured: &[Measured]) -> Option<&Measured> {
    let fine = measured.iter().filter(|one| one.deviation.shown.p99 < JUST_NOTICEABLE);
    fine.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}
