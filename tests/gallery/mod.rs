//! The gallery: its committed manifests, and facts that are measured on what they show.
//!
//! Everything that is expected is worked out here from the numbers that the manifests' comments and the paper say, in the lab
//! and in metres of light travel, by closed forms. Only the scene is the program's.

mod blinking;
mod explained;
mod gate;
mod ours;
mod ours_light;
mod rocket;
mod rotation;
mod shadows;
mod sodium;
mod sun;

use crate::support::v;
use glam::{DVec2, DVec3};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::path::{Path, PathBuf};
use terrell::error::Report;
use terrell::manifest::{self, Manifest};
use terrell::observer::View;
use terrell::plan::{Plan, meaning};
use terrell::scene::{Scene, compose};
use terrell::spacetime::SightRay;
use terrell::spectrum::Wavelengths;
use terrell::trace::Light;

/// Metres of light travel in a nanosecond.
const NS: f64 = 0.299_792_458;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("manifests/gallery")
}

fn manifests() -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = folder().read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    all.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    all.sort();
    all
}

/// A manifest of the gallery, as it is committed.
struct Exhibit {
    manifest: Manifest,
    scene: Scene,
    plan: Plan,
    // Wavelengths take longer to choose than to look at.
    wavelengths: Wavelengths<16>,
}

impl Exhibit {
    fn of(name: &str) -> Self {
        let (exhibit, report) = read(&folder().join(name).with_extension("yaml"));
        assert!(report.faults.is_empty(), "{:?}", report.faults);
        exhibit.unwrap()
    }

    /// A square picture of one exposure.
    fn view(&self, exposure: usize, width: u32) -> View {
        self.scene.observer.view(self.plan.exposures[exposure].tau, width, width)
    }

    fn seen(&self, ray: &SightRay) -> Light<16> {
        self.scene.lit().seen(ray, &self.wavelengths)
    }

    /// Luminance without spectral lines, cd/m².
    fn luminance(&self, ray: &SightRay) -> f64 {
        self.wavelengths.xyz(&self.seen(ray).radiance).y
    }

    /// Whether light of lamps with spectral lines comes along a ray: nothing else here has lines.
    fn shows_lamplight(&self, ray: &SightRay) -> bool {
        self.seen(ray).lines.y > 0.0
    }

    /// The number of the body that a ray meets first.
    fn body(&self, ray: &SightRay) -> Option<u32> {
        self.scene.lit().first(ray).map(|first| first.body)
    }
}

fn read(path: &Path) -> (Option<Exhibit>, Report) {
    let mut report = Report::default();
    let manifest = manifest::load(path, &mut report);
    let scene = manifest.as_ref().and_then(|manifest| compose(manifest, path, &mut report));
    let exhibit = manifest.zip(scene).map(|(manifest, scene)| {
        let plan = Plan::of(&manifest, &scene, path, &mut report);
        meaning::check(&manifest, &scene, &plan, &mut report);
        Exhibit { manifest, scene, plan, wavelengths: Wavelengths::new() }
    });
    (exhibit, report)
}

#[test]
fn every_manifest_of_the_gallery_is_without_fault_or_warning() {
    let all = manifests();
    assert!(all.len() >= 23, "{all:?}");
    all.par_iter().for_each(|path| {
        let (exhibit, report) = read(path);
        let told = report.faults.iter().map(|fault| &fault.what);
        let told: Vec<_> = told.chain(report.warnings.iter().map(|warning| &warning.what)).collect();
        assert!(exhibit.is_some() && told.is_empty(), "{}: {told:?}", path.display());
        let name = path.file_stem().unwrap();
        let output = exhibit.unwrap().plan.folder;
        assert!(output.ends_with(Path::new("out/gallery").join(name)), "{}: {output:?}", path.display());
    });
}

#[test]
fn every_manifest_of_the_gallery_is_in_its_table() {
    let table = std::fs::read_to_string(folder().join("README.md")).unwrap();
    for path in manifests() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(table.contains(&format!("({name})")), "README.md says nothing of {name}");
    }
}

/// A pinhole 90° wide in a square picture, +y up, in axes of its own.
struct Pinhole {
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    half: f64,
}

impl Pinhole {
    fn toward(forward: DVec3, width: u32) -> Self {
        let forward = forward.normalize();
        let right = forward.cross(DVec3::Y).normalize();
        Self { forward, right, up: right.cross(forward), half: 0.5 * f64::from(width) }
    }

    fn direction(&self, pixel: DVec2) -> DVec3 {
        let aside = pixel / self.half - 1.0;
        (self.forward + self.right * aside.x - self.up * aside.y).normalize()
    }

    /// Where in the picture a direction is; none beside it.
    fn pixel(&self, n: DVec3) -> Option<DVec2> {
        let aside = DVec2::new(n.dot(self.right), -n.dot(self.up)) / n.dot(self.forward);
        (n.dot(self.forward) > 0.0 && aside.abs().max_element() < 1.0).then(|| (aside + 1.0) * self.half)
    }
}

/// Aberration: where someone who moves with `beta` sees what is in the direction `n` for who rests.
///
/// ~~~text
/// cos θ' = (cos θ + β) / (1 + β cos θ)        sin θ' = sin θ / (γ (1 + β cos θ))
/// ~~~
fn aberrated(n: DVec3, beta: DVec3) -> DVec3 {
    let speed = beta.length();
    let along = beta / speed;
    let cos = n.dot(along);
    let across = (n - along * cos) * (1.0 - speed * speed).sqrt();
    (along * (cos + speed) + across) / (1.0 + speed * cos)
}

/// Whether a box about `centre` that reaches `half` to each side is between two places.
fn between(centre: DVec3, half: f64, from: DVec3, to: DVec3) -> bool {
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let at = |face: f64| (centre[axis] + face - from[axis]) / (to[axis] - from[axis]);
        enters = enters.max(at(-half).min(at(half)));
        leaves = leaves.min(at(-half).max(at(half)));
    }
    enters < leaves
}

/// The centres of two cubes of side 2 on the floor, as several scenes have them.
const CUBES: [DVec3; 2] = [v(3.0, 1.0, 0.0), v(-3.0, 1.0, 0.0)];

fn a_cube_is_between(from: DVec3, to: DVec3) -> bool {
    CUBES.iter().any(|centre| between(*centre, 1.0, from, to))
}
