//! What the laws are tried on: small meshes, a stage to put them on, an eye to look with, and dice.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec3};
use proptest::prelude::{Strategy, prop};
use std::collections::BTreeMap;
use std::sync::Arc;
use terrell::exposure::{Sampling, expose};
use terrell::film::{Negative, Reconstruction};
use terrell::lamp::{Beam, Lamp};
use terrell::mesh::Mesh;
use terrell::observer::{Aim, Observer, View};
use terrell::scene::{Placement, Scene, WorldBuilder};
use terrell::spacetime::{
    Course, Event, FourVector, Lab, Lorentz, Poincare, Rest, SightRay, Velocity, Worldline,
};
use terrell::spectrum::{Reflectance, Source, Spectrum, Wavelengths};
use terrell::surface::{Glow, Scatter, Surface};
use terrell::trace::{Effects, First, Light};
use terrell::triangles::Triangles;

// ---------------------------------------------------------------------------------------------- numbers

/// A velocity from β.
pub(crate) fn beta(x: f64, y: f64, z: f64) -> Velocity {
    Velocity::from_beta(DVec3::new(x, y, z)).unwrap()
}

/// A velocity from a speed and a direction of any length.
pub(crate) fn speed(beta: f64, along: DVec3) -> Velocity {
    Velocity::from_beta(along / along.length() * beta).unwrap()
}

/// A vector.
pub(crate) const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The angle between two directions, radians, with all its digits at 0 and at π.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// `got` is `expected` but for a part `tolerance` of it.
#[track_caller]
pub(crate) fn close(got: f64, expected: f64, tolerance: f64) {
    let error = (got - expected).abs() / expected.abs();
    assert!(error <= tolerance, "{got} for {expected}: off by a part {error:e} of it");
}

/// `got` is `expected` but for `tolerance`.
#[track_caller]
pub(crate) fn near(got: f64, expected: f64, tolerance: f64) {
    let error = (got - expected).abs();
    assert!(error <= tolerance, "{got} for {expected}: off by {error:e}");
}

/// The vector `got` is `expected` but for `tolerance`.
#[track_caller]
pub(crate) fn near_vector(got: DVec3, expected: DVec3, tolerance: f64) {
    let error = (got - expected).length();
    assert!(error <= tolerance, "{got} for {expected}: off by {error:e}");
}

/// Where between `inside` (where `holds`) and `outside` (where it does not) a property ends.
pub(crate) fn edge(mut inside: f64, mut outside: f64, holds: impl Fn(f64) -> bool) -> f64 {
    assert!(holds(inside) && !holds(outside), "no edge between {inside} and {outside}");
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if holds(middle) { inside = middle } else { outside = middle }
    }
    0.5 * (inside + outside)
}

/// The lab time at which something on the path `place` sent the light that arrives at the event: by halving, in the
/// lab alone.
pub(crate) fn emission_time(arrival: Event, place: impl Fn(f64) -> DVec3) -> f64 {
    let (mut early, mut late) = (arrival.t - 1.0, arrival.t);
    let too_late = |t: f64| arrival.t - t < (place(t) - arrival.x).length();
    while too_late(early) {
        early = arrival.t - 2.0 * (arrival.t - early);
    }
    for _ in 0..200 {
        let middle = 0.5 * (early + late);
        if too_late(middle) { late = middle } else { early = middle }
    }
    0.5 * (early + late)
}

/// A repeatable source of chance (splitmix64).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// Even between 0 and 1.
    pub(crate) fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// Even between two numbers.
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.part()
    }

    /// One of `count` numbers from 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.part() * count as f64) as usize).min(count - 1)
    }

    /// Even in the cube from -1 to 1.
    pub(crate) fn in_cube(&mut self) -> DVec3 {
        v(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A unit vector, even over the sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = libm::sincos(self.between(0.0, std::f64::consts::TAU));
        let across = (1.0 - z * z).sqrt();
        v(across * cos, across * sin, z)
    }

    /// A velocity of a given speed, any direction.
    pub(crate) fn velocity(&mut self, beta: f64) -> Velocity {
        speed(beta, self.direction())
    }

    /// A turn.
    pub(crate) fn turn(&mut self) -> DQuat {
        let axis = self.direction();
        DQuat::from_axis_angle(axis, self.between(-3.0, 3.0))
    }
}

/// Vectors of length up to about 1.7 with no preferred direction, never tiny.
pub(crate) fn vectors() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from).prop_filter("too short", |x| x.length() > 0.1)
}

/// Velocities up to a rapidity, in all directions.
pub(crate) fn velocities(rapidity: f64) -> impl Strategy<Value = Velocity> {
    (vectors(), 1e-3..rapidity).prop_map(|(along, rapidity)| Velocity::from_rapidity(rapidity, along))
}

