//! Trees find what trying every triangle finds, at every size, and nothing slips through a closed mesh.

use crate::support::{
    Body, Dice, Stage, angle, black, built, cube, icosphere, light_at_rest, light_from, near, soup, speed, v,
};
use glam::{DAffine3, DMat3, DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use proptest::prelude::{ProptestConfig, Strategy, prop, prop_assert, prop_assert_eq, proptest};
use std::sync::Arc;
use std::time::{Duration, Instant};
use terrell::mesh::Mesh;
use terrell::spacetime::Event;
use terrell::tree::{Bounds, Line, Tree};
use terrell::triangles::Triangles;

/// Möller and Trumbore 1997: s, and how far inside the triangle (below zero: outside).
fn meets(line: &Line, [a, b, c]: [DVec3; 3]) -> Option<(f64, f64)> {
    let (ab, ac) = (b - a, c - a);
    let across = line.step.cross(ac);
    let volume = ab.dot(across);
    let from = line.origin - a;
    let (u, v) = (from.dot(across) / volume, line.step.dot(from.cross(ab)) / volume);
    let s = ac.dot(from.cross(ab)) / volume;
    s.is_finite().then_some((s, u.min(v).min(1.0 - u - v)))
}

/// The nearest s by trying every triangle, and whether that is in doubt: if an edge or the start is grazed.
fn tried(triangles: impl IntoIterator<Item = [DVec3; 3]>, line: &Line) -> (Option<f64>, bool) {
    let (mut nearest, mut doubtful) = (None, false);
    for (s, inside) in triangles.into_iter().filter_map(|triangle| meets(line, triangle)) {
        doubtful |= inside.abs() < 1e-6 || (inside > 0.0 && s.abs() * line.step.length() < 1e-9);
        if inside > 0.0 && s > 0.0 {
            nearest = Some(nearest.map_or(s, |n: f64| n.min(s)));
        }
    }
    (nearest, doubtful)
}

/// The corners of a mesh's triangles.
fn corners_of(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|i| mesh.positions[i as usize].as_dvec3()))
}

fn triangles() -> impl Strategy<Value = Vec<[DVec3; 3]>> {
    let corner = || prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from);
    let triangle = (corner(), corner(), corner(), -3.0..0.0_f64).prop_map(|(place, a, b, size)| {
        let size = libm::exp(2.0 * size);
        [place, place + a * size, place + b * size]
    });
    prop::collection::vec(triangle, 1..60)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn tree_equals_trying_every_triangle(corners in triangles(), seed in 0..u64::MAX, size in -6.0..6.0_f64, far in 0.0..4.0_f64) {
        let size = libm::pow(10.0, size);
        let mut dice = Dice(seed);
        let middle = dice.direction() * (libm::pow(10.0, far) - 1.0);
        let corners: Vec<_> = corners.iter().map(|t| t.map(|p| (p + middle) * size)).collect();
        let mesh = soup(&corners);
        let tree = built(mesh.clone());
        for _ in 0..50 {
            let target = (dice.in_cube() + middle) * size;
            let start = (dice.in_cube() * 3.0 + middle) * size;
            let line = Line { origin: start, step: (target - start) * libm::pow(10.0, dice.between(-3.0, 3.0)) };
            let (expected, doubtful) = tried(corners_of(&mesh), &line);
            if doubtful {
                continue;
            }
            let found = tree.nearest(&line, f64::INFINITY).map(|meeting| meeting.s);
            prop_assert_eq!(found.is_some(), expected.is_some());
            prop_assert_eq!(tree.any(&line, f64::INFINITY), expected.is_some());
            if let (Some(found), Some(expected)) = (found, expected) {
                prop_assert!((found / expected - 1.0).abs() < 1e-7, "{found} for {expected}");
                // The limit is kept to.
                prop_assert!(tree.nearest(&line, expected * (1.0 - 1e-7)).is_none());
                prop_assert!(!tree.any(&line, expected * (1.0 - 1e-7)));
                prop_assert!(tree.any(&line, expected * (1.0 + 1e-7)));
            }
        }
    }

    #[test]
    fn instances_meet_lines_as_the_transformed_mesh_does(corners in triangles(), seed in 0..u64::MAX) {
        let mut dice = Dice(seed);
        let matrix = DMat3::from_cols(dice.in_cube(), dice.in_cube(), dice.in_cube());
        let map = DAffine3::from_mat3_translation(matrix, dice.in_cube() * 5.0);
        if matrix.determinant().abs() < 0.02 {
            return Ok(());
        }
        let mesh = soup(&corners);
        let moved = Stage::of([Body::new(&built(mesh.clone()), black()).mapped(map)]).scene();
        for _ in 0..50 {
            let target = map.transform_point3(dice.in_cube());
            let eye = Event::new(0.0, target + dice.direction() * dice.between(0.5, 20.0));
            let ray = light_from(target, eye);
            let line = Line { origin: eye.x, step: -ray.k.x };
            let moved_corners = corners_of(&mesh).map(|triangle| triangle.map(|p| map.transform_point3(p)));
            let (nearest, doubtful) = tried(moved_corners, &line);
            if doubtful {
                continue;
            }
            let hit = moved.world.nearest(&ray);
            prop_assert_eq!(hit.map(|hit| hit.s).is_some(), nearest.is_some());
            prop_assert_eq!(moved.world.blocked(&ray, None, f64::INFINITY, None), nearest.is_some());
            if let (Some(hit), Some(nearest)) = (hit, nearest) {
                prop_assert!((hit.s / nearest - 1.0).abs() < 1e-7);
                let spot = hit.spot(&ray);
                prop_assert!((spot.event.x - ray.at(nearest).x).length() < 1e-6);
                // The normal is square to the transformed triangle, on the eye's side.
                prop_assert!(spot.facet_normal.dot(ray.k.x) > 0.0);
            }
        }
    }
}

