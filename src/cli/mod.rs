//! The command line: flags as typed become what is meant. Only this folder and `main` print.

mod chart;
mod check;
mod examples;
mod inspect;
mod manual;
mod new;
mod preview;
mod progress;
mod sheet;
mod signals;
mod sized;
mod watch;

use crate::diagnostic;
use crate::error::{Error, Fault, Place, Report};
use crate::manifest::{self, Manifest};
use crate::plan::{Plan, meaning};
use crate::render;
use crate::scene::{Scene, compose, compose_rest};
use crate::stereo::Layout;
use crate::stop::Stop;
use clap::{Args, Parser, Subcommand};
use examples::{CHART, CHECK, COMPLETIONS, EXAMPLES, INSPECT, MAN, NEW, RENDER, SCHEMA, SHEET};
use std::io::{IsTerminal, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Renders what a camera would really see when things move near the speed of light.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render the pictures and the film of manifests
    #[command(after_help = RENDER)]
    Render(RenderArgs),
    /// Find every fault of a manifest, and say what its scene needs
    #[command(after_help = CHECK)]
    Check(CheckArgs),
    /// Chart what each setting costs in time against what it gives in accuracy, for one exposure
    #[command(after_help = CHART)]
    Chart(chart::ChartArgs),
    /// Show what is in a model file: nodes, materials, lights, cameras
    #[command(after_help = INSPECT)]
    Inspect(inspect::InspectArgs),
    /// Write a manifest to begin with, for any model
    #[command(after_help = NEW)]
    New(new::NewArgs),
    /// Put pictures on a contact sheet, each with its name
    #[command(after_help = SHEET)]
    Sheet(sheet::SheetArgs),
    /// Print the JSON Schema of manifests, by which editors complete keys and explain them
    #[command(after_help = SCHEMA)]
    Schema(manual::SchemaArgs),
    /// Print what a shell needs to complete commands and flags
    #[command(after_help = COMPLETIONS)]
    Completions(manual::CompletionsArgs),
    /// Print the page of the manual, or write all pages
    #[command(after_help = MAN)]
    Man(manual::ManArgs),
}

/// Each thread has a stack of its own.
const MOST_THREADS: i64 = 1024;

#[derive(Debug, Args)]
struct RenderArgs {
    /// The manifests (YAML)
    #[arg(required = true, value_name = "MANIFEST")]
    manifests: Vec<PathBuf>,
    /// Only this exposure, by its number (the first is 0)
    #[arg(long, value_name = "N", conflicts_with_all = ["from", "to"])]
    exposure: Option<usize>,
    /// Only the exposures from this number; a part of them makes no film
    #[arg(long, value_name = "N")]
    from: Option<usize>,
    /// Only the exposures up to this number
    #[arg(long, value_name = "N")]
    to: Option<usize>,
    /// Width and height in pixels, as in 640x360
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Width and height times this, rounded: 0.25 is a quarter of each side
    #[arg(long, value_name = "FACTOR", conflicts_with = "size", allow_negative_numbers = true)]
    scale: Option<String>,
    /// Samples per pixel
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    samples: Option<String>,
    /// How far 99 of 100 pixels may be from the converged picture, in CIEDE2000 (1 is just noticeable), instead of samples
    #[arg(long, value_name = "CIEDE2000", conflicts_with = "samples", allow_negative_numbers = true)]
    tolerance: Option<String>,
    /// The folder for the pictures, instead of the manifest's
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Render all anew, though pictures are there
    #[arg(long)]
    restart: bool,
    /// Leave the film out, only pictures
    #[arg(long)]
    no_video: bool,
    /// Threads to use (all unless said); the pictures are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    threads: Option<u16>,
    #[command(flatten)]
    seeing: Seeing,
    #[command(flatten)]
    changes: Changes,
}

