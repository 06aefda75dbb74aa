//! Material libraries (MTL): colour, coverage, glow and their textures, refraction, metalness and roughness.

use super::tidy::{lines, number, split};
use crate::error::{Fault, Place};
use crate::import::{Coverage, Job, Material, picture};
use crate::texture::{Filter, Picture, Texture, Wrap};
use glam::{DAffine2, DVec2};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The materials of all libraries of a file.
#[derive(Default)]
pub(super) struct Library {
    pub materials: Vec<Material>,
    /// Their numbers by name; the last of a name counts.
    pub numbers: BTreeMap<String, usize>,
    /// The files, without links.
    files: BTreeSet<PathBuf>,
    /// Pictures by their files without links, and whether alpha is left out.
    pictures: BTreeMap<(PathBuf, bool), Option<Arc<Picture>>>,
}

/// Loads the libraries that the rest of a `mtllib` line names: one with blanks in its name, or several.
pub(super) fn load(names: &str, line: usize, library: &mut Library, job: &mut Job) {
    let whole = job.files.find(&job.folder, names);
    let several = whole.as_ref().is_err_and(|refusal| refusal.missing) && names.contains(char::is_whitespace);
    if several {
        for name in names.split_whitespace() {
            load_one(name, job.files.find(&job.folder, name), line, library, job);
        }
    } else {
        load_one(names, whole, line, library, job);
    }
}

fn load_one(
    name: &str,
    found: Result<PathBuf, crate::import::files::Refusal>,
    line: usize,
    library: &mut Library,
    job: &mut Job,
) {
    // Some programs name the same library before every object.
    if found.as_ref().is_ok_and(|path| !library.files.insert(path.clone())) {
        return;
    }
    let bytes = found.and_then(|path| Ok((job.files.read(&path)?, path)));
    match bytes {
        Ok((bytes, path)) => {
            let shown = job.path.with_file_name(name.replace('\\', "/"));
            let mut reader = Reader { shown, line: 0, folder: path.parent().unwrap_or(&path), job };
            reader.read(&String::from_utf8_lossy(&bytes), library);
        }
        Err(refusal) if refusal.missing => {
            let what = format!("{}; its materials are white", refusal.what);
            job.warn(format!("line {line}"), what, refusal.hint);
        }
        Err(refusal) => job.refused(format!("line {line}"), refusal),
    }
}

/// Names and lines that `tobj` does not keep.
#[derive(Default)]
struct Written {
    name: String,
    /// The lines of the textures of colour and glow.
    lines: [usize; 2],
    /// The last word of `map_d`, and its line.
    coverage: Option<(String, usize)>,
    /// `Ni`.
    ior: Option<f32>,
    /// `Pm` and `Pr`, which only materials that reflect have.
    metallic: Option<f32>,
    roughness: Option<f32>,
}

/// Where one library is read.
struct Reader<'a> {
    /// The file as messages name it.
    shown: PathBuf,
    line: usize,
    /// The folder it is in, without links.
    folder: &'a Path,
    job: &'a mut Job,
}

