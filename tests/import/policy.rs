//! What may be read: nothing outside of one folder.

use super::*;

/// Loads a model in `root/models/` whose buffer is at a URI; the same bytes lie inside and outside of `root`.
fn with_buffer_at(uri: &str) -> Result<Asset, Error> {
    let folder = tempfile::tempdir().unwrap();
    let model = Model::triangle();
    let files = [
        ("root/models/m.gltf", &model.gltf(uri)[..]),
        ("root/models/in.bin", &model.bin),
        ("root/shared/in.bin", &model.bin),
        ("out.bin", &model.bin),
    ];
    write_files(folder.path(), &files);
    #[cfg(unix)]
    std::os::unix::fs::symlink(folder.path().join("out.bin"), folder.path().join("root/models/link.bin"))
        .unwrap();
    load(&folder.path().join("root/models/m.gltf"), &folder.path().join("root"))
}

#[test]
fn names_inside_of_the_folder_are_followed() {
    for uri in ["in.bin", "./in.bin", "../shared/in.bin", "..%2Fshared/in.bin", "..\\shared\\in.bin"] {
        assert!(with_buffer_at(uri).is_ok(), "{uri}: {:?}", with_buffer_at(uri).err());
    }
}

#[test]
fn names_that_leave_the_folder_are_refused() {
    let mut uris = vec![
        "../../out.bin",
        "%2e%2e/%2e%2e/out.bin",
        "..\\..\\out.bin",
        "../../root/models/in.bin",
        "/etc/hostname",
        "file:///etc/hostname",
        "https://example.org/in.bin",
        "C:\\in.bin",
        "",
        "in.bin%00",
    ];
    if cfg!(unix) {
        uris.push("link.bin");
    }
    for uri in uris {
        let faults = faults(with_buffer_at(uri));
        let said = faults[0].to_string();
        assert!(said.contains("m.gltf: buffers[0]"), "{uri}: {said}");
        assert!(!said.contains("cannot find"), "{uri} was looked for: {said}");
    }
}

#[test]
fn missing_files_and_folders_are_faults() {
    let said = faults(with_buffer_at("nothing.bin"))[0].to_string();
    assert!(said.contains("m.gltf: buffers[0]: cannot find `nothing.bin`"), "{said}");
    let said = faults(with_buffer_at("../models"))[0].to_string();
    assert!(said.contains("is not a file"), "{said}");
    let said = faults(load(Path::new("no/such.glb"), Path::new("")))[0].to_string();
    assert!(said.contains("no/such.glb: there is no such file"), "{said}");
}

#[test]
fn model_itself_must_be_inside_of_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path(), &[("m.glb", &Model::triangle().glb()), ("root/x", b"")]);
    let said = faults(load(&folder.path().join("m.glb"), &folder.path().join("root")))[0].to_string();
    assert!(said.contains("outside of which nothing is read"), "{said}");
}

#[test]
fn unknown_kind_of_file_names_the_known_ones() {
    for name in ["a.fbx", "a", "glb"] {
        let said = faults(load_files(name, &[(name, b"")]))[0].to_string();
        assert!(said.contains(name) && said.contains(".glb, .gltf or .obj"), "{said}");
    }
}
