//! What a camera would really see when things move near the speed of light.
pub mod color;
pub mod error;
pub mod exposure;
pub mod film;
pub mod import;
pub mod lamp;
pub mod mesh;
pub mod observer;
pub mod scene;
pub mod spacetime;
pub mod spectrum;
pub mod surface;
pub mod texture;
pub mod trace;
pub mod tree;
pub mod triangles;
pub mod world;
