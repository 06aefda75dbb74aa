//! A manifest to begin with, for any model: what is near what, how fast, under which light and how bright, found by
//! measuring the model and by looking at small pictures of it. `terrell new` writes it.

use crate::error::{Error, Place, Report};
use crate::exposure::{expose, first_hits};
use crate::import::{self, Asset};
use crate::manifest;
use crate::plan::Plan;
use crate::scene::{Scene, compose};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// What the film shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// The observer flies past the model.
    Flyby,
    /// The observer circles it.
    Turntable,
}

/// How fast: so much that lines bend and colours shift, and not so much that the end of the film is dark.
const SPEED: f64 = 0.5;
/// Pictures.
const COUNT: u32 = 96;
/// Pictures in a second.
const RATE: f64 = 24.0;
/// Half the way past, in distances.
const REACH: f64 = 1.5;
/// Tangents of half the angle of view, across and down: 50 degrees, 16 to 9.
const HALF_VIEW: (f64, f64) = (0.466, 0.262);
/// The part of the picture's width or height that the model fills at most.
const FILLED: f64 = 0.75;
/// Columns of the small pictures.
const COLUMNS: u32 = 64;
/// The part of white that half of the model is darker than, where most of it is seen.
const MEDIAN: f64 = 0.4;

/// The text of a manifest for a model, to be written to `file`.
///
/// Faults: those of the model, and a model in which there is nothing to be seen.
pub fn starter(model: &Path, file: &Path, motion: Motion) -> Result<String, Error> {
    let asset = import::load(model, model.parent().unwrap_or(Path::new("")))?;
    let extent = asset.extent().filter(|(lo, hi)| (*hi - *lo).length() > 0.0);
    let Some((lo, hi)) = extent else {
        let what = "there is nothing to be seen in this model";
        return Err(Error::fault(Place::file(model), what, "`terrell inspect` shows what is in it"));
    };
    let mut draft = Draft::new(&asset, (lo, hi), (model, file), motion);
    let mut seen = draft.look(file)?;
    if seen.part < 0.1 {
        // Long or thin things come nearer, as far as all of them stays in front.
        let nearer = draft.distance * (seen.part.max(0.01) / 0.15).sqrt();
        draft.distance = nearer.max((hi - lo).length() * 0.75);
        seen = draft.look(file)?;
    }
    if !draft.lit && seen.is_dark() {
        draft.lit = true;
        seen = draft.look(file)?;
    }
    draft.white = seen.white();
    Ok(draft.text())
}

/// What has been chosen.
struct Draft {
    name: String,
    file: String,
    stem: String,
    motion: Motion,
    middle: DVec3,
    size: DVec3,
    distance: f64,
    /// How high a floor is that the model does not have itself.
    floor: Option<f64>,
    /// Whether light is added.
    lit: bool,
    /// The luminance of white.
    white: Option<f64>,
    materials: Vec<String>,
}

impl Draft {
    fn new(asset: &Asset, (lo, hi): (DVec3, DVec3), (model, file): (&Path, &Path), motion: Motion) -> Self {
        let size = hi - lo;
        // From every side: as wide as its diagonal.
        let (wide, high) = (size.x.hypot(size.z), size.y);
        let away = (wide / HALF_VIEW.0).max(high / HALF_VIEW.1) / (2.0 * FILLED);
        let stem = file.file_stem().map_or_else(|| "film".into(), |stem| stem.to_string_lossy());
        let model_stem = model.file_stem().map_or_else(|| "model".into(), |stem| stem.to_string_lossy());
        let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
        let name: String = model_stem.chars().map(plain).collect();
        let name = name.trim_matches('_');
        Self {
            name: if name.starts_with(|c: char| c.is_ascii_alphabetic()) {
                name.to_owned()
            } else {
                format!("model_{name}")
            },
            file: quoted(&path_from(file.parent().unwrap_or(Path::new("")), model)),
            stem: stem.into_owned(),
            motion,
            middle: (lo + hi) / 2.0,
            size,
            distance: away + wide / 4.0,
            floor: (!has_floor(asset, (lo, hi))).then_some(lo.y),
            lit: asset.lights.is_empty(),
            white: None,
            materials: asset
                .materials
                .iter()
                .map(|material| material.name.clone())
                .filter(|name| !name.is_empty())
                .collect(),
        }
    }

    /// Small pictures from the beginning to the middle of the film.
    fn look(&self, file: &Path) -> Result<Seen, Error> {
        let mut report = Report::default();
        let text = self.text();
        let manifest = manifest::parse(file, &text, &mut report);
        let scene = manifest.as_ref().and_then(|manifest| compose(manifest, file, &mut report));
        let (Some(manifest), Some(scene)) = (manifest, scene) else {
            return Err(Error::Input(report.faults));
        };
        let plan = Plan::of(&manifest, &scene, file, &mut report);
        report.finish(Some(()))?;
        Ok(Seen::of(&scene, &plan))
    }
}

