//! A camera of a model file as the observer: its path by the keys of the file, its turns, its field of view.

use super::Placement;
use super::models::Models;
use crate::error::{Place, Report, by_nearness, nearest_name};
use crate::filmed::Filmed;
use crate::import::{self, Animation, Asset, Interpolation, Moving, Rig};
use crate::lens::Lens;
use crate::manifest::{self, Manifest};
use crate::observer::{Aim, Observer, Unaberrated};
use crate::spacetime::{Course, Event, FourVector, TooFast, Track, Worldline};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Parts into which the way between two keys is divided where it bends.
const DIVIDED: usize = 8;
/// Runs of keys that are told to be too fast one by one.
const MOST_TOLD: usize = 8;

/// What a camera of a file does.
pub(super) struct Shot {
    /// Its path in the starting frame; none where it stays at its place.
    pub(super) track: Option<Arc<Track>>,
    /// Its place at its first key.
    pub(super) place: DAffine3,
    /// How it turns; none where it does not, and nothing else of it moves.
    pub(super) filmed: Option<Arc<Filmed>>,
    /// Its lens for the manifest's pictures.
    pub(super) lens: Lens,
}

impl Shot {
    /// The observer who looks through it.
    pub(super) fn observer(self, written: &manifest::Observer, unaberrated: Option<Unaberrated>) -> Observer {
        let Placement { origin, velocity } = super::placement(&written.placement);
        let rotation = written.placement.rotation;
        let worldline = |origin: Event, course: Course| Worldline::new(origin, velocity, rotation, course);
        let worldline = match self.track {
            Some(track) => worldline(origin, Course::Keyed(track)),
            None => {
                let start = worldline(origin, Course::Inertial).at(0.0);
                let offset = FourVector::new(0.0, self.place.translation);
                worldline(start.event + start.lab_from_camera * offset, Course::Inertial)
            }
        };
        Observer {
            worldline,
            aim: Aim::Along(-self.place.matrix3.z_axis),
            up: self.place.matrix3.y_axis,
            lens: self.lens,
            unaberrated,
            filmed: self.filmed,
            stereo: written.stereo.as_ref().map(manifest::Stereo::eyes),
        }
    }
}

/// The camera that the observer is; none with faults, which are reported.
pub(super) fn shot(
    written: &manifest::Camera,
    manifest: &Manifest,
    models: &Models,
    report: &mut Report,
) -> Option<Shot> {
    let asset = manifest.assets.get(&written.asset.value)?;
    let Some(file) = asset.file() else {
        let what = format!("`{}` is a shape, and has no camera", written.asset.value);
        report.fault(written.asset.place.clone(), what, "name an asset that is a model file");
        return None;
    };
    let asset = models.asset(&file.file.value)?;
    let camera = find(written, asset, report)?;
    let lens = lens(written, camera, manifest, report)?;
    let rig = rig(written, asset, camera.node, report)?;
    let keys = rig.keys();
    let (Some(first), Some(last)) = (keys.first(), keys.last()) else {
        let exposures = &manifest.exposures;
        if exposures.count > 1 && !exposures.timed {
            let what = format!(
                "the camera `{}` is not animated: when are its {} pictures taken?",
                name(asset, camera),
                exposures.count
            );
            report.fault(exposures.place.clone(), what, "from: 0 s, to: 4 s");
        }
        return Some(Shot { track: None, place: rig.at(0.0), filmed: None, lens });
    };
    let pace = written.rate / manifest.light_speed;
    let span = (written.start + first / pace, written.start + last / pace);
    let filmed = Filmed { rig, start: written.start, pace, span };
    let place = filmed.rig.at(*first);
    let track = path(&filmed, &keys).map_err(|(samples, too_fast)| {
        let camera = (&written.place, name(asset, camera));
        too_fast_between(camera, &samples, &too_fast, (written.rate, &keys), report);
    });
    Some(Shot { track: track.ok()?, place, filmed: Some(Arc::new(filmed)), lens })
}

fn name<'a>(asset: &'a Asset, camera: &'a import::Camera) -> &'a str {
    let node = asset.nodes.get(camera.node).map_or("", |node| node.name.as_str());
    if camera.name.is_empty() { node } else { &camera.name }
}

