//! The manifest: what is in the world, who looks, and what is made of it, as YAML text.
//!
//! [`parse`] turns the text into a [`Manifest`] in house units (metres, c = 1, radians, kelvin, nanometres)
//! with names resolved. It reports every fault it finds, each with its line and column and what to type
//! instead; unknown keys are faults. [`shape`] describes all keys.
//!
//! ~~~
//! use terrell::error::Report;
//! let mut report = Report::default();
//! let text = "{ observer: { velocity: 0.8 0 0 c }, output: out }";
//! let manifest = terrell::manifest::parse("m.yaml".as_ref(), text, &mut report).unwrap();
//! assert!((manifest.observer.placement.velocity.gamma() - 5.0 / 3.0).abs() < 1e-15);
//! ~~~

mod body;
mod camera;
mod canonical;
mod course;
mod exposures;
mod extends;
mod glass;
mod keyed;
mod lens;
mod light;
mod list;
mod material;
mod motion;
mod names;
mod node;
mod observer;
mod output;
mod overrides;
mod paint;
mod picture;
mod plain;
mod quantity;
mod reader;
mod record;
mod reference;
mod schema;
mod shorthand;
mod solid;
mod spectrum;
mod stereo;
mod surroundings;
mod swarm;
mod table;
mod units;
mod yaml;

pub use body::{AssetRef, AssetSource, Body, ModelFile};
pub use camera::Camera;
pub use course::{Blinking, Course, Key};
pub use exposures::{Clock, Exposures};
pub use glass::{Glass, GlassName, Index, Tint};
pub use keyed::ObserverKey;
pub use lens::Lens;
pub use light::{Amount, Glow, Lamp, Light, LightSource, Spot, Strength, Sun};
pub use material::{Beyond, BlinkingMaterial, Gloss, Material, MaterialKey, MaterialKind, Metal, MetalName};
pub(crate) use motion::GREATEST_GAMMA;
pub use motion::Placement;
pub use observer::{LookAt, Observer, Orbit, Ring, Rocket, View, Worldline};
pub use output::{Depth, Exr, Film, Layer, Output};
pub use paint::Paint;
pub(crate) use picture::USUAL_SIZE;
pub use picture::{Effects, Filter, Picture, White};
pub use reader::LIGHT_SPEED;
pub use record::{Field, Presence, RecordShape, Shape};
pub use reference::{meaning, reference};
pub use schema::schema;
pub use shorthand::{Flyby, Shorthand, Turntable};
pub use solid::{Cone, Cuboid, Cylinder, Plane, Pose, Solid, SolidForm, Sphere};
pub use spectrum::{Illuminant, Line, Spectrum};
pub use stereo::{Layout, Stereo};
pub use surroundings::{SkyPicture, StarOrigin, Stars, Surroundings};
pub use swarm::Swarm;
pub use table::Rows;
pub(crate) use table::read_text;

use crate::error::{Place, Report};
use body::{Assets, Bodies};
use exposures::ExposuresKind;
use extends::Extends;
use light::GlowKind;
use material::Materials;
use motion::LightSpeed;
use node::Source;
use observer::ObserverKind;
use output::OutputKind;
use reader::{Read, Reader, Reported};
use record::{Kind, List, record};
use spectrum::Spectra;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use surroundings::SurroundingsKind;

/// A value and where it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spanned<T> {
    /// What is written.
    pub value: T,
    /// Where.
    pub place: Place,
}

