//! A picture at half the size, a quarter, and so on down to one texel.

use super::{Encoding, Picture, Texels};
use glam::{DVec4, Vec4};
use std::fmt;
use std::sync::OnceLock;

/// The levels of a picture above the picture itself: each has half the columns and rows of the one below
/// (rounded up), and the last is one texel, the mean of all.
///
/// A texel is the mean of the area that it covers, parts of texels counted as parts, so that every level has
/// the picture's mean whatever its size. Means are of linear values. Where a picture of colours (sRGB or
/// float) has transparent parts, colours are multiplied by alpha before, and divided by it after the look-up:
/// what is not there lends no colour to what is. The four channels of data (linear, 8 or 16 bits) have nothing
/// to do with each other and are averaged each for itself.
///
/// Levels of pictures in 8 or 16 bits are kept in 16: 8 bytes for every third texel, 2.7 bytes for each of the
/// picture's texels, where floats would take 5.3. Data is stored as it is, in steps of 1/65535; colours as
/// their square roots, whose steps are nowhere more than 1.5 times those of 16-bit sRGB, and which are decoded
/// by one multiplication. Levels of float pictures are floats.
#[derive(Debug)]
pub struct Pyramid {
    levels: Vec<Level>,
    mean: Vec4,
    premultiplied: bool,
}

/// One of the levels.
#[derive(Debug)]
pub(super) struct Level {
    /// Columns and rows.
    pub(super) size: [u32; 2],
    pub(super) texels: Stored,
}

/// Texels of a level.
pub(super) enum Stored {
    /// Square roots of linear values.
    Root(Vec<[u16; 4]>),
    /// Linear values.
    Word(Vec<[u16; 4]>),
    /// Linear values.
    Float(Vec<[f32; 4]>),
}

/// The value of a stored square root.
#[inline]
pub(super) fn square(texel: [u16; 4]) -> Vec4 {
    let root = floats(texel);
    root * root * (1.0 / (65535.0 * 65535.0))
}

/// The value of a stored word.
#[inline]
pub(super) fn linear(texel: [u16; 4]) -> Vec4 {
    floats(texel) * (1.0 / 65535.0)
}

/// (Not by `map`, which becomes a call.)
#[inline]
fn floats([r, g, b, a]: [u16; 4]) -> Vec4 {
    Vec4::new(f32::from(r), f32::from(g), f32::from(b), f32::from(a))
}

/// Colours multiplied by alpha.
#[inline]
pub(super) fn multiplied(texel: Vec4) -> Vec4 {
    (texel * texel.w).with_w(texel.w)
}

/// The colours of colours multiplied by alpha; black where nothing is.
#[inline]
pub(super) fn divided(texel: Vec4) -> Vec4 {
    if texel.w > 0.0 { (texel / texel.w).with_w(texel.w) } else { Vec4::ZERO }
}

impl Stored {
    fn new(picture: &Picture, count: usize) -> Self {
        match (&picture.texels, picture.encoding) {
            (Texels::Float(_), _) => Self::Float(Vec::with_capacity(count)),
            (_, Encoding::Srgb) => Self::Root(Vec::with_capacity(count)),
            (_, Encoding::Linear) => Self::Word(Vec::with_capacity(count)),
        }
    }

    fn extend(&mut self, row: &[DVec4]) {
        let word = |c: f64| (c * 65535.0 + 0.5) as u16;
        match self {
            Self::Root(v) => v.extend(row.iter().map(|texel| texel.to_array().map(|c| word(c.sqrt())))),
            Self::Word(v) => v.extend(row.iter().map(|texel| texel.to_array().map(word))),
            Self::Float(v) => v.extend(row.iter().map(|texel| texel.as_vec4().to_array())),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Root(v) | Self::Word(v) => size_of_val(v.as_slice()),
            Self::Float(v) => size_of_val(v.as_slice()),
        }
    }
}

impl fmt::Debug for Stored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.bytes())
    }
}

