//! Paths through places at given times: their velocity at every moment, their own time, and how fast they are at most.

use glam::DVec3;
use rayon::prelude::*;

/// The greatest Lorentz factor of a path through keys: γ comes from a β there, and its last digit is a part 1e-7 of it.
const GREATEST_GAMMA: f64 = 1e4;

/// Parts of a piece that are looked at for its greatest speed; beyond, the bound is what is known till then.
const MOST_HALVED: usize = 10_000;

/// Nodes and weights of Gauss and Legendre's rule with eight points (the positive half; Abramowitz and Stegun, table 25.4).
const RULE: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// A path through places at given times, in the frame in which these are given.
///
/// Between the keys it is a cubic in time, with velocity and acceleration continuous at every key (the natural spline):
/// a corner would be an infinite acceleration, and aberration would jump there. Before the first key and after the last it
/// goes on uniformly, where the acceleration is zero already. A single key is a place to stay at.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    pieces: Vec<Piece>,
    /// Times of that frame, from the first key to the last, and the own time then, zero at time zero.
    clock: Vec<(f64, f64)>,
    /// Where it begins and ends: place and velocity.
    ends: [(DVec3, DVec3); 2],
}

/// The way from one key to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    from: f64,
    to: f64,
    place: DVec3,
    velocity: DVec3,
    /// Acceleration at its two ends.
    bend: [DVec3; 2],
}

/// A piece of a path that is not below the speed of light, or too near it for the arithmetic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooFast {
    /// From the key of this number, counted from zero, to the next.
    pub piece: usize,
    /// The greatest speed there, of c: never less than it is.
    pub speed: f64,
    /// When it is reached.
    pub at: f64,
}

impl Track {
    /// Through places at times that rise.
    ///
    /// Errors: the pieces on which it reaches γ = 1e4, or the speed of light.
    pub fn through(keys: &[(f64, DVec3)]) -> Result<Self, Vec<TooFast>> {
        let pieces = pieces(keys);
        let too_fast: Vec<TooFast> = pieces
            .par_iter()
            .enumerate()
            .map(|(number, piece)| {
                let (speed, at) = piece.fastest();
                TooFast { piece: number, speed, at }
            })
            .filter(|found| !((1.0 - found.speed) * (1.0 + found.speed) >= 1.0 / GREATEST_GAMMA.powi(2)))
            .collect();
        if !too_fast.is_empty() {
            return Err(too_fast);
        }
        let (start, place) = keys.first().copied().unwrap_or((0.0, DVec3::ZERO));
        let ends = match (pieces.first(), pieces.last()) {
            (Some(first), Some(last)) => [first.at(first.from), last.at(last.to)],
            _ => [(place, DVec3::ZERO); 2],
        };
        let mut clock = vec![(start, 0.0)];
        // Of a hundred thousand keys these take a second, so each is found by itself, and then they are added up.
        let ticks: Vec<Vec<(f64, f64)>> = pieces.par_iter().map(Piece::ticks).collect();
        let mut own = 0.0;
        clock.extend(ticks.into_iter().flatten().map(|(to, lasts)| {
            own += lasts;
            (to, own)
        }));
        let mut track = Self { pieces, clock, ends };
        let zero = track.own(0.0);
        track.clock.iter_mut().for_each(|(_, own)| *own -= zero);
        Ok(track)
    }

    /// The greatest speed of each piece of a path through places at times that rise, as in [`TooFast::speed`].
    pub fn fastest(keys: &[(f64, DVec3)]) -> Vec<f64> {
        pieces(keys).iter().map(|piece| piece.fastest().0).collect()
    }

    /// The first key's time and the last one's.
    pub fn span(&self) -> (f64, f64) {
        let at = |entry: Option<&(f64, f64)>| entry.map_or(0.0, |(t, _)| *t);
        (at(self.clock.first()), at(self.clock.last()))
    }

