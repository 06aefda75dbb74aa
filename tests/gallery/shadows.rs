//! The shadows of two cubes below a lamp that passes, and of a cube that passes a lamp.

use super::{CUBES, Exhibit, NS, Pinhole, a_cube_is_between, between};
use crate::support::{edge, v};
use glam::{DVec2, DVec3};

/// When the lamp's light left that arrives on the floor at x at the time t: the earlier root of `(t - tₑ)² = |x - p(tₑ)|²` with
/// `p = (0, 3, -β tₑ)`:
///
/// ~~~text
/// tₑ = [t + βz - √((t + βz)² - (1 - β²)(t² - q²))] / (1 - β²)        q = x - (0, 3, 0)
/// ~~~
fn departure(t: f64, x: DVec3) -> f64 {
    const BETA: f64 = 0.9;
    let (q, slow) = (x - v(0.0, 3.0, 0.0), 1.0 - BETA * BETA);
    let half = t + BETA * q.z;
    (half - (half * half - slow * (t * t - q.length_squared())).sqrt()) / slow
}

/// Whether a pixel shows floor that the lamp lights; none where it shows none.
fn expected(eye: DVec3, n: DVec3, seen: f64, lamp_at: impl Fn(f64, DVec3) -> DVec3) -> Option<bool> {
    let floor = eye - n * (eye.y / n.y);
    if n.y >= 0.0 || a_cube_is_between(eye, floor) {
        return None;
    }
    let t = seen - (floor - eye).length();
    Some(!a_cube_is_between(lamp_at(t, floor), floor))
}

/// In pictures of 120 x 120 pixels: whether each is in the shadow, and each edge on the way along a row of pixels.
#[test]
fn shadows_of_two_cubes_end_where_the_lamps_earlier_place_throws_them() {
    const WIDTH: u32 = 120;
    let retarded = |t: f64, x: DVec3| v(0.0, 3.0, -0.9 * departure(t, x));
    let (mut edges, mut naive) = (0, 0);
    for (name, eye, target) in [
        ("two_cubes_1", v(5.0, 5.0, 5.0), v(2.0, 1.0, 0.0)),
        ("two_cubes_2", v(12.0, 8.0, 0.0), v(5.0, 0.0, -3.0)),
    ] {
        let exhibit = Exhibit::of(name);
        let (view, pinhole) = (exhibit.view(0, WIDTH), Pinhole::toward(target - eye, WIDTH));
        let ours = |pixel| expected(eye, pinhole.direction(pixel), 55.0 * NS, retarded);
        let shows = |pixel| {
            let ray = view.ray(pixel);
            (exhibit.body(&ray) == Some(0)).then(|| exhibit.shows_lamplight(&ray))
        };
        for row in 0..WIDTH {
            let place = |x: f64| DVec2::new(x, f64::from(row) + 0.437);
            for x in (0..WIDTH).map(|x| f64::from(x) + 0.219) {
                assert_eq!(shows(place(x)), ours(place(x)), "{name}: {}", place(x));
                let at_once = |t: f64, _: DVec3| v(0.0, 3.0, -0.9 * t);
                let now = expected(eye, pinhole.direction(place(x)), 55.0 * NS, at_once);
                naive += u32::from(now != ours(place(x)));
                let (here, next) = (ours(place(x)), ours(place(x + 1.0)));
                if let (Some(lit), Some(other)) = (here, next)
                    && lit != other
                {
                    let ends =
                        |of: &dyn Fn(DVec2) -> Option<bool>| edge(x, x + 1.0, |x| of(place(x)) == here);
                    let (got, expected) = (ends(&shows), ends(&ours));
                    assert!((got - expected).abs() < 1e-9, "{name}: {got} for {expected} in row {row}");
                    edges += 1;
                }
            }
        }
    }
    // There are edges, and they are elsewhere than those of light that takes no time.
    assert!(edges > 200 && naive > 3000, "{edges} {naive}");
}

