//! Images, samplers and texture transforms.

use super::buffer;
use super::document::Document;
use crate::import::Job;
use crate::import::files::Refusal;
use crate::import::picture;
use crate::texture::{Filter, Picture, Texels, Texture, Wrap};
use glam::{DAffine2, DMat2, DVec2};
use gltf::json;
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::texture::{MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a texture's numbers are taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// Colour with coverage.
    Color,
    /// Numbers that are no colours, linear as stored.
    Data,
    /// Colour whose alpha is left out.
    Opaque,
}

/// Pictures decoded so far, by the number of the image, in the order of [`Use`]; all none for one at fault.
pub(super) type Pictures = BTreeMap<usize, [Option<Arc<Picture>>; 3]>;

/// The texture that a material refers to; none if it is at fault, which is reported.
pub(super) fn read(
    document: &Document<'_>,
    info: &json::texture::Info,
    (element, usage): (&str, Use),
    pictures: &mut Pictures,
    job: &mut Job,
) -> Option<Texture> {
    let Some(written) = super::get(&document.root.textures, info.index) else {
        let what = format!("there is no textures[{}]", info.index.value());
        job.fault(format!("{element}.index"), what, "");
        return None;
    };
    let sampler = written.sampler.and_then(|index| super::get(&document.root.samplers, index)).cloned();
    let sampler = sampler.unwrap_or_default();
    let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
    let set = transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
    let Some(uv_set) = u8::try_from(set).ok().filter(|&set| set < 2) else {
        let hint = "use one of the first two UV maps";
        job.fault(format!("{element}.texCoord"), format!("TEXCOORD_{set} is not read"), hint);
        return None;
    };
    let transform = transform.map_or(DAffine2::IDENTITY, matrix);
    if !transform.is_finite() {
        job.fault(format!("{element}.extensions.KHR_texture_transform"), "is not finite", "");
        return None;
    }
    let Some(image) = super::get(&document.root.images, written.source) else {
        let hint = "export the pictures as PNG or JPEG";
        let what = "has no picture of a kind that plain glTF knows";
        job.fault(format!("textures[{}].source", info.index.value()), what, hint);
        return None;
    };
    let picture = picture(document, image, (written.source.value(), usage), pictures, job)?;
    let filter = match sampler.mag_filter {
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        _ => Filter::Linear,
    };
    Some(Texture { picture, wrap: [wrap(sampler.wrap_s), wrap(sampler.wrap_t)], filter, uv_set, transform })
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// ~~~text
/// uv' = T R S uv,   R = ( cos  sin)
///                       (-sin  cos)
/// ~~~
///
/// The listing in the text of `KHR_texture_transform` turns the other way. Its sample model, Blender and
/// the well-known viewers agree on this one, counter-clockwise where v points down (glTF issue 1563).
fn matrix(t: &TextureTransform) -> DAffine2 {
    let (sin, cos) = libm::sincos(f64::from(t.rotation.0));
    let rotation = DMat2::from_cols(DVec2::new(cos, -sin), DVec2::new(sin, cos));
    let [u, v] = t.scale.0.map(f64::from);
    let scale = DMat2::from_diagonal(DVec2::new(u, v));
    let [u, v] = t.offset.0.map(f64::from);
    DAffine2::from_mat2_translation(rotation * scale, DVec2::new(u, v))
}

/// The picture of an image (its number) for a use; a fault is reported, once, and gives none.
fn picture(
    document: &Document<'_>,
    image: &json::Image,
    (number, usage): (usize, Use),
    pictures: &mut Pictures,
    job: &mut Job,
) -> Option<Arc<Picture>> {
    let slot = usage as usize;
    let made = match pictures.get(&number) {
        Some(known) if known[slot].is_some() => return known[slot].clone(),
        // What has lost its alpha comes from what has it.
        Some(_) if usage == Use::Opaque => {
            let whole = picture(document, image, (number, Use::Color), pictures, job)?;
            if picture::is_opaque(&whole) { Ok(whole) } else { altered(&whole, picture::opaque, job) }
        }
        Some(known) => {
            let other = known.iter().flatten().next()?;
            match usage {
                _ if matches!(other.texels, Texels::Float(_)) => Ok(other.clone()),
                Use::Data => altered(other, picture::as_data, job),
                _ => altered(other, picture::as_color, job),
            }
        }
        None => {
            let loaded = load(document, image, job);
            let first = if usage == Use::Data { Use::Data } else { Use::Color };
            let alter = if usage == Use::Data { picture::as_data } else { picture::as_color };
            let loaded = loaded.map_err(|refusal| job.refused(format!("images[{number}]"), refusal)).ok();
            pictures.entry(number).or_default()[first as usize] = loaded.map(|made| Arc::new(alter(made)));
            return picture(document, image, (number, usage), pictures, job);
        }
    };
    let made = made.map_err(|refusal| job.refused(format!("images[{number}]"), refusal)).ok();
    pictures.entry(number).or_default()[slot].clone_from(&made);
    made
}

/// A copy of a picture, changed.
fn altered(picture: &Picture, alter: fn(Picture) -> Picture, job: &mut Job) -> Result<Arc<Picture>, Refusal> {
    job.files.take(picture::size(picture))?;
    Ok(Arc::new(alter(picture.clone())))
}

fn load(document: &Document<'_>, image: &json::Image, job: &mut Job) -> Result<Picture, Refusal> {
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) => {
            let bytes = buffer::resource(uri, job)?;
            picture::decode(&bytes, uri, &mut job.files)
        }
        (None, Some(view)) => {
            let (bytes, _) = buffer::view(document, view).map_err(|what| Refusal::new(what, ""))?;
            picture::decode(bytes, "", &mut job.files)
        }
        (None, None) => Err(Refusal::new("has neither a uri nor a bufferView", "export the model again")),
    }
}
