//! Normals, and what shines of itself.

use super::{lambert, lit, rgb, same};
use crate::support::{near_vector, v};
use glam::DVec3;

/// The normal that a texel says, its axes being the tangent, the bitangent and the normal.
fn texel(r: f64, g: f64, b: f64) -> DVec3 {
    (v(r, g, b) * (2.0 / 255.0) - DVec3::ONE).normalize()
}

/// Each texel's place in the model, and what it says: to the right of the picture, and up.
fn texels() -> [(f64, DVec3); 2] {
    [(-0.5, texel(204.0, 128.0, 230.0)), (0.5, texel(128.0, 204.0, 230.0))]
}

/// The luminance is that of Lambert's cosine with the texel's normal.
fn lean(model: &str, lab: impl Fn(DVec3) -> DVec3) {
    let lamps = [v(3.0, 0.5, 2.0), v(-2.0, 3.0, 2.5), v(0.3, -2.0, 2.0)];
    for lamp in lamps {
        let scene = lit(model, &[lamp]);
        for (x, said) in texels() {
            for (centre, mirror) in [(-1.5, v(1.0, 1.0, 1.0)), (1.5, v(-1.0, 1.0, 1.0))] {
                let place = v(centre, 0.3, 0.0) + v(x, 0.0, 0.0) * mirror;
                let expected = DVec3::splat(0.8 * lambert(place, lab(said) * mirror, lamp));
                same(rgb(&scene, place + v(0.3, -0.4, 3.0), place), expected, 1e-5);
            }
        }
    }
}

/// `normal_map.glb`, from its texture coordinates; the mirrored square is the mirror image.
#[test]
fn normal_map_leans_normals_along_the_picture() {
    lean("normal_map", |said| said);
}

/// `normal_map_tangents.glb`: its tangents lie along y, so that what is the picture's right is up, its up to the left.
#[test]
fn normal_map_leans_normals_along_the_tangents_of_the_file() {
    lean("normal_map_tangents", |said| v(-said.y, said.x, said.z));
}

/// cd/m²: factor times strength times texel (sRGB).
#[test]
fn emissive_strength_multiplies_factor_and_texture() {
    let scene = lit("emissive_strength", &[]);
    let eye = v(0.2, 0.3, 4.0);
    let factor = v(1.0, 0.5, 0.25) * 40.0;
    same(rgb(&scene, eye, v(-0.5, 0.0, 0.0)), factor, 1e-6);
    let decoded = |stored: f64| libm::pow((stored / 255.0 + 0.055) / 1.055, 2.4);
    let right = factor * v(decoded(188.0), decoded(99.0), 0.0);
    same(rgb(&scene, eye, v(0.5, 0.0, 0.0)), right, 1e-6);
}

#[test]
fn unlit_shows_its_colour_whatever_the_lamps_do() {
    let expected = v(0.5, 0.25, 1.0) * terrell::scene::UNLIT_LUMINANCE;
    for lamps in [vec![], vec![v(0.0, 0.0, 0.1)], vec![v(1.0, 2.0, 3.0), v(0.0, 0.0, -2.0)]] {
        let scene = lit("unlit", &lamps);
        for place in [v(0.0, 0.0, 0.0), v(0.9, -0.8, 0.0)] {
            near_vector(rgb(&scene, v(0.5, 0.0, 2.0), place), expected, 1e-4);
        }
    }
}
