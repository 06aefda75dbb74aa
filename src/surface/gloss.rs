//! Surfaces with a gloss, and bare metals.

use super::microfacet::highlight;
use super::paint::{Paint, Tint};
use super::veil::NormalMap;
use super::{Glass, Look, Scatter, Surface};
use crate::spectrum::Metal;
use crate::texture::Texture;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A bare material with a roughness.
#[derive(Debug, Clone)]
pub struct Polish<M> {
    /// The material.
    pub of: M,
    /// The square root of GGX's α, 0 to 1.
    pub roughness: f64,
}

/// glTF's metallic-roughness surface, with `KHR_materials_ior`, `_specular` and `_clearcoat`.
#[derive(Debug, Clone)]
pub struct Gloss {
    /// The diffuse reflectance of a dielectric, the reflectance of a metal that faces the light.
    pub base: Paint,
    /// How much of a metal it is, 0 to 1.
    pub metallic: f64,
    /// The square root of GGX's α, 0 to 1.
    pub roughness: f64,
    /// Multiplies both: metalness in blue, roughness in green.
    pub metal_rough: Option<Texture>,
    /// The index of the dielectric: what it reflects when it faces the light is `((n - 1)/(n + 1))²`.
    pub index: f64,
    /// How strong the dielectric's reflection is.
    pub specular: f64,
    /// Multiplies it, in alpha.
    pub specular_texture: Option<Texture>,
    /// Its colour when facing the light; none for white.
    pub specular_color: Option<Paint>,
    /// A coat over it all.
    pub clearcoat: Option<Clearcoat>,
}

/// A second, dielectric layer (index 1.5).
#[derive(Debug, Clone)]
pub struct Clearcoat {
    /// How much of it there is, 0 to 1.
    pub strength: f64,
    /// Multiplies it, in red.
    pub strength_texture: Option<Texture>,
    /// The square root of its α.
    pub roughness: f64,
    /// Multiplies it, in green.
    pub roughness_texture: Option<Texture>,
    /// Its own relief: that of the base does not show in it.
    pub relief: Option<NormalMap>,
}

impl Gloss {
    pub(super) fn is_textured(&self) -> bool {
        let of_coat = |coat: &Clearcoat| {
            coat.strength_texture.is_some() || coat.roughness_texture.is_some() || coat.relief.is_some()
        };
        self.base.varies()
            || self.metal_rough.is_some()
            || self.specular_texture.is_some()
            || self.specular_color.as_ref().is_some_and(Paint::varies)
            || self.clearcoat.as_ref().is_some_and(of_coat)
    }
}

/// What a surface is at one place, for light from anywhere.
///
/// Every response is linear in two spectra: `base(λ) b + tint(λ) t + w`, where b, t and w depend on directions alone.
/// (A metal by its index multiplies w.)
#[derive(Debug)]
pub(crate) struct Lobes<'s> {
    /// What the diffuse part, and a metal of a colour, have for a colour.
    pub(crate) base: Option<Tint<'s>>,
    /// The normal, relief included, on the side from which it is seen.
    pub(crate) normal: DVec3,
    // Share of the diffuse part.
    diffuse: f64,
    /// What it reflects otherwise.
    pub(crate) shine: Option<Shine<'s>>,
}

/// What a surface reflects otherwise than to all sides.
#[derive(Debug)]
pub(crate) struct Shine<'s> {
    /// What the dielectric's reflection has for a colour.
    pub(crate) tint: Option<Tint<'s>>,
    /// Whose reflectance the white part is multiplied with.
    pub(crate) metal: Option<&'s Metal>,
    metallic: f64,
    // Reflectances of the dielectric facing the light (before its tint) and at grazing; the tint's largest channel.
    facing: f64,
    grazing: f64,
    tint_peak: f64,
    // Of the base.
    roughness: f64,
    coat: Option<Coat>,
}

#[derive(Debug)]
struct Coat {
    strength: f64,
    roughness: f64,
    normal: DVec3,
}

/// The weights of `base(λ) b + tint(λ) t + w`.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Response {
    pub(crate) base: f64,
    pub(crate) tint: f64,
    pub(crate) white: f64,
    /// The cosine at which a metal reflects.
    pub(crate) cosine: f64,
}

impl Response {
    /// Whether there is more to it than its base.
    pub(crate) fn shines(&self) -> bool {
        self.tint > 0.0 || self.white > 0.0
    }
}

/// What is reflected as by a mirror.
pub(crate) struct Reflection {
    pub(crate) normal: DVec3,
    pub(crate) roughness: f64,
    pub(crate) response: Response,
}

/// Reflectance of the coat facing the light: index 1.5.
const COAT: f64 = 0.04;

/// What a dielectric of index `n` reflects of light that it faces: `((n - 1)/(n + 1))²`, all for 0 (glTF's infinity).
fn facing(index: f64) -> f64 {
    let ratio = (index - 1.0) / (index + 1.0);
    ratio * ratio
}

