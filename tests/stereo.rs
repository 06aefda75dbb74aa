//! Two eyes: where they are, what each of them sees, how their pictures are put together.

use crate::support::{
    Body, Dice, Eye, Stage, black_body, boosted, built, close, difference, exposed, glowing, icosphere,
    light_from, manifested, near, near_vector, v,
};
use glam::{DVec2, DVec3};
use std::path::Path;
use terrell::error::Report;
use terrell::exposure::{Sampling, expose, expose_settled};
use terrell::film::{Development, Negative, Reconstruction};
use terrell::lens::Lens;
use terrell::manifest;
use terrell::output::read_png;
use terrell::render::{Step, render};
use terrell::scene::Scene;
use terrell::spacetime::Velocity;
use terrell::stereo::{Layout, Side, Stereo, anaglyph};

fn sampling(width: u32, height: u32) -> Sampling {
    Sampling { width, height, samples: 4, reconstruction: Reconstruction::default(), wavelengths: 8 }
}

fn eyes(apart: f64, layout: Layout) -> Eye {
    Eye { stereo: Some(Stereo { apart, layout }), ..Eye::at(0.0, DVec3::ZERO) }
}

fn balls() -> Stage {
    let mut dice = Dice(9);
    let ball = |_| {
        let at = v(dice.between(-2.0, 2.0), dice.between(-1.5, 1.5), dice.between(-6.0, -3.0));
        Body::new(&built(icosphere(2)), glowing(black_body(dice.between(3000.0, 7000.0))))
            .sized(0.4)
            .at(0.0, at)
    };
    Stage::of((0..12).map(ball))
}

/// The columns of one eye.
fn half(negative: &Negative, side: Side) -> Vec<[f32; 3]> {
    let width = negative.width as usize / 2;
    let from = if side == Side::Left { 0 } else { width };
    negative.xyz.chunks(2 * width).flat_map(|row| row[from..from + width].to_vec()).collect()
}

/// To the last bit, at the seam too, with whatever lens.
#[test]
fn eyes_that_are_not_apart_see_what_one_eye_sees() {
    for lens in [Lens::Pinhole { across: 1.0 }, Lens::Fisheye { across: 3.0 }] {
        let moving = |eye: Eye| Eye { lens, ..eye.moving(Velocity::from_beta(v(0.4, 0.1, -0.5)).unwrap()) };
        let one = balls().seen_by(&moving(Eye::at(0.0, DVec3::ZERO)));
        let alone = expose(&one, &one.observer.view(0.3, 40, 30), &sampling(40, 30));
        let two = balls().seen_by(&moving(eyes(0.0, Layout::SideBySide)));
        let both = expose(&two, &two.observer.view(0.3, 80, 30), &sampling(80, 30));
        assert!(alone.xyz.iter().filter(|xyz| xyz[1] > 0.0).count() > 5);
        for side in Side::BOTH {
            assert_eq!(half(&both, side), alone.xyz, "{side:?}");
        }
        // Under a tolerance pixels share what is measured, but not from one eye to the other.
        let development = Development::new(100.0, 1.0);
        let settled = |scene: &Scene, width: u32| {
            let view = scene.observer.view(0.3, width, 30);
            expose_settled(&scene.lit(), &view, &sampling(width, 30), &development, 3.0)
        };
        let (alone, both) = (settled(&one, 40), settled(&two, 80));
        for side in Side::BOTH {
            assert_eq!(half(&both.negative, side), alone.negative.xyz, "{side:?}");
        }
        close(both.error.mean, alone.error.mean, 1e-12);
        assert_eq!(both.error.p99, alone.error.p99);
    }
}

