//! What manifests mean, and what is said about those that mean nothing.

use std::path::{Path, PathBuf};
use terrell::error::Report;
use terrell::manifest;

/// The manifests of a folder, in order.
fn manifests(folder: &str) -> Vec<PathBuf> {
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = paths.filter(|path| path.extension().is_some_and(|x| x == "yaml")).collect();
    paths.sort();
    assert!(!paths.is_empty());
    paths
}

/// Each manifest that must fail has the whole of what is said about it beside it.
/// `TERRELL_UPDATE=1` writes what is said now; read the difference before keeping it.
#[test]
fn bad_manifests_are_refused_with_place_fault_and_hint() {
    let mut wrong = Vec::new();
    for path in manifests("tests/manifests/bad") {
        let mut report = Report::default();
        assert!(manifest::load(&path, &mut report).is_none(), "{} was accepted", path.display());
        assert!(!report.faults.is_empty(), "{}: no fault", path.display());
        let lines: Vec<_> = report.faults.iter().map(|fault| format!("{fault}\n")).collect();
        let said = lines.concat().replace("tests/manifests/bad/", "");
        let expected = path.with_extension("expected");
        if std::env::var_os("TERRELL_UPDATE").is_some() {
            std::fs::write(&expected, &said).unwrap();
        }
        if std::fs::read_to_string(&expected).ok().as_ref() != Some(&said) {
            wrong.push(format!("{}:\n{said}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "not as expected:\n{}", wrong.join("\n"));
}
