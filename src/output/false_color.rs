//! Numbers as colours, with a legend by which they can be read.

use super::font::{HIGH, WIDE, dots};

/// Which numbers the colours stand for. What lies beyond has the colour of the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// Ratios of frequencies from `1 / most` to `most`, by their logarithm: red below 1, light grey at 1, blue above.
    Ratio {
        /// The greatest; above 1.
        most: f64,
    },
    /// Times in seconds, dark to light.
    Seconds {
        /// The earliest.
        from: f64,
        /// The latest; later than that.
        to: f64,
        /// Between two marks of the legend.
        step: f64,
    },
}

/// Greatest ratios that a scale may have.
const RATIOS: [f64; 13] = [1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0];

/// Red to blue over light grey, in equal steps.
const DIVERGING: [[u8; 3]; 7] = [
    [70, 0, 16],
    [165, 28, 38],
    [235, 130, 100],
    [238, 238, 238],
    [120, 175, 225],
    [38, 92, 172],
    [10, 24, 84],
];

/// Violet to yellow, in equal steps, each lighter than the one before.
const SEQUENTIAL: [[u8; 3]; 6] =
    [[40, 8, 66], [56, 60, 132], [34, 110, 142], [34, 158, 128], [130, 202, 78], [252, 232, 70]];

impl Scale {
    /// For ratios of which nearly all are given. 98 in 100 are within it.
    pub fn of_ratios(ratios: impl IntoIterator<Item = f64>) -> Self {
        let apart = |ratio: f64| libm::log(ratio).abs();
        let mut apart: Vec<f64> = ratios.into_iter().map(apart).filter(|apart| apart.is_finite()).collect();
        let most = libm::exp(quantile(&mut apart, 98).unwrap_or(0.0));
        let known = RATIOS.iter().copied().find(|known| *known >= most * (1.0 - 1e-9));
        // Beyond the table by powers of ten.
        let power = || libm::pow(10.0, libm::log10(most).ceil()).min(1e9);
        Self::Ratio { most: known.unwrap_or_else(power) }
    }

    /// For times (seconds) of which nearly all are given. 96 in 100 are within it.
    pub fn of_seconds(times: impl IntoIterator<Item = f64>) -> Self {
        let mut times: Vec<f64> = times.into_iter().filter(|seconds| seconds.is_finite()).collect();
        let first = quantile(&mut times, 2).unwrap_or(0.0);
        let last = quantile(&mut times, 98).unwrap_or(0.0);
        // Not finer than numbers are told apart.
        let span = (last - first).max(1e-9 * first.abs().max(last.abs())).max(1e-15);
        let power = libm::pow(10.0, (libm::log10(span / 5.0)).floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|part| part * power).into_iter().find(|step| span / step <= 5.0);
        let step = step.unwrap_or(10.0 * power);
        let (from, to) = ((first / step).floor(), (last / step).ceil());
        Self::Seconds { from: from * step, to: to.max(from + 1.0) * step, step }
    }

    /// Where on the scale a value is, from 0 to 1.
    pub fn part(&self, value: f64) -> f64 {
        let part = match *self {
            Self::Ratio { most } => 0.5 + 0.5 * libm::log(value) / libm::log(most),
            Self::Seconds { from, to, .. } => (value - from) / (to - from),
        };
        // Also what is no number is somewhere.
        if part > 0.0 { part.min(1.0) } else { 0.0 }
    }

    /// The colour of a part of the scale, sRGB.
    pub fn color(&self, part: f64) -> [u8; 3] {
        let anchors: &[[u8; 3]] = match self {
            Self::Ratio { .. } => &DIVERGING,
            Self::Seconds { .. } => &SEQUENTIAL,
        };
        let at = part.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
        let below = (at as usize).min(anchors.len() - 2);
        let between = |i: usize| {
            let (a, b) = (f64::from(anchors[below][i]), f64::from(anchors[below + 1][i]));
            (a + (b - a) * (at - below as f64)).round() as u8
        };
        [between(0), between(1), between(2)]
    }

    /// What the numbers are, in full and in short.
    fn titles(&self) -> [&'static str; 2] {
        match self {
            Self::Ratio { .. } => ["frequency seen / frequency sent", "seen/sent"],
            Self::Seconds { .. } => ["light sent at lab time, s", "s"],
        }
    }

    /// Values with their names, in order of their worth.
    fn marks(&self) -> Vec<(f64, String)> {
        match *self {
            Self::Ratio { most } => {
                let within = RATIOS.into_iter().filter(|ratio| *ratio < most * (1.0 + 1e-9));
                let mut marks = vec![(1.0, "1".to_owned())];
                for ratio in [most].into_iter().chain(within.rev()) {
                    if marks.iter().all(|(known, _)| *known != ratio) {
                        marks.push((ratio, format!("{ratio}")));
                        marks.push((1.0 / ratio, format!("1/{ratio}")));
                    }
                }
                marks
            }
            Self::Seconds { from, to, step } => {
                let count = ((to - from) / step).round() as usize;
                let first = (from / step).round();
                let digits = (-libm::log10(step)).ceil().clamp(0.0, 12.0) as usize;
                let mark = |i: usize| {
                    let value = (first + i as f64) * step + 0.0;
                    let plain = step >= 1e-6 && value.abs() < 1e9;
                    (value, if plain { format!("{value:.digits$}") } else { format!("{value:e}") })
                };
                (0..=count).map(mark).collect()
            }
        }
    }
}

