//! Star catalogues: CSV files.

use super::stars::{COOLEST_K, HOTTEST_K, MOST_STARS, Star};
use crate::error::{Place, Report, table_lines};
use glam::DVec3;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

/// Faults after which reading stops.
const MOST_FAULTS: usize = 100;
/// A row as it should be: Sirius.
const EXAMPLE: &str = "101.287, -16.716, -1.46, 9940";

/// What a column holds, its range, and what to type when it is not in it.
const COLUMNS: [(&str, RangeInclusive<f64>, &str); 4] = [
    ("right ascension", -360.0..=360.0, "degrees from 0 to 360, 15 for each hour, such as 101.287"),
    ("declination", -90.0..=90.0, "degrees from -90 to 90, such as -16.716"),
    ("magnitude", -50.0..=50.0, "a visual magnitude from -50 to 50, such as -1.46"),
    ("temperature", COOLEST_K..=HOTTEST_K, "kelvin from 500 to 1e7, such as 9940"),
];

/// The stars of a catalogue: rows of right ascension and declination in degrees, visual magnitude, temperature in kelvin.
///
/// A first line without any number names the columns, lines that begin with `#` are comments. The celestial
/// north pole is +y, right ascension 0 lies at -z and 90° (6 h) at -x: seen from inside, with north up, it grows to the left.
///
/// None when something is wrong; what, is in the report.
pub fn parse_catalogue(path: &Path, text: &Arc<str>, report: &mut Report) -> Option<Vec<Star>> {
    let already = report.faults.len();
    let (mut stars, mut is_first) = (Vec::new(), true);
    for (from, kept) in table_lines(text) {
        let is_heading = is_first && kept.split(',').all(|cell| cell.trim().parse::<f64>().is_err());
        is_first = false;
        if is_heading {
            continue;
        }
        if stars.len() == MOST_STARS {
            let what = format!("the catalogue has more than {MOST_STARS} stars");
            report.fault(Place::file(path), what, "leave out the faintest");
            break;
        }
        let place = |at: usize, length: usize| {
            let span = from + at..from + at + length;
            Place::Text { path: path.into(), text: text.clone(), span }
        };
        stars.extend(row(kept, place, report));
        if report.faults.len() - already >= MOST_FAULTS {
            break;
        }
    }
    if stars.is_empty() && report.faults.len() == already {
        report.fault(Place::file(path), "the catalogue has no star", format!("a row such as `{EXAMPLE}`"));
    }
    (report.faults.len() == already).then_some(stars)
}

/// The star of a row; `place` makes a place of a start within the row and a length.
fn row(kept: &str, place: impl Fn(usize, usize) -> Place, report: &mut Report) -> Option<Star> {
    let cells = kept.split(',').count();
    if cells != COLUMNS.len() {
        let what = format!(
            "a row has right ascension, declination, magnitude and temperature, this one {cells} {}",
            if cells == 1 { "value" } else { "values" }
        );
        report.fault(place(0, kept.len()), what, format!("such as `{EXAMPLE}`"));
        return None;
    }
    let (mut numbers, mut sound, mut at) = ([0.0; 4], true, 0);
    for ((cell, number), (name, range, hint)) in kept.split(',').zip(&mut numbers).zip(&COLUMNS) {
        let written = cell.trim();
        let here = || place(at + (cell.len() - cell.trim_start().len()), written.len());
        match written.parse::<f64>() {
            Ok(value) if range.contains(&value) => *number = value,
            Ok(_) => {
                sound = false;
                report.fault(here(), format!("there is no {name} of {written}"), format!("type {hint}"));
            }
            Err(_) => {
                sound = false;
                report.fault(
                    here(),
                    format!("the {name} `{written}` is not a number"),
                    format!("type {hint}"),
                );
            }
        }
        at += cell.len() + 1;
    }
    let [ascension, declination, magnitude, kelvin] = numbers;
    sound.then(|| Star::of_magnitude(direction(ascension, declination), kelvin, magnitude))
}

/// Where right ascension and declination (degrees) point.
fn direction(ascension: f64, declination: f64) -> DVec3 {
    let (sin_a, cos_a) = libm::sincos(ascension.to_radians());
    let (sin_d, cos_d) = libm::sincos(declination.to_radians());
    DVec3::new(-cos_d * sin_a, sin_d, -cos_d * cos_a)
}
