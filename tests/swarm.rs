//! A swarm is so many bodies.

use crate::support::{exposed, manifested};
use glam::DVec3;
use std::f64::consts::PI;
use terrell::error::Report;
use terrell::manifest::Placement;
use terrell::scene::compose;

fn scene(bodies: &str) -> String {
    format!(
        "{{ light_speed: 1 m/s, assets: {{ die: {{ box: {{ size: 1 2 0.5 m }} }} }}, bodies: {bodies}, \
         lights: [{{ sun: {{ illuminance: 300 lx, direction: -1 -2 -3 }} }}], observer: {{ at: 0 0 12 m }}, output: out }}"
    )
}

fn placements(bodies: &str) -> Vec<Placement> {
    manifested(&scene(bodies)).0.bodies[0].placements()
}

type Bits = ([f64; 3], [f64; 3], [f64; 4]);

fn numbers(one: &Placement) -> Bits {
    (one.at.to_array(), one.velocity.proper().to_array(), one.rotation.to_array())
}

/// The same light, pixel by pixel, as of bodies that are written one by one.
#[test]
fn swarms_are_bodies_written_one_by_one() {
    let swarm = "[{ asset: die, at: 0 1 0 m, at_time: -12 s, rotation: 30 deg about 0 1 0, material: { diffuse: 0.6 }, \
                 swarm: { seed: 3, count: 20, within: 8 6 8 m, speed: 0.6 c } }]";
    let written: Vec<String> = placements(swarm)
        .iter()
        .map(|one| {
            let (x, u, q) = (one.at, one.velocity.proper(), one.rotation);
            format!(
                "{{ asset: die, at: {:e} {:e} {:e} m, at_time: -12 s, velocity: {{ gamma_beta: {:e} {:e} {:e} }}, \
                 rotation: {{ quaternion: {:e} {:e} {:e} {:e} }}, material: {{ diffuse: 0.6 }} }}",
                x.x, x.y, x.z, u.x, u.y, u.z, q.x, q.y, q.z, q.w
            )
        })
        .collect();
    let seen = |bodies: &str| exposed::<8>(&manifested(&scene(bodies)).1, 0.0, (80, 60));
    let (together, apart) = (seen(swarm), seen(&format!("[{}]", written.join(", "))));
    assert!(together.iter().filter(|xyz| xyz.y > 0.0).count() > 300);
    for (a, b) in together.iter().zip(&apart) {
        assert!((a - b).length() <= 1e-9 * b.length(), "{a} {b}");
    }
}

/// Another seed is another swarm; a larger one begins with the smaller; the middle is the body's own place and turn.
#[test]
fn bodies_of_a_swarm_depend_on_seed_and_number_alone() {
    let of = |more: &str, count: u32| -> Vec<Bits> {
        let swarm =
            format!("[{{ asset: die, swarm: {{ {more} count: {count}, within: 4 m, speed: 0.5 c }} }}]");
        placements(&swarm).iter().map(numbers).collect()
    };
    let [few, many, others] = [of("seed: 5,", 10), of("seed: 5,", 30), of("seed: 6,", 10)];
    assert_eq!(few, many[..10]);
    assert!(few.iter().zip(&others).all(|(a, b)| a.0 != b.0 && a.1 != b.1 && a.2 != b.2));
    assert_eq!(of("", 10), of("seed: 1,", 10));
}

/// How far the distribution of some values is from even between 0 and 1 (Kolmogorov's distance).
fn unevenness(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    values.iter().enumerate().fold(0.0, |most, (i, x)| most.max((x - i as f64 / count).abs()))
}

/// Places are even in the box, rapidities even up to the fastest's, directions even on the sphere: of these, and of each axis of a body
/// that is turned at random, each component is even from -1 to 1 (Archimedes), and the angles θ of such turns have the
/// distribution (θ - sin θ)/π.
#[test]
fn bodies_of_a_swarm_are_strewn_evenly() {
    const COUNT: u32 = 100_000;
    let swarm = format!(
        "[{{ asset: die, at: 1 2 3 m, swarm: {{ seed: 9, count: {COUNT}, within: 4 6 8 m, speed: 0.8 c }} }}]"
    );
    let all = placements(&swarm);
    let even = |what: &str, of: &dyn Fn(&Placement) -> f64| {
        // More than that happens once in a thousand times.
        let (off, most) = (unevenness(all.iter().map(of)), 1.95 / f64::from(COUNT).sqrt());
        assert!(off < most, "{what}: {off} > {most}");
    };
    for axis in 0..3 {
        let (middle, side) = ([1.0, 2.0, 3.0][axis], [4.0, 6.0, 8.0][axis]);
        even("place", &|one| (one.at[axis] - middle) / side + 0.5);
        even("direction", &|one| 0.5 + 0.5 * one.velocity.proper().normalize()[axis]);
        for other in [DVec3::X, DVec3::Y, DVec3::Z] {
            even("turn", &|one| 0.5 + 0.5 * (one.rotation * other)[axis]);
        }
    }
    // tanh ln 3 = 0.8.
    even("rapidity", &|one| libm::asinh(one.velocity.proper().length()) / libm::log(3.0));
    even("angle", &|one| {
        let angle = 2.0 * libm::acos(one.rotation.w.abs().min(1.0));
        (angle - libm::sin(angle)) / PI
    });
}

/// Where all rest together aberration can be left out; a swarm does not.
#[test]
fn aberration_of_a_swarm_cannot_be_left_out() {
    let text = scene("[{ asset: die, swarm: { count: 3, within: 4 m, speed: 0.5 c } }]");
    let text = text.replace("output: out", "effects: { aberration: off }, output: out");
    let (path, mut report) = (std::path::Path::new("manifests/swarm.yaml"), Report::default());
    let manifest = terrell::manifest::parse(path, &text, &mut report).unwrap();
    assert!(compose(&manifest, path, &mut report).is_none());
    assert!(report.faults[0].what.contains("move relative to one another"), "{report:?}");
}
