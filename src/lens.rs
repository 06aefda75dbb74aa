//! How places in a picture belong to directions: pinholes, fisheyes, panoramas.

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// What a camera makes its picture with. Angles in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// A plane picture, so many radians (below π) across its width: straight lines stay straight.
    Pinhole {
        /// Across the width.
        across: f64,
    },
    /// The distance from the middle of the picture is in proportion to the angle from where the camera looks.
    Fisheye {
        /// Across the width; up to 2π.
        across: f64,
    },
    /// All around: equirectangular, as the pictures are that surround a scene. Longitude is in proportion to the way
    /// across, latitude to the way down; the camera looks at the middle.
    Panorama,
}

/// A lens and a picture's size in pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Optics {
    lens: Lens,
    /// Pinhole: half the width of the picture at distance 1. Fisheye: radians a pixel.
    scale: f64,
    size: DVec2,
}

impl Lens {
    /// For a picture of a size in pixels.
    pub(crate) fn optics(self, size: DVec2) -> Optics {
        let scale = match self {
            Self::Pinhole { across } => libm::tan(0.5 * across),
            Self::Fisheye { across } => across / size.x,
            Self::Panorama => 0.0,
        };
        Optics { lens: self, scale, size }
    }
}

impl Optics {
    /// Columns.
    #[inline]
    pub(crate) fn width(&self) -> f64 {
        self.size.x
    }

    /// Whether a place in the picture, pixels from the upper left corner, shows anything: beyond 180° from where a fisheye
    /// looks there is no direction.
    #[inline]
    pub(crate) fn shows(&self, pixel: DVec2) -> bool {
        match self.lens {
            Lens::Fisheye { .. } => (pixel - 0.5 * self.size).length() * self.scale <= PI,
            _ => true,
        }
    }

    /// The unit direction of a place in the picture: x right, y up, z backward.
    #[inline]
    pub(crate) fn direction(&self, pixel: DVec2) -> DVec3 {
        match self.lens {
            Lens::Pinhole { .. } => {
                let from_centre = (pixel - 0.5 * self.size) * (2.0 * self.scale / self.size.x);
                let direction = DVec3::new(from_centre.x, -from_centre.y, -1.0);
                direction / direction.length()
            }
            Lens::Fisheye { .. } => {
                let from_centre = pixel - 0.5 * self.size;
                let radius = from_centre.length();
                let (sin, cos) = libm::sincos((radius * self.scale).min(PI));
                let across = if radius > 0.0 { from_centre * (sin / radius) } else { DVec2::ZERO };
                DVec3::new(across.x, -across.y, -cos)
            }
            Lens::Panorama => {
                let (sin, cos) = libm::sincos((pixel.x / self.size.x - 0.5) * TAU);
                let (below, level) = libm::sincos((pixel.y / self.size.y - 0.5) * PI);
                DVec3::new(sin * level, -below, -cos * level)
            }
        }
    }

    /// Half as wide as a pixel is in this direction: for a pinhole the root of its solid angle, for what bends lines the
    /// longer one of its sides.
    #[inline]
    pub(crate) fn half_width(&self, direction: DVec3) -> f64 {
        match self.lens {
            // A pixel's solid angle is its area on the plane at distance 1, times cos³.
            Lens::Pinhole { .. } => {
                let cosine = -direction.z;
                self.scale / self.size.x * cosine * cosine.sqrt()
            }
            Lens::Fisheye { .. } => 0.5 * self.scale,
            Lens::Panorama => {
                let across = TAU / self.size.x * libm::hypot(direction.x, direction.z);
                0.5 * across.max(PI / self.size.y)
            }
        }
    }

    /// Where a direction lies in the picture, and beside it; none from behind a pinhole.
    pub(crate) fn pixel_of(&self, direction: DVec3) -> Option<DVec2> {
        let DVec3 { x, y, z } = direction;
        match self.lens {
            Lens::Pinhole { .. } => (z < 0.0).then(|| {
                let on_plane = DVec2::new(x, -y) / -z;
                on_plane * (self.size.x / (2.0 * self.scale)) + 0.5 * self.size
            }),
            Lens::Fisheye { .. } => {
                let across = libm::hypot(x, y);
                let radius = libm::atan2(across, -z) / self.scale;
                let along = if across > 0.0 { DVec2::new(x, -y) / across } else { DVec2::X };
                Some(along * radius + 0.5 * self.size)
            }
            Lens::Panorama => {
                let across = libm::atan2(x, -z) / TAU + 0.5;
                let down = libm::atan2(libm::hypot(x, z), y) / PI;
                Some(DVec2::new(across, down) * self.size)
            }
        }
    }
}
