//! Many bodies, each with a velocity of its own: asking only those that a ray can meet gives what asking all gives.

use crate::support::{
    Body, Dice, Lantern, Stage, ball, black, black_body, cuboid, diffuse, light_from, plane, v,
};
use glam::DVec3;
use terrell::scene::Scene;
use terrell::spacetime::{Event, FourVector, SightRay, Velocity};
use terrell::spectrum::Wavelengths;
use terrell::world::{Crowd, Departure, Hit};

/// Balls that appear all round the event, near and far, slow and at γ = 1e4; one floor without end.
fn crowded(dice: &mut Dice, count: usize, seen_from: Event) -> Scene {
    let bodies = (0..count).map(|number| {
        let distance = 3.0 * libm::pow(40.0, dice.part());
        let place = seen_from.x + dice.direction() * distance;
        let velocity = match number % 4 {
            0 => Velocity::from_gamma(1.0 + 1e4 * dice.part(), dice.direction()),
            1 => dice.velocity(0.01),
            _ => {
                let beta = dice.between(0.1, 0.99);
                dice.velocity(beta)
            }
        };
        let radius = distance * dice.between(0.02, 0.2);
        Body::of(ball(radius, DVec3::ZERO), diffuse(0.5)).at(seen_from.t - distance, place).moving(velocity)
    });
    let floor = Body::of(plane(v(0.0, -500.0, 0.0), v(0.1, 1.0, 0.2)), black());
    Stage::of(bodies.chain([floor])).scene()
}

/// Rays that go together are told what each is told by itself: what is met first, and whether anything is.
fn same_together(scene: &Scene, rays: &[SightRay], s_max: f64, crowd: Option<&Crowd>) {
    let world = &scene.world;
    let known = |hit: Option<Hit<'_>>| hit.map(|hit| (hit.placed.body, hit.s.to_bits()));
    let away = |ray: &SightRay| {
        // From the ground of some body, as shadow rays start.
        let rest = &world.frames[world.frames.len() / 2];
        // (A little beside, so that it shows who begins there.)
        let at = rest.rest_from_lab * ray.event;
        Departure { event: ray.event, rest, at: Event::new(at.t, at.x + v(0.01, 0.02, -0.01)) }
    };
    let from: Vec<Departure<'_>> = rays.iter().map(away).collect();
    let leaving: Vec<_> = rays.iter().zip(&from).map(|(ray, from)| (ray, from, s_max)).collect();
    let blocked = world.blocked_many(leaving, crowd);
    for (i, hit) in world.nearest_many(rays, crowd).into_iter().enumerate() {
        let Some(ray) = rays.get(i) else {
            assert!(hit.is_none() && blocked >> i & 1 == 0);
            continue;
        };
        assert_eq!(known(hit), known(world.nearest_from(ray, None, crowd)), "{ray:?}");
        assert_eq!(blocked >> i & 1 == 1, world.blocked(ray, Some(&from[i]), s_max, crowd), "{ray:?}");
    }
}

#[test]
fn rays_that_go_together_meet_whom_each_meets_by_itself() {
    let mut dice = Dice(73);
    for count in [3, 60, 400] {
        let scene = crowded(&mut dice, count, Event::ORIGIN);
        let crowd = scene.world.crowd(Event::ORIGIN);
        assert_eq!(crowd.is_some(), count > 3);
        for number in 0..300 {
            let (n, wide) = (dice.direction(), libm::pow(10.0, dice.between(-4.0, 0.0)));
            let start = dice.in_cube() * f64::from(number % 3);
            let mut rays: Vec<SightRay> = (0..=dice.below(16))
                .map(|_| {
                    let along = (n + dice.in_cube() * wide).normalize();
                    let event = Event::new(0.0, start + dice.in_cube() * wide);
                    SightRay { event, k: FourVector::new(1.0, along) }
                })
                .collect();
            let mut s_max = dice.between(1.0, 100.0);
            if number % 5 == 0 {
                // One is from so far away that the crowd is a point.
                let away = libm::pow(10.0, dice.between(4.0, 12.0));
                rays[0].event = rays[0].at(-away);
                s_max += if number % 2 == 0 { away } else { 0.0 };
            }
            same_together(&scene, &rays, s_max, crowd.as_ref());
            same_together(&scene, &rays, s_max, None);
        }
    }
}

