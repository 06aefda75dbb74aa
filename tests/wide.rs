//! The tree of eight children meets what the binary one meets, triangle by triangle and bit by bit, whatever the mesh.

use crate::support::{Dice, built, icosphere, soup, v};
use glam::{DAffine3, DVec3};
use proptest::prelude::{ProptestConfig, prop_assert_eq, proptest};
use std::time::{Duration, Instant};
use terrell::mesh::Mesh;
use terrell::tree::{Bounds, Line, Lines, MANY, Tree};
use terrell::triangles::{Meeting, Triangles};

/// The same mesh in both trees.
struct Both {
    eight: std::sync::Arc<Triangles>,
    two: Tree,
}

/// All bits of a meeting.
type Bits = (u64, u32, [u64; 2]);

fn bits(meeting: Meeting) -> Bits {
    let (a, b) = meeting.weights;
    (meeting.s.to_bits(), meeting.triangle, [a.to_bits(), b.to_bits()])
}

impl Both {
    fn new(mesh: Mesh) -> Self {
        let eight = built(mesh);
        let count = eight.mesh.triangles.len() as u32;
        let boxes: Vec<Bounds> = (0..count).map(|triangle| Bounds::of(eight.corners(triangle))).collect();
        Self { two: Tree::build(&boxes), eight }
    }

    /// All that the binary tree leads to at 0 < s < `s_max`, by s and then by number.
    fn all(&self, line: &Line, s_max: f64) -> Vec<Bits> {
        let (sheared, mesh) = (self.eight.sheared(line), &self.eight.mesh);
        let mut all = Vec::new();
        self.two.walk(line, s_max, |triangle, limit| {
            let corners = mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize].as_ref());
            if let Some((s, weights)) = sheared.meet(corners)
                && s > 0.0
                && s < limit
            {
                all.push(bits(Meeting { triangle, s, weights, place: 0 }));
            }
            limit
        });
        all.sort_unstable();
        all
    }

    /// Whether both meet the same; how much.
    fn agree(&self, line: &Line, s_max: f64) -> Result<usize, String> {
        let expected = self.all(line, s_max);
        let mut found = Vec::new();
        self.eight.until(line, s_max, &mut |meeting| {
            found.push(bits(meeting));
            false
        });
        found.sort_unstable();
        let first = self.eight.nearest(line, s_max).map(bits);
        let any = self.eight.any(line, s_max);
        if found == expected && first == expected.first().copied() && any != expected.is_empty() {
            return Ok(expected.len());
        }
        Err(format!("{line:?} up to {s_max}:\n{found:?}\n{expected:?}\n{first:?} {any}"))
    }

    /// Whether whatever is met is there, for lines from so far away that rounding their starts passes over whole triangles; how much.
    fn agree_from_afar(&self, line: &Line, s_max: f64) -> Result<usize, String> {
        let sheared = self.eight.sheared(line);
        let is_there = |meeting: Meeting| {
            let corners = self.eight.mesh.triangles[meeting.triangle as usize]
                .map(|i| self.eight.mesh.positions[i as usize].as_ref());
            let alone = sheared.meet(corners).map(|(s, weights)| Meeting { s, weights, ..meeting });
            alone.map(bits) == Some(bits(meeting)) && meeting.s > 0.0 && meeting.s < s_max
        };
        let (mut count, mut all_there) = (0, self.eight.nearest(line, s_max).is_none_or(is_there));
        self.eight.until(line, s_max, &mut |meeting| {
            all_there &= is_there(meeting);
            count += 1;
            false
        });
        if all_there && (count > 0 || !self.eight.any(line, s_max)) {
            return Ok(count);
        }
        Err(format!("{line:?} up to {s_max}"))
    }

    /// Whether lines that go together meet what each meets by itself; how many meet anything.
    fn agree_together(&self, lines: &[Line], limits: &[f64; MANY]) -> Result<usize, String> {
        let together = Lines::of(lines.iter().copied());
        let nearest = self.eight.nearest_many(&together, limits);
        let any = self.eight.any_many(&together, limits);
        let mut met = 0;
        for (i, (nearest, limit)) in nearest.into_iter().zip(limits).enumerate() {
            let Some(line) = lines.get(i) else {
                assert!(nearest.is_none() && any >> i & 1 == 0, "no line");
                continue;
            };
            let alone = self.eight.nearest(line, *limit);
            if nearest.map(bits) != alone.map(bits) || (any >> i & 1 == 1) != self.eight.any(line, *limit) {
                return Err(format!("{i} of {lines:?} up to {limit}:\n{nearest:?}\n{alone:?} {any:b}"));
            }
            met += usize::from(alone.is_some());
        }
        Ok(met)
    }
}