#[derive(Debug, Args)]
struct Seeing {
    /// Write nothing, and show one exposure from coarse to fine, in a window or else in the terminal: the middle one, or --exposure
    #[arg(long, value_name = "WHERE", num_args = 0..=1, require_equals = true, default_missing_value = "anywhere",
        conflicts_with_all = ["out", "restart", "no_video"])]
    preview: Option<preview::Where>,
    /// Again whenever the manifest, or a file that it reads, is saved
    #[arg(long)]
    watch: bool,
}

#[derive(Debug, Args)]
struct CheckArgs {
    /// The manifest (YAML)
    manifest: PathBuf,
    #[command(flatten)]
    changes: Changes,
}

#[derive(Debug, Args)]
struct Changes {
    /// Change a key of the manifest, as in picture.samples=16 or bodies.monkey.velocity="0.5 0 0 c"; 'film=~' takes one away, lights.+="{ .. }" adds to a list
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl Changes {
    fn pairs(&self) -> Result<Vec<(String, String)>, Error> {
        let pair = |text: &String| match text.split_once('=') {
            Some((key, value)) => Ok((key.trim().to_owned(), value.trim().to_owned())),
            None => Err(Error::fault(
                Place::Command,
                format!("`--set {text}` has no `=`"),
                "--set picture.samples=16",
            )),
        };
        self.set.iter().map(pair).collect()
    }
}

/// Runs the program.
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    signals::take();
    let done = match cli.command {
        Command::Render(args) => render_all(&args),
        Command::Check(args) => args.changes.pairs().and_then(|pairs| check::run(&args.manifest, &pairs)),
        Command::Chart(args) => pool(args.threads).and_then(|pool| pool.install(|| chart::run(&args))),
        Command::Inspect(args) => inspect::run(&args),
        Command::New(args) => new::run(&args),
        Command::Sheet(args) => sheet::run(&args),
        Command::Schema(args) => manual::schema(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Man(args) => manual::man(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say(&complaint(&error));
            ExitCode::from(error.exit_code())
        }
    }
}

fn complaint(error: &Error) -> String {
    match error {
        Error::Input(faults) => diagnostic::render(faults, false, colored()),
        error @ Error::Machine { .. } => format!("error: {error}\n"),
        error @ Error::Stopped { .. } => format!("{error}\n"),
    }
}

/// Writes to the standard output. A reader that has gone (`| head`) wants no more, and no complaint.
fn print(text: &str) -> Result<(), Error> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::machine(Path::new("standard output"), "writing", error))
        }
        _ => Ok(()),
    }
}

/// Warnings, each thing said once with the number of further places.
fn warnings(warnings: &[Fault]) -> String {
    let mut said: Vec<(Fault, usize)> = Vec::new();
    for warning in warnings {
        match said.iter_mut().find(|(first, _)| first.what == warning.what && first.hint == warning.hint) {
            Some((_, more)) => *more += 1,
            None => said.push((warning.clone(), 0)),
        }
    }
    for (warning, more) in &mut said {
        if *more > 0 {
            warning.what += &format!(" (and in {more} more)");
        }
    }
    let said: Vec<Fault> = said.into_iter().map(|(warning, _)| warning).collect();
    diagnostic::render(&said, true, colored())
}

fn colored() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// What a manifest asks for and means, with warnings printed; or all faults. `film`: whether its film may be wanted.
fn prepare(path: &Path, changes: &[(String, String)], film: bool) -> Result<(Manifest, Scene, Plan), Error> {
    let mut report = Report::default();
    let all = compose_into(path, changes, film, &mut report);
    look(all.as_ref(), &mut report);
    say(&warnings(&report.warnings));
    report.finish(all)
}

