//! Pictures while they come about, work that is stopped, and work that is done again when something is saved.

use crate::support::manifested;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::time::{Duration, Instant};
use terrell::exposure::{Grain, Sampling, expose, expose_coarse_to_fine};
use terrell::film::Negative;
use terrell::stop::Stop;

const MANIFEST: &str = include_str!("survive/film.yaml");

/// All that is shown of the film's seventh picture.
fn looks(size: (u32, u32), samples: u32) -> (Vec<(Grain, Negative)>, Negative, Negative) {
    let (_, scene, plan) = manifested(MANIFEST);
    let sampling = Sampling { width: size.0, height: size.1, samples, ..plan.sampling };
    let view = scene.observer.view(plan.exposures[6].tau, size.0, size.1);
    let mut looks = Vec::new();
    let show = |picture: &Negative, grain| looks.push((grain, picture.clone()));
    let finished = expose_coarse_to_fine(&scene.lit(), &view, &sampling, &Stop::never(), show).unwrap();
    let at_once = expose(&scene, &view, &sampling);
    (looks, finished, at_once)
}

#[test]
fn picture_that_came_about_from_coarse_to_fine_is_the_one_exposed_at_once() {
    for (size, samples) in [((64, 48), 1), ((37, 23), 1), ((37, 23), 4), ((5, 3), 2), ((1, 1), 1)] {
        let (looks, finished, at_once) = looks(size, samples);
        assert!(finished == at_once, "{size:?}, {samples} samples");
        let last = looks.last().unwrap();
        assert!(last.0 == Grain::Done && last.1 == at_once);
        assert!(at_once.xyz.iter().any(|xyz| xyz[1] > 0.0));
    }
}

#[test]
fn every_pass_knows_the_corners_of_its_squares_and_fills_the_squares_with_them() {
    let (looks, _, at_once) = looks((37, 23), 1);
    let sides: Vec<usize> = looks
        .iter()
        .map(|(grain, _)| match grain {
            Grain::Squares(side) => *side as usize,
            Grain::Done => 1,
            Grain::Rows(_) => panic!("one sample each leaves no rows to be done"),
        })
        .collect();
    assert_eq!(sides, [16, 8, 4, 2, 1]);
    for (side, (_, picture)) in sides.iter().zip(&looks) {
        for (number, xyz) in picture.xyz.iter().enumerate() {
            let (column, row) = (number % 37 / side * side, number / 37 / side * side);
            assert_eq!(*xyz, at_once.xyz[row * 37 + column], "side {side}, pixel {number}");
        }
    }
}

#[test]
fn exposure_that_is_stopped_is_no_picture() {
    let (_, scene, plan) = manifested(MANIFEST);
    let view = scene.observer.view(plan.exposures[6].tau, 64, 48);
    for after in 0..3 {
        let flag = Arc::new(AtomicBool::new(false));
        let mut passes = 0;
        let show = |_: &Negative, _| {
            passes += 1;
            flag.store(passes > after, SeqCst);
        };
        let stop = Stop::never().or(flag.clone());
        assert!(expose_coarse_to_fine(&scene.lit(), &view, &plan.sampling, &stop, show).is_none());
        assert_eq!(passes, after + 1);
    }
}

/// A folder with the manifest in it.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        place.write("film.yaml", MANIFEST);
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_terrell"));
        command.args(["render", "film.yaml"]).args(arguments).current_dir(self.0.path());
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).env_remove("DISPLAY");
        command
    }

    fn render(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let output = self.command(arguments).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    }

    /// Names and bytes of all files in a folder.
    fn files(&self, folder: &str) -> Vec<(String, Vec<u8>)> {
        let read = |path: &Path| {
            (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap())
        };
        let entries = std::fs::read_dir(self.path(folder)).unwrap();
        let mut files: Vec<_> = entries.map(|entry| read(&entry.unwrap().path())).collect();
        files.sort();
        files
    }
}

/// A process whose words are heard.
struct Heard {
    child: Child,
    said: std::sync::mpsc::Receiver<String>,
    all: String,
}

