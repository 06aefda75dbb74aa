//! What manifests mean, and what is said about those that mean nothing.

mod extends;
mod faults;
mod hints;
mod hostile;
mod language;
mod overrides;
mod reference;
mod schema;
mod shorthand;
mod units;
mod values;

use std::path::Path;
use terrell::error::Report;
use terrell::manifest::{self, Manifest};

/// What a text says, which has no faults.
fn read(text: &str) -> Manifest {
    read_with(text, &[])
}

fn read_with(text: &str, overrides: &[(&str, &str)]) -> Manifest {
    let mut report = Report::default();
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect();
    let path = Path::new("folder/m.yaml");
    let manifest = manifest::parse_with(path, text, &overrides, &mut report);
    assert_eq!(report.faults, [], "of {text}");
    manifest.unwrap()
}

/// What a text says that has a standing observer and an output too.
fn complete(text: &str) -> Manifest {
    read(&format!("{text}\nobserver: {{}}\noutput: out\n"))
}

/// The faults of a text.
fn faults(text: &str) -> Report {
    let mut report = Report::default();
    let manifest = manifest::parse(Path::new("m.yaml"), text, &mut report);
    assert_eq!(manifest.is_none(), !report.faults.is_empty(), "nothing exactly if there are faults: {text}");
    report
}

/// The observer of a manifest that says nothing else.
fn observer(text: &str) -> manifest::Observer {
    read(&format!("observer: {text}\noutput: out\n")).observer
}

/// Equal but for rounding.
fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-14 * expected.abs().max(1e-300)
}
