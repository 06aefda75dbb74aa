//! Solids whose crossings are known.

use super::sets::{ALL, all, at, cuboid, first, placed};
use crate::support::{near, near_vector, v};
use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::FRAC_1_SQRT_2;
use terrell::solid::{Shape, Solid};
use terrell::tree::Line;

const CLOSED: [Shape; 4] = [Shape::Sphere, Shape::Box, Shape::Cylinder, Shape::Cone];

#[test]
fn lines_along_faces_edges_and_through_the_apex_are_in_or_out_and_never_nan() {
    let corners = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let steps = [-1.0, -0.5, 0.0, 0.5, 1.0, 1e-300, -1e-160];
    let point = |list: &[f64], i: usize| {
        let n = list.len();
        v(list[i % n], list[i / n % n], list[i / n / n % n])
    };
    let ball = placed(Shape::Sphere, DAffine3::from_translation(v(0.5, 0.5, 0.0)));
    for solid in ALL.map(Solid::from).into_iter().flat_map(|s| [s.clone(), s.difference([ball.clone()])]) {
        for i in 0..125 {
            for j in 0..343 {
                let line = Line { origin: point(&corners, i), step: point(&steps, j) };
                let found = all(&solid, &line);
                assert!(found.windows(2).all(|pair| pair[0].entering != pair[1].entering));
                for crossing in found {
                    let facet = solid.surface_at(&crossing, at(&line, crossing.s));
                    assert!(crossing.s.is_finite() && facet.uv.is_finite() && facet.place.is_finite());
                    assert!(facet.tangent_u.is_finite() && facet.tangent_v.is_finite());
                    near(facet.normal.length(), 1.0, 1e-14);
                }
            }
        }
    }
}

#[test]
fn the_axis_of_a_cone_goes_from_apex_to_base() {
    let found = all(&Shape::Cone.into(), &Line { origin: v(0.0, 2.0, 0.0), step: v(0.0, -0.5, 0.0) });
    let found: Vec<_> = found.iter().map(|c| (c.s, c.face, c.entering)).collect();
    assert_eq!(found, [(3.0, 0, true), (5.0, 2, false)]);
    // A line that is as steep as the side leaves by the base.
    let found = all(&Shape::Cone.into(), &Line { origin: v(-0.5, 0.5, 0.0), step: v(1.0, -1.0, 0.0) });
    let found: Vec<_> = found.iter().map(|c| (c.s, c.face)).collect();
    assert_eq!(found, [(0.25, 0), (1.0, 2)]);
    // What only touches the apex is no crossing.
    assert!(all(&Shape::Cone.into(), &Line { origin: v(-1.0, 0.5, 0.0), step: v(1.0, 0.0, 0.3) }).is_empty());
}

#[test]
fn a_box_standing_on_another_is_entered_once() {
    let tower = Solid::union((0..5).map(|i| {
        let y = 0.1 * f64::from(i);
        cuboid(v(-0.3, y, -0.3), v(0.3, 0.1 * f64::from(i + 1), 0.3))
    }));
    let found = all(&tower, &Line { origin: v(0.1, 3.0, 0.1), step: v(0.0, -1.0, 0.0) });
    assert_eq!(found.len(), 2, "{found:?}");
    near(found[1].s - found[0].s, 0.5, 1e-15);
    // Along the seam too.
    assert_eq!(all(&tower, &Line { origin: v(3.0, 0.1, 0.1), step: v(-1.0, 0.0, 0.0) }).len(), 2);
    // A plate thinner than that of any microscope is still there.
    let thin = cuboid(v(-1.0, 0.0, -1.0), v(1.0, 1e-12, 1.0));
    let plates = Solid::union([thin, cuboid(v(-1.0, 2e-12, -1.0), v(1.0, 1.0, 1.0))]);
    assert_eq!(all(&plates, &Line { origin: v(0.0, -5.0, 0.0), step: v(0.1, 1.0, 0.0) }).len(), 4);
}

#[test]
fn a_lens_is_what_two_balls_have_in_common() {
    let ball = |z: f64| placed(Shape::Sphere, DAffine3::from_translation(v(0.0, 0.0, z)));
    let lens = Solid::intersection([ball(0.8), ball(-0.8)]);
    let (s, facet) = first(&lens, v(0.1, 0.0, -3.0), v(0.0, 0.0, 1.0)).unwrap();
    near(s, 3.8 - 0.99_f64.sqrt(), 1e-15);
    near_vector(facet.normal, v(0.1, 0.0, -0.99_f64.sqrt()), 1e-15);
    assert!(first(&lens, v(0.7, 0.0, -3.0), v(0.0, 0.0, 1.0)).is_none());
    // A bowl: the inner wall faces the hollow.
    let bowl = ball(0.0).difference([placed(Shape::Sphere, DAffine3::from_scale(v(0.5, 0.5, 0.5)))]);
    let (s, facet) = first(&bowl, DVec3::ZERO, v(0.0, 0.0, 2.0)).unwrap();
    assert_eq!((s, facet.normal), (0.25, v(0.0, 0.0, -1.0)));
}

