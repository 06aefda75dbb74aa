//! The film: exposures one after another, developed alike, to files.

mod about;
mod files;
mod folder;
mod layers;
mod scales;

use crate::error::Error;
use crate::exposure::{Bands, Sampling, Uncertainty, expose_settled_until, expose_spectral, expose_until};
use crate::film::{self, Brightness, Development, Negative};
use crate::observer::View;
use crate::output::{self, FilmKind, Making};
use crate::plan::{Exposure, Picture, Plan, White};
use crate::scene::Scene;
use crate::stereo::{self, Layout, Side, Stereo};
use crate::stop::Stop;
pub(crate) use layers::{asks_rays, channels};
use scales::Scales;
use std::path::{Path, PathBuf};
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

/// What has been measured.
#[derive(Clone)]
struct Exposed {
    negative: Negative,
    settling: Option<Settling>,
    // Its spectrum, where that is asked for.
    bands: Option<Bands>,
    // What either eye sees, where they share one picture.
    eyes: Option<Box<[Negative; 2]>>,
}

/// A developed picture on its way to the files.
struct Print {
    exposure: Exposure,
    negative: Negative,
    settling: Option<Settling>,
    bands: Option<Bands>,
    // What is seen of each pixel beside its light, where that is asked for.
    seen: Option<Vec<Option<layers::Seen>>>,
    rgb: Vec<u8>,
    // The same in 16 bits, where that is asked for.
    fine: Option<Vec<u16>>,
    // What is shown as white, cd/m².
    white: f64,
    text: Vec<(&'static str, String)>,
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
    render_until(scene, plan, chosen, &Stop::never(), tell)
}

/// The same; when it is stopped the pictures that are finished stay, and nothing else is left behind.
pub fn render_until(
    scene: &Scene,
    plan: &Plan,
    chosen: std::ops::Range<usize>,
    stop: &Stop,
    tell: impl FnMut(Step) + Send,
) -> Result<(), Error> {
    let mut tell = tell;
    // Both eyes' films are developed alike.
    let mut known = None;
    if !scene.observer.stereo.is_some_and(|eyes| eyes.layout == Layout::LeftRight) {
        return render_film(scene, plan, chosen, (&mut known, stop), tell);
    }
    Side::BOTH.into_iter().try_for_each(|side| {
        let plan = Plan { eye: Some(side), folder: plan.folder.join(side.name()), ..plan.clone() };
        render_film(scene, &plan, chosen.clone(), (&mut known, stop), &mut tell)
    })
}

fn render_film(
    scene: &Scene,
    plan: &Plan,
    chosen: std::ops::Range<usize>,
    (known, stop): (&mut Option<Development>, &Stop),
    mut tell: impl FnMut(Step) + Send,
) -> Result<(), Error> {
    let stopped = |done: usize, of: usize| stopped(plan, done, of);
    let folder = folder::open(plan, &chosen, stop, &mut tell)?.ok_or_else(|| stopped(0, chosen.len()))?;
    if !folder.kept.is_empty() {
        tell(Step::Kept(folder.kept.len()));
    }
    let exposures = plan.exposures.get(chosen).unwrap_or(&[]);
    let all = exposures.len();
    if known.is_none() {
        *known = development_until(scene, plan, stop);
    }
    let development = known.as_ref().ok_or_else(|| stopped(folder.kept.len(), all))?;
    tell(Step::Metered(development.white));
    let scales = scales::of(scene, plan);
    let comment = about::lines(&about::of_film(plan, development.white));
    let start = |path: PathBuf| Ok((start(plan, &path, &comment)?, path));
    let films = film_paths(plan, exposures.len()).into_iter().map(start).collect::<Result<_, Error>>()?;

    // Files are written and the film encoded beside the tracing of the next picture.
    std::thread::scope(|scope| {
        let (prints, inbox) = sync_channel(1);
        let writer = scope.spawn(move || file_all(plan, scales.as_ref(), films, (&inbox, stop), tell));
        let mut last = None;
        for exposure in exposures {
            if folder.kept.contains(&exposure.index) {
                if prints.send(Sheet::Kept(exposure.index)).is_err() {
                    break;
                }
                continue;
            }
            let exposed: Option<Exposed> =
                last.take().or_else(|| exposed(scene, plan, exposure, (development, stop)));
            let Some(exposed) = exposed else { break };
            if plan.still {
                last = Some(exposed.clone());
            }
            let print = print(scene, plan, exposure, development, exposed);
            if prints.send(Sheet::New(Box::new(print))).is_err() {
                break; // The writer has stopped and says why.
            }
        }
        drop(prints);
        let written = writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        if written { Ok(()) } else { Err(stopped(folder::count(plan, exposures), all)) }
    })
}

fn stopped(plan: &Plan, done: usize, of: usize) -> Error {
    let (are, folder) = (if of == 1 { "picture is" } else { "pictures are" }, plan.folder.display());
    let goes_on = if plan.restart { "without --restart the same command" } else { "the same command" };
    Error::Stopped { there: format!("{done} of {of} {are} in {folder}; {goes_on} goes on") }
}

/// Where the films go, if there are to be any: only of all exposures they are made.
pub fn film_paths(plan: &Plan, exposures: usize) -> Vec<PathBuf> {
    let whole = exposures == plan.exposures.len() && exposures > 1 && plan.film_rate.is_some();
    plan.film_files.iter().filter(|_| whole).map(|file| plan.folder.join(file)).collect()
}

fn start(plan: &Plan, path: &Path, comment: &str) -> Result<Making, Error> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let kind = FilmKind::of(&name).unwrap_or(FilmKind::Mp4);
    let size = (plan.sampling.width, plan.sampling.height);
    Making::create(kind, path, size, plan.film_rate.unwrap_or(24.0), comment)
}

