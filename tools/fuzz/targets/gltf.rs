//! Any bytes as a .glb or .gltf file, all that it leads to decoded.
#![no_main]

libfuzzer_sys::fuzz_target!(init: terrell_fuzz::let_fences_stand(), |bytes: &[u8]| {
    let folder = terrell_fuzz::folder();
    let kind = if bytes.starts_with(b"glTF") { "glb" } else { "gltf" };
    let path = folder.join("model").with_extension(kind);
    std::fs::write(&path, bytes).expect("writing");
    match terrell::import::load(&path, &folder) {
        Ok(asset) => {
            for mesh in &asset.meshes {
                assert!(mesh.positions.iter().all(|place| place.is_finite()));
                assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
            }
        }
        Err(error) => terrell_fuzz::said(&error),
    }
});
