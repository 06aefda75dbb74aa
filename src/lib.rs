//! What a camera would really see when things move near the speed of light.
//!
//! The data goes one way: a [`manifest`] names model files, which [`import`] reads; [`scene::compose`] makes of both a
//! [`scene::Scene`], [`plan::Plan`] lists its exposures, and [`render::render`] exposes them ([`exposure`], [`trace`]),
//! develops them ([`film`]) and writes them ([`output`]).
//!
//! Conventions: c = 1, lengths and times in metres, wavelengths in nanometres, angles in radians, light in watts
//! (per steradian, square metre, nanometre) until it becomes XYZ in cd/m². See [`spacetime`] for those of relativity.

pub mod chart;
pub mod cli;
pub mod color;
pub mod course;
pub mod diagnostic;
pub mod error;
pub mod exposure;
pub mod film;
pub mod filmed;
pub mod fresnel;
pub mod import;
pub mod inputs;
pub mod lamp;
pub mod lens;
pub mod manifest;
pub mod mesh;
pub mod observer;
pub mod output;
pub mod plan;
pub mod render;
pub mod scene;
mod simd;
pub mod solid;
pub mod spacetime;
pub mod spectrum;
pub mod starter;
pub mod stereo;
pub mod stop;
pub mod surface;
pub mod surroundings;
pub mod texture;
pub mod trace;
pub mod tree;
pub mod triangles;
pub mod world;