    /// Place and velocity at a time.
    pub fn at(&self, t: f64) -> (DVec3, DVec3) {
        let (first, last) = self.span();
        let [start, end] = self.ends;
        if t <= first {
            return (start.0 + start.1 * (t - first), start.1);
        }
        if t >= last {
            return (end.0 + end.1 * (t - last), end.1);
        }
        self.piece(t).map_or(end, |piece| piece.at(t))
    }

    fn piece(&self, t: f64) -> Option<&Piece> {
        self.pieces.get(self.pieces.partition_point(|piece| piece.to < t))
    }

    /// The own time at a time: `∫ √(1 - v²) dt`, zero at time zero.
    pub fn own(&self, t: f64) -> f64 {
        let at = self.clock.partition_point(|(from, _)| *from <= t);
        match (self.clock.get(at.wrapping_sub(1)), self.clock.get(at)) {
            (Some((from, own)), Some(_)) => {
                own + self.piece(0.5 * (from + t)).map_or(0.0, |piece| piece.length(*from, t))
            }
            (None, Some((first, own))) => own + (t - first) * rate(self.ends[0].1),
            (Some((last, own)), None) => own + (t - last) * rate(self.ends[1].1),
            (None, None) => t,
        }
    }

    /// The time at which the own time is `own`.
    pub fn when(&self, own: f64) -> f64 {
        let at = self.clock.partition_point(|(_, known)| *known <= own);
        match (self.clock.get(at.wrapping_sub(1)), self.clock.get(at)) {
            (Some(early), Some(late)) => self.within(*early, *late, own),
            (None, Some((first, known))) => first + (own - known) / rate(self.ends[0].1),
            (Some((last, known)), None) => last + (own - known) / rate(self.ends[1].1),
            (None, None) => own,
        }
    }

    /// Newton's steps, held between two times of the table.
    fn within(&self, (from, known): (f64, f64), (to, next): (f64, f64), own: f64) -> f64 {
        let Some(piece) = self.piece(0.5 * (from + to)) else { return from };
        let (mut early, mut late) = (from, to);
        let mut t = from + (to - from) * ((own - known) / (next - known)).clamp(0.0, 1.0);
        for _ in 0..64 {
            let past = known + piece.length(from, t) - own;
            if past > 0.0 {
                late = t;
            } else {
                early = t;
            }
            let step = t - past / rate(piece.at(t).1);
            let next = if step >= early && step <= late { step } else { 0.5 * (early + late) };
            if (next - t).abs() <= f64::EPSILON * t.abs() {
                return next;
            }
            t = next;
        }
        t
    }
}

/// The cubics between the keys: accelerations at the keys by Thomas' algorithm, zero at both ends.
fn pieces(keys: &[(f64, DVec3)]) -> Vec<Piece> {
    let slope = |pair: &[(f64, DVec3)]| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
    let mut bends = vec![DVec3::ZERO; keys.len()];
    let mut shares = vec![0.0; keys.len()];
    for (i, three) in keys.windows(3).enumerate() {
        let (before, after) = (three[1].0 - three[0].0, three[2].0 - three[1].0);
        let diagonal = 2.0 * (before + after) - before * shares[i];
        shares[i + 1] = after / diagonal;
        bends[i + 1] = (6.0 * (slope(&three[1..]) - slope(three)) - before * bends[i]) / diagonal;
    }
    for i in (1..keys.len().saturating_sub(1)).rev() {
        let next = bends[i + 1];
        bends[i] -= next * shares[i];
    }
    let piece = |(pair, bend): (&[(f64, DVec3)], &[DVec3])| {
        let length = pair[1].0 - pair[0].0;
        Piece {
            from: pair[0].0,
            to: pair[1].0,
            place: pair[0].1,
            velocity: slope(pair) - (2.0 * bend[0] + bend[1]) * (length / 6.0),
            bend: [bend[0], bend[1]],
        }
    };
    keys.windows(2).zip(bends.windows(2)).map(piece).collect()
}

