//! Buffers, views into them, and URIs.

use super::document::Document;
use crate::import::Job;
use crate::import::files::{Refusal, scheme};
use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use gltf::json;
use std::borrow::Cow;

/// The standard alphabet, with the padding or without.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// All buffers of a file; one at fault is reported and left empty.
pub(super) fn load<'a>(root: &json::Root, blob: Option<Cow<'a, [u8]>>, job: &mut Job) -> Vec<Cow<'a, [u8]>> {
    let mut blob = blob;
    let mut buffers = Vec::new();
    for (i, buffer) in root.buffers.iter().enumerate() {
        let element = format!("buffers[{i}]");
        let bytes = match &buffer.uri {
            Some(uri) => resource(uri, job).map(Cow::Owned),
            None if i == 0 => blob.take().ok_or_else(|| no_bytes("the file has no binary chunk")),
            None => Err(no_bytes("only the first buffer can be the binary chunk")),
        };
        let bytes = bytes.and_then(|bytes| cut(bytes, buffer.byte_length.0));
        buffers.push(bytes.unwrap_or_else(|refusal| {
            job.refused(element, refusal);
            Cow::Borrowed(&[])
        }));
    }
    buffers
}

fn no_bytes(why: &str) -> Refusal {
    Refusal::new(format!("has no uri, and {why}"), "the file is incomplete: export it again")
}

/// The first bytes of a buffer, as many as it says it has.
fn cut(mut bytes: Cow<'_, [u8]>, length: u64) -> Result<Cow<'_, [u8]>, Refusal> {
    let length = usize::try_from(length).unwrap_or(usize::MAX);
    if length > bytes.len() {
        let what = format!("byteLength says {length} bytes, but there are {}", bytes.len());
        return Err(Refusal::new(what, "the file was cut off: copy or export it again"));
    }
    match &mut bytes {
        Cow::Borrowed(b) => *b = &b[..length],
        Cow::Owned(b) => b.truncate(length),
    }
    Ok(bytes)
}

/// The bytes that a URI stands for: a data URI, or a file by a relative path.
pub(super) fn resource(uri: &str, job: &mut Job) -> Result<Vec<u8>, Refusal> {
    if scheme(uri).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data")) {
        job.files.take(uri.len() as u64)?;
        return data(uri);
    }
    let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
    let path = match job.files.find(&job.folder, &name) {
        // A file may really be named `100%25.png`.
        Err(refusal) if refusal.missing && name != uri => job.files.find(&job.folder, uri),
        found => found,
    }?;
    job.files.read(&path)
}

/// The bytes in a data URI (RFC 2397).
fn data(uri: &str) -> Result<Vec<u8>, Refusal> {
    let hint = "the file is damaged: export it again";
    let Some((head, body)) = uri.split_once(',') else {
        return Err(Refusal::new("a data URI without a comma", hint));
    };
    if !head.to_ascii_lowercase().ends_with(";base64") {
        return Ok(percent_encoding::percent_decode_str(body).collect());
    }
    let body = if body.contains('%') {
        percent_encoding::percent_decode_str(body).collect()
    } else {
        Cow::Borrowed(body.as_bytes())
    };
    BASE64.decode(body).map_err(|error| Refusal::new(format!("a data URI with bad base64: {error}"), hint))
}

/// The bytes of a view and its stride.
pub(super) fn view<'a>(
    document: &'a Document<'_>,
    index: json::Index<json::buffer::View>,
) -> Result<(&'a [u8], Option<usize>), String> {
    let number = index.value();
    let view =
        super::get(&document.root.buffer_views, index).ok_or(format!("there is no bufferViews[{number}]"))?;
    let buffer = super::get(&document.buffers, json::Index::new(view.buffer.value() as u32))
        .ok_or(format!("bufferViews[{number}].buffer: there is no such buffer"))?;
    let start = view.byte_offset.unwrap_or_default().0;
    let end = start.checked_add(view.byte_length.0).filter(|&end| end <= buffer.len() as u64);
    let Some(end) = end else {
        return Err(format!(
            "bufferViews[{number}] wants {} bytes from byte {start} on, but its buffer has {}",
            view.byte_length.0,
            buffer.len()
        ));
    };
    Ok((&buffer[start as usize..end as usize], view.byte_stride.map(|stride| stride.0)))
}
