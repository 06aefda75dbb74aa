//! What a film will cost in time and memory, found by exposing a few parts of it.
//!
//! Squares of pixels are exposed as they will be, here and there in pictures here and there in the film, until their mean is known
//! well enough; that is what most of the time goes to. It is the processor's time, so what else is going on does not count. What is done with a finished picture is the same for every scene, and has
//! been measured once.

use super::Plan;
use crate::exposure::{Sampling, TILE, expose_settled, expose_tiles};
use crate::manifest::Layer;
use crate::render;
use crate::scene::Scene;
use crate::stereo::Layout;
use std::time::{Duration, Instant};

/// What is to be expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Finding the brightness of the film, seconds.
    pub metering: f64,
    /// One picture in the mean, seconds.
    pub picture: f64,
    /// The exposures that are to be rendered, all together, metering included, seconds.
    pub all: f64,
    /// The threads that this is for.
    pub threads: usize,
    /// The memory that is taken at most, bytes, the scene included; none where the system does not say what the scene takes.
    pub memory: Option<f64>,
}

/// Not much longer than this is spent on finding out.
const BUDGET: Duration = Duration::from_millis(1500);
/// Rounds of squares, each in another picture of the film: at least, and at most.
const ROUNDS: (usize, usize) = (8, 64);
/// Squares of a round: of the first one, by which it is found how many others may have, and of those at most.
const SQUARES: (usize, usize) = (4, 96);
/// Known well enough: the standard error of the mean, in parts of it.
const ENOUGH: f64 = 0.02;
/// Columns of the pictures on which a tolerance is tried.
const SETTLED_COLUMNS: u32 = 192;

/// Seconds a pixel on one thread, measured: development, PNG, coding for the film, a channel of OpenEXR.
const DEVELOPED: f64 = 15e-9;
const PNG: f64 = 18e-9;
const CODED: f64 = 15e-9;
const EXR: f64 = 105e-9;

/// Bytes a pixel, measured: pictures in the making, on their way and being written; what a film and 16 bits take beside that; a channel
/// of OpenEXR, what rays to the pixels' centres tell, a part of the spectrum; what is known of a pixel that is to settle.
const PICTURES: f64 = 25.0;
const FILM: f64 = 11.0;
const SIXTEEN: f64 = 12.0;
const CHANNEL: f64 = 9.6;
const SEEN: f64 = 112.0;
const BAND: f64 = 32.0;
const SETTLING: f64 = 290.0;
/// What threads and the rest take, and what the coding of a film takes of any size, bytes.
const BESIDE: f64 = 2e6;
const CODER: f64 = 1e6;

/// What the whole film will cost. Takes two seconds or less, but for scenes of which a few squares take longer.
pub fn estimate(scene: &Scene, plan: &Plan) -> Cost {
    let memory = memory(plan);
    let threads = rayon::current_num_threads();
    let pixels = f64::from(plan.sampling.width) * f64::from(plan.sampling.height);
    let once = once(scene, plan);
    let (traced, sample) = match plan.tolerance {
        Some(tolerance) => settled(scene, plan, tolerance),
        None => traced(scene, plan),
    };
    // Two eyes are two pictures in one, or two films.
    let layout = scene.observer.stereo.map(|eyes| eyes.layout);
    let traced = if layout == Some(Layout::Anaglyph) { 2.0 * traced } else { traced };
    let films = if layout == Some(Layout::LeftRight) { 2.0 } else { 1.0 };
    let metering = render::metering(plan).map_or(0.0, |metering| {
        let Sampling { width, height, .. } = metering.small;
        sample * metering.pictures as f64 * f64::from(width) * f64::from(height)
    });
    let film = CODED * render::film_paths(plan, plan.exposures.len()).len() as f64;
    let written = pixels * (PNG + film);
    // OpenEXR is packed on all threads.
    let exr = EXR * channels(plan);
    let developed = pixels * (DEVELOPED + exr) / threads as f64;
    // Files are written beside the tracing of the next picture, on the same processor.
    let beside = |traced: f64| written.max(traced + developed + written / threads as f64);
    let count = plan.exposures.len() as f64;
    let all = if plan.still { traced + count * beside(0.0) } else { count * beside(traced) };
    Cost { metering, picture: all / count, all: once + metering + films * all, threads, memory }
}

/// The seconds that tables and the like take, which are made when they are asked for first, and only once.
fn once(scene: &Scene, plan: &Plan) -> f64 {
    let Sampling { width, height, .. } = plan.sampling;
    let view = scene.observer.view(plan.exposures[plan.exposures.len() / 2].tau, width, height);
    let middle = |side: u32| (side as usize).div_ceil(TILE) / 2;
    let started = Clock::start();
    let lit = scene.lit().seen_from(view.tetrad.event);
    expose_tiles(&lit, &view, &plan.sampling, &[(middle(width), middle(height))]);
    started.passed(1)
}

