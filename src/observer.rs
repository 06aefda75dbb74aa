//! The observer's camera: where it is, where it looks, and the sight ray of each place in the picture.

use crate::filmed::Filmed;
use crate::lens::{Lens, Optics};
use crate::spacetime::{
    Boost, Camera, Event, FourVector, Lab, Lorentz, Poincare, Rest, SightRay, Tetrad, Velocity, Worldline,
    looking_along,
};
use crate::stereo::{Layout, Side, Stereo};
use crate::trace::Cone;
use glam::{DQuat, DVec2, DVec3};
use std::sync::Arc;

/// What a camera looks at.
#[derive(Debug, Clone, Copy)]
pub enum Aim {
    /// A direction in the axes that the observer carries.
    Along(DVec3),
    /// The apparent place of something at rest in a frame: where its light, arriving now, comes from.
    At {
        /// Into the target's rest frame.
        rest_from_lab: Poincare<Rest, Lab>,
        /// Where it is there.
        place: DVec3,
    },
}

/// An observer with a camera.
#[derive(Debug, Clone)]
pub struct Observer {
    /// Its motion.
    pub worldline: Worldline,
    /// Where the camera looks.
    pub aim: Aim,
    /// What is up in the picture, in the axes that the observer carries.
    pub up: DVec3,
    /// What the camera makes its pictures with.
    pub lens: Lens,
    /// With aberration switched off: the velocity of all bodies and the turn of the observer's axes. Directions are
    /// then those of a camera at the same event that stands still beside the bodies.
    pub unaberrated: Option<Unaberrated>,
    /// A camera of a file that turns as the file says, whatever the aim.
    pub filmed: Option<Arc<Filmed>>,
    /// Two eyes in place of one.
    pub stereo: Option<Stereo>,
}

/// What directions refer to when aberration is switched off.
#[derive(Debug, Clone, Copy)]
pub struct Unaberrated {
    /// Into the frame in which all bodies rest.
    pub rest_from_lab: Boost<Rest, Lab>,
    /// Turn of the observer's axes.
    pub rotation: DQuat,
}

/// The camera at one moment.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// The observer with the camera's axes: x right, y up, z backward.
    pub tetrad: Tetrad,
    // Where the right eye is, whose picture is the right half.
    right: Option<Event>,
    // Into the observer's true rest frame, where the tetrad's is not.
    seer: Option<Boost<Camera, Lab>>,
    optics: Optics,
}

impl Observer {
    /// The camera at proper time `tau`, for a picture of `width` by `height` pixels.
    pub fn view(&self, tau: f64, width: u32, height: u32) -> View {
        let carried = self.worldline.at(tau);
        let axes = match self.unaberrated {
            Some(Unaberrated { rest_from_lab, rotation }) => Tetrad {
                event: carried.event,
                lab_from_camera: Lorentz::from(rest_from_lab.inverse()) * Lorentz::rotation(rotation),
            },
            None => carried,
        };
        let forward = match self.aim {
            Aim::Along(direction) => direction,
            Aim::At { rest_from_lab, place } => {
                let toward = place - (rest_from_lab * axes.event).x;
                let light = FourVector::<Rest>::new(toward.length(), -toward);
                let seen = axes.direction_of(rest_from_lab.boost().inverse().light(light));
                if seen.is_finite() { seen } else { DVec3::NEG_Z }
            }
        };
        let turn = match &self.filmed {
            Some(filmed) => filmed.turn(self.worldline.start_time(tau)),
            None => looking_along(forward, self.up),
        };
        let size = DVec2::new(f64::from(width), f64::from(height));
        let view = View {
            tetrad: axes.turned(turn),
            right: None,
            seer: self.unaberrated.map(|_| Boost::to_moving(Velocity::from_proper(carried.velocity().x))),
            optics: self.lens.optics(size),
        };
        match self.stereo {
            Some(Stereo { apart, layout: Layout::SideBySide }) => {
                let optics = self.lens.optics(DVec2::new(0.5 * size.x, size.y));
                let [left, right] = Side::BOTH.map(|side| view.eye(side, apart));
                View { right: Some(right.tetrad.event), optics, ..left }
            }
            _ => view,
        }
    }
}

impl Observer {
    /// All that pictures are made of: what each eye sees, where they do not share one picture.
    pub fn views(&self, tau: f64, width: u32, height: u32) -> impl Iterator<Item = View> + use<> {
        let view = self.view(tau, width, height);
        let eyes = self.stereo.filter(|eyes| eyes.layout != Layout::SideBySide);
        let both = eyes.map(|eyes| Side::BOTH.map(|side| view.eye(side, eyes.apart)));
        let one = if both.is_none() { Some(view) } else { None };
        both.into_iter().flatten().chain(one)
    }
}

