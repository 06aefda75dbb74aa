//! Two eyes as written.

use super::Manifest;
use super::plain::words;
use super::quantity::Length;
use super::record::record;
use crate::error::Report;
use crate::stereo;

words! {
    /// How the pictures of two eyes are put together.
    Layout, "a layout" {
        /// In one picture, the left eye's in its left half.
        "side_by_side" => SideBySide;
        /// Two films, in the folders `left` and `right` of the output.
        "left_right" => LeftRight;
        /// In one picture, for glasses that are red on the left and cyan on the right.
        "anaglyph" => Anaglyph;
    }
}

record! {
    /// Two eyes beside one another, in the observer's momentary rest frame and at one time there; both look the same way.
    pub Stereo, "a pair of eyes" {
        /// How far apart they are, metres.
        apart: f64 = Length, required, "6.5 cm";
        /// Where their pictures go: `side_by_side` unless said, each in a half of the picture's width.
        layout: Layout = Layout, default(Layout::SideBySide), "anaglyph";
    }
}

impl Stereo {
    /// As the observer has them.
    pub fn eyes(&self) -> stereo::Stereo {
        let layout = match self.layout {
            Layout::SideBySide => stereo::Layout::SideBySide,
            Layout::LeftRight => stereo::Layout::LeftRight,
            Layout::Anaglyph => stereo::Layout::Anaglyph,
        };
        stereo::Stereo { apart: self.apart, layout }
    }
}

impl Manifest {
    /// Columns of what one eye sees.
    pub fn eye_width(&self) -> u32 {
        let halved = self.observer.stereo.as_ref().is_some_and(|eyes| eyes.layout == Layout::SideBySide);
        let (width, _) = self.picture.size.value;
        if halved { width / 2 } else { width }
    }
}

/// Faults what two eyes cannot have: a panorama, and halves of unlike width.
pub(super) fn check(manifest: &Manifest, report: &mut Report) {
    let Some(eyes) = &manifest.observer.stereo else { return };
    if manifest.observer.lens == super::Lens::Panorama {
        let what = "to the sides of a panorama one eye would be behind the other";
        report.fault(eyes.place.clone(), what, "lens: fisheye, or remove `stereo`");
    }
    let (width, height) = manifest.picture.size.value;
    if eyes.layout == Layout::SideBySide && width % 2 == 1 {
        let what = format!("a picture {width} pixels wide has no halves for two eyes");
        report.fault(manifest.picture.size_place().clone(), what, format!("size: {} {height}", width + 1));
    }
}