// ---------------------------------------------------------------------------------------------- meshes

fn indexed(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh { positions: positions.iter().map(|p| p.as_vec3()).collect(), triangles, ..Mesh::default() }
}

/// A mesh with its tree.
pub(crate) fn built(mesh: Mesh) -> Arc<Triangles> {
    Arc::new(Triangles::new(Arc::new(mesh)))
}

/// Triangles from their corners, none shared.
pub(crate) fn soup(corners: &[[DVec3; 3]]) -> Mesh {
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    indexed(corners.as_flattened().to_vec(), triangles)
}

/// A unit sphere of `20 * 4^level` triangles, its normals those of the sphere.
pub(crate) fn icosphere(level: u32) -> Mesh {
    let long = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points: Vec<DVec3> = Vec::new();
    for (a, b) in [(1.0, long), (-1.0, long), (1.0, -long), (-1.0, -long)] {
        points.extend([v(0.0, a, b), v(a, b, 0.0), v(b, 0.0, a)]);
    }
    let side = 2.0;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for a in 0..12_u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|i| points[i as usize]);
                if [p - q, q - r, r - p].iter().all(|edge| (edge.length() - side).abs() < 1e-9) {
                    let outward = (q - p).cross(r - p).dot(p) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for point in &mut points {
        *point /= point.length();
    }
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = points[a as usize] + points[b as usize];
                points.push(sum / sum.length());
                points.len() as u32 - 1
            })
        };
        let mut finer = Vec::with_capacity(triangles.len() * 4);
        for [a, b, c] in triangles {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let mut mesh = indexed(points, triangles);
    mesh.normals = mesh.positions.iter().map(|p| p.normalize_or(Vec3::Z)).collect();
    mesh
}

/// A square from -1 to 1 in x and y, that faces +z.
pub(crate) fn square() -> Mesh {
    let corner = |x: f64, y: f64| v(x, y, 0.0);
    indexed(
        vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        vec![[0, 1, 2], [0, 2, 3]],
    )
}

/// A cube from -1 to 1 with flat sides.
pub(crate) fn cube() -> Mesh {
    let corners = (0..8).map(|i| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { -1.0 } else { 1.0 };
        v(pick(0), pick(1), pick(2))
    });
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    indexed(corners.collect(), triangles)
}

/// The mesh with a colour at each vertex, from its place.
pub(crate) fn coloured(mut mesh: Mesh) -> Mesh {
    mesh.colors = mesh
        .positions
        .iter()
        .map(|p| [p.x, p.y, p.z].map(|c| 0.5 + 0.4 * c))
        .map(|[r, g, b]| [r, g, b, 1.0])
        .collect();
    mesh
}

// ---------------------------------------------------------------------------------------------- surfaces

/// A black body as a radiance.
pub(crate) fn black_body(kelvin: f64) -> Source {
    Source::new(&Spectrum::BlackBody(kelvin), 1.0)
}

/// The same at every wavelength.
pub(crate) fn flat(value: f64) -> Source {
    Source::new(&Spectrum::Constant(1.0), value)
}

/// All at one wavelength.
pub(crate) fn line(centre_nm: f64, power: f64) -> Source {
    Source::new(&Spectrum::Line { centre_nm, width_nm: 0.0 }, power)
}

/// Shines by itself and throws nothing back.
pub(crate) fn glowing(radiance: Source) -> Surface {
    Surface { scatter: Scatter::Absorb, glow: Some(Glow { radiance, paint: None }) }
}

/// Throws a part of the light back to all sides.
pub(crate) fn diffuse(reflectance: f64) -> Surface {
    Surface { scatter: Scatter::Diffuse(Reflectance::Constant(reflectance)), glow: None }
}

/// Throws a part of the light back as a mirror.
pub(crate) fn mirror(reflectance: f64) -> Surface {
    Surface { scatter: Scatter::Mirror(Reflectance::Constant(reflectance)), glow: None }
}

/// Neither shines nor scatters.
pub(crate) fn black() -> Surface {
    Surface { scatter: Scatter::Absorb, glow: None }
}

// ---------------------------------------------------------------------------------------------- the stage

/// A body as it is put on a stage: made at rest at the origin, then moved there.
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) mesh: Arc<Triangles>,
    pub(crate) placement: Placement,
    pub(crate) rest_from_mesh: DAffine3,
    pub(crate) surface: Surface,
}

