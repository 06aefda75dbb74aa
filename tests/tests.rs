//! The laws: one module for each, every test a sentence that is true.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test that fails may panic")]

mod support;

mod aberration;
mod boost;
mod delay;
mod doppler;
mod effects;
mod equivalence;
mod film;
mod furnace;
mod lamp;
mod mirror;
mod radiance;
mod shadow;
mod spectrum;
mod terrell;
mod tint;
mod tree;
mod velocity;
mod world;
mod worldline;
