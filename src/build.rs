//! Puts the C++ library (of the H.264 encoder) into the program, so that it runs where none is installed.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=src/build.rs");
    println!("cargo::rerun-if-env-changed=CXX");
    let is = |name: &str, value: &str| std::env::var(name).is_ok_and(|found| found == value);
    let video = std::env::var_os("CARGO_FEATURE_VIDEO").is_some();
    if !video || !is("CARGO_CFG_TARGET_OS", "linux") || !is("CARGO_CFG_TARGET_ENV", "gnu") {
        return;
    }
    // A linker takes the first directory that has the library in either form: one that has the static form alone is put first.
    // Where there is none the program needs the shared one, as without this file.
    if let (Some(library), Some(folder)) = (static_library(), std::env::var_os("OUT_DIR")) {
        let folder = PathBuf::from(folder);
        if std::fs::copy(library, folder.join("libstdc++.a")).is_ok() {
            println!("cargo::rustc-link-search=native={}", folder.display());
        }
    }
}

fn static_library() -> Option<PathBuf> {
    let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".into());
    let output = Command::new(compiler).arg("-print-file-name=libstdc++.a").output().ok()?;
    let path = String::from_utf8(output.stdout).ok()?;
    let path = Path::new(path.trim());
    path.is_absolute().then(|| path.to_owned())
}