impl Body {
    /// At rest at the origin.
    pub(crate) fn new(mesh: &Arc<Triangles>, surface: Surface) -> Self {
        let placement = Placement { origin: Event::ORIGIN, velocity: Velocity::REST };
        Self { mesh: mesh.clone(), placement, rest_from_mesh: DAffine3::IDENTITY, surface }
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
    pub(crate) source: Source,
}

impl Lantern {
    /// A point lamp through an event.
    pub(crate) fn at(t: f64, x: DVec3, source: Source) -> Self {
        let beam = Beam::Point { place: DVec3::ZERO };
        Self { origin: Event::new(t, x), velocity: Velocity::REST, beam, source }
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
            source: self.source.clone(),
        }
    }
}

/// Bodies and lamps, still as data: they can be boosted.
#[derive(Clone)]
pub(crate) struct Stage {
    pub(crate) bodies: Vec<Body>,
    pub(crate) lamps: Vec<Lantern>,
    pub(crate) ambient: Option<Source>,
    pub(crate) effects: Effects,
    pub(crate) depth: u32,
}

impl Stage {
    /// With bodies.
    pub(crate) fn of(bodies: impl IntoIterator<Item = Body>) -> Self {
        let bodies = bodies.into_iter().collect();
        Self { bodies, lamps: Vec::new(), ambient: None, effects: Effects::ALL, depth: 8 }
    }

    /// With lamps.
    pub(crate) fn lit_by(mut self, lamps: impl IntoIterator<Item = Lantern>) -> Self {
        self.lamps.extend(lamps);
        self
    }

    /// The scene, as `eye` sees it.
    pub(crate) fn seen_by(&self, eye: &Eye) -> Scene {
        let mut world = WorldBuilder::default();
        for (number, body) in self.bodies.iter().enumerate() {
            let number = number as u32;
            world.add(number, body.placement, &body.mesh, body.rest_from_mesh, number);
        }
        Scene {
            world: world.build(),
            surfaces: self.bodies.iter().map(|body| body.surface.clone()).collect(),
            lamps: self.lamps.iter().map(Lantern::lamp).collect(),
            ambient: self.ambient.clone(),
            effects: self.effects,
            depth: self.depth,
            observer: eye.observer(),
        }
    }

    /// The scene, for sight rays that come from elsewhere.
    pub(crate) fn scene(&self) -> Scene {
        self.seen_by(&Eye::at(0.0, DVec3::ZERO))
    }
}

/// An observer, still as data.
#[derive(Clone, Copy)]
pub(crate) struct Eye {
    pub(crate) origin: Event,
    pub(crate) velocity: Velocity,
    pub(crate) rotation: DQuat,
    pub(crate) course: Course,
    pub(crate) aim: Aim,
    pub(crate) up: DVec3,
    pub(crate) field_of_view: f64,
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
            field_of_view: 60.0_f64.to_radians(),
        }
    }

    /// It moves.
    pub(crate) fn moving(self, velocity: Velocity) -> Self {
        Self { velocity, ..self }
    }

    /// It looks along a direction of the axes it carries.
    pub(crate) fn toward(self, direction: DVec3) -> Self {
        Self { aim: Aim::Along(direction), ..self }
    }

    /// This many degrees wide.
    pub(crate) fn wide(self, degrees: f64) -> Self {
        Self { field_of_view: degrees.to_radians(), ..self }
    }

    /// As the scene takes it.
    pub(crate) fn observer(&self) -> Observer {
        Observer {
            worldline: Worldline::new(self.origin, self.velocity, self.rotation, self.course),
            aim: self.aim,
            up: self.up,
            field_of_view: self.field_of_view,
            unaberrated: None,
        }
    }

    /// The light from the direction `n` of the axes it carries, at its proper time zero.
    pub(crate) fn sight(&self, n: DVec3) -> SightRay {
        self.observer().worldline.at(0.0).sight_ray(n / n.length())
    }
}

/// The light that arrives at an event of the lab from the direction of another place, frequency 1 in the lab.
pub(crate) fn light_from(place: DVec3, arrival: Event) -> SightRay {
    let n = (place - arrival.x) / (place - arrival.x).length();
    SightRay { event: arrival, k: FourVector::new(1.0, -n) }
}

/// The light that leaves an event of the lab for a place; it arrives there at a later time.
pub(crate) fn light_to(place: DVec3, departure: Event) -> SightRay {
    let distance = (place - departure.x).length();
    light_from(departure.x, Event::new(departure.t + distance, place))
}

/// The light that goes from a place in a rest frame to an event there, as the lab sees it: s is 1 at the place.
pub(crate) fn light_at_rest(rest_from_lab: &Poincare<Rest>, place: DVec3, arrival: Event<Rest>) -> SightRay {
    let way = arrival.x - place;
    let k = FourVector::<Rest>::new(way.length(), way);
    SightRay { event: rest_from_lab.undo(arrival), k: rest_from_lab.boost().inverse() * k }
}

