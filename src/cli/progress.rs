//! How far a film is: a bar with the time left on a terminal, plain lines elsewhere.

use crate::exposure::Uncertainty;
use crate::plan::Plan;
use crate::render::{Settling, Step};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Between two plain lines.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// The state of a film's rendering, shown as it goes.
pub(super) struct Progress {
    gauge: Option<ProgressBar>,
    started: Instant,
    last_line: Option<Instant>,
    done: usize,
    kept: usize,
    pictures: usize,
    folder: PathBuf,
    // The least settled so far.
    worst: Option<Settling>,
    tolerance: f64,
}

fn worse(one: Option<Settling>, other: Settling) -> Settling {
    let Some(one) = one else { return other };
    let error =
        Uncertainty { mean: one.error.mean.max(other.error.mean), p99: one.error.p99.max(other.error.p99) };
    Settling { error, samples: one.samples.max(other.samples) }
}

impl Progress {
    /// For so many pictures of a film.
    pub(super) fn start(plan: &Plan, pictures: usize) -> Self {
        let gauge = std::io::stderr().is_terminal().then(|| {
            let style =
                ProgressStyle::with_template("{wide_bar} {pos}/{len}  {elapsed} gone, {eta} left  {msg}");
            ProgressBar::new(pictures as u64)
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
                .with_message(plan.folder.display().to_string())
        });
        if let Some(gauge) = &gauge {
            gauge.enable_steady_tick(Duration::from_millis(250));
        }
        let tolerance = plan.tolerance.unwrap_or(f64::INFINITY);
        Self {
            gauge,
            started: Instant::now(),
            last_line: None,
            done: 0,
            kept: 0,
            pictures,
            folder: plan.folder.clone(),
            worst: None,
            tolerance,
        }
    }

    /// Shows a step.
    pub(super) fn show(&mut self, step: &Step) {
        let path = match step {
            Step::Metered(_) => return,
            Step::Waiting(folder) => {
                let folder = folder.display();
                return self
                    .say(&format!("another terrell is rendering into {folder}: waiting until it is done"));
            }
            Step::Unlocked(folder) => {
                let folder = folder.display();
                return self.say(&format!(
                    "{folder} is on a disk without locks: see that no other terrell renders there"
                ));
            }
            Step::Kept(count) => return self.keep(*count),
            Step::Film(path) => return self.say(&format!("film {}", path.display())),
            Step::Picture(path, settling) => {
                if let Some(settling) = settling {
                    self.worst = Some(worse(self.worst, *settling));
                }
                path
            }
        };
        self.done += 1;
        let last = self.done == self.pictures;
        if let Some(gauge) = &self.gauge {
            gauge.inc(1);
            if last {
                gauge.finish_and_clear();
            }
        }
        if last {
            let seconds = self.started.elapsed().as_secs_f64();
            let made = self.pictures - self.kept;
            let what = if made == 1 { "picture" } else { "pictures" };
            let more = if self.kept > 0 { "more " } else { "" };
            let folder = self.folder.display();
            self.say(&format!("{made} {more}{what} in {folder}, {seconds:.1} s"));
            if let Some(Settling { error, samples }) = self.worst {
                let reached = if error.p99 > self.tolerance {
                    format!("; {} was not reached: some pixels need more than they may have", self.tolerance)
                } else {
                    String::new()
                };
                self.say(&format!(
                    "99 of 100 pixels are within CIEDE2000 {:.2} of the converged picture (mean {:.2}), by estimate; {samples:.0} samples \
                     for each pixel in the mean{reached}",
                    error.p99, error.mean
                ));
            }
            return;
        }
        let due = self.last_line.unwrap_or(self.started).elapsed() >= BETWEEN_LINES;
        if self.gauge.is_none() && due {
            self.last_line = Some(Instant::now());
            let each = self.started.elapsed().as_secs_f64() / (self.done - self.kept) as f64;
            let left = each * (self.pictures - self.done) as f64;
            self.say(&format!("{}/{} {}  {left:.0} s left", self.done, self.pictures, path.display()));
        }
    }

    /// Some pictures are there already.
    fn keep(&mut self, count: usize) {
        self.done += count;
        self.kept = count;
        if let Some(gauge) = &self.gauge {
            gauge.inc(count as u64);
            gauge.reset_eta();
            if self.done == self.pictures {
                gauge.finish_and_clear();
            }
        }
        self.say(&format!("{count} of {} pictures are there already", self.pictures));
    }

    fn say(&self, line: &str) {
        match &self.gauge {
            Some(gauge) => gauge.suspend(|| super::say(&format!("{line}\n"))),
            None => super::say(&format!("{line}\n")),
        }
    }
}