fn find<'a>(written: &manifest::Camera, asset: &'a Asset, report: &mut Report) -> Option<&'a import::Camera> {
    let path = asset.path.display();
    let names: Vec<&str> = asset.cameras.iter().map(|camera| name(asset, camera)).collect();
    let said = written.name.as_ref();
    let is_meant = |camera: &&import::Camera| {
        let node = asset.nodes.get(camera.node).map(|node| node.name.as_str());
        said.is_none_or(|said| camera.name == said.value || node == Some(&said.value))
    };
    let found: Vec<&import::Camera> = asset.cameras.iter().filter(is_meant).collect();
    let (what, hint) = match (found.as_slice(), said) {
        ([one], _) => return Some(one),
        _ if names.is_empty() => {
            (format!("`{path}` has no camera"), "export the model with its cameras".to_owned())
        }
        ([], Some(said)) => {
            let all = by_nearness(&said.value, &names).join(", ");
            let hint = match nearest_name(&said.value, names.iter().copied()) {
                Some(nearest) => format!("did you mean `{nearest}`? its cameras are: {all}"),
                None => format!("its cameras are: {all}"),
            };
            (format!("`{path}` has no camera named `{}`", said.value), hint)
        }
        (_, Some(said)) => {
            let what = format!("{} cameras of `{path}` are named `{}`", found.len(), said.value);
            (what, "give the one meant a name of its own in the model".to_owned())
        }
        (_, None) => {
            let what = format!("`{path}` has {} cameras", names.len());
            (what, format!("name: {} (its cameras are: {})", names[0], names.join(", ")))
        }
    };
    let place = said.map_or(&written.place, |said| &said.place);
    report.fault(place.clone(), what, hint);
    None
}

/// The manifest's lens, with the file's field of view where the manifest gives none.
fn lens(
    written: &manifest::Camera,
    camera: &import::Camera,
    manifest: &Manifest,
    report: &mut Report,
) -> Option<Lens> {
    let observer = &manifest.observer;
    if observer.lens != manifest::Lens::Pinhole || observer.field_of_view.is_some() {
        return Some(observer.optics());
    }
    let Some(vertical) = camera.vertical_fov else {
        let what = format!("the camera `{}` is orthographic: it has no place to look from", camera.name);
        report.fault(
            written.place.clone(),
            what,
            "make it a perspective one, or write field_of_view: 50 deg",
        );
        return None;
    };
    let (width, height) = (manifest.eye_width(), manifest.picture.size.value.1);
    let half = libm::tan(0.5 * vertical) * f64::from(width) / f64::from(height);
    Some(Lens::Pinhole { across: 2.0 * libm::atan(half) })
}

/// The camera with what it hangs on, and the channels that move these.
fn rig(written: &manifest::Camera, asset: &Asset, node: usize, report: &mut Report) -> Option<Rig> {
    let all: Vec<&Animation> = asset.animations.iter().collect();
    let chosen: Vec<&Animation> = match &written.animation {
        None => all,
        Some(named) => all.into_iter().filter(|animation| animation.name == named.value).collect(),
    };
    if let Some(named) = written.animation.as_ref().filter(|_| chosen.is_empty()) {
        let known = asset.animations.iter().map(|animation| animation.name.as_str());
        let hint = match nearest_name(&named.value, known.clone()) {
            Some(nearest) => format!("did you mean `{nearest}`?"),
            None => format!("its animations are: {}", known.collect::<Vec<_>>().join(", ")),
        };
        let what = format!("`{}` has no animation named `{}`", asset.path.display(), named.value);
        report.fault(named.place.clone(), what, hint);
        return None;
    }
    let mut links = Vec::new();
    let mut next = Some(node);
    while let Some(number) = next {
        let node = asset.nodes.get(number)?;
        let of_node = |animation: &&Animation| {
            animation.channels.iter().filter(|channel| channel.node == number).cloned().collect::<Vec<_>>()
        };
        let channels: Vec<_> = chosen.iter().flat_map(of_node).collect();
        for part in [Moving::Translation, Moving::Rotation, Moving::Scale] {
            if channels.iter().filter(|channel| channel.moving == part).count() > 1 {
                let moves = |animation: &&&Animation| {
                    animation.channels.iter().any(|channel| channel.node == number && channel.moving == part)
                };
                let names: Vec<&str> = chosen.iter().filter(moves).map(|a| a.name.as_str()).collect();
                let what = format!("several animations move `{}`: {}", node.name, names.join(", "));
                report.fault(written.place.clone(), what, format!("animation: {}", names.first()?));
                return None;
            }
        }
        links.push((node.pose, channels));
        next = node.parent;
    }
    links.reverse();
    Some(Rig { links })
}

