//! Accessors: numbers of any type, interleaved or not, sparse or not, checked before they are read.

use super::buffer;
use super::document::Document;
use crate::import::Job;
use gltf::json;
use gltf::json::accessor::{ComponentType as Kind, Type};
use gltf::json::validation::Checked;

/// The most elements of an accessor that has no bytes behind it (all zeros, or sparse), since nothing else
/// bounds those.
const ZEROS_LIMIT: u64 = 1 << 22;

/// An accessor whose every element is known to be there.
pub(super) struct Elements<'a> {
    /// Bytes from the first element on; none stands for zeros.
    bytes: Option<&'a [u8]>,
    stride: usize,
    /// Number of elements.
    pub count: usize,
    /// Type of a component.
    pub kind: Kind,
    /// SCALAR, VEC3 and so on.
    pub shape: Type,
    /// Whether integers stand for numbers from 0 or -1 to 1.
    pub normalized: bool,
    sparse: Option<Sparse<'a>>,
}

/// Elements that replace others.
struct Sparse<'a> {
    places: Vec<u32>,
    values: &'a [u8],
}

/// Looks up an accessor and checks that all of its elements are there.
pub(super) fn open<'a>(
    document: &'a Document<'_>,
    index: json::Index<json::Accessor>,
    job: &mut Job,
) -> Result<Elements<'a>, String> {
    let number = index.value();
    let at = |what: String| format!("accessors[{number}]: {what}");
    let accessor =
        super::get(&document.root.accessors, index).ok_or(at("there is no such accessor".into()))?;
    let (Checked::Valid(kind), Checked::Valid(shape)) = (&accessor.component_type, &accessor.type_) else {
        return Err(at("its type is not known to glTF".into()));
    };
    let (kind, shape) = (kind.0, *shape);
    let size = kind.size() * shape.multiplicity();
    let count = accessor.count.0;
    let (bytes, stride) = match accessor.buffer_view {
        Some(view) => {
            let offset = accessor.byte_offset.unwrap_or_default().0;
            let (bytes, stride) = buffer::view(document, view).map_err(at)?;
            let stride = stride.unwrap_or(size);
            (Some(within(bytes, offset, count, stride, size).map_err(at)?), stride)
        }
        None if count > ZEROS_LIMIT => {
            return Err(at(format!("{count} elements without a bufferView, and the limit is {ZEROS_LIMIT}")));
        }
        None => (None, size),
    };
    let sparse = match &accessor.sparse {
        Some(sparse) => Some(open_sparse(document, sparse, count, size, job).map_err(at)?),
        None => None,
    };
    let count = count as usize;
    Ok(Elements { bytes, stride, count, kind, shape, normalized: accessor.normalized, sparse })
}

/// The bytes from the first of `count` elements on, if all are inside.
fn within(bytes: &[u8], offset: u64, count: u64, stride: usize, size: usize) -> Result<&[u8], String> {
    if stride < size {
        return Err(format!("byteStride is {stride}, less than the {size} bytes of an element"));
    }
    let steps = count.saturating_sub(1).checked_mul(stride as u64);
    let last = if count == 0 { 0 } else { size as u64 };
    let end = steps.and_then(|n| n.checked_add(last)).and_then(|n| n.checked_add(offset));
    if end.is_none_or(|end| end > bytes.len() as u64) {
        return Err(format!(
            "{count} elements of {size} bytes, {stride} apart, from byte {offset} on do not fit \
             into the {} bytes of its bufferView",
            bytes.len()
        ));
    }
    Ok(&bytes[offset as usize..])
}

fn open_sparse<'a>(
    document: &'a Document<'_>,
    sparse: &json::accessor::sparse::Sparse,
    count: u64,
    size: usize,
    job: &mut Job,
) -> Result<Sparse<'a>, String> {
    let Checked::Valid(kind) = &sparse.indices.component_type else {
        return Err("sparse.indices.componentType is not known to glTF".into());
    };
    let kind = kind.0;
    let step = kind.size();
    let number = sparse.count.0;
    let (bytes, _) = buffer::view(document, sparse.indices.buffer_view)?;
    let bytes = within(bytes, sparse.indices.byte_offset.0, number, step, step)
        .map_err(|what| format!("sparse.indices: {what}"))?;
    let (values, _) = buffer::view(document, sparse.values.buffer_view)?;
    let values = within(values, sparse.values.byte_offset.0, number, size, size)
        .map_err(|what| format!("sparse.values: {what}"))?;
    job.files.take(number * 4).map_err(|refusal| refusal.what)?;
    let places = integers(bytes, step, number as usize, kind);
    if let Some(place) = places.iter().find(|&&place| u64::from(place) >= count) {
        return Err(format!("sparse.indices: {place} is out of range, there are {count} elements"));
    }
    Ok(Sparse { places, values })
}