#[test]
fn what_has_nothing_in_common_has_no_crossings_and_finite_bounds() {
    let far = placed(Shape::Sphere, DAffine3::from_translation(v(5.0, 0.0, 0.0)));
    let none = Solid::intersection([Shape::Sphere.into(), far]);
    let line = Line { origin: v(-9.0, 0.0, 0.0), step: v(1.0, 0.0, 0.0) };
    for empty in [none, Solid::union([]), Solid::intersection([]).complement()] {
        assert!(all(&empty, &line).is_empty());
        assert!(empty.bounded() && !empty.contains(DVec3::ZERO));
    }
    assert!(all(&Solid::intersection([]), &line).is_empty() && Solid::intersection([]).contains(DVec3::ZERO));
}

#[test]
fn only_what_is_cut_off_on_all_sides_is_bounded() {
    let [ball, plane] = [Shape::Sphere, Shape::Plane].map(Solid::from);
    assert!(CLOSED.iter().all(|&shape| Solid::from(shape).bounded()));
    assert!(!plane.bounded() && !ball.clone().complement().bounded());
    assert!(!Solid::union([ball.clone(), plane.clone()]).bounded());
    assert!(!plane.clone().difference([ball.clone()]).bounded());
    let half = Solid::intersection([ball.clone(), plane.clone()]);
    assert!(half.bounded() && ball.difference([plane]).bounded());
    let bounds = half.bounds();
    near_vector(bounds.lo, v(-1.0, -1.0, -1.0), 1e-12);
    near_vector(bounds.hi, v(1.0, 0.0, 1.0), 1e-12);
}

#[test]
fn maps_that_cannot_be_undone_are_refused() {
    for scale in [v(1.0, 0.0, 1.0), v(1e-200, 1e-200, 1.0), v(f64::NAN, 1.0, 1.0), v(f64::INFINITY, 1.0, 1.0)]
    {
        assert!(Solid::from(Shape::Box).placed(DAffine3::from_scale(scale)).is_none(), "{scale}");
    }
}

#[test]
fn limits_are_kept_to_and_visits_end_when_told() {
    let balls = Solid::union(
        (0..200).map(|i| placed(Shape::Sphere, DAffine3::from_translation(v(3.0 * f64::from(i), 0.0, 0.0)))),
    );
    let line = Line { origin: v(-3.0, 0.0, 0.0), step: v(1.0, 0.0, 0.0) };
    let found = all(&balls, &line);
    assert_eq!(found.len(), 400);
    assert_eq!((found[399].leaf, found[399].s), (199, 601.0));
    assert_eq!(balls.nearest(&line, 2.0, 4.0), None);
    assert_eq!(balls.nearest(&line, 2.0, 4.1).map(|c| (c.s, c.entering)), Some((4.0, false)));
    let mut visits = 0;
    balls.crossings(&line, 0.0, f64::INFINITY, &mut |_| {
        visits += 1;
        visits < 3
    });
    assert_eq!(visits, 3);
}

/// The texture coordinates where a line from outside towards the point first meets the shape.
fn uv(shape: Shape, point: DVec3, outwards: DVec3) -> DVec2 {
    let (_, facet) = first(&shape.into(), point + outwards, -outwards).unwrap();
    near_vector(facet.place, point, 1e-15);
    let down = facet.tangent_u.cross(facet.tangent_v).normalize();
    near_vector(down, -facet.normal, 1e-15);
    facet.uv
}

#[test]
fn textures_are_where_they_are_said_to_be() {
    let is = |got: DVec2, u: f64, w: f64| near_vector(got.extend(0.0), v(u, w, 0.0), 1e-15);
    let diagonal = FRAC_1_SQRT_2;
    is(uv(Shape::Plane, v(3.0, 0.0, -7.5), DVec3::Y), 3.0, -7.5);
    is(uv(Shape::Sphere, DVec3::X, DVec3::X), 0.0, 0.5);
    is(uv(Shape::Sphere, DVec3::NEG_Z, DVec3::NEG_Z), 0.25, 0.5);
    is(uv(Shape::Sphere, v(0.0, diagonal, diagonal), DVec3::Z), 0.75, 0.25);
    is(uv(Shape::Sphere, v(-diagonal, -diagonal, 0.0), DVec3::NEG_X), 0.5, 0.75);
    for (axis, right) in [
        (DVec3::X, DVec3::NEG_Z),
        (DVec3::NEG_X, DVec3::Z),
        (DVec3::Z, DVec3::X),
        (DVec3::NEG_Z, DVec3::NEG_X),
    ] {
        is(uv(Shape::Box, 0.5 * axis + 0.25 * right + 0.125 * DVec3::Y, axis), 0.75, 0.375);
    }
    is(uv(Shape::Box, v(0.25, 0.5, 0.125), DVec3::Y), 0.75, 0.625);
    is(uv(Shape::Box, v(0.25, -0.5, 0.125), DVec3::NEG_Y), 0.75, 0.375);
    is(uv(Shape::Cylinder, v(0.0, 0.25, -1.0), DVec3::NEG_Z), 0.25, 0.25);
    is(uv(Shape::Cone, v(0.0, 0.25, -0.25), DVec3::NEG_Z), 0.25, 0.25);
    is(uv(Shape::Cylinder, v(0.5, 0.5, 0.25), DVec3::Y), 0.75, 0.625);
    for shape in [Shape::Cylinder, Shape::Cone] {
        is(uv(shape, v(0.5, -0.5, 0.25), DVec3::NEG_Y), 0.75, 0.375);
    }
}
