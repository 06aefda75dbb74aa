//! The reference that users read is the one that the program reads by.

use std::path::Path;

#[test]
fn reference_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("manifests/REFERENCE.md");
    let now = terrell::manifest::reference();
    if std::env::var_os("TERRELL_UPDATE").is_some() {
        std::fs::write(&path, &now).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(
        written == now,
        "manifests/REFERENCE.md is stale: TERRELL_UPDATE=1 cargo test --release reference"
    );
}
