//! A scene that another observer writes down as a manifest gives the same picture.

use super::support::{boosted, manifested};
use glam::{DQuat, DVec3};
use std::fmt::Write as _;
use terrell::exposure::expose;
use terrell::spacetime::{Event, Velocity};

/// Where something is, as a manifest says it.
#[derive(Clone, Copy)]
struct Placed {
    origin: Event,
    velocity: Velocity,
    rotation: DQuat,
}

impl Placed {
    fn new(at: [f64; 3], at_time: f64, gamma_beta: [f64; 3], turn: DQuat) -> Self {
        let velocity = Velocity::from_proper(gamma_beta.into());
        Self { origin: Event::new(at_time, at.into()), velocity, rotation: turn }
    }

    fn boosted(&self, by: Velocity) -> Self {
        let (velocity, turn) = boosted::velocity(by, self.velocity);
        Self { origin: boosted::event(by, self.origin), velocity, rotation: turn * self.rotation }
    }

    fn text(&self) -> String {
        let (x, u, q) = (self.origin.x, self.velocity.proper(), self.rotation);
        format!(
            "at: {:e} {:e} {:e} m, at_time: {:e} m, velocity: {{ gamma_beta: {:e} {:e} {:e} }}, \
             rotation: {{ quaternion: {:e} {:e} {:e} {:e} }}",
            x.x, x.y, x.z, self.origin.t, u.x, u.y, u.z, q.x, q.y, q.z, q.w
        )
    }
}

/// Two textured bodies, a mirror and a floor, a lamp and a spot, all with motions of their own, seen from a rocket.
fn manifest_seen_by(by: Option<Velocity>) -> String {
    let turn = |axis: [f64; 3], angle: f64| DQuat::from_axis_angle(DVec3::from(axis).normalize(), angle);
    let put = |placed: Placed| by.map_or(placed, |by| placed.boosted(by)).text();
    let still = DQuat::IDENTITY;
    let mut text = String::from(
        "assets: { monkey: ../assets/monkey.glb, die: ../assets/die.glb, floor: { file: ../assets/studio.glb, node: Floor } }\nbodies:\n",
    );
    let bodies = [
        ("asset: monkey", Placed::new([0.5, 1.0, -0.5], 0.3, [0.8, 0.1, -0.3], turn([0.2, 1.0, 0.1], 0.4))),
        ("asset: die", Placed::new([-1.6, 0.6, 0.4], -0.2, [-0.4, 0.0, 0.5], turn([1.0, 1.0, 0.3], 0.9))),
        (
            "asset: die, name: glass, scale: 3.5 2.2 0.2, material: { mirror: 0.8 }",
            Placed::new([0.3, 1.6, -4.0], 0.0, [0.1, 0.0, 0.3], turn([0.0, 1.0, 0.0], 0.2)),
        ),
        ("asset: floor", Placed::new([0.0, 0.0, 0.0], 0.0, [0.0; 3], still)),
    ];
    for (what, placed) in bodies {
        writeln!(text, "  - {{ {what}, {} }}", put(placed)).unwrap();
    }
    let lamp = Placed::new([1.0, 4.0, 3.0], 0.0, [0.5, 0.0, -0.6], still);
    let spot = Placed::new([-3.0, 4.0, 2.0], 1.0, [0.0, 0.2, 0.0], turn([0.0, 0.0, 1.0], 0.3));
    writeln!(
        text,
        "lights:\n  - {{ lamp: {{ intensity: 300 cd, spectrum: {{ black_body: 5000 K }} }}, {} }}",
        put(lamp)
    )
    .unwrap();
    writeln!(
        text,
        "  - {{ spot: {{ intensity: 400 cd, cone: 70 deg, inner: 50 deg, spectrum: {{ line: 600 nm }} }}, {} }}",
        put(spot)
    )
    .unwrap();
    let eye = Placed::new([0.2, 1.5, 6.0], 2.0, [-0.3, 0.0, 0.4], turn([0.1, 1.0, 0.0], 0.1));
    writeln!(
        text,
        "observer: {{ rocket: {{ acceleration: 0.05 0.02 -0.1 c/s }}, look_at: monkey, {} }}\n\
         light_speed: 1 m/s\nexposures: {{ at: 0.7 s }}\npicture: {{ size: 96 54, samples: 1 }}\noutput: out",
        put(eye)
    )
    .unwrap();
    text
}

fn picture(text: &str) -> Vec<[f32; 3]> {
    let (_, scene, plan) = manifested(text);
    let view = scene.observer.view(plan.exposures[0].tau, plan.sampling.width, plan.sampling.height);
    expose(&scene, &view, &plan.sampling).xyz
}

#[test]
fn manifest_written_by_another_observer_gives_the_same_picture() {
    let ours = picture(&manifest_seen_by(None));
    let bright = ours.iter().map(|xyz| xyz[1]).fold(0.0, f32::max);
    assert!(ours.iter().filter(|xyz| xyz[1] > 1e-3 * bright).count() > ours.len() / 3);
    for by in [[0.3, -0.4, 0.2], [-4.0, 3.0, 5.0]] {
        let theirs = picture(&manifest_seen_by(Some(Velocity::from_proper(by.into()))));
        let differ = |(a, b): (&[f32; 3], &[f32; 3])| {
            (0..3).any(|i| (a[i] - b[i]).abs() > 1e-4 * a[1].max(b[1]).max(1e-6 * bright))
        };
        let edges = ours.iter().zip(&theirs).filter(|pair| differ(*pair)).count();
        assert!(edges * 1000 <= ours.len(), "{edges} of {} pixels differ for {by:?}", ours.len());
    }
}
