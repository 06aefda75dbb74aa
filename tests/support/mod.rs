//! What the laws are tried on: small meshes, a stage to put them on, an eye to look with, and dice.

pub(crate) mod boosted;
mod ciede2000;
pub(crate) mod exact;
mod heaven;
mod looking;
mod meshes;
pub(crate) mod needless;
mod numbers;
mod stage;
mod surfaces;
mod written;

pub(crate) use ciede2000::{ciede2000, lab};
pub(crate) use heaven::Heaven;
pub(crate) use looking::{
    along, first, frequency, is_bright, light_at_rest, light_from, light_to, look, picture, pixel_centre,
};
pub(crate) use looking::{difference, exposed, manifested, relative_difference};
pub(crate) use meshes::{built, coloured, cube, icosphere, soup, square};
pub(crate) use numbers::{
    Dice, angle, beta, close, edge, emission_time, near, near_vector, speed, v, vectors, velocities,
};
pub(crate) use stage::{Body, Eye, Lantern, Stage};
pub(crate) use surfaces::{
    ball, black, black_body, blinking, cuboid, diffuse, flat, glass, glowing, line, mirror, mixed, pane,
    plane,
};
pub(crate) use written::is_current;
