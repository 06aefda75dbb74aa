//! OBJ and MTL.

use super::*;
use glam::{DVec2, Vec2, Vec3};
use terrell::import::{Coverage, Material};
use terrell::texture::Wrap;

fn read(obj: &str, others: &[(&str, &[u8])]) -> Asset {
    let files: Vec<_> = others.iter().copied().chain([("m.obj", obj.as_bytes())]).collect();
    load_files("m.obj", &files).unwrap_or_else(|error| panic!("{error}"))
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn objects_and_groups_become_meshes_and_nodes() {
    let asset = read(&format!("{SQUARE}o Front Door\nf 1 2 3\ng Back\nf 1 3 4\nf 4 3 1\no Empty\n"), &[]);
    let names: Vec<_> = asset.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["Front Door", "Back"]);
    assert_eq!(asset.meshes[1].triangles.len(), 2);
    assert_eq!(asset.meshes[1].name, "Back");
    assert_eq!(asset.instances[1].node, 1);
    assert_eq!(asset.materials.len(), 1);
    assert_eq!(asset.materials[0].base_color, [1.0; 4]);
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
}

#[test]
fn object_without_a_name_has_the_files_and_a_name_again_goes_on() {
    let asset = read(&format!("{SQUARE}f 1 2 3\ng a\nf 1 3 4\ng b\nf 1 3 4\ng a\nf 2 3 4\n"), &[]);
    let counts: Vec<_> = asset.meshes.iter().map(|mesh| (mesh.name.as_str(), mesh.triangles.len())).collect();
    assert_eq!(counts, [("m", 1), ("a", 2), ("b", 1)]);
}

#[test]
fn faces_without_normals_are_flat() {
    let mesh = read(&format!("{SQUARE}v 0 0 1\nf 1 2 3 4\nf 1 4 5\n"), &[]).meshes[0].clone();
    assert_eq!(mesh.triangles.len(), 3);
    assert_eq!(mesh.normals, [vec![Vec3::Z; 6], vec![Vec3::X; 3]].concat());
}

#[test]
fn faces_with_and_without_attributes_do_not_mix_them_up() {
    let text = format!(
        "{SQUARE}vt 0.25 0.25\nvt 0.5 0.5\nvn 0 3 4\nf 1 2 3\nf 1/1/1 2/2/1 3/1/1\nf 1//1 3//1 4//1\n"
    );
    let mesh = read(&text, &[]).meshes[0].clone();
    assert_eq!(mesh.normals[..3], [Vec3::Z; 3]);
    assert_eq!(mesh.normals[3..], [Vec3::new(0.0, 0.6, 0.8); 6]);
    assert_eq!(mesh.uvs[0][3..6], [Vec2::new(0.25, 0.75), Vec2::new(0.5, 0.5), Vec2::new(0.25, 0.75)]);
    assert_eq!(mesh.uvs[0][6..], [Vec2::ZERO; 3]);
}

#[test]
fn texture_coordinates_are_turned_over() {
    let text = format!("{SQUARE}vt 0 0\nvt 1 0.25\nvt 1 1\nf 1/1 2/2 3/3\n");
    let mesh = read(&text, &[]).meshes[0].clone();
    assert_eq!(mesh.uvs[0], [Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75), Vec2::new(1.0, 0.0)]);
}

#[test]
fn concave_polygons_keep_their_shape() {
    let arrow = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 1 0.5 0\nv 0 4 0\nf 1 2 3 4 5\n";
    let mesh = read(arrow, &[]).meshes[0].clone();
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).z / 2.0
    };
    assert!(mesh.triangles.iter().all(|t| area(t) > 0.0));
    assert!((mesh.triangles.iter().map(area).sum::<f32>() - 9.0).abs() < 1e-5);
}

#[test]
fn negative_indices_count_back_and_lines_may_go_on() {
    let mesh = read("v 0 0 0\nv 2 0 0\nv \\\n0 2 0 # up\nf -3 \\\n -2 -1\n", &[]).meshes[0].clone();
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0]);
}

