//! Light where a method has met something: the same for all methods, and our own.

use crate::stage::{Prop, Stage};
use glam::{DVec2, DVec3};
use terrell::spacetime::{FourVector, Rest, SightRay};
use terrell::spectrum::{Reflectance, Wavelengths};
use terrell::surface::Colors;
use terrell::texture::Footprint;
use terrell::trace::Cone;

/// Wavelengths with which rivals are given their light.
pub const N: usize = 16;

/// A triangle in the rest frame of its body.
pub struct Facet<'a> {
    pub corners: [DVec3; 3],
    pub uvs: Option<[DVec2; 3]>,
    pub paint: &'a Colors,
}

/// What a method has met.
pub struct Found<'a> {
    pub facet: Facet<'a>,
    pub weights: (f64, f64),
    /// The wave vector at the body, frequency 1 at the observer.
    pub k: FourVector<Rest>,
    pub s: f64,
    pub body: u32,
}

impl Prop {
    pub fn facet(&self, triangle: u32) -> Facet<'_> {
        let mesh = &self.triangles.mesh;
        let indices = mesh.triangles[triangle as usize];
        let uvs = &mesh.uvs[0];
        Facet {
            corners: self.triangles.corners(triangle).map(|p| self.rest_from_mesh.transform_point3(p)),
            uvs: (!uvs.is_empty()).then(|| indices.map(|i| uvs[i as usize].as_dvec2())),
            paint: &self.paints[mesh.material_of(triangle) as usize],
        }
    }
}

impl Facet<'_> {
    /// The linear sRGB of the paint, averaged over what a sample sees.
    pub fn rgb(&self, (v, w): (f64, f64), k: DVec3, radius: f64) -> [f64; 3] {
        let mut rgb = self.paint.color.map(f64::from);
        if let (Some(texture), Some([a, b, c])) = (&self.paint.texture, self.uvs) {
            let uv = a + (b - a) * v + (c - a) * w;
            let texel = match self.footprint(k, radius, [b - a, c - a]) {
                Some(footprint) => texture.over(uv, &footprint),
                None => texture.rgba(uv),
            };
            for (channel, texel) in rgb.iter_mut().zip(texel) {
                *channel *= f64::from(texel);
            }
        }
        rgb
    }

    /// What a sample sees of the surface, in texture coordinates.
    fn footprint(&self, k: DVec3, radius: f64, [d1, d2]: [DVec2; 2]) -> Option<Footprint> {
        let [p, q, r] = self.corners;
        let (e1, e2) = (q - p, r - p);
        let normal = e1.cross(e2).try_normalize()?;
        let cosine = (k.dot(normal) / k.length()).abs().max(1e-6);
        let along = (k - normal * k.dot(normal)).try_normalize()?;
        let (a, b, c) = (e1.dot(e1), e1.dot(e2), e2.dot(e2));
        let det = a * c - b * b;
        if !(radius > 0.0 && det > 0.0) {
            return None;
        }
        let solve = |v: DVec3| {
            let (p, q) = (v.dot(e1), v.dot(e2));
            (d1 * (c * p - b * q) + d2 * (a * q - b * p)) / det
        };
        Some(Footprint { u: solve(normal.cross(along) * radius), v: solve(along * (radius / cosine)) })
    }
}

impl Found<'_> {
    pub fn rgb(&self, cone: Cone) -> [f64; 3] {
        self.facet.rgb(self.weights, self.k.x, cone.sample * self.s)
    }
}

/// Light and eye.
pub struct Eye<'a> {
    pub stage: &'a Stage,
    pub wavelengths: Wavelengths<N>,
}

impl<'a> Eye<'a> {
    pub fn new(stage: &'a Stage) -> Self {
        Self { stage, wavelengths: Wavelengths::new() }
    }

    /// XYZ of what is met, or of the sky.
    pub fn xyz(&self, ray: &SightRay, cone: Cone, found: Option<&Found<'_>>) -> DVec3 {
        match found {
            Some(found) => self.painted(found.rgb(cone), found.k.t),
            None => self.sky(ray),
        }
    }

    /// XYZ of a paint in the bodies' even light, which has the frequency `omega` there.
    pub fn painted(&self, rgb: [f64; 3], omega: f64) -> DVec3 {
        let nm = self.wavelengths.nm.map(|nm| nm / omega);
        let reflectance = if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            Reflectance::Constant(rgb[0])
        } else {
            Reflectance::Rgb(rgb)
        };
        let mut light = reflectance.at_each(&nm);
        let ambient = self.stage.scene.ambient[0].at_each(&nm);
        let gain = omega.powi(-5);
        for (light, ambient) in light.iter_mut().zip(ambient) {
            *light *= ambient * gain;
        }
        self.wavelengths.xyz(&light)
    }

    /// XYZ of the sky.
    pub fn sky(&self, ray: &SightRay) -> DVec3 {
        let sky = &self.stage.scene.surroundings[0];
        let k: FourVector<Rest> = sky.rest_from_lab * ray.k;
        let nm = self.wavelengths.nm.map(|nm| nm / k.t);
        let radiance = sky.sky.radiance(-k.x / k.x.length(), (0.0, 0.0), &nm);
        self.wavelengths.xyz(&radiance.map(|value| value * k.t.powi(-5)))
    }
}
