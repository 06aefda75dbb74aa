//! When pictures are taken.

use super::Spanned;
use super::node::Node;
use super::plain::{Count, Placed, words};
use super::quantity::Instant;
use super::reader::{Read, Reader};
use super::record::{Kind, Shape, record};
use crate::error::Place;

/// Most exposures.
pub(super) const MOST_EXPOSURES: u32 = 1_000_000;

words! {
    /// The clock by which exposures are timed.
    Clock, "a clock" {
        /// The observer's own.
        "own" => Own;
        /// That of the lab.
        "lab" => Lab;
    }
}

record! {
    /// When pictures are taken: `count` of them from `from` to `to`, both included, or one `at` a time.
    ExposuresKeys, "the exposures" {
        /// The first.
        from: Option<f64> = Instant, optional, "-4 s";
        /// The last.
        to: Option<Spanned<f64>> = Placed<Instant>, optional, "9 s";
        /// The only one (or that of a ring of observers).
        at: Option<Spanned<f64>> = Placed<Instant>, optional, "2 s";
        /// How many.
        count: Option<u32> = Count<1, MOST_EXPOSURES>, optional, "96";
        /// By whose clock: `own` (the observer's proper time) unless said.
        clock: Clock = Clock, default(Clock::Own), "lab";
    }
}

/// When pictures are taken. Metres of light travel.
#[derive(Debug, Clone)]
pub struct Exposures {
    /// Where it is written.
    pub place: Place,
    /// The first; with a `count` of 1 the only one.
    pub from: f64,
    /// The last.
    pub to: f64,
    /// How many, evenly spaced.
    pub count: u32,
    /// By whose clock.
    pub clock: Clock,
    /// Whether any of their times is said; else those of an animated camera's keys take their place.
    pub timed: bool,
    /// Whether `count` is said.
    pub counted: bool,
}

/// Exposures, checked.
pub(crate) struct ExposuresKind;

impl Kind for ExposuresKind {
    type Value = Exposures;
    fn shape() -> Shape {
        ExposuresKeys::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Exposures> {
        let keys = ExposuresKeys::read(node, reader)?;
        let (from, to) = span(&keys, reader)?;
        let timed = !reader.filmed || keys.from.is_some() || keys.at.is_some();
        let counted = keys.count.is_some();
        let Some(to) = to else {
            let count = keys.count.unwrap_or(1);
            if count == 1 || reader.ring || !timed {
                return Ok(Exposures {
                    place: keys.place,
                    from,
                    to: from,
                    count,
                    clock: keys.clock,
                    timed,
                    counted,
                });
            }
            let what = format!("{count} exposures need a time from which and one to which");
            return Err(reader.missing(&keys.place, what, "from: 0 s, to: 4 s"));
        };
        let Some(count) = keys.count else {
            return Err(reader.missing(&keys.place, "how many exposures?", "count: 96"));
        };
        let instant_ring = reader.ring && to.value >= from;
        // The ring may be in a manifest that could not be had.
        let instant_ring = instant_ring || reader.partial && to.value == from;
        if count > 1 && to.value <= from && !instant_ring {
            let text = |key: &str| node.get(key).and_then(|node| node.text()).unwrap_or("0 s").to_owned();
            let hint = if to.value == from {
                "count: 1".to_owned()
            } else {
                format!("from: {}, to: {}", text("to"), text("from"))
            };
            return Err(reader.fault(&to.place, "`to` is not later than `from`", hint));
        }
        Ok(Exposures { place: keys.place, from, to: to.value, count, clock: keys.clock, timed, counted })
    }
}

/// The first time, and the last if it is written.
fn span(keys: &ExposuresKeys, reader: &mut Reader<'_>) -> Read<(f64, Option<Spanned<f64>>)> {
    match (&keys.from, &keys.to, &keys.at) {
        (None, None, at) => Ok((at.as_ref().map_or(0.0, |at| at.value), None)),
        (Some(_), _, Some(at)) | (None, Some(_), Some(at)) => {
            let what = "exposures are either `at` a time or `from` one `to` another";
            Err(reader.fault(&at.place, what, "remove `at`, or `from` and `to`"))
        }
        (None, Some(to), None) => {
            Err(reader.missing(&to.place, "exposures have a `to` but no `from`", "from: 0 s"))
        }
        (Some(from), to, None) => Ok((*from, to.clone())),
    }
}