record! {
    /// A manifest.
    pub Manifest, "a manifest" {
        @include shorthand: Shorthand, "Observer and exposures in short; what it stands for is in those.";
        /// Manifests that this one begins from, a path or a list of them: what is said here (and further on in the list) takes the
        /// place of what they say. Maps are merged key by key, `key: ~` takes a key away (as exposures `at` a time do those `from`
        /// one `to` another), and `bodies` and `lights` may be maps that change items by name or number (`+` adds some). Paths in
        /// them are relative to their own folders.
        extends: Vec<PathBuf> = Extends, default(Vec::new()), "studio.yaml";
        /// The speed of light in metres per second: what the seconds of this manifest are.
        light_speed: f64 = LightSpeed, default(LIGHT_SPEED), "1 m/s";
        /// Spectra by name.
        spectra: BTreeMap<String, Arc<Spectrum>> = Spectra, default(BTreeMap::new()), "{ sodium: { line: 589 nm } }";
        /// Materials by name.
        materials: BTreeMap<String, Arc<Material>> = Materials, default(BTreeMap::new()), "{ white: { diffuse: 0.8 } }";
        /// Model files and shapes by name.
        assets: BTreeMap<String, AssetRef> = Assets, default(BTreeMap::new()), "{ monkey: models/monkey.glb }";
        /// What is there to be seen.
        bodies: Vec<Body> = Bodies, default(Vec::new()), "[{ asset: monkey }]";
        /// What shines, beside the lights in the assets.
        lights: Vec<Light> = List<Light>, default(Vec::new()), "[{ lamp: { intensity: 300 cd } }]";
        /// Light that falls on each body from all sides alike, in its rest frame.
        ambient: Option<Glow> = GlowKind, optional, "{ luminance: 20 cd/m2 }";
        /// What is seen behind everything, infinitely far away; a list of them if they are at rest in several frames.
        surroundings: Vec<Surroundings> = SurroundingsKind, default(Vec::new()), "{ stars: { seed: 7, count: 5000 } }";
        /// Who looks. It has to be there, or `turntable` or `flyby`.
        observer: Observer = ObserverKind, empty, "{ at: 0 1.2 5 m }";
        /// When pictures are taken: one, at 0 s, unless said.
        exposures: Exposures = ExposuresKind, empty, "{ from: -4 s, to: 9 s, count: 96 }";
        /// What the pictures are like.
        picture: Picture = Picture, empty, "{ size: 1280 720 }";
        /// The film made of them: made if there is more than one.
        film: Option<Film> = Film, optional, "{ rate: 24 }";
        /// Where everything goes that is written.
        output: Output = OutputKind, required, "../out/flyby";
        /// What is shown of relativity.
        effects: Effects = Effects, empty, "{ searchlight: off }";
    }
}

/// What a manifest looks like: all keys, from the outermost.
pub fn shape() -> Shape {
    Manifest::shape()
}

/// Reads the manifest in a file; see [`parse`].
pub fn load(path: &Path, report: &mut Report) -> Option<Manifest> {
    load_with(path, &[], report)
}

/// Reads the manifest in a file, some of its values given on the command line; see [`parse_with`].
pub fn load_with(path: &Path, overrides: &[(String, String)], report: &mut Report) -> Option<Manifest> {
    load_draft(path, overrides, report).and_then(Draft::whole)
}

/// Reads what can be read of the manifest in a file; see [`parse_with`].
pub fn load_draft(path: &Path, overrides: &[(String, String)], report: &mut Report) -> Option<Draft> {
    if crate::import::is_model(path) && path.is_file() {
        let hint = format!("terrell new {} writes a manifest for it", path.display());
        report.fault(Place::file(path), "this is a model, not a manifest", hint);
        return None;
    }
    match read_text(path) {
        Ok(text) => parse_draft(path, &text, overrides, report),
        Err(why) => {
            report.fault(Place::file(path), why, "name a manifest, a YAML text file");
            None
        }
    }
}

/// Reads a manifest from its text. `path` is where paths in it are relative to, and how places are named.
///
/// None if there is any fault; all of those found are in the report, in the order of the text.
pub fn parse(path: &Path, text: &str, report: &mut Report) -> Option<Manifest> {
    parse_with(path, text, &[], report)
}

/// Reads a manifest of which some values are given on the command line: pairs of a path of keys and a YAML
/// text, such as `bodies.0.velocity` and `0 0 0.5 c`.
pub fn parse_with(
    path: &Path,
    text: &str,
    overrides: &[(String, String)],
    report: &mut Report,
) -> Option<Manifest> {
    parse_draft(path, text, overrides, report).and_then(Draft::whole)
}

