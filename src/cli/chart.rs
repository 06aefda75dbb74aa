//! `terrell chart`: what each setting costs, and what it gives.

use super::{Changes, prepare, print};
use crate::chart::{self, Deviation, Measured, Method, Subject};
use crate::error::{Error, Place};
use crate::exposure::Sampling;
use crate::output::{make_folder, write_whole};
use crate::render::development;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(super) struct ChartArgs {
    /// The manifest (YAML)
    manifest: PathBuf,
    /// Which exposure, by its number (the middle one unless said)
    #[arg(long, value_name = "N")]
    exposure: Option<usize>,
    /// Width and height in pixels (the manifest's shape, at most 320 wide, unless said)
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// How often each setting is timed
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// Samples per pixel of the reference, shared by neighbouring pixels; the next power of two is taken
    #[arg(long, value_name = "N", default_value = "512", value_parser = clap::value_parser!(u32).range(8..=1024))]
    reference: u32,
    /// The folder for `chart.svg` and `chart.csv`, instead of the manifest's
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Threads to use (all unless said)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=super::MOST_THREADS))]
    pub(super) threads: Option<u16>,
    #[command(flatten)]
    changes: Changes,
}

/// Widest picture unless said.
const WIDEST: u32 = 320;

pub(super) fn run(args: &ChartArgs) -> Result<(), Error> {
    let mut changes = args.changes.pairs()?;
    changes.extend(super::sized::size_change(args.size.as_deref())?);
    let (_, scene, mut plan) = prepare(&args.manifest, &changes, false)?;
    let number = args.exposure.unwrap_or(plan.exposures.len() / 2);
    let Some(exposure) = plan.exposures.get(number).copied() else {
        let hint = format!("they are numbered from 0 to {}", plan.exposures.len() - 1);
        return Err(Error::fault(Place::Command, format!("there is no exposure {number}"), hint));
    };
    let development = development(&scene, &plan);
    if args.size.is_none() {
        plan.sampling = plan.sampling.within(WIDEST);
    }
    let folder = args.out.as_ref().unwrap_or(&plan.folder);
    // A folder that cannot be written is found before all the work, not after it.
    make_folder(folder)?;
    let trial = folder.join(".chart");
    write(&trial, "")?;
    std::fs::remove_file(&trial).map_err(|error| Error::machine(&trial, "removing", error))?;
    let subject = Subject { scene: &scene, tau: exposure.tau, development };
    let samples = args.reference.next_power_of_two();
    let (reference, ..) = subject.expose(&chart::reference(&scene, &plan, samples));
    let (half, ..) = subject.expose(&chart::reference(&scene, &plan, samples / 2));
    let doubt = Deviation::between(&half, &reference, &development);

    let gauge = ProgressBar::new(1000);
    let style = ProgressStyle::with_template("{wide_bar} {elapsed} gone, {eta} left");
    gauge.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let settings = chart::ladder(&scene, &plan);
    let tell = |part: f64| gauge.set_position((part * 1000.0) as u64);
    let measured = subject.measure(settings, &reference, args.runs as usize, tell);
    gauge.finish_and_clear();

    let name = args.manifest.file_stem().unwrap_or_default().to_string_lossy();
    let Sampling { width, height, .. } = plan.sampling;
    let title = format!("{name}, exposure {number}, {width} x {height}: what it costs and what it gives");
    write(&folder.join("chart.svg"), &chart::svg(&title, &measured))?;
    write(&folder.join("chart.csv"), &chart::csv(&measured))?;
    print(&summary(&measured, (samples, &doubt), folder))
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    write_whole(path, |file| std::io::Write::write_all(file, text.as_bytes()))
}

fn named(one: &Measured) -> String {
    let setting = &one.setting;
    match setting.method {
        _ if setting.default => format!("the default, {}", setting.label),
        Method::Tolerance(tolerance) => format!("--tolerance {tolerance}"),
        Method::Everything => setting.series.to_owned(),
        Method::Planned | Method::Converged => format!("{} {}", setting.series, setting.label),
    }
}

fn summary(measured: &[Measured], (samples, doubt): (u32, &Deviation), folder: &Path) -> String {
    let mut text = String::new();
    text += "       time    RMSE of XYZ    CIEDE2000: mean  99 in 100    setting\n";
    let mut order: Vec<&Measured> = measured.iter().collect();
    order.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    for one in order {
        let Deviation { rmse, shown } = &one.deviation;
        text += &format!(
            "{:>9.4} s    {rmse:>11.2e}    {:>15.3}  {:>9.3}    {}{}\n",
            one.seconds,
            shown.mean,
            shown.p99,
            named(one),
            one.estimate.map_or(String::new(), |estimate| {
                format!(" ({:.1} samples; says {:.3} {:.3})", one.samples, estimate.mean, estimate.p99)
            })
        );
    }
    text += &format!(
        "The reference has {samples} samples and 64 wavelengths; with half the samples it differs by {:.3} in the mean, and in \
         99 pixels of 100 by less than {:.3}.\n",
        doubt.shown.mean, doubt.shown.p99
    );
    text += &match chart::cheapest(measured) {
        Some(one) => format!(
            "Cheapest below what is just noticeable (99 in 100 pixels differ by less than CIEDE2000 1): {}, {:.3} s.\n",
            named(one),
            one.seconds
        ),
        None => "No setting stays below what is just noticeable in 99 pixels of 100.\n".to_owned(),
    };
    text + &format!("{}\n{}\n", folder.join("chart.svg").display(), folder.join("chart.csv").display())
}