impl Heard {
    fn start(mut command: Command) -> Self {
        let mut child = command.spawn().unwrap();
        let (tell, said) = std::sync::mpsc::channel();
        let from = BufReader::new(child.stderr.take().unwrap());
        std::thread::spawn(move || from.lines().map_while(Result::ok).try_for_each(|line| tell.send(line)));
        Self { child, said, all: String::new() }
    }

    /// Waits until it says something with these words in it.
    fn until(&mut self, words: &str) {
        let began = Instant::now();
        loop {
            if let Ok(line) = self.said.recv_timeout(Duration::from_secs(1)) {
                self.all += &(line.clone() + "\n");
                if line.contains(words) {
                    return;
                }
            }
            assert!(began.elapsed() < Duration::from_mins(2), "no `{words}` in\n{}", self.all);
        }
    }

    fn send(&self, signal: &str) {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().unwrap().success());
    }

    fn end(mut self) -> (ExitStatus, String) {
        let began = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(began.elapsed() < Duration::from_mins(2), "it does not end\n{}", self.all);
            std::thread::sleep(Duration::from_millis(5));
        };
        let mut all = std::mem::take(&mut self.all);
        all.extend(self.said.iter().map(|line| line + "\n"));
        (status, all)
    }
}

impl Drop for Heard {
    fn drop(&mut self) {
        // Where a test has failed it may go on for ever.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn wait_for(path: &Path) {
    let began = Instant::now();
    while !path.exists() {
        assert!(began.elapsed() < Duration::from_mins(1), "{}", path.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// How many files are of a kind.
fn count(names: &[String], kind: &str) -> usize {
    names.iter().filter(|name| Path::new(name).extension().is_some_and(|extension| extension == kind)).count()
}

/// Large enough that there is time for a signal.
const SLOW: [&str; 4] = ["--size", "96x72", "--samples", "4"];

#[cfg(unix)]
#[test]
fn signal_leaves_what_is_finished_and_nothing_else_and_the_same_command_goes_on() {
    let (place, whole) = (Place::new(), Place::new());
    assert_eq!(whole.render(&SLOW).0, Some(0));
    for (signal, first) in [("-INT", "0000.png"), ("-TERM", "0003.png")] {
        let mut command = place.command(&SLOW);
        command.args(["--threads", "2"]);
        let heard = Heard::start(command);
        wait_for(&place.path("out").join(first));
        heard.send(signal);
        let (status, said) = heard.end();
        assert_eq!(status.code(), Some(130), "{said}");
        let names: Vec<String> = place.files("out").into_iter().map(|(name, _)| name).collect();
        let pictures = count(&names, "png");
        assert!((1..12).contains(&pictures), "{names:?}");
        assert!(
            said.contains(&format!(
                "stopped: {pictures} of 12 pictures are in out; the same command goes on"
            )),
            "{said}"
        );
        assert!(names.iter().all(|name| !name.starts_with('.')) && count(&names, "mp4") == 0, "{names:?}");
    }
    assert_eq!(place.render(&SLOW).0, Some(0));
    assert!(place.files("out") == whole.files("out"));
}

#[cfg(unix)]
#[test]
fn second_signal_ends_it_at_once() {
    let place = Place::new();
    let mut command = place.command(&["--size", "3000x2000", "--samples", "1024", "--no-video"]);
    command.args(["--threads", "1"]);
    let heard = Heard::start(command);
    wait_for(&place.path("out/.terrell.lock"));
    heard.send("-INT");
    heard.send("-TERM");
    let began = Instant::now();
    let (status, said) = heard.end();
    assert_eq!(status.code(), Some(130), "{said}");
    assert!(began.elapsed() < Duration::from_secs(20));
}

#[cfg(target_os = "linux")]
#[test]
fn signal_that_a_script_ignores_for_it_is_ignored() {
    let place = Place::new();
    let mut command = Command::new("sh");
    command.args(["-c", "trap '' INT; exec \"$0\" render film.yaml"]).arg(env!("CARGO_BIN_EXE_terrell"));
    command.current_dir(place.0.path()).stderr(Stdio::piped());
    let heard = Heard::start(command);
    wait_for(&place.path("out/0000.png"));
    heard.send("-INT");
    let (status, said) = heard.end();
    assert_eq!(status.code(), Some(0), "{said}");
}

#[test]
fn preview_without_window_and_terminal_says_so_and_writes_nothing() {
    let place = Place::new();
    for (arguments, words) in [
        (&["--preview"][..], "a preview cannot be shown: "),
        (&["--preview=terminal"], "a preview cannot be shown: the output is no terminal"),
        // What to type shows the same exposure.
        (&["--preview=terminal", "--exposure", "3"], "--exposure 3 --scale 0.25 --out FOLDER"),
        (&["--preview=terminal", "--from", "4", "--to", "8"], "--exposure 6 --scale 0.25 --out FOLDER"),
    ] {
        let (code, said) = place.render(arguments);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(words), "{said}");
        assert!(!place.path("out").exists());
    }
}

/// A film that reads a table.
fn with_table(value: &str) -> String {
    MANIFEST.replace(
        "{ asset: floor }",
        &format!("{{ asset: floor, material: {{ diffuse: {{ table: {value} }} }} }}"),
    )
}

#[cfg(unix)]
#[test]
fn whatever_is_saved_is_rendered_again_and_is_the_same_as_a_fresh_one() {
    let place = Place::new();
    let table = |value: &str| place.write("wall.csv", &format!("400, 0.2\n700, {value}\n"));
    table("0.3");
    place.write("film.yaml", &with_table("wall.csv"));
    let one = ["--exposure", "5"];
    let mut heard = Heard::start({
        let mut command = place.command(&one);
        command.arg("--watch");
        command
    });
    let fresh = || {
        let (code, said) = place.render(&[&one[..], &["--out", "fresh", "--restart"]].concat());
        assert_eq!(code, Some(0), "{said}");
        assert!(place.files("fresh") == place.files("out"));
        place.files("out")
    };
    heard.until("waiting until film.yaml");
    let first = fresh();
    // A file that the manifest reads.
    table("0.9");
    heard.until("waiting until film.yaml");
    let second = fresh();
    assert!(first != second);
    // A fault is said, and the picture stays.
    place.write("film.yaml", "bodies: [");
    heard.until("error");
    // And it is said that it goes on.
    heard.until("waiting until film.yaml");
    assert!(place.files("out") == second);
    // As editors do it.
    place.write("film.yaml.new", &with_table("wall.csv").replace("400 cd", "100 cd"));
    std::fs::rename(place.path("film.yaml.new"), place.path("film.yaml")).unwrap();
    heard.until("waiting until film.yaml");
    assert!(fresh() != second);
    // Gone, and there again.
    std::fs::remove_file(place.path("wall.csv")).unwrap();
    heard.until("there is no such file");
    heard.until("waiting until film.yaml");
    table("0.3");
    heard.until("waiting until film.yaml");
    fresh();
    // What comes only after it was named.
    place.write("film.yaml", &with_table("other.csv"));
    heard.until("there is no such file");
    heard.until("waiting until film.yaml");
    place.write("other.csv", "400, 0.5\n700, 0.1\n");
    heard.until("waiting until film.yaml");
    fresh();
    // What it is made of.
    place.write("base.yaml", MANIFEST);
    place.write("film.yaml", "extends: base.yaml\n");
    heard.until("waiting until film.yaml");
    let before = fresh();
    place.write("base.yaml", &MANIFEST.replace("400 cd", "50 cd"));
    heard.until("waiting until film.yaml");
    assert!(fresh() != before);
    heard.send("-INT");
    let (status, said) = heard.end();
    assert_eq!(status.code(), Some(130), "{said}");
}

#[cfg(unix)]
#[test]
fn save_while_it_renders_begins_anew() {
    let place = Place::new();
    let mut heard = Heard::start(place.command(&[&SLOW[..], &["--watch"]].concat()));
    wait_for(&place.path("out/0001.png"));
    place.write("film.yaml", &MANIFEST.replace("count: 12", "count: 3"));
    heard.until("waiting until film.yaml");
    let names: Vec<String> = place.files("out").into_iter().map(|(name, _)| name).collect();
    assert_eq!(count(&names, "png"), 3);
    heard.send("-TERM");
    assert_eq!(heard.end().0.code(), Some(130));
}
