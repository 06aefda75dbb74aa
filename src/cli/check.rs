//! `terrell check`: every fault, then what the scene needs.

use crate::error::Error;
use crate::manifest::Manifest;
use crate::plan::Plan;
use crate::render;
use crate::scene::Scene;
use crate::surface::{Scatter, Surface};
use crate::world::{Form, Placed};
use std::path::Path;

/// Checks a manifest and prints what it needs.
pub(super) fn run(path: &Path, changes: &[(String, String)]) -> Result<(), Error> {
    let (manifest, scene, plan) = super::prepare(path, changes)?;
    let mut text = format!("{}: no faults\n", path.display());
    for (what, how_much) in needs(&manifest, &scene, &plan) {
        text += &format!("  {what:<14} {how_much}\n");
    }
    super::print(&text)
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
    let mirrors = surfaces().any(|surface| matches!(surface.scatter, Scatter::Mirror(_)));
    let lines = !scene.lines.is_empty();
    let sampling = &plan.sampling;
    let mut needs = vec![
        ("bodies", format!("{} in {} rest frames", manifest.bodies.len(), scene.world.frames.len())),
        ("triangles", format!("{shown} shown, {} meshes with a tree each", meshes.len())),
        ("lamps", format!("{}, each with shadows", scene.lamps.len())),
        ("mirrors", if mirrors { format!("followed {} deep", scene.depth) } else { "none".to_owned() }),
        (
            "light",
            format!(
                "{} wavelengths{}",
                sampling.wavelengths,
                if lines { ", and spectral lines carried exactly" } else { "" }
            ),
        ),
        (
            "pictures",
            format!(
                "{} of {} x {}, {} samples each pixel",
                plan.exposures.len(),
                sampling.width,
                sampling.height,
                sampling.samples
            ),
        ),
        ("files", format!("{}", plan.folder.display())),
    ];
    if let Some(film) = render::film_path(plan, plan.exposures.len()) {
        needs.push(("film", format!("{}", film.display())));
    }
    needs
}