/// Lines that go about the same way from about the same place, or toward one, or nowhere together.
fn bundled(mesh: &Mesh, dice: &mut Dice, reach: f64) -> Vec<Line> {
    let first = aimed(mesh, dice, reach);
    let count = 1 + dice.below(MANY);
    let (kind, spread) = (dice.below(4), libm::pow(10.0, dice.between(-6.0, 0.0)));
    let line = |dice: &mut Dice| {
        let moved = dice.in_cube() * spread * reach;
        let turned = dice.in_cube() * spread * first.step.length();
        match kind {
            0 => Line { step: first.step + turned, ..first },
            1 => Line { origin: first.origin + moved, step: first.step - moved },
            2 => Line { origin: first.origin + moved, step: first.step + turned },
            _ => aimed(mesh, dice, reach),
        }
    };
    (0..count).map(|_| line(dice)).collect()
}

/// A line at a mesh: at its vertices, its edges, along its edges, or anywhere near it.
fn aimed(mesh: &Mesh, dice: &mut Dice, reach: f64) -> Line {
    let triangle = mesh.triangles[dice.below(mesh.triangles.len())];
    let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
    let size = (b - a).abs().max((c - a).abs()).max_element();
    let target = match dice.below(6) {
        0 => a,
        1 => a.lerp(b, 0.5),
        2 => b.lerp(c, dice.part()),
        3 => a + (b - a) * dice.part() + (c - a) * dice.part(),
        _ => a + dice.in_cube() * size,
    };
    let origin = match dice.below(5) {
        0 => a + (a - b) * dice.between(-1.0, 2.0),
        1 => target + DVec3::from_array([0, 1, 2].map(|_| f64::from(dice.below(3) as u32) - 1.0)) * size,
        2 => target + dice.direction() * reach * 1e3,
        _ => target + dice.in_cube() * reach,
    };
    Line { origin, step: (target - origin) * libm::pow(10.0, dice.between(-3.0, 3.0)) }
}

