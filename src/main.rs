//! tmp
use glam::*;
use std::sync::Arc;
use terrell::{exposure::*, film::*, lamp::*, mesh::*, observer::*, scene::*, spacetime::*, spectrum::*, surface::*, trace::Effects, triangles::Triangles};
fn quad() -> Mesh {
    Mesh { positions: vec![vec3(-20.,0.,-20.),vec3(20.,0.,-20.),vec3(20.,0.,20.),vec3(-20.,0.,20.)], normals: vec![Vec3::Y;4], triangles: vec![[0,2,1],[0,3,2]], parts: vec![Part{end:2,material:0}], ..Mesh::default() }
}
fn main() {
    let (m, _) = tobj::load_obj(std::env::args().nth(1).unwrap(), &tobj::LoadOptions{triangulate:true,single_index:true,..Default::default()}).unwrap();
    let m = &m[0].mesh;
    let mesh = Mesh { positions: m.positions.chunks(3).map(|c| vec3(c[0],c[1],c[2])).collect(), normals: m.normals.chunks(3).map(|c| vec3(c[0],c[1],c[2])).collect(), triangles: m.indices.chunks(3).map(|c| [c[0],c[1],c[2]]).collect(), parts: vec![Part{end:m.indices.len() as u32/3,material:0}], ..Mesh::default() };
    println!("{} triangles", mesh.triangles.len());
    let t = std::time::Instant::now();
    let tri = Arc::new(Triangles::new(Arc::new(mesh)));
    println!("build {:?}", t.elapsed());
    let mut b = WorldBuilder::default();
    let at = |x: DVec3, v: DVec3| Placement { origin: Event::new(0., x), velocity: Velocity::from_beta(v).unwrap() };
    b.add(0, at(dvec3(-1.,1.,0.), dvec3(0.9,0.,0.)), &tri, DAffine3::IDENTITY, 0);
    b.add(1, at(dvec3(2.,1.,-1.), DVec3::ZERO), &tri, DAffine3::IDENTITY, 0);
    b.add(2, at(DVec3::ZERO, DVec3::ZERO), &Arc::new(Triangles::new(Arc::new(quad()))), DAffine3::IDENTITY, 1);
    let lamp = |x: DVec3| Lamp { rest_from_lab: at(x, DVec3::ZERO).rest_from_lab(), beam: Beam::Point{place: DVec3::ZERO}, source: Source::with_luminous(&Spectrum::BlackBody(5600.), 300.).unwrap() };
    let surf = |r: [f64;3]| Surface { scatter: Scatter::Diffuse(Reflectance::Rgb(r)), glow: None };
    let obs = Observer { worldline: Worldline::new(Event::new(6.,dvec3(0.,1.5,6.)), Velocity::REST, DQuat::IDENTITY, Course::Inertial), aim: Aim::Along(dvec3(0.,-0.1,-1.)), up: DVec3::Y, field_of_view: 1.0, unaberrated: None };
    let scene = Scene { world: b.build(), surfaces: vec![surf([0.8,0.3,0.2]), surf([0.5,0.5,0.4])], lamps: vec![lamp(dvec3(2.,5.,4.)), lamp(dvec3(-3.,4.,3.))], ambient: None, effects: Effects::ALL, depth: 4, observer: obs };
    let view = scene.observer.view(0., 1280, 720);
    let s = Sampling { width: 1280, height: 720, samples: 4, reconstruction: Reconstruction::Gaussian, wavelengths: 16 };
    for _ in 0..3 {
        let t = std::time::Instant::now();
        let n = expose(&scene, &view, &s);
        let el = t.elapsed();
        let white = meter(n.xyz.iter().map(|x| x[1] as f64)).unwrap();
        println!("{:?} white {white}", el);
        let rgb = Development { white }.develop(&n);
        terrell::output::write_png(std::path::Path::new("/tmp/t.png"), &terrell::output::Picture8 { width: 1280, height: 720, rgb: &rgb, text: &[] }).unwrap();
    }
}
