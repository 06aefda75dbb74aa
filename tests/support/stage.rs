//! Bodies, lamps and an observer as data.

use super::Heaven;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::sync::Arc;
use terrell::course::Course as Clockwork;
use terrell::lamp::{Beam, Lamp};
use terrell::lens::Lens;
use terrell::mesh::Mesh;
use terrell::observer::{Aim, Observer};
use terrell::scene::{Placement, Scene, WorldBuilder};
use terrell::solid::Solid;
use terrell::spacetime::{Course, Event, Poincare, SightRay, Velocity, Worldline};
use terrell::spectrum::Index;
use terrell::spectrum::Source;
use terrell::stereo::Stereo;
use terrell::surface::{Absorption, Glass, Medium, Scatter, Surface};
use terrell::trace::Effects;
use terrell::triangles::Triangles;
use terrell::world::Form;

/// A body as it is put on a stage: made at rest at the origin, then moved there.
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) mesh: Arc<Triangles>,
    /// Instead of the mesh.
    pub(crate) solid: Option<Arc<Solid>>,
    pub(crate) placement: Placement,
    pub(crate) rest_from_mesh: DAffine3,
    pub(crate) surface: Surface,
    pub(crate) index: Index,
    pub(crate) absorption: Option<Absorption>,
    /// Its own fill light.
    pub(crate) ambient: Option<Source>,
}

impl Body {
    /// At rest at the origin.
    pub(crate) fn new(mesh: &Arc<Triangles>, surface: Surface) -> Self {
        let placement = Placement { origin: Event::ORIGIN, velocity: Velocity::REST };
        Self {
            mesh: mesh.clone(),
            solid: None,
            placement,
            rest_from_mesh: DAffine3::IDENTITY,
            surface,
            index: Index::Constant(1.0),
            absorption: None,
            ambient: None,
        }
    }

    /// A shape without triangles, at rest at the origin.
    pub(crate) fn of(solid: Solid, surface: Surface) -> Self {
        let none = Arc::new(Triangles::new(Arc::new(Mesh::default())));
        Self { solid: Some(Arc::new(solid)), ..Self::new(&none, surface) }
    }

    fn form(&self) -> Form {
        self.solid.clone().map_or_else(|| Form::Mesh(self.mesh.clone()), Form::Solid)
    }

    /// In a fill light of its own.
    pub(crate) fn in_ambient(mut self, radiance: Source) -> Self {
        self.ambient = Some(radiance);
        self
    }

    /// Filled with glass.
    pub(crate) fn filled(mut self, index: Index) -> Self {
        self.index = index;
        self
    }

    /// Its surface, when it is body number `number`.
    fn surface(&self, number: u32) -> Surface {
        let mut surface = self.surface.clone();
        if let Scatter::Glass(glass) = &mut surface.scatter {
            // A pane has an index of its own.
            let index = if glass.thin { glass.index } else { self.index };
            **glass = Glass { medium: number, index, ..*glass.clone() };
        }
        surface
    }

    /// The volume of its box in its own coordinates; nobody asks for that of what has no end.
    fn volume(&self) -> f64 {
        let bounds = self.solid.as_ref().map(|solid| solid.bounds());
        bounds.map_or(1.0, |bounds| (bounds.hi - bounds.lo).element_product())
    }

    /// Its centre passes through this event.
    pub(crate) fn at(mut self, t: f64, x: DVec3) -> Self {
        self.placement.origin = Event::new(t, x);
        self
    }

    /// It moves.
    pub(crate) fn moving(mut self, velocity: Velocity) -> Self {
        self.placement.velocity = velocity;
        self
    }

    /// Larger (about its centre) by a factor.
    pub(crate) fn sized(self, factor: f64) -> Self {
        self.stretched(DVec3::splat(factor))
    }

    /// Larger by a factor for each axis of its rest frame.
    pub(crate) fn stretched(self, factors: DVec3) -> Self {
        self.mapped(DAffine3::from_scale(factors))
    }

    /// Turned in its rest frame so that its +z looks along `normal`.
    pub(crate) fn facing(self, normal: DVec3) -> Self {
        let z = normal / normal.length();
        let x = z.any_orthonormal_vector();
        self.mapped(DAffine3::from_mat3(DMat3::from_cols(x, z.cross(x), z)))
    }

    /// Moved about in its rest frame.
    pub(crate) fn mapped(mut self, map: DAffine3) -> Self {
        self.rest_from_mesh = map * self.rest_from_mesh;
        self
    }
}

/// A lamp as it is put on a stage.
#[derive(Clone)]
pub(crate) struct Lantern {
    pub(crate) origin: Event,
    pub(crate) velocity: Velocity,
    pub(crate) beam: Beam,
    pub(crate) light: Vec<(Clockwork, Source)>,
}

impl Lantern {
    /// A point lamp through an event.
    pub(crate) fn at(t: f64, x: DVec3, source: Source) -> Self {
        let beam = Beam::Point { place: DVec3::ZERO };
        let light = vec![(Clockwork::Steady, source)];
        Self { origin: Event::new(t, x), velocity: Velocity::REST, beam, light }
    }

    /// With a course in its own time.
    pub(crate) fn by(mut self, course: &Clockwork) -> Self {
        self.light.iter_mut().for_each(|part| part.0 = course.clone());
        self
    }

    /// It moves.
    pub(crate) fn moving(self, velocity: Velocity) -> Self {
        Self { velocity, ..self }
    }