impl Reader<'_> {
    fn place(&self) -> Place {
        Place::element(&self.shown, format!("line {}", self.line))
    }

    fn fault(&mut self, what: impl Into<String>, hint: &str) {
        self.job.found(Fault::new(self.place(), what, hint));
    }

    fn warn(&mut self, what: impl Into<String>) {
        self.job.noticed(Fault::new(self.place(), what, ""));
    }

    fn read(&mut self, text: &str, library: &mut Library) {
        let mut tidied = String::new();
        let mut written: Vec<Written> = Vec::new();
        for (number, line) in lines(text) {
            self.line = number;
            if let Err(what) = self.tidy(&line, &mut tidied, &mut written) {
                self.fault(what, "");
            }
        }
        let materials = match tobj::load_mtl_buf(&mut tidied.as_bytes()) {
            Ok((materials, _)) => materials,
            Err(error) => {
                self.job.found(Fault::new(Place::file(&self.shown), error.to_string(), ""));
                return;
            }
        };
        for (material, written) in materials.iter().zip(written) {
            let material = self.material(material, &written, library);
            library.numbers.insert(written.name, library.materials.len());
            library.materials.push(material);
        }
    }

    /// Checks a line and writes it down in a form that `tobj` is sure to understand.
    fn tidy(&mut self, line: &str, tidied: &mut String, all: &mut Vec<Written>) -> Result<(), String> {
        let (key, rest) = split(line);
        let key = key.to_ascii_lowercase();
        if key == "newmtl" {
            if rest.is_empty() {
                return Err("a material without a name".into());
            }
            tidied.push_str(&format!("newmtl {}\n", all.len()));
            all.push(Written { name: rest.to_owned(), ..Written::default() });
            return Ok(());
        }
        const KNOWN: [&str; 13] = [
            "kd", "ke", "d", "tr", "ni", "pm", "pr", "map_kd", "map_ke", "map_d", "map_pm", "map_pr", "norm",
        ];
        let known = KNOWN.contains(&key.as_str());
        let Some(written) = all.last_mut().filter(|_| known) else {
            return if known { Err(format!("`{key}` before the first newmtl")) } else { Ok(()) };
        };
        match key.as_str() {
            "kd" | "ke" if rest.starts_with("spectral") || rest.starts_with("xyz") => {
                self.warn(format!("a {key} that is not of three numbers is passed over"));
            }
            "kd" | "ke" => {
                let [r, g, b] = color(rest)?;
                let key = if key == "kd" { "Kd" } else { "Ke" };
                tidied.push_str(&format!("{key} {r} {g} {b}\n"));
            }
            "d" | "tr" => {
                let value = number(rest.split_whitespace().last().unwrap_or(""))?;
                let coverage = if key == "d" { value } else { 1.0 - value };
                tidied.push_str(&format!("d {}\n", coverage.clamp(0.0, 1.0)));
            }
            "ni" => match number(rest)? {
                ior if ior >= 1.0 => written.ior = Some(ior),
                ior => self.warn(format!("a refractive index of {ior} is passed over: they begin at 1")),
            },
            "pm" => written.metallic = Some(share(rest)?),
            "pr" => written.roughness = Some(share(rest)?),
            "map_pm" | "map_pr" | "norm" => self.warn(format!("`{key}` is passed over")),
            "map_kd" | "map_ke" if !rest.is_empty() => {
                let glow = usize::from(key == "map_ke");
                written.lines[glow] = self.line;
                tidied.push_str(&format!("{} {rest}\n", ["map_Kd", "map_Ke"][glow]));
            }
            "map_d" if !rest.is_empty() => {
                written.coverage = Some((options(rest)?.name.to_owned(), self.line));
            }
            _ => return Err(format!("`{key}` without the name of a picture")),
        }
        Ok(())
    }

    fn material(&mut self, material: &tobj::Material, written: &Written, library: &mut Library) -> Material {
        // A colour that is only in the texture is left out by Blender.
        let [r, g, b] = material.diffuse.unwrap_or([1.0; 3]);
        let glow = material.unknown_param.get("map_Ke");
        let dark = if glow.is_some() { [1.0; 3] } else { [0.0; 3] };
        // Blender writes the picture of the colour again as `map_d` when its alpha is used.
        let base = material.diffuse_texture.as_deref();
        let same = |(name, _): &(String, usize)| {
            base.and_then(|base| options(base).ok()).is_some_and(|base| base.name == name)
        };
        let covered = written.coverage.as_ref().is_some_and(same);
        if let Some((_, line)) = written.coverage.as_ref().filter(|_| !covered) {
            self.line = *line;
            self.warn("a map_d other than the alpha of map_Kd's picture is passed over");
        }
        self.line = written.lines[0];
        let base_texture = base.and_then(|base| self.texture(base, !covered, library));
        self.line = written.lines[1];
        let emissive_texture = glow.and_then(|glow| self.texture(glow, true, library));
        let dissolve = material.dissolve.unwrap_or(1.0);
        let cut = covered && base_texture.as_ref().is_some_and(|base| !picture::is_opaque(&base.picture));
        let mut made = Material {
            name: written.name.clone(),
            base_color: [r, g, b, dissolve],
            base_texture,
            coverage: if cut || dissolve < 1.0 { Coverage::Blend } else { Coverage::Opaque },
            emissive: material.emissive.unwrap_or(dark),
            emissive_texture,
            double_sided: true,
            ior: written.ior.unwrap_or(1.5),
            ..Material::default()
        };
        // Without these the material is one of Lambert's: `Ks` and `Ns` are of a law that is not physical.
        if written.metallic.is_some() || written.roughness.is_some() {
            made.metal.metallic = written.metallic.unwrap_or(0.0);
            made.metal.roughness = written.roughness.unwrap_or(1.0);
            made.specular.strength = 1.0;
        }
        made
    }

    /// The texture that the rest of a `map_` line describes.
    fn texture(&mut self, words: &str, opaque: bool, library: &mut Library) -> Option<Texture> {
        let options = options(words).map_err(|what| self.fault(what, "")).ok()?;
        let path = match self.job.files.find(self.folder, options.name) {
            Ok(path) => path,
            Err(refusal) => {
                self.fault(refusal.what, &refusal.hint);
                return None;
            }
        };
        let key = (path, opaque);
        if !library.pictures.contains_key(&key) {
            let picture = self.picture(&key.0, opaque);
            library.pictures.insert(key.clone(), picture);
        }
        let picture = library.pictures.get(&key)?.clone()?;
        let wrap = [if options.clamp { Wrap::Clamp } else { Wrap::Repeat }; 2];
        // v runs up in the file and down in the mesh.
        let origin = DVec2::new(options.origin.x, 1.0 - options.scale.y - options.origin.y);
        let transform = DAffine2::from_scale_angle_translation(options.scale, 0.0, origin);
        Some(Texture { picture, wrap, filter: Filter::Linear, uv_set: 0, transform })
    }

    fn picture(&mut self, path: &Path, opaque: bool) -> Option<Arc<Picture>> {
        let name = path.to_string_lossy();
        let files = &mut self.job.files;
        match files.read(path).and_then(|bytes| picture::decode(&bytes, &name, files)) {
            Ok(picture) if opaque => Some(Arc::new(picture::opaque(picture))),
            Ok(picture) => Some(Arc::new(picture)),
            Err(refusal) => {
                self.fault(format!("`{}`: {}", name, refusal.what), &refusal.hint);
                None
            }
        }
    }
}

