//! The laws and requirements that the program is held to.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[cfg(feature = "video")]
mod movie;
mod import;
mod manifest;
mod output;
