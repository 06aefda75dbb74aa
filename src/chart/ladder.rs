//! The settings that are tried.

use crate::exposure::Sampling;
use crate::plan::Plan;
use crate::scene::Scene;

/// How a picture is made under a setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// As the plan has it, every pixel alike.
    Planned,
    /// The same, with all that the plan leaves out.
    Everything,
    /// Each pixel until it is within this of the converged one, CIEDE2000.
    Tolerance(f64),
    /// As what others are compared with.
    Converged,
}

/// A setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// What is changed, step by step; the same word for all steps.
    pub series: &'static str,
    /// The step.
    pub label: String,
    /// Size, samples, filter, wavelengths.
    pub sampling: Sampling,
    /// How deep mirrors are followed.
    pub depth: u32,
    /// Whether textures are filtered.
    pub footprints: bool,
    /// How.
    pub method: Method,
    /// Whether it is what the manifest asks for.
    pub default: bool,
}

/// Wavelengths of the reference.
const REFERENCE_WAVELENGTHS: u32 = 64;
/// The tolerances that are tried.
const TOLERANCES: [f64; 3] = [4.0, 2.0, 1.0];

/// The setting of the reference.
pub fn reference(scene: &Scene, plan: &Plan, samples: u32) -> Setting {
    Setting {
        series: "reference",
        label: format!("{samples} samples, {REFERENCE_WAVELENGTHS} wavelengths"),
        method: Method::Converged,
        sampling: Sampling { samples, wavelengths: REFERENCE_WAVELENGTHS, ..plan.sampling },
        ..default(scene, plan)
    }
}

fn default(scene: &Scene, plan: &Plan) -> Setting {
    let lit = scene.lit();
    let Sampling { samples, wavelengths, .. } = plan.sampling;
    let (method, label) = match plan.tolerance {
        Some(tolerance) => (Method::Tolerance(tolerance), format!("tolerance {tolerance}")),
        None => (Method::Planned, format!("{samples} samples, {wavelengths} wavelengths")),
    };
    Setting {
        series: "as the manifest has it",
        label,
        sampling: plan.sampling,
        depth: lit.depth,
        footprints: lit.footprints,
        method,
        default: true,
    }
}

/// All settings: what the manifest asks for, and one thing changed at a time.
pub fn ladder(scene: &Scene, plan: &Plan) -> Vec<Setting> {
    let default = default(scene, plan);
    let planned = plan.sampling;
    let other = |series: &'static str, label: String| Setting {
        series,
        label,
        default: false,
        method: Method::Planned,
        ..default.clone()
    };
    let mut all = vec![default.clone()];
    let asked = |what: bool| what && default.method == Method::Planned;
    for samples in [1, 2, 4, 8, 16, 32, 64].into_iter().filter(|n| !asked(*n == planned.samples)) {
        let sampling = Sampling { samples, ..planned };
        all.push(Setting { sampling, ..other("samples", format!("{samples}")) });
    }
    for wavelengths in [3, 8, 16, 32, 64].into_iter().filter(|count| *count != planned.wavelengths) {
        let sampling = Sampling { wavelengths, ..planned };
        all.push(Setting { sampling, ..other("wavelengths", format!("{wavelengths}")) });
    }
    for depth in [0, 1, 2, 4, 8, 16].into_iter().filter(|depth| *depth < default.depth) {
        all.push(Setting { depth, ..other("depth", format!("{depth}")) });
    }
    if default.footprints {
        all.push(Setting { footprints: false, ..other("texture filter", "off".to_owned()) });
    }
    let everything = Setting {
        method: Method::Everything,
        sampling: Sampling { wavelengths: planned.wavelengths.max(16), ..planned },
        depth: scene.depth,
        footprints: true,
        ..other("everything on", String::new())
    };
    let left_out = everything.sampling != default.sampling
        || everything.depth != default.depth
        || everything.footprints != default.footprints
        || !scene.lit().see_through;
    if left_out {
        all.push(everything);
    }
    for tolerance in TOLERANCES.into_iter().filter(|of| default.method != Method::Tolerance(*of)) {
        all.push(Setting {
            method: Method::Tolerance(tolerance),
            ..other("tolerance", format!("{tolerance}"))
        });
    }
    all
}
