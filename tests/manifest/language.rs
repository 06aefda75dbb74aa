//! What materials, courses, shapes and surroundings mean as written.
#![expect(clippy::float_cmp, reason = "what is written exactly is kept exactly")]

use super::{close, complete, faults, values::load};
use glam::DVec3;
use std::path::Path;
use terrell::manifest::{
    Amount, Beyond, Course, GlassName, Index, Manifest, Material, MaterialKind, MetalName, Paint, Solid,
    SolidForm, Spectrum, StarOrigin,
};

fn kind<'m>(manifest: &'m Manifest, name: &str) -> &'m MaterialKind {
    &manifest.materials[name].kind
}

/// The value of a reflectance that is the same at all wavelengths.
fn grey(spectrum: &Spectrum) -> f64 {
    let Spectrum::Constant(value) = spectrum else { panic!("a constant, not {spectrum:?}") };
    *value
}

/// What `material: ..` is, of a manifest that says nothing else of it.
fn material(text: &str) -> Material {
    Material::clone(&complete(&format!("materials: {{ a: {text} }}")).materials["a"])
}

/// What is said first of a text, with its hint.
fn said(text: &str) -> String {
    let report = faults(&format!("{text}\nobserver: {{}}\noutput: out\n"));
    let fault = report.faults.first().unwrap();
    format!("{}; {}", fault.what, fault.hint)
}

#[test]
fn patterns_are_squares_and_pictures_and_have_a_size() {
    let m = load("materials.yaml");
    let MaterialKind::Diffuse(Paint::Checker { size, even, odd }) = kind(&m, "board") else { panic!() };
    assert_eq!((*size, grey(even)), (0.5, 0.9));
    assert_eq!(**odd, Spectrum::Rgb([0.2, 0.8, 0.3]));
    let MaterialKind::Diffuse(Paint::Checker { size, even, odd }) = kind(&m, "squares") else { panic!() };
    assert_eq!((*size, grey(even), grey(odd)), (1.0, 1.0, 0.0));
    let MaterialKind::Diffuse(Paint::Picture { file, size }) = kind(&m, "poster") else { panic!() };
    assert_eq!((file.value.as_path(), *size), (Path::new("tests/manifests/good/paint.png"), 2.0));
    assert!(matches!(kind(&m, "tiles"), MaterialKind::Mirror(Paint::Picture { size: 1.0, .. })));
}

#[test]
fn metals_are_smooth_unless_their_roughness_is_said() {
    let m = load("materials.yaml");
    let MaterialKind::Metal(gold) = kind(&m, "gold") else { panic!() };
    assert_eq!((gold.name, gold.roughness), (MetalName::Gold, 0.0));
    let MaterialKind::Metal(steel) = kind(&m, "steel") else { panic!() };
    assert_eq!((steel.name, steel.roughness), (MetalName::Aluminium, 0.25));
}

#[test]
fn a_gloss_has_something_below_a_coat() {
    let m = load("materials.yaml");
    let MaterialKind::Gloss(lacquer) = kind(&m, "lacquer") else { panic!() };
    assert!(matches!(&lacquer.base, Paint::Checker { odd, .. } if grey(odd) == 0.0));
    assert_eq!((lacquer.roughness, lacquer.index), (0.0, 1.7));
    let MaterialKind::Gloss(varnish) = kind(&m, "varnish") else { panic!() };
    assert_eq!((varnish.roughness, varnish.index), (0.3, 1.5));
}