fn view(scene: &Scene, plan: &Plan, exposure: &Exposure) -> View {
    let view = scene.observer.view(exposure.tau, plan.sampling.width, plan.sampling.height);
    match (plan.eye, scene.observer.stereo) {
        (Some(side), Some(eyes)) => view.eye(side, eyes.apart),
        _ => view,
    }
}

/// None if it was stopped.
fn exposed(
    scene: &Scene,
    plan: &Plan,
    exposure: &Exposure,
    (development, stop): (&Development, &Stop),
) -> Option<Exposed> {
    // Of a still film always the first, so that a part of it has the same bytes.
    let exposure = if plan.still { &plan.exposures[0] } else { exposure };
    let view = view(scene, plan, exposure);
    let of = |view: &View| exposed_by(scene, plan, view, (development, stop));
    let Some(Stereo { apart, layout: Layout::Anaglyph }) = scene.observer.stereo else { return of(&view) };
    let (left, right) = (of(&view.eye(Side::Left, apart))?, of(&view.eye(Side::Right, apart))?);
    let settling = left.settling.zip(right.settling).map(|(one, other)| Settling {
        error: Uncertainty {
            mean: one.error.mean.max(other.error.mean),
            p99: one.error.p99.max(other.error.p99),
        },
        samples: one.samples + other.samples,
    });
    let negative = stereo::anaglyph(&left.negative, &right.negative);
    let eyes = Some(Box::new([left.negative, right.negative]));
    Some(Exposed { negative, settling, bands: None, eyes })
}

fn exposed_by(
    scene: &Scene,
    plan: &Plan,
    view: &View,
    (development, stop): (&Development, &Stop),
) -> Option<Exposed> {
    let lit = scene.lit();
    if let Some(tolerance) = plan.tolerance {
        let settled = expose_settled_until(&lit, view, &plan.sampling, development, (tolerance, stop))?;
        let settling = Settling { error: settled.error, samples: settled.samples };
        return Some(Exposed {
            negative: settled.negative,
            settling: Some(settling),
            bands: None,
            eyes: None,
        });
    }
    if plan.outputs.spectrum() {
        let (negative, bands) = expose_spectral(scene, view, &plan.sampling);
        let exposed = Exposed { negative, settling: None, bands: Some(bands), eyes: None };
        return Some(exposed).filter(|_| !stop.is_set());
    }
    let negative = expose_until(&lit, view, &plan.sampling, stop)?;
    Some(Exposed { negative, settling: None, bands: None, eyes: None })
}