impl View {
    /// What one of two eyes sees that are `apart` (metres), at the same time of the observer's rest frame.
    pub fn eye(&self, side: Side, apart: f64) -> Self {
        let offset = FourVector::<Camera>::new(0.0, DVec3::X * side.offset(apart));
        let event = self.tetrad.event + self.tetrad.lab_from_camera * offset;
        Self { tetrad: Tetrad { event, ..self.tetrad }, ..*self }
    }

    /// What each eye sees whose picture is in this one, from left to right, and its columns.
    pub fn eyes(&self) -> impl Iterator<Item = (Self, u32)> + use<> {
        let width = self.optics.width() as u32;
        let left = Self { right: None, ..*self };
        let right = self.right.map(|event| Self { tetrad: Tetrad { event, ..self.tetrad }, ..left });
        std::iter::once(left).chain(right).map(move |view| (view, width))
    }

    /// The picture of the eye to whom a pixel belongs, and the pixel in it: samples beside a pixel are of the same eye.
    #[inline]
    pub fn of_pixel(&self, pixel: DVec2) -> (Self, DVec2) {
        let (event, pixel) = self.local(pixel);
        (Self { tetrad: Tetrad { event, ..self.tetrad }, right: None, ..*self }, pixel)
    }

    /// Where the light of a pixel arrives, and the pixel in the picture of that eye.
    #[inline]
    fn local(&self, pixel: DVec2) -> (Event, DVec2) {
        match self.right {
            Some(right) if pixel.x >= self.optics.width() => {
                (right, DVec2::new(pixel.x - self.optics.width(), pixel.y))
            }
            _ => (self.tetrad.event, pixel),
        }
    }

    /// Whether a place in the picture shows anything: not beyond 180° from where a fisheye looks.
    #[inline]
    pub fn shows(&self, pixel: DVec2) -> bool {
        self.optics.shows(self.local(pixel).1)
    }

    /// The unit direction, in the camera's axes, of a place in the picture: pixels from the upper left corner.
    pub fn direction(&self, pixel: DVec2) -> DVec3 {
        self.optics.direction(self.local(pixel).1)
    }

    /// The sight ray of a place in the picture, k·u = 1.
    pub fn ray(&self, pixel: DVec2) -> SightRay {
        self.sight(pixel, 1.0).0
    }

    /// The sight ray of a place, k·u = 1, and how wide it is among samples that are `spacing` pixels apart.
    #[inline]
    pub fn sight(&self, pixel: DVec2, spacing: f64) -> (SightRay, Cone) {
        let (event, pixel) = self.local(pixel);
        let direction = self.optics.direction(pixel);
        let ray = SightRay { event, ..self.tetrad.sight_ray(direction) };
        let half = self.optics.half_width(direction);
        let cone = |half: f64| Cone { sample: half * spacing, pixel: half, phase: 0.0 };
        match self.seer {
            // With aberration switched off the angle is seen by those beside whom the light has another frequency.
            Some(seer) => {
                let scale = 1.0 / seer.light(ray.k).t;
                (SightRay { k: ray.k * scale, ..ray }, cone(half * scale))
            }
            None => (ray, cone(half)),
        }
    }

    /// How often light of a sight ray goes to and fro for who has the camera's axes, while the observer sees the frequency 1:
    /// other than 1 only where aberration is switched off.
    pub fn frequency(&self, ray: &SightRay) -> f64 {
        match self.seer {
            Some(_) => self.tetrad.lab_from_camera.inverse().light(ray.k).t,
            None => 1.0,
        }
    }

    /// A normal (lab, at right angles to the four-velocity of what it belongs to) as it appears where a place in the picture
    /// is: at right angles to the surface that is seen, in the camera's axes, unit length.
    ///
    /// What is seen lies on the observer's past light cone, at `(-r, r n)`. Where a surface `N·x = const` meets it
    /// `N⁰ r + N·n r` is constant (N the normal in the camera's frame), so that is at right angles to `N + N⁰ n`.
    pub fn apparent_normal(&self, pixel: DVec2, normal: FourVector) -> DVec3 {
        let toward = self.direction(pixel);
        let seen: FourVector<Camera> = self.tetrad.lab_from_camera.inverse() * normal;
        let apparent = seen.x + toward * seen.t;
        apparent.try_normalize().unwrap_or(-toward)
    }

    /// Where in the picture light with the wave vector `k` arrives (of two eyes: at the left one);
    /// none from behind a pinhole.
    pub fn pixel_of(&self, k: FourVector) -> Option<DVec2> {
        self.optics.pixel_of(self.tetrad.direction_of(k))
    }
}