/// In the mirror that the right cube is, the floor is seen by light that made a detour: a point at x shows the lamp's light of the
/// time at which it passed there, `t - |x - m| - |m - eye|` with m on the mirror.
#[test]
fn mirrored_shadows_are_as_late_as_the_way_of_their_light() {
    const WIDTH: u32 = 160;
    let (eye, target) = (v(6.0, 3.4, 4.6), v(0.9, 0.3, -1.6));
    let exhibit = Exhibit::of("two_cubes_glass");
    let (view, seen) = (exhibit.view(0, WIDTH), 55.0 * NS);
    let pinhole = Pinhole::toward(target - eye, WIDTH);
    let (mut lit, mut dark, mut naive) = (0, 0, 0);
    for (column, row) in (0..WIDTH).flat_map(|x| (0..WIDTH).map(move |y| (x, y))) {
        let pixel = DVec2::new(f64::from(column) + 0.219, f64::from(row) + 0.437);
        let n = pinhole.direction(pixel);
        // Its faces at x = 4 and z = 1, from which the other cube is hidden by it.
        let faces = [(DVec3::X, (4.0 - eye.x) / n.x), (DVec3::Z, (1.0 - eye.z) / n.z)];
        let on_cube = |(_, way): &(DVec3, f64)| {
            let beside = (eye + n * *way - CUBES[0]).abs();
            *way > 0.0 && beside.max_element() < 1.0 + 1e-9
        };
        let Some((normal, way)) = faces.into_iter().find(on_cube) else { continue };
        let (m, on) = (eye + n * way, n - normal * (2.0 * n.dot(normal)));
        let x = m + on * (-m.y / on.y);
        let left = between(CUBES[1], 1.0, m, x);
        if on.y >= 0.0 || left || (x - m).length() > 20.0 {
            continue;
        }
        let shadow = |t: f64| {
            let lamp = v(0.0, 3.0, -0.9 * departure(t, x));
            between(CUBES[0], 1.0, lamp, x)
        };
        let expected = !shadow(seen - way - (x - m).length());
        let ray = view.ray(pixel);
        assert_eq!(exhibit.body(&ray), Some(1), "{pixel}");
        assert_eq!(exhibit.shows_lamplight(&ray), expected, "{pixel}: {x}");
        lit += u32::from(expected);
        dark += u32::from(!expected);
        naive += u32::from(expected == shadow(seen - (x - eye).length()));
    }
    assert!(lit > 100 && dark > 100 && naive > 3, "{lit} {dark} {naive}");
}

/// From the middle of the cube that moves, as it is when light is at x at the time t: γ times as far along its motion, so that the way
/// of light is straight past a cube of side 2.
fn from_cube((t, x): (f64, DVec3)) -> DVec3 {
    let aside = x - v(0.0, 1.0, 2.0 - 0.3 * t);
    aside.with_z(aside.z / (1.0 - 0.3 * 0.3_f64).sqrt())
}

/// On the floor, from the observer's place: white squares are brighter than by the fill light alone (1 cd/m²) unless light that left the
/// lamp for them was stopped by the cube where that was then.
#[test]
fn shadow_of_the_passing_cube_is_of_where_it_was() {
    let exhibit = Exhibit::of("shadow");
    let (eye, lamp) = (v(2.0, 3.0, 0.0), v(5.0, 3.0, 0.0));
    let stopped =
        |from: (f64, DVec3), to: (f64, DVec3)| between(DVec3::ZERO, 1.0, from_cube(from), from_cube(to));
    let (mut dark, mut naive) = (0, 0);
    for exposure in (0..240).step_by(4) {
        let arrives = (250.0 * exposure as f64 / 239.0 - 50.0) * NS;
        let tetrad = exhibit.scene.observer.worldline.at(exhibit.plan.exposures[exposure].tau);
        for (x, z) in (-12..5).flat_map(|x| (-15..15).map(move |z| (f64::from(x), f64::from(z)))) {
            if (x + z) % 2.0 != 0.0 {
                continue;
            }
            let place = v(x + 0.37, 0.0, z + 0.61);
            let t = arrives - (place - eye).length();
            if stopped((t, place), (arrives, eye)) || (place - lamp.with_y(0.0)).length() > 12.0 {
                continue;
            }
            let expected = !stopped((t - (place - lamp).length(), lamp), (t, place));
            let lit = exhibit.luminance(&tetrad.sight_ray((place - eye).normalize())) > 1.1;
            assert_eq!(lit, expected, "{exposure}: {place}");
            dark += u32::from(!lit);
            naive += u32::from(expected == stopped((arrives, lamp), (arrives, place)));
        }
    }
    assert!(dark > 200 && naive > 100, "{dark} {naive}");
}
