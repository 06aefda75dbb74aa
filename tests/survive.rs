//! Films that are interrupted: nothing is lost, nothing is mixed, and the end is the same.

use crate::support::Dice;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const MANIFEST: &str = include_str!("survive/film.yaml");

/// A folder with the manifest in it.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        place.write(MANIFEST);
        place
    }

    fn write(&self, manifest: &str) {
        std::fs::write(self.0.path().join("film.yaml"), manifest).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join("out").join(name)
    }

    fn start(&self, arguments: &[&str]) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_terrell"));
        command.args(["render", "film.yaml"]).args(arguments).current_dir(self.0.path());
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    /// What it says, and whether it ends well.
    fn render(&self, arguments: &[&str]) -> (bool, String) {
        let output = self.start(arguments).wait_with_output().unwrap();
        (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
    }

    fn done(&self, arguments: &[&str]) -> String {
        let (well, said) = self.render(arguments);
        assert!(well, "{said}");
        said
    }

    fn refused(&self, arguments: &[&str]) -> String {
        let (well, said) = self.render(arguments);
        assert!(!well, "{said}");
        said
    }

    /// All files with their bytes.
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let read = |path: &Path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, std::fs::read(path).unwrap())
        };
        let entries = std::fs::read_dir(self.0.path().join("out")).unwrap();
        let mut files: Vec<_> = entries.map(|entry| read(&entry.unwrap().path())).collect();
        files.sort();
        files
    }
}

fn same(one: &Place, other: &Place) {
    let (one, other) = (one.files(), other.files());
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    assert!(one == other, "the same names, but not the same bytes");
}

#[test]
fn film_that_is_killed_again_and_again_is_the_same_in_the_end() {
    let whole = Place::new();
    let began = Instant::now();
    whole.done(&[]);
    let takes = began.elapsed().as_secs_f64();
    let mut dice = Dice(81);
    let (mut kills, mut goes_on) = (0, 0);
    for _ in 0..3 {
        let place = Place::new();
        loop {
            let mut child = place.start(&[]);
            std::thread::sleep(Duration::from_secs_f64(dice.between(0.0, 0.7 * takes)));
            if child.try_wait().unwrap().is_some_and(|status| status.success()) {
                break;
            }
            child.kill().unwrap();
            child.wait().unwrap();
            kills += 1;
        }
        // Once more: nothing is left to be done, and nothing changes.
        goes_on += usize::from(place.done(&[]).contains("12 of 12 pictures are there already"));
        same(&place, &whole);
    }
    assert!(kills >= 3, "killed only {kills} times");
    assert_eq!(goes_on, 3);
}

#[test]
fn only_what_is_missing_or_broken_is_rendered_again() {
    let (place, whole) = (Place::new(), Place::new());
    whole.done(&[]);
    place.done(&[]);
    let modified = |name: &str| std::fs::metadata(place.path(name)).unwrap().modified().unwrap();
    let before = modified("0003.png");
    std::fs::remove_file(place.path("0007.png")).unwrap();
    // As after a loss of power: the name is there, but not all of the bytes.
    let bytes = std::fs::read(place.path("0005.png")).unwrap();
    std::fs::write(place.path("0005.png"), &bytes[..bytes.len() / 2]).unwrap();
    assert!(place.done(&[]).contains("10 of 12 pictures are there already"));
    assert_eq!(modified("0003.png"), before);
    same(&place, &whole);
}

#[test]
fn single_exposures_become_part_of_the_film() {
    let (place, whole) = (Place::new(), Place::new());
    whole.done(&[]);
    place.done(&["--exposure", "3"]);
    place.done(&["--from", "2", "--to", "5"]);
    assert!(place.done(&[]).contains("4 of 12 pictures are there already"));
    same(&place, &whole);
}

#[test]
fn comments_and_the_order_of_keys_make_no_other_film() {
    let place = Place::new();
    place.done(&["--exposure", "3"]);
    let turned = MANIFEST.replace("from: 4 s, to: 14 s", "to: 14 s, from: 4 s");
    let turned = turned.replace("observer:", "# Who looks.\nobserver:");
    place.write(&turned.replace("rate: 24", "rate: 12"));
    assert!(place.done(&[]).contains("1 of 12 pictures are there already"));
}

