//! What a camera would really see when things move near the speed of light.
pub mod error;
pub mod import;
pub mod mesh;
pub mod output;
pub mod spacetime;
pub mod texture;
