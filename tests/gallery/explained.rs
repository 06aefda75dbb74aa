//! The pages that explain the effects: their commands are understood, and what they show is there.

use super::{folder, meaning};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::path::Path;
use terrell::error::Report;
use terrell::manifest;
use terrell::plan::Plan;
use terrell::scene::compose;

/// The words of a command as a shell has them; quotes stand alone.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut quoted) = (vec![String::new()], false);
    for c in command.chars() {
        match c {
            '"' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().unwrap().push(c),
        }
    }
    words
}

/// The manifest of a command is read with what it sets, and gives a picture without fault or warning.
fn understood(page: &Path, command: &str) {
    let words = words(command.trim());
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join(&words[2]);
    let options = words[3..].chunks(2).map(|pair| (pair[0].as_str(), pair[1].as_str()));
    let set = |(option, value): (&str, &str)| match option {
        "--set" => value.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned())),
        "--size" | "--out" => None,
        other => panic!("{}: {other}", page.display()),
    };
    let overrides: Vec<_> = options.filter_map(set).collect();
    let mut report = Report::default();
    let manifest = manifest::load_with(&path, &overrides, &mut report);
    let scene = manifest.as_ref().and_then(|manifest| compose(manifest, &path, &mut report));
    if let Some((manifest, scene)) = manifest.as_ref().zip(scene.as_ref()) {
        let plan = Plan::of(manifest, scene, &path, &mut report);
        meaning::check(manifest, scene, &plan, &mut report);
        assert_eq!(plan.exposures.len(), 1, "{}: {command}", page.display());
    }
    assert!(
        report.faults.is_empty() && report.warnings.is_empty(),
        "{}: {command} {report:?}",
        page.display()
    );
}

#[test]
fn commands_and_links_of_the_explanations_lead_somewhere() {
    let listed = std::fs::read_to_string(folder().join("README.md")).unwrap();
    let pages: Vec<_> =
        folder().join("explained").read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(pages.len() >= 9);
    let mut commands = Vec::new();
    for page in &pages {
        let name = page.file_name().unwrap().to_string_lossy();
        assert!(listed.contains(&format!("(explained/{name})")), "README.md says nothing of {name}");
        let text = std::fs::read_to_string(page).unwrap();
        for (_, rest) in text.match_indices("](").map(|(at, _)| text.split_at(at + 2)) {
            let link = rest.split_once(')').unwrap().0;
            assert!(folder().join("explained").join(link).is_file(), "{name}: {link}");
        }
        let before = commands.len();
        let lines = text.lines().filter(|line| line.starts_with("    terrell render "));
        commands.extend(lines.map(|line| (page, line.to_owned())));
        assert!(commands.len() >= before + 2, "{name}");
    }
    commands.par_iter().for_each(|(page, command)| understood(page, command));
}