/// What small pictures show of the model.
struct Seen {
    /// The part of the picture that it covers where it covers most.
    part: f64,
    /// Its median luminance there.
    median: f64,
    /// The luminance below which 98 of 100 of its pixels are, in each of the pictures.
    bright: f64,
}

impl Seen {
    fn of(scene: &Scene, plan: &Plan) -> Self {
        let sampling = plan.sampling.within(COLUMNS);
        let (width, height) = (sampling.width, sampling.height);
        let model = |index: usize| -> Vec<f64> {
            let view = scene.observer.view(plan.exposures[index].tau, width, height);
            let hits = first_hits(scene, &view, width, height);
            let pixels = expose(scene, &view, &sampling).xyz;
            let own = hits.iter().zip(&pixels).filter(|(hit, _)| hit.is_some_and(|hit| hit.body == 0));
            let mut own: Vec<f64> = own.map(|(_, xyz)| f64::from(xyz[1])).collect();
            own.sort_unstable_by(f64::total_cmp);
            own
        };
        let middle = plan.exposures.len() / 2;
        let pictures = [middle, 0, middle / 2].map(model);
        let bright = pictures.iter().map(|own| quantile(own, 0.98)).fold(0.0, f64::max);
        // Thin things are not seen from all sides.
        let most =
            pictures.iter().fold(&pictures[0], |most, own| if own.len() > most.len() { own } else { most });
        let part = most.len() as f64 / (f64::from(width) * f64::from(height));
        Self { part, median: quantile(most, 0.5), bright }
    }

    fn is_dark(&self) -> bool {
        self.median <= 0.01 * self.bright
    }

    /// Half of the model is darker than some part of white, and hardly any of it brighter than white.
    fn white(&self) -> Option<f64> {
        let white = (self.median / MEDIAN).max(self.bright);
        (white > 0.0).then_some(white)
    }
}

fn quantile(rising: &[f64], part: f64) -> f64 {
    rising.get((rising.len() as f64 * part) as usize).copied().unwrap_or(0.0)
}

/// Whether a model stands on something of its own: flat faces that look up low down, under much of it.
fn has_floor(asset: &Asset, (lo, hi): (DVec3, DVec3)) -> bool {
    let size = hi - lo;
    let low = lo.y + 0.05 * size.y;
    let mut area = 0.0;
    for instance in &asset.instances {
        let mesh = &asset.meshes[instance.mesh];
        let place = |i: u32| instance.asset_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3());
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(place);
            let across = (b - a).cross(c - a) / 2.0;
            if a.y.max(b.y).max(c.y) <= low && across.y > 0.9 * across.length() {
                area += across.y;
            }
        }
    }
    area > 0.4 * size.x * size.z
}

/// A path as seen from a folder.
fn path_from(folder: &Path, path: &Path) -> PathBuf {
    let real = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        path.canonicalize().unwrap_or_else(|_| path.to_owned())
    };
    let (from, to) = (real(folder), real(path));
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return to;
    }
    let up = from.components().skip(shared).map(|_| Path::new(".."));
    up.chain(to.components().skip(shared).map(|part| Path::new(part.as_os_str()))).collect()
}

/// A path as YAML reads it.
fn quoted(path: &Path) -> String {
    let text = path.to_string_lossy();
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '/' | '_' | '-');
    if text.chars().all(plain) && !text.starts_with('-') {
        text.into_owned()
    } else {
        serde_json::Value::from(text).to_string()
    }
}

/// A number to three digits.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// The nearest of 1, 2 and 5 times a power of ten.
fn round(x: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(x).floor());
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().min_by(|a, b| {
        let off = |d: f64| (libm::log(x / power / d)).abs();
        off(*a).total_cmp(&off(*b))
    });
    digit.unwrap_or(1.0) * power
}

/// Lines of a manifest, each with what it means.
struct Lines(String);

impl Lines {
    /// A line with the meaning of a key, by its path.
    fn key(&mut self, indent: usize, line: &str, path: &[&str]) {
        self.said(indent, line, &manifest::meaning(path));
    }

    fn said(&mut self, indent: usize, line: &str, comment: &str) {
        self.0 += &format!("{:indent$}{line} # {comment}\n", "");
    }
}