/// Samples of a path: their times in the file, the number of the key before them, and where the camera is.
type Samples = Vec<(f64, usize, DVec3)>;

/// The path through the places at the keys; none where it stays. The error has the samples, by whose numbers pieces go.
fn path(filmed: &Filmed, keys: &[f64]) -> Result<Option<Arc<Track>>, (Samples, Vec<TooFast>)> {
    let sampled = |parts: usize| -> Samples {
        let mut samples = Samples::new();
        for (number, key) in keys.iter().enumerate() {
            samples.push((*key, number, filmed.place(*key)));
            let Some(next) = keys.get(number + 1) else { continue };
            let mut between: Vec<f64> =
                (1..parts).map(|i| key + (next - key) * i as f64 / parts as f64).collect();
            // Where values jump, the places just before say so.
            let jumps = |channel: &import::Channel| {
                channel.interpolation == Interpolation::Step
                    && channel.keys.binary_search_by(|key| key.total_cmp(next)).is_ok()
            };
            if filmed.rig.channels().any(jumps) {
                between.push(next - (next - key) * 1e-6);
            }
            samples.extend(between.into_iter().map(|t| (t, number, filmed.place(t))));
        }
        samples
    };
    let through = |samples: &Samples| {
        let keys: Vec<_> = samples.iter().map(|(t, _, place)| (filmed.time_of(*t), *place)).collect();
        Track::through(&keys)
    };
    let mut samples = sampled(1);
    let mut track = through(&samples);
    if filmed.rig.bends() && !track.as_ref().is_ok_and(|track| follows(track, filmed, keys)) {
        samples = sampled(DIVIDED);
        track = through(&samples);
    }
    let first = samples.first().map_or(DVec3::ZERO, |sample| sample.2);
    if samples.iter().all(|sample| sample.2 == first) {
        return Ok(None);
    }
    track.map(|track| Some(Arc::new(track))).map_err(|too_fast| (samples, too_fast))
}

/// Whether a path through the keys alone is where the file has the camera in between, to a part of the way between keys.
fn follows(track: &Track, filmed: &Filmed, keys: &[f64]) -> bool {
    keys.windows(2).all(|pair| {
        let way = (filmed.place(pair[1]) - filmed.place(pair[0])).length();
        [0.25, 0.5, 0.75].iter().all(|part| {
            let t = pair[0] + (pair[1] - pair[0]) * part;
            (track.at(filmed.time_of(t)).0 - filmed.place(t)).length() <= 0.02 * way
        })
    })
}

/// Says which keys of the file the camera is too fast between, and at what rate it would not be.
fn too_fast_between(
    (place, name): (&Place, &str),
    samples: &Samples,
    too_fast: &[TooFast],
    (rate, keys): (f64, &[f64]),
    report: &mut Report,
) {
    let mut runs: Vec<(usize, usize, f64)> = Vec::new();
    for found in too_fast {
        let key = samples.get(found.piece).map_or(0, |sample| sample.1);
        match runs.last_mut() {
            Some((_, last, speed)) if key <= *last + 1 => {
                *last = key;
                *speed = speed.max(found.speed);
            }
            _ => runs.push((key, key, found.speed)),
        }
    }
    let most = too_fast.iter().map(|found| found.speed).fold(0.0, f64::max);
    let jumps = most > 1e4;
    let slower = 0.95 * rate / most;
    let ten = libm::pow(10.0, 2.0 - libm::floor(libm::log10(slower)));
    let hint = if jumps {
        "it jumps there: let its keys be interpolated (not STEP) in the model".to_owned()
    } else {
        format!("rate: {}", libm::floor(slower * ten) / ten)
    };
    for (first, last, speed) in runs.iter().take(MOST_TOLD) {
        let at = |key: usize| keys.get(key).copied().unwrap_or_default();
        let what = format!(
            "between keys {} and {} of the file ({:.3} s and {:.3} s) the camera `{name}` reaches {speed:.3} c",
            first + 1,
            last + 2,
            at(*first),
            at(last + 1)
        );
        report.fault(place.clone(), what, hint.clone());
    }
    if runs.len() > MOST_TOLD {
        let what = format!("the camera `{name}` is too fast {} times more", runs.len() - MOST_TOLD);
        report.fault(place.clone(), what, hint);
    }
}
