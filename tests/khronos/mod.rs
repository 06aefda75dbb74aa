//! Each feature of glTF's materials, on a small model of its own, against the law that it stands for.
//!
//! The models are made by `tools/khronos/make_models.py`. Light is in R, G, B of D65 white, cd/m².

mod gloss;
mod light;
mod through;
mod veils;

use crate::support::{light_from, look, v};
use glam::DVec3;
use std::f64::consts::PI;
use std::path::Path;
use terrell::color::RGB_FROM_XYZ;
use terrell::error::Report;
use terrell::manifest;
use terrell::scene::{Scene, compose};
use terrell::spacetime::{Event, SightRay};
use terrell::spectrum::Wavelengths;

/// The base of the balls with and without a coat.
const MATT_RED: DVec3 = DVec3::new(0.7, 0.1, 0.05);

/// What each test's lamps have, cd.
const INTENSITY: f64 = 300.0;

/// A model with lamps of white light at some places, and more lines of manifest; `body`: more keys of the body.
fn stage(model: &str, body: &str, lamps: &[DVec3], more: &str) -> Scene {
    let lamp = |at: &DVec3| {
        format!("{{ lamp: {{ intensity: {INTENSITY} cd }}, at: {:?} {:?} {:?} m }}", at.x, at.y, at.z)
    };
    let lamps: Vec<String> = lamps.iter().map(lamp).collect();
    let text = format!(
        "assets: {{ model: models/khronos/{model}.glb }}\nbodies: [{{ asset: model{body} }}]\n\
         lights: [{}]\nobserver: {{}}\noutput: out\n{more}",
        lamps.join(", ")
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/khronos.yaml");
    let mut report = Report::default();
    let manifest = manifest::parse(&path, &text, &mut report);
    let scene = manifest.as_ref().and_then(|manifest| compose(manifest, &path, &mut report));
    assert!(report.faults.is_empty(), "{:?}\n{text}", report.faults);
    scene.unwrap()
}

/// A model in the light of lamps.
fn lit(model: &str, lamps: &[DVec3]) -> Scene {
    stage(model, "", lamps, "")
}

/// The sight ray from an eye toward a place.
fn sight(eye: DVec3, toward: DVec3) -> SightRay {
    light_from(toward, Event::new(0.0, eye))
}

/// What an eye sees toward a place.
fn rgb(scene: &Scene, eye: DVec3, toward: DVec3) -> DVec3 {
    let light = look(scene, &sight(eye, toward));
    *RGB_FROM_XYZ * (Wavelengths::<64>::new().xyz(&light.radiance) + light.lines)
}

/// Every channel is `expected` but for a part `tolerance` of the largest.
#[track_caller]
fn same(got: DVec3, expected: DVec3, tolerance: f64) {
    near_rgb(got, expected, tolerance * expected.abs().max_element());
}

/// The same, but for so many cd/m².
#[track_caller]
fn near_rgb(got: DVec3, expected: DVec3, tolerance: f64) {
    let error = (got - expected).abs().max_element();
    assert!(error <= tolerance, "{got} for {expected}: off by {error:e}");
}

/// What a lamp's light is at a place of a surface: illuminance over π, so that a white matt surface has it for luminance.
fn lambert(place: DVec3, normal: DVec3, lamp: DVec3) -> f64 {
    let way = lamp - place;
    INTENSITY * way.dot(normal).max(0.0) / (way.length() * way.length_squared() * PI)
}

/// GGX with Smith's separable shadowing as glTF's appendix B writes it: `D G / (4 n·l n·v)`.
fn ggx(roughness: f64, normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    let half = (to_light + to_eye).normalize();
    let squared = roughness.powi(4);
    let (l, e, h) = (normal.dot(to_light), normal.dot(to_eye), normal.dot(half));
    let d = squared / (PI * (h * h * (squared - 1.0) + 1.0).powi(2));
    let g = |c: f64| 2.0 * c / (c + (squared + (1.0 - squared) * c * c).sqrt());
    d * g(l) * g(e) / (4.0 * l * e)
}

/// Schlick's formula.
fn schlick(facing: DVec3, grazing: f64, cosine: f64) -> DVec3 {
    facing + (DVec3::splat(grazing) - facing) * (1.0 - cosine).powi(5)
}

/// What a dielectric reflects, by Fresnel's equations.
fn fresnel(cos: f64, n: f64) -> f64 {
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    0.5 * (s * s + p * p)
}

/// A place that faces +z, with the lamp and the eye at angles (degrees) in the plane of x and z, 2 m and 3 m away.
struct Facing {
    place: DVec3,
    lamp: DVec3,
    eye: DVec3,
}

impl Facing {
    fn new(place: DVec3, lamp_angle: f64, eye_angle: f64) -> Self {
        let toward = |degrees: f64| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            v(sin, 0.0, cos)
        };
        Self { place, lamp: place + toward(lamp_angle) * 2.0, eye: place + toward(eye_angle) * 3.0 }
    }

    fn seen(&self, model: &str) -> DVec3 {
        rgb(&lit(model, &[self.lamp]), self.eye, self.place)
    }

    fn to_light(&self) -> DVec3 {
        (self.lamp - self.place).normalize()
    }

    fn to_eye(&self) -> DVec3 {
        (self.eye - self.place).normalize()
    }

    /// The cosine between the half vector and the sight.
    fn cosine(&self) -> f64 {
        (self.to_light() + self.to_eye()).normalize().dot(self.to_eye())
    }

    /// The luminance of a white matt surface.
    fn white(&self) -> f64 {
        lambert(self.place, DVec3::Z, self.lamp)
    }

    /// The luminance of a rough surface that reflects everything: `D V I cosθ / r²`.
    fn shine(&self, roughness: f64) -> f64 {
        ggx(roughness, DVec3::Z, self.to_light(), self.to_eye()) * self.white() * PI
    }
}

/// Angles of lamp and eye: facing both, at the mirror's direction, and not.
const ANGLES: [(f64, f64); 5] = [(0.0, 0.0), (35.0, -35.0), (-60.0, 60.0), (20.0, -40.0), (10.0, 50.0)];