/// obvhs's own walk, on rays on which it is to be trusted (no small components).
#[test]
fn tree_equals_the_builders_own_walk() {
    let mut dice = Dice(1);
    let corners: Vec<[DVec3; 3]> = (0..3000)
        .map(|_| {
            let place = dice.in_cube();
            [place, place + dice.in_cube() * 0.05, place + dice.in_cube() * 0.05]
        })
        .collect();
    let tree = built(soup(&corners));
    let point = |p: DVec3| Vec3A::from(p.as_vec3());
    let theirs: Vec<Triangle> =
        corners.iter().map(|t| Triangle { v0: point(t[0]), v1: point(t[1]), v2: point(t[2]) }).collect();
    let mut elapsed = Duration::ZERO;
    let bvh = build_bvh2(&theirs, BvhBuildParams::medium_build(), &mut elapsed);
    let (mut both, mut apart) = (0, 0);
    for _ in 0..20_000 {
        let (origin, step) = (dice.direction() * 4.0, dice.direction());
        let step = (dice.in_cube() - origin) * (0.5 + 0.1 * step.x);
        let step = step / step.length();
        if step.abs().min_element() < 0.01 {
            continue;
        }
        let ray = Ray::new_inf(point(origin), point(step));
        let mut hit = RayHit::none();
        let met = bvh
            .ray_traverse(ray, &mut hit, |ray, id| theirs[bvh.primitive_indices[id] as usize].intersect(ray));
        let found = tree.nearest(&Line { origin, step }, f64::INFINITY);
        if met && let Some(found) = found {
            both += 1;
            near(f64::from(hit.t), found.s, 1e-4);
        }
        apart += u32::from(met != found.is_some());
    }
    // They may disagree on rays that graze an edge.
    assert!(both > 3000 && apart < 20, "{both} {apart}");
}

/// The edges of a mesh, as pairs of vertices.
fn edges(mesh: &Mesh) -> Vec<(DVec3, DVec3)> {
    corners_of(mesh).flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]).collect()
}

/// 200,000 rays each from inside a closed ball at its vertices and edges, exactly and nearly: none gets out.
#[test]
fn nothing_gets_out_of_a_closed_ball_of_any_size() {
    let ball = icosphere(4);
    let seams = edges(&ball);
    let ball = built(ball);
    for (size, far) in
        [(1e-6, 0.0), (1e-3, 0.0), (1.0, 0.0), (1e3, 0.0), (1e6, 0.0), (1e-3, 1e4), (1.0, 1e7), (1e3, 1e9)]
    {
        let place = v(0.6, -0.48, 0.64) * far;
        let scene = Stage::of([Body::new(&ball, black()).sized(size).at(0.0, place)]).scene();
        // In the mesh's own coordinates, too.
        let (mut dice, mut lost) = (Dice(9), 0);
        for i in 0..200_000 {
            let (a, b) = seams[dice.below(seams.len())];
            let target = match i % 4 {
                0 => a,
                1 => a.lerp(b, 0.5),
                2 => a.lerp(b, dice.part()),
                _ => dice.direction(),
            };
            let start = if i % 3 == 0 { DVec3::ZERO } else { dice.in_cube() * 0.5 };
            let ray = light_from(place + target * size, Event::new(0.0, place + start * size));
            lost += usize::from(scene.world.nearest(&ray).is_none());
        }
        assert_eq!(lost, 0, "size {size}, at {far}");
    }
}

