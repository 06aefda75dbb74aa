//! `terrell check`: every fault, then what the scene needs.

use crate::chart::{Deviation, JUST_NOTICEABLE};
use crate::error::{Error, counted};
use crate::exposure::{Sampling, expose};
use crate::film::Negative;
use crate::manifest::Manifest;
use crate::plan::cost::{self, Cost};
use crate::plan::{Plan, needs};
use crate::render;
use crate::scene::Scene;
use crate::surface::{Scatter, Surface, fade};
use crate::world::{Form, Placed};
use std::path::Path;
use std::time::Instant;

/// Checks a manifest and prints what it needs.
pub(super) fn run(path: &Path, changes: &[(String, String)]) -> Result<(), Error> {
    let began = Instant::now();
    let (manifest, scene, plan) = super::prepare(path, changes, true)?;
    let prepared = began.elapsed().as_secs_f64();
    let cost = cost::estimate(&scene, &plan);
    let mut text = format!("{}: no faults\n", path.display());
    for (what, how_much) in needs(&manifest, &scene, &plan) {
        text += &format!("  {what:<14} {how_much}\n");
    }
    for (what, how_much) in costs(&cost, prepared, plan.exposures.len()) {
        text += &format!("  {what:<14} {how_much}\n");
    }
    text += "how it is rendered, and why\n";
    for needs::Part { name, choice, why } in needs::parts(&scene, &plan) {
        text += &format!("  {name:<14} {choice}: {why}\n");
        if let Some(found) = (name == "spectra").then(|| wavelengths(&scene, &plan)).flatten() {
            text += &format!("  {:<14} {found}\n", "");
        }
    }
    super::print(&text)
}

/// What rendering will cost; `prepared`: the seconds that it takes to read the manifest and its files.
fn costs(cost: &Cost, prepared: f64, pictures: usize) -> [(&'static str, String); 2] {
    let mut parts = vec![format!("{} to read", span(prepared))];
    if cost.metering > 0.0 {
        parts.push(format!("{} to find the brightness", span(cost.metering)));
    }
    if pictures > 1 {
        parts.push(format!("{} each picture", span(cost.picture)));
    }
    let threads = if cost.threads == 1 { "thread" } else { "threads" };
    let all = span(prepared + cost.all);
    let memory = cost.memory.map_or("not known on this system".to_owned(), |bytes| match bytes {
        bytes if bytes < 1e10 => format!("{:.0} MB", bytes / 1e6),
        bytes => format!("{:.0} GB", bytes / 1e9),
    });
    [
        (
            "time",
            format!(
                "about {all} on {} {threads} that have nothing else to do: {}",
                cost.threads,
                parts.join(", ")
            ),
        ),
        ("memory", format!("about {memory}")),
    ]
}

/// Seconds in words.
fn span(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 1.0 => format!("{seconds:.2} s"),
        seconds if seconds < 10.0 => format!("{seconds:.1} s"),
        seconds if seconds < 120.0 => format!("{seconds:.0} s"),
        seconds if seconds < 7200.0 => format!("{:.0} min", seconds / 60.0),
        seconds => format!("{:.1} h", seconds / 3600.0),
    }
}

/// Columns of the small pictures that are tried, and how many of them.
const TRIED_COLUMNS: u32 = 64;
const TRIED: usize = 3;

/// Whether the wavelengths are enough, tried on small pictures; none where they are sure to be.
fn wavelengths(scene: &Scene, plan: &Plan) -> Option<String> {
    let wavelengths = plan.sampling.wavelengths;
    if !(4..64).contains(&wavelengths) || plan.tolerance.is_some() {
        return None;
    }
    let small = Sampling { samples: 1, ..plan.sampling.within(TRIED_COLUMNS) };
    let development = render::development(scene, plan);
    let every = plan.exposures.len().div_ceil(TRIED).max(1);
    let views: Vec<_> = plan.exposures.iter().skip(every / 2).step_by(every).collect();
    let exposed = |wavelengths: u32| -> Vec<Negative> {
        let sampling = Sampling { wavelengths, ..small };
        let view = |tau: f64| scene.observer.view(tau, small.width, small.height);
        views.iter().map(|exposure| expose(scene, &view(exposure.tau), &sampling)).collect()
    };
    let converged = exposed(64);
    let off = |wavelengths: u32| {
        let pictures = exposed(wavelengths);
        let pairs = pictures.iter().zip(&converged);
        pairs.map(|(one, all)| Deviation::between(one, all, &development).shown.p99).fold(0.0, f64::max)
    };
    let own = off(wavelengths);
    let said = format!("with 64 instead 99 in 100 pixels would differ by less than CIEDE2000 {own:.2}");
    if own < JUST_NOTICEABLE {
        return Some(said);
    }
    let enough = [16, 32].into_iter().find(|more| *more > wavelengths && off(*more) < JUST_NOTICEABLE);
    Some(format!("{said}: write `wavelengths: {}`, or `tolerance: 1`", enough.unwrap_or(64)))
}

