//! Rough surfaces: the highlight of a lamp.

use glam::DVec3;
use std::f64::consts::PI;

/// Below this α a highlight is as small as the lamp, which is a point: the mirror shows it no more.
const SMALLEST_ALPHA: f64 = 1e-3;

/// `D G / (4 n·l n·v)` of the GGX distribution with Smith's separable shadowing, and the cosine between the half vector and
/// the sight; none for a smooth surface or from behind.
///
/// All vectors have unit length and point away from the surface; `alpha` is the roughness squared.
/// Source: Walter et al., EGSR 2007; glTF 2.0, appendix B.3.
pub fn highlight(alpha: f64, normal: DVec3, to_light: DVec3, to_eye: DVec3) -> Option<(f64, f64)> {
    let (light, eye) = (normal.dot(to_light), normal.dot(to_eye));
    if alpha < SMALLEST_ALPHA || light <= 0.0 || eye <= 0.0 {
        return None;
    }
    let half = (to_light + to_eye).try_normalize()?;
    let cos = normal.dot(half).min(1.0);
    let squared = alpha * alpha;
    // cos²α² + sin², the sine from the cross product: near the peak the cosine has lost it.
    let sine = normal.cross(half).length_squared();
    let spread = cos * cos * squared + sine;
    let distribution = squared / (PI * spread * spread);
    let shadowing = |cos: f64| 1.0 / (cos + (squared + (1.0 - squared) * cos * cos).sqrt());
    Some((distribution * shadowing(light) * shadowing(eye), half.dot(to_eye).clamp(0.0, 1.0)))
}

/// What part of a reflection is traced as one mirror ray: all up to roughness 0.1, none from 0.5 on.
///
/// A rough surface's reflection is a blur that one ray cannot show; rather than sampled it fades.
pub fn fade(roughness: f64) -> f64 {
    let x = ((0.5 - roughness) / 0.4).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