/// From outside, with the ball at 0.9 c: rays at its vertices and edges meet it on its near side.
#[test]
fn nothing_slips_into_a_closed_ball_that_flies_by() {
    let ball = icosphere(4);
    let seams = edges(&ball);
    let ball = built(ball);
    for (size, far) in [(1e-3, 0.0), (1.0, 0.0), (1e3, 0.0), (1.0, 1e6)] {
        let mut dice = Dice(10);
        let velocity = dice.velocity(0.9);
        let start: Event = Event::new(0.3 * far, v(0.0, 0.6, 0.8) * far);
        let scene =
            Stage::of([Body::new(&ball, black()).sized(size).at(start.t, start.x).moving(velocity)]).scene();
        let into = scene.world.frames[0].rest_from_lab;
        for i in 0..200_000 {
            let (a, b) = seams[dice.below(seams.len())];
            let target = if i % 3 == 0 { a } else { a.lerp(b, if i % 3 == 1 { 0.5 } else { dice.part() }) };
            // A light from that place of the rest frame to somewhere on its own side, well above the surface.
            let to = target * 3.0 + dice.in_cube();
            let arrival = Event::new((to - target).length() * size, to * size);
            let ray = light_at_rest(&into, target * size, arrival);
            let hit = scene.world.nearest(&ray);
            // Met at s = 1, not on the far side behind it.
            let s = hit.map_or(f64::INFINITY, |hit| hit.s);
            assert!((s - 1.0).abs() < 1e-6 + 1e-7 * far / size, "size {size}: s = {s}");
        }
    }
}

/// Rays along the axes, and in the planes of the sides: no component's zero does harm.
#[test]
fn rays_along_the_axes_meet_what_they_should() {
    let scene = Stage::of([Body::new(&built(cube()), black())]).scene();
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    for axis in axes {
        let side = axis.any_orthonormal_vector();
        let up = axis.cross(side);
        for (off, meets) in [
            (DVec3::ZERO, true),
            (side * 0.5 + up * 0.5, true),
            (side * 0.999, true),
            (side * 1.001, false),
            (up * 1.5, false),
        ] {
            let ray = light_from(off, Event::new(0.0, off - axis * 7.0));
            let s = scene.world.nearest(&ray).map(|hit| hit.s);
            assert_eq!(s, meets.then_some(6.0), "{axis} {off}");
            let inside = light_from(off + axis * 3.0, Event::new(0.0, off));
            assert_eq!(scene.world.nearest(&inside).is_some(), meets, "{axis} {off} from inside");
            // The other way there is nothing.
            assert!(
                scene
                    .world
                    .nearest(&light_from(off - axis * 9.0, Event::new(0.0, off - axis * 7.0)))
                    .is_none()
            );
        }
    }
}

#[test]
fn grazing_rays_meet_a_long_floor() {
    let floor = built(crate::support::square());
    let scene = Stage::of([Body::new(&floor, black()).sized(1e4)]).scene();
    for height in [1e-6, 1e-3, 1.0] {
        for along in [v(1.0, 0.0, 0.0), v(0.3, -0.9, 0.0)] {
            let target = along * 5e3;
            let hit = scene.world.nearest(&light_from(target, Event::new(0.0, v(0.0, 0.0, height)))).unwrap();
            near(hit.s, (target - v(0.0, 0.0, height)).length(), 1e-8);
        }
    }
}

#[test]
fn empty_and_degenerate_meshes_are_misses() {
    let ray = |x: f64| Line { origin: v(x, 0.1, 5.0), step: v(-0.2 * x, -0.02, -1.0) };
    let p = v(0.5, 0.25, 0.125);
    let odd = [
        Mesh::default(),
        soup(&[[p, p, p]]),
        soup(&[[p, p, -p]; 5]),
        soup(&[[p, p * 2.0, p * 3.0]]),
        soup(&[[DVec3::ZERO; 3]; 100]),
    ];
    for mesh in odd {
        let scene = Stage::of([Body::new(&built(mesh.clone()), black())]).scene();
        let tree = built(mesh);
        for x in [0.0, 0.3, 0.5, 2.0] {
            assert!(tree.nearest(&ray(x), f64::INFINITY).is_none() && !tree.any(&ray(x), f64::INFINITY));
            assert!(scene.world.nearest(&light_from(p, Event::new(0.0, v(x, 2.0, 3.0)))).is_none());
        }
    }
    assert!(Stage::of([]).scene().world.nearest(&light_from(p, Event::ORIGIN)).is_none());
    assert!(Tree::build(&[]).walk(&ray(0.0), 1.0, |_, limit| limit) >= 1.0);
}