/// What comes along a sight ray, at 64 wavelengths.
pub(crate) fn look(scene: &Scene, ray: &SightRay) -> Light<64> {
    scene.lit().seen(ray, &Wavelengths::new())
}

/// Whether any light of the visible range comes along a sight ray.
pub(crate) fn is_bright(scene: &Scene, ray: &SightRay) -> bool {
    scene.lit().seen(ray, &Wavelengths::<8>::new()).radiance.iter().any(|value| *value > 0.0)
}

/// What stands first in the way of a sight ray.
#[track_caller]
pub(crate) fn first(scene: &Scene, ray: &SightRay) -> First {
    scene.lit().first(ray).unwrap_or_else(|| panic!("the ray meets nothing"))
}

/// A picture at the eye's proper time zero, one sample a pixel.
pub(crate) fn picture(scene: &Scene, width: u32, height: u32) -> (View, Negative) {
    let view = scene.observer.view(0.0, width, height);
    let sampling =
        Sampling { width, height, samples: 1, reconstruction: Reconstruction::default(), wavelengths: 8 };
    let negative = expose(scene, &view, &sampling);
    (view, negative)
}

/// The centre of a pixel by its number.
pub(crate) fn pixel_centre(number: usize, width: u32) -> DVec2 {
    let width = width as usize;
    DVec2::new((number % width) as f64 + 0.5, (number / width) as f64 + 0.5)
}

/// Everything as the lab sees it that moves with `velocity` in the old lab.
pub(crate) mod boosted {
    use super::{
        Aim, Beam, Body, DAffine3, DQuat, DVec3, Event, Eye, Lab, Lantern, Lorentz, Poincare, Rest, Stage,
        Velocity,
    };
    use terrell::spacetime::Boost;

    /// The new lab's view of an event.
    pub(crate) fn event(boost: Velocity, event: Event) -> Event {
        Event::ORIGIN + Boost::<Lab, Lab>::to_moving(boost) * (event - Event::ORIGIN)
    }

    /// The new lab's velocity of something, and the turn that takes coordinates of its rest frame with the old axes
    /// to ones with axes that are the pure boost of the new lab's.
    pub(crate) fn velocity(boost: Velocity, velocity: Velocity) -> (Velocity, DQuat) {
        let lab_from_new = Lorentz::from(Boost::<Lab, Lab>::to_moving(boost)).inverse();
        let rest_from_new = Lorentz::from(Boost::<Rest, Lab>::to_moving(velocity)) * lab_from_new;
        let (velocity, turn) = rest_from_new.boost_then_rotation();
        (velocity, turn.inverse())
    }

    fn body(boost: Velocity, body: &Body) -> Body {
        let mut body = body.clone();
        let (moves, turn) = velocity(boost, body.placement.velocity);
        body.placement.origin = event(boost, body.placement.origin);
        body.placement.velocity = moves;
        body.mapped(DAffine3::from_quat(turn))
    }

    fn lantern(boost: Velocity, lantern: &Lantern) -> Lantern {
        let (moves, turn) = velocity(boost, lantern.velocity);
        let beam = match lantern.beam {
            Beam::Point { place } => Beam::Point { place: turn * place },
            Beam::Spot { place, axis, cos_inner, cos_outer } => {
                Beam::Spot { place: turn * place, axis: turn * axis, cos_inner, cos_outer }
            }
            Beam::Sun { axis } => Beam::Sun { axis: turn * axis },
        };
        Lantern {
            origin: event(boost, lantern.origin),
            velocity: moves,
            beam,
            source: lantern.source.clone(),
        }
    }

    /// Bodies and lamps.
    pub(crate) fn stage(boost: Velocity, stage: &Stage) -> Stage {
        Stage {
            bodies: stage.bodies.iter().map(|b| body(boost, b)).collect(),
            lamps: stage.lamps.iter().map(|l| lantern(boost, l)).collect(),
            ..stage.clone()
        }
    }

    /// The observer.
    pub(crate) fn eye(boost: Velocity, eye: &Eye) -> Eye {
        let (moves, turn) = velocity(boost, eye.velocity);
        let aim = match eye.aim {
            Aim::Along(direction) => Aim::Along(direction),
            Aim::At { rest_from_lab, place } => target(boost, rest_from_lab, place),
        };
        Eye { origin: event(boost, eye.origin), velocity: moves, rotation: turn * eye.rotation, aim, ..*eye }
    }

    fn target(boost: Velocity, rest_from_lab: Poincare<Rest, Lab>, place: DVec3) -> Aim {
        let (moves, turn) = velocity(boost, rest_from_lab.boost().velocity());
        let origin = event(boost, rest_from_lab.origin());
        Aim::At { rest_from_lab: Poincare::to_moving(moves, origin), place: turn * place }
    }
}
