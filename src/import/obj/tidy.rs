//! OBJ text, checked line by line and made into a plainer text that says the same.

use super::mtl::{self, Library};
use crate::import::Job;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::str::SplitWhitespace;

/// A checked file.
pub(super) struct Tidied {
    /// OBJ text with numbers for the names of objects and materials.
    pub text: Vec<u8>,
    /// Names of the objects.
    pub objects: Vec<String>,
    /// The materials of all libraries.
    pub library: Library,
}

/// What is known at a line.
struct Tidy<'a> {
    job: &'a mut Job,
    done: Tidied,
    /// Whether any vertex of the file has a colour; then all get one.
    colored: bool,
    /// Positions, texture coordinates and normals so far.
    counts: [usize; 3],
    /// Numbers of the objects.
    numbers: BTreeMap<String, usize>,
    /// The name of the object that the next face belongs to.
    object: String,
    /// The number of that object, once it has a face, and which attributes its last face had.
    run: Option<(usize, u8)>,
    /// What was warned of already.
    noticed: BTreeSet<&'static str>,
}

/// Checks a file; none if it is at fault, which is reported.
pub(super) fn tidy(text: &str, job: &mut Job) -> Option<Tidied> {
    let before = job.faults;
    let done = Tidied {
        text: Vec::with_capacity(text.len() + text.len() / 8),
        objects: Vec::new(),
        library: Library::default(),
    };
    let object = job.path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let mut tidy = Tidy {
        job,
        done,
        colored: text.lines().any(has_color),
        counts: [0; 3],
        numbers: BTreeMap::new(),
        object,
        run: None,
        noticed: BTreeSet::new(),
    };
    tidy.write("mtllib all");
    for (number, line) in lines(text) {
        if let Err(what) = tidy.line(&line, number) {
            tidy.job.fault(format!("line {number}"), what, "");
        }
    }
    let Tidy { job, done, .. } = tidy;
    if job.faults == before && done.objects.is_empty() {
        job.fault("the whole file", "has no faces", "export the model again, with its meshes");
    }
    (job.faults == before).then_some(done)
}

/// Lines with their numbers, put together where a backslash at the end says so, without the blanks around.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut rest = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (i, line) = rest.next()?;
        let mut whole = Cow::Borrowed(line.trim());
        while let Some(part) = whole.strip_suffix('\\') {
            let part = format!("{part} ");
            let next = rest.next().map_or("", |(_, line)| line.trim());
            whole = Cow::Owned(part + next);
        }
        Some((i + 1, whole))
    })
}

/// Keyword and the rest of a line.
pub(super) fn split(line: &str) -> (&str, &str) {
    line.split_once(char::is_whitespace).map_or((line, ""), |(key, rest)| (key, rest.trim()))
}

fn has_color(line: &str) -> bool {
    let (key, rest) = split(line.trim_start());
    key == "v" && rest.split_whitespace().nth(5).is_some()
}

