//! How lights and materials change, in their own times.

use super::node::{Content, Node};
use super::plain::{NotNegative, Part};
use super::quantity::{Instant, Period};
use super::reader::{Read, Reader};
use super::record::{Kind, List, Shape, choice, record};
use super::spectrum::{Spectrum, SpectrumKind};
use std::marker::PhantomData;
use std::sync::Arc;

record! {
    /// When something is lit, on and off, on the clock of what shines: that reads zero where it passes its `at`.
    pub Blinking, "what blinks" {
        /// From one lighting up to the next, metres of light travel: a time, or the way of light in it.
        period: f64 = Period, required, "6.67 ns";
        /// The part of each period in which it is lit: 0.5 unless said.
        lit: f64 = Part, default(0.5), "0.5";
        /// A time at which it lights up, metres of light travel: 0 s unless said.
        start: f64 = Instant, default(0.0), "0 s";
    }
}

record! {
    /// What a light is like at one time; linear between one and the next, and held before the first and after the last.
    pub Key, "a moment of a light" {
        /// When, on its own clock, metres of light travel.
        at: f64 = Instant, required, "2 s";
        /// How bright, as a multiple of what the light says: 1 unless said.
        brightness: f64 = NotNegative, default(1.0), "0.2";
        /// Its spectrum from here on; that of the key before (or of the light) unless said.
        spectrum: Option<Arc<Spectrum>> = SpectrumKind, optional, "{ black_body: 2000 K }";
    }
}

choice! {
    /// How a light changes on its own clock: not at all unless said.
    pub Course, "the course of a light", otherwise(Course::Steady) {
        @unit Steady, "It does not change.";
        /// It goes on and off.
        blinking => Blinking(Blinking) = Blinking, "{ period: 6.67 ns }";
        /// Its brightness, and its spectrum if said, at several of its own times, in their order.
        keys => Keys(Vec<Key>) = Rising<Key>, "[{ at: 0 s }, { at: 2 s, brightness: 0.2 }]";
    }
}

/// A list of keys, each with its time, which rise.
pub(crate) struct Rising<K>(PhantomData<K>);

/// Something at a time.
pub(crate) trait Timed {
    /// The key under which its time is written.
    const KEY: &'static str = "at";
    /// Metres of light travel.
    fn at(&self) -> f64;
}

impl Timed for Key {
    fn at(&self) -> f64 {
        self.at
    }
}

impl<K: Kind> Kind for Rising<K>
where
    K::Value: Timed,
{
    type Value = Vec<K::Value>;
    fn shape() -> Shape {
        List::<K>::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Self::Value> {
        let keys = List::<K>::read(node, reader)?;
        let Content::List(items) = &node.content else { return Ok(keys) };
        let mut rising = Ok(());
        for (pair, nodes) in keys.windows(2).zip(items.windows(2)) {
            let ([before, key], [before_node, key_node]) = (pair, nodes) else { continue };
            if key.at() <= before.at() {
                let text = |node: &Node| {
                    node.get(K::Value::KEY).and_then(|at| at.text()).unwrap_or("0 s").to_owned()
                };
                let (first, second) = (text(before_node), text(key_node));
                let place = key_node.get(K::Value::KEY).map_or(&key_node.place, |at| &at.place);
                let what = format!("the times of keys must rise: `{second}` comes after `{first}`");
                rising =
                    Err(reader.fault(place, what, "put the keys in the order of their times, each once"));
            }
        }
        if keys.is_empty() {
            let hint = format!("keys: [{{ {0}: 0 s, .. }}, {{ {0}: 2 s, .. }}], or remove it", K::Value::KEY);
            rising = Err(reader.fault(&node.place, "here are no keys", hint));
        }
        rising.map(|()| keys)
    }
}