/// How fast an own time goes: 1/γ.
fn rate(velocity: DVec3) -> f64 {
    let speed = velocity.length();
    ((1.0 - speed) * (1.0 + speed)).max(0.0).sqrt()
}

impl Piece {
    fn at(&self, t: f64) -> (DVec3, DVec3) {
        let s = t - self.from;
        let [bend, last] = self.bend;
        let jerk = (last - bend) / (self.to - self.from);
        let place = self.place + (self.velocity + (bend * 0.5 + jerk * (s / 6.0)) * s) * s;
        (place, self.velocity + (bend + jerk * (0.5 * s)) * s)
    }

    /// The own time from one time to another.
    fn length(&self, from: f64, to: f64) -> f64 {
        self.measured(from, to).0
    }

    /// The own time from one time to another by eight points, and the slowest that it goes at these.
    fn measured(&self, from: f64, to: f64) -> (f64, f64) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (mut sum, mut slowest) = (0.0, 1.0_f64);
        for (node, weight) in RULE {
            let rates = [-node, node].map(|node| rate(self.at(middle + node * half).1));
            sum += weight * (rates[0] + rates[1]);
            slowest = slowest.min(rates[0]).min(rates[1]);
        }
        (sum * half, slowest)
    }

    /// Its times from one to the next, each with the own time that it lasts: as many as make the rule exact to rounding.
    fn ticks(&self) -> Vec<(f64, f64)> {
        let mut ticks = Vec::new();
        let mut waiting = vec![(self.from, self.to, self.measured(self.from, self.to), 0)];
        while let Some((from, to, (whole, slowest), depth)) = waiting.pop() {
            let middle = 0.5 * (from + to);
            let (early, late) = (self.measured(from, middle), self.measured(middle, to));
            let rounding = (to - from) * f64::EPSILON * (8.0 + 4.0 / slowest);
            let divisible = from < middle && middle < to && depth < 16;
            if divisible && !((whole - (early.0 + late.0)).abs() <= rounding) {
                waiting.extend([(middle, to, late, depth + 1), (from, middle, early, depth + 1)]);
                continue;
            }
            ticks.push((to, whole));
        }
        ticks
    }

    /// A bound of its speed that is reached to a part 1e-9, and where.
    ///
    /// v² is a polynomial of the fourth degree: it lies below the largest of its coefficients over Bernstein's
    /// polynomials, and these close in on it where an interval is halved.
    fn fastest(&self) -> (f64, f64) {
        let length = self.to - self.from;
        let middle = self.velocity + self.bend[0] * (0.5 * length);
        let last = self.velocity + (self.bend[0] + self.bend[1]) * (0.5 * length);
        let mut waiting = vec![([self.velocity, middle, last], self.from, self.to)];
        let (mut bound, mut best) = (0.0_f64, (-1.0, self.from));
        let known = [self.velocity, middle, last].iter().all(|v| v.length_squared().is_finite());
        if !known || !(length > 0.0) {
            return (f64::INFINITY, self.from);
        }
        let mut steps = 0;
        while let Some(([a, b, c], from, to)) = waiting.pop() {
            for (v, t) in [(a, from), (c, to)] {
                if !(v.length_squared() <= best.0) {
                    best = (v.length_squared(), t);
                }
            }
            let squares = [a.dot(a), a.dot(b), (a.dot(c) + 2.0 * b.dot(b)) / 3.0, b.dot(c), c.dot(c)];
            let most = squares.into_iter().fold(0.0, f64::max);
            let at = 0.5 * (from + to);
            steps += 1;
            if !(most > best.0 * (1.0 + 1e-9)) || !(from < at && at < to) || steps > MOST_HALVED {
                bound = bound.max(most);
                continue;
            }
            let (ab, bc) = (0.5 * (a + b), 0.5 * (b + c));
            let centre = 0.5 * (ab + bc);
            waiting.extend([([a, ab, centre], from, at), ([centre, bc, c], at, to)]);
        }
        (bound.max(best.0).sqrt(), best.1)
    }
}
