//! From a manifest and its model files to the scene that they mean.

use super::materials::{Owner, Workshop};
use super::models::{Chosen, Model, Models};
use super::{Placement, Scene, WorldBuilder, camera, light, sky, solids};
use crate::error::Report;
use crate::import;
use crate::manifest::{self, LookAt, Manifest, MaterialKind, ModelFile};
use crate::observer::{Aim, Observer, Unaberrated};
use crate::spacetime::{Boost, Circle, Course, Event, Velocity, Worldline};
use crate::spectrum::{Beyond, Source};
use crate::surface::{Paint, Scatter, Surface};
use crate::trace::Effects;
use crate::tree::Bounds;
use crate::world::Form;
use glam::{DAffine3, DVec3};
use std::path::Path;
use std::sync::Arc;

/// What a shape without a material reflects, to all sides.
const SHAPE_REFLECTANCE: f64 = 0.8;

/// The scene that a manifest means. Reads the model files; all faults and warnings go to the report.
pub fn compose(manifest: &Manifest, path: &Path, report: &mut Report) -> Option<Scene> {
    let scene = compose_rest(manifest, path, report);
    report.faults.is_empty().then_some(scene)
}

/// What can be had of the scene that a manifest means, for what else is wrong with it.
pub fn compose_rest(manifest: &Manifest, path: &Path, report: &mut Report) -> Scene {
    let models = Models::load(manifest, path, report);
    let chosen = models.chosen(manifest, report);
    let ambient = manifest.ambient.as_ref().and_then(|glow| light::radiance(glow, report));
    let mut gathered = Gathered {
        world: WorldBuilder::default(),
        surfaces: Vec::new(),
        ambient: vec![ambient.unwrap_or_default()],
        lamps: Vec::new(),
        workshop: Workshop::default(),
    };
    for (number, body) in manifest.bodies.iter().enumerate() {
        let solid = manifest.assets.get(&body.asset.value).and_then(manifest::AssetRef::solid);
        let model = models.of(manifest, body).zip(chosen.get(&body.asset.value));
        for placement in body.placements() {
            let body = manifest::Body { placement, ..body.clone() };
            if let Some(solid) = solid {
                gathered.add_solid(number as u32, &body, solid, report);
            } else if let Some(model) = model {
                gathered.add_body(number as u32, &body, model, report);
            }
        }
    }
    for light in &manifest.lights {
        gathered.lamps.extend(light::from_manifest(light, report));
    }
    let surroundings: Vec<_> =
        manifest.surroundings.iter().map(|sky| sky::sky(sky, &mut gathered.workshop, report)).collect();
    let effects = effects(&manifest.effects);
    let observer = observer(manifest, &models, report);
    let dark = gathered.lamps.is_empty()
        && surroundings.is_empty()
        && gathered.ambient.iter().all(Source::is_dark)
        && !gathered.surfaces.iter().flat_map(Surface::all).any(|surface| surface.glow.is_some());
    if dark && !manifest.bodies.is_empty() {
        let place = crate::error::Place::file(path);
        report.warn(
            place,
            "nothing shines, so nothing will be seen",
            "lights: [{ sun: { illuminance: 300 lx } }]",
        );
    }
    let scene = Scene {
        world: gathered.world.build(),
        surfaces: gathered.surfaces,
        media: gathered.workshop.media,
        lamps: gathered.lamps,
        ambient: gathered.ambient,
        surroundings,
        lines: Vec::new(),
        effects,
        depth: manifest.picture.depth,
        faintest: manifest.picture.faintest,
        observer,
    };
    scene.with_lines()
}

pub(crate) fn placement(written: &manifest::Placement) -> Placement {
    Placement { origin: Event::new(written.at_time, written.at), velocity: written.velocity }
}

fn effects(written: &manifest::Effects) -> Effects {
    Effects { aberration: written.aberration, doppler: written.doppler, searchlight: written.searchlight }
}

/// What the bodies put together.
struct Gathered {
    world: WorldBuilder,
    surfaces: Vec<Surface>,
    ambient: Vec<Source>,
    lamps: Vec<crate::lamp::Lamp>,
    workshop: Workshop,
}

