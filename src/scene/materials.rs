//! Surfaces, from the manifest's and the model files' words.

use super::light;
use crate::course::Course;
use crate::error::{Error, Place, Report};
use crate::import;
use crate::manifest::{self, MaterialKind, Spanned};
use crate::spectrum::{Beyond, End, Index, Metal, Reflectance, Source, Spectrum};
use crate::surface::{
    Absorption, Checker, Clearcoat, Colors, Coverage, Glass, Gloss, Glow, Medium, NormalMap, Paint, Polish,
    Scatter, Surface, Veil,
};
use crate::texture::{Filter, Picture, Texture, Wrap};
use glam::{DAffine2, DVec2};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Luminance of an unlit surface of white colour, cd/m² (glTF gives it none).
pub const UNLIT_LUMINANCE: f64 = 100.0;

/// The index of glass for which a file says 0: infinite, so that all is reflected.
const INFINITE_INDEX: f64 = 100.0;

/// Makes surfaces, and keeps what they share.
#[derive(Default)]
pub(super) struct Workshop {
    pub(super) media: Vec<Medium>,
    pictures: BTreeMap<PathBuf, Option<Arc<Picture>>>,
}

/// Of whom surfaces are made.
#[derive(Clone, Copy)]
pub(super) struct Owner<'b> {
    pub(super) place: &'b Place,
    pub(super) rest_from_lab: crate::spacetime::Boost<crate::spacetime::Rest, crate::spacetime::Lab>,
}

impl Workshop {
    /// A surface of the manifest; `file`: what the model file says of it.
    pub(super) fn surface(
        &mut self,
        material: &manifest::Material,
        file: Option<&import::Material>,
        owner: Owner<'_>,
        report: &mut Report,
    ) -> Surface {
        let beyond = Beyond { ultraviolet: end(material.ultraviolet), infrared: end(material.infrared) };
        let mut paint =
            |workshop: &mut Self, paint: &manifest::Paint| workshop.paint(paint, beyond, owner.place, report);
        match &material.kind {
            MaterialKind::Imported => match file {
                Some(file) => self.imported(file, beyond, owner),
                None => Surface::new(Scatter::Diffuse(Paint::grey(0.8))),
            },
            MaterialKind::Diffuse(of) => Surface::new(Scatter::Diffuse(paint(self, of))),
            MaterialKind::Mirror(of) => Surface::new(Scatter::Mirror(paint(self, of))),
            MaterialKind::Metal(metal) => {
                let of = Metal::named(metal_name(metal.name));
                let polish = of.map(|of| Scatter::Metal(Polish { of, roughness: metal.roughness }));
                Surface::new(polish.unwrap_or(Scatter::Absorb))
            }
            MaterialKind::Gloss(gloss) => {
                let base = paint(self, &gloss.base);
                Surface::new(Scatter::Gloss(Box::new(plain_gloss(base, gloss.roughness, gloss.index))))
            }
            MaterialKind::Glass(glass) => self.glass(glass, owner, report),
            MaterialKind::Emission(glow) => {
                let glow = light::radiance(glow, report).map(|radiance| Glow { radiance, paint: None });
                Surface { glow, ..Surface::new(Scatter::Absorb) }
            }
            MaterialKind::Blinking(blinking) => {
                let course = |inverted| blink(&blinking.blinking, inverted);
                let on = self.surface(&blinking.on, file, owner, report);
                let off = self.surface(&blinking.off, file, owner, report);
                Surface::new(Scatter::Mixed(vec![(course(false), on), (course(true), off)]))
            }
            MaterialKind::Keys(keys) => {
                let times: Vec<f64> = keys.iter().map(|key| key.at).collect();
                let part = |(i, key): (usize, &manifest::MaterialKey)| {
                    (share_of_key(&times, i), self.surface(&key.material, file, owner, report))
                };
                Surface::new(Scatter::Mixed(keys.iter().enumerate().map(part).collect()))
            }
        }
    }

    fn paint(
        &mut self,
        paint: &manifest::Paint,
        beyond: Beyond,
        place: &Place,
        report: &mut Report,
    ) -> Paint {
        match paint {
            manifest::Paint::Even(spectrum) => Paint::Even(reflectance(spectrum, beyond, place, report)),
            manifest::Paint::Checker { size, even, odd } => Paint::Checker(Box::new(Checker {
                size: *size,
                even: reflectance(even, beyond, place, report),
                odd: reflectance(odd, beyond, place, report),
            })),
            manifest::Paint::Picture { file, size } => match self.picture(file, report) {
                Some(picture) => {
                    let texture = Texture {
                        picture,
                        wrap: [Wrap::Repeat; 2],
                        filter: Filter::Linear,
                        uv_set: 0,
                        transform: DAffine2::from_scale(DVec2::splat(1.0 / size)),
                    };
                    let (color, texture) = ([1.0; 3], Some(texture));
                    Paint::Colors(Colors { color, texture, vertex_colors: false, beyond })
                }
                None => Paint::grey(0.0),
            },
        }
    }

