//! The laws and requirements that the program is held to, a module for each.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod import;
mod manifest;
#[cfg(feature = "video")]
mod movie;
mod output;
