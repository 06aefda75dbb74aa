//! The film: exposures one after another, developed alike, to files.

mod folder;

use crate::color::RGB_FROM_XYZ;
use crate::error::Error;
use crate::exposure::{Sampling, Uncertainty, expose, expose_settled, first_hits};
use crate::film::{Brightness, Development, Negative};
use crate::observer::View;
use crate::output::{self, Layers, Movie, Picture8};
use crate::plan::{Exposure, Plan, White};
use crate::scene::Scene;
use crate::trace::First;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, sync_channel};

/// What has been done.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Another process renders into this folder, and is waited for.
    Waiting(PathBuf),
    /// The disk of this folder knows no locks: another process may write there.
    Unlocked(PathBuf),
    /// So many pictures are on the disk already.
    Kept(usize),
    /// The brightness of the film is known: this luminance (cd/m²) becomes white.
    Metered(f64),
    /// A picture is on the disk; how far it is settled, if that was asked for.
    Picture(PathBuf, Option<Settling>),
    /// The film is on the disk.
    Film(PathBuf),
}

/// How far a picture is settled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// Its estimated error.
    pub error: Uncertainty,
    /// Samples taken, for each pixel in the mean.
    pub samples: f64,
}

/// A developed picture on its way to the files.
struct Print {
    exposure: Exposure,
    negative: Negative,
    settling: Option<Settling>,
    firsts: Option<Vec<Option<First>>>,
    rgb: Vec<u8>,
}

/// What the writer gets.
enum Sheet {
    // The picture of this exposure is there already.
    Kept(usize),
    New(Box<Print>),
}

