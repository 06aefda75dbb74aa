//! The same transport in f32 throughout: boosts, rays, trees and triangles. Light is computed as for the others.

use crate::shade::Found;
use crate::stage::Stage;
use glam::{DAffine3, DVec3, Mat3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use std::time::Duration;
use terrell::spacetime::{FourVector, SightRay};

/// A boost about an event, in f32; γ from γβ, which is the best that f32 can do.
#[derive(Clone, Copy)]
pub struct Boost32 {
    pub u: Vec3,
    pub gamma: f32,
    pub t: f32,
    pub x: Vec3,
}

impl Boost32 {
    pub fn vector(&self, t: f32, x: Vec3) -> (f32, Vec3) {
        let along = self.u.dot(x);
        (self.gamma * t - along, x + self.u * (along / (self.gamma + 1.0) - t))
    }

    pub fn event(&self, t: f32, x: Vec3) -> (f32, Vec3) {
        self.vector(t - self.t, x - self.x)
    }
}

struct Prop32 {
    boost: Boost32,
    linear: Mat3,
    offset: Vec3,
    triangles: Vec<Triangle>,
    tree: CwBvh,
}

/// The bodies in f32.
pub struct Single<'a> {
    stage: &'a Stage,
    props: Vec<Prop32>,
}

fn single(map: &DAffine3) -> (Mat3, Vec3) {
    (map.matrix3.as_mat3(), map.translation.as_vec3())
}

impl<'a> Single<'a> {
    pub fn new(stage: &'a Stage) -> Self {
        let prop = |prop: &crate::stage::Prop| {
            let velocity = prop.rest_from_lab.boost().velocity();
            let u = velocity.proper().as_vec3();
            let origin = prop.rest_from_lab.origin();
            let gamma = (1.0 + u.length_squared()).sqrt();
            let boost = Boost32 { u, gamma, t: origin.t as f32, x: origin.x.as_vec3() };
            let mesh = &prop.triangles.mesh;
            let place = |i: u32| Vec3A::from(mesh.positions[i as usize]);
            let triangle = |t: &[u32; 3]| Triangle { v0: place(t[0]), v1: place(t[1]), v2: place(t[2]) };
            let triangles: Vec<Triangle> = mesh.triangles.iter().map(triangle).collect();
            let tree =
                build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
            let (linear, offset) = single(&prop.mesh_from_rest);
            Prop32 { boost, linear, offset, triangles, tree }
        };
        Self { stage, props: stage.props.iter().map(prop).collect() }
    }

    pub fn meet(&self, ray: &SightRay) -> Option<Found<'a>> {
        let (t, x) = (ray.event.t as f32, ray.event.x.as_vec3());
        let (omega, k) = (ray.k.t as f32, ray.k.x.as_vec3());
        let mut limit = f32::INFINITY;
        let mut nearest = None;
        for (number, prop) in self.props.iter().enumerate() {
            let (_, x) = prop.boost.event(t, x);
            let (omega, k) = prop.boost.vector(omega, k);
            let origin = Vec3A::from(prop.linear * x + prop.offset);
            let mut ray = Ray::new(origin, Vec3A::from(prop.linear * -k), 0.0, limit);
            let mut hit = RayHit::none();
            let test = |ray: &Ray, id: usize| {
                prop.triangles[prop.tree.primitive_indices[id] as usize].intersect(ray)
            };
            if prop.tree.ray_traverse(ray, &mut hit, test) {
                limit = hit.t;
                ray.tmax = hit.t;
                nearest =
                    Some((number, prop.tree.primitive_indices[hit.primitive_id as usize], ray, omega, k));
            }
        }
        let (number, triangle, ray, omega, k) = nearest?;
        let weights = weights(&self.props[number].triangles[triangle as usize], &ray);
        let prop = &self.stage.props[number];
        let k = FourVector::new(f64::from(omega), DVec3::new(f64::from(k.x), f64::from(k.y), f64::from(k.z)));
        Some(Found { facet: prop.facet(triangle), weights, k, s: f64::from(limit), body: prop.body })
    }
}

/// The weights of the second and the third corner.
fn weights(triangle: &Triangle, ray: &Ray) -> (f64, f64) {
    let (e1, e2) = (triangle.v1 - triangle.v0, triangle.v2 - triangle.v0);
    let c = triangle.v0 - ray.origin;
    let r = ray.direction.cross(c);
    let inverse = 1.0 / e1.cross(e2).dot(ray.direction);
    (f64::from(-r.dot(e2) * inverse), f64::from(r.dot(e1) * inverse))
}