/// The same, with faults and warnings reported, and nothing looked at.
fn compose_into(
    path: &Path,
    changes: &[(String, String)],
    film: bool,
    report: &mut Report,
) -> Option<(Manifest, Scene, Plan)> {
    let draft = manifest::load_draft(path, changes, report)?;
    if !draft.sound {
        // What else is wrong, in the files of what could be read.
        let mut beside = Report::default();
        compose(&draft.manifest, path, &mut beside);
        report.faults.append(&mut beside.faults);
        report.inputs.extend(beside.inputs);
        return None;
    }
    let manifest = Manifest { film: draft.manifest.film.filter(|_| film), ..draft.manifest };
    let scene = compose_rest(&manifest, path, report);
    let plan = Plan::of(&manifest, &scene, path, report);
    Some((manifest, scene, plan)).filter(|_| report.faults.is_empty())
}

/// Warns of what will not be seen.
fn look(all: Option<&(Manifest, Scene, Plan)>, report: &mut Report) {
    if let Some((manifest, scene, plan)) = all {
        meaning::check(manifest, scene, plan, report);
    }
}

/// The threads that trace.
fn pool(threads: Option<u16>) -> Result<rayon::ThreadPool, Error> {
    // Mirrors and glass are followed by recursion, at most `depth` and a hundred veils deep.
    let mut pool = rayon::ThreadPoolBuilder::new().stack_size(16 << 20);
    if let Some(threads) = threads {
        pool = pool.num_threads(usize::from(threads));
    }
    pool.build().map_err(|error| {
        Error::fault(Place::Command, format!("the threads could not be started: {error}"), "--threads 2")
    })
}

fn render_all(args: &RenderArgs) -> Result<(), Error> {
    let mut changes = args.changes.pairs()?;
    changes.extend(sized::size_change(args.size.as_deref())?);
    sized::check_scale(args.scale.as_deref())?;
    if let Some(samples) = &args.samples {
        changes.push(("picture.samples".to_owned(), samples.clone()));
    }
    if let Some(tolerance) = &args.tolerance {
        changes.push(("picture.tolerance".to_owned(), tolerance.clone()));
    }
    if args.no_video {
        changes.push(("film.video".to_owned(), "off".to_owned()));
    }
    if args.out.is_some() && args.manifests.len() > 1 {
        let hint = "render them one by one, or leave --out away: each has an output of its own";
        return Err(Error::fault(Place::Command, "several manifests cannot go to one folder", hint));
    }
    if args.seeing.watch && args.manifests.len() > 1 {
        let hint = "one command for each, each in a terminal of its own";
        return Err(Error::fault(Place::Command, "several manifests cannot be watched", hint));
    }
    if args.seeing.preview.is_some() {
        return args.manifests.iter().try_for_each(|path| preview::run(path, &changes, args));
    }
    let pool = pool(args.threads)?;
    if args.seeing.watch {
        return args.manifests.iter().try_for_each(|path| pool.install(|| watch::run(path, &changes, args)));
    }
    pool.install(|| render_each(&changes, args))
}

