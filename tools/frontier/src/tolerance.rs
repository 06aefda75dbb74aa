//! A picture asked for by its error beside even samples that reach the same: what each costs.
//!
//! `frontier tolerance WIDTH MANIFEST...` writes a line for each tolerance: its error and processor time, and those of the cheapest
//! even setting that is as good for 99 pixels of 100, found between neighbouring settings by their logarithms.

use crate::clock::timed;
use std::error::Error;
use std::path::Path;
use terrell::chart::{Deviation, Method, Setting, Subject, ladder, reference};
use terrell::error::Report;
use terrell::exposure::Sampling;
use terrell::manifest;
use terrell::plan::Plan;
use terrell::render::development;
use terrell::scene::compose;

const RUNS: usize = 3;
const REFERENCE: u32 = 512;
const SAMPLES: [u32; 11] = [4, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192];

/// Error and processor time of an even setting.
struct Even {
    label: String,
    error: f64,
    seconds: f64,
}

/// The time of the cheapest even setting with such an error, and its name; none if no setting is as good.
fn cheapest(rows: &[Vec<Even>], error: f64) -> Option<(f64, String)> {
    let mut best: Option<(f64, String)> = None;
    for row in rows {
        for pair in row.windows(2) {
            let (one, two) = (&pair[0], &pair[1]);
            if two.error > error {
                continue;
            }
            let part = if one.error <= error {
                0.0
            } else {
                (one.error / error).ln() / (one.error / two.error).ln()
            };
            let seconds = one.seconds * (two.seconds / one.seconds).powf(part);
            if best.as_ref().is_none_or(|(least, _)| seconds < *least) {
                best = Some((seconds, format!("{} to {}", one.label, two.label)));
            }
            break;
        }
    }
    best
}

/// Measures each manifest.
pub(crate) fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let (width, manifests) = arguments.split_first().ok_or("tolerance WIDTH MANIFEST...")?;
    println!("manifest,tolerance,says,error,samples,seconds,even seconds,ratio,even");
    for path in manifests {
        one(Path::new(path), width.parse()?)?;
    }
    Ok(())
}

fn one(path: &Path, width: u32) -> Result<(), Box<dyn Error>> {
    let mut report = Report::default();
    let made = manifest::load(path, &mut report).and_then(|manifest| {
        let scene = compose(&manifest, path, &mut report)?;
        let plan = Plan::of(&manifest, &scene, path, &mut report);
        Some((scene, plan))
    });
    let Some((scene, mut plan)) = made else { return Err(format!("{:?}", report.faults).into()) };
    plan.sampling = plan.sampling.within(width);
    let development = development(&scene, &plan);
    let subject = Subject { scene: &scene, tau: plan.exposures[plan.exposures.len() / 2].tau, development };
    let (converged, ..) = subject.expose(&reference(&scene, &plan, REFERENCE));
    let settings = ladder(&scene, &plan);
    let least = |setting: &Setting| {
        let (exposed, mut seconds) = timed(|| subject.expose(setting));
        for _ in 1..RUNS {
            seconds = seconds.min(timed(|| subject.expose(setting)).1);
        }
        (exposed, seconds)
    };
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let (asked, mut smallest) =
        (settings.iter().filter(|one| matches!(one.method, Method::Tolerance(_))), f64::INFINITY);
    let mut settled = Vec::new();
    for setting in asked {
        let ((negative, says, samples), seconds) = least(setting);
        let error = Deviation::between(&negative, &converged, &development).shown.p99;
        smallest = smallest.min(error);
        settled.push((setting.label.clone(), says.unwrap_or_default().p99, error, samples, seconds));
    }
    let mut rows = Vec::new();
    let rules = if plan.sampling.wavelengths == 3 { vec![3] } else { vec![8, 16, 32] };
    for wavelengths in rules {
        let mut row: Vec<Even> = Vec::new();
        for samples in SAMPLES {
            // What is already better than all that was asked for need not be made better still.
            if row.last().is_some_and(|last| last.error < smallest) {
                break;
            }
            let sampling = Sampling { samples, wavelengths, ..plan.sampling };
            let setting = Setting { method: Method::Planned, sampling, ..settings[0].clone() };
            let ((negative, ..), seconds) = least(&setting);
            let error = Deviation::between(&negative, &converged, &development).shown.p99;
            row.push(Even { label: format!("{samples} x {wavelengths}"), error, seconds });
        }
        rows.push(row);
    }
    for (tolerance, says, error, samples, seconds) in settled {
        let even = cheapest(&rows, error)
            .map_or(",,none".to_owned(), |(even, label)| format!("{even:.3},{:.3},{label}", seconds / even));
        println!("{name},{tolerance},{says:.3},{error:.3},{samples:.1},{seconds:.3},{even}");
    }
    Ok(())
}
