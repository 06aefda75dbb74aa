//! What lets light through.

use super::{fresnel, rgb, same, sight, stage};
use crate::support::{close, look, near, v};
use glam::{DVec2, DVec3};
use terrell::scene::UNLIT_LUMINANCE;
use terrell::spectrum::{Reflectance, Wavelengths};

/// `transmission.glb`: (1 - F) times the colour, straight on.
#[test]
fn thin_pane_lets_through_straight_on_what_it_does_not_reflect() {
    let scene = stage("transmission", "", &[], "");
    let (eye, tint) = (v(0.9, 0.3, 3.0), v(0.4, 0.9, 0.6));
    // Sights through the pane's x = 0.36 meet the border of white and grey on the wall.
    for (x, wall) in [(-0.9, 1.0), (0.36 - 1e-6, 1.0), (0.36 + 1e-6, 0.2), (0.9, 0.2)] {
        for y in [-0.9, 0.1, 0.8] {
            let place = v(x, y, 0.0);
            let cosine = (eye - place).normalize().z;
            let through = (1.0 - fresnel(cosine, 1.5)) * wall * UNLIT_LUMINANCE;
            same(rgb(&scene, eye, place), tint * through, 1e-6);
        }
    }
}

/// Reflections within the ball are followed, however faint.
const ALL: &str = "picture: { depth: 40, faintest: 0.000001 }";

/// `volume.glb`: what is left of light after its real way through the ball, which is not the file's `thicknessFactor`.
#[test]
fn volume_absorbs_along_the_chord_of_the_ball() {
    let scene = stage("volume", "", &[], ALL);
    let wall = look(&scene, &sight(v(4.0, 0.0, 5.0), v(4.0, 0.0, -3.0))).radiance;
    let color = Reflectance::Rgb([0.9, 0.5, 0.2]);
    let left = |nm: f64, chord: f64| libm::pow(color.at(nm), chord / 1.5);
    let nm = Wavelengths::<64>::new().nm;

    // Through the middle, from corner to corner, and to and fro within.
    let seen = look(&scene, &sight(v(0.0, 0.0, 5.0), DVec3::ZERO)).radiance;
    for (i, nm) in nm.iter().enumerate() {
        let (r, a) = (0.04, left(*nm, 2.0));
        // What goes back and forth once more is fainter by r²a².
        let expected = (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
        close(seen[i] / wall[i], expected, 1e-5);
    }

    // Off the middle: sinθ = b outside, b/n inside. Facets lie some thousandths below the ball.
    for b in [0.3, 0.5, 0.7_f64] {
        let seen = look(&scene, &sight(v(b, 0.0, 5.0), v(b, 0.0, 0.0))).radiance;
        let chord = 2.0 * (1.0 - b * b / 2.25).sqrt();
        let r = fresnel((1.0 - b * b).sqrt(), 1.5);
        for (i, nm) in nm.iter().enumerate() {
            close(seen[i] / wall[i], (1.0 - r) * (1.0 - r) * left(*nm, chord), 8e-3);
        }
    }
}

/// Snell's law in a plane; `n`: index before over index beyond.
fn refracted(along: DVec2, normal: DVec2, n: f64) -> DVec2 {
    let cosine = -along.dot(normal);
    let beyond = (1.0 - n * n * (1.0 - cosine * cosine)).sqrt();
    along * n + normal * (n * cosine - beyond)
}

/// Where a sight along `along` that enters the prism's left side at `entry` meets the screen at x = 10.
fn on_screen(entry: DVec2, along: DVec2, n: f64) -> f64 {
    let (sin, cos) = libm::sincos(30.0_f64.to_radians());
    let (left, right) = (DVec2::new(-cos, sin), DVec2::new(cos, sin));
    let inside = refracted(along, left, 1.0 / n);
    // The right side goes through the prism's edge.
    let edge = DVec2::new(0.0, 0.5 * 3.0_f64.sqrt());
    let exit = entry + inside * ((edge - entry).dot(right) / inside.dot(right));
    let out = refracted(inside, -right, n);
    exit.y + out.y / out.x * (10.0 - exit.x)
}

/// `dispersion.glb`: `n(λ) = n_d + (n_d - 1)/V (523655 nm²/λ² - 1.5168)`, V = 20/2.
#[test]
fn dispersion_bends_each_wavelength_by_its_own_index() {
    // What is reflected is not followed: its part goes where the rest goes, with or without a pattern on the screen.
    let direct = "picture: { faintest: 0.1 }";
    let pattern = stage("dispersion", "", &[], direct);
    let plain = ", materials: { Screen: { emission: { luminance: 100 cd/m2 } } }";
    let plain = stage("dispersion", plain, &[], direct);
    let entry = DVec2::new(-0.5, 0.0);
    for slope in [0.25, 0.4, 0.55] {
        let along = DVec2::new(1.0, slope).normalize();
        let eye = entry - along * 3.0;
        let ray = sight(eye.extend(0.2), entry.extend(0.2));
        let (pattern, plain) = (look(&pattern, &ray).radiance, look(&plain, &ray).radiance);
        let mut places = Vec::new();
        for (i, nm) in Wavelengths::<64>::new().nm.iter().enumerate() {
            let n = 1.5168 + 0.05168 * (523_655.0 / (nm * nm) - 1.5168);
            // The screen goes from 1 at y = -10 to 0 at y = 10.
            let y = 10.0 - 20.0 * pattern[i] / plain[i];
            near(y, on_screen(entry, along, n), 1e-4);
            places.push(y);
        }
        // Blue lies lower: it is bent more.
        assert!(places[60] - places[3] > 1.0, "{places:?}");
    }
}
