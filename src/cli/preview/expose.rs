//! The work of a preview: a manifest read, and one exposure of it from coarse to fine.

use super::{News, Picture};
use crate::cli::watch::FilesRead;
use crate::cli::{RenderArgs, chosen, prepared, warnings};
use crate::error::{Error, Report};
use crate::exposure::{Grain, Sampling, expose_coarse_to_fine, expose_settled_until};
use crate::film::{Brightness, Development, Negative};
use crate::plan::Plan;
use crate::render;
use crate::scene::Scene;
use crate::stop::Stop;
use std::path::Path;
use std::sync::mpsc::{Sender, channel};
use std::time::Instant;

/// When one pixel is known in so many by so many the film is metered: that is as much work as a pass.
const METERED_AT: u32 = 4;

/// Reads a manifest and exposes one of its pictures. `files` gets the files that were read.
pub(super) fn once(
    path: &Path,
    changes: &[(String, String)],
    args: &RenderArgs,
    (news, stop, files): (&Sender<News>, &Stop, &mut FilesRead<'_>),
) -> Result<(), Error> {
    let mut report = Report::default();
    let ready = prepared(path, changes, args, &mut report);
    let warned = warnings(&report.warnings);
    files(&report, ready.is_none());
    let (scene, plan) = report.finish(ready)?;
    let range = chosen(args, plan.exposures.len())?;
    if !warned.is_empty() {
        let _ = news.send(News::Text(warned));
    }
    let (answer, room) = channel();
    let full = (plan.sampling.width, plan.sampling.height);
    let Ok(room) =
        news.send(News::Size(full, answer)).map_err(|_| ()).and_then(|()| room.recv().map_err(|_| ()))
    else {
        return Ok(()); // Nobody looks.
    };
    let index = (range.start + range.end - 1) / 2;
    let preview = Preview {
        name: path.file_name().unwrap_or_default().display().to_string(),
        index,
        sampling: fitted(plan.sampling, room),
        started: Instant::now(),
        news,
        stop,
    };
    preview.exposed(&scene, &plan).ok_or_else(|| Error::Stopped { there: "a preview leaves no files".into() })
}

/// No more pixels than can be shown.
pub(super) fn fitted(sampling: Sampling, (width, height): (u32, u32)) -> Sampling {
    let by_height = u64::from(height) * u64::from(sampling.width) / u64::from(sampling.height.max(1));
    sampling.within(width.min(by_height.min(u64::from(u32::MAX)) as u32).max(1))
}

struct Preview<'p> {
    name: String,
    index: usize,
    sampling: Sampling,
    started: Instant,
    news: &'p Sender<News>,
    stop: &'p Stop,
}

impl Preview<'_> {
    /// Shows the exposure pass by pass. None if it was stopped.
    fn exposed(&self, scene: &Scene, plan: &Plan) -> Option<()> {
        let exposure = if plan.still { &plan.exposures[0] } else { &plan.exposures[self.index] };
        let Sampling { width, height, .. } = self.sampling;
        let view = scene.observer.view(exposure.tau, width, height);
        let lit = scene.lit();
        let mut film = render::metering(plan).is_none().then(|| render::developed(plan, None));
        // With a tolerance the samples follow from what is there.
        let passes = match plan.tolerance {
            Some(_) => Sampling { samples: 1, ..self.sampling },
            None => self.sampling,
        };
        let look = |negative: &Negative, grain: Grain| {
            let own = || render::developed(plan, Brightness::of(negative.xyz.iter().copied()));
            if grain == Grain::Squares(METERED_AT) && film.is_none() {
                self.show(negative, &own(), &self.said(grain));
                film = render::development_until(scene, plan, self.stop);
            }
            let said = if plan.tolerance.is_some() && grain == Grain::Done {
                "settling".to_owned()
            } else {
                self.said(grain)
            };
            self.show(negative, &film.unwrap_or_else(own), &said);
        };
        expose_coarse_to_fine(&lit, &view, &passes, self.stop, look)?;
        let Some(tolerance) = plan.tolerance else { return Some(()) };
        let development = film?;
        let settled =
            expose_settled_until(&lit, &view, &self.sampling, &development, (tolerance, self.stop))?;
        self.show(&settled.negative, &development, &self.said(Grain::Done));
        Some(())
    }

    fn said(&self, grain: Grain) -> String {
        match grain {
            Grain::Squares(1) => "every pixel once".to_owned(),
            Grain::Squares(side) => format!("one pixel in {side} x {side}"),
            Grain::Rows(rows) => format!("{rows} of {} rows with all samples", self.sampling.height),
            Grain::Done => "done".to_owned(),
        }
    }

    fn show(&self, negative: &Negative, development: &Development, said: &str) {
        let picture =
            Picture { width: negative.width, height: negative.height, rgb: development.develop(negative) };
        let seconds = self.started.elapsed().as_secs_f64();
        let line = format!(
            "{}, exposure {}, {} x {}: {said}, {seconds:.2} s",
            self.name, self.index, negative.width, negative.height
        );
        let _ = self.news.send(News::Picture(picture, line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Reconstruction;

    #[test]
    fn preview_has_no_more_pixels_than_can_be_shown_and_the_same_shape() {
        let sampling = Sampling {
            width: 1280,
            height: 720,
            samples: 4,
            reconstruction: Reconstruction::default(),
            wavelengths: 16,
        };
        for (room, size) in
            [((80, 48), (80, 45)), ((80, 20), (35, 19)), ((4000, 4000), (1280, 720)), ((1, 1), (1, 1))]
        {
            let fitted = fitted(sampling, room);
            assert_eq!((fitted.width, fitted.height), size, "{room:?}");
        }
    }
}