/// Whether a mirror image is traced in it.
fn mirrors(surface: &Surface) -> bool {
    match &surface.scatter {
        Scatter::Mirror(_) => true,
        Scatter::Metal(polish) => fade(polish.roughness) > 0.0,
        Scatter::Gloss(gloss) => fade(gloss.roughness) > 0.0,
        _ => false,
    }
}

fn glow_needs(shining: usize) -> String {
    match shining {
        0 => "no surface".to_owned(),
        1 => "1 surface: it is seen, and lights nothing else".to_owned(),
        many => format!("{many} surfaces: they are seen, and light nothing else"),
    }
}

fn needs(manifest: &Manifest, scene: &Scene, plan: &Plan) -> Vec<(&'static str, String)> {
    let placed = || scene.world.frames.iter().flat_map(|rest| &rest.placed);
    let mesh = |placed: &Placed| match &placed.form {
        Form::Mesh(triangles) => Some(triangles.clone()),
        Form::Solid(_) => None,
    };
    let shown: usize = placed().filter_map(mesh).map(|triangles| triangles.mesh.triangles.len()).sum();
    let mut meshes: Vec<*const _> =
        placed().filter_map(mesh).map(|triangles| std::sync::Arc::as_ptr(&triangles)).collect();
    meshes.sort_unstable();
    meshes.dedup();
    let surfaces = || scene.surfaces.iter().flat_map(Surface::all);
    let mirrors = surfaces().any(mirrors);
    let shining = surfaces().filter(|surface| surface.glow.is_some()).count();
    let dispersing = scene.media.iter().any(|medium| medium.index.disperses());
    let glass = match (surfaces().any(|surface| matches!(surface.scatter, Scatter::Glass(_))), dispersing) {
        (false, _) => "none",
        (true, false) => "refracts all wavelengths alike",
        (true, true) => "parts the colours: each wavelength is followed by itself",
    };
    let lines = !scene.lines.is_empty();
    let sampling = &plan.sampling;
    let bodies: usize = manifest.bodies.iter().map(crate::manifest::Body::count).sum();
    let frames = counted(scene.world.frames.len(), "rest frame", "rest frames");
    let trees = counted(meshes.len(), "mesh with a tree", "meshes with a tree each");
    let lamps = match scene.lamps.len() {
        1 => "1, with shadows".to_owned(),
        lamps => format!("{lamps}, each with shadows"),
    };
    let mut needs = vec![
        ("bodies", format!("{bodies} in {frames}")),
        ("triangles", format!("{shown} shown, {trees}")),
        ("lamps", lamps),
        ("shining", glow_needs(shining)),
        ("sky", counted(scene.surroundings.len(), "surrounding", "surroundings")),
        ("glass", glass.to_owned()),
        ("mirrors", if mirrors { format!("followed {} deep", scene.depth) } else { "none".to_owned() }),
        (
            "light",
            format!(
                "{} wavelengths{}",
                if plan.tolerance.is_some() && sampling.wavelengths > 3 {
                    "16 to 64".to_owned()
                } else {
                    sampling.wavelengths.to_string()
                },
                if lines { ", and spectral lines carried exactly" } else { "" }
            ),
        ),
        (
            "pictures",
            format!(
                "{} of {} x {}, {}",
                plan.exposures.len(),
                sampling.width,
                sampling.height,
                match plan.tolerance {
                    Some(tolerance) => format!("99 of 100 pixels to CIEDE2000 {tolerance}"),
                    None => counted(sampling.samples as usize, "sample each pixel", "samples each pixel"),
                }
            ),
        ),
        ("files", format!("{}", plan.folder.display())),
    ];
    for film in render::film_paths(plan, plan.exposures.len()) {
        needs.push(("film", format!("{}", film.display())));
    }
    needs
}
