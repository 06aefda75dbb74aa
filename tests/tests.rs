//! The laws and requirements that the program is held to.

#[cfg(feature = "video")]
mod film;
mod import;
mod manifest;
mod output;