/// Whether a picture's colours count by its alpha.
fn is_premultiplied(picture: &Picture) -> bool {
    match (&picture.texels, picture.encoding) {
        (Texels::Byte(v), Encoding::Srgb) => v.iter().any(|texel| texel[3] < u8::MAX),
        (Texels::Word(v), Encoding::Srgb) => v.iter().any(|texel| texel[3] < u16::MAX),
        (Texels::Float(v), _) => v.iter().any(|texel| texel[3] < 1.0),
        _ => false,
    }
}

impl Pyramid {
    /// All levels of a picture, in one pass over its rows.
    pub fn new(picture: &Picture) -> Self {
        let premultiplied = is_premultiplied(picture);
        let texel = |column, row| {
            let texel = picture.texel(column, row);
            (if premultiplied { multiplied(texel) } else { texel }).as_dvec4()
        };
        let mut size = [picture.width, picture.height];
        let mut levels = Vec::new();
        while size != [1, 1] {
            let level = Halving::new(picture, size);
            size = level.level.size;
            levels.push(level);
        }
        let mut below = Vec::with_capacity(picture.width as usize);
        for row in 0..picture.height as usize {
            below.clear();
            below.extend((0..picture.width as usize).map(|column| texel(column, row)));
            give(&mut levels, &below);
        }
        let mean = levels.last().map_or(&below, |last| &last.finished)[0].as_vec4();
        Self {
            levels: levels.into_iter().map(|halving| halving.level).collect(),
            mean: if premultiplied { divided(mean) } else { mean },
            premultiplied,
        }
    }

    /// The linear mean of the whole picture; of colours with transparent parts, each by its alpha.
    pub fn mean(&self) -> [f32; 4] {
        self.mean.to_array()
    }

    /// The bytes that its texels take.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.texels.bytes()).sum()
    }

    /// The number of the level of one texel; the picture itself is level 0.
    pub(super) fn top(&self) -> usize {
        self.levels.len()
    }

    /// A level from 1 to the top.
    pub(super) fn level(&self, number: usize) -> &Level {
        &self.levels[number - 1]
    }

    /// Whether colours are multiplied by alpha.
    pub(super) fn premultiplied(&self) -> bool {
        self.premultiplied
    }
}

impl Picture {
    /// Its levels, made when they are first asked for.
    ///
    /// Threads that ask meanwhile wait. The work is not shared out to them: a pool's thread that waits for its
    /// share may be given a task that asks for the same levels, and would wait for itself.
    pub fn pyramid(&self) -> &Pyramid {
        self.pyramid.0.get_or_init(|| Pyramid::new(self))
    }
}

/// Levels that may not have been asked for.
#[derive(Debug, Default)]
pub(super) struct Lazy(OnceLock<Pyramid>);

impl Clone for Lazy {
    /// None: a picture is copied to be changed.
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// A level in the making: rows of the level below come in, rows of its own go out.
struct Halving {
    below: [u32; 2],
    columns: Vec<Share>,
    /// The row that came in, made as narrow as the level.
    narrow: Vec<DVec4>,
    /// The row that is being added up.
    sum: Vec<DVec4>,
    /// The last row that went out.
    finished: Vec<DVec4>,
    came: u32,
    level: Level,
}

/// Where a texel goes in the level above.
#[derive(Clone, Copy)]
struct Share {
    /// The texel above that its beginning is in.
    to: usize,
    /// The part of that one which it covers.
    part: f64,
    /// The part of the next one which it covers.
    rest: f64,
    /// Whether that one ends in it.
    ends: bool,
}

impl Share {
    /// Of number `i` of `below` texels, which become `above`, at most as many.
    fn new(i: u32, below: u32, above: u32) -> Self {
        let [i, below, above] = [i, below, above].map(u64::from);
        // In units of which a texel is `above` long, and one above it `below`.
        let (start, end) = (i * above, (i + 1) * above);
        let to = start / below;
        let border = (to + 1) * below;
        let part = |length: u64| length as f64 / below as f64;
        Self {
            to: to as usize,
            part: part(end.min(border) - start),
            rest: part(end.saturating_sub(border)),
            ends: end >= border,
        }
    }
}

impl Halving {
    fn new(picture: &Picture, below: [u32; 2]) -> Self {
        let size = below.map(|n| n.div_ceil(2));
        let width = size[0] as usize;
        let zeros = vec![DVec4::ZERO; width];
        Self {
            below,
            columns: (0..below[0]).map(|i| Share::new(i, below[0], size[0])).collect(),
            narrow: zeros.clone(),
            sum: zeros.clone(),
            finished: zeros,
            came: 0,
            level: Level { size, texels: Stored::new(picture, width * size[1] as usize) },
        }
    }

