//! The laws: one module for each, every test a sentence that is true.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test that fails may panic")]

mod support;

mod aberration;
mod boost;
mod doppler;
mod furnace;
mod radiance;
mod velocity;
