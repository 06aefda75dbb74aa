//! One panorama of the bodies at rest, seen from the camera's event, and warped by aberration.

use crate::shade::Eye;
use crate::stage::{Prop, Stage};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use terrell::spacetime::{FourVector, Poincare, Rest, SightRay};
use terrell::trace::Cone;
use terrell::tree::Line;

/// A panorama, longitude across and latitude down.
///
/// A texel holds the mean paint (premultiplied) and how much of it is covered: in an even light the spectra follow from
/// these exactly, so that nothing but the geometry is in question. Only texels that are looked at are made.
pub struct Panorama<'a> {
    eye: &'a Eye<'a>,
    to_rest: Poincare<Rest>,
    width: usize,
    texels: Vec<[f32; 4]>,
}

/// A mesh where it stands in the panorama's frame.
struct Standing<'a> {
    prop: &'a Prop,
    here_from_mesh: DAffine3,
    mesh_from_here: DAffine3,
}

/// Bodies of the first body's rest frame, and all others where they are just then, as if they rested there too.
fn standing<'a>(stage: &'a Stage, to_rest: &Poincare<Rest>) -> Vec<Standing<'a>> {
    let now = (*to_rest * stage.view.tetrad.event).t;
    let place = |prop: &'a Prop| {
        let origin = *to_rest * prop.rest_from_lab.origin();
        let u: FourVector<Rest> = *to_rest * prop.rest_from_lab.boost().velocity().four();
        let moved = if u.t > 1.0 + 1e-9 { origin.x + u.x / u.t * (now - origin.t) } else { origin.x };
        let here_from_mesh = DAffine3::from_translation(moved) * prop.rest_from_mesh;
        Standing { prop, here_from_mesh, mesh_from_here: here_from_mesh.inverse() }
    };
    stage.props.iter().map(place).collect()
}

impl<'a> Panorama<'a> {
    /// Renders what `samples` per pixel will look at.
    pub fn new(eye: &'a Eye<'a>, width: usize, samples: u32) -> Self {
        let stage = eye.stage;
        let to_rest = stage.scene.world.frames
            [stage.props.iter().find(|p| p.body == 0).map_or(0, |p| p.number)]
        .rest_from_lab;
        let mut panorama = Self { eye, to_rest, width, texels: Vec::new() };
        let wanted: Vec<AtomicBool> = (0..width * width / 2).map(|_| AtomicBool::new(false)).collect();
        crate::stage::exposed(&stage.view, samples, |ray, _| {
            for (texel, _) in panorama.taps((to_rest * ray.k).x) {
                wanted[texel].store(true, Ordering::Relaxed);
            }
            DVec3::ZERO
        });
        let bodies = standing(stage, &to_rest);
        let from = (to_rest * stage.view.tetrad.event).x;
        let texel = |(number, wanted): (usize, &AtomicBool)| {
            if wanted.load(Ordering::Relaxed) { panorama.texel(number, from, &bodies) } else { [0.0; 4] }
        };
        panorama.texels = wanted.par_iter().enumerate().map(texel).collect();
        panorama
    }

    fn texel(&self, number: usize, from: DVec3, bodies: &[Standing<'_>]) -> [f32; 4] {
        let (column, row) = (number % self.width, number / self.width);
        let step = std::f64::consts::TAU / self.width as f64;
        let (sin, cos) = libm::sincos((column as f64 + 0.5) * step);
        let (down, across) = libm::sincos((row as f64 + 0.5) * step);
        let n = DVec3::new(down * sin, across, down * cos);
        let mut nearest = None;
        let mut limit = f64::INFINITY;
        for body in bodies {
            let line = Line {
                origin: body.mesh_from_here.transform_point3(from),
                step: body.mesh_from_here.transform_vector3(n),
            };
            if let Some(met) = body.prop.triangles.nearest(&line, limit) {
                limit = met.s;
                nearest = Some((body, met));
            }
        }
        let Some((body, met)) = nearest else { return [0.0; 4] };
        let mut facet = body.prop.facet(met.triangle);
        facet.corners =
            body.prop.triangles.corners(met.triangle).map(|p| body.here_from_mesh.transform_point3(p));
        let [r, g, b] = facet.rgb(met.weights, -n, 0.5 * step * met.s);
        [r as f32, g as f32, b as f32, 1.0]
    }

    /// The four texels around the direction from which light with the wave vector `k` comes, with their weights.
    fn taps(&self, k: DVec3) -> [(usize, f64); 4] {
        let n = -k / k.length();
        let scale = self.width as f64 / std::f64::consts::TAU;
        let rows = self.width / 2;
        let x = libm::atan2(n.x, n.z) * scale - 0.5;
        let y = libm::acos(n.y.clamp(-1.0, 1.0)) * scale - 0.5;
        let (left, top) = (x.floor(), y.floor());
        let (p, q) = (x - left, y - top);
        let column = |i: f64| (i as i64).rem_euclid(self.width as i64) as usize;
        let row = |i: f64| (i.max(0.0) as usize).min(rows - 1);
        let at = |dx: f64, dy: f64| row(top + dy) * self.width + column(left + dx);
        [
            (at(0.0, 0.0), (1.0 - p) * (1.0 - q)),
            (at(1.0, 0.0), p * (1.0 - q)),
            (at(0.0, 1.0), (1.0 - p) * q),
            (at(1.0, 1.0), p * q),
        ]
    }

    /// XYZ along a sight ray.
    pub fn xyz(&self, ray: &SightRay, _: Cone) -> DVec3 {
        let k = self.to_rest * ray.k;
        let mut sum = [0.0; 4];
        for (texel, weight) in self.taps(k.x) {
            for (sum, value) in sum.iter_mut().zip(self.texels[texel]) {
                *sum += weight * f64::from(value);
            }
        }
        let [r, g, b, covered] = sum;
        let mut xyz = DVec3::ZERO;
        if covered > 0.0 {
            xyz += self.eye.painted([r, g, b], k.t);
        }
        if covered < 1.0 {
            xyz += self.eye.sky(ray) * (1.0 - covered);
        }
        xyz
    }
}