/// What could be read of a manifest.
#[derive(Debug, Clone)]
pub struct Draft {
    /// All of it, or, where it has faults, the assets, bodies and surroundings that have none, beside what is usual: there may
    /// be more faults in the files that these name.
    pub manifest: Manifest,
    /// Whether it has no faults.
    pub sound: bool,
}

impl Draft {
    /// The manifest, if it has no faults.
    pub fn whole(self) -> Option<Manifest> {
        Some(self.manifest).filter(|_| self.sound)
    }
}

fn parse_draft(
    path: &Path,
    text: &str,
    overrides: &[(String, String)],
    report: &mut Report,
) -> Option<Draft> {
    let mut found = Report::default();
    let mut files = vec![path.to_owned()];
    let root = yaml::parse(&Source::file(path, text), text, &mut found)
        .map(|root| extends::resolve(root, path, &mut files, &mut found));
    report.inputs.bases.extend(files.iter().skip(1).cloned());
    let draft = root.and_then(|(root, partial)| {
        let root = overrides::apply(root, overrides, partial, &mut found)?;
        report.inputs.manifest = Some(canonical::digest(&root));
        draft(path, &root, partial, &mut found)
    });
    let sound = found.faults.is_empty();
    found.faults.sort_by_key(|fault| extends::order(&files, &fault.place));
    report.faults.append(&mut found.faults);
    report.warnings.append(&mut found.warnings);
    report.inputs.extend(found.inputs);
    files.remove(0);
    draft.map(|draft| Draft {
        manifest: Manifest { extends: files, ..draft.manifest },
        sound: draft.sound && sound,
    })
}

fn draft(path: &Path, root: &node::Node, partial: bool, report: &mut Report) -> Option<Draft> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut reader = Reader::new(folder, report);
    reader.partial = partial;
    if let Ok(manifest) = read(root, &mut reader) {
        extends::warn_of_output(root, path, report);
        return Some(Draft { manifest, sound: true });
    }
    let Reader { rest, light_speed, .. } = reader;
    let mut manifest = yaml::parse(&Source::file(path, USUAL), USUAL, report)
        .and_then(|usual| <Manifest as Kind>::read(&usual, &mut Reader::new(folder, report)).ok())?;
    (manifest.assets, manifest.bodies, manifest.surroundings) = (rest.assets, rest.bodies, rest.surroundings);
    manifest.light_speed = light_speed;
    Some(Draft { manifest, sound: false })
}

/// What has to be said.
const USUAL: &str = "{ observer: {}, output: out }";

fn read(root: &node::Node, reader: &mut Reader<'_>) -> Read<Manifest> {
    let looking = if extends::nobody_looks(root) {
        let what = "a manifest needs `observer`, `turntable` or `flyby`";
        Err(reader.missing(&root.place, what, "observer: { at: 0 1.2 5 m }"))
    } else {
        Ok(())
    };
    let apart = shorthand::check(root, reader);
    let mut manifest = <Manifest as Kind>::read(root, reader)?;
    looking.and(apart)?;
    if reader.partial {
        return Err(Reported); // What follows is about the whole.
    }
    shorthand::expand(&mut manifest, root, reader)?;
    let mut used: BTreeSet<_> = manifest.bodies.iter().map(|body| &body.asset.value).collect();
    if let Worldline::Camera(camera) = &manifest.observer.worldline {
        used.insert(&camera.asset.value);
    }
    for (name, asset) in &manifest.assets {
        if !used.contains(name) {
            reader.report.warn(asset.place.clone(), format!("no body is made of the asset `{name}`"), "");
        }
    }
    lens::check_size(&manifest, reader.report);
    stereo::check(&manifest, reader.report);
    let several = manifest.exposures.count > 1 || !manifest.exposures.timed;
    if manifest.film.is_none() && several {
        manifest.film = Some(Film::usual());
    }
    Ok(manifest)
}