fn print(
    scene: &Scene,
    plan: &Plan,
    exposure: &Exposure,
    development: &Development,
    Exposed { negative, settling, bands, eyes }: Exposed,
) -> Print {
    let view = view(scene, plan, exposure);
    let seen = asks_rays(plan).then(|| layers::seen(scene, plan, &view));
    let shown = |pixel: usize| match eyes.as_deref() {
        Some(eyes) => stereo::shown(eyes.each_ref().map(|eye| development.shown(eye, pixel))),
        None => development.shown(&negative, pixel),
    };
    let fine = plan.outputs.sixteen.then(|| film::encode_finely(negative.xyz.len(), shown));
    let rgb = match &fine {
        Some(fine) => fine.iter().map(|value| output::eight_of(*value)).collect(),
        None => film::encode(negative.xyz.len(), shown),
    };
    let white = development.white;
    let text = about::of_picture(scene, plan, exposure, white);
    Print { exposure: *exposure, rgb, fine, negative, settling, bands, seen, white, text }
}

/// Writes what comes; whether that was all, or it was stopped.
fn file_all(
    plan: &Plan,
    scales: Option<&Scales>,
    mut films: Vec<(Making, PathBuf)>,
    (inbox, stop): (&Receiver<Sheet>, &Stop),
    mut tell: impl FnMut(Step),
) -> Result<bool, Error> {
    for sheet in inbox {
        let print = match sheet {
            Sheet::New(print) => print,
            Sheet::Kept(_) if stop.is_set() => continue,
            Sheet::Kept(index) => {
                if !films.is_empty() {
                    let rgb = files::read(plan, index)?;
                    films.iter_mut().try_for_each(|(film, _)| film.push(&rgb))?;
                }
                continue;
            }
        };
        files::write(plan, &print, scales)?;
        films.iter_mut().try_for_each(|(film, _)| film.push(&print.rgb))?;
        tell(Step::Picture(plan.picture(print.exposure.index, Picture::Png), print.settling));
    }
    // One that fails leaves the others as they are.
    let mut done = Ok(());
    for (film, path) in films {
        if stop.is_set() {
            break;
        }
        match film.finish(&|index| files::read(plan, index)) {
            Ok(()) => tell(Step::Film(path)),
            Err(error) => done = done.and(Err(error)),
        }
    }
    done.map(|()| !stop.is_set())
}

/// Columns of the small pictures by which a film is metered, and how many there are at most.
const METER_COLUMNS: u32 = 64;
const METER_PICTURES: usize = 48;

/// How every picture of the film is developed, whichever of them are rendered.
pub fn development(scene: &Scene, plan: &Plan) -> Development {
    development_until(scene, plan, &Stop::never()).unwrap_or_else(|| developed(plan, None))
}

/// The same; none if it was stopped.
pub fn development_until(scene: &Scene, plan: &Plan, stop: &Stop) -> Option<Development> {
    let Some(Metering { small, every, .. }) = metering(plan) else { return Some(developed(plan, None)) };
    let mut pixels = Vec::new();
    for exposure in plan.exposures.iter().step_by(every) {
        for view in scene.observer.views(exposure.tau, small.width, small.height) {
            pixels.extend(expose_until(&scene.lit(), &view, &small, stop)?.xyz);
        }
    }
    Some(developed(plan, Brightness::of(pixels)))
}

/// How a film is metered.
pub(crate) struct Metering {
    /// What the small pictures are like.
    pub(crate) small: Sampling,
    /// From one of them to the next.
    pub(crate) every: usize,
    /// How many they are.
    pub(crate) pictures: usize,
}

/// How a film is metered; none where the manifest says all that there is to be found.
pub(crate) fn metering(plan: &Plan) -> Option<Metering> {
    if matches!(plan.white, White::Fixed(_)) && plan.headroom.is_some() {
        return None;
    }
    // Of the same picture over and over, one is enough.
    let pictures = if plan.still { 1 } else { METER_PICTURES };
    let every = plan.exposures.len().div_ceil(pictures).max(1);
    let small = Sampling { samples: 1, ..plan.sampling.within(METER_COLUMNS) };
    Some(Metering { small, every, pictures: plan.exposures.len().div_ceil(every) })
}

/// How pictures of this brightness are developed.
pub(crate) fn developed(plan: &Plan, brightness: Option<Brightness>) -> Development {
    let brightness = brightness.unwrap_or(Brightness { white: 1.0, brightest: 1.0 });
    let white = match plan.white {
        White::Fixed(white) => white,
        White::Auto { gain } => brightness.white / gain,
    };
    Development::new(white, plan.headroom.unwrap_or_else(|| brightness.headroom(white)))
}