impl Draft {
    fn text(&self) -> String {
        let mut lines = Lines(String::new());
        let (way, stem) = (if self.motion == Motion::Flyby { "passed" } else { "circled" }, &self.stem);
        lines.0 += &format!("# {} is {way} at half the speed of light.\n", self.name);
        lines.0 += &format!(
            "# terrell check {stem}.yaml says what it needs; terrell render {stem}.yaml makes the film.\n"
        );
        lines.0 += "# All keys there are: manifests/REFERENCE.md, or `terrell schema` for an editor.\n";
        let extent = format!("{} x {} x {} m", short(self.size.x), short(self.size.y), short(self.size.z));
        let second = format!("light_speed: {} m/s", short(self.light_speed()));
        lines.said(
            0,
            &second,
            "Such that the observer's clock and the film go alike; without it, the real one.",
        );
        self.things(&mut lines, &extent);
        if self.lit {
            lines.key(0, "lights:", &["lights"]);
            let sun =
                "- sun: { illuminance: 1000 lx, direction: -0.6 -1 -0.7, spectrum: { black_body: 5600 K } }";
            lines.key(2, sun, &["lights", "sun"]);
            lines.key(0, "ambient: { luminance: 60 cd/m2 }", &["ambient"]);
        }
        self.motion(&mut lines);
        lines.key(0, "observer:", &["observer"]);
        lines.key(2, "field_of_view: 50 deg", &["observer", "field_of_view"]);
        lines.key(0, "picture:", &["picture"]);
        lines.key(2, "size: 1280 720", &["picture", "size"]);
        lines.key(2, "samples: 4", &["picture", "samples"]);
        match self.white {
            Some(white) => {
                let line = format!("white: {} cd/m2", short(white));
                lines.said(
                    2,
                    &line,
                    "The luminance that is shown as white, measured on the model; `auto` measures the film.",
                );
            }
            None => lines.key(2, "white: auto", &["picture", "white"]),
        }
        lines.key(0, "film:", &["film"]);
        lines.key(2, &format!("rate: {RATE}"), &["film", "rate"]);
        let folder = quoted(Path::new(&format!("out/{stem}")));
        lines.key(0, &format!("output: {folder}"), &["output"]);
        lines.0
    }

    /// Assets and bodies.
    fn things(&self, lines: &mut Lines, extent: &str) {
        let name = &self.name;
        lines.key(0, "assets:", &["assets"]);
        lines.said(
            2,
            &format!("{name}: {}", self.file),
            &format!("The model, {extent}; `terrell inspect` shows what is in it."),
        );
        if self.floor.is_some() {
            lines.said(2, "floor: plane", "A shape: all of the plane y = 0.");
        }
        lines.key(0, "bodies:", &["bodies"]);
        lines.key(2, &format!("- asset: {name}"), &["bodies", "asset"]);
        lines.said(
            4,
            "velocity: 0 0 0 c",
            "Its velocity in the lab; if it is to move, give `past` or `around` its name.",
        );
        if let Some(material) = self.materials.first().filter(|name| !name.contains(char::is_control)) {
            let named = serde_json::Value::from(material.as_str());
            let line = format!("# materials: {{ {named}: {{ diffuse: 0.5 }} }}");
            lines.key(4, &line, &["bodies", "materials"]);
        }
        if let Some(floor) = self.floor {
            let square = short(round(self.size.max_element() / 3.0));
            let checker = format!("{{ checker: {{ size: {square} m, even: 0.5, odd: 0.25 }} }}");
            lines.key(2, "- asset: floor", &["bodies", "asset"]);
            lines.key(4, &format!("at: 0 {} 0 m", short(floor)), &["bodies", "at"]);
            lines.key(4, &format!("material: {{ diffuse: {checker} }}"), &["bodies", "material"]);
        }
    }

    /// The turntable or the flyby.
    fn motion(&self, lines: &mut Lines) {
        let middle = self.middle.to_array().map(short).join(" ");
        let (distance, height) = (short(self.distance), short(self.distance * 0.25));
        let written: [String; 6] = match self.motion {
            Motion::Flyby => [
                format!("past: {middle} m"),
                format!("distance: {distance} m"),
                format!("speed: {SPEED} c"),
                "side: 0 0.25 1".to_owned(),
                format!("reach: {REACH}"),
                format!("count: {COUNT}"),
            ],
            Motion::Turntable => [
                format!("around: {middle} m"),
                format!("radius: {distance} m"),
                format!("height: {height} m"),
                format!("speed: {SPEED} c"),
                "turns: 1".to_owned(),
                format!("count: {COUNT}"),
            ],
        };
        let key = if self.motion == Motion::Flyby { "flyby" } else { "turntable" };
        lines.key(0, &format!("{key}:"), &[key]);
        for line in &written {
            lines.key(2, line, &[key, line.split(':').next().unwrap_or_default()]);
        }
    }

    /// Metres that light goes in a second, if the film lasts as long as the observer's clock says.
    fn light_speed(&self) -> f64 {
        let way = match self.motion {
            Motion::Flyby => 2.0 * REACH * self.distance,
            Motion::Turntable => std::f64::consts::TAU * self.distance,
        };
        let own = way * (1.0 - SPEED * SPEED).sqrt() / SPEED;
        round(own * RATE / f64::from(COUNT))
    }
}
