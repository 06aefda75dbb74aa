//! What the observer's camera makes its pictures with.

use super::node::Node;
use super::observer::Observer;
use super::plain::words;
use super::quantity::{ConeAngle, ViewAngle};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape};
use crate::error::Report;
use crate::lens;
use std::f64::consts::PI;

words! {
    /// How places in the picture belong to directions.
    Lens, "a lens" {
        /// A plane picture: straight lines stay straight.
        "pinhole" => Pinhole;
        /// Distances from the middle in proportion to angles.
        "fisheye" => Fisheye;
        /// All around, as the pictures are that surround a scene.
        "panorama" => Panorama;
    }
}

impl Observer {
    /// Its lens with the angle that it takes in: 50° of a pinhole, 180° of a fisheye unless said.
    pub fn optics(&self) -> lens::Lens {
        match self.lens {
            Lens::Pinhole => lens::Lens::Pinhole { across: self.field_of_view.unwrap_or(50.0 * PI / 180.0) },
            Lens::Fisheye => lens::Lens::Fisheye { across: self.field_of_view.unwrap_or(PI) },
            Lens::Panorama => lens::Lens::Panorama,
        }
    }
}

/// Across the picture, radians: below 180 degrees but for a fisheye.
pub(super) struct FieldOfView;

impl Kind for FieldOfView {
    type Value = f64;
    fn shape() -> Shape {
        ConeAngle::shape()
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
        match reader.lens {
            Lens::Pinhole => ViewAngle::read(node, reader),
            Lens::Fisheye => ConeAngle::read(node, reader),
            Lens::Panorama => {
                let hint = "remove `field_of_view`, or write lens: fisheye";
                Err(reader.fault(&node.place, "a panorama shows all that is around", hint))
            }
        }
    }
}

/// Which lens an observer has: it decides what angles there may be. Of a manifest of which a part is missing, that of the
/// widest angles unless it is said.
pub(super) fn of(observer: &Node, partial: bool) -> Lens {
    match observer.get("lens").map(|lens| lens.text()) {
        Some(Some("fisheye")) => Lens::Fisheye,
        Some(Some("panorama")) => Lens::Panorama,
        None if partial => Lens::Fisheye,
        _ => Lens::Pinhole,
    }
}

/// Says where a panorama's pixels are no squares, and where a fisheye's circle is cut.
pub(super) fn check_size(manifest: &super::Manifest, report: &mut Report) {
    let height = manifest.picture.size.value.1;
    let width = manifest.eye_width();
    if manifest.observer.lens == Lens::Panorama && width != 2 * height {
        let what = format!("a panorama that is not twice as wide as high ({width} x {height}) is squeezed");
        report.warn(manifest.picture.size_place().clone(), what, format!("size: {} {height}", 2 * height));
    }
    // A fisheye of less than half of all directions is meant to fill the picture.
    if let lens::Lens::Fisheye { across } = manifest.observer.optics()
        && across >= PI
        && width > height
    {
        let degrees = across.to_degrees();
        let what = format!(
            "the circle of a fisheye of {degrees:.0} degrees is cut above and below ({width} x {height})"
        );
        let eyes = manifest.picture.size.value.0 / width;
        let hint = format!("size: {} {height}", eyes * height);
        report.warn(manifest.picture.size_place().clone(), what, hint);
    }
}