#[test]
fn pictures_of_another_film_are_neither_mixed_nor_overwritten() {
    let place = Place::new();
    place.done(&["--exposure", "3"]);
    let before = place.files();
    for (manifest, arguments) in [
        (MANIFEST.replace("0.6 0 0 c", "0.5 0 0 c"), &[][..]),
        (MANIFEST.to_owned(), &["--size", "32x24"]),
        (MANIFEST.to_owned(), &["--exposure", "5", "--samples", "1"]),
        (MANIFEST.to_owned(), &["--set", "exposures.count=4"]),
    ] {
        place.write(&manifest);
        let said = place.refused(arguments);
        assert!(
            said.contains("`0003.png` is a picture of another film: the manifest, or a flag, is another"),
            "{said}"
        );
        assert!(said.contains("--restart"), "{said}");
        assert!(place.files() == before);
    }
}

#[test]
fn files_that_have_changed_make_another_film() {
    let place = Place::new();
    let table =
        |value: &str| std::fs::write(place.0.path().join("wall.csv"), format!("400, 0.2\n700, {value}\n"));
    table("0.3").unwrap();
    place.write(
        &MANIFEST.replace("{ asset: floor }", "{ asset: floor, material: { diffuse: { table: wall.csv } } }"),
    );
    place.done(&["--exposure", "3"]);
    place.done(&["--exposure", "4"]);
    table("0.4").unwrap();
    let said = place.refused(&["--exposure", "5"]);
    assert!(said.contains("a file that it reads has changed"), "{said}");
    table("0.3").unwrap();
    place.done(&["--exposure", "5"]);
}

#[test]
fn files_that_have_changed_places_make_another_film() {
    let place = Place::new();
    let table = |name: &str, value: &str| {
        std::fs::write(place.0.path().join(name), format!("400, 0.2\n700, {value}\n")).unwrap();
    };
    let wall = |file: &str| format!("material: {{ diffuse: {{ table: {file} }} }} }}");
    let floor =
        format!("{{ asset: floor, {}\n  - {{ asset: floor, at: 0 -9 0 m, {}", wall("a.csv"), wall("b.csv"));
    place.write(&MANIFEST.replace("{ asset: floor }", &floor));
    table("a.csv", "0.3");
    table("b.csv", "0.4");
    place.done(&["--exposure", "3"]);
    table("a.csv", "0.4");
    table("b.csv", "0.3");
    assert!(place.refused(&["--exposure", "4"]).contains("a file that it reads has changed"));
}

#[test]
fn a_single_bit_that_turned_anywhere_in_a_picture_is_noticed() {
    let (place, whole) = (Place::new(), Place::new());
    whole.done(&[]);
    place.done(&[]);
    let good = std::fs::read(place.path("0005.png")).unwrap();
    let find = |word: &str| good.windows(word.len()).position(|bytes| bytes == word.as_bytes()).unwrap();
    // In texts, in the picture, in a sum. (One of the header makes it a picture that is not from here.)
    for at in [find("Lorentz factor") + 15, find("Velocity") + 12, find("IDAT") + 20, good.len() - 13] {
        let mut bytes = good.clone();
        bytes[at] ^= 1;
        std::fs::write(place.path("0005.png"), &bytes).unwrap();
        let said = place.done(&[]);
        assert!(said.contains("11 of 12 pictures are there already"), "{at}: {said}");
        same(&place, &whole);
    }
}

