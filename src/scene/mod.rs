//! The scene as meant: bodies in their rest frames, surfaces, lamps, the observer. Immutable once built.

mod camera;
mod compose;
mod light;
mod materials;
mod models;
mod sky;
mod solids;

pub(crate) use compose::placement;
pub use compose::{compose, compose_rest};
pub use materials::UNLIT_LUMINANCE;

use crate::lamp::Lamp;
use crate::observer::Observer;
use crate::spacetime::{Boost, Event, Lab, Poincare, Rest, Velocity};
use crate::spectrum::Source;
use crate::surface::{Medium, Surface};
use crate::surroundings::Surroundings;
use crate::trace::{Effects, Lit};
use crate::tree::Bounds;
use crate::world::{Form, Placed, RestFrame, World};
use glam::{DAffine3, DVec3};

/// Everything that is seen, and who sees it.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The bodies, grouped by rest frame.
    pub world: World,
    /// Surfaces, by the numbers that the world's meshes carry.
    pub surfaces: Vec<Surface>,
    /// What fills closed bodies of glass, by the numbers that surfaces carry.
    pub media: Vec<Medium>,
    /// Lamps.
    pub lamps: Vec<Lamp>,
    /// Radiances that fill rest frames alike from all sides, by the numbers that surfaces carry.
    pub ambient: Vec<Source>,
    /// What is beyond all bodies.
    pub surroundings: Vec<Sky>,
    /// Wavelengths of all spectral lines, nm, each in its source's rest frame.
    pub lines: Vec<f64>,
    /// Which effects are shown.
    pub effects: Effects,
    /// How many mirrors one after another are followed.
    pub depth: u32,
    /// Rays of which the observer would get less than this part are not followed.
    pub faintest: f64,
    /// The camera.
    pub observer: Observer,
}

impl Scene {
    /// Everything that shines: of lamps, of surfaces, and from all around.
    pub fn sources(&self) -> impl Iterator<Item = &Source> {
        let lamps = self.lamps.iter().flat_map(|lamp| lamp.light.iter().map(|(_, source)| source));
        let surfaces = self.surfaces.iter().flat_map(Surface::all);
        let glows = surfaces.filter_map(|surface| surface.glow.as_ref()).map(|glow| &glow.radiance);
        lamps.chain(glows).chain(&self.ambient)
    }

    /// Takes note of all spectral lines.
    #[must_use]
    pub fn with_lines(mut self) -> Self {
        let skies = self.surroundings.iter().flat_map(|sky| sky.sky.lines());
        let lines = self.sources().flat_map(Source::lines).chain(skies).map(|line| line.wavelength_nm);
        let mut lines: Vec<f64> = lines.collect();
        lines.sort_unstable_by(f64::total_cmp);
        lines.dedup();
        self.lines = lines;
        self
    }

    /// The scene as the light loop takes it, with the methods that it needs and no others.
    pub fn lit(&self) -> Lit<'_> {
        Lit {
            world: &self.world,
            crowd: None,
            in_vacuum: None,
            surfaces: &self.surfaces,
            media: &self.media,
            lamps: &self.lamps,
            ambient: &self.ambient,
            surroundings: &self.surroundings,
            see_through: self.surfaces.iter().any(Surface::lets_through),
            footprints: self.surfaces.iter().any(Surface::is_textured),
            lines: &self.lines,
            effects: self.effects,
            depth: if self.surfaces.iter().any(Surface::sends_on) { self.depth } else { 0 },
            faintest: self.faintest,
        }
    }
}

/// What is infinitely far away.
#[derive(Debug, Clone)]
pub struct Sky {
    /// Into its rest frame.
    pub rest_from_lab: Boost<Rest, Lab>,
    /// What is seen there.
    pub sky: Surroundings,
}

/// Where a body is: the event at which its own clock reads zero, and its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Its origin, at its own time zero.
    pub origin: Event,
    /// Its velocity in the lab; its axes are the pure boost of the lab's.
    pub velocity: Velocity,
}

impl Placement {
    /// Into the body's rest frame, its origin at the body's.
    pub fn rest_from_lab(&self) -> Poincare<Rest> {
        Poincare::to_moving(self.velocity, self.origin)
    }
}

/// Gathers bodies into rest frames: those with the same velocity share one.
#[derive(Debug, Default)]
pub struct WorldBuilder {
    frames: Vec<(Placement, Vec<Placed>)>,
}

impl WorldBuilder {
    /// Adds a mesh or a solid of a body, and says how large it is in its rest frame. A singular map adds nothing.
    pub fn add(
        &mut self,
        body: u32,
        placement: Placement,
        form: &Form,
        rest_from_form: DAffine3,
        surfaces: u32,
    ) -> Bounds {
        let shared = self.frames.iter().position(|(first, _)| first.velocity == placement.velocity);
        let index = shared.unwrap_or_else(|| {
            self.frames.push((placement, Vec::new()));
            self.frames.len() - 1
        });
        let (first, placed) = &mut self.frames[index];
        // Bodies that share a rest frame differ by where they stand in it and by when their clocks read zero.
        let rest_from_lab: Poincare<Rest> = first.rest_from_lab();
        let Event { t, x, .. }: Event<Rest> = rest_from_lab * placement.origin;
        let rest_from_form = DAffine3::from_translation(x) * rest_from_form;
        let Some(mut new) = Placed::new(form.clone(), rest_from_form, body, surfaces) else {
            return Bounds::EMPTY;
        };
        let endless = Bounds { lo: DVec3::NEG_INFINITY, hi: DVec3::INFINITY };
        let bounds = new.bounds().unwrap_or(endless);
        new.clock_zero = t;
        placed.push(new);
        bounds
    }

    /// Builds the trees over the bodies.
    pub fn build(self) -> World {
        let rest =
            |(placement, placed): (Placement, Vec<Placed>)| RestFrame::new(placement.rest_from_lab(), placed);
        World { frames: self.frames.into_iter().map(rest).collect() }
    }
}