/// Schlick's fifth power.
fn fifth(cosine: f64) -> f64 {
    let x = (1.0 - cosine).clamp(0.0, 1.0);
    let squared = x * x;
    squared * squared * x
}

impl<'s> Lobes<'s> {
    /// Of a diffuse surface.
    #[inline]
    pub(crate) fn diffuse(paint: &'s Paint, surface: &'s Surface, look: &Look<'_>) -> Self {
        let normal = look.normal(surface.relief.as_ref());
        Self { base: Some(paint.at(look)), normal, diffuse: 1.0, shine: None }
    }

    /// What scatters light of lamps at a place; none for what does not.
    #[inline]
    pub(crate) fn of(surface: &'s Surface, look: &Look<'_>) -> Option<Self> {
        let normal = look.normal(surface.relief.as_ref());
        match &surface.scatter {
            Scatter::Diffuse(paint) => Some(Self::diffuse(paint, surface, look)),
            Scatter::Metal(Polish { of, roughness }) => {
                let shine = Shine { metal: Some(of), roughness: *roughness, ..Shine::NONE };
                Some(Self { base: None, normal, diffuse: 0.0, shine: Some(shine) })
            }
            Scatter::Gloss(gloss) => Some(gloss.lobes(look, normal)),
            Scatter::Glass(glass) => Some(glass.lobes(look, normal)),
            Scatter::Absorb | Scatter::Mirror(_) | Scatter::Mixed(_) => None,
        }
    }

    /// How light goes between two directions (to the light, to the eye; units, away from the surface): `f(λ)`, per
    /// steradian.
    #[inline]
    pub(crate) fn response(&self, directions: impl Fn() -> (DVec3, DVec3)) -> Response {
        let response = Response { base: self.diffuse * FRAC_1_PI, ..Response::default() };
        match &self.shine {
            Some(shine) => shine.response(response, self.normal, directions()),
            None => response,
        }
    }

    /// What the surface makes of light that is the same from all sides: its diffuse part, and each of its reflections.
    pub(crate) fn all_round(&self, to_eye: DVec3) -> (Response, [Option<Reflection>; 2]) {
        let diffuse = Response { base: self.diffuse, ..Response::default() };
        match &self.shine {
            Some(shine) => shine.all_round(diffuse, self.normal, to_eye),
            None => (diffuse, [None, None]),
        }
    }

    /// Whose reflectance the white part of responses is multiplied with.
    pub(crate) fn metal(&self) -> Option<&'s Metal> {
        self.shine.as_ref().and_then(|shine| shine.metal)
    }

    /// A response at one wavelength in the surface's rest frame.
    pub(crate) fn at(&self, response: &Response, wavelength_nm: f64) -> f64 {
        let of = |tint: Option<&Tint<'_>>| tint.map_or(0.0, |tint| tint.at(wavelength_nm));
        let mut sum = match self.metal() {
            Some(metal) => response.white * metal.reflectance(response.cosine, wavelength_nm),
            None => response.white,
        };
        if response.base > 0.0 {
            sum += response.base * of(self.base.as_ref());
        }
        if response.tint > 0.0 {
            sum += response.tint * of(self.shine.as_ref().and_then(|shine| shine.tint.as_ref()));
        }
        sum
    }
}