/// Renders one manifest after the other. What is wrong with any of them is told before the first one is rendered; a folder that
/// is refused leaves the others as they are.
fn render_each(changes: &[(String, String)], args: &RenderArgs) -> Result<(), Error> {
    let mut faults = Vec::new();
    if args.manifests.len() > 1 {
        for path in &args.manifests {
            let mut report = Report::default();
            let composed = composed(path, changes, args, &mut report).map(|(_, _, plan)| plan);
            let plan = report.finish(composed);
            if let Err(Error::Input(more)) = plan.and_then(|plan| chosen(args, plan.exposures.len())) {
                // A fault of the command is one fault, however many manifests there are.
                faults.extend(more.into_iter().filter(|fault| !faults.contains(fault)).collect::<Vec<_>>());
            }
        }
    }
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    for path in &args.manifests {
        match render_one(path, changes, args) {
            Err(Error::Input(more)) => faults.extend(more),
            Err(error) if faults.is_empty() => return Err(error),
            Err(error) => {
                say(&complaint(&Error::Input(faults)));
                return Err(error);
            }
            Ok(()) => {}
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}

fn render_one(path: &Path, changes: &[(String, String)], args: &RenderArgs) -> Result<(), Error> {
    let mut report = Report::default();
    let ready = prepared(path, changes, args, &mut report);
    say(&warnings(&report.warnings));
    let (scene, plan) = report.finish(ready)?;
    signals::gently(|stop| render_ready(&scene, &plan, args, stop))
}

/// What is to be rendered, as the manifest and the flags have it.
fn prepared(
    path: &Path,
    changes: &[(String, String)],
    args: &RenderArgs,
    report: &mut Report,
) -> Option<(Scene, Plan)> {
    let ready = composed(path, changes, args, report);
    look(ready.as_ref(), report);
    let (_, scene, mut plan) = ready?;
    if let Some(folder) = &args.out {
        plan.folder.clone_from(folder);
    }
    plan.restart = args.restart;
    if args.samples.is_some() {
        plan.tolerance = None; // Asked for by hand, whatever the manifest has.
    }
    Some((scene, plan))
}

fn composed(
    path: &Path,
    changes: &[(String, String)],
    args: &RenderArgs,
    report: &mut Report,
) -> Option<(Manifest, Scene, Plan)> {
    let scaled = sized::scaled(path, changes, args.scale.as_deref());
    let flags = [
        ("size", "--size", args.size.is_some()),
        ("size", "--scale", scaled.is_some()),
        ("samples", "--samples", args.samples.is_some()),
        ("tolerance", "--tolerance", args.tolerance.is_some()),
    ];
    let changes = scaled.as_deref().unwrap_or(changes);
    let ready = compose_into(path, changes, args.exposure.is_none(), report);
    for (key, flag, _) in flags.into_iter().filter(|(.., given)| *given) {
        name_as_flag(report.faults.iter_mut().chain(&mut report.warnings), key, flag);
    }
    ready
}

fn render_ready(scene: &Scene, plan: &Plan, args: &RenderArgs, stop: &Stop) -> Result<(), Error> {
    let chosen = chosen(args, plan.exposures.len())?;
    let films =
        if scene.observer.stereo.is_some_and(|eyes| eyes.layout == Layout::LeftRight) { 2 } else { 1 };
    let mut progress = progress::Progress::start(plan, films * chosen.len());
    render::render_until(scene, plan, chosen, stop, |step| progress.show(&step))
}

/// Faults of what a flag says, as faults of the flag and not of the key that it stands for.
fn name_as_flag<'f>(faults: impl Iterator<Item = &'f mut Fault>, key: &str, flag: &str) {
    let change = format!("--set picture.{key}=");
    for fault in faults {
        if !matches!(&fault.place, Place::Argument { text, .. } if text.starts_with(&change)) {
            continue;
        }
        fault.place = Place::Command;
        fault.what = format!("{flag}: {}", fault.what);
        if let Some(typed) = fault.hint.strip_prefix(&format!("{key}: ")) {
            fault.hint = if key == "size" { sized::typed(typed, flag) } else { format!("{flag} {typed}") };
        }
    }
}

/// The exposures that are asked for, of `count`.
fn chosen(args: &RenderArgs, count: usize) -> Result<Range<usize>, Error> {
    let (from, to) = match args.exposure {
        Some(only) => (only, only),
        None => (args.from.unwrap_or(0), args.to.unwrap_or(count - 1)),
    };
    let hint = format!("they are numbered from 0 to {}", count - 1);
    if from.max(to) >= count {
        return Err(Error::fault(Place::Command, format!("there is no exposure {}", from.max(to)), hint));
    }
    if from > to {
        let what = format!("the exposures from {from} to {to} are none: the first comes after the last");
        return Err(Error::fault(Place::Command, what, hint));
    }
    Ok(from..to + 1)
}

/// Says something beside what is asked for. If nobody listens any more the work goes on.
fn say(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}