#[test]
fn glass_is_a_name_or_an_index_or_a_formula() {
    let m = load("materials.yaml");
    let glass = |name: &str| match kind(&m, name) {
        MaterialKind::Glass(glass) => glass.clone(),
        other => panic!("{other:?}"),
    };
    assert!(matches!(glass("lens").index, Index::Named(GlassName::Bk7)));
    assert!(matches!(glass("plain").index, Index::Constant(1.5)));
    assert!(matches!(glass("same").index, Index::Constant(1.5)));
    assert!(matches!(glass("crown").index, Index::Cauchy([1.5046, 0.0042, 0.0])));
    assert!(matches!(glass("flat").index, Index::Cauchy([1.5, 0.0, 0.0])));
    let Index::Sellmeier(terms) = glass("flint").index else { panic!() };
    assert_eq!(terms[1], [0.313_747_346, 0.062_306_814_2]);
    assert_eq!(terms.len(), 3);
    let bottle = glass("bottle");
    assert!(matches!(bottle.index, Index::Named(GlassName::FusedSilica)) && !bottle.thin);
    let tint = bottle.color.unwrap();
    assert_eq!((&*tint.color, tint.distance), (&Spectrum::Rgb([0.2, 0.8, 0.3]), 0.01));
    assert!(glass("window").thin && glass("window").color.is_none());
}

#[test]
fn light_that_no_eye_sees_is_reflected_as_the_mean_unless_said() {
    let m = load("materials.yaml");
    let beyond = |name: &str| (m.materials[name].ultraviolet, m.materials[name].infrared);
    assert_eq!(beyond("wall"), (Beyond::Hold, Beyond::Value(0.5)));
    assert_eq!(beyond("warm"), (Beyond::Mean, Beyond::Hold));
    assert_eq!(beyond("gold"), (Beyond::Mean, Beyond::Mean));
}

#[test]
fn a_material_that_says_only_what_it_does_beyond_the_visible_is_else_the_files_own() {
    let m = load("materials.yaml");
    assert!(matches!(kind(&m, "warm"), MaterialKind::Imported));
    let eyes = &m.bodies[1].materials[1].1;
    assert!(matches!(eyes.kind, MaterialKind::Imported));
    assert_eq!(eyes.infrared, Beyond::Value(0.0));
}

#[test]
fn materials_blink_and_change_in_their_own_times() {
    let m = load("materials.yaml");
    let MaterialKind::Blinking(beacon) = kind(&m, "beacon") else { panic!() };
    assert_eq!((beacon.blinking.period, beacon.blinking.lit, beacon.blinking.start), (6.67e-9, 0.25, 1e-9));
    assert!(matches!(beacon.on.kind, MaterialKind::Emission(_)));
    assert!(matches!(beacon.off.kind, MaterialKind::Imported));
    let MaterialKind::Blinking(torch) = kind(&m, "torch") else { panic!() };
    assert_eq!((torch.blinking.period, torch.blinking.lit, torch.blinking.start), (2.0, 0.5, 0.0));
    let MaterialKind::Keys(keys) = kind(&m, "chameleon") else { panic!() };
    assert_eq!(keys.iter().map(|key| key.at).collect::<Vec<_>>(), [-1.0, 0.0, 31_557_600.0]);
    assert!(matches!(keys[1].material.kind, MaterialKind::Metal(_)));
    assert!(m.materials["torch"].changes() && m.materials["chameleon"].changes());
    assert!(!m.materials["gold"].changes());
}

#[test]
fn lights_blink_and_change_in_their_own_times() {
    let m = load("materials.yaml");
    let Course::Blinking(blinking) = &m.lights[0].course else { panic!() };
    assert_eq!((blinking.period, blinking.lit), (6.67e-9, 0.5));
    let Course::Keys(keys) = &m.lights[1].course else { panic!() };
    assert_eq!(
        keys.iter().map(|key| (key.at, key.brightness)).collect::<Vec<_>>(),
        [(0.0, 1.0), (2.0, 0.2), (3.0, 0.0)]
    );
    let spectra: Vec<_> = keys.iter().map(|key| key.spectrum.as_deref()).collect();
    assert_eq!(spectra, [None, Some(&Spectrum::BlackBody(2000.0)), None]);
    assert!(matches!(m.lights[2].course, Course::Steady));
}

#[test]
fn a_black_body_is_as_bright_as_its_temperature_says() {
    let m = load("materials.yaml");
    let glow = m.ambient.unwrap();
    let Amount::Radiometric(radiance) = glow.brightness else { panic!() };
    // Stefan and Boltzmann: 5.670374419e-8 W/m²/K⁴ (CODATA 2018), and a π for the hemisphere.
    assert!(close(radiance, 5.670_374_419e-8 * 1.6e13 / std::f64::consts::PI));
    assert_eq!(*glow.spectrum, Spectrum::BlackBody(2000.0));
    assert!(m.bodies[0].ambient.is_some() && m.bodies[1].ambient.is_none());
}

