//! The laws and requirements that the program is held to, a module for each.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod aberration;
mod boost;
mod cli;
mod clockwork;
mod course;
mod delay;
mod doppler;
mod edges;
mod effects;
mod equivalence;
mod fill;
mod film;
mod fizeau;
mod fresnel;
mod furnace;
mod glass;
mod import;
mod index;
mod khronos;
mod lamp;
mod light_equivalence;
mod lines;
mod lines_in_glass;
mod lost_in_glass;
mod manifest;
mod mirror;
#[cfg(feature = "video")]
mod movie;
mod output;
mod radiance;
mod shadow;
mod sky;
mod solid;
mod solids;
mod spectrum;
mod support;
mod surroundings;
mod terrell;
mod texture;
mod tint;
mod tree;
mod velocity;
mod world;
mod worldline;
mod written;