#[test]
fn rays_that_go_together_meet_one_body_among_many_without_end() {
    let mut dice = Dice(74);
    let walls = (0..8).map(|_| {
        let normal = dice.direction();
        Body::of(plane(-30.0 * normal, normal), black()).moving(dice.velocity(0.5))
    });
    let walls: Vec<Body> = walls.collect();
    let lone = Body::of(ball(2.0, DVec3::ZERO), diffuse(0.5)).at(-5.0, v(0.0, 0.0, -5.0));
    let scene = Stage::of(walls.into_iter().chain([lone.moving(dice.velocity(0.3))])).scene();
    let crowd = scene.world.crowd(Event::ORIGIN);
    let mut met = 0;
    for _ in 0..100 {
        let n = dice.direction();
        let toward = |dice: &mut Dice| SightRay {
            event: Event::new(0.0, dice.in_cube()),
            k: FourVector::new(1.0, (n + 0.3 * dice.in_cube()).normalize()),
        };
        let rays: Vec<SightRay> = (0..16).map(|_| toward(&mut dice)).collect();
        same_together(&scene, &rays, 20.0, Some(crowd.as_ref().unwrap()));
        let all = scene.world.nearest_many(&rays, None);
        met += all.into_iter().flatten().filter(|hit| hit.placed.bounds().is_some()).count();
    }
    assert!(met > 20, "{met}");
}

/// What is met first, whether anything is met, and how many are met at all.
fn asked(
    scene: &Scene,
    ray: &SightRay,
    s_max: f64,
    crowd: Option<&Crowd>,
) -> (Option<(u32, u64)>, bool, Vec<u32>) {
    let world = &scene.world;
    let nearest = world.nearest_from(ray, None, crowd).map(|hit| (hit.placed.body, hit.s.to_bits()));
    let mut all = Vec::new();
    world.until(ray, None, s_max, crowd, |hit| {
        all.push(hit.placed.body);
        false
    });
    all.sort_unstable();
    (nearest, world.blocked(ray, None, s_max, crowd), all)
}

#[test]
fn asking_whom_a_ray_can_meet_is_asking_all() {
    let mut dice = Dice(71);
    let mut met = 0;
    for count in [8, 60, 400] {
        for eye in [Event::ORIGIN, Event::new(1e6, v(3e5, -2e5, 7e5))] {
            let scene = crowded(&mut dice, count, eye);
            let crowd = scene.world.crowd(eye).unwrap();
            for number in 0..1500 {
                // From the event for which the boxes are made, and from others before and after.
                let start = match number % 3 {
                    0 => eye,
                    1 => Event::new(eye.t + dice.between(-80.0, 0.0), eye.x + dice.in_cube() * 50.0),
                    _ => Event::new(eye.t + dice.between(-500.0, 500.0), eye.x + dice.in_cube() * 200.0),
                };
                let frequency = libm::pow(10.0, dice.between(-3.0, 3.0));
                let n = dice.direction();
                let ray = SightRay { event: start, k: FourVector::new(frequency, n * frequency) };
                // And from so far away that the crowd is a point.
                let away = if number % 7 == 0 { libm::pow(10.0, dice.between(4.0, 12.0)) } else { 0.0 };
                let ray = SightRay { event: ray.at(-away / frequency), ..ray };
                let s_max = (away + dice.between(1.0, 100.0)) / frequency;
                let (fast, slow) =
                    (asked(&scene, &ray, s_max, Some(&crowd)), asked(&scene, &ray, s_max, None));
                assert_eq!(fast, slow, "{count} bodies, from {start:?} along {n}");
                met += usize::from(slow.0.is_some_and(|(body, _)| (body as usize) < count));
            }
        }
    }
    assert!(met > 1000, "only {met}");
}

