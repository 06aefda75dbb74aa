//! Where a line passes through the surface of a whole solid.

use super::{Leaf, NONE, Slot, Solid};
use crate::tree::Line;

/// How far two faces that are meant to coincide may be apart, in parts of the coordinates they come from: some dozen
/// roundings of maps that follow each other.
pub(super) const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Where a line passes through the surface of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The line's parameter.
    pub s: f64,
    /// Number of the leaf whose surface it is.
    pub leaf: u32,
    /// Number of the leaf's face.
    pub face: u8,
    /// Whether the line goes into the whole solid, by growing s.
    pub entering: bool,
}

/// A crossing of a leaf alone.
#[derive(Clone, Copy)]
struct Event {
    s: f64,
    // How far its s may be from that of a face meant to be the same.
    tolerance: f64,
    leaf: u32,
    face: u8,
    entering: bool,
}

const NOTHING: Event = Event { s: 0.0, tolerance: 0.0, leaf: 0, face: 0, entering: false };

impl Solid {
    /// The first crossing at `s_min` < s < `s_max`.
    #[inline]
    pub fn nearest(&self, line: &Line, s_min: f64, s_max: f64) -> Option<Crossing> {
        let mut nearest = None;
        self.each(line, s_min, s_max, &mut |crossing| {
            nearest = Some(crossing);
            false
        });
        nearest
    }

    /// Calls `visit` with every crossing at `s_min` < s < `s_max` in their order, as long as it returns true.
    ///
    /// They go in and out by turns. Faces of leaves that coincide within rounding count as one: two boxes that
    /// touch have no face between them, and a box cut out of its like leaves nothing.
    pub fn crossings(&self, line: &Line, s_min: f64, s_max: f64, visit: &mut dyn FnMut(Crossing) -> bool) {
        self.each(line, s_min, s_max, &mut |crossing| visit(crossing));
    }

    #[inline]
    fn each(&self, line: &Line, s_min: f64, s_max: f64, visit: &mut impl FnMut(Crossing) -> bool) {
        let mut visit = |crossing: Crossing| {
            if crossing.s > s_min && crossing.s < s_max { visit(crossing) } else { crossing.s < s_max }
        };
        match (&*self.leaves, self.leaves.len().max(self.gates.len())) {
            ([leaf], _) if self.gates.is_empty() => leaf.alone(line, &mut visit),
            (_, ..=4) => self.sweep(line, &mut [NOTHING; 8], &mut [0; 4], &mut visit),
            (_, ..=32) => self.sweep(line, &mut [NOTHING; 64], &mut [0; 32], &mut visit),
            (_, many) => self.sweep(line, &mut vec![NOTHING; 2 * many], &mut vec![0; many], &mut visit),
        }
    }

    /// Goes along the ends of all leaves' spans and tells where the whole expression changes.
    fn sweep(
        &self,
        line: &Line,
        events: &mut [Event],
        counts: &mut [u32],
        visit: &mut impl FnMut(Crossing) -> bool,
    ) {
        // All leaves take the line from one point near them: they share its rounding.
        let shift = (self.centre - line.origin).dot(line.step) / line.step.length_squared();
        let near = Line { origin: line.origin + line.step * shift, step: line.step };
        if !near.origin.is_finite() {
            return;
        }
        let events = self.events(&near, events);
        for (count, gate) in counts.iter_mut().zip(&self.gates) {
            *count = gate.resting;
        }
        let mut inside = self.resting;
        let mut at = 0;
        while at < events.len() {
            let (first, before) = (events[at], inside);
            let mut last = first;
            loop {
                let event = events[at];
                let changed = self.toggle(counts, self.leaves[event.leaf as usize].slot, event.entering);
                if let Some(value) = changed {
                    (inside, last) = (value, event);
                }
                at += 1;
                let more = events.get(at);
                // Infinities are never apart by a number.
                if !more.is_some_and(|next| next.s - first.s <= first.tolerance.min(next.tolerance)) {
                    break;
                }
            }
            let Event { s, leaf, face, .. } = last;
            if inside != before && !visit(Crossing { s: s + shift, leaf, face, entering: inside }) {
                return;
            }
        }
    }

    /// The ends of all leaves' spans, in their order.
    fn events<'e>(&self, line: &Line, events: &'e mut [Event]) -> &'e [Event] {
        let at_rest = ROUNDING * (self.size + line.origin.length());
        let along = ROUNDING * line.step.length();
        let mut count = 0;
        for (number, leaf) in self.leaves.iter().enumerate() {
            let own = leaf.line(line);
            let Some(span) = leaf.shape.span(&own) else { continue };
            for (end, entering) in [(span.enter, true), (span.exit, false)] {
                let outwards = leaf.shape.outwards(end.face, own.origin + own.step * end.s);
                // A place that is off by this is met earlier or later, the more so the flatter.
                let error = at_rest + along * end.s.abs();
                let approach =
                    outwards.dot(own.step).abs() / (leaf.solid_from_own_normals * outwards).length();
                let tolerance = if approach > 0.0 { error / approach } else { 0.0 };
                events[count] = Event { s: end.s, tolerance, leaf: number as u32, face: end.face, entering };
                count += 1;
            }
        }
        let events = &mut events[..count];
        events.sort_unstable_by(|a, b| a.s.total_cmp(&b.s).then(a.leaf.cmp(&b.leaf)));
        events
    }

    /// Tells a leaf's gate of its new value, and further up what changes by that; returns what becomes of the whole.
    #[inline]
    pub(super) fn toggle(&self, counts: &mut [u32], mut slot: Slot, mut value: bool) -> Option<bool> {
        loop {
            value = value != slot.complement;
            if slot.gate == NONE {
                return Some(value);
            }
            let gate = &self.gates[slot.gate as usize];
            let count = &mut counts[slot.gate as usize];
            // At the step to what it needs, or the one back.
            let turns = *count + u32::from(value) == gate.needs;
            *count = if value { *count + 1 } else { *count - 1 };
            if !turns {
                return None;
            }
            slot = gate.slot;
        }
    }
}

impl Leaf {
    #[inline]
    fn alone(&self, line: &Line, visit: &mut impl FnMut(Crossing) -> bool) {
        let Some(span) = self.shape.span(&self.line(line)) else { return };
        let crossing = |s, face, into| Crossing { s, leaf: 0, face, entering: into != self.turned };
        if visit(crossing(span.enter.s, span.enter.face, true)) {
            visit(crossing(span.exit.s, span.exit.face, false));
        }
    }
}