/// At rest a point at the distance z is at places that are d f/z apart, f being the distance of the picture in pixels.
#[test]
fn disparity_at_rest_is_distance_of_the_eyes_over_that_of_the_point() {
    let (apart, width) = (0.065, 400.0);
    let view = Eye::at(3.0, DVec3::ZERO).wide(70.0).observer().view(0.0, 400, 300);
    let f = 0.5 * width / libm::tan(35.0_f64.to_radians());
    for (place, z) in [(v(0.2, 0.1, -1.0), 1.0), (v(-3.0, 1.0, -8.0), 8.0), (v(0.0, 0.0, -1e6), 1e6)] {
        let [left, right] = Side::BOTH.map(|side| {
            let eye = view.eye(side, apart);
            eye.pixel_of(light_from(place, eye.tetrad.event).k).unwrap()
        });
        near(left.x - right.x, apart * f / z, 1e-9);
        near(left.y, right.y, 1e-9);
    }
}

/// The middles of a small ball in both halves of a picture.
#[test]
fn disparity_is_in_the_picture() {
    let ball =
        Body::new(&built(icosphere(3)), glowing(black_body(5000.0))).sized(0.3).at(0.0, v(0.4, 0.0, -5.0));
    let scene = Stage::of([ball])
        .seen_by(&Eye { lens: Lens::Pinhole { across: 0.8 }, ..eyes(0.5, Layout::SideBySide) });
    let negative = expose(&scene, &scene.observer.view(0.0, 240, 90), &sampling(240, 90));
    let [left, right] = Side::BOTH.map(|side| {
        let xyz = half(&negative, side);
        let light = |number: usize| f64::from(xyz[number][1]);
        let sum: f64 = (0..xyz.len()).map(light).sum();
        (0..xyz.len()).map(|number| light(number) * (number % 120) as f64).sum::<f64>() / sum
    });
    near(left - right, 0.5 * 60.0 / libm::tan(0.4) / 5.0, 0.05);
}

#[test]
fn eyes_are_apart_in_the_observers_rest_frame_and_at_one_time_of_it() {
    let beta = 0.9_f64;
    let gamma = 1.0 / (1.0 - beta * beta).sqrt();
    // It looks across its motion, so that its eyes lie along it: +x is right when it looks along -z.
    let eye = Eye::at(0.0, DVec3::ZERO).moving(Velocity::from_beta(DVec3::X * beta).unwrap());
    let view = eye.observer().view(1.3, 40, 30);
    let [left, right] = Side::BOTH.map(|side| view.eye(side, 0.2).tetrad.event);
    near_vector((right - left).x, DVec3::X * (gamma * 0.2), 1e-13);
    near((right - left).t, gamma * beta * 0.2, 1e-13);
    let mut dice = Dice(3);
    for _ in 0..50 {
        let eye = Eye::at(0.0, dice.in_cube()).moving(dice.velocity(0.9)).toward(dice.direction());
        let view = eye.observer().view(0.7, 40, 30);
        let [left, right] = Side::BOTH.map(|side| view.eye(side, 0.2).tetrad.event);
        near((right - left).dot(view.tetrad.velocity()), 0.0, 1e-12);
        near((right - left).dot(right - left), -0.04, 1e-12);
        let middle = left + (right - left) * 0.5;
        near_vector(middle.x, view.tetrad.event.x, 1e-13);
    }
}

/// At 0.9 c ahead, of a point far away to the front: the disparity is that of its distance in the observer's rest frame.
#[test]
fn disparity_of_a_moving_observer_is_that_of_the_distance_in_its_own_frame() {
    let velocity = Velocity::from_beta(v(0.0, 0.0, -0.9)).unwrap();
    let view = Eye::at(0.0, DVec3::ZERO).moving(velocity).wide(60.0).observer().view(0.0, 400, 300);
    let (apart, z) = (1e-3, 5.0);
    // The light left at -z/c in the lab: in the observer's frame from z sqrt((1 + β)/(1 - β)) away, ahead.
    let far = z * (1.9_f64 / 0.1).sqrt();
    let [left, right] = Side::BOTH.map(|side| {
        let eye = view.eye(side, apart);
        eye.pixel_of(light_from(v(0.0, 0.0, -z), eye.tetrad.event).k).unwrap()
    });
    let f = 200.0 / libm::tan(30.0_f64.to_radians());
    // To the first order in the distance of the eyes: at that moment the point is elsewhere by β of it.
    close(left.x - right.x, apart * f / far, 1e-3);
}

