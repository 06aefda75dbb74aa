//! Sight rays that go together have the light that each has by itself, to the bit; and none is asked whether it begins in glass
//! where none can.

use crate::settle::{committed, loaded};
use crate::support::{Body, Dice, Stage, ball, built, diffuse, flat, glass, glowing, icosphere, square, v};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use terrell::exposure::{Sampling, expose};
use terrell::film::Reconstruction;
use terrell::observer::View;
use terrell::scene::Scene;
use terrell::spacetime::{Event, FourVector, SightRay};
use terrell::spectrum::{Index, Wavelengths};
use terrell::trace::{Cone, Light};

const SIZE: (u32, u32) = (48, 27);

fn bits<const N: usize>(light: &Light<N>) -> ([u64; N], [u64; 3]) {
    (light.radiance.map(f64::to_bits), light.lines.to_array().map(f64::to_bits))
}

/// Whether rays of some kind of packets see what each sees; how many see anything.
fn compare(scene: &Scene, view: &View, packets: &[Vec<(SightRay, Cone)>]) -> usize {
    let (lit, rule) = (scene.lit().seen_from(view.tetrad.event), Wavelengths::<8>::new());
    let mut lights = 0;
    for packet in packets {
        let mut told = Vec::new();
        lit.seen_many(packet, &rule, |i, light| told.push((i, bits(&light))));
        let alone = packet.iter().map(|(ray, cone)| lit.seen_within(ray, *cone, &rule));
        for (number, ((i, together), alone)) in told.iter().zip(alone).enumerate() {
            assert_eq!((*i, *together), (number, bits(&alone)));
            lights += usize::from(alone.radiance[4] > 0.0);
        }
        assert_eq!(told.len(), packet.len());
    }
    lights
}

#[test]
fn rays_that_go_together_see_what_each_sees_in_every_manifest() {
    let mut all = committed("manifests");
    all.extend(committed("manifests/gallery"));
    let lights: usize = all
        .par_iter()
        .map(|path| {
            let (scene, plan) = loaded(path, SIZE);
            let view = scene.observer.view(plan.exposures[plan.exposures.len() / 2].tau, SIZE.0, SIZE.1);
            let sight = |(column, row): (u32, u32)| {
                let place = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                view.shows(place).then(|| view.sight(place, 1.0))
            };
            let of = |first: u32, apart: u32| {
                let places =
                    (0..16).map(|i| ((first + i % 4 * apart) % SIZE.0, (first * 7 + i / 4 * apart) % SIZE.1));
                places.filter_map(sight).collect::<Vec<_>>()
            };
            // Near one another, and far apart.
            let packets: Vec<_> = (0..60).map(|i| of(13 * i, if i % 3 == 0 { 5 } else { 1 })).collect();
            compare(&scene, &view, &packets)
        })
        .sum();
    assert!(lights > 10_000, "{lights}");
}

/// A picture is what its samples are, whichever of them go together: all numbers of samples, with a rest in each packet.
#[test]
fn picture_is_the_mean_of_what_each_sample_sees() {
    let (scene, plan) = loaded(&committed("manifests")[0], (21, 11));
    let view = scene.observer.view(plan.exposures[plan.exposures.len() / 2].tau, 21, 11);
    let (lit, rule) = (scene.lit().seen_from(view.tetrad.event), Wavelengths::<8>::new());
    for samples in [1, 3, 5, 16, 20] {
        let reconstruction = Reconstruction::Box;
        let sampling = Sampling { width: 21, height: 11, samples, reconstruction, wavelengths: 8 };
        let picture = expose(&scene, &view, &sampling);
        let spacing = f64::from(samples).recip().sqrt();
        for (number, xyz) in picture.xyz.iter().enumerate() {
            let centre = DVec2::new((number % 21) as f64 + 0.5, (number / 21) as f64 + 0.5);
            let seen = |offset: DVec2| {
                let (ray, cone) = view.sight(centre + offset, spacing);
                let light = lit.seen_within(&ray, cone, &rule);
                rule.xyz(&light.radiance) + light.lines
            };
            let offsets = reconstruction.offsets(samples);
            let mean = offsets.iter().map(|offset| seen(*offset)).sum::<DVec3>() / f64::from(samples);
            let error = (DVec3::from(xyz.map(f64::from)) - mean).abs().max_element();
            assert!(error <= 1e-6 * mean.max_element(), "{samples}, {number}: {xyz:?} {mean}");
        }
    }
}

/// Within glass of one mesh, of a shape, of six plates, and outside of them: what is known beforehand of where rays begin changes nothing.
#[test]
fn light_within_glass_is_the_same_from_an_event_that_is_known() {
    let mut dice = Dice(91);
    let filled = |body: Body| body.filled(Index::Constant(1.5));
    let lamp = Body::new(&built(icosphere(2)), glowing(flat(1.0))).at(0.0, v(0.0, 0.0, -30.0)).sized(9.0);
    let wall = Body::new(&built(square()), diffuse(0.5)).at(0.0, v(0.0, 0.0, -60.0)).sized(60.0);
    let (mut inside, mut outside) = (0, 0);
    for number in 0..40 {
        let velocity = dice.velocity(0.5 * f64::from(number % 2));
        let form = match number % 4 {
            0 | 1 => Body::new(&built(icosphere(3)), glass()),
            _ => Body::of(ball(1.0, DVec3::ZERO), glass()),
        };
        let scene = Stage::of([filled(form).moving(velocity), lamp.clone(), wall.clone()]).scene();
        for _ in 0..50 {
            let event = Event::new(0.0, dice.in_cube() * 2.0);
            let (open, known) = (scene.lit(), scene.lit().seen_from(event));
            let ray = SightRay { event, k: FourVector::new(1.0, dice.direction()) };
            let rule = Wavelengths::<8>::new();
            assert_eq!(bits(&open.seen(&ray, &rule)), bits(&known.seen(&ray, &rule)), "{event:?}");
            *(if known.in_vacuum.is_some() { &mut outside } else { &mut inside }) += 1;
        }
    }
    assert!(inside > 200 && outside > 200, "{inside} {outside}");
}
