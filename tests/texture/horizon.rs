//! A chequered floor to the horizon: what is seen at 4 samples per pixel against 4096.

use super::{Texture, texture};
use glam::DVec2;
use terrell::film::Reconstruction;
use terrell::texture::{Encoding, Footprint, Texels};

const WIDTH: u32 = 96;
/// Rows below the horizon.
const ROWS: u32 = 40;
const SAMPLES: u32 = 4;
/// The side of a square, texels; eight of them make the texture.
const SQUARE: u32 = 8;

fn floor() -> Texture {
    let side = 8 * SQUARE;
    let white = |i: u32| (i % side / SQUARE + i / side / SQUARE).is_multiple_of(2);
    let texels = (0..side * side).map(|i| if white(i) { [255; 4] } else { [0, 0, 0, 255] }).collect();
    texture(side, side, Texels::Byte(texels), Encoding::Srgb)
}

/// A pinhole at a height over the floor, in sides of the texture, moved across it.
#[derive(Clone, Copy)]
struct Eye {
    height: f64,
    at: DVec2,
}

impl Eye {
    /// What lies under a place in the picture, and how it moves with that place's column and row.
    fn floor(&self, place: DVec2) -> Option<[DVec2; 3]> {
        let x = (place.x - 0.5 * f64::from(WIDTH)) / f64::from(WIDTH);
        let y = place.y / f64::from(WIDTH);
        let turned = |v: DVec2| DVec2::from_angle(0.3).rotate(v) * self.height;
        let pixel = 1.0 / f64::from(WIDTH);
        (y > 0.0).then(|| {
            [
                self.at + turned(DVec2::new(x, 1.0) / y),
                turned(DVec2::new(pixel / y, 0.0)),
                turned(DVec2::new(x, 1.0) * (-pixel / (y * y))),
            ]
        })
    }

    fn picture(&self, samples: u32, light: impl Fn([DVec2; 3]) -> f32) -> Vec<f64> {
        let offsets = Reconstruction::default().offsets(samples);
        let pixel = |column: u32, row: u32| {
            // The samples of the first row would reach over the horizon.
            let centre = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 2.0);
            let seen = |offset: &DVec2| self.floor(centre + *offset).map_or(0.2, &light);
            offsets.iter().map(|offset| f64::from(seen(offset))).sum::<f64>() / f64::from(samples)
        };
        (0..ROWS)
            .flat_map(|row| (0..WIDTH).map(move |column| (column, row)))
            .map(|(c, r)| pixel(c, r))
            .collect()
    }
}

/// How a film of pictures differs from another, which is right.
#[derive(Debug)]
struct Verdict {
    /// The root of the mean square of the differences.
    error: f64,
    /// How much of the right contrast is there, as the slope of one over the other.
    contrast: f64,
    /// As `error`, of the differences from one picture to the next.
    crawl: f64,
}

fn judge(pictures: &[Vec<f64>], right: &[Vec<f64>]) -> Verdict {
    let root = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let (all, all_right) = (pictures.concat(), right.concat());
    let grey = all_right.iter().sum::<f64>() / all_right.len() as f64;
    let slope = |of: &[f64]| of.iter().zip(&all_right).map(|(a, b)| (a - grey) * (b - grey)).sum::<f64>();
    let steps: Vec<f64> = (1..pictures.len())
        .flat_map(|i| minus(&minus(&pictures[i], &pictures[i - 1]), &minus(&right[i], &right[i - 1])))
        .collect();
    Verdict {
        error: root(&minus(&all, &all_right)),
        contrast: slope(&all) / slope(&all_right),
        crawl: root(&steps),
    }
}

/// By footprints, by round ones as wide as these are long, and by points.
fn verdicts(height: f64) -> [Verdict; 3] {
    let floor = floor();
    // The nearest row moves by a third of a pixel from one picture to the next.
    let step = DVec2::new(0.25, 0.3) * (height / f64::from(ROWS));
    let eyes = [0.0, 1.0, 2.0].map(|i| Eye { height, at: step * i });
    let half = 0.5 / f64::from(SAMPLES).sqrt();
    let right = eyes.map(|eye| eye.picture(4096, |[uv, ..]| floor.rgba(uv)[0]));
    let shaped = |[uv, u, v]: [DVec2; 3]| floor.over(uv, &Footprint { u: u * half, v: v * half })[0];
    let isotropic = |[uv, u, v]: [DVec2; 3]| {
        let radius = half * u.length().max(v.length());
        floor.over(uv, &Footprint { u: DVec2::X * radius, v: DVec2::Y * radius })[0]
    };
    [
        judge(&eyes.map(|eye| eye.picture(SAMPLES, shaped)), &right),
        judge(&eyes.map(|eye| eye.picture(SAMPLES, isotropic)), &right),
        judge(&eyes.map(|eye| eye.picture(SAMPLES, |[uv, ..]| floor.rgba(uv)[0])), &right),
    ]
}

#[test]
fn chequered_floor_to_the_horizon_neither_blurs_nor_crawls() {
    // Squares of 12, 4 and 1.2 pixels in the nearest row.
    for (height, error, loss) in [(0.08, 0.025, 0.02), (0.3, 0.035, 0.02), (1.0, 0.05, 0.08)] {
        let [footprints, round, points] = verdicts(height);
        assert!(footprints.error < error, "{footprints:?}");
        assert!((footprints.contrast - 1.0).abs() < loss, "{footprints:?}");
        assert!(footprints.error < 0.9 * round.error && footprints.error < 0.5 * points.error);
        assert!(footprints.crawl < 0.95 * round.crawl && footprints.crawl < 0.5 * points.crawl);
    }
}