/// The seconds that a picture takes to be traced, and one sample of it.
fn traced(scene: &Scene, plan: &Plan) -> (f64, f64) {
    let Sampling { width, height, samples, .. } = plan.sampling;
    let across = |side: u32| (side as usize).div_ceil(TILE);
    let (columns, rows) = (across(width), across(height));
    let began = Instant::now();
    let (mut ready, mut seconds, mut pixels) = (0.0, 0.0, 0.0);
    let mut means: Vec<f64> = Vec::new();
    let mut squares = SQUARES.0;
    let mut next = 0;
    while means.len() < ROUNDS.1 {
        // Evenly, wherever it stops: multiples of irrational numbers.
        let part = |number: usize, step: f64| (0.5 + number as f64 * step).fract();
        let exposure = part(means.len(), 0.618_033_988_749_895) * plan.exposures.len() as f64;
        let view = scene.observer.view(plan.exposures[exposure as usize].tau, width, height);
        let place = |number: usize| {
            let column = part(number, 0.754_877_666_246_693) * columns as f64;
            (column as usize, (part(number, 0.569_840_290_998_053) * rows as f64) as usize)
        };
        let places: Vec<(usize, usize)> = (next..next + squares).map(place).collect();
        next += squares;
        let started = Clock::start();
        let lit = scene.lit().seen_from(view.tetrad.event);
        let begin = Clock::start();
        expose_tiles(&lit, &view, &plan.sampling, &[]);
        let begun = begin.passed(rayon::current_num_threads());
        let made_ready = started.passed(1);
        let started = Clock::start();
        let exposed = expose_tiles(&lit, &view, &plan.sampling, &places) as f64;
        // What it takes to begin is in both.
        let took = (started.passed(rayon::current_num_threads()) - begun).max(1e-9);
        if means.is_empty() {
            let room = BUDGET.as_secs_f64() / (2 * ROUNDS.0) as f64;
            squares = ((squares as f64 * room / took) as usize).clamp(SQUARES.0, SQUARES.1);
        }
        ready += made_ready;
        seconds += took;
        pixels += exposed;
        means.push(took / exposed);
        let known = means.len() >= ROUNDS.0 && error(&means) < ENOUGH;
        if known || (means.len() > 1 && began.elapsed() > BUDGET) {
            break;
        }
    }
    let pixel = seconds / pixels;
    let picture = pixel * f64::from(width) * f64::from(height) * idle(rows);
    (picture + ready / means.len() as f64, pixel / f64::from(samples))
}

/// The time that work takes when nothing else is done on the machine.
struct Clock {
    began: Instant,
    // What all threads had been given, where the system says so.
    given: Option<f64>,
}

impl Clock {
    fn start() -> Self {
        Self { began: Instant::now(), given: given() }
    }

    /// Seconds since it was started, of work on so many threads.
    fn passed(&self, threads: usize) -> f64 {
        let given = self.given.zip(given()).map(|(before, now)| (now - before) / threads as f64);
        given.filter(|seconds| *seconds > 0.0).unwrap_or_else(|| self.began.elapsed().as_secs_f64())
    }
}

/// The processor's time that the threads of this process have been given, seconds.
fn given() -> Option<f64> {
    let of = |thread: std::fs::DirEntry| -> Option<f64> {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse().ok()
    };
    let threads = std::fs::read_dir("/proc/self/task").ok()?;
    Some(threads.flatten().filter_map(of).sum::<f64>() * 1e-9)
}

/// By what a picture takes longer since threads have nothing to do in the end: each works on a row of squares.
fn idle(rows: usize) -> f64 {
    let (threads, rows) = (rayon::current_num_threads() as f64, rows as f64);
    if rows <= threads { threads / rows } else { 1.0 + 0.5 * (threads - 1.0) / rows }
}

/// The standard error of the mean, in parts of it.
fn error(means: &[f64]) -> f64 {
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let squared = means.iter().map(|one| (one - mean) * (one - mean)).sum::<f64>();
    (squared / (count * (count - 1.0))).sqrt() / mean
}

/// The same where samples follow from a tolerance: from small pictures. They have more edges, so that takes rather too long.
fn settled(scene: &Scene, plan: &Plan, tolerance: f64) -> (f64, f64) {
    let small = plan.sampling.within(SETTLED_COLUMNS);
    let development = render::development(scene, plan);
    let (began, clock, mut samples, mut pictures) = (Instant::now(), Clock::start(), 0.0, 0.0);
    let every = plan.exposures.len().div_ceil(ROUNDS.0).max(1);
    for exposure in plan.exposures.iter().skip(every / 2).step_by(every) {
        let view = scene.observer.view(exposure.tau, small.width, small.height);
        samples += expose_settled(&scene.lit(), &view, &small, &development, tolerance).samples;
        pictures += 1.0;
        if began.elapsed() > BUDGET {
            break;
        }
    }
    let seconds = clock.passed(rayon::current_num_threads()) / pictures;
    let pixels = |sampling: &Sampling| f64::from(sampling.width) * f64::from(sampling.height);
    (seconds * pixels(&plan.sampling) / pixels(&small), seconds / pixels(&small) / (samples / pictures))
}

/// The channels of an OpenEXR file, if there are to be any.
fn channels(plan: &Plan) -> f64 {
    plan.outputs.exr.as_ref().map_or(0.0, |wanted| render::channels(plan, wanted) as f64)
}

/// The memory that will be taken at most, given what the scene has taken.
fn memory(plan: &Plan) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kilobytes = |name: &str| -> Option<f64> {
        let line = status.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    let (most, now) = (1024.0 * kilobytes("VmHWM:")?, 1024.0 * kilobytes("VmRSS:")?);
    let films = render::film_paths(plan, plan.exposures.len()).len() as f64;
    let spectral = plan.outputs.exr.as_ref().is_some_and(|wanted| wanted.layers.contains(&Layer::Spectrum));
    let bands = if spectral { f64::from(plan.sampling.wavelengths) } else { 0.0 };
    let with = |wanted: bool, bytes: f64| if wanted { bytes } else { 0.0 };
    let pixel = PICTURES
        + FILM * films
        + CHANNEL * channels(plan)
        + BAND * bands
        + with(plan.outputs.sixteen, SIXTEEN)
        + with(render::asks_rays(plan), SEEN)
        + with(plan.tolerance.is_some(), SETTLING);
    let pixels = f64::from(plan.sampling.width) * f64::from(plan.sampling.height);
    Some(most.max(now + pixels * pixel + BESIDE + CODER * films))
}
