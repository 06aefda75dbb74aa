//! What the targets share: files in memory, and faults that must have words.

use std::path::PathBuf;
use std::sync::Once;
use terrell::error::{Error, Fault};

/// A folder of this process, in memory where there is such a thing.
pub fn folder() -> PathBuf {
    let memory = PathBuf::from("/dev/shm");
    let base = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let folder = base.join(format!("terrell-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the inputs");
    folder
}

/// Two crates that decode models panic on some; the importer fences them and makes faults of it. What is not fenced
/// still ends the run.
pub fn let_fences_stand() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| std::panic::set_hook(Box::new(|_| {})));
}

/// Each fault says something, and can be printed.
pub fn worded(faults: &[Fault]) {
    for fault in faults {
        assert!(!fault.what.is_empty());
        assert!(!format!("{fault}").is_empty());
    }
}

/// The same of an error.
pub fn said(error: &Error) {
    assert!(!format!("{error}").is_empty());
}
