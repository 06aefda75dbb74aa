//! Faces in one plane, slivers, and bodies that touch.

use super::sound_picture;
use crate::support::{
    Body, Dice, Eye, Stage, black, built, cube, exposed, first, flat, glowing, is_bright, light_from, soup,
    square, v,
};
use glam::{DAffine3, DQuat, DVec3};
use terrell::scene::Scene;
use terrell::spacetime::{Event, Velocity};

/// Which bodies are seen at places of a face, and whether it is the same a second time.
fn seen(scene: &Scene, place: impl Fn(&mut Dice) -> DVec3) -> Vec<u32> {
    let mut dice = Dice(11);
    let mut found = vec![0; 2];
    for _ in 0..2000 {
        let eye: Event = Event::new(0.0, v(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), 3.0));
        let ray = light_from(place(&mut dice), eye);
        let one = first(scene, &ray);
        assert_eq!(one.body, first(scene, &ray).body);
        found[one.body as usize] += 1;
    }
    found
}

/// Of two faces that are the same to the last digit, at rest together, the first that is told is seen everywhere.
#[test]
fn first_told_of_two_equal_faces_is_seen() {
    let turn = DAffine3::from_quat(DQuat::from_axis_angle(v(0.6, 0.8, 0.0), 0.4));
    for colours in [[1.0, 2.0], [2.0, 1.0]] {
        let plate = |value: f64| Body::new(&built(square()), glowing(flat(value))).mapped(turn);
        let scene = Stage::of(colours.map(plate)).scene();
        let found = seen(&scene, |dice| {
            turn.transform_point3(v(dice.between(-0.9, 0.9), dice.between(-0.9, 0.9), 0.0))
        });
        assert_eq!(found, [2000, 0]);
    }
}

/// Of two faces in one plane, of which one slides, either is seen, by rounding; never what is behind them, never both,
/// and the same every time.
#[test]
fn one_of_two_faces_in_one_plane_is_seen_the_same_every_time() {
    let turn = DQuat::from_axis_angle(v(0.6, 0.8, 0.0), 0.4);
    let plate = |value: f64| {
        Body::new(&built(square()), glowing(flat(value))).sized(9.0).mapped(DAffine3::from_quat(turn))
    };
    let slides = Velocity::from_gamma(3.0, turn * v(0.6, 0.8, 0.0));
    let behind = plate(4.0).at(0.0, turn * v(0.0, 0.0, -1e-6));
    let stage = Stage::of([plate(1.0), plate(2.0).moving(slides), behind]);
    let scene = stage.seen_by(&Eye::at(0.0, v(0.0, 0.0, 4.0)));
    let one = exposed::<8>(&scene, 0.0, (40, 30));
    assert!(one == exposed::<8>(&scene, 0.0, (40, 30)));
    let eye = stage.seen_by(&Eye::at(0.0, v(0.0, 0.0, 4.0)));
    let view = eye.observer.view(0.0, 40, 30);
    for number in 0..1200 {
        let pixel = crate::support::pixel_centre(number, 40);
        assert!(first(&scene, &view.ray(pixel)).body < 2);
    }
    sound_picture(&scene);
}

/// A wall of slivers, 2 m by 2 µm each: no ray passes, at rest and fast, and every place is met where it is.
#[test]
fn wall_of_slivers_of_aspect_1e6_loses_no_ray() {
    let (count, width) = (500, 2e-6);
    let half = 0.5 * f64::from(count) * width;
    let corner = |i: i32, y: f64| v(f64::from(i) * width - half, y, 0.0);
    let corners: Vec<[DVec3; 3]> = (0..count)
        .flat_map(|i| {
            let [a, b, c, d] = [corner(i, -1.0), corner(i + 1, -1.0), corner(i + 1, 1.0), corner(i, 1.0)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let wall = Body::new(&built(soup(&corners)), black());
    let mut dice = Dice(12);
    for gamma in [1.0, 5.0, 1e4] {
        let moves = Velocity::from_gamma(gamma, v(0.6, 0.8, 0.0));
        let put = v(0.0, 0.0, -1.0);
        let scene = Stage::of([wall.clone().mapped(DAffine3::from_translation(put)).moving(moves)]).scene();
        let eye = Eye::at(0.0, DVec3::ZERO).moving(moves);
        for i in 0..6000 {
            let mut place = v(dice.between(-0.98, 0.98) * half, dice.between(-0.99, 0.99), 0.0);
            if i % 2 == 0 {
                // On a seam, as f32 has it.
                place.x = f64::from((corner(i % count, 0.0).x * 0.98) as f32);
            }
            assert!(scene.world.nearest(&eye.sight(put + place)).is_some(), "γ = {gamma}, {place}");
        }
    }
}

/// A cube on a cube that moves otherwise, face on face, before a bright sky: no light passes between them, however the
/// seam is aimed at; but for rays that stay within 64 ε γ of the coordinates of its plane.
#[test]
fn no_light_leaks_between_bodies_that_touch_at_different_speeds() {
    let mut dice = Dice(13);
    let die = built(cube());
    for gamma in [1.5, 10.0, 1e4] {
        for turned in [false, true] {
            let turn = if turned { dice.turn() } else { DQuat::IDENTITY };
            let put = |body: Body, centre: DVec3| {
                body.mapped(DAffine3::from_quat(turn) * DAffine3::from_translation(centre))
            };
            let lower = put(Body::new(&die, black()).stretched(v(50.0, 1.0, 1.0)), v(0.0, -1.0, 0.0));
            let upper = Body::new(&die, black()).stretched(v(50.0 * gamma, 1.0, 1.0));
            let upper = put(upper, v(0.0, 1.0, 0.0)).moving(Velocity::from_gamma(gamma, turn * DVec3::X));
            let sky = crate::support::Heaven::uniform(flat(1.0));
            let scene = Stage::of([lower, upper]).under(sky).scene();
            // Between the roundings of both faces a ray in the seam's own plane may pass, where that is no axis' plane.
            let gap = if turned { 64.0 * f64::EPSILON * gamma * 6.0 } else { 0.0 };
            for _ in 0..4000 {
                let off = [0.0, 1e-15, -1e-15, 1e-13, -1e-13, 1e-9, -1e-9][dice.below(7)];
                let place = turn * v(dice.between(-5.0, 5.0), off, 1.0);
                let height = [0.0, 1e-9, 1e-3, 1.0][dice.below(4)] * dice.between(-1.0, 1.0);
                let eye: Event = Event::new(0.0, turn * v(dice.between(-5.0, 5.0), height, 4.0));
                let leaks = is_bright(&scene, &light_from(place, eye));
                assert!(!leaks || turned && off.abs() <= gap, "γ = {gamma}, {off}, {height}");
            }
        }
    }
}
