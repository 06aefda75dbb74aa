//! Few colours for many: the palette of a film, and its pixels in it.

/// Colours of a palette; one number more stands for "as before".
pub(super) const COLORS: usize = 255;

/// How often colours were seen, in cells of 8 by 8 by 8 of them.
pub(super) struct Histogram {
    // Count and sums of red, green, blue.
    cells: Vec<[u64; 4]>,
}

impl Histogram {
    pub(super) fn new() -> Self {
        Self { cells: vec![[0; 4]; 1 << 15] }
    }

    pub(super) fn add(&mut self, rgb: &[u8]) {
        for pixel in rgb.chunks_exact(3) {
            let place = pixel.iter().fold(0, |place, value| place << 5 | usize::from(value >> 3));
            let cell = &mut self.cells[place];
            cell[0] += 1;
            for (sum, value) in cell[1..].iter_mut().zip(pixel) {
                *sum += u64::from(*value);
            }
        }
    }

    /// The colours by which all are best stood for: the lot that is spread most is cut in two at its mean, until there are
    /// enough.
    pub(super) fn palette(&self) -> Palette {
        let colors = self.cells.iter().filter(|cell| cell[0] > 0).map(|[count, sums @ ..]| {
            let color = sums.map(|sum| sum as f64 / *count as f64);
            // What is rare counts for more than its share: small bright things are what is looked at.
            Color { color, weight: (*count as f64).sqrt() }
        });
        let mut lots = vec![Lot::new(colors.collect())];
        while lots.len() < COLORS {
            let widest =
                lots.iter().enumerate().max_by(|(i, a), (j, b)| a.spread.total_cmp(&b.spread).then(j.cmp(i)));
            let Some((widest, _)) = widest.filter(|(_, lot)| lot.spread > 0.0) else { break };
            let [low, high] = lots.swap_remove(widest).cut();
            lots.push(low);
            lots.push(high);
        }
        Palette::new(lots.iter().map(|lot| lot.mean.map(|value| value.round() as u8)).collect())
    }
}

#[derive(Clone, Copy)]
struct Color {
    color: [f64; 3],
    weight: f64,
}

/// Colours that one is to stand for.
struct Lot {
    colors: Vec<Color>,
    mean: [f64; 3],
    // The channel in which they are spread most, and how much in all.
    axis: usize,
    spread: f64,
}

/// How much a difference in red, green and blue is seen.
const SEEN: [f64; 3] = [0.3, 0.59, 0.11];

impl Lot {
    fn new(colors: Vec<Color>) -> Self {
        let weight: f64 = colors.iter().map(|one| one.weight).sum();
        let sum = |of: &dyn Fn(&Color) -> f64| colors.iter().map(|one| one.weight * of(one)).sum::<f64>();
        let mean: [f64; 3] =
            std::array::from_fn(|i| sum(&|one| one.color[i]) / weight.max(f64::MIN_POSITIVE));
        let spread: [f64; 3] = std::array::from_fn(|i| {
            SEEN[i] * sum(&|one| (one.color[i] - mean[i]) * (one.color[i] - mean[i]))
        });
        let axis = (1..3).fold(0, |best, i| if spread[i] > spread[best] { i } else { best });
        let several = colors.len() > 1;
        Self { mean, axis, spread: if several { spread.iter().sum() } else { 0.0 }, colors }
    }

    fn cut(self) -> [Self; 2] {
        let (axis, at) = (self.axis, self.mean[self.axis]);
        let (low, high) = self.colors.into_iter().partition(|one| one.color[axis] < at);
        [Self::new(low), Self::new(high)]
    }
}

/// The colours of a film.
pub(super) struct Palette {
    pub(super) colors: Vec<[u8; 3]>,
    // The nearest colour to the middle of each cell of 4 by 4 by 4 colours.
    nearest: Vec<u8>,
}

/// How far colours are moved, to one side and the other by turns, so that those between two of the palette are seen.
const STRENGTH: i32 = 14;

/// Each pixel's turn, of 64: an ordered pattern, so that what rests does not flicker.
fn turn(column: usize, row: usize) -> i32 {
    let (x, y) = (column as i32, row as i32);
    (0..3).fold(0, |turn, bit| turn << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1))
}

impl Palette {
    fn new(mut colors: Vec<[u8; 3]>) -> Self {
        colors.sort_unstable();
        colors.dedup();
        let nearest = (0..1_usize << 18).map(|cell| {
            let middle = [cell >> 12, cell >> 6 & 63, cell & 63].map(|part| (4 * part + 2) as f64);
            let apart = |color: &[u8; 3]| -> f64 {
                let off = |i: usize| f64::from(color[i]) - middle[i];
                (0..3).map(|i| SEEN[i] * off(i) * off(i)).sum()
            };
            let best = |best: (usize, f64), (number, color): (usize, &[u8; 3])| {
                let apart = apart(color);
                if apart < best.1 { (number, apart) } else { best }
            };
            colors.iter().enumerate().fold((0, f64::INFINITY), best).0 as u8
        });
        let nearest = nearest.collect();
        Self { colors, nearest }
    }

    fn near(&self, color: [i32; 3]) -> u8 {
        let place = color.iter().fold(0, |place, value| place << 6 | (value.clamp(&0, &255) >> 2) as usize);
        self.nearest[place]
    }

    /// The numbers of the pixels' colours.
    pub(super) fn numbers(&self, rgb: &[u8], width: usize) -> Vec<u8> {
        let number = |(place, pixel): (usize, &[u8])| {
            let color = [0, 1, 2].map(|i| i32::from(pixel[i]));
            let plain = self.near(color);
            let off = |i: usize| (i32::from(self.colors[usize::from(plain)][i]) - color[i]).abs();
            if (0..3).all(|i| off(i) <= 1) {
                return plain;
            }
            let moved = STRENGTH * (2 * turn(place % width, place / width) - 63) / 126;
            self.near(color.map(|value| value + moved))
        };
        rgb.chunks_exact(3).enumerate().map(number).collect()
    }
}
