//! A path of the observer through places at given times.

use super::course::{Rising, Timed};
use super::node::{Content, Node};
use super::quantity::{Instant, Point, Written};
use super::reader::{Read, Reader, Reported};
use super::record::{Kind, List, Shape, record};
use super::units;
use crate::spacetime::{TooFast, Track};
use glam::DVec3;
use std::sync::Arc;

/// Pieces of a path that are told to be too fast one by one.
const MOST_TOLD: usize = 8;
/// Keys of a path for which it is tried out when they would have to be.
const MOST_TRIED: usize = 2000;
/// A path that is proposed stays below this speed.
const PROPOSED: f64 = 0.95;

record! {
    /// Where the observer is at one time.
    pub ObserverKey, "a moment of the observer" {
        /// Where it is in S, metres.
        at: DVec3 = Point, required, "0 1 5 m";
        /// When, in S's time, metres of light travel.
        at_time: f64 = Instant, required, "2 s";
    }
}

impl Timed for ObserverKey {
    const KEY: &'static str = "at_time";
    fn at(&self) -> f64 {
        self.at_time
    }
}

/// A list of those, and the path through them, checked to be slower than light everywhere.
pub(crate) struct PathKeys;

impl Kind for PathKeys {
    type Value = Arc<Track>;
    fn shape() -> Shape {
        List::<ObserverKey>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Arc<Track>> {
        let keys: Vec<(f64, DVec3)> =
            Rising::<ObserverKey>::read(node, reader)?.iter().map(|key| (key.at_time, key.at)).collect();
        let too_fast = match Track::through(&keys) {
            Ok(track) => return Ok(Arc::new(track)),
            Err(too_fast) => too_fast,
        };
        let Content::List(items) = &node.content else { return Err(Reported) };
        let told = worth_telling(&keys, &too_fast);
        for found in told.iter().take(MOST_TOLD) {
            if let Some([before, after]) = items.get(found.piece..found.piece + 2) {
                too_fast_between([before, after], &keys, found, reader);
            }
        }
        if told.len() > MOST_TOLD {
            let more = format!("{} more pieces of this path are too fast", told.len() - MOST_TOLD);
            reader.fault(&node.place, more, "put more time between their keys, or less way");
        }
        Err(Reported)
    }
}

/// Those of the pieces that are too fast of themselves, or faster than the pieces beside them: a fast piece makes others
/// fast, since the path has no corners.
fn worth_telling(keys: &[(f64, DVec3)], too_fast: &[TooFast]) -> Vec<TooFast> {
    // They come in the order of the pieces.
    let speed = |piece: usize| {
        let at = too_fast.binary_search_by_key(&piece, |found| found.piece);
        at.ok().and_then(|at| too_fast.get(at)).map_or(0.0, |found| found.speed)
    };
    let mut told = too_fast.to_vec();
    told.retain(|found| {
        let straight = match keys.get(found.piece..found.piece + 2) {
            Some([from, to]) => (to.1 - from.1).length() / (to.0 - from.0),
            _ => 0.0,
        };
        let before = found.piece.checked_sub(1).map_or(0.0, speed);
        straight >= 1.0 || (found.speed >= before && found.speed > speed(found.piece + 1))
    });
    told
}

/// Says which keys the path is too fast between, and what the time of the second would have to be.
fn too_fast_between(
    [before, after]: [&std::rc::Rc<Node>; 2],
    keys: &[(f64, DVec3)],
    found: &TooFast,
    reader: &mut Reader<'_>,
) {
    let text = |node: &Node| node.get("at_time").and_then(|at| at.text()).unwrap_or("0 s").to_owned();
    let (first, second) = (text(before), text(after));
    // Times are told in the unit of the second key.
    let unit = Written::of(&second).rest;
    let metres = units::find(&units::plain(unit), Instant::QUANTITY.dimensions)
        .map_or(1.0, |known| known.house(1.0, reader.light_speed));
    let told = |t: f64| format!("{} {unit}", rounded(t / metres));
    let (number, next) = (found.piece + 1, found.piece + 2);
    let speed = if found.speed < 1.0 {
        format!("{:.9} c, too near the speed of light", found.speed)
    } else {
        format!("{} c", rounded_up(found.speed))
    };
    let what = format!(
        "between key {number} ({first}) and key {next} ({second}) the path reaches {speed}, at {}",
        told(found.at)
    );
    let hint = match longer(keys, found.piece) {
        Some(longer) => {
            let from = keys.get(found.piece + 1).map_or(0.0, |key| key.0);
            let by = rounded_up((from + longer) / metres) - from / metres;
            let typed = format!("at_time: {} {unit}", rounded(from / metres + by));
            match keys.len() - next {
                0 => typed,
                1 => format!("{typed}, and the key after it as much later ({})", told(by * metres)),
                _ => format!("{typed}, and all keys after it as much later ({})", told(by * metres)),
            }
        }
        None => "put more time between these keys, or less way".to_owned(),
    };
    let place = after.get("at_time").map_or(&after.place, |at| &at.place);
    reader.fault(place, what, hint);
}

/// How much later the key after `piece` and all that follow must be: for the whole path to be slow, or at least this
/// piece; none if no such time is found.
fn longer(keys: &[(f64, DVec3)], piece: usize) -> Option<f64> {
    if keys.len() > MOST_TRIED {
        return None;
    }
    let speeds = |later: f64| {
        let put = |(i, (t, x)): (usize, &(f64, DVec3))| (if i > piece { t + later } else { *t }, *x);
        Track::fastest(&keys.iter().enumerate().map(put).collect::<Vec<_>>())
    };
    let all = |later: f64| speeds(later).iter().all(|speed| *speed < PROPOSED);
    let own = |later: f64| speeds(later).get(piece).is_some_and(|speed| *speed < PROPOSED);
    let pair = keys.get(piece..piece + 2)?;
    let straight = (pair[1].1 - pair[0].1).length() + (pair[1].0 - pair[0].0);
    let tries = || (0..12).map(|power| straight * f64::from(1 << power));
    let (mut most, is_all) = tries()
        .find(|later| all(*later))
        .map(|later| (later, true))
        .or_else(|| tries().find(|later| own(*later)).map(|later| (later, false)))?;
    let mut least = 0.0;
    for _ in 0..12 {
        let middle = 0.5 * (least + most);
        let fits = if is_all { all(middle) } else { own(middle) };
        if fits { most = middle } else { least = middle }
    }
    Some(most)
}

/// Three digits, and not fewer than what is before the point.
fn rounded(x: f64) -> f64 {
    to_digits(x, f64::round)
}

/// The same, never less.
fn rounded_up(x: f64) -> f64 {
    to_digits(x, f64::ceil)
}

fn to_digits(x: f64, to_whole: fn(f64) -> f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let place = 2 - libm::floor(libm::log10(x.abs())) as i32;
    // Powers of ten are exact where they are whole.
    let ten = |power: i32| libm::pow(10.0, f64::from(power));
    if place <= 0 {
        return to_whole(x);
    }
    to_whole(x * ten(place)) / ten(place)
}
