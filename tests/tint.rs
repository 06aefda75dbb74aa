//! Colours of surfaces belong to their own rest frames: a reflectance is asked at the wavelength that the light has
//! there.

use crate::support::{
    Body, Eye, Lantern, Stage, beta, built, close, flat, glowing, icosphere, light_to, line, look,
    near_vector, square, v,
};
use glam::DVec3;
use std::f64::consts::PI;
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::spacetime::{Event, Velocity};
use terrell::spectrum::{Reflectance, Table, Wavelengths};
use terrell::surface::{Paint, Scatter, Surface};

/// 0.2 at 200 nm, rising to 0.9 at 1600 nm.
fn tint() -> Table {
    Table::new([(200.0, 0.2), (1600.0, 0.9)]).unwrap()
}

fn part(nm: f64) -> f64 {
    0.2 + 0.7 * (nm - 200.0) / 1400.0
}

fn tinted(scatter: impl Fn(Paint) -> Scatter) -> Surface {
    Surface::new(scatter(Paint::Even(Reflectance::Table(tint()))))
}

/// Frequency at what moves, of light that goes along `n` in the lab.
fn frequency(velocity: Velocity, n: DVec3) -> f64 {
    velocity.gamma() * (1.0 - velocity.beta().dot(n))
}

/// A tinted plate at the origin that moves, the light that leaves it for z, and its frequency there.
fn plate(scatter: impl Fn(Paint) -> Scatter) -> (Body, terrell::spacetime::SightRay, f64) {
    let velocity = beta(0.3, 0.2, 0.4);
    let ray = light_to(v(0.3, -0.2, 1.0), Event::ORIGIN);
    let omega = frequency(velocity, ray.k.x);
    (Body::new(&built(square()), tinted(scatter)).sized(5.0).moving(velocity), ray, omega)
}

#[test]
fn moving_tinted_surface_reflects_by_the_wavelength_of_its_own_frame() {
    let (body, ray, omega) = plate(Scatter::Diffuse);
    let mut stage = Stage::of([body]);
    stage.ambient = Some(flat(3.0));
    for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&stage.scene(), &ray).radiance) {
        close(got, 3.0 * part(nm / omega) * omega.powi(-5), 1e-12);
    }
    // A line of the ambient light: at λω, by the reflectance at λ.
    let nm = 550.0 / omega;
    stage.ambient = Some(line(nm, 3.0));
    let expected = matching(nm * omega) * (LUMENS_PER_WATT * 3.0 * part(nm) * omega.powi(-4));
    assert!(expected.y > 0.0);
    near_vector(look(&stage.scene(), &ray).lines, expected, 1e-12 * expected.length());
}

/// Three wavelengths: the lamp's own, the surface's, and the eye's.
#[test]
fn lamplight_on_a_moving_tinted_surface_has_a_wavelength_at_each_end() {
    let (body, ray, omega) = plate(Scatter::Diffuse);
    let lamp = |source| Lantern::at(0.0, v(1.0, 2.0, 4.0), source);
    let n = v(-1.0, -2.0, -4.0) / 21.0_f64.sqrt();
    let velocity = body.placement.velocity;
    let doppler = frequency(velocity, n);
    // The cosine at the plate, from n in its rest frame; its normal is z.
    let (u, gamma) = (velocity.proper(), velocity.gamma());
    let cosine = -(n + u * (u.dot(n) / (gamma + 1.0) - 1.0)).z / doppler;
    let dilution = cosine / 21.0 / PI;
    let scene = Stage::of([body.clone()]).lit_by([lamp(flat(2.0))]).scene();
    for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &ray).radiance) {
        close(got, 2.0 * doppler.powi(3) * dilution * part(nm / omega) * omega.powi(-5), 1e-11);
    }
    let nm = 550.0 * doppler / omega;
    let scene = Stage::of([body]).lit_by([lamp(line(nm, 2.0))]).scene();
    let at_plate = nm / doppler;
    let expected = matching(at_plate * omega)
        * (LUMENS_PER_WATT * 2.0 * doppler.powi(2) * dilution * part(at_plate) * omega.powi(-4));
    assert!(expected.y > 0.0);
    near_vector(look(&scene, &ray).lines, expected, 1e-10 * expected.length());
}

/// Also where light only passes: on its way over two tinted mirrors that move.
#[test]
fn mirrors_tint_by_the_wavelength_of_their_own_frames() {
    // Sliding in their own planes they change no frequency: what is seen is the sky's light, tinted twice.
    let slides = [beta(0.6, 0.0, 0.0), beta(-0.5, 0.0, 0.3)];
    let surface = tinted(Scatter::Mirror);
    let bodies = [1.0, -1.0].iter().zip(slides).map(|(y, slide)| {
        Body::new(&built(square()), surface.clone())
            .sized(200.0)
            .facing(v(0.0, -y, 0.0))
            .at(0.0, v(0.0, *y, 0.0))
            .moving(slide)
    });
    // A wall ends the way after the second mirror.
    let sky = Body::new(&built(icosphere(3)), glowing(flat(1.0))).sized(4.0).at(0.0, v(0.0, 0.0, -10.5));
    let lines = Body { surface: glowing(line(570.0, 1.0)), ..sky.clone() };
    let bodies: Vec<Body> = bodies.collect();
    let ray = Eye::at(0.0, DVec3::ZERO).sight(v(0.1, 1.0, -1.5));
    // Before the first mirror met (above) the light goes down and on; in the lab always with frequency 1.
    let n = v(0.1, 1.0, -1.5) / v(0.1, 1.0, -1.5).length();
    let above = frequency(slides[0], -n);
    let below = frequency(slides[1], -v(n.x, -n.y, n.z));
    assert!((above - 1.0).abs() > 0.02 && (below - 1.0).abs() > 0.02);
    let with = |sky: Body| look(&Stage::of(bodies.iter().cloned().chain([sky])).scene(), &ray);
    for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(with(sky).radiance) {
        close(got, part(nm / above) * part(nm / below), 1e-12);
    }
    let expected = matching(570.0) * (LUMENS_PER_WATT * part(570.0 / above) * part(570.0 / below));
    near_vector(with(lines).lines, expected, 1e-12 * expected.length());
}