/// The value below which so many in 100 lie.
fn quantile(values: &mut [f64], hundredths: usize) -> Option<f64> {
    let place = (values.len() * hundredths / 100).min(values.len().checked_sub(1)?);
    Some(*values.select_nth_unstable_by(place, f64::total_cmp).1)
}

/// Rows of a legend, in units of a dot.
const LEGEND: usize = 38;
/// Rows at which things begin in it: title, bar, ticks, names.
const ROWS: [usize; 4] = [4, 14, 23, 27];
/// Columns beside the bar.
const MARGIN: usize = 10;
const PAPER: [u8; 3] = [20, 20, 20];
const INK: [u8; 3] = [230, 230, 230];
/// Where no number is.
const NOTHING: [[u8; 3]; 2] = [[52, 52, 52], [64, 64, 64]];

/// Pixels to a dot of the legend, by the picture's width.
fn dot(width: usize) -> usize {
    ((width + 320) / 640).max(1)
}

/// Rows of a picture of so many columns and rows with its legend.
pub fn height_with_legend(width: u32, height: u32) -> u32 {
    height + (LEGEND * dot(width as usize)) as u32
}

/// The colours of some values, `width` of them in a row, with a legend below; hatched grey where there is no value.
pub fn false_color(values: &[Option<f64>], width: usize, scale: &Scale) -> Vec<u8> {
    let hatch = |place: usize| NOTHING[((place % width + place / width) / (4 * dot(width))) % 2];
    let color = |(place, value): (usize, &Option<f64>)| {
        value.map_or_else(|| hatch(place), |value| scale.color(scale.part(value)))
    };
    let mut pixels: Vec<[u8; 3]> = values.iter().enumerate().map(color).collect();
    pixels.extend(legend(width, scale));
    pixels.into_flattened()
}

fn legend(width: usize, scale: &Scale) -> Vec<[u8; 3]> {
    let dot = dot(width);
    let mut sheet = Sheet { pixels: vec![PAPER; width * LEGEND * dot], width, dot };
    let margin = (MARGIN * dot).min(width / 8);
    let strip = (width - 2 * margin).max(1);
    for column in 0..strip {
        let color = scale.color((column as f64 + 0.5) / strip as f64);
        sheet.fill((margin + column, 1), (ROWS[1] * dot, 8 * dot), color);
    }
    let title =
        scale.titles().into_iter().find(|title| title.len() * WIDE * dot <= strip).unwrap_or_default();
    sheet.write(title, margin, ROWS[0]);
    // Each name keeps away from those before it.
    let mut taken: Vec<(usize, usize)> = Vec::new();
    for (value, name) in scale.marks() {
        let at = margin + ((scale.part(value) * strip as f64) as usize).min(strip - 1);
        let wide = name.len() * WIDE * dot;
        let from = at.saturating_sub(wide / 2).min(width.saturating_sub(wide));
        let to = from + wide;
        if wide <= width
            && taken.iter().all(|(start, end)| to + WIDE * dot <= *start || *end + WIDE * dot <= from)
        {
            taken.push((from, to));
            sheet.fill((at, dot.div_ceil(2)), (ROWS[2] * dot, 3 * dot), INK);
            sheet.write(&name, from, ROWS[3]);
        }
    }
    sheet.pixels
}

struct Sheet {
    pixels: Vec<[u8; 3]>,
    width: usize,
    dot: usize,
}

impl Sheet {
    /// Columns and rows: the first, and how many.
    fn fill(&mut self, (left, wide): (usize, usize), (top, high): (usize, usize), color: [u8; 3]) {
        for row in top..top + high {
            for column in left..(left + wide).min(self.width) {
                if let Some(pixel) = self.pixels.get_mut(row * self.width + column) {
                    *pixel = color;
                }
            }
        }
    }

    /// `top` in dots.
    fn write(&mut self, text: &str, left: usize, top: usize) {
        let dot = self.dot;
        for (column, row) in dots(text) {
            self.fill((left + column * dot, dot), ((top + row) * dot, dot), INK);
        }
    }
}

const _: () = assert!(ROWS[3] + HIGH < LEGEND);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_of_a_legend_is_known() {
        let mut said = String::new();
        for exponent in -14..15 {
            let scales = [
                Scale::of_ratios([libm::exp(libm::pow(10.0, f64::from(exponent) / 7.0))]),
                Scale::of_seconds([0.0, 3.0 * libm::pow(10.0, f64::from(exponent))]),
                Scale::of_seconds([-7e4, libm::pow(10.0, f64::from(exponent))]),
            ];
            for scale in scales {
                scale.titles().into_iter().for_each(|title| said.push_str(title));
                scale.marks().into_iter().for_each(|(_, name)| said.push_str(&name));
            }
        }
        for letter in said.chars().filter(|letter| *letter != ' ') {
            assert!(dots(&letter.to_string()).next().is_some(), "{letter}");
        }
    }
}