/// Triangles of many kinds, some of them twice: small and large ones, slivers, flat ones, ones without a surface.
fn zoo(dice: &mut Dice, count: usize) -> Vec<[DVec3; 3]> {
    let mut all: Vec<[DVec3; 3]> = Vec::new();
    for _ in 0..count {
        let place = dice.in_cube();
        let size = libm::exp(dice.between(-6.0, 0.0));
        let (e, f) = (dice.in_cube() * size, dice.in_cube() * size);
        let on_grid = |p: DVec3| (p * 8.0).round() / 8.0;
        let one = match dice.below(8) {
            0 => [place, place + e, place + e * dice.part() + f * 1e-6],
            1 => [place, place + e, place + e * dice.part()],
            2 => [place; 3],
            3 => [place, place + e.with_z(0.0), place + f.with_z(0.0)],
            4 => [place, place + e, place + f].map(|p| on_grid(p).with_z(0.5)),
            5 => [place, place + e * 8.0, place + f * 8.0].map(on_grid),
            6 if !all.is_empty() => all[dice.below(all.len())],
            _ => [place, place + e, place + f],
        };
        all.push(one);
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn wide_tree_meets_what_the_binary_one_meets(seed in 0..u64::MAX, count in 1..400_usize, size in -6.0..6.0_f64, far in 0.0..4.0_f64) {
        let mut dice = Dice(seed);
        let size = libm::pow(10.0, size);
        let middle = dice.direction() * (libm::pow(10.0, far) - 1.0);
        // Half of them about the origin, so that coordinates on the grid stay there.
        let middle = if dice.below(2) == 0 { DVec3::ZERO } else { middle };
        let both = Both::new(soup(&zoo(&mut dice, count).map_all(|p| (p + middle) * size)));
        for _ in 0..100 {
            let line = aimed(&both.eight.mesh, &mut dice, 3.0 * size);
            let limits = [f64::INFINITY, 0.5, dice.between(0.0, 2.0) * size / line.step.length()];
            for s_max in limits {
                let agreed = both.agree(&line, s_max);
                prop_assert_eq!(agreed.as_ref().err(), None);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn lines_that_go_together_meet_what_each_meets_by_itself(seed in 0..u64::MAX, count in 1..2000_usize, size in -6.0..6.0_f64) {
        let mut dice = Dice(seed);
        let size = libm::pow(10.0, size);
        let both = Both::new(soup(&zoo(&mut dice, count).map_all(|p| p * size)));
        for _ in 0..60 {
            let mut lines = bundled(&both.eight.mesh, &mut dice, 3.0 * size);
            if dice.below(10) == 0 {
                // Some that are no lines.
                lines[0].step = [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::X][dice.below(4)];
                lines[0].origin.x *= [1.0, f64::NAN, f64::INFINITY][dice.below(3)];
            }
            let limits = [0; MANY].map(|_| match dice.below(4) {
                0 => dice.between(0.0, 2.0) * size / lines[0].step.length(),
                1 => -1.0,
                _ => f64::INFINITY,
            });
            for limits in [limits, [f64::INFINITY; MANY]] {
                let agreed = both.agree_together(&lines, &limits);
                prop_assert_eq!(agreed.as_ref().err(), None);
            }
        }
    }
}

trait MapAll {
    fn map_all(self, f: impl Fn(DVec3) -> DVec3) -> Self;
}

impl MapAll for Vec<[DVec3; 3]> {
    fn map_all(self, f: impl Fn(DVec3) -> DVec3) -> Self {
        self.into_iter().map(|triangle| triangle.map(&f)).collect()
    }
}

/// Rays at vertices and edges of closed balls, from within and from without; the same s at both sides of an edge.
#[test]
fn both_trees_meet_the_same_side_of_an_edge() {
    for (size, far) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e3)] {
        let mut mesh = icosphere(4);
        let map = DAffine3::from_scale(DVec3::splat(size));
        for p in &mut mesh.positions {
            *p = (map.transform_point3(p.as_dvec3()) + v(0.6, -0.48, 0.64) * far * size).as_vec3();
        }
        let both = Both::new(mesh);
        let (mut dice, mut met) = (Dice(3), 0);
        for _ in 0..20_000 {
            let line = aimed(&both.eight.mesh, &mut dice, 2.0 * size);
            met += usize::from(both.agree(&line, f64::INFINITY).unwrap() > 1);
        }
        assert!(met > 8_000, "{met}");
    }
}

#[test]
fn lines_together_at_a_ball_meet_what_each_meets_by_itself() {
    let both = Both::new(icosphere(5));
    let (mut dice, mut met) = (Dice(8), 0);
    for _ in 0..3_000 {
        let lines = bundled(&both.eight.mesh, &mut dice, 2.0);
        met += both.agree_together(&lines, &[f64::INFINITY; MANY]).unwrap();
    }
    assert!(met > 8_000, "{met}");
}

/// Of triangles that are met at the same s it is the one with the smallest number, wherever it is in the tree.
#[test]
fn smallest_number_is_met_of_equal_triangles() {
    let mut dice = Dice(4);
    for _ in 0..50 {
        // Layers of triangles, each several times, in a random order.
        let mut corners: Vec<[DVec3; 3]> = (0..300)
            .map(|i| {
                let z = f64::from(i % 5);
                [v(-1.0, -1.0, z), v(1.0, -1.0, z), v(0.0, 1.0, z)]
            })
            .collect();
        for place in (1..corners.len()).rev() {
            corners.swap(place, dice.below(place + 1));
        }
        let both = Both::new(soup(&corners));
        let line = Line { origin: v(0.1, -0.2, dice.between(4.1, 9.0)), step: DVec3::NEG_Z };
        let first = corners.iter().position(|[a, ..]| a.z == 4.0).unwrap();
        assert_eq!(both.eight.nearest(&line, f64::INFINITY).unwrap().triangle as usize, first);
        assert_eq!(both.agree(&line, f64::INFINITY).unwrap(), 300);
    }
}

#[test]
fn hundred_thousand_equal_triangles_are_all_met() {
    let one = [v(-1.0, -1.0, 0.3), v(1.0, -1.0, 0.2), v(0.0, 1.0, 0.1)];
    let begin = Instant::now();
    let mut corners = vec![one; 100_000];
    corners[70_000] = one.map(|p| p + DVec3::Z);
    let both = Both::new(soup(&corners));
    let line = |origin| Line { origin, step: DVec3::NEG_Z };
    for _ in 0..100 {
        assert_eq!(both.eight.nearest(&line(v(0.0, 0.0, 5.0)), f64::INFINITY).unwrap().triangle, 70_000);
        assert_eq!(both.eight.nearest(&line(v(0.0, 0.0, 1.0)), f64::INFINITY).unwrap().triangle, 0);
        assert!(!both.eight.any(&line(v(0.0, 0.0, -1.0)), f64::INFINITY));
    }
    assert_eq!(both.agree(&line(v(0.0, 0.0, 5.0)), f64::INFINITY).unwrap(), 100_000);
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
}

/// Lines with components that are zero, not a number, infinite, or as small and as large as numbers are.
#[test]
fn odd_lines_do_no_harm() {
    let mut dice = Dice(5);
    let both = Both::new(soup(&zoo(&mut dice, 500)));
    let odd = [0.0, -0.0, 1.0, -1.0, 1e-200, 1e200, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, f64::NAN];
    let (mut met, mut from_afar) = (0, 0);
    for _ in 0..50_000 {
        let mut any = || DVec3::from_array([0; 3].map(|_| odd[dice.below(odd.len())]));
        let (origin, step) = (any(), any());
        let line = Line { origin: if dice.below(2) == 0 { dice.in_cube() } else { origin }, step };
        let s_max = [f64::INFINITY, 1.0, 0.0, -1.0, f64::NAN][dice.below(5)];
        if line.origin.abs().max_element() > 1e9 {
            from_afar += usize::from(both.agree_from_afar(&line, s_max).unwrap() > 0);
        } else {
            met += usize::from(both.agree(&line, s_max).unwrap() > 0);
        }
    }
    assert!(met > 1_000 && from_afar > 0, "{met} {from_afar}");
}

/// Boxes within boxes: trees as deep as they can be, and lines that have more left to visit than is kept at hand.
#[test]
fn deep_trees_are_walked_to_their_end() {
    let sheets = |count: u32, ratio: f64| -> Vec<[DVec3; 3]> {
        let sheet = |i| {
            let size = libm::pow(ratio, f64::from(i) - f64::from(count));
            [v(-size, -size, size), v(size, -size, size), v(0.0, size, size)]
        };
        (0..count).map(sheet).collect()
    };
    for (count, ratio) in [(2_000, 1.01), (3_000, 1.004), (20_000, 1.0001)] {
        let both = Both::new(soup(&sheets(count, ratio)));
        for (origin, step) in [
            (DVec3::ZERO, DVec3::Z),
            (v(0.0, 0.0, 2.0), DVec3::NEG_Z),
            (v(1e-3, 0.0, 0.5), v(0.01, 0.02, 1.0)),
        ] {
            let met = both.agree(&Line { origin, step }, f64::INFINITY).unwrap();
            assert!(met > count as usize / 20 || ratio > 1.005, "{met}");
        }
    }
}

/// With positions, normals, one set of texture coordinates and corners (28 bytes for a closed mesh) less than 100.
#[test]
fn tree_takes_less_than_62_bytes_a_triangle() {
    let ball = built(icosphere(6));
    let each = ball.bytes() as f64 / ball.mesh.triangles.len() as f64;
    assert!(each < 62.0, "{each}");
}
