//! What a walk through a tree of eight children has still to visit.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

/// Children still to be visited, with their entries; beyond what most walks need, on the heap.
pub(crate) struct Open {
    last: [u64; HERE],
    count: usize,
    before: Vec<u64>,
}

const HERE: usize = 32;

impl Open {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self { last: [0; HERE], count: 0, before: Vec::new() }
    }

    /// The child of eight that comes next, if any is entered; the others stay open. `met`: the bits of those that are entered,
    /// which is `near`, and not negative. `by_s`: whether the nearest comes first.
    #[inline(always)]
    pub(crate) fn descend(
        &mut self,
        near: &[f32; 8],
        child: &[u32; 8],
        mut met: u32,
        by_s: bool,
    ) -> Option<u32> {
        if met == 0 {
            return None;
        }
        // Most often few are met.
        let one = next(&mut met);
        if met == 0 {
            return Some(child[one]);
        }
        let two = next(&mut met);
        let (a, b) = (told(near, child, one), told(near, child, two));
        if met == 0 {
            self.push(a.max(b));
            return Some(a.min(b) as u32);
        }
        let mut some = [a, b, 0, 0, 0, 0, 0, 0];
        let mut count = 2;
        while met != 0 {
            let lane = next(&mut met);
            some[count & 7] = told(near, child, lane);
            count += 1;
        }
        if by_s {
            far_to_near(&mut some, count);
        }
        for place in 0..count - 1 {
            self.push(some[place & 7]);
        }
        Some(some[(count - 1) & 7] as u32)
    }

    #[inline(always)]
    fn push(&mut self, told: u64) {
        if self.count == HERE {
            self.put_away();
        }
        self.last[self.count % HERE] = told;
        self.count += 1;
    }

    /// The last of them that is entered before the limit.
    #[inline(always)]
    pub(crate) fn pop(&mut self, t_max: f32) -> Option<u32> {
        loop {
            if self.count == 0 && !self.fetch() {
                return None;
            }
            self.count -= 1;
            let told = self.last[self.count % HERE];
            if f32::from_bits((told >> 32) as u32) <= t_max {
                return Some(told as u32);
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn put_away(&mut self) {
        self.before.extend_from_slice(&self.last);
        self.count = 0;
    }

    /// Whether there were any that had been put away.
    #[inline(always)]
    fn fetch(&mut self) -> bool {
        !self.before.is_empty() && self.fetch_some()
    }

    #[cold]
    #[inline(never)]
    fn fetch_some(&mut self) -> bool {
        let rest = self.before.len() - HERE;
        self.last.copy_from_slice(&self.before[rest..]);
        self.before.truncate(rest);
        self.count = HERE;
        true
    }
}

/// The lowest of the children that are left.
#[inline(always)]
fn next(met: &mut u32) -> usize {
    let lane = met.trailing_zeros() as usize & 7;
    *met &= *met - 1;
    lane
}

/// A child with its entry before it: no entry is negative, so that they are ordered as their bits are.
#[inline(always)]
fn told(near: &[f32; 8], child: &[u32; 8], lane: usize) -> u64 {
    u64::from(near[lane].to_bits()) << 32 | u64::from(child[lane])
}

/// Puts the nearest last.
#[inline(always)]
fn far_to_near(some: &mut [u64; 8], count: usize) {
    for end in 1..count {
        let moved = some[end & 7];
        let mut place = end;
        while place > 0 && some[(place - 1) & 7] < moved {
            some[place & 7] = some[(place - 1) & 7];
            place -= 1;
        }
        some[place & 7] = moved;
    }
}