/// Unsigned integers; `bytes` are known to be enough.
fn integers(bytes: &[u8], stride: usize, count: usize, kind: Kind) -> Vec<u32> {
    let elements = bytes.chunks(stride).take(count);
    match kind {
        Kind::U8 => elements.map(|b| u32::from(b[0])).collect(),
        Kind::U16 => elements.map(|b| u32::from(u16::from_le_bytes([b[0], b[1]]))).collect(),
        _ => elements.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect(),
    }
}

impl Elements<'_> {
    /// The elements as unsigned integers; for SCALAR of an unsigned type.
    pub(super) fn integers(&self, job: &mut Job) -> Result<Vec<u32>, String> {
        job.files.take(self.count as u64 * 4).map_err(|refusal| refusal.what)?;
        let mut all = match self.bytes {
            Some(bytes) => integers(bytes, self.stride, self.count, self.kind),
            None => vec![0; self.count],
        };
        if let Some(sparse) = &self.sparse {
            let size = self.kind.size();
            let values = integers(sparse.values, size, sparse.places.len(), self.kind);
            for (&place, value) in sparse.places.iter().zip(values) {
                all[place as usize] = value;
            }
        }
        Ok(all)
    }

    /// The elements numbered `picked` (all of them for none) as floats, `N` each; components that the
    /// file does not have are 1.
    pub(super) fn floats<const N: usize>(
        &self,
        picked: Option<&[u32]>,
        job: &mut Job,
    ) -> Result<Vec<[f32; N]>, String> {
        let number = picked.map_or(self.count, <[u32]>::len);
        let extra = if self.sparse.is_some() { self.count } else { 0 };
        let bytes = (number as u64 + extra as u64) * 4 * N as u64;
        job.files.take(bytes).map_err(|refusal| refusal.what)?;
        // glTF 2.0 §3.11: how integers stand for fractions.
        let full = self.normalized;
        let scale = |c: f32, most: f32| if full { (c / most).max(-1.0) } else { c };
        Ok(match self.kind {
            Kind::I8 => self.collect(picked, |b| scale(f32::from(b[0].cast_signed()), 127.0)),
            Kind::U8 => self.collect(picked, |b| scale(f32::from(b[0]), 255.0)),
            Kind::I16 => {
                self.collect(picked, |b| scale(f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0))
            }
            Kind::U16 => {
                self.collect(picked, |b| scale(f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0))
            }
            Kind::U32 => self.collect(picked, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32),
            Kind::F32 => self.collect(picked, |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        })
    }

    fn collect<const N: usize>(&self, picked: Option<&[u32]>, get: impl Fn(&[u8]) -> f32) -> Vec<[f32; N]> {
        let step = self.kind.size();
        let width = self.shape.multiplicity();
        let size = step * width;
        let element = |bytes: &[u8]| {
            std::array::from_fn(|c| if c < width { get(&bytes[c * step..(c + 1) * step]) } else { 1.0 })
        };
        let at = |i: usize| match self.bytes {
            Some(bytes) => element(&bytes[i * self.stride..i * self.stride + size]),
            None => std::array::from_fn(|c| if c < width { 0.0 } else { 1.0 }),
        };
        let Some(sparse) = &self.sparse else {
            return match picked {
                Some(picked) => picked.iter().map(|&i| at(i as usize)).collect(),
                None => (0..self.count).map(at).collect(),
            };
        };
        let mut all: Vec<[f32; N]> = (0..self.count).map(at).collect();
        for (&place, value) in sparse.places.iter().zip(sparse.values.chunks(size)) {
            all[place as usize] = element(value);
        }
        match picked {
            Some(picked) => picked.iter().map(|&i| all[i as usize]).collect(),
            None => all,
        }
    }
}