#[test]
fn vertex_colours_are_decoded_from_srgb_and_white_where_missing() {
    let mesh = read("v 0 0 0 0.5 0 1\nv 1 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n", &[]).meshes[0].clone();
    assert!((mesh.colors[0][0] - 0.214).abs() < 1e-3, "{:?}", mesh.colors[0]);
    assert_eq!(mesh.colors[0][1..], [0.0, 1.0, 1.0]);
    assert_eq!(mesh.colors[1], [1.0; 4]);
}

#[test]
fn lines_points_and_curves_are_passed_over_with_one_warning_each() {
    let asset = read(&format!("{SQUARE}l 1 2 3\nl 1 2\np 1\nf 1 2 3\ncurv 0 1\nsurf 0\n"), &[]);
    assert_eq!(asset.meshes[0].triangles.len(), 1);
    assert_eq!(asset.warnings.len(), 2);
    assert!(warns(&asset, "m.obj: line 5: points and lines"));
    assert!(warns(&asset, "m.obj: line 9: curved surfaces"));
}

#[test]
fn materials_have_colour_coverage_glow_and_texture() {
    let mtl = "newmtl a b\nKd 0.5 0.25 1\nKe 2 3 4\nd 0.5\nillum 2\nKs 1\nNs nonsense\n\
        newmtl t\n  map_Kd\t-s 2 4 1 -o 0.5 0.25 -clamp on my picture.png\nTr 0.25\n";
    let picture = png(1, &[[255, 0, 0, 7]]);
    let text =
        format!("mtllib the lib.mtl\n{SQUARE}vt 0 0\nusemtl t\nf 1/1 2/1 3/1\nusemtl a b\nf 1/1 3/1 4/1\n");
    let asset = read(&text, &[("the lib.mtl", mtl.as_bytes()), ("my picture.png", &picture)]);
    let [plain, textured] = &asset.materials[..] else { panic!("{:?}", asset.materials) };
    assert_eq!(
        (plain.name.as_str(), plain.base_color, plain.emissive),
        ("a b", [0.5, 0.25, 1.0, 0.5], [2.0, 3.0, 4.0])
    );
    assert_eq!(textured.base_color, [1.0, 1.0, 1.0, 0.75]);
    let texture = textured.base_texture.as_ref().unwrap();
    assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
    assert_eq!(texture.rgba(DVec2::ZERO), [1.0, 0.0, 0.0, 1.0], "coverage is that of `d`");
    // The file's (u, v) = (0.5, 0.5) becomes (2 · 0.5 + 0.5, 4 · 0.5 + 0.25), counted from below.
    let uv = texture.transform.transform_point2(DVec2::new(0.5, 1.0 - 0.5));
    assert_eq!(uv, DVec2::new(1.5, 1.0 - 2.25));
    let ends: Vec<_> = asset.meshes[0].parts.iter().map(|part| (part.end, part.material)).collect();
    assert_eq!(ends, [(1, 1), (2, 0)]);
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
}

#[test]
fn alpha_of_a_picture_counts_where_map_d_names_it_again() {
    let picture = png(1, &[[255, 0, 0, 51]]);
    let mtl = "newmtl a\nmap_Kd p.png\nmap_d -imfchan m p.png\nnewmtl b\nmap_Kd p.png\nmap_d q.png\n";
    let text = format!("mtllib m.mtl\n{SQUARE}f 1 2 3\n");
    let asset = read(&text, &[("m.mtl", mtl.as_bytes()), ("p.png", &picture)]);
    let alpha = |i: usize| asset.materials[i].base_texture.as_ref().unwrap().rgba(DVec2::ZERO)[3];
    assert_eq!((alpha(0), alpha(1)), (0.2, 1.0));
    assert!(warns(&asset, "m.mtl: line 6: a map_d other than"));
    assert_eq!(asset.warnings.len(), 1);
}