    /// Takes a row of the level below; whether it finished one of this.
    fn take(&mut self, row: &[DVec4]) -> bool {
        self.narrow.fill(DVec4::ZERO);
        for (texel, share) in row.iter().zip(&self.columns) {
            self.narrow[share.to] += *texel * share.part;
            if share.rest > 0.0 {
                self.narrow[share.to + 1] += *texel * share.rest;
            }
        }
        let share = Share::new(self.came, self.below[1], self.level.size[1]);
        self.came += 1;
        for (sum, texel) in self.sum.iter_mut().zip(&self.narrow) {
            *sum += *texel * share.part;
        }
        if share.ends {
            std::mem::swap(&mut self.sum, &mut self.finished);
            self.level.texels.extend(&self.finished);
            for (sum, texel) in self.sum.iter_mut().zip(&self.narrow) {
                *sum = *texel * share.rest;
            }
        }
        share.ends
    }
}

/// Gives a row to the first level, and what becomes of it to those above.
fn give(levels: &mut [Halving], row: &[DVec4]) {
    if let Some((first, above)) = levels.split_first_mut()
        && first.take(row)
    {
        give(above, &first.finished);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Filter, Footprint, Texture, Wrap};
    use glam::{DAffine2, DVec2};
    use std::sync::Arc;

    #[test]
    fn each_level_has_half_the_size_rounded_up_and_the_mean_of_the_picture() {
        let texels: Vec<[f32; 4]> = (0..21 * 6).map(|i| [(i * i % 37) as f32, i as f32, 1.0, 1.0]).collect();
        let mean = |v: &[[f32; 4]]| v.iter().map(|t| f64::from(t[0])).sum::<f64>() / v.len() as f64;
        let expected = mean(&texels);
        let pyramid = Pyramid::new(&Picture::new(21, 6, Texels::Float(texels), Encoding::Linear));
        let sizes: Vec<_> = pyramid.levels.iter().map(|level| level.size).collect();
        assert_eq!(sizes, [[11, 3], [6, 2], [3, 1], [2, 1], [1, 1]]);
        for level in &pyramid.levels {
            let Stored::Float(v) = &level.texels else { panic!("{level:?}") };
            assert_eq!(v.len(), (level.size[0] * level.size[1]) as usize);
            assert!((mean(v) - expected).abs() < 1e-5, "{level:?}");
        }
    }

    #[test]
    fn texels_of_an_odd_row_are_shared_by_area() {
        let texels = [3.0, 6.0, 9.0].map(|c| [c; 4]).to_vec();
        let pyramid = Pyramid::new(&Picture::new(3, 1, Texels::Float(texels), Encoding::Linear));
        let Stored::Float(v) = &pyramid.level(1).texels else { panic!("{pyramid:?}") };
        // One texel and half of the next, over one and a half.
        assert!((v[0][0] - 4.0).abs() < 1e-6 && (v[1][0] - 8.0).abs() < 1e-6, "{v:?}");
    }

    #[test]
    fn levels_are_made_when_a_look_up_asks_for_them_and_not_copied() {
        let picture = Picture::new(2, 1, Texels::Byte(vec![[0; 4], [255; 4]]), Encoding::Srgb);
        let texture = Texture {
            picture: Arc::new(picture),
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Linear,
            uv_set: 0,
            transform: DAffine2::IDENTITY,
        };
        let made = |picture: &Picture| picture.pyramid.0.get().is_some();
        let over =
            |size: f64| texture.over(DVec2::ZERO, &Footprint { u: DVec2::X * size, v: DVec2::Y * size });
        over(0.1);
        assert!(!made(&texture.picture));
        over(1.0);
        assert!(made(&texture.picture));
        assert!(!made(&Picture::clone(&texture.picture)));
    }
}