/// Renders the exposures of the plan whose indices are within `chosen` and calls `tell` after each step. Pictures of the
/// same film that are there are kept. The film is made when all are.
pub fn render(
    scene: &Scene,
    plan: &Plan,
    chosen: std::ops::Range<usize>,
    tell: impl FnMut(Step) + Send,
) -> Result<(), Error> {
    let mut tell = tell;
    let folder = folder::open(plan, &chosen, &mut tell)?;
    if !folder.kept.is_empty() {
        tell(Step::Kept(folder.kept.len()));
    }
    let exposures = plan.exposures.get(chosen).unwrap_or(&[]);
    let development = development(scene, plan);
    tell(Step::Metered(development.white));
    let movie = film_path(plan, exposures.len()).map(|path| start(plan, &path)).transpose()?;

    // Files are written and the film encoded beside the tracing of the next picture.
    std::thread::scope(|scope| {
        let (prints, inbox) = sync_channel(1);
        let writer = scope.spawn(move || file_all(plan, movie, &inbox, tell));
        let mut last = None;
        for exposure in exposures {
            if folder.kept.contains(&exposure.index) {
                if prints.send(Sheet::Kept(exposure.index)).is_err() {
                    break;
                }
                continue;
            }
            let exposed: (Negative, Option<Settling>) = last
                .take()
                .filter(|_| plan.still)
                .unwrap_or_else(|| exposed(scene, plan, exposure, &development));
            if plan.still {
                last = Some(exposed.clone());
            }
            let print = print(scene, plan, exposure, &development, exposed);
            if prints.send(Sheet::New(Box::new(print))).is_err() {
                break; // The writer has stopped and says why.
            }
        }
        drop(prints);
        writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Where the film goes, if there is to be one: only a whole film is made.
pub fn film_path(plan: &Plan, exposures: usize) -> Option<PathBuf> {
    let whole = exposures == plan.exposures.len() && exposures > 1;
    (whole && plan.film_rate.is_some()).then(|| plan.folder.join(&plan.film_file))
}

fn start(plan: &Plan, path: &std::path::Path) -> Result<Movie, Error> {
    Movie::create(path, plan.sampling.width, plan.sampling.height, plan.film_rate.unwrap_or(24.0))
}

fn view(scene: &Scene, plan: &Plan, exposure: &Exposure) -> View {
    scene.observer.view(exposure.tau, plan.sampling.width, plan.sampling.height)
}

fn exposed(
    scene: &Scene,
    plan: &Plan,
    exposure: &Exposure,
    development: &Development,
) -> (Negative, Option<Settling>) {
    // Of a still film always the first, so that a part of it has the same bytes.
    let exposure = if plan.still { &plan.exposures[0] } else { exposure };
    let view = view(scene, plan, exposure);
    let Some(tolerance) = plan.tolerance else { return (expose(scene, &view, &plan.sampling), None) };
    let settled = expose_settled(&scene.lit(), &view, &plan.sampling, development, tolerance);
    (settled.negative, Some(Settling { error: settled.error, samples: settled.samples }))
}

fn print(
    scene: &Scene,
    plan: &Plan,
    exposure: &Exposure,
    development: &Development,
    (negative, settling): (Negative, Option<Settling>),
) -> Print {
    let view = view(scene, plan, exposure);
    let firsts = plan.exr.then(|| first_hits(scene, &view, negative.width, negative.height));
    Print { exposure: *exposure, rgb: development.develop(&negative), negative, settling, firsts }
}

fn file_all(
    plan: &Plan,
    mut movie: Option<Movie>,
    inbox: &Receiver<Sheet>,
    mut tell: impl FnMut(Step),
) -> Result<(), Error> {
    let size = (plan.sampling.width, plan.sampling.height);
    for sheet in inbox {
        let print = match sheet {
            Sheet::New(print) => print,
            Sheet::Kept(index) => {
                if let Some(movie) = &mut movie {
                    movie.push(&output::read_png(&folder::picture(plan, index), size)?)?;
                }
                continue;
            }
        };
        let path = folder::picture(plan, print.exposure.index);
        let text = labels(plan, print.exposure.index);
        if let Some(firsts) = &print.firsts {
            write_exr(plan, &path.with_extension("exr"), &print, (firsts, &text))?;
        }
        let Negative { width, height, .. } = print.negative;
        output::write_png(&path, &Picture8 { width, height, rgb: &print.rgb, text: &text })?;
        if let Some(movie) = &mut movie {
            movie.push(&print.rgb)?;
        }
        tell(Step::Picture(path, print.settling));
    }
    if let Some(movie) = movie {
        movie.finish()?;
        tell(Step::Film(plan.folder.join(&plan.film_file)));
    }
    Ok(())
}

/// What is written into a picture.
fn labels(plan: &Plan, index: usize) -> Vec<(&'static str, String)> {
    let fingerprint = plan.fingerprint().map(|fingerprint| (folder::FINGERPRINT, fingerprint.to_string()));
    let exposure = (folder::EXPOSURE, index.to_string());
    plan.text.iter().cloned().chain([exposure]).chain(fingerprint).collect()
}

fn write_exr(
    plan: &Plan,
    path: &std::path::Path,
    print: &Print,
    (firsts, text): (&[Option<First>], &[(&str, String)]),
) -> Result<(), Error> {
    let rgb = |xyz: &[f32; 3]| (*RGB_FROM_XYZ * DVec3::from(xyz.map(f64::from))).as_vec3().to_array();
    let number =
        |of: &dyn Fn(&First) -> f64| firsts.iter().map(|f| f.as_ref().map_or(0.0, of) as f32).collect();
    let doppler: Vec<f32> = number(&|first| first.doppler.factor());
    let emission_time: Vec<f32> = number(&|first| first.emission.t * plan.seconds_per_metre);
    let layers = Layers {
        width: print.negative.width as usize,
        height: print.negative.height as usize,
        rgb: &print.negative.xyz.iter().map(rgb).collect::<Vec<_>>(),
        white_luminance: 1.0,
        xyz: &print.negative.xyz,
        doppler: &doppler,
        emission_time: &emission_time,
        body: &firsts.iter().map(|f| f.as_ref().map_or(-1, |first| first.body as i32)).collect::<Vec<_>>(),
        text,
    };
    output::write_exr(path, &layers)
}

/// Columns of the small pictures by which a film is metered, and how many there are at most.
const METER_COLUMNS: u32 = 64;
const METER_PICTURES: usize = 48;

/// How every picture of the film is developed, whichever of them are rendered.
pub fn development(scene: &Scene, plan: &Plan) -> Development {
    if let (White::Fixed(white), Some(headroom)) = (plan.white, plan.headroom) {
        return Development::new(white, headroom);
    }
    let brightness = brightness(scene, plan).unwrap_or(Brightness { white: 1.0, brightest: 1.0 });
    let white = match plan.white {
        White::Fixed(white) => white,
        White::Auto { gain } => brightness.white / gain,
    };
    let measured = libm::log2(brightness.brightest / white).clamp(LEAST_HEADROOM, MOST_HEADROOM);
    Development::new(white, plan.headroom.unwrap_or(measured))
}

/// Headroom where the film says it: at least so much that highlights end softly, at most what a searchlight at γ = 50 needs.
const LEAST_HEADROOM: f64 = 1.0;
const MOST_HEADROOM: f64 = 24.0;

fn brightness(scene: &Scene, plan: &Plan) -> Option<Brightness> {
    let small = Sampling { samples: 1, ..plan.sampling.within(METER_COLUMNS) };
    let every = plan.exposures.len().div_ceil(METER_PICTURES).max(1);
    Brightness::of(plan.exposures.iter().step_by(every).flat_map(|exposure| {
        let view = scene.observer.view(exposure.tau, small.width, small.height);
        expose(scene, &view, &small).xyz
    }))
}
