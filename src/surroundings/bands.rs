//! Which of many points on a sphere lie near a direction: bands of latitude, cut into cells.

use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Most bands; their cells are fewer than 1.3 times the square of it.
const MOST_BANDS: usize = 1024;
/// Added to angles, so that rounding loses no point.
const SLACK: f64 = 1e-9;

/// Points sorted into cells that are about as high as wide. Cells of a band, and bands, follow one another, so that a stretch of
/// cells is a stretch of points.
#[derive(Debug, Clone)]
pub(super) struct Bands {
    /// For each band the number of its first cell; one more at the end.
    first: Vec<u32>,
    /// For each cell the number of its first point; one more at the end.
    start: Vec<u32>,
}

impl Bands {
    /// The cells for points, and the order in which these must be put: by cell, otherwise as they come.
    pub(super) fn new(points: &[DVec3]) -> (Self, Vec<u32>) {
        let bands = ((points.len() as f64).sqrt().ceil() as usize).clamp(1, MOST_BANDS);
        let mut first = vec![0];
        for band in 0..bands {
            let middle = PI * (band as f64 + 0.5) / bands as f64;
            let cells = (2.0 * bands as f64 * libm::sin(middle)).round().max(1.0) as u32;
            first.push(first[band] + cells);
        }
        let mut sorted = Self { start: Vec::new(), first };
        let cells: Vec<u32> = points.iter().map(|point| sorted.cell(*point)).collect();
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        order.sort_by_key(|i| cells[*i as usize]);
        let count = sorted.first[bands];
        sorted.start = vec![0; count as usize + 1];
        for cell in cells {
            sorted.start[cell as usize + 1] += 1;
        }
        for cell in 1..=count as usize {
            sorted.start[cell] += sorted.start[cell - 1];
        }
        (sorted, order)
    }

    fn count(&self) -> usize {
        self.first.len() - 1
    }

    fn cell(&self, d: DVec3) -> u32 {
        let band = self.band(polar(d));
        let cells = self.first[band + 1] - self.first[band];
        self.first[band] + column(azimuth(d), cells)
    }

    /// The band of an angle from +y; the outermost for one beyond the poles.
    fn band(&self, polar: f64) -> usize {
        ((polar / PI * self.count() as f64) as usize).min(self.count() - 1)
    }

    /// Shows all points within `radius` (radians) of a direction, and others near them: as stretches of their new order.
    pub(super) fn near(&self, d: DVec3, radius: f64, mut show: impl FnMut(Range<usize>)) {
        let radius = radius + SLACK;
        let from_pole = polar(d);
        let (upper, lower) = (from_pole - radius, from_pole + radius);
        let (top, bottom) = (self.band(upper.max(0.0)), self.band(lower.min(PI)));
        let around_pole = upper <= 0.0 || lower >= PI;
        if around_pole {
            let cells = self.first[top] as usize..self.first[bottom + 1] as usize;
            return show(self.start[cells.start] as usize..self.start[cells.end] as usize);
        }
        // The meridians that touch a circle without a pole in it.
        let half = libm::asin((libm::sin(radius) / libm::sin(from_pole)).min(1.0)) + SLACK;
        let middle = azimuth(d);
        for band in top..=bottom {
            self.stretches(band, middle - half, middle + half, &mut show);
        }
    }

    /// The cells of a band between two azimuths, of which the first may be below zero or the second above 2π.
    fn stretches(&self, band: usize, from: f64, to: f64, show: &mut impl FnMut(Range<usize>)) {
        let (base, end) = (self.first[band], self.first[band + 1]);
        let cells = end - base;
        let mut show = |from: u32, to: u32| {
            show(self.start[from as usize] as usize..self.start[to as usize] as usize);
        };
        let before = if from < 0.0 { from + TAU } else { from };
        let after = if to >= TAU { to - TAU } else { to };
        let (left, right) = (column(before, cells), column(after, cells));
        let wraps = before != from || after != to;
        if !wraps {
            show(base + left, base + right + 1);
        } else if left <= right {
            show(base, end);
        } else {
            show(base, base + right + 1);
            show(base + left, end);
        }
    }
}