#[test]
fn boosting_the_scene_and_both_eyes_changes_nothing() {
    let mut dice = Dice(17);
    let mut stage = balls();
    stage.bodies.iter_mut().for_each(|body| body.placement.velocity = dice.velocity(0.5));
    let eye = Eye { lens: Lens::Pinhole { across: 1.2 }, ..eyes(0.4, Layout::SideBySide) };
    let eye = Eye { rotation: dice.turn() * glam::DQuat::IDENTITY, ..eye };
    let aim = eye.rotation.inverse() * DVec3::NEG_Z;
    let eye = eye.toward(aim).moving(dice.velocity(0.3));
    let here = exposed::<8>(&stage.seen_by(&eye), 0.2, (96, 36));
    assert!(here.iter().filter(|xyz| xyz.y > 0.0).count() > 200);
    for _ in 0..3 {
        let by = dice.velocity(0.8);
        let there = exposed::<8>(&boosted::stage(by, &stage).seen_by(&boosted::eye(by, &eye)), 0.2, (96, 36));
        let (worst, others) = difference(&here, &there);
        assert!(worst < 1e-4 && others < 12, "{worst} {others}");
    }
}

#[test]
fn each_eye_alone_sees_its_half() {
    let stage = balls();
    let two = stage.seen_by(&eyes(0.3, Layout::SideBySide));
    let both = expose(&two, &two.observer.view(0.0, 80, 30), &sampling(80, 30));
    let apart = stage.seen_by(&eyes(0.3, Layout::LeftRight));
    for side in Side::BOTH {
        let view = apart.observer.view(0.0, 40, 30).eye(side, 0.3);
        assert_eq!(expose(&apart, &view, &sampling(40, 30)).xyz, half(&both, side));
    }
    assert_ne!(half(&both, Side::Left), half(&both, Side::Right));
    // What is asked of a place is asked of the eye whose place it is.
    let view = two.observer.view(0.0, 80, 30);
    assert_eq!(view.direction(DVec2::new(50.0, 7.0)), view.direction(DVec2::new(10.0, 7.0)));
    assert_ne!(view.ray(DVec2::new(50.0, 7.0)).event, view.ray(DVec2::new(10.0, 7.0)).event);
}

#[test]
fn anaglyph_is_red_of_the_left_eye_and_leaves_greys_as_they_are() {
    let to_xyz = |rgb: DVec3| (*terrell::color::XYZ_FROM_RGB * rgb).as_vec3().to_array();
    let negative = |colors: [DVec3; 2]| Negative { width: 2, height: 1, xyz: colors.map(to_xyz).to_vec() };
    let grey = negative([DVec3::splat(3.0), DVec3::splat(0.2)]);
    for (a, b) in anaglyph(&grey, &grey).xyz.iter().flatten().zip(grey.xyz.iter().flatten()) {
        assert!((a - b).abs() < 1e-5 * b, "{a} {b}");
    }
    let dark = negative([DVec3::ZERO; 2]);
    let rgb =
        |negative: &Negative| *terrell::color::RGB_FROM_XYZ * DVec3::from(negative.xyz[0].map(f64::from));
    near_vector(rgb(&anaglyph(&grey, &dark)), v(3.0, 0.0, 0.0), 1e-5);
    near_vector(rgb(&anaglyph(&dark, &grey)), v(0.0, 3.0, 3.0), 1e-5);
}

