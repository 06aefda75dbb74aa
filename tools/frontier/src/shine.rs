//! The light of a black body, by ours and by what is commonly done, at any Doppler factor.

use crate::edges::{Curve, GREATEST_GAMMA, decades, panel, series};
use crate::rgb;
use crate::svg::{Panel, Series};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::sync::Arc;
use terrell::color::xyz_of;
use terrell::mesh::Mesh;
use terrell::scene::{Placement, WorldBuilder};
use terrell::spacetime::{Event, FourVector, SightRay, Velocity};
use terrell::spectrum::{Source, Spectrum, Wavelengths, planck};
use terrell::surface::{Glow, Surface};
use terrell::trace::{Effects, Lit};
use terrell::triangles::Triangles;
use terrell::world::Form;

/// The luminance of a glowing body that is seen as a black body of 6500 K, with Doppler factor `doppler`.
fn glow_seen<const N: usize>(doppler: f64, kelvin: f64) -> DVec3 {
    let n = DVec3::NEG_Z;
    let u = DVec3::new(0.0, 0.0, 0.5 * (doppler - 1.0 / doppler));
    let mesh = Mesh {
        positions: vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 2.0, 0.0)],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let form = Form::Mesh(Arc::new(Triangles::new(Arc::new(mesh))));
    let placement = Placement { origin: Event::new(-10.0, n * 10.0), velocity: Velocity::from_proper(u) };
    let mut builder = WorldBuilder::default();
    builder.add(0, placement, &form, DAffine3::IDENTITY, 0);
    let world = builder.build();
    let radiance = Source::new(&Spectrum::BlackBody(kelvin), 1.0);
    let surfaces = [Surface::glowing(Glow { radiance, paint: None })];
    let lit = Lit {
        crowd: None,
        in_vacuum: None,
        world: &world,
        surfaces: &surfaces,
        media: &[],
        lamps: &[],
        ambient: &[],
        surroundings: &[],
        see_through: false,
        footprints: false,
        lines: &[],
        effects: Effects::ALL,
        depth: 1,
        faintest: 0.0,
    };
    let wavelengths = Wavelengths::<N>::new();
    let ray = SightRay { event: Event::ORIGIN, k: FourVector::new(1.0, -n) };
    wavelengths.xyz(&lit.seen(&ray, &wavelengths).radiance)
}

/// Planck's law in SI units and f32.
fn planck32(nm: f32, kelvin: f32) -> f32 {
    let (h, c, k) = (6.626_07e-34_f32, 299_792_460.0_f32, 1.380_649e-23_f32);
    let metres = nm * 1e-9;
    let exponent = h * c / (metres * k * kelvin);
    2.0 * h * c * c / metres.powi(5) / libm::expm1f(exponent) * 1e-9
}

pub fn light_panel() -> Panel {
    let seen = 6500.0;
    let truth = xyz_of(|nm| planck(nm, seen));
    let error = |xyz: DVec3| {
        let off = (xyz - truth).length() / truth.length();
        if off.is_nan() { f64::INFINITY } else { off }
    };
    let powers = |power: i32| move |d: f64| xyz_of(|nm| planck(nm, seen / d)) * d.powi(power);
    let gauss = |d: f64| {
        let units = rgb::NARROW.map(|bell| rgb::bell_xyz(bell, 1.0));
        let weights =
            DMat3::from_cols(units[0], units[1], units[2]).inverse() * xyz_of(|nm| planck(nm, seen / d));
        let moved = rgb::NARROW.map(|bell| rgb::bell_xyz(bell, d));
        DMat3::from_cols(moved[0], moved[1], moved[2]) * weights
    };
    let single = |d: f64| {
        let (d, kelvin) = (d as f32, (seen / d) as f32);
        xyz_of(|nm| f64::from(d.powi(5) * planck32(nm as f32 * d, kelvin)))
    };
    let methods: [Curve<'_, DVec3>; 6] = [
        ("ours, 64 wavelengths", "64", &|d| glow_seen::<64>(d, seen / d)),
        ("ours, 16 wavelengths", "16", &|d| glow_seen::<16>(d, seen / d)),
        ("RGB times D⁵", "D⁵", &powers(5)),
        ("RGB times D⁴", "D⁴", &powers(4)),
        ("three narrow Gaussians, shifted", "3G", &gauss),
        ("Planck's law in f32 and SI units", "f32", &single),
    ];
    let mut stress = decades(-6, 6);
    stress.extend([-0.2, -0.1, -0.03, -0.01, 0.01, 0.03, 0.1, 0.2].map(|power| libm::pow(10.0, power)));
    stress.sort_unstable_by(f64::total_cmp);
    let line = |(i, (name, code, of)): (usize, &Curve<'_, DVec3>)| {
        let points = stress.iter().map(|d| (*d, error(of(*d)))).collect();
        Series { dashed: i == 1, ..series(name, code, i < 2, i.wrapping_sub(2), points) }
    };
    let lines = methods.iter().enumerate().map(line).collect();
    panel(
        "Light of a body that is seen as 6500 K",
        "Doppler factor",
        "relative error of XYZ",
        (1e-6, 1e6),
        (1e-6, 1e6),
        lines,
    )
    .guaranteed(2.0 * GREATEST_GAMMA, "ours: 5e-9 to 2e8")
}
