//! The scene of the first chart, as all methods take it.

use glam::{DAffine3, DVec2, DVec3};
use rayon::prelude::*;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use terrell::error::Report;
use terrell::film::Reconstruction;
use terrell::observer::View;
use terrell::scene::{Scene, compose};
use terrell::spacetime::{Poincare, Rest, SightRay};
use terrell::surface::{Colors, Paint, Scatter};
use terrell::trace::Cone;
use terrell::triangles::Triangles;
use terrell::world::Form;

pub const WIDTH: u32 = 192;
pub const HEIGHT: u32 = 108;

/// One mesh of a body.
pub struct Prop {
    pub rest_from_lab: Poincare<Rest>,
    /// Number of the rest frame, and of the body.
    pub number: usize,
    pub body: u32,
    pub triangles: Arc<Triangles>,
    pub rest_from_mesh: DAffine3,
    pub mesh_from_rest: DAffine3,
    /// Paint of each of the mesh's materials.
    pub paints: Vec<Colors>,
}

pub struct Stage {
    pub scene: Scene,
    pub view: View,
    pub props: Vec<Prop>,
}

/// How bodies move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Traffic {
    /// All with one velocity.
    Convoy,
    /// The die another way.
    Crossing,
}

/// The angle to the line of sight (radians) at which light comes with the frequency it had.
fn unshifted_angle(beta: f64) -> f64 {
    let gamma = 1.0 / (1.0 - beta * beta).sqrt();
    libm::acos(((1.0 - 1.0 / gamma) / beta).clamp(-1.0, 1.0))
}

/// The bodies' velocities as a manifest writes them.
fn velocities(beta: f64, traffic: Traffic) -> Vec<(String, String)> {
    let written = |angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        format!("{:.17} 0 {:.17} c", beta * sin, beta * cos)
    };
    let angle = unshifted_angle(beta) + 13.0_f64.to_radians();
    let one = written(angle);
    let other = if traffic == Traffic::Crossing { written(-angle) } else { one.clone() };
    let of = |i: usize| if i == 1 { other.clone() } else { one.clone() };
    (0..4).map(|i| (format!("bodies.{i}.velocity"), of(i))).collect()
}

impl Stage {
    pub fn new(beta: f64, traffic: Traffic) -> Result<Self, Box<dyn Error>> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.yaml");
        let mut report = Report::default();
        let manifest = terrell::manifest::load_with(&path, &velocities(beta, traffic), &mut report);
        let scene = manifest.and_then(|manifest| compose(&manifest, &path, &mut report));
        let Some(scene) = scene else { return Err(format!("{:?}", report.faults).into()) };
        Self::of(scene)
    }

    fn of(scene: Scene) -> Result<Self, Box<dyn Error>> {
        let view = scene.observer.view(0.0, WIDTH, HEIGHT);
        let mut props = Vec::new();
        for (number, rest) in scene.world.frames.iter().enumerate() {
            for placed in &rest.placed {
                let Form::Mesh(triangles) = &placed.form else { return Err("a solid".into()) };
                let materials = triangles.mesh.parts.iter().map(|part| part.material + 1).max().unwrap_or(1);
                let paint = |i: u32| match &scene.surfaces[(placed.surfaces + i) as usize].scatter {
                    Scatter::Diffuse(Paint::Colors(colors)) => Ok(colors.clone()),
                    _ => Err("a surface that is not diffuse"),
                };
                props.push(Prop {
                    rest_from_lab: rest.rest_from_lab,
                    number,
                    body: placed.body,
                    triangles: triangles.clone(),
                    rest_from_mesh: placed.rest_from_form,
                    mesh_from_rest: placed.rest_from_form.inverse(),
                    paints: (0..materials).map(paint).collect::<Result<_, _>>()?,
                });
            }
        }
        Ok(Self { scene, view, props })
    }
}

/// Exposes with a method: the mean over a pixel's samples, as `terrell::exposure` takes it.
pub fn exposed(view: &View, samples: u32, of: impl Fn(&SightRay, Cone) -> DVec3 + Sync) -> Vec<DVec3> {
    let offsets = Reconstruction::default().offsets(samples);
    let share = 1.0 / f64::from(samples);
    let rows = |row: u32| {
        let (offsets, of) = (&offsets, &of);
        (0..WIDTH).into_par_iter().map(move |column| {
            let centre = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let sum: DVec3 = offsets
                .iter()
                .map(|offset| {
                    let (ray, cone) = view.sight(centre + *offset, share.sqrt());
                    of(&ray, cone)
                })
                .sum();
            sum * share
        })
    };
    (0..HEIGHT).into_par_iter().flat_map(rows).collect()
}
