//! Polygons become triangles, convex or not.

use glam::{DVec2, DVec3, Vec3};

/// The most corners of a polygon that may be concave: cutting off ears takes the square of their number.
pub(super) const CORNERS_LIMIT: usize = 512;

/// Adds the triangles of a polygon, in its own sense of rotation. False if it has too many corners to look
/// whether it is convex; then it is taken for that.
///
/// Cuts off ears: corners whose triangle lies inside and has no other corner in it (Meisters 1975).
pub(super) fn triangulate(points: &[Vec3], corners: &[u32], triangles: &mut Vec<[u32; 3]>) -> bool {
    let fan = |triangles: &mut Vec<[u32; 3]>| {
        let Some((&hub, rim)) = corners.split_first() else { return };
        triangles.extend(rim.windows(2).map(|w| [hub, w[0], w[1]]));
    };
    if corners.len() <= 3 || corners.len() > CORNERS_LIMIT {
        fan(triangles);
        return corners.len() <= 3;
    }
    let flat = project(points, corners);
    if (0..flat.len()).all(|i| turn(&flat, [i, (i + 1) % flat.len(), (i + 2) % flat.len()]) >= 0.0) {
        fan(triangles);
        return true;
    }
    let mut left: Vec<usize> = (0..flat.len()).collect();
    while left.len() > 3 {
        let n = left.len();
        let around = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        // A polygon that crosses itself may have no ear; any corner will do for it.
        let ear = (0..n).find(|&i| is_ear(&flat, &left, around(i))).unwrap_or(0);
        triangles.push(around(ear).map(|i| corners[i]));
        left.remove(ear);
    }
    triangles.push([corners[left[0]], corners[left[1]], corners[left[2]]]);
    true
}

fn is_ear(flat: &[DVec2], left: &[usize], ear: [usize; 3]) -> bool {
    let [a, b, c] = ear;
    if turn(flat, ear) <= 0.0 {
        return false;
    }
    let inside = |&p: &usize| {
        let other = ear.iter().all(|&i| flat[i] != flat[p]);
        other && turn(flat, [a, b, p]) >= 0.0 && turn(flat, [b, c, p]) >= 0.0 && turn(flat, [c, a, p]) >= 0.0
    };
    !left.iter().any(inside)
}

/// Twice the area of a triangle, positive if it turns counter-clockwise.
fn turn(flat: &[DVec2], [a, b, c]: [usize; 3]) -> f64 {
    (flat[b] - flat[a]).perp_dot(flat[c] - flat[a])
}

/// The corners seen along the polygon's normal, counter-clockwise.
fn project(points: &[Vec3], corners: &[u32]) -> Vec<DVec2> {
    let at = |i: usize| points[corners[i % corners.len()] as usize].as_dvec3();
    // Newell's normal: the sum over the edges, right also for corners that are not quite in a plane.
    let mut normal = DVec3::ZERO;
    for i in 0..corners.len() {
        normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
    }
    let n = normal.abs();
    let drop = |p: DVec3| match () {
        () if n.x >= n.y && n.x >= n.z => DVec2::new(p.y, p.z) * DVec2::new(normal.x.signum(), 1.0),
        () if n.y >= n.z => DVec2::new(p.z, p.x) * DVec2::new(normal.y.signum(), 1.0),
        () => DVec2::new(p.x, p.y) * DVec2::new(normal.z.signum(), 1.0),
    };
    (0..corners.len()).map(|i| drop(at(i) - at(0))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
        let at = |i: u32| points[i as usize];
        triangles.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)) / 2.0).sum()
    }

    #[test]
    fn concave_polygons_keep_their_area_in_every_orientation() {
        // An arrow: the corner at (1, 0.5) is concave.
        let arrow = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (1.0, 0.5), (0.0, 4.0)];
        for axis in 0..3 {
            for mirror in [1.0, -1.0] {
                let point = |&(u, v): &(f32, f32)| match axis {
                    0 => Vec3::new(7.0, u, v * mirror),
                    1 => Vec3::new(v * mirror, 7.0, u),
                    _ => Vec3::new(u, v * mirror, 7.0),
                };
                let points: Vec<_> = arrow.iter().map(point).collect();
                let mut triangles = Vec::new();
                assert!(triangulate(&points, &[0, 1, 2, 3, 4], &mut triangles));
                assert_eq!(triangles.len(), 3);
                let whole = area(&points, &triangles);
                let parts: f32 = triangles.iter().map(|t| area(&points, &[*t]).length()).sum();
                assert!((whole.length() - parts).abs() < 1e-5, "{axis} {mirror}: {whole} {parts}");
                assert!((whole[axis] - 9.0 * mirror).abs() < 1e-5, "{axis} {mirror}: {whole}");
            }
        }
    }

    #[test]
    fn degenerate_polygons_still_give_all_but_two_triangles() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::X, Vec3::ZERO];
        let mut triangles = Vec::new();
        assert!(triangulate(&points, &[0, 1, 2, 3, 4], &mut triangles));
        assert_eq!(triangles.len(), 3);
    }
}
