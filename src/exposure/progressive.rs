//! A picture from coarse to fine, to look at while it comes about.
//!
//! One pixel in 16 by 16, then one in 8 by 8, and so on, each standing for the square that it is the corner of until the pixels
//! within are known. Every pixel is traced once at its centre; where it is to have more samples, all follow. What is there in the end
//! has the same bytes as the picture that [`expose`](super::expose) makes at once.

use super::{Pixels, Place, Sampling, by_tile_until, pixels};
use crate::film::Negative;
use crate::observer::View;
use crate::stop::Stop;
use crate::trace::Lit;
use std::ops::Range;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Pixels from one that is traced to the next, pass by pass.
const STEPS: [u32; 5] = [16, 8, 4, 2, 1];

/// While all samples are taken the picture is shown again after so long.
const BETWEEN_LOOKS: Duration = Duration::from_millis(250);

/// How far a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grain {
    /// One pixel is known in a square of so many by so many.
    Squares(u32),
    /// All pixels are known, and so many rows have all of their samples.
    Rows(u32),
    /// Nothing is left to be done.
    Done,
}

/// Exposes a picture and shows it after each pass. None if it was stopped.
pub fn expose_coarse_to_fine(
    lit: &Lit<'_>,
    view: &View,
    sampling: &Sampling,
    stop: &Stop,
    mut show: impl FnMut(&Negative, Grain) + Send,
) -> Option<Negative> {
    let lit = &lit.seen_from(view.tetrad.event);
    let once = Sampling { samples: 1, ..*sampling };
    let mut picture = Negative {
        width: sampling.width,
        height: sampling.height,
        xyz: vec![[0.0; 3]; sampling.width as usize * sampling.height as usize],
    };
    let centre = pixels(lit, view, &once);
    for step in STEPS {
        refine(&mut picture, step, stop, &centre)?;
        let done = step == 1 && sampling.samples == 1;
        show(&picture, if done { Grain::Done } else { Grain::Squares(step) });
    }
    if sampling.samples == 1 {
        return Some(picture);
    }
    // Who shows may take up other bands meanwhile (it works on the same threads): so nobody waits for the looker.
    let gathered = Mutex::new((picture, 0));
    let looker = Mutex::new((Instant::now(), &mut show));
    let take = |rows: Range<usize>, band: &[[f32; 3]]| {
        let Ok(mut known) = gathered.lock() else { return };
        let first = rows.start * known.0.width as usize;
        known.0.xyz[first..first + band.len()].copy_from_slice(band);
        known.1 += rows.len() as u32;
        if let Ok(mut looker) = looker.try_lock()
            && looker.0.elapsed() >= BETWEEN_LOOKS
            && known.1 < known.0.height
        {
            let (picture, rows) = known.clone();
            drop(known);
            (looker.1)(&picture, Grain::Rows(rows));
            looker.0 = Instant::now();
        }
    };
    let all = pixels(lit, view, sampling);
    let size = (sampling.width, sampling.height);
    let xyz = by_tile_until(size, stop, |places, tell| all(places, tell), take)?;
    let picture = Negative { width: sampling.width, height: sampling.height, xyz };
    show(&picture, Grain::Done);
    Some(picture)
}

/// Traces the pixels that are `step` apart, but for those that the passes before have traced.
fn refine(picture: &mut Negative, step: u32, stop: &Stop, trace: &Pixels<'_>) -> Option<()> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let apart = step as usize;
    let is_new = |(column, row): &Place| step == STEPS[0] || column % 2 == 1 || row % 2 == 1;
    let of = |places: &[Place], tell: &mut dyn FnMut(Option<[f32; 3]>)| {
        let new = places.iter().filter(|place| is_new(place));
        let all: Vec<Place> = new.map(|(column, row)| (column * apart, row * apart)).collect();
        let mut found = Vec::with_capacity(all.len());
        trace(&all, &mut |xyz| found.push(xyz));
        let mut found = found.into_iter();
        places.iter().for_each(|place| tell(if is_new(place) { found.next() } else { None }));
    };
    let grid = (picture.width.div_ceil(step), picture.height.div_ceil(step));
    let new = by_tile_until(grid, stop, of, |_, _| {})?;
    for (number, xyz) in new.into_iter().enumerate() {
        let Some(xyz) = xyz else { continue };
        let (column, row) = (number % grid.0 as usize * apart, number / grid.0 as usize * apart);
        for row in row..(row + apart).min(height) {
            picture.xyz[row * width + column..row * width + (column + apart).min(width)].fill(xyz);
        }
    }
    Some(())
}