/// The cell of a band with a number of them in which an azimuth lies.
fn column(azimuth: f64, cells: u32) -> u32 {
    ((azimuth / TAU * f64::from(cells)) as u32).min(cells - 1)
}

/// The angle from +y.
fn polar(d: DVec3) -> f64 {
    libm::atan2(libm::hypot(d.x, d.z), d.y)
}

/// The angle around +y, from 0 to 2π.
fn azimuth(d: DVec3) -> f64 {
    let angle = libm::atan2(d.x, d.z);
    if angle < 0.0 { angle + TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surroundings::{Kinds, seeded};

    const RADII: [f64; 8] = [1e-9, 1e-6, 0.01, 0.1, 0.7, 1.6, 3.0, 3.15];

    fn directions(seed: u64, count: usize) -> Vec<DVec3> {
        seeded(seed, count, Kinds::Alike { kelvin: 5000.0, magnitude: 0.0 })
            .map(|star| star.direction)
            .collect()
    }

    /// Random points, points on the axes and close by, and many in one place.
    fn points(count: usize) -> Vec<DVec3> {
        let mut points = directions(1, count);
        for axis in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
            points.extend((0..3).map(|i| (axis + directions(9, 3)[i] * 1e-8).normalize()));
            points.push(axis);
        }
        points.extend(vec![DVec3::new(0.6, 0.0, 0.8); 5]);
        points
    }

    /// The points within an angle of a direction, by cells (if there are any) or one by one.
    fn found(points: &[DVec3], d: DVec3, radius: f64, cells: Option<&(Bands, Vec<u32>)>) -> Vec<u32> {
        let chord = if radius < PI { 2.0 * libm::sin(0.5 * radius) } else { 2.1 };
        let mut numbers = Vec::new();
        match cells {
            None => numbers.extend(0..points.len() as u32),
            Some((bands, order)) => {
                bands.near(d, radius, |stretch| numbers.extend_from_slice(&order[stretch]));
            }
        }
        numbers.retain(|i| d.distance(points[*i as usize]) <= chord);
        numbers.sort_unstable();
        numbers
    }

    #[test]
    fn cells_hold_all_points_that_a_search_one_by_one_finds_each_once() {
        for count in [0, 3, 2000] {
            let points = points(count);
            let cells = Bands::new(&points);
            let mut looks = points[..points.len().min(60)].to_vec();
            looks.extend(directions(2, 60));
            looks.extend(DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]));
            for (d, radius) in looks.iter().flat_map(|d| RADII.map(|radius| (*d, radius))) {
                let all = found(&points, d, radius, None);
                assert_eq!(found(&points, d, radius, Some(&cells)), all, "{d} {radius}");
            }
        }
    }

    #[test]
    fn narrow_search_looks_at_few_points() {
        let points = directions(3, 20_000);
        let (bands, _) = Bands::new(&points);
        let mut most = 0;
        for d in directions(4, 2000).into_iter().chain([DVec3::Y, -DVec3::Y]) {
            let mut count = 0;
            bands.near(d, 1e-3, |stretch| count += stretch.len());
            most = most.max(count);
        }
        assert!(most < 60, "{most}");
    }

    #[test]
    fn no_point_is_shown_twice() {
        // A half circle's meridians end in the same cell, of two.
        let points = [DVec3::new(1e-12, 0.0, -1.0), DVec3::new(-1e-12, 0.0, -1.0)];
        for point in points {
            let (bands, _) = Bands::new(&[point]);
            for radius in [0.5 * PI - 2e-9, 0.5 * PI, 3.0] {
                let mut count = 0;
                bands.near(DVec3::X, radius, |stretch| count += stretch.len());
                assert!(count <= 1, "{point} {radius}");
            }
        }
    }
}