impl Gathered {
    fn add_body(
        &mut self,
        number: u32,
        body: &manifest::Body,
        ((reference, model), chosen): ((&ModelFile, &Model), &Chosen),
        report: &mut Report,
    ) {
        let placement = placement(&body.placement);
        let Some(rest_from_asset) = rest_from_asset(body, report) else { return };
        let first_medium = self.workshop.media.len();
        let first_surface = self.surfaces.len() as u32;
        let surfaces = surfaces(body, &model.asset, &mut self.workshop, report);
        self.add_surfaces(surfaces, body, report);
        let mut bounds = Bounds::EMPTY;
        for instance in &model.asset.instances {
            let Some(triangles) = chosen.contains(instance.node).then(|| &model.triangles[instance.mesh])
            else {
                continue;
            };
            let rest_from_mesh = rest_from_asset * instance.asset_from_mesh;
            bounds = bounds.with(self.world.add(
                number,
                placement,
                &Form::Mesh(triangles.clone()),
                rest_from_mesh,
                first_surface,
            ));
        }
        let volume = (bounds.hi - bounds.lo).element_product();
        self.workshop.media[first_medium..].iter_mut().for_each(|medium| medium.volume = volume);
        let surfaces = &self.surfaces[first_surface as usize..];
        let is_glass = |part: &crate::mesh::Part| {
            surfaces.get(part.material as usize).is_none_or(|surface| surface.medium().is_some())
        };
        let open = |instance: &&import::Instance| {
            let mesh = &model.asset.meshes[instance.mesh];
            chosen.contains(instance.node) && mesh.parts.iter().any(is_glass) && !mesh.is_closed()
        };
        if let Some(instance) = model.asset.instances.iter().find(open) {
            let name = &model.asset.meshes[instance.mesh].name;
            let what =
                format!("the mesh `{name}` is of glass and is not closed: it has no inside to go through");
            report.warn(
                body.place.clone(),
                what,
                "close it in the model, or use glass: { index: 1.5, thin: on }",
            );
        }
        let lights =
            model.asset.lights.iter().filter(|light| chosen.contains(light.node) && reference.lights);
        self.lamps.extend(lights.map(|light| light::from_file(light, placement, rest_from_asset)));
    }

    fn add_solid(
        &mut self,
        number: u32,
        body: &manifest::Body,
        solid: &manifest::Solid,
        report: &mut Report,
    ) {
        let Some(solid) = solids::solid(solid) else { return };
        let placement = placement(&body.placement);
        let Some(rest_from_solid) = rest_from_asset(body, report) else { return };
        let first_medium = self.workshop.media.len();
        let first_surface = self.surfaces.len() as u32;
        let owner = Owner { place: &body.place, rest_from_lab: placement.rest_from_lab().boost() };
        let surface = match &body.material {
            Some(material) => self.workshop.surface(material, None, owner, report),
            None => Surface::new(Scatter::Diffuse(Paint::grey(SHAPE_REFLECTANCE))),
        };
        self.add_surfaces(vec![surface], body, report);
        let form = Form::Solid(Arc::new(solid));
        let bounds = self.world.add(number, placement, &form, rest_from_solid, first_surface);
        let volume = (bounds.hi - bounds.lo).element_product();
        self.workshop.media[first_medium..].iter_mut().for_each(|medium| medium.volume = volume);
    }

    fn add_surfaces(&mut self, surfaces: Vec<Surface>, body: &manifest::Body, report: &mut Report) {
        let own = body.ambient.as_ref().and_then(|glow| light::radiance(glow, report));
        let ambient = if own.is_some() { self.ambient.len() as u32 } else { 0 };
        self.ambient.extend(own);
        self.surfaces.extend(surfaces.into_iter().map(|surface| surface.in_ambient(ambient)));
    }
}

/// How large and how turned a body is; none, with a fault, if nothing would be left of it.
fn rest_from_asset(body: &manifest::Body, report: &mut Report) -> Option<DAffine3> {
    let map = DAffine3::from_scale_rotation_translation(body.scale, body.placement.rotation, DVec3::ZERO);
    let scale = body.scale.abs();
    if scale.min_element() >= 1e-100 && scale.max_element() <= 1e100 {
        return Some(map);
    }
    report.fault(
        body.place.clone(),
        "at this scale nothing is left of the body, or nothing else",
        "scale: 0.001",
    );
    None
}

