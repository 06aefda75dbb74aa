//! Any bytes as a manifest: read or refused with words, never a panic.
#![no_main]

use std::path::Path;
use terrell::error::Report;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let mut report = Report::default();
    let read = terrell::manifest::parse(Path::new("fuzz.yaml"), text, &mut report);
    assert!(read.is_some() || !report.faults.is_empty());
    terrell_fuzz::worded(&report.faults);
    terrell_fuzz::worded(&report.warnings);
});
