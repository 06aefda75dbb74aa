//! Single rays through a large mesh on one core: the tree of eight children, as the program walks it, beside a binary
//! one with the same test of one triangle after the other. Both take turns; what is printed are medians.
//!
//!     cargo run --release --manifest-path tools/rays/Cargo.toml
//!
//! Arguments: how often the icosphere is divided (8), runs (7), one set alone (primary, incoherent, bounce, shadow).

mod mesh;
mod rays;

use glam::DVec3;
use rays::Set;
use std::sync::Arc;
use std::time::Instant;
use terrell::mesh::Mesh;
use terrell::tree::{Bounds, Line, Tree};
use terrell::triangles::{Meeting, Sheared, Triangles};

/// The binary tree with a scalar test: what the program did before.
struct Binary<'a> {
    triangles: &'a Triangles,
    mesh: &'a Mesh,
    tree: Tree,
}

impl<'a> Binary<'a> {
    fn new(triangles: &'a Triangles) -> Self {
        let mesh = &triangles.mesh;
        let boxes: Vec<Bounds> = (mesh.triangles.iter())
            .map(|t| Bounds::of(t.map(|i| mesh.positions[i as usize].as_dvec3())))
            .collect();
        Self { triangles, mesh, tree: Tree::build(&boxes) }
    }

    #[inline(always)]
    fn meet(&self, line: &Sheared, triangle: u32, limit: f64) -> Option<Meeting> {
        let mesh = self.mesh;
        let corners = mesh.triangles[triangle as usize].map(|i| &mesh.positions[i as usize]);
        let (s, weights) = line.meet(corners.map(AsRef::as_ref))?;
        (s > 0.0 && s < limit).then_some(Meeting { triangle, s, weights, place: 0 })
    }

    fn nearest(&self, line: &Line, s_max: f64) -> Option<Meeting> {
        let sheared = self.triangles.sheared(line);
        let mut nearest = None;
        self.tree.walk(line, s_max, |triangle, limit| {
            self.meet(&sheared, triangle, limit).map_or(limit, |meeting| {
                nearest = Some(meeting);
                meeting.s
            })
        });
        nearest
    }

    fn any(&self, line: &Line, s_max: f64) -> bool {
        let sheared = self.triangles.sheared(line);
        let met = |triangle, limit| if self.meet(&sheared, triangle, limit).is_some() { -1.0 } else { limit };
        self.tree.walk(line, s_max, met) < 0.0
    }
}

fn median(seconds: &mut [f64]) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// Lines that are walked by one tree before it is the other's turn, so that both have the same share of a busy machine.
const PIECE: usize = 1 << 14;

/// Times both in turn and prints millions of rays a second.
fn compare(
    name: &str,
    lines: &[Line],
    runs: usize,
    two: impl Fn(&Line) -> f64,
    eight: impl Fn(&Line) -> f64,
) {
    let two = |lines: &[Line]| lines.iter().map(&two).sum();
    let eight = |lines: &[Line]| lines.iter().map(&eight).sum();
    let mut total = [0.0; 2];
    let mut same = true;
    for piece in lines.chunks(PIECE) {
        let mut seconds = [vec![], vec![]];
        let mut sums = [0.0; 2];
        for _ in 0..runs {
            for (which, one) in [&two as &dyn Fn(&[Line]) -> f64, &eight].into_iter().enumerate() {
                let begin = Instant::now();
                sums[which] = one(piece);
                seconds[which].push(begin.elapsed().as_secs_f64());
            }
        }
        same &= sums[0] == sums[1];
        for (total, seconds) in total.iter_mut().zip(&mut seconds) {
            *total += median(seconds);
        }
    }
    let [two, eight] = total.map(|seconds| lines.len() as f64 / seconds * 1e-6);
    println!(
        "{name:12} {two:8.2} {eight:8.2} {:8.2}   {}",
        eight / two,
        if same { "same" } else { "DIFFERENT" }
    );
}

fn main() {
    let mut words = std::env::args().skip(1);
    let level = words.next().and_then(|word| word.parse().ok()).unwrap_or(8);
    let runs = words.next().and_then(|word| word.parse().ok()).unwrap_or(7);
    let only = words.next();
    let mesh = Arc::new(mesh::ball_in_room(level));
    let attributes = mesh.positions.len() * 12 + mesh.normals.len() * 12 + mesh.triangles.len() * 12;
    let uvs = mesh.positions.len() * 8;
    let million = mesh.triangles.len() as f64 * 1e-6;
    let mut build = vec![];
    let mut triangles = Triangles::new(Arc::clone(&mesh));
    for _ in 0..3 {
        let begin = Instant::now();
        triangles = Triangles::new(Arc::clone(&mesh));
        build.push(begin.elapsed().as_secs_f64());
    }
    let each = |bytes: usize| bytes as f64 * 1e-6 / million;
    println!(
        "{} triangles; bytes a triangle: tree {:.1}, mesh {:.1}",
        mesh.triangles.len(),
        each(triangles.bytes()),
        each(attributes + uvs)
    );
    println!(
        "built in {:.3} s a million, on {} threads",
        median(&mut build) / million,
        rayon::current_num_threads()
    );
    let binary = Binary::new(&triangles);
    let nearest_of_two =
        |line: &Line| binary.nearest(line, f64::INFINITY).map_or(0.0, |m| m.s + f64::from(m.triangle));
    let nearest =
        |line: &Line| triangles.nearest(line, f64::INFINITY).map_or(0.0, |m| m.s + f64::from(m.triangle));
    let place = |line: &Line| {
        triangles.nearest(line, f64::INFINITY).map(|m| {
            let [a, b, c] = triangles.corners(m.triangle);
            (line.origin + line.step * m.s, (b - a).cross(c - a).normalize_or(DVec3::Z))
        })
    };
    println!(
        "\nmillion rays a second, medians of {runs}\n{:12} {:>8} {:>8} {:>8}",
        "", "two", "eight", "ratio"
    );
    let primary = rays::primary();
    let bounce = rays::bounce(&primary, place);
    let sets: [Set<'_>; 3] =
        [("primary", &primary), ("incoherent", &rays::incoherent()), ("bounce", &bounce)];
    for (name, lines) in sets {
        if only.as_deref().is_none_or(|only| only == name) {
            compare(name, lines, runs, nearest_of_two, nearest);
        }
    }
    if only.as_deref().is_none_or(|only| only == "shadow") {
        let any_of_two = |line: &Line| f64::from(u8::from(binary.any(line, 3.0)));
        compare("shadow", &bounce, runs, any_of_two, |line| f64::from(u8::from(triangles.any(line, 3.0))));
    }
}
