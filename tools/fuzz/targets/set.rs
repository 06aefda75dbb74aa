//! Any key and value given on the command line, over a manifest that is right.
#![no_main]

use std::path::Path;
use terrell::error::Report;

const BASE: &str = include_str!("../../../manifests/flyby.yaml");

libfuzzer_sys::fuzz_target!(|text: &str| {
    let overrides: Vec<(String, String)> = text
        .lines()
        .filter_map(|line| line.split_once('='))
        .map(|(key, value)| (key.into(), value.replace('\t', "\n")))
        .collect();
    let mut report = Report::default();
    let path = Path::new("fuzz.yaml");
    let read = terrell::manifest::parse_with(path, BASE, &overrides, &mut report);
    assert!(read.is_some() || !report.faults.is_empty());
    terrell_fuzz::worded(&report.faults);
});