fn solid<'m>(manifest: &'m Manifest, name: &str) -> &'m Solid {
    manifest.assets[name].solid().unwrap()
}

#[test]
fn shapes_have_their_measures_and_a_place() {
    let m = load("shapes.yaml");
    assert!(matches!(&solid(&m, "ball").form, SolidForm::Sphere(ball) if ball.radius == 1.0));
    assert!(matches!(&solid(&m, "cube").form, SolidForm::Box(cube) if cube.size == DVec3::splat(2.0)));
    let slab = solid(&m, "slab");
    assert!(matches!(&slab.form, SolidForm::Box(slab) if slab.size == DVec3::new(4.0, 0.1, 2.0)));
    assert_eq!(slab.pose.at, DVec3::new(0.0, -0.05, 0.0));
    let SolidForm::Cylinder(pillar) = &solid(&m, "pillar").form else { panic!() };
    assert_eq!((pillar.radius, pillar.height), (0.3, 4.0));
    let hat = solid(&m, "hat");
    assert!(matches!(&hat.form, SolidForm::Cone(cone) if (cone.radius, cone.height) == (1.0, 2.0)));
    assert!((hat.pose.rotation * DVec3::Y - DVec3::Z).length() < 1e-15);
    assert!(m.assets.values().all(|asset| asset.file().is_none()));
}

#[test]
fn a_plane_is_a_word_with_or_without_an_empty_map() {
    let m = load("shapes.yaml");
    assert!(matches!(solid(&m, "table").form, SolidForm::Plane(_)));
    assert_eq!(solid(&m, "table").pose.at.y, 0.7);
    assert!(matches!(solid(&m, "floor").form, SolidForm::Plane(_)));
    assert!(matches!(solid(&m, "ceiling").form, SolidForm::Plane(_)));
    let SolidForm::Intersection(ground) = &solid(&m, "ground").form else { panic!() };
    assert!(matches!(ground[0].form, SolidForm::Plane(_)));
}

#[test]
fn shapes_are_made_of_shapes_in_their_order() {
    let m = load("shapes.yaml");
    let SolidForm::Difference(bowl) = &solid(&m, "bowl").form else { panic!() };
    let [all, inside, lid] = bowl.as_slice() else { panic!("three") };
    assert!(matches!(&all.form, SolidForm::Union(parts) if parts.len() == 2));
    assert!(matches!(&inside.form, SolidForm::Sphere(_)));
    assert_eq!(lid.pose.at, DVec3::new(0.0, 1.5, 0.0));
    assert!(matches!(&solid(&m, "lens").form, SolidForm::Intersection(parts) if parts.len() == 2));
}

#[test]
fn shapes_of_up_to_a_thousand_shapes_are_read() {
    let shape = |count: usize| format!("assets: {{ a: {{ union: [{}] }} }}", vec!["plane"; count].join(", "));
    complete(&format!("{}\nbodies: [{{ asset: a }}]", shape(999)));
    assert!(said(&shape(1000)).starts_with("a shape made of 1001 shapes; 1000 are the most"));
}

#[test]
fn shapes_within_one_another_are_read_up_to_sixteen_deep() {
    let shape = |levels: usize| {
        format!("assets: {{ a: {}plane{} }}", "{ union: [".repeat(levels - 1), "] }".repeat(levels - 1))
    };
    complete(&shape(16));
    assert!(said(&shape(17)).starts_with("shapes within one another 17 deep; 16 are the most"));
}

