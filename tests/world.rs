//! Bodies in many rest frames: which is met, where it is, and which way it faces.

use crate::support::{
    Body, Dice, Stage, angle, black, built, emission_time, first, icosphere, light_from, near, near_vector,
    square, v,
};
use glam::{DAffine3, DMat3, DVec3};
use terrell::spacetime::{Event, SightRay, Velocity};

/// Plates behind one another, each passing the line of sight when the light does: the nearest is seen, in whatever
/// order they are given.
#[test]
fn nearest_body_hides_the_others() {
    let (mut dice, plate) = (Dice(50), built(square()));
    for _ in 0..50 {
        let n = dice.direction();
        let mut plates: Vec<(f64, Body)> = (0..6)
            .map(|i| {
                let distance = 2.0 + 3.0 * f64::from(i) + dice.part();
                let speed = dice.between(0.0, 0.95);
                let facing = n + dice.direction() * 0.3;
                let plate = Body::new(&plate, black()).facing(facing).at(-distance, n * distance);
                (distance, plate.moving(dice.velocity(speed)))
            })
            .collect();
        for _ in 0..6 {
            plates.rotate_left(1);
            let swapped = dice.below(5);
            plates.swap(swapped, 5);
            let scene = Stage::of(plates.iter().map(|(_, plate)| plate.clone())).scene();
            let seen = first(&scene, &light_from(n, Event::ORIGIN));
            let nearest = plates.iter().map(|(distance, _)| *distance).fold(f64::INFINITY, f64::min);
            near(-seen.emission.t, nearest, 1e-9);
            near(plates[seen.body as usize].0, nearest, 0.0);
        }
    }
}

/// Bodies that move alike share a rest frame: each keeps its own place, and its surface.
#[test]
fn bodies_with_one_velocity_keep_their_own_places() {
    let (mut dice, ball) = (Dice(51), built(icosphere(2)));
    let velocity = dice.velocity(0.8);
    let starts: Vec<Event> =
        (0..20).map(|_| Event::new(dice.between(-9.0, 9.0), dice.in_cube() * 20.0)).collect();
    let bodies = starts
        .iter()
        .map(|start| Body::new(&ball, black()).sized(1e-4).at(start.t, start.x).moving(velocity));
    let scene = Stage::of(bodies).scene();
    assert_eq!(scene.world.frames.len(), 1);
    for (number, start) in starts.iter().enumerate() {
        let eye = Event::new(3.0, v(1.0, -2.0, 40.0));
        let path = |t: f64| start.x + velocity.beta() * (t - start.t);
        let emitted = emission_time(eye, path);
        let ray = light_from(path(emitted), eye);
        let seen = first(&scene, &ray);
        assert_eq!(seen.body as usize, number);
        assert_eq!(scene.world.nearest(&ray).unwrap().surface(), number);
        near(seen.emission.t, emitted, 1e-3);
    }
}

/// An ellipsoid's normal is the gradient of its equation, whatever map made it: turned, stretched or mirrored.
#[test]
fn normals_stay_square_to_stretched_and_mirrored_bodies() {
    let (mut dice, ball) = (Dice(52), built(icosphere(5)));
    for _ in 0..60 {
        let stretch = v(dice.between(0.5, 2.0), dice.between(0.5, 2.0), dice.between(-2.0, -0.5));
        let stretch = if dice.part() < 0.5 { stretch } else { stretch.abs() };
        let (turn, before) = (DMat3::from_quat(dice.turn()), DMat3::from_quat(dice.turn()));
        let matrix = turn * DMat3::from_diagonal(stretch) * before;
        let place = dice.in_cube() * 5.0;
        let map = DAffine3::from_mat3_translation(matrix, place);
        let scene = Stage::of([Body::new(&ball, black()).mapped(map)]).scene();
        for _ in 0..20 {
            let n = dice.direction();
            let gradient = matrix.inverse().transpose() * n;
            let on = place + matrix * n;
            // From outside and from inside: always the side that is seen.
            for (eye, side) in [(on + gradient * 0.01, 1.0), (on - matrix * n * 0.3, -1.0)] {
                let ray = light_from(on, Event::new(0.0, eye));
                let spot = scene.world.nearest(&ray).unwrap().spot(&ray);
                near_vector(spot.event.x, on, 2e-2);
                assert!(angle(spot.normal, gradient * side) < 0.02, "{matrix}");
                assert!(angle(spot.facet_normal, gradient * side) < 0.3, "{matrix}");
                near(spot.facet_normal.length(), 1.0, 1e-12);
                near(spot.normal.length(), 1.0, 1e-12);
            }
        }
    }
}

/// Plates of several bodies in one place: the first of them is seen, from wherever, by whichever way it is asked, in one rest frame or in
/// several.
#[test]
fn first_body_is_seen_of_those_at_one_place() {
    let plate = built(square());
    for frames in [1, 2, 9] {
        let put = |number: usize| {
            let away = if number % 3 == 2 { v(0.0, 0.0, 0.5) } else { DVec3::ZERO };
            // Frames that differ by nothing that a ray could tell.
            let velocity = v(1e-30, 0.0, 0.0) * (number % frames) as f64;
            Body::new(&plate, black()).at(0.0, away).moving(Velocity::from_proper(velocity))
        };
        let scene = Stage::of((0..12).map(put)).scene();
        let frames = scene.world.frames.len();
        let mut dice = Dice(53);
        for _ in 0..50 {
            let eye =
                Event::new(0.0, v(dice.between(-3.0, 3.0), dice.between(-3.0, 3.0), -2.0 - dice.part()));
            let rays: Vec<SightRay> =
                (0..16).map(|_| light_from(v(dice.part() - 0.5, dice.part() - 0.5, 0.0), eye)).collect();
            let crowd = scene.world.crowd(eye);
            let together = scene.world.nearest_many(&rays, crowd.as_ref());
            for (ray, together) in rays.iter().zip(together) {
                let alone = scene.world.nearest_from(ray, None, crowd.as_ref()).unwrap();
                let together = together.unwrap();
                assert_eq!((alone.placed.body, alone.s), (together.placed.body, together.s));
                assert_eq!(alone.placed.body, 0, "{frames} frames");
            }
        }
    }
}

/// A plate has two sides; each is the outside to who looks at it.
#[test]
fn plate_is_seen_from_both_sides() {
    let scene = Stage::of([Body::new(&built(square()), black())]).scene();
    for height in [3.0, -3.0] {
        let ray = light_from(v(0.2, 0.1, 0.0), Event::new(0.0, v(0.0, 0.0, height)));
        let spot = scene.world.nearest(&ray).unwrap().spot(&ray);
        near_vector(spot.facet_normal, DVec3::Z * f64::signum(height), 0.0);
        near_vector(spot.normal, DVec3::Z * f64::signum(height), 0.0);
    }
}