/// The materials of a library.
fn materials(mtl: &str, pictures: &[(&str, &[u8])]) -> Vec<Material> {
    let files: Vec<_> = [("m.mtl", mtl.as_bytes())].into_iter().chain(pictures.iter().copied()).collect();
    let asset = read(&format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3\n"), &files);
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
    asset.materials
}

#[test]
fn material_of_colour_alone_is_purely_diffuse_and_has_two_sides() {
    let a = &materials("newmtl a\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 250\nNi 1.45\nillum 2\n", &[])[0];
    assert_eq!((a.metal.metallic, a.metal.roughness, a.specular.strength), (0.0, 1.0, 0.0));
    assert_eq!((a.coverage, a.ior, a.double_sided), (Coverage::Opaque, 1.45, true));
}

#[test]
fn metalness_and_roughness_make_a_material_reflect() {
    let of = |lines: &str| {
        let a = materials(&format!("newmtl a\n{lines}\n"), &[])[0].clone();
        (a.metal.metallic, a.metal.roughness, a.specular.strength)
    };
    assert_eq!(of("Pr 0.25\nPm 0.75"), (0.75, 0.25, 1.0));
    assert_eq!(of("Pr 0.5"), (0.0, 0.5, 1.0));
    assert_eq!(of("Pm 1"), (1.0, 1.0, 1.0));
    assert_eq!(of("Ni 1"), (0.0, 1.0, 0.0));
}

#[test]
fn coverage_below_one_blends() {
    let all = materials("newmtl a\nd 0.5\nnewmtl b\nTr 0.25\nnewmtl c\nd 1\nnewmtl d\nTr 0\n", &[]);
    let coverage = |i: usize| (all[i].coverage, all[i].base_color[3]);
    assert_eq!((coverage(0), coverage(1)), ((Coverage::Blend, 0.5), (Coverage::Blend, 0.75)));
    assert_eq!((coverage(2), coverage(3)), ((Coverage::Opaque, 1.0), (Coverage::Opaque, 1.0)));
    let (clear, solid) = (png(1, &[[255, 0, 0, 51]]), png(1, &[[255, 0, 0, 255]]));
    let mtl =
        "newmtl a\nmap_Kd p.png\nmap_d p.png\nnewmtl b\nmap_Kd q.png\nmap_d q.png\nnewmtl c\nmap_Kd p.png\n";
    let all = materials(mtl, &[("p.png", &clear), ("q.png", &solid)]);
    let coverage: Vec<_> = all.iter().map(|m| m.coverage).collect();
    assert_eq!(coverage, [Coverage::Blend, Coverage::Opaque, Coverage::Opaque]);
}

#[test]
fn what_is_not_read_of_physical_materials_is_warned_of() {
    let mtl = "newmtl a\nNi 0.5\nmap_Pr p.png\nmap_Pm p.png\nnorm p.png\n";
    let asset = read(&format!("mtllib m.mtl\n{SQUARE}f 1 2 3\n"), &[("m.mtl", mtl.as_bytes())]);
    assert!(warns(&asset, "m.mtl: line 2: a refractive index of 0.5 is passed over"));
    assert!(warns(&asset, "m.mtl: line 3: `map_pr`") && warns(&asset, "line 4: `map_pm`"));
    assert!(warns(&asset, "line 5: `norm`"));
    assert_eq!(asset.materials[0].ior, 1.5);
}

#[test]
fn several_libraries_on_a_line_are_read_and_each_only_once() {
    let text = format!("mtllib a.mtl b.mtl\nmtllib a.mtl\n{SQUARE}usemtl b\nf 1 2 3\n");
    let asset = read(&text, &[("a.mtl", b"newmtl a\nKd 1 0 0"), ("b.mtl", b"newmtl b\nKd 0 1 0")]);
    assert_eq!(asset.materials.len(), 2);
    assert_eq!(asset.meshes[0].parts[0].material, 1);
}

#[test]
fn missing_library_and_unknown_material_are_warned_of() {
    let asset = read(&format!("mtllib gone.mtl\n{SQUARE}usemtl red\nf 1 2 3\n"), &[]);
    assert!(warns(&asset, "m.obj: line 1: cannot find `gone.mtl`"));
    assert!(warns(&asset, "m.obj: line 6: there is no material `red`"));
    assert_eq!(asset.materials[asset.meshes[0].material_of(0) as usize].base_color, [1.0; 4]);
}

/// What the faults of a square with one more line say, in one string.
fn said(obj: &str, mtl: &str) -> String {
    let files = [("m.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    faults(load_files("m.obj", &files)).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[test]
fn lines_at_fault_are_named() {
    let cases = [
        ("v 1 2", "a vertex has 3, 4 or 6 numbers, not 2"),
        ("v 1 2 3 0", "a w of 0"),
        ("v 1 2 3 4 5", "not 5"),
        ("v 1 2 3 4 5 6 7", "more than 6"),
        ("v 1 2 x", "`x` is not a number"),
        ("v 1 nan 2", "`nan` is not a finite number"),
        ("v 1 1e999 2", "`1e999` is not a finite number"),
        ("vt", "texture coordinates have 2"),
        ("vt inf 0", "`inf`"),
        ("vn 0 1", "a normal has 3 numbers"),
        ("vn 0 1 nan", "`nan`"),
        ("f 1 2", "at least 3 corners"),
        ("f 1 2 0", "the index 0"),
        ("f 1 2 5", "`5`: there are only 4 vertices"),
        ("f 1 2 -5", "`-5`: there are only 4 vertices"),
        ("f 1 2 99999999999999999999", "not a whole number"),
        ("f 1/1 2/1 3/1", "there are only 0 texture coordinates"),
        ("f 1//1 2//1 3//1", "there are only 0 normals"),
        ("f 1/a 2 3", "`a` is not a whole number"),
        ("f 1///1 2 3", "is not a corner"),
        ("f /1 2 3", "is not a corner"),
        ("vt 0 0\nf 1/1 2 3", "the corners of a face must all"),
        ("mtllib ../m.mtl", "leaves the folder"),
        ("mtllib /etc/passwd", "absolute path"),
        ("mtllib", "empty"),
    ];
    for (line, what) in cases {
        let said = said(&format!("{SQUARE}{line}\n"), "");
        let number = 4 + line.lines().count();
        assert!(said.contains(&format!("m.obj: line {number}: ")) && said.contains(what), "`{line}`: {said}");
    }
    assert!(said("# nothing\n", "").contains("m.obj: the whole file: has no faces"));
}

#[test]
fn lines_of_a_library_at_fault_are_named() {
    let cases = [
        ("Kd 1", "a colour has 3 numbers, not 1"),
        ("Kd 1 2 x", "`x` is not a number"),
        ("Ke 1 2 nan", "not a finite number"),
        ("Kd 1 -2 3", "no negative number"),
        ("d", "`` is not a number"),
        ("Pm 1.5", "1.5 is out of range: type a number from 0 to 1"),
        ("Pr -1", "-1 is out of range"),
        ("Pr nan", "not a finite number"),
        ("Ni glass", "`glass` is not a number"),
        ("newmtl", "without a name"),
        ("map_Kd", "without the name of a picture"),
        ("map_Kd -s 1 1 1", "without the name of a picture"),
        ("map_Kd gone.png", "cannot find `gone.png`"),
        ("map_Kd ../gone.png", "leaves the folder"),
        ("map_Kd m.obj", "this picture cannot be decoded"),
    ];
    for (line, what) in cases {
        let said = said(&format!("mtllib m.mtl\n{SQUARE}f 1 2 3\n"), &format!("newmtl a\n{line}\n"));
        assert!(said.contains("m.mtl: line 2: ") && said.contains(what), "`{line}`: {said}");
    }
    let said = said(&format!("mtllib m.mtl\n{SQUARE}f 1 2 3\n"), "Kd 1 1 1\n");
    assert!(said.contains("m.mtl: line 1: `kd` before the first newmtl"), "{said}");
}

#[test]
fn every_line_at_fault_is_reported() {
    let said = said("v 0 0 nan\nv 0 0\nf 1 2 3\n", "");
    for line in ["line 1", "line 2", "line 3"] {
        assert!(said.contains(line), "{said}");
    }
}
