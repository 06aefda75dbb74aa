//! What shines: metals, and the reflection of what is no metal.

use super::{ANGLES, Facing, INTENSITY, MATT_RED, schlick};
use crate::support::{close, v};
use glam::DVec3;
use std::f64::consts::PI;

const METAL: DVec3 = DVec3::new(0.9, 0.5, 0.2);

/// `metal_rough.glb`: F D V I cosθ / r².
#[test]
fn rough_metal_shines_by_fresnel_times_distribution_times_shadowing() {
    for (i, roughness) in [0.2, 0.4, 0.6, 0.8, 1.0].into_iter().enumerate() {
        for (lamp, eye) in ANGLES {
            let at = Facing::new(v(2.5 * i as f64 - 5.0, 0.0, 1.0), lamp, eye);
            let expected = schlick(METAL, 1.0, at.cosine()) * at.shine(roughness);
            super::same(at.seen("metal_rough"), expected, 1e-6);
        }
    }
}

/// At the mirror's direction the half vector is the normal: D is 1/πα², of a lamp that is faced V is 1/4.
#[test]
fn highlight_of_a_metal_that_is_faced_has_its_colour_and_the_height_of_the_distribution() {
    let at = Facing::new(v(-2.5, 0.0, 1.0), 0.0, 0.0);
    let alpha = 0.4 * 0.4;
    let height = INTENSITY / (2.0 * 2.0) / (PI * alpha * alpha) / 4.0;
    super::same(at.seen("metal_rough"), METAL * height, 1e-6);
}

/// The left half is a metal of roughness 128/255, the right a dielectric of roughness 204/255; red says nothing.
#[test]
fn metalness_is_in_blue_and_roughness_in_green() {
    for (lamp, eye) in ANGLES {
        let left = Facing::new(v(-0.5, 3.0, 0.0), lamp, eye);
        let metal = schlick(METAL, 1.0, left.cosine()) * left.shine(128.0 / 255.0);
        super::same(left.seen("metal_rough"), metal, 1e-6);
        let right = Facing::new(v(0.5, 3.0, 0.0), lamp, eye);
        let reflected = schlick(DVec3::splat(0.04), 1.0, right.cosine());
        let matt = METAL * (1.0 - reflected.x) * right.white();
        super::same(right.seen("metal_rough"), matt + reflected * right.shine(0.8), 1e-6);
    }
}

#[test]
fn index_says_what_is_reflected_by_who_is_faced() {
    for (i, n) in [1.0, 1.33, 1.5, 2.4_f64].into_iter().enumerate() {
        let facing = ((n - 1.0) / (n + 1.0)).powi(2);
        for (lamp, eye) in ANGLES {
            let at = Facing::new(v(2.5 * i as f64, 0.0, 1.0), lamp, eye);
            let expected = schlick(DVec3::splat(facing), 1.0, at.cosine()) * at.shine(0.5);
            // Of an index of 1 there is nothing but what grazes.
            super::near_rgb(at.seen("ior"), expected, 1e-6 * at.shine(0.5));
        }
    }
}

/// `KHR_materials_specular`: F0 = min(0.04 c, 1) s, F90 = s.
#[test]
fn specular_strength_weakens_and_specular_colour_tints_the_reflection() {
    let color = v(1.0, 0.3, 0.1);
    for (i, (strength, color)) in [(0.5, DVec3::ONE), (1.0, color), (0.5, color)].into_iter().enumerate() {
        for (lamp, eye) in ANGLES {
            let at = Facing::new(v(2.5 * i as f64, 0.0, 1.0), lamp, eye);
            let expected = schlick(color * 0.04 * strength, strength, at.cosine()) * at.shine(0.5);
            super::same(at.seen("specular"), expected, 1e-6);
        }
    }
}

#[test]
fn clearcoat_adds_its_reflection_and_takes_as_much_from_what_is_below() {
    for (lamp, eye) in ANGLES {
        let bare = Facing::new(v(0.0, 0.0, 1.0), lamp, eye);
        super::same(bare.seen("clearcoat"), MATT_RED * bare.white(), 1e-6);
        let coated = Facing::new(v(2.5, 0.0, 1.0), lamp, eye);
        let share = 0.8 * schlick(DVec3::splat(0.04), 1.0, coated.to_eye().z).x;
        let expected = MATT_RED * coated.white() * (1.0 - share) + DVec3::splat(share * coated.shine(0.4));
        super::same(coated.seen("clearcoat"), expected, 1e-6);
        if eye == 0.0 {
            close(share, 0.032, 1e-9);
        }
    }
}
