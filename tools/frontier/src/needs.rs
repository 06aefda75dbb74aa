//! What each part of the plan saves: pictures of scenes that need nothing, beside the same pictures of scenes in which something that
//! nobody sees needs it.

#[allow(dead_code, unused_imports, reason = "the tests compare the pictures, here they are only timed")]
#[path = "../../../tests/support/needless.rs"]
mod needless;

use crate::clock::timed;
use needless::Needless;
use std::fmt::Write;
use std::path::Path;
use terrell::error::Report;
use terrell::manifest;
use terrell::plan::Plan;
use terrell::render::render;
use terrell::scene::{Scene, compose};

/// How often each film is made; the median counts.
const RUNS: usize = 11;
/// Size of the pictures.
const SIZE: (u32, u32) = (640, 360);

struct Film {
    scene: Scene,
    plan: Plan,
}

fn film(folder: &Path, out: &Path, text: &str) -> Film {
    let path = folder.join("../../manifests/needs.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, text, &mut report);
    let made = manifest.as_ref().and_then(|manifest| {
        let scene = compose(manifest, &path, &mut report)?;
        let plan = Plan::of(manifest, &scene, &path, &mut report);
        Some(Film { scene, plan: Plan { folder: out.to_owned(), restart: true, ..plan } })
    });
    made.filter(|_| report.faults.is_empty()).unwrap_or_else(|| panic!("{:?}\n{text}", report.faults))
}

impl Film {
    fn seconds(&self) -> Result<f64, terrell::error::Error> {
        let (done, seconds) = timed(|| render(&self.scene, &self.plan, 0..self.plan.exposures.len(), |_| {}));
        done.map(|()| seconds)
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Measures, and writes `needs.csv`.
pub(crate) fn run(folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::temp_dir().join(format!("terrell-needs-{}", std::process::id()));
    let mut table = "part,what nobody sees,pictures,planned s,with it s,ratio\n".to_owned();
    for Needless { part, what, plain, with, .. } in needless::all(SIZE) {
        let films = [plain, with].map(|text| film(folder, &out, &text));
        let pictures = films[0].plan.exposures.len();
        let mut seconds = [Vec::new(), Vec::new()];
        for run in 0..=RUNS {
            for (film, seconds) in films.iter().zip(&mut seconds) {
                let spent = film.seconds()?;
                if run > 0 {
                    seconds.push(spent);
                }
            }
        }
        let ratios = seconds[0].iter().zip(&seconds[1]).map(|(planned, with)| with / planned).collect();
        let [planned, with] = seconds.map(median);
        let line = format!("{part},{what},{pictures},{planned:.4},{with:.4},{:.3}", median(ratios));
        println!("{line}");
        writeln!(table, "{line}")?;
    }
    std::fs::remove_dir_all(&out)?;
    std::fs::write(folder.join("needs.csv"), table)?;
    Ok(())
}
