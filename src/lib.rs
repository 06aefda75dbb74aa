//! What a camera would really see when things move near the speed of light.
pub mod diagnostic;
pub mod error;
pub mod import;
pub mod manifest;
pub mod mesh;
pub mod spacetime;
pub mod texture;