/// A finite number.
pub(super) fn number(word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{word}` is not a finite number")),
        Err(_) => Err(format!("`{word}` is not a number")),
    }
}

impl Tidy<'_> {
    fn write(&mut self, line: &str) {
        self.done.text.extend_from_slice(line.as_bytes());
        self.done.text.push(b'\n');
    }

    fn line(&mut self, line: &str, number: usize) -> Result<(), String> {
        let (key, rest) = split(line);
        // Comments stand on lines of their own, but some programs put them behind numbers, too.
        let numbers = rest.split_once('#').map_or(rest, |(numbers, _)| numbers);
        match key {
            "v" => self.position(numbers),
            "vt" => self.texture_coordinates(numbers),
            "vn" => self.normal(numbers),
            "f" => self.face(numbers),
            "o" | "g" => {
                let name = if rest.is_empty() { "default" } else { rest };
                name.clone_into(&mut self.object);
                self.run = None;
                Ok(())
            }
            "mtllib" => {
                mtl::load(rest, number, &mut self.done.library, self.job);
                Ok(())
            }
            "usemtl" => {
                self.material(rest, number);
                Ok(())
            }
            "l" | "p" => {
                self.notice("points and lines have no surface and are passed over", number);
                Ok(())
            }
            "vp" | "cstype" | "deg" | "bmat" | "step" | "curv" | "curv2" | "surf" => {
                self.notice("curved surfaces are passed over; export the model as polygons", number);
                Ok(())
            }
            "" | "s" => Ok(()),
            _ if key.starts_with('#') => Ok(()),
            _ => {
                self.notice("lines that begin with unknown words are passed over", number);
                Ok(())
            }
        }
    }

    /// Warns the first time.
    fn notice(&mut self, what: &'static str, number: usize) {
        if self.noticed.insert(what) {
            self.job.warn(format!("line {number}"), what, "");
        }
    }

    fn position(&mut self, words: &str) -> Result<(), String> {
        self.counts[0] += 1;
        let mut values = [0.0; 6];
        let count = numbers(words, &mut values)?;
        let [x, y, z, w, ..] = values;
        match count {
            3 if !self.colored => self.write(&format!("v {words}")),
            3 => self.write(&format!("v {words} 1 1 1")),
            4 => {
                // Homogeneous coordinates.
                let [x, y, z] = [x / w, y / w, z / w];
                if !(x.is_finite() && y.is_finite() && z.is_finite()) {
                    return Err(format!("a w of {w} does not give a place in space"));
                }
                let color = if self.colored { " 1 1 1" } else { "" };
                self.write(&format!("v {x} {y} {z}{color}"));
            }
            6 => self.write(&format!("v {words}")),
            _ => return Err(format!("a vertex has 3, 4 or 6 numbers, not {count}")),
        }
        Ok(())
    }

    fn texture_coordinates(&mut self, words: &str) -> Result<(), String> {
        self.counts[1] += 1;
        let mut values = [0.0; 3];
        match numbers(words, &mut values)? {
            0 => return Err("texture coordinates have 2 numbers, not 0".into()),
            1 => self.write(&format!("vt {} 0", values[0])),
            _ => self.write(&format!("vt {words}")),
        }
        Ok(())
    }

    fn normal(&mut self, words: &str) -> Result<(), String> {
        self.counts[2] += 1;
        let mut values = [0.0; 3];
        match numbers(words, &mut values)? {
            3 => self.write(&format!("vn {words}")),
            count => return Err(format!("a normal has 3 numbers, not {count}")),
        }
        Ok(())
    }

    fn face(&mut self, words: &str) -> Result<(), String> {
        let mut kinds = [0_usize; 4];
        let mut corners = 0;
        for word in words.split_whitespace() {
            kinds[usize::from(corner(word, self.counts)?)] += 1;
            corners += 1;
        }
        if corners < 3 {
            return Err(format!("a face has at least 3 corners, not {corners}"));
        }
        let Some(kind) = kinds.iter().position(|&count| count == corners) else {
            return Err("the corners of a face must all have texture coordinates and normals, or none".into());
        };
        self.begin(kind as u8);
        self.write(&format!("f {words}"));
        Ok(())
    }

    /// Starts a run of faces alike in their attributes, if the last face was different: `tobj` mixes up the
    /// attributes of vertices that do not all have them.
    fn begin(&mut self, kind: u8) {
        if self.run.is_some_and(|(_, last)| last == kind) {
            return;
        }
        let objects = &mut self.done.objects;
        let number = if let Some(&number) = self.numbers.get(&self.object) {
            number
        } else {
            objects.push(self.object.clone());
            self.numbers.insert(self.object.clone(), objects.len() - 1);
            objects.len() - 1
        };
        self.run = Some((number, kind));
        self.write(&format!("o {number}"));
    }

    fn material(&mut self, name: &str, number: usize) {
        let Some(material) = self.done.library.numbers.get(name).copied() else {
            let what = format!("there is no material `{name}`; white stands in for it");
            self.job.warn(
                format!("line {number}"),
                what,
                "check the `mtllib` lines and the names in that file",
            );
            self.write("usemtl none");
            return;
        };
        self.write(&format!("usemtl {material}"));
    }
}

/// Reads numbers into `values`; how many there were.
fn numbers(words: &str, values: &mut [f32]) -> Result<usize, String> {
    let mut words: SplitWhitespace<'_> = words.split_whitespace();
    let mut count = 0;
    for (value, word) in values.iter_mut().zip(words.by_ref()) {
        *value = number(word)?;
        count += 1;
    }
    match words.next() {
        Some(_) => Err(format!("more than {count} numbers")),
        None => Ok(count),
    }
}

/// Checks a corner of a face, `v`, `v/vt`, `v//vn` or `v/vt/vn`; 1 if it has texture coordinates, plus 2 if
/// it has a normal.
fn corner(word: &str, counts: [usize; 3]) -> Result<u8, String> {
    const NAMES: [&str; 3] = ["vertices", "texture coordinates", "normals"];
    let mut kind = 0;
    for (i, part) in word.split('/').enumerate() {
        if i > 2 || (i == 0 && part.is_empty()) {
            return Err(format!("`{word}` is not a corner, such as 1, 1/1, 1//1 or 1/1/1"));
        }
        if part.is_empty() {
            continue;
        }
        let Ok(index) = part.parse::<i64>() else {
            return Err(format!("`{word}` is not a corner: `{part}` is not a whole number"));
        };
        if index == 0 {
            return Err(format!("`{word}` has the index 0; indices count from 1, or from -1 back"));
        }
        if index.unsigned_abs() > counts[i] as u64 {
            return Err(format!("`{word}`: there are only {} {} up to here", counts[i], NAMES[i]));
        }
        kind |= [0, 1, 2][i];
    }
    Ok(kind)
}