    /// A picture file that the manifest names, read once.
    pub(super) fn picture(&mut self, file: &Spanned<PathBuf>, report: &mut Report) -> Option<Arc<Picture>> {
        if let Some(known) = self.pictures.get(&file.value) {
            return known.clone();
        }
        let picture = match import::picture_file(&file.value, &mut report.inputs) {
            Ok(picture) => Some(Arc::new(picture)),
            Err(Error::Input(faults)) => {
                for fault in faults {
                    report.fault(file.place.clone(), fault.what, fault.hint);
                }
                None
            }
            Err(error) => {
                report.fault(file.place.clone(), error.to_string(), "");
                None
            }
        };
        self.pictures.insert(file.value.clone(), picture.clone());
        picture
    }

    fn glass(&mut self, glass: &manifest::Glass, owner: Owner<'_>, report: &mut Report) -> Surface {
        let Some(index) = index(&glass.index) else {
            let what = "there is no glass of this index of refraction at all visible wavelengths";
            report.fault(glass.place.clone(), what, "glass: BK7");
            return Surface::new(Scatter::Absorb);
        };
        let left = glass
            .color
            .as_ref()
            .map(|tint| (reflectance(&tint.color, Beyond::MEAN, owner.place, report), tint.distance));
        let (color, absorption) = match left {
            Some((left, _)) if glass.thin => (Some(Paint::Even(left)), None),
            Some((left, distance)) => (None, Some(Absorption { left, distance })),
            None => (None, None),
        };
        let medium = self.medium(index, absorption, owner);
        Surface::new(Scatter::Glass(Box::new(Glass {
            medium,
            index,
            thin: glass.thin,
            color,
            amount: 1.0,
            amount_texture: None,
            roughness: 0.0,
        })))
    }

    fn medium(&mut self, index: Index, absorption: Option<Absorption>, owner: Owner<'_>) -> u32 {
        let rest_from_lab = owner.rest_from_lab;
        self.media.push(Medium { index, absorption, rest_from_lab, volume: f64::INFINITY });
        self.media.len() as u32 - 1
    }

    /// A surface as a model file describes it.
    pub(super) fn imported(&mut self, file: &import::Material, beyond: Beyond, owner: Owner<'_>) -> Surface {
        let [r, g, b, alpha] = file.base_color;
        let (color, texture) = ([r, g, b], file.base_texture.clone());
        let base = Paint::Colors(Colors { color, texture, vertex_colors: true, beyond });
        let veil = veil(file, alpha);
        if file.unlit {
            let glow = white(UNLIT_LUMINANCE).map(|radiance| Glow { radiance, paint: Some(base) });
            return Surface { glow, veil, ..Surface::new(Scatter::Absorb) };
        }
        let emits = file.emissive.iter().any(|channel| *channel > 0.0);
        let emitted = Colors {
            color: file.emissive,
            texture: file.emissive_texture.clone(),
            vertex_colors: false,
            beyond: Beyond::MEAN,
        };
        let glow = emits.then(|| white(1.0)).flatten();
        let glow = glow.map(|radiance| Glow { radiance, paint: Some(Paint::Colors(emitted)) });
        let relief = file.normal.as_ref().map(relief);
        let scatter = match &file.transmission {
            Some(transmission) if f64::from(file.metal.metallic) < 1.0 => {
                Scatter::Glass(Box::new(self.imported_glass(file, transmission, base, owner)))
            }
            _ if is_matt(file) => Scatter::Diffuse(base),
            _ => Scatter::Gloss(Box::new(gloss(file, base))),
        };
        Surface { glow, veil, relief, ..Surface::new(scatter) }
    }

    fn imported_glass(
        &mut self,
        file: &import::Material,
        transmission: &import::Transmission,
        base: Paint,
        owner: Owner<'_>,
    ) -> Glass {
        let ior = if file.ior == 0.0 { INFINITE_INDEX } else { f64::from(file.ior).max(1.0) };
        let index = Index::from_dispersion(ior, f64::from(file.dispersion));
        let absorption = file.volume.filter(|volume| volume.attenuation_distance.is_finite());
        let absorption = absorption.map(|volume| Absorption {
            left: Reflectance::Rgb(volume.attenuation_color.map(f64::from)),
            distance: f64::from(volume.attenuation_distance),
        });
        let thin = file.volume.is_none();
        let medium = if thin { 0 } else { self.medium(index, absorption, owner) };
        Glass {
            medium,
            index,
            thin,
            color: Some(base),
            amount: f64::from(transmission.amount) * (1.0 - f64::from(file.metal.metallic)),
            amount_texture: transmission.texture.clone(),
            roughness: f64::from(file.metal.roughness),
        }
    }
}

fn end(written: manifest::Beyond) -> End {
    match written {
        manifest::Beyond::Mean => End::Mean,
        manifest::Beyond::Hold => End::Hold,
        manifest::Beyond::Value(value) => End::Value(value),
    }
}