#[test]
fn every_file_of_an_exposure_is_read_before_it_is_kept() {
    let (place, whole) = (Place::new(), Place::new());
    for one in [&place, &whole] {
        one.write(include_str!("survive/formats.yaml"));
        one.done(&[]);
    }
    let kept = |count: usize| {
        let said = place.done(&[]);
        assert!(said.contains(&format!("{count} of 4 pictures are there already")), "{said}");
        same(&place, &whole);
    };
    kept(4);
    for (name, _) in whole.files().into_iter().filter(|(name, _)| name.starts_with("0002.")) {
        std::fs::remove_file(place.path(&name)).unwrap();
        kept(3);
        let bytes = std::fs::read(place.path(&name)).unwrap();
        std::fs::write(place.path(&name), &bytes[..bytes.len() - 100]).unwrap();
        kept(3);
        // That of another exposure.
        std::fs::copy(place.path(&name.replace("0002", "0001")), place.path(&name)).unwrap();
        kept(3);
    }
    // Of another kind: with fewer digits, or fewer layers.
    for instead in [
        "png: 8, bmp: on, exr: { depth: half }",
        "png: 16, bmp: on, exr: on",
        "exr: { depth: half, layers: [body] }",
    ] {
        place.write(
            &include_str!("survive/formats.yaml").replace("png: 16, bmp: on, exr: { depth: half }", instead),
        );
        place.done(&["--exposure", "1"]);
        place.write(include_str!("survive/formats.yaml"));
        kept(3);
    }
}

#[test]
fn measured_picture_of_another_film_is_seen_too() {
    let place = Place::new();
    place.done(&["--exposure", "3"]);
    std::fs::remove_file(place.path("0003.png")).unwrap();
    place.write(&MANIFEST.replace("0.6 0 0 c", "0.5 0 0 c"));
    let said = place.refused(&[]);
    assert!(said.contains("`0003.exr` is a picture of another film"), "{said}");
}

#[test]
fn picture_under_another_number_is_rendered_again() {
    let (place, whole) = (Place::new(), Place::new());
    whole.done(&[]);
    place.done(&[]);
    std::fs::copy(place.path("0001.png"), place.path("0002.png")).unwrap();
    std::fs::write(place.path("0004.png"), "").unwrap();
    assert!(place.done(&[]).contains("10 of 12 pictures are there already"));
    same(&place, &whole);
}

#[cfg(unix)]
#[test]
fn lock_that_is_a_link_is_refused_and_what_it_names_is_left() {
    let place = Place::new();
    std::fs::create_dir(place.0.path().join("out")).unwrap();
    std::os::unix::fs::symlink(place.0.path().join("film.yaml"), place.path(".terrell.lock")).unwrap();
    assert!(place.refused(&[]).contains("`.terrell.lock` is there, and is no file"));
    assert_eq!(std::fs::read_to_string(place.0.path().join("film.yaml")).unwrap(), MANIFEST);
}

#[test]
fn beginning_anew_leaves_nothing_of_the_film_before() {
    let (place, whole) = (Place::new(), Place::new());
    place.done(&["--set", "exposures.count=14"]);
    place.done(&["--restart"]);
    whole.done(&[]);
    same(&place, &whole);
}

#[test]
fn pictures_that_are_not_from_here_are_not_overwritten() {
    let place = Place::new();
    std::fs::create_dir(place.0.path().join("out")).unwrap();
    image::RgbImage::new(4, 4).save(place.path("0002.png")).unwrap();
    let said = place.refused(&[]);
    assert!(said.contains("`0002.png` is there, and is not from here"), "{said}");
    // Not even anew; but pictures that are from here give way.
    let said = place.refused(&["--restart"]);
    assert!(said.contains("`0002.png` is there, and is not from here"), "{said}");
    assert_eq!(image::image_dimensions(place.path("0002.png")).unwrap(), (4, 4));
    // What is no picture of the film is nobody's business.
    std::fs::rename(place.path("0002.png"), place.path("0099.png")).unwrap();
    place.done(&["--exposure", "2"]);
}

#[test]
fn two_at_once_render_each_picture_once() {
    let (place, whole) = (Place::new(), Place::new());
    whole.done(&[]);
    let children = [place.start(&[]), place.start(&[]), place.start(&[])];
    let said: Vec<String> = children
        .into_iter()
        .map(|child| {
            let output = child.wait_with_output().unwrap();
            assert!(output.status.success());
            String::from_utf8_lossy(&output.stderr).into_owned()
        })
        .collect();
    let waited = said.iter().filter(|said| said.contains("waiting until it is done")).count();
    let kept = said.iter().filter(|said| said.contains("12 of 12 pictures are there already")).count();
    assert_eq!((waited, kept), (2, 2), "{said:?}");
    same(&place, &whole);
}
