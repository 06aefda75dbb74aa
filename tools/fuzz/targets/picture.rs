//! Any bytes as a picture file; the first byte chooses its name.
#![no_main]

use terrell::inputs::Inputs;

const KINDS: [&str; 6] = ["png", "jpg", "exr", "hdr", "tga", "webp"];

libfuzzer_sys::fuzz_target!(init: terrell_fuzz::let_fences_stand(), |bytes: &[u8]| {
    let Some((first, bytes)) = bytes.split_first() else { return };
    let path = terrell_fuzz::folder().join("picture").with_extension(KINDS[usize::from(*first) % KINDS.len()]);
    std::fs::write(&path, bytes).expect("writing");
    if let Err(error) = terrell::import::picture_file(&path, &mut Inputs::default()) {
        terrell_fuzz::said(&error);
    }
});