fn white(luminance: f64) -> Option<Source> {
    Source::with_luminous(&Spectrum::DAYLIGHT, luminance)
}

fn metal_name(name: manifest::MetalName) -> &'static str {
    match name {
        manifest::MetalName::Gold => "gold",
        manifest::MetalName::Silver => "silver",
        manifest::MetalName::Copper => "copper",
        manifest::MetalName::Aluminium => "aluminium",
    }
}

fn index(written: &manifest::Index) -> Option<Index> {
    match written {
        manifest::Index::Constant(n) => Some(Index::Constant(*n)),
        manifest::Index::Cauchy([a, b, c]) => Index::cauchy(*a, *b, *c),
        manifest::Index::Sellmeier(terms) => Index::sellmeier(terms),
        manifest::Index::Named(name) => Some(match name {
            manifest::GlassName::Bk7 => Index::BK7,
            manifest::GlassName::Sf11 => Index::SF11,
            manifest::GlassName::FusedSilica => Index::FUSED_SILICA,
            manifest::GlassName::Diamond => Index::DIAMOND,
            manifest::GlassName::Water => Index::WATER,
        }),
    }
}

/// A reflectance of the manifest; what cannot be one is reported.
fn reflectance(
    spectrum: &manifest::Spectrum,
    beyond: Beyond,
    place: &Place,
    report: &mut Report,
) -> Reflectance {
    match light::reflectance(spectrum) {
        Ok(Reflectance::Rgb(rgb)) if beyond != Beyond::MEAN => Reflectance::Extended { rgb, beyond },
        Ok(reflectance) => reflectance,
        Err(what) => {
            report.fault(place.clone(), what, "use a constant, an RGB colour or a table");
            Reflectance::Constant(0.0)
        }
    }
}

/// A blinking course of the manifest.
pub(super) fn blink(blinking: &manifest::Blinking, inverted: bool) -> Course {
    Course::Blinking { period: blinking.period, lit: blinking.lit, start: blinking.start, inverted }
}

/// What part key `i` has between its neighbours: 1 at its own time, 0 at theirs.
pub(super) fn share_of_key(times: &[f64], i: usize) -> Course {
    let value = |j: usize| f64::from(u8::from(j == i));
    let first = i.saturating_sub(1);
    let last = (i + 1).min(times.len() - 1);
    Course::Keyed((first..=last).map(|j| (times[j], value(j))).collect())
}

fn relief(map: &import::NormalMap) -> NormalMap {
    NormalMap { texture: map.texture.clone(), scale: map.scale }
}

fn veil(file: &import::Material, alpha: f32) -> Option<Veil> {
    let coverage =
        |cutoff| Coverage { factor: alpha, texture: file.base_texture.clone(), vertex_colors: true, cutoff };
    let coverage = match file.coverage {
        import::Coverage::Opaque => None,
        import::Coverage::Mask { cutoff } => Some(coverage(Some(cutoff))),
        import::Coverage::Blend => Some(coverage(None)),
    };
    // Glass has an inside, which is seen.
    let one_sided = !file.double_sided && file.transmission.is_none();
    (coverage.is_some() || one_sided).then_some(Veil { coverage, one_sided })
}

/// Whether nothing is reflected but by the diffuse part.
fn is_matt(file: &import::Material) -> bool {
    file.metal.metallic == 0.0 && file.specular.strength == 0.0 && file.clearcoat.is_none()
}

fn plain_gloss(base: Paint, roughness: f64, index: f64) -> Gloss {
    Gloss {
        base,
        metallic: 0.0,
        roughness,
        metal_rough: None,
        index,
        specular: 1.0,
        specular_texture: None,
        specular_color: None,
        clearcoat: None,
    }
}

fn gloss(file: &import::Material, base: Paint) -> Gloss {
    let specular = &file.specular;
    let colored = specular.color != [1.0; 3] || specular.color_texture.is_some();
    let specular_color = colored.then(|| {
        let (color, texture) = (specular.color, specular.color_texture.clone());
        Paint::Colors(Colors { color, texture, vertex_colors: false, beyond: Beyond::MEAN })
    });
    let coat = |coat: &import::Clearcoat| Clearcoat {
        strength: f64::from(coat.strength),
        strength_texture: coat.texture.clone(),
        roughness: f64::from(coat.roughness),
        roughness_texture: coat.roughness_texture.clone(),
        relief: coat.normal.as_ref().map(relief),
    };
    Gloss {
        metallic: f64::from(file.metal.metallic),
        metal_rough: file.metal.texture.clone(),
        specular: f64::from(specular.strength),
        specular_texture: specular.texture.clone(),
        specular_color,
        clearcoat: file.clearcoat.as_ref().map(coat),
        ..plain_gloss(base, f64::from(file.metal.roughness), f64::from(file.ior))
    }
}