fn color(words: &str) -> Result<[f32; 3], String> {
    let mut color = [0.0; 3];
    let mut words = words.split_whitespace();
    for (i, channel) in color.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| format!("a colour has 3 numbers, not {i}"))?;
        *channel = number(word)?;
        if *channel < 0.0 {
            return Err(format!("a colour has no negative number such as {word}"));
        }
    }
    Ok(color)
}

/// A number from 0 to 1.
fn share(word: &str) -> Result<f32, String> {
    match number(word)? {
        value if (0.0..=1.0).contains(&value) => Ok(value),
        value => Err(format!("{value} is out of range: type a number from 0 to 1")),
    }
}

/// A texture's file with the options before it.
struct Options<'a> {
    /// `-s u v w`.
    scale: DVec2,
    /// `-o u v w`.
    origin: DVec2,
    /// `-clamp on`.
    clamp: bool,
    /// The rest of the line, blanks included.
    name: &'a str,
}

/// Takes the options before the name of a texture's file apart.
fn options(words: &str) -> Result<Options<'_>, String> {
    let mut options = Options { scale: DVec2::ONE, origin: DVec2::ZERO, clamp: false, name: words };
    let mut turbulence = DVec2::ZERO;
    while options.name.starts_with('-') {
        let (option, rest) = split(options.name);
        options.name = match option {
            "-s" => pair(rest, &mut options.scale),
            "-o" => pair(rest, &mut options.origin),
            "-t" => pair(rest, &mut turbulence),
            "-mm" => split(split(rest).1).1,
            "-clamp" => {
                let (word, rest) = split(rest);
                options.clamp = word == "on";
                rest
            }
            "-bm" | "-boost" | "-texres" | "-imfchan" | "-type" | "-cc" | "-blendu" | "-blendv"
            | "-colorspace" => split(rest).1,
            // A name may begin with a dash, too.
            _ => break,
        };
    }
    if options.name.is_empty() {
        return Err("a texture without the name of a picture".into());
    }
    Ok(options)
}

/// Reads one to three numbers, of which the first two count; what comes after them.
fn pair<'a>(words: &'a str, values: &mut DVec2) -> &'a str {
    let mut rest = words;
    for i in 0..3 {
        let (word, after) = split(rest);
        let Ok(value) = number(word) else { break };
        if i < 2 {
            values[i] = f64::from(value);
        }
        rest = after;
    }
    rest
}