fn scene(layout: &str) -> String {
    format!(
        "{{ light_speed: 1 m/s, assets: {{ ball: {{ sphere: {{ radius: 0.5 m }} }} }}, bodies: [{{ asset: ball, at: 0 0 -3 m, \
         material: {{ emission: {{ luminance: 50 cd/m2 }} }} }}], observer: {{ stereo: {{ apart: 0.4 m, layout: {layout} }} }}, \
         picture: {{ size: 64 32, samples: 1 }}, output: out }}"
    )
}

#[test]
fn films_of_both_eyes_are_in_folders_of_their_own_and_as_bright() {
    let (_, scene, plan) = manifested(&scene("left_right"));
    let folder = tempfile::tempdir().unwrap();
    let plan = terrell::plan::Plan { folder: folder.path().join("out"), ..plan };
    let mut written = Vec::new();
    let mut whites = Vec::new();
    render(&scene, &plan, 0..1, |step| match step {
        Step::Picture(path, _) => written.push(path),
        Step::Metered(white) => whites.push(white),
        _ => {}
    })
    .unwrap();
    assert_eq!(written, ["left", "right"].map(|side| plan.folder.join(side).join("0000.png")));
    assert!(whites.len() == 2 && whites[0] == whites[1]);
    let [left, right] = [0, 1].map(|side| read_png(&written[side], (64, 32)).unwrap().rgb);
    let middle = |rgb: &[u8]| {
        let lit: Vec<usize> = (0..64).filter(|column| rgb[(16 * 64 + column) * 3] > 100).collect();
        lit.iter().sum::<usize>() as f64 / lit.len() as f64
    };
    let disparity = 0.4 * 32.0 / libm::tan(25.0_f64.to_radians()) / 3.0;
    near(middle(&left) - middle(&right), disparity, 1.0);
}

#[test]
fn pictures_of_both_eyes_in_one_have_what_each_sees() {
    for layout in ["side_by_side", "anaglyph"] {
        let (_, scene, mut plan) = manifested(&scene(layout));
        plan.white = terrell::plan::White::Fixed(1.0);
        let folder = tempfile::tempdir().unwrap();
        let plan = terrell::plan::Plan { folder: folder.path().join("out"), ..plan };
        render(&scene, &plan, 0..1, |_| {}).unwrap();
        let rgb = read_png(&plan.folder.join("0000.png"), (64, 32)).unwrap().rgb;
        let lit = |column: usize, channel: usize| rgb[(16 * 64 + column) * 3 + channel] > 100;
        if layout == "anaglyph" {
            let first = |channel: usize| (0..64).find(|column| lit(*column, channel)).unwrap();
            assert!(first(0) > first(1) + 5 && first(1) == first(2));
            // What is far too bright for one eye is nothing to the other.
            let last = (0..64).rfind(|column| lit(*column, 0)).unwrap();
            let at = |column: usize, channel: usize| rgb[(16 * 64 + column) * 3 + channel];
            assert!(at(first(1), 0) == 0 && at(last, 1) == 0 && at(last, 2) == 0);
        } else {
            let first = |from: usize| (from..from + 32).find(|column| lit(*column, 0)).unwrap() - from;
            assert!(first(0) > first(32) + 2);
        }
    }
}

#[test]
fn eyes_that_cannot_be_are_refused() {
    let refused = |text: &str| {
        let mut report = Report::default();
        assert!(manifest::parse(Path::new("m.yaml"), text, &mut report).is_none());
        assert_eq!(report.faults.len(), 1, "{:?}", report.faults);
        report.faults[0].to_string()
    };
    let panorama = refused(
        "{ observer: { stereo: { apart: 6 cm }, lens: panorama }, picture: { size: 64 32 }, output: out }",
    );
    assert!(panorama.contains("one eye would be behind the other"), "{panorama}");
    let odd = refused("{ observer: { stereo: { apart: 6 cm } }, picture: { size: 65 32 }, output: out }");
    assert!(odd.contains("size: 66 32"), "{odd}");
}
