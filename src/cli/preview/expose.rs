//! The work of a preview: a manifest read, and one exposure of it from coarse to fine.

use super::{News, Picture};
use crate::cli::watch::FilesRead;
use crate::cli::{RenderArgs, chosen, prepared, warnings};
use crate::error::{Error, Report};
use crate::exposure::{Grain, Sampling, expose_coarse_to_fine, expose_settled_until};
use crate::film::{self, Brightness, Development, Negative};
use crate::observer::{Observer, View};
use crate::plan::Plan;
use crate::render;
use crate::scene::Scene;
use crate::stereo::{self, Layout, Stereo};
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
    let index = (range.start + range.end - 1) / 2;
    let eyes = scene.observer.stereo.map(|eyes| eyes.layout);
    let (answer, room) = channel();
    let full =
        (if eyes == Some(Layout::LeftRight) { 2 } else { 1 } * plan.sampling.width, plan.sampling.height);
    let coming = News::Size { size: full, exposure: index, answer };
    let Ok(room) = news.send(coming).map_err(|_| ()).and_then(|()| room.recv().map_err(|_| ())) else {
        return Ok(()); // Nobody looks.
    };
    let preview = Preview {
        name: path.file_name().unwrap_or_default().display().to_string(),
        index,
        sampling: traced(plan.sampling, eyes, room),
        anaglyph: eyes == Some(Layout::Anaglyph),
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

/// What is traced so that it fits into the room: of two eyes always one beside the other, however they are shown.
fn traced(sampling: Sampling, eyes: Option<Layout>, room: (u32, u32)) -> Sampling {
    let Some(layout) = eyes else { return fitted(sampling, room) };
    let width = if layout == Layout::SideBySide { (sampling.width / 2).max(1) } else { sampling.width };
    let room = if layout == Layout::Anaglyph { room } else { (room.0 / 2, room.1) };
    let eye = fitted(Sampling { width, ..sampling }, room);
    Sampling { width: 2 * eye.width, ..eye }
}

/// The view of one eye, or of two beside one another.
fn view(scene: &Scene, tau: f64, sampling: &Sampling) -> View {
    let stereo = scene.observer.stereo.map(|eyes| Stereo { layout: Layout::SideBySide, ..eyes });
    Observer { stereo, ..scene.observer.clone() }.view(tau, sampling.width, sampling.height)
}

/// What is shown of what was traced: of an anaglyph both halves in one.
fn shown(negative: &Negative, development: &Development, anaglyph: bool) -> Picture {
    let (width, height) = (negative.width, negative.height);
    if !anaglyph {
        return Picture { width, height, rgb: development.develop(negative) };
    }
    let columns = (width / 2).max(1) as usize;
    let both = |pixel: usize| {
        let left = pixel / columns * width as usize + pixel % columns;
        stereo::shown([left, left + columns].map(|of_eye| development.shown(negative, of_eye)))
    };
    Picture { width: width / 2, height, rgb: film::encode(columns * height as usize, both) }
}

struct Preview<'p> {
    name: String,
    index: usize,
    // What is traced; of an anaglyph twice as wide as what is shown.
    sampling: Sampling,
    anaglyph: bool,
    started: Instant,
    news: &'p Sender<News>,
    stop: &'p Stop,
}

impl Preview<'_> {
    /// Shows the exposure pass by pass. None if it was stopped.
    fn exposed(&self, scene: &Scene, plan: &Plan) -> Option<()> {
        let exposure = if plan.still { &plan.exposures[0] } else { &plan.exposures[self.index] };
        let view = view(scene, exposure.tau, &self.sampling);
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
        let picture = shown(negative, development, self.anaglyph);
        let seconds = self.started.elapsed().as_secs_f64();
        let line = format!(
            "{}, exposure {}, {} x {}: {said}, {seconds:.2} s",
            self.name, self.index, picture.width, picture.height
        );
        let _ = self.news.send(News::Picture(picture, line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Reconstruction;
    use crate::manifest;
    use crate::output::read_png;
    use crate::scene::compose;

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

    #[test]
    fn two_eyes_have_room_beside_one_another_or_in_one_picture() {
        let sampling = Sampling {
            width: 640,
            height: 360,
            samples: 4,
            reconstruction: Reconstruction::default(),
            wavelengths: 16,
        };
        for (layout, size) in [
            (None, (320, 180)),
            // Each half is of half the manifest's width.
            (Some(Layout::SideBySide), (320, 180)),
            // Two pictures of the manifest's shape.
            (Some(Layout::LeftRight), (320, 90)),
            // Two for one that has all of the room.
            (Some(Layout::Anaglyph), (640, 180)),
        ] {
            let traced = traced(sampling, layout, (320, 1000));
            assert_eq!((traced.width, traced.height), size, "{layout:?}");
        }
        assert_eq!(traced(sampling, Some(Layout::SideBySide), (1, 1)).width, 2);
    }

    /// A picture as a preview shows it when it is done, and as the film has it.
    fn both(layout: &str) -> (Vec<u8>, Vec<Vec<u8>>) {
        let text = format!(
            "{{ assets: {{ a: {{ sphere: {{ radius: 0.5 m }} }} }}, bodies: [{{ asset: a, velocity: 0.5 0 0 c }}],
              ambient: {{ luminance: 20 cd/m2 }}, picture: {{ size: 20 12, white: 40 cd/m2, headroom: 2 }},
              observer: {{ at: 0 0 3 m, stereo: {{ apart: 40 cm, layout: {layout} }} }}, output: out }}"
        );
        let mut report = Report::default();
        let manifest = manifest::parse("m.yaml".as_ref(), &text, &mut report).unwrap();
        let scene = compose(&manifest, "m.yaml".as_ref(), &mut report).unwrap();
        let mut plan = Plan::of(&manifest, &scene, "m.yaml".as_ref(), &mut report);
        assert_eq!(report.faults, []);
        let folder = tempfile::tempdir().unwrap();
        plan.folder = folder.path().join("out");
        let mut files = Vec::new();
        let tell = |step| {
            if let render::Step::Picture(path, _) = step {
                files.push(path);
            }
        };
        render::render(&scene, &plan, 0..1, tell).unwrap();
        let film = files.iter().map(|path| read_png(path, (20, 12)).unwrap().rgb).collect();
        let eyes = scene.observer.stereo.map(|eyes| eyes.layout);
        let (news, inbox) = channel();
        let preview = Preview {
            name: String::new(),
            index: 0,
            sampling: traced(plan.sampling, eyes, (100, 100)),
            anaglyph: eyes == Some(Layout::Anaglyph),
            started: Instant::now(),
            news: &news,
            stop: &Stop::never(),
        };
        preview.exposed(&scene, &plan).unwrap();
        let shown = inbox.try_iter().filter_map(|news| match news {
            News::Picture(picture, _) => Some(picture.rgb),
            _ => None,
        });
        (shown.last().unwrap(), film)
    }

    #[test]
    fn a_preview_of_two_eyes_ends_as_what_both_see() {
        for layout in ["side_by_side", "anaglyph"] {
            let (shown, film) = both(layout);
            assert!(film == [shown], "{layout}");
        }
        let (shown, film) = both("left_right");
        assert!(film.len() == 2 && film[0] != film[1]);
        let rows =
            film[0].chunks(60).zip(film[1].chunks(60)).flat_map(|(left, right)| [left, right].concat());
        assert!(shown == rows.collect::<Vec<u8>>());
    }
}