#[test]
fn surroundings_are_one_or_a_list_each_in_its_own_frame() {
    let m = load("sky.yaml");
    let [near, moving, fast] = m.surroundings.as_slice() else { panic!("three") };
    assert!(near.uniform.is_some() && near.stars.is_none());
    let picture = near.picture.as_ref().unwrap();
    assert_eq!(picture.file.value, Path::new("tests/manifests/good/paint.png"));
    assert_eq!((picture.luminance, near.velocity.gamma()), (50.0, 1.0));
    assert!((near.rotation * DVec3::Z).x > 0.49);
    assert!(close(moving.velocity.beta().z, 0.5) && close(fast.velocity.gamma(), 2.0));
    assert_eq!(fast.picture.as_ref().unwrap().luminance, 100.0);
    let one = complete("surroundings: { uniform: { black_body: 2.725 K } }");
    assert_eq!(one.surroundings.len(), 1);
    assert!(complete("").surroundings.is_empty());
}

#[test]
fn stars_are_made_up_or_those_of_a_catalogue() {
    let m = load("sky.yaml");
    let stars = m.surroundings[1].stars.as_ref().unwrap();
    let StarOrigin::Seeded { seed, count, faintest, temperature, magnitude } = &stars.origin else {
        panic!()
    };
    assert_eq!((*seed, *count, *faintest), (7, 5000, 8.0));
    assert_eq!((*temperature, *magnitude, stars.brightness), (Some(5800.0), None, 3.0));
    let stars = m.surroundings[2].stars.as_ref().unwrap();
    let StarOrigin::Catalogue(catalogue) = &stars.origin else { panic!() };
    assert_eq!(catalogue.value, Path::new("tests/manifests/good/stars.csv"));
    let plain = complete("surroundings: { stars: { count: 3 } }");
    let stars = plain.surroundings[0].stars.as_ref().unwrap();
    assert!(matches!(stars.origin, StarOrigin::Seeded { seed: 1, faintest: 6.5, .. }));
    assert_eq!((stars.brightness, stars.radius), (1.0, None));
    let discs = complete("surroundings: { stars: { count: 3, temperature: 5800 K, radius: 0.5 deg } }");
    assert_eq!(discs.surroundings[0].stars.as_ref().unwrap().radius, Some(0.5_f64.to_radians()));
}

#[test]
fn formulas_that_give_no_glass_are_refused() {
    let said = |formula: &str| said(&format!("materials: {{ a: {{ glass: {{ {formula} }} }} }}"));
    assert!(said("cauchy: 0.9").starts_with("by this formula the index of refraction at 380 nm is 0.900"));
    assert!(
        said("cauchy: 1.5 4200").starts_with("by this formula the index of refraction at 380 nm is 29087")
    );
    assert!(said("sellmeier: [[1, 0.25]]").contains("a resonance in the midst of the visible, at 500 nm"));
    assert!(said("sellmeier: [[-3, 0.006]]").starts_with("by this formula there is no index of refraction"));
}

#[test]
fn numbers_at_the_ends_of_their_ranges_are_accepted() {
    material("{ blinking: { period: 1 s, lit: 0, on: mirror, off: mirror } }");
    material("{ blinking: { period: 1 s, lit: 1, on: mirror, off: mirror } }");
    material("{ metal: silver, roughness: 1 }");
    material("{ glass: 1 }");
    material("{ diffuse: 0.5, ultraviolet: 0, infrared: 1 }");
}

#[test]
fn names_that_are_nearly_right_are_recognised() {
    assert!(said("materials: { a: { glass: bk7 } }").contains("glass: BK7"));
    assert!(said("materials: { a: { metal: aluminum } }").contains("metal: aluminium"));
    assert!(
        said("materials: { a: { diffuse: { cheker: { even: 1, odd: 0 } } } }")
            .contains("did you mean `checker`?")
    );
    assert!(said("assets: { a: { shpere: { radius: 1 m } } }").contains("did you mean `sphere`?"));
    assert!(said("surroundings: { star: { count: 3 } }").contains("did you mean `stars`?"));
}

#[test]
fn materials_that_change_cannot_multiply_by_names() {
    let mut text = "materials:\n  a0: mirror\n".to_owned();
    for i in 1..60 {
        text.push_str(&format!("  a{i}: {{ blinking: {{ period: 1 s, on: a{0}, off: a{0} }} }}\n", i - 1));
    }
    assert!(said(&text).starts_with("a material that changes cannot be part of another that does"));
}
