//! The floor before the gate.

use super::{Exhibit, Pinhole, aberrated};
use crate::support::v;
use glam::DVec3;

/// Around each corner of the squares that is seen: the four squares that meet there are seen around the direction of the closed
/// form, a thousandth of a millimetre from it on the floor.
#[test]
fn corners_of_the_squares_are_seen_where_aberration_puts_them() {
    const WIDTH: u32 = 400;
    let exhibit = Exhibit::of("gate_1");
    let (view, pinhole) = (exhibit.view(0, WIDTH), Pinhole::toward(DVec3::Z, WIDTH));
    let (eye, beta) = (v(0.0, 2.0, -9.50001), v(0.0, 0.0, 0.8));
    let brightness = |place: DVec3| {
        let pixel = pinhole.pixel(aberrated((place - eye).normalize(), beta))?;
        let ray = view.ray(pixel);
        (exhibit.body(&ray) == Some(0)).then(|| exhibit.luminance(&ray))
    };
    let (mut corners, mut beside) = (0, 0);
    for (x, z) in (-9..=9).flat_map(|x| (-9..=9).map(move |z| (f64::from(x), f64::from(z)))) {
        let square = |dx: f64, dz: f64| brightness(v(x + 1e-6 * dx, 0.0, z + 1e-6 * dz));
        let four = [square(1.0, 1.0), square(-1.0, -1.0), square(1.0, -1.0), square(-1.0, 1.0)];
        let [Some(a), Some(b), Some(c), Some(d)] = four else { continue };
        // Whole numbers with an even sum begin a white square, of 1 against 0.02.
        let (white, black) = if (x + z) % 2.0 == 0.0 { ([a, b], [c, d]) } else { ([c, d], [a, b]) };
        assert!(white[0].min(white[1]) > 10.0 * black[0].max(black[1]), "({x}, {z}): {four:?}");
        corners += 1;
        // A line across our way is no line in the picture: the middle of two corners is not between them.
        let seen = |x: f64| pinhole.pixel(aberrated((v(x, 0.0, z) - eye).normalize(), beta));
        if let (Some(left), Some(middle), Some(right)) = (seen(x - 4.0), seen(x), seen(x + 4.0)) {
            let chord = (right - left).normalize();
            beside += u32::from(chord.perp_dot(middle - left).abs() > 1.0);
        }
    }
    assert!(corners > 150 && beside > 50, "{corners} {beside}");
}

/// Each model is seen where its manifest means it to be, with D = 1/(γ(1 - β·n)) for the way n of its light to the eye.
#[test]
fn models_fly_through_the_gate_where_they_are_seen() {
    let exhibit = Exhibit::of("gate_models");
    let tetrad = exhibit.scene.observer.worldline.at(exhibit.plan.exposures[0].tau);
    let eye = v(0.0, 2.4, -9.5);
    for (name, at, beta) in [
        ("near", v(1.9, 1.7, -1.0), -0.5),
        ("behind", v(-2.2, 3.2, 4.0), -0.5),
        ("far", v(0.6, 4.4, 12.0), -0.5),
        ("coming_die", v(-1.1, 1.2, -3.5), -0.5),
        ("going", v(-3.4, 1.5, 0.5), 0.5),
        ("going_die", v(3.4, 4.2, 0.0), 0.5),
    ] {
        let n = (eye - at).normalize();
        let first = exhibit.scene.lit().first(&tetrad.sight_ray(-n)).unwrap();
        assert_eq!(exhibit.manifest.bodies[first.body as usize].known_as(), name);
        // Its surface is before its middle, by no more than its own size.
        let far = (eye - at).length();
        assert!((first.s - far).abs() < 1.5, "{name}: {} m for {far} m", first.s);
        let doppler = 0.75_f64.sqrt() / (1.0 - beta * n.z);
        assert!(
            (first.doppler.factor() - doppler).abs() < 1e-9,
            "{name}: {} for {doppler}",
            first.doppler.factor()
        );
    }
}
