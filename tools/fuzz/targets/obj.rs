//! Any text as an OBJ file; what follows a line of four percent signs is its material file `m.mtl`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: terrell_fuzz::let_fences_stand(), |bytes: &[u8]| {
    let folder = terrell_fuzz::folder();
    let cut = bytes.windows(5).position(|part| part == b"%%%%\n");
    let (obj, mtl) = cut.map_or((bytes, &[][..]), |cut| (&bytes[..cut], &bytes[cut + 5..]));
    let path = folder.join("model.obj");
    std::fs::write(&path, obj).expect("writing");
    std::fs::write(folder.join("m.mtl"), mtl).expect("writing");
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