/// Degenerate triangles among good ones do no harm.
#[test]
fn good_triangles_are_met_among_degenerate_ones() {
    let good = [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 1.0, 0.0)];
    let mut corners = vec![[v(0.1, 0.1, 1.0); 3]; 50];
    corners.push(good);
    corners.extend(vec![[v(0.0, 0.0, 2.0), v(0.0, 0.0, 2.0), v(0.1, 0.1, 0.5)]; 50]);
    let meeting = built(soup(&corners))
        .nearest(&Line { origin: v(0.1, -0.2, 9.0), step: v(0.0, 0.0, -1.0) }, 1e9)
        .unwrap();
    assert_eq!(meeting.triangle, 50);
    near(meeting.s, 9.0, 1e-15);
}

#[test]
fn hundred_thousand_equal_triangles_are_built_in_a_moment() {
    let one = [v(-1.0, -1.0, 0.3), v(1.0, -1.0, 0.2), v(0.0, 1.0, 0.1)];
    let begin = Instant::now();
    let tree = built(soup(&vec![one; 100_000]));
    assert!(tree.nearest(&Line { origin: v(0.0, 0.0, 5.0), step: DVec3::NEG_Z }, f64::INFINITY).is_some());
    assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
}

/// Boxes within boxes, each a part of the one around it: a tree as deep as it can be.
#[test]
fn nested_boxes_are_found_however_deep() {
    let boxes: Vec<Bounds> = (0..3000)
        .map(|i| {
            let half = libm::pow(0.99, f64::from(i));
            Bounds { lo: DVec3::splat(-half), hi: DVec3::splat(half) }
        })
        .collect();
    let tree = Tree::build(&boxes);
    let mut seen = 0;
    tree.walk(&Line { origin: v(3.0, 3.0, 3.0), step: v(-1.0, -1.0, -1.0) }, 1e9, |_, limit| {
        seen += 1;
        limit
    });
    assert_eq!(seen, 3000);
    // Sheets one behind the other, their sizes falling: the nearest is the smallest.
    let sheets: Vec<[DVec3; 3]> = (0..2000)
        .map(|i| {
            let size = libm::pow(1.01, f64::from(i) - 2000.0);
            [v(-size, -size, size), v(size, -size, size), v(0.0, size, size)]
        })
        .collect();
    let tree = built(soup(&sheets));
    let meeting = tree.nearest(&Line { origin: DVec3::ZERO, step: DVec3::Z }, f64::INFINITY).unwrap();
    assert_eq!(meeting.triangle, 0);
}

/// Many bodies in one rest frame are found by a tree of their own.
#[test]
fn bodies_of_one_frame_are_found_through_their_tree() {
    let ball = built(icosphere(2));
    let mut dice = Dice(14);
    let places: Vec<DVec3> = (0..500).map(|_| dice.in_cube() * 50.0).collect();
    let velocity = speed(0.7, v(1.0, 2.0, -1.0));
    let bodies = places
        .iter()
        .map(|place| Body::new(&ball, black()).mapped(DAffine3::from_translation(*place)).moving(velocity));
    let scene = Stage::of(bodies).scene();
    assert_eq!(scene.world.frames.len(), 1);
    let into = scene.world.frames[0].rest_from_lab;
    for _ in 0..2000 {
        let event = Event::new(0.0, dice.direction() * 90.0);
        let target = dice.in_cube() * 40.0;
        let way = event.x - target;
        let ray = light_at_rest(&into, target, event);
        let met = places.iter().enumerate().filter_map(|(number, place)| {
            // A unit sphere: where the line enters it.
            let from = *place - event.x;
            let along = -from.dot(way) / way.length();
            let miss = (from.length_squared() - along * along).max(0.0).sqrt();
            (along > 0.0 && miss < 0.93).then_some((along, number))
        });
        let nearest = met.min_by(|a, b| a.0.total_cmp(&b.0));
        let hit = scene.world.nearest(&ray);
        if let Some((along, number)) = nearest {
            let hit = hit.unwrap();
            assert!(hit.placed.body as usize == number || hit.s * way.length() < along + 1.0);
        }
        if let Some(hit) = hit {
            let spot = hit.spot(&ray);
            near((spot.event.x - places[hit.placed.body as usize]).length(), 1.0, 0.07);
            assert!(angle(spot.normal, spot.event.x - places[hit.placed.body as usize]) < 0.3);
        }
    }
}

#[test]
fn meshes_without_a_place_are_left_out() {
    let flat = Body::new(&built(cube()), black()).stretched(v(1.0, 0.0, 1.0));
    assert!(
        Stage::of([flat])
            .scene()
            .world
            .nearest(&light_from(DVec3::ZERO, Event::new(0.0, v(1.0, 5.0, 2.0))))
            .is_none()
    );
    let shared: Arc<Triangles> = built(cube());
    assert!(shared.bounds().lo == DVec3::splat(-1.0) && shared.mesh.positions[0] == Vec3::splat(-1.0));
}
