//! Surfaces as files describe them: the metallic-roughness model of glTF 2.0 with its extensions.

use crate::texture::Texture;

/// A surface as the file describes it. Colours are linear sRGB.
///
/// Every number is finite (but for one distance) and in the range that the specification gives. Where there
/// is a texture its channel multiplies the number beside it.
#[derive(Debug, Clone)]
pub struct Material {
    /// The file's name for it.
    pub name: String,
    /// Reflectance (RGB) and coverage (A), multiplied with the texture's and the vertices' colours. For a
    /// metal, what it reflects straight on.
    pub base_color: [f32; 4],
    /// Multiplies `base_color`.
    pub base_texture: Option<Texture>,
    /// What the alpha of the base colour means.
    pub coverage: Coverage,
    /// Emitted light, cd/m² for a white of 1, strength included.
    pub emissive: [f32; 3],
    /// Multiplies `emissive`.
    pub emissive_texture: Option<Texture>,
    /// Shows its base colour whatever the lighting (`KHR_materials_unlit`).
    pub unlit: bool,
    /// Metal or not, and how rough.
    pub metal: MetalRough,
    /// Small bumps.
    pub normal: Option<NormalMap>,
    /// Whether the back of a triangle shows, too (`doubleSided`); always so for OBJ, which knows no back.
    pub double_sided: bool,
    /// Refractive index, from 1 on (`KHR_materials_ior`); 0 stands for infinite: all light is reflected.
    pub ior: f32,
    /// Abbe's number V as 20/V: 0 for glass without dispersion (`KHR_materials_dispersion`).
    pub dispersion: f32,
    /// How strongly a surface that is no metal reflects (`KHR_materials_specular`).
    pub specular: Specular,
    /// A layer of varnish on top (`KHR_materials_clearcoat`).
    pub clearcoat: Option<Clearcoat>,
    /// Light goes through (`KHR_materials_transmission`).
    pub transmission: Option<Transmission>,
    /// The surface bounds a body that light goes through (`KHR_materials_volume`); none for a thin wall.
    pub volume: Option<Volume>,
}

/// What the alpha of the base colour (its factor, texture and vertex colours multiplied) means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coverage {
    /// Nothing: the surface is everywhere; its alpha is 1.
    Opaque,
    /// The surface is where alpha is at least the cutoff, and nowhere else.
    Mask {
        /// From 0 on; beyond 1 nothing is there.
        cutoff: f32,
    },
    /// The share of the surface that is there.
    Blend,
}

/// Metalness and roughness.
#[derive(Debug, Clone)]
pub struct MetalRough {
    /// From 0, a dielectric, to 1, a metal.
    pub metallic: f32,
    /// From 0, smooth, to 1; its square is the width α of the distribution of microfacets.
    pub roughness: f32,
    /// Metalness in B, roughness in G; linear.
    pub texture: Option<Texture>,
}

/// Normals in tangent space, x along the tangent, y along the bitangent, z along the normal.
#[derive(Debug, Clone)]
pub struct NormalMap {
    /// RGB, each from 0 to 1 for -1 to 1; linear.
    pub texture: Texture,
    /// Multiplies x and y. Of any sign.
    pub scale: f32,
}

/// The reflection of a dielectric.
#[derive(Debug, Clone)]
pub struct Specular {
    /// From 0, none at all, to 1, that of its refractive index.
    pub strength: f32,
    /// Multiplies `strength` by its A; linear.
    pub texture: Option<Texture>,
    /// Colours the reflection straight on; from 0, beyond 1 too.
    pub color: [f32; 3],
    /// Multiplies `color` by its RGB.
    pub color_texture: Option<Texture>,
}

/// A clear layer of refractive index 1.5 on top.
#[derive(Debug, Clone)]
pub struct Clearcoat {
    /// Its share of the surface, above 0 up to 1.
    pub strength: f32,
    /// Multiplies `strength` by its R; linear.
    pub texture: Option<Texture>,
    /// As [`MetalRough::roughness`].
    pub roughness: f32,
    /// Multiplies `roughness` by its G; linear.
    pub roughness_texture: Option<Texture>,
    /// Its own bumps; those of what is below do not count for it.
    pub normal: Option<NormalMap>,
}

/// Light that goes through a dielectric instead of being scattered.
#[derive(Debug, Clone)]
pub struct Transmission {
    /// Its share of what is not reflected, above 0 up to 1.
    pub amount: f32,
    /// Multiplies `amount` by its R; linear.
    pub texture: Option<Texture>,
}

/// The inside of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Above 0; how thick the file guesses the body to be, metres in the mesh's coordinates. The true
    /// thickness is that of the mesh: this one only says that there is an inside.
    pub thickness: f32,
    /// How far white light goes until it has `attenuation_color`, metres; infinite where nothing is absorbed.
    pub attenuation_distance: f32,
    /// Linear sRGB, from 0 to 1.
    pub attenuation_color: [f32; 3],
}

/// What triangles without a material are made of: white that scatters alike to all sides.
impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_texture: None,
            coverage: Coverage::Opaque,
            emissive: [0.0; 3],
            emissive_texture: None,
            unlit: false,
            metal: MetalRough { metallic: 0.0, roughness: 1.0, texture: None },
            normal: None,
            double_sided: false,
            ior: 1.5,
            dispersion: 0.0,
            specular: Specular { strength: 0.0, texture: None, color: [1.0; 3], color_texture: None },
            clearcoat: None,
            transmission: None,
            volume: None,
        }
    }
}

impl Material {
    /// All of its textures, with what they are for.
    pub fn textures(&self) -> impl Iterator<Item = (&'static str, &Texture)> {
        let coat = self.clearcoat.as_ref();
        [
            ("base colour", self.base_texture.as_ref()),
            ("emission", self.emissive_texture.as_ref()),
            ("metallic and roughness", self.metal.texture.as_ref()),
            ("normal", self.normal.as_ref().map(|map| &map.texture)),
            ("specular", self.specular.texture.as_ref()),
            ("specular colour", self.specular.color_texture.as_ref()),
            ("transmission", self.transmission.as_ref().and_then(|t| t.texture.as_ref())),
            ("clearcoat", coat.and_then(|coat| coat.texture.as_ref())),
            ("clearcoat roughness", coat.and_then(|coat| coat.roughness_texture.as_ref())),
            ("clearcoat normal", coat.and_then(|coat| coat.normal.as_ref()).map(|map| &map.texture)),
        ]
        .into_iter()
        .filter_map(|(purpose, texture)| Some((purpose, texture?)))
    }

    /// Whether its look depends on the tangents of the mesh.
    pub fn has_normal_map(&self) -> bool {
        self.normal.is_some() || self.clearcoat.as_ref().is_some_and(|coat| coat.normal.is_some())
    }
}