impl Shine<'_> {
    const NONE: Self = Self {
        tint: None,
        metal: None,
        metallic: 0.0,
        facing: 0.0,
        grazing: 0.0,
        tint_peak: 1.0,
        roughness: 1.0,
        coat: None,
    };

    fn response(&self, diffuse: Response, normal: DVec3, (to_light, to_eye): (DVec3, DVec3)) -> Response {
        let alpha = self.roughness * self.roughness;
        let mut response = diffuse;
        if self.metal.is_some() {
            if let Some((height, cosine)) = highlight(alpha, normal, to_light, to_eye) {
                response = Response { white: height, cosine, ..response };
            }
            return response;
        }
        if self.grazing > 0.0 || self.metallic > 0.0 {
            let half = (to_light + to_eye).normalize_or_zero();
            let share = fifth(half.dot(to_eye));
            let height = highlight(alpha, normal, to_light, to_eye).map_or(0.0, |(d, _)| d);
            self.reflected(&mut response, share, height);
        }
        if let Some(coat) = &self.coat {
            let share = coat.share(to_eye);
            let shine = highlight(coat.roughness * coat.roughness, coat.normal, to_light, to_eye);
            response = response.times(1.0 - share);
            response.white += share * shine.map_or(0.0, |(height, _)| height);
        }
        response
    }

    /// Adds the base's reflection, with Schlick's share and the height of the lobe, and takes it from the diffuse part.
    fn reflected(&self, response: &mut Response, share: f64, height: f64) {
        let dielectric = 1.0 - self.metallic;
        let brightest = (self.facing * self.tint_peak).min(1.0) * (1.0 - share) + self.grazing * share;
        response.base *= dielectric * (1.0 - brightest.min(1.0));
        response.base += self.metallic * height * (1.0 - share);
        let facing = dielectric * self.facing * (1.0 - share) * height;
        if self.tint.is_some() {
            response.tint += facing;
        } else {
            response.white += facing;
        }
        response.white += (dielectric * self.grazing + self.metallic) * share * height;
    }

    fn all_round(
        &self,
        mut diffuse: Response,
        normal: DVec3,
        to_eye: DVec3,
    ) -> (Response, [Option<Reflection>; 2]) {
        let mut reflections = [None, None];
        let cosine = normal.dot(to_eye).clamp(0.0, 1.0);
        let mut mirrored = Response::default();
        if self.metal.is_some() {
            mirrored = Response { white: 1.0, cosine, ..mirrored };
        } else if self.grazing > 0.0 || self.metallic > 0.0 {
            let share = fifth(cosine);
            self.reflected(&mut diffuse, share, 0.0);
            self.reflected(&mut mirrored, share, 1.0);
        }
        if let Some(coat) = &self.coat {
            let share = coat.share(to_eye);
            diffuse = diffuse.times(1.0 - share);
            mirrored = mirrored.times(1.0 - share);
            let response = Response { white: share, ..Response::default() };
            reflections[0] = Some(Reflection { normal: coat.normal, roughness: coat.roughness, response });
        }
        if mirrored.base + mirrored.tint + mirrored.white > 0.0 {
            reflections[1] = Some(Reflection { normal, roughness: self.roughness, response: mirrored });
        }
        (diffuse, reflections)
    }
}

impl Coat {
    /// What part of the light it reflects, by the angle of sight.
    fn share(&self, to_eye: DVec3) -> f64 {
        self.strength * (COAT + (1.0 - COAT) * fifth(self.normal.dot(to_eye)))
    }
}

impl Response {
    /// With so much of another besides. (Only one of the two may be a bare metal's.)
    pub(crate) fn plus(self, other: Self, factor: f64) -> Self {
        Self {
            base: self.base + other.base * factor,
            tint: self.tint + other.tint * factor,
            white: self.white + other.white * factor,
            cosine: self.cosine.max(other.cosine),
        }
    }

    fn times(self, factor: f64) -> Self {
        Self {
            base: self.base * factor,
            tint: self.tint * factor,
            white: self.white * factor,
            cosine: self.cosine,
        }
    }
}

/// One channel of a texture, if there is one; else 1.
fn channel(texture: Option<&Texture>, channel: usize, look: &Look<'_>) -> f64 {
    texture.map_or(1.0, |texture| f64::from(look.texel(texture)[channel]))
}

impl Gloss {
    fn lobes<'s>(&'s self, look: &Look<'_>, normal: DVec3) -> Lobes<'s> {
        let texel = self.metal_rough.as_ref().map_or([1.0; 4], |texture| look.texel(texture));
        let specular = self.specular * channel(self.specular_texture.as_ref(), 3, look);
        let facing = facing(self.index) * specular;
        let tint_peak = match &self.specular_color {
            Some(Paint::Colors(colors)) => colors.rgb(look).into_iter().fold(0.0, f64::max),
            _ => 1.0,
        };
        // No channel reflects more than all.
        let facing = facing.min(1.0 / tint_peak.max(1e-9));
        let coat = self.clearcoat.as_ref().map(|coat| Coat {
            strength: coat.strength * channel(coat.strength_texture.as_ref(), 0, look),
            roughness: coat.roughness * channel(coat.roughness_texture.as_ref(), 1, look),
            normal: look.normal(coat.relief.as_ref()),
        });
        let shine = Shine {
            tint: self.specular_color.as_ref().map(|color| color.at(look)),
            metal: None,
            metallic: self.metallic * f64::from(texel[2]),
            facing,
            grazing: specular,
            tint_peak,
            roughness: (self.roughness * f64::from(texel[1])).clamp(0.0, 1.0),
            coat: coat.filter(|coat| coat.strength > 0.0),
        };
        Lobes { base: Some(self.base.at(look)), normal, diffuse: 1.0, shine: Some(shine) }
    }
}

impl Glass {
    /// A dielectric's highlight, and the diffuse part of what is not all glass. Reflections are traced elsewhere.
    fn lobes<'s>(&'s self, look: &Look<'_>, normal: DVec3) -> Lobes<'s> {
        let index = self.medium_index().at(589.0);
        let amount = self.amount_at(look);
        let shine = Shine { facing: facing(index), grazing: 1.0, roughness: self.roughness, ..Shine::NONE };
        let base = self.color.as_ref().filter(|_| amount < 1.0).map(|color| color.at(look));
        Lobes { base, normal, diffuse: 1.0 - amount, shine: Some(shine) }
    }
}