    /// With another beam.
    pub(crate) fn with(self, beam: Beam) -> Self {
        Self { beam, ..self }
    }

    /// As the scene takes it.
    pub(crate) fn lamp(&self) -> Lamp {
        Lamp {
            rest_from_lab: Poincare::to_moving(self.velocity, self.origin),
            beam: self.beam,
            light: self.light.clone(),
        }
    }
}

/// Bodies and lamps, still as data: they can be boosted.
#[derive(Clone)]
pub(crate) struct Stage {
    pub(crate) bodies: Vec<Body>,
    pub(crate) lamps: Vec<Lantern>,
    pub(crate) ambient: Option<Source>,
    pub(crate) skies: Vec<Heaven>,
    pub(crate) effects: Effects,
    pub(crate) depth: u32,
}

impl Stage {
    /// With bodies.
    pub(crate) fn of(bodies: impl IntoIterator<Item = Body>) -> Self {
        let bodies = bodies.into_iter().collect();
        Self { bodies, lamps: Vec::new(), ambient: None, skies: Vec::new(), effects: Effects::ALL, depth: 8 }
    }

    /// With lamps.
    pub(crate) fn lit_by(mut self, lamps: impl IntoIterator<Item = Lantern>) -> Self {
        self.lamps.extend(lamps);
        self
    }

    /// Below something infinitely far away.
    pub(crate) fn under(mut self, sky: Heaven) -> Self {
        self.skies.push(sky);
        self
    }

    /// The scene, as `eye` sees it.
    pub(crate) fn seen_by(&self, eye: &Eye) -> Scene {
        let mut world = WorldBuilder::default();
        let mut ambient = vec![self.ambient.clone().unwrap_or_default()];
        let mut surfaces = Vec::new();
        for (number, body) in self.bodies.iter().enumerate() {
            let number = number as u32;
            world.add(number, body.placement, &body.form(), body.rest_from_mesh, number);
            let own = if body.ambient.is_some() { ambient.len() as u32 } else { 0 };
            ambient.extend(body.ambient.clone());
            surfaces.push(body.surface(number).in_ambient(own));
        }
        Scene {
            world: world.build(),
            surfaces,
            lamps: self.lamps.iter().map(Lantern::lamp).collect(),
            media: self.media(),
            ambient,
            surroundings: self.skies.iter().map(Heaven::sky).collect(),
            lines: Vec::new(),
            effects: self.effects,
            depth: self.depth,
            faintest: 1e-9,
            observer: eye.observer(),
        }
        .with_lines()
    }

    /// What fills bodies of glass: that of body number i is medium number i (others are not asked for theirs).
    fn media(&self) -> Vec<Medium> {
        let glass = self.bodies.iter().any(|body| body.surface.medium().is_some());
        let medium = |body: &Body| Medium {
            index: body.index,
            absorption: body.absorption.clone(),
            rest_from_lab: body.placement.rest_from_lab().boost(),
            volume: body.rest_from_mesh.matrix3.determinant().abs() * body.volume(),
        };
        if glass { self.bodies.iter().map(medium).collect() } else { Vec::new() }
    }

    /// The scene, for sight rays that come from elsewhere.
    pub(crate) fn scene(&self) -> Scene {
        self.seen_by(&Eye::at(0.0, DVec3::ZERO))
    }
}

/// An observer, still as data.
#[derive(Clone)]
pub(crate) struct Eye {
    pub(crate) origin: Event,
    pub(crate) velocity: Velocity,
    pub(crate) rotation: DQuat,
    pub(crate) course: Course,
    pub(crate) aim: Aim,
    pub(crate) up: DVec3,
    pub(crate) lens: Lens,
    pub(crate) stereo: Option<Stereo>,
}

impl Eye {
    /// At rest; looks along -z, 60° wide.
    pub(crate) fn at(t: f64, x: DVec3) -> Self {
        Self {
            origin: Event::new(t, x),
            velocity: Velocity::REST,
            rotation: DQuat::IDENTITY,
            course: Course::Inertial,
            aim: Aim::Along(DVec3::NEG_Z),
            up: DVec3::Y,
            lens: Lens::Pinhole { across: 60.0_f64.to_radians() },
            stereo: None,
        }
    }

    /// It moves.
    pub(crate) fn moving(&self, velocity: Velocity) -> Self {
        Self { velocity, ..self.clone() }
    }

    /// It looks along a direction of the axes it carries.
    pub(crate) fn toward(&self, direction: DVec3) -> Self {
        Self { aim: Aim::Along(direction), ..self.clone() }
    }

    /// This many degrees wide.
    pub(crate) fn wide(&self, degrees: f64) -> Self {
        Self { lens: Lens::Pinhole { across: degrees.to_radians() }, ..self.clone() }
    }

    /// As the scene takes it.
    pub(crate) fn observer(&self) -> Observer {
        Observer {
            worldline: Worldline::new(self.origin, self.velocity, self.rotation, self.course.clone()),
            aim: self.aim,
            up: self.up,
            lens: self.lens,
            unaberrated: None,
            filmed: None,
            stereo: self.stereo,
        }
    }

    /// The light from the direction `n` of the axes it carries, at its proper time zero.
    pub(crate) fn sight(&self, n: DVec3) -> SightRay {
        self.observer().worldline.at(0.0).sight_ray(n / n.length())
    }
}
