//! Files that the program writes of itself, and that are committed.

use std::path::Path;

/// A committed file is what the program writes now. `TERRELL_UPDATE=1` with the tests called `filter` writes it.
pub(crate) fn is_current(name: &str, now: &str, filter: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    if std::env::var_os("TERRELL_UPDATE").is_some() {
        std::fs::write(&path, now).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(written == now, "{name} is stale: TERRELL_UPDATE=1 cargo test --release {filter}");
}
