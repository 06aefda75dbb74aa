//! Three sets of a million rays.

use glam::DVec3;
use terrell::tree::Line;

/// A set with its name.
pub type Set<'a> = (&'a str, &'a [Line]);

/// Vigna's splitmix64.
struct Dice(u64);

impl Dice {
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * f64::EPSILON / 2.0
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let p = DVec3::from_array([0; 3].map(|_| 2.0 * self.part() - 1.0));
            if (0.01..1.0).contains(&p.length_squared()) {
                return p / p.length();
            }
        }
    }
}

/// A picture of 1024 x 1024, in squares of 8 x 8.
pub fn primary() -> Vec<Line> {
    let eye = DVec3::new(3.5, 2.5, 3.0);
    let ahead = -eye / eye.length();
    let right = ahead.cross(DVec3::Y) / ahead.cross(DVec3::Y).length();
    let up = right.cross(ahead);
    let squares = (0..128 * 128)
        .flat_map(|square| (0..64).map(move |i| (square % 128 * 8 + i % 8, square / 128 * 8 + i / 8)));
    squares
        .map(|(x, y)| {
            let [x, y] = [x, y].map(|c| (f64::from(c) + 0.5) / 512.0 - 1.0);
            let step = ahead + right * (x * 0.55) + up * (y * 0.55);
            Line { origin: eye, step: step / step.length() }
        })
        .collect()
}

/// Chords of a ball around the mesh.
pub fn incoherent() -> Vec<Line> {
    let mut dice = Dice(1);
    (0..1 << 20)
        .map(|_| {
            let (origin, to) = (dice.direction() * 4.0, dice.direction() * 2.5);
            Line { origin, step: (to - origin) / (to - origin).length() }
        })
        .collect()
}

/// From where the rays of another set end, anywhere on that side, in their order.
pub fn bounce(rays: &[Line], place: impl Fn(&Line) -> Option<(DVec3, DVec3)>) -> Vec<Line> {
    let mut dice = Dice(2);
    rays.iter()
        .filter_map(|ray| {
            let (at, normal) = place(ray)?;
            let normal = if normal.dot(ray.step) > 0.0 { -normal } else { normal };
            let step = normal * 1.001 + dice.direction();
            Some(Line { origin: at + normal * 1e-6, step: step / step.length() })
        })
        .collect()
}