/// The surfaces of a body, one for each material of its file.
fn surfaces(
    body: &manifest::Body,
    asset: &import::Asset,
    workshop: &mut Workshop,
    report: &mut Report,
) -> Vec<Surface> {
    let owner =
        Owner { place: &body.place, rest_from_lab: placement(&body.placement).rest_from_lab().boost() };
    let mut instead: Vec<Option<&manifest::Material>> = vec![body.material.as_deref(); asset.materials.len()];
    for (name, material) in &body.materials {
        let named: Vec<usize> =
            (0..instead.len()).filter(|i| asset.materials[*i].name == name.value).collect();
        if named.is_empty() {
            let known = asset.materials.iter().map(|m| m.name.as_str()).filter(|name| !name.is_empty());
            let hint = match crate::error::nearest_name(&name.value, known.clone()) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => format!("its materials are: {}", known.collect::<Vec<_>>().join(", ")),
            };
            let what = format!("`{}` has no material named `{}`", asset.path.display(), name.value);
            report.fault(name.place.clone(), what, hint);
        }
        for i in named {
            instead[i] = Some(material);
        }
    }
    // One material for the whole body is one surface: of glass it has one inside, whatever its file calls the faces.
    let whole = body.material.as_deref().filter(|material| !matches!(material.kind, MaterialKind::Imported));
    let whole = whole.map(|material| workshop.surface(material, None, owner, report));
    let surface = |(file, instead): (&import::Material, Option<&manifest::Material>)| match instead {
        Some(material) if body.material.as_deref().is_some_and(|of| std::ptr::eq(of, material)) => {
            match &whole {
                Some(surface) => surface.clone(),
                None => workshop.surface(material, Some(file), owner, report),
            }
        }
        Some(material) => workshop.surface(material, Some(file), owner, report),
        None => workshop.imported(file, Beyond::MEAN, owner),
    };
    asset.materials.iter().zip(instead).map(surface).collect()
}

fn observer(manifest: &Manifest, models: &Models, report: &mut Report) -> Observer {
    let written = &manifest.observer;
    let unaberrated = unaberrated(manifest, report);
    if let manifest::Worldline::Camera(camera) = &written.worldline
        && let Some(shot) = camera::shot(camera, manifest, models, report)
    {
        return shot.observer(written, unaberrated);
    }
    let course = match &written.worldline {
        manifest::Worldline::Rest | manifest::Worldline::Camera(_) => Course::Inertial,
        manifest::Worldline::Rocket(rocket) if rocket.acceleration == DVec3::ZERO => Course::Inertial,
        manifest::Worldline::Rocket(rocket) => Course::Rocket { acceleration: rocket.acceleration },
        manifest::Worldline::Orbit(orbit) => Course::Orbit {
            circle: Circle::around(orbit.centre, orbit.axis, orbit.radius, orbit.start),
            proper_speed: orbit.speed,
        },
        manifest::Worldline::Ring(ring) => Course::Ring {
            circle: Circle::around(ring.centre, ring.axis, ring.radius, ring.start),
            turns: ring.turns,
            instants: ring_instants(&manifest.exposures),
        },
        manifest::Worldline::Keys(track) => Course::Keyed(track.clone()),
    };
    let Placement { origin, velocity } = placement(&written.placement);
    let rotation = written.placement.rotation;
    let aim = match &written.view {
        manifest::View::Direction(direction) => Aim::Along(*direction),
        manifest::View::LookAt(LookAt::Body(body)) => {
            let target = placement(&manifest.bodies[body.value].placement);
            Aim::At { rest_from_lab: target.rest_from_lab(), place: DVec3::ZERO }
        }
        manifest::View::LookAt(LookAt::Point(place)) => {
            let lab = Placement { origin: Event::ORIGIN, velocity: Velocity::REST };
            Aim::At { rest_from_lab: lab.rest_from_lab(), place: *place }
        }
    };
    Observer {
        worldline: Worldline::new(origin, velocity, rotation, course),
        aim,
        up: written.up,
        lens: written.optics(),
        unaberrated,
        filmed: None,
        stereo: written.stereo.as_ref().map(manifest::Stereo::eyes),
    }
}

/// The instants at the two ends of a ring's film. Its last exposure, at `to`, stands one step before the ring closes.
fn ring_instants(exposures: &manifest::Exposures) -> (f64, f64) {
    let count = f64::from(exposures.count);
    let span = (exposures.to - exposures.from) * count / (count - 1.0).max(1.0);
    (exposures.from, exposures.from + span)
}

/// The rest frame of all bodies, when aberration is switched off; a fault if they have none in common.
fn unaberrated(manifest: &Manifest, report: &mut Report) -> Option<Unaberrated> {
    if manifest.effects.aberration {
        return None;
    }
    let mut bodies =
        manifest.bodies.iter().flat_map(manifest::Body::placements).map(|placement| placement.velocity);
    let velocity = bodies.next().unwrap_or(Velocity::REST);
    if bodies.any(|other| other != velocity) {
        report.fault(
            manifest.effects.place.clone(),
            "aberration cannot be switched off where bodies move relative to one another",
            "remove `aberration: off`, or give all bodies the same velocity",
        );
    }
    Some(Unaberrated {
        rest_from_lab: Boost::to_moving(velocity),
        rotation: manifest.observer.placement.rotation,
    })
}