#[test]
fn rays_at_the_rims_of_bodies_are_not_lost() {
    let mut dice = Dice(72);
    let eye = Event::new(-30.0, v(1.0, 2.0, 3.0));
    let scene = crowded(&mut dice, 200, eye);
    let crowd = scene.world.crowd(eye).unwrap();
    for rest in &scene.world.frames {
        let Some(bounds) = rest.placed[0].bounds() else { continue };
        // A place within 1e-9 of the ball's rim, by the ball's own rest frame.
        let (middle, radius) = (0.5 * (bounds.lo + bounds.hi), 0.5 * (bounds.hi - bounds.lo).x);
        let at = rest.rest_from_lab * eye;
        let toward = (at.x - middle).normalize();
        let sin = radius / (at.x - middle).length();
        for _ in 0..8 {
            let side = (dice.direction().cross(toward)).normalize();
            let touch = middle + radius * (1.0 - 1e-9) * (toward * sin + side * (1.0 - sin * sin).sqrt());
            let left = Event::new(at.t - (at.x - touch).length(), touch);
            let ray = light_from(rest.rest_from_lab.undo(left).x, eye);
            let (fast, slow) = (asked(&scene, &ray, 1e9, Some(&crowd)), asked(&scene, &ray, 1e9, None));
            assert_eq!(fast, slow);
        }
    }
}

/// The corners of boxes in the lab: what is tightest there is a flat box that moves along an axis.
#[test]
fn rays_at_the_corners_of_boxes_are_not_lost() {
    let mut dice = Dice(75);
    let eye = Event::new(7.0, v(-3.0, 0.5, 2.0));
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let bodies = (0..300).map(|number| {
        let distance = dice.between(3.0, 100.0);
        let place = eye.x + dice.direction() * distance;
        let velocity = Velocity::from_beta(axes[number % 3] * dice.between(-0.99, 0.99)).unwrap();
        let half = (dice.in_cube().abs() + 0.1) * 0.02 * distance;
        Body::of(cuboid(-half, half), diffuse(0.5)).at(eye.t - distance, place).moving(velocity)
    });
    let scene = Stage::of(bodies).scene();
    let crowd = scene.world.crowd(eye).unwrap();
    for rest in &scene.world.frames {
        let bounds = rest.placed[0].bounds().unwrap();
        let (middle, at) = (0.5 * (bounds.lo + bounds.hi), rest.rest_from_lab * eye);
        for corner in bounds.corners() {
            let touch = middle + (corner - middle) * (1.0 - 1e-9);
            let left = Event::new(at.t - (at.x - touch).length(), touch);
            let ray = light_from(rest.rest_from_lab.undo(left).x, eye);
            let (fast, slow) = (asked(&scene, &ray, 1e9, Some(&crowd)), asked(&scene, &ray, 1e9, None));
            assert_eq!(fast, slow);
        }
    }
}

/// With shadows: rays that leave bodies for lamps, in the midst of the crowd and beyond it.
#[test]
fn light_is_the_same_with_and_without_the_tree() {
    let mut dice = Dice(74);
    let mut scene = crowded(&mut dice, 150, Event::ORIGIN);
    let lamp = |place: DVec3, velocity| Lantern::at(0.0, place, black_body(6000.0)).moving(velocity).lamp();
    scene.lamps =
        vec![lamp(v(4.0, 6.0, -5.0), dice.velocity(0.9)), lamp(v(-80.0, 60.0, 9.0), dice.velocity(0.3))];
    let (all, crowd) = (scene.lit(), scene.lit().seen_from(Event::ORIGIN));
    assert!(all.crowd.is_none() && crowd.crowd.is_some());
    let wavelengths = Wavelengths::<8>::new();
    let mut bright = 0;
    for _ in 0..4000 {
        let ray = SightRay { event: Event::ORIGIN, k: FourVector::new(1.0, dice.direction()) };
        let (fast, slow) = (crowd.seen(&ray, &wavelengths), all.seen(&ray, &wavelengths));
        assert_eq!(fast.radiance, slow.radiance);
        bright += usize::from(slow.radiance[4] > 0.0);
    }
    assert!(bright > 300, "only {bright}");
}

#[test]
fn few_rest_frames_have_no_tree() {
    let scene = crowded(&mut Dice(73), 6, Event::ORIGIN);
    assert!(scene.world.crowd(Event::ORIGIN).is_none());
}
