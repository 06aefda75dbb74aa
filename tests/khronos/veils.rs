//! Surfaces that are not there all over.

use super::{lambert, lit, rgb, same};
use crate::support::v;
use glam::DVec3;

/// Where light from the middle of a square's cell would fall on the wall 2 m behind it.
fn behind(lamp: DVec3, cell: DVec3) -> DVec3 {
    lamp + (cell - lamp) * ((lamp.z + 2.0) / lamp.z)
}

/// The eye between a square and the wall behind it, in whose way nothing is.
const BETWEEN: DVec3 = DVec3::new(3.5, 0.2, -1.0);

fn wall(place: DVec3, lamp: DVec3) -> DVec3 {
    DVec3::splat(0.8 * lambert(place, DVec3::Z, lamp))
}

/// `alpha_mask.glb`: where alpha (150 or 100 of 255) is below the cutoff (a half) nothing is there.
#[test]
fn holes_of_a_mask_let_sight_and_lamplight_through_and_the_rest_is_all_there() {
    let (lamp, eye) = (v(0.3, 0.2, 4.0), v(-0.4, 0.3, 5.0));
    let scene = lit("alpha_mask", &[lamp]);
    let mut lit_cells = 0;
    for (column, row) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let cell = v(f64::from(column) * 0.5 - 0.75, 0.75 - f64::from(row) * 0.5, 0.0);
        let there = (column + row) % 2 == 0;
        let shadow = rgb(&scene, BETWEEN, behind(lamp, cell));
        if there {
            same(rgb(&scene, eye, cell), v(0.6, 0.3, 0.1) * lambert(cell, DVec3::Z, lamp), 1e-5);
            assert_eq!(shadow, DVec3::ZERO, "{cell}");
        } else {
            lit_cells += 1;
            let place = behind(lamp, cell);
            same(shadow, wall(place, lamp), 1e-5);
            // Through the hole: the wall, in the light or not.
            let place = behind(eye, cell);
            same(rgb(&scene, eye, cell), rgb(&scene, BETWEEN, place), 1e-5);
        }
    }
    assert_eq!(lit_cells, 8);
    // Beyond the square.
    let beside = v(3.0, -2.5, -2.0);
    same(rgb(&scene, BETWEEN, beside), wall(beside, lamp), 1e-5);
}

/// `alpha_blend.glb`: α front + (1 - α) behind.
#[test]
fn blended_surface_is_there_in_part() {
    let (lamp, eye) = (v(6.0, 0.5, 1.0), v(0.3, -0.2, 5.0));
    let scene = lit("alpha_blend", &[lamp]);
    for place in [v(0.2, 0.1, 0.0), v(-0.7, 0.6, 0.0)] {
        let front = v(0.8, 0.4, 0.2) * lambert(place, DVec3::Z, lamp);
        let expected = front * 0.25 + wall(behind(eye, place), lamp) * 0.75;
        same(rgb(&scene, eye, place), expected, 1e-5);
    }
}

#[test]
fn blended_surface_throws_a_shadow_in_part() {
    let lamp = v(0.3, 0.2, 4.0);
    let scene = lit("alpha_blend", &[lamp]);
    for through in [v(0.2, 0.1, 0.0), v(-0.7, 0.6, 0.0)] {
        let place = behind(lamp, through);
        same(rgb(&scene, BETWEEN, place), wall(place, lamp) * 0.75, 1e-5);
    }
    let beside = behind(lamp, v(1.1, 0.1, 0.0));
    same(rgb(&scene, BETWEEN, beside), wall(beside, lamp), 1e-5);
}

/// `sides.glb`: the left square has no back, the right has.
#[test]
fn single_sided_square_seen_from_behind_is_not_there() {
    let (front, back) = (v(0.0, 0.0, 1.5), v(0.0, 0.0, -4.0));
    let scene = lit("sides", &[front, back]);
    let (single, double) = (v(-1.5, 0.3, 0.0), v(1.5, 0.3, 0.0));
    let (red, green) = (v(0.8, 0.2, 0.2), v(0.2, 0.8, 0.2));
    let before = v(0.1, 0.1, 1.6);
    same(rgb(&scene, before, single), red * lambert(single, DVec3::Z, front), 1e-5);
    same(rgb(&scene, before, double), green * lambert(double, DVec3::Z, front), 1e-5);
    let behind = v(0.1, 0.1, -3.0);
    // An unlit wall of 0.8.
    same(rgb(&scene, behind, single), DVec3::splat(80.0), 1e-5);
    same(rgb(&scene, behind, double), green * lambert(double, DVec3::NEG_Z, back), 1e-5);
}
