//! Fill light of a body's own rest frame, and what colours mean in the ultraviolet and in the infrared.

use crate::support::{
    Body, Dice, Lantern, Stage, ball, black, black_body, blinking, close, diffuse, flat, frequency, glowing,
    light_at_rest, look, mixed, near, v,
};
use glam::{DAffine2, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;
use terrell::course::Course;
use terrell::spacetime::{Event, Poincare, Rest, SightRay, Velocity};
use terrell::spectrum::{Beyond, End, Reflectance, Table, Wavelengths, planck};
use terrell::surface::{Colors, Glow, Paint, Scatter, Surface};
use terrell::texture::{Encoding, Filter, Picture, Texels, Texture, Wrap};

/// A ball of radius 1 that moves, seen at the point with the normal `normal` by an eye above that point in its frame.
fn onto(moves: Velocity, normal: DVec3) -> SightRay {
    let into: Poincare<Rest> = Poincare::to_moving(moves, Event::ORIGIN);
    let ray = light_at_rest(&into, normal, Event::new(2.0, 3.0 * normal));
    SightRay { k: ray.k * (1.0 / ray.k.t), ..ray }
}

fn round(surface: Surface) -> Body {
    Body::of(ball(1.0, DVec3::ZERO), surface)
}

#[test]
fn fill_light_is_even_in_the_rest_frame_of_each_body() {
    let mut dice = Dice(100);
    for _ in 0..50 {
        let b = dice.between(0.0, 0.95);
        let (moves, normal) = (dice.velocity(b), dice.direction());
        let mut stage = Stage::of([round(diffuse(0.7)).moving(moves)]);
        stage.ambient = Some(black_body(5000.0));
        let ray = onto(moves, normal);
        let omega = frequency(moves, ray.k.x);
        for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(look(&stage.scene(), &ray).radiance) {
            let expected = 0.7 * planck(*nm, 5000.0 / omega);
            near(value, expected, 1e-9 * expected);
        }
    }
}

#[test]
fn own_fill_light_of_a_body_replaces_the_general_one() {
    let moves = crate::support::beta(0.3, 0.4, 0.0);
    let far = |body: Body, x: f64| body.at(0.0, v(x, 0.0, 0.0)).moving(moves);
    let dark = round(diffuse(0.5)).in_ambient(flat(0.0));
    let blue = round(diffuse(0.5)).in_ambient(flat(3.0));
    let both = mixed([(blinking(2.0, 0.5, 0.0), diffuse(0.5)), (Course::Steady, black())]);
    let mut stage = Stage::of([
        far(round(diffuse(0.5)), 0.0),
        far(dark, 9.0),
        far(blue, 18.0),
        far(round(both).in_ambient(flat(5.0)), 27.0),
    ]);
    stage.ambient = Some(flat(2.0));
    let scene = stage.scene();
    for (number, expected) in [1.0, 0.0, 1.5, 2.5].into_iter().enumerate() {
        let into: Poincare<Rest> = stage.bodies[number].placement.rest_from_lab();
        let ray = light_at_rest(&into, DVec3::Y, Event::new(2.5, 3.0 * DVec3::Y));
        let ray = SightRay { k: ray.k * (1.0 / ray.k.t), ..ray };
        let omega = frequency(moves, ray.k.x);
        near(look(&scene, &ray).radiance[9] * omega.powi(5), expected, 1e-12);
    }
}

const RGB: [f32; 3] = [0.9, 0.3, 0.06];

fn coloured(beyond: Beyond, textured: bool) -> Paint {
    let texture = textured.then(|| {
        let [r, g, b] = RGB;
        let texels = Texels::Float(vec![[r, g, b, 1.0]; 16]);
        Texture {
            picture: Arc::new(Picture::new(4, 4, texels, Encoding::Linear)),
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Linear,
            uv_set: 0,
            transform: DAffine2::IDENTITY,
        }
    });
    let color = if textured { [1.0; 3] } else { RGB };
    Paint::Colors(Colors { color, texture, vertex_colors: false, beyond })
}

/// What is seen of a painted ball at each wavelength, brought back to its own frame, when it approaches or recedes
/// straight at `b`: shone upon by a lamp at rest with it, glowing, and in its own fill light.
fn in_its_frame(paint: &Paint, b: f64) -> Vec<[f64; 64]> {
    let moves = crate::support::speed(b.abs(), DVec3::Z * b.signum());
    let ray = onto(moves, DVec3::Z);
    let omega = frequency(moves, ray.k.x);
    let back = |stage: Stage| look(&stage.scene(), &ray).radiance.map(|value| value * omega.powi(5));
    let surface = || Surface::new(Scatter::Diffuse(paint.clone()));
    // The lamp passes (0, 0, 4) of the ball's frame, 3 m from the surface.
    let into: Poincare<Rest> = Poincare::to_moving(moves, Event::ORIGIN);
    let lamp = into.undo(Event::new(0.0, v(0.0, 0.0, 4.0)));
    let lamp = Lantern::at(lamp.t, lamp.x, flat(9.0 * PI)).moving(moves);
    let glow = Surface::glowing(Glow { radiance: flat(1.0), paint: Some(paint.clone()) });
    vec![
        back(Stage::of([round(surface()).moving(moves)]).lit_by([lamp])),
        back(Stage::of([round(glow).moving(moves)])),
        back(Stage::of([round(surface()).in_ambient(flat(1.0)).moving(moves)])),
    ]
}

/// At 0.9 c what is seen in the visible was infrared (approaching) or ultraviolet (receding).
#[test]
fn colour_beyond_the_visible_is_what_it_is_said_to_be() {
    let rgb = RGB.map(f64::from);
    let mean = (rgb[0] + rgb[1] + rgb[2]) / 3.0;
    let held = |nm: f64| Reflectance::Rgb(rgb).at(nm);
    for textured in [false, true] {
        for (b, edge_nm, approaching) in [(0.9, 700.0, true), (-0.9, 400.0, false)] {
            for (end, expected) in [(End::Mean, mean), (End::Hold, held(edge_nm)), (End::Value(0.42), 0.42)] {
                // The other end says something else, which is not to be seen.
                let other = End::Value(0.77);
                let beyond = if approaching {
                    Beyond { ultraviolet: other, infrared: end }
                } else {
                    Beyond { ultraviolet: end, infrared: other }
                };
                let seen = in_its_frame(&coloured(beyond, textured), b);
                seen.as_flattened().iter().for_each(|value| close(*value, expected, 1e-6));
            }
        }
        // At rest it is the colour, whatever is said of the rest.
        for beyond in [Beyond::MEAN, Beyond { ultraviolet: End::Hold, infrared: End::Value(1.0) }] {
            for seen in in_its_frame(&coloured(beyond, textured), 0.0) {
                for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(seen) {
                    close(value, held(*nm), 1e-6);
                }
            }
        }
    }
}

#[test]
fn measured_reflectance_is_asked_at_the_wavelength_in_the_bodys_frame() {
    let rows = [(90.0, 0.1), (150.0, 0.3), (400.0, 0.5), (700.0, 0.2), (1700.0, 0.9), (3000.0, 0.4)];
    let by_hand = |nm: f64| {
        let after = rows.iter().position(|(at, _)| *at >= nm).unwrap();
        let ((a, p), (b, q)) = (rows[after - 1], rows[after]);
        p + (q - p) * (nm - a) / (b - a)
    };
    let paint = Paint::Even(Reflectance::Table(Table::new(rows).unwrap()));
    for b in [0.9, -0.9, 0.5, 0.0_f64] {
        let doppler = ((1.0 + b) / (1.0 - b)).sqrt();
        for seen in in_its_frame(&paint, b) {
            for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(seen) {
                if (91.0..2999.0).contains(&(nm * doppler)) {
                    close(value, by_hand(nm * doppler), 1e-9);
                }
            }
        }
    }
}

/// Between the visible and what is beyond it the reflectance goes over without a step.
#[test]
fn colour_goes_over_into_what_is_beyond_without_a_step() {
    let beyond = Beyond { ultraviolet: End::Value(0.0), infrared: End::Value(1.0) };
    let rgb = RGB.map(f64::from);
    let reflectance = Reflectance::Extended { rgb, beyond };
    for i in 0..6000 {
        let nm = 330.0 + 0.1 * f64::from(i);
        let (a, b) = (reflectance.at(nm), reflectance.at(nm + 0.1));
        assert!((a - b).abs() < 0.01, "{nm}: {a} {b}");
    }
    near(reflectance.at(359.9), 0.0, 1e-12);
    near(reflectance.at(740.1), 1.0, 1e-12);
}

/// Fill light and glow of one surface add up, each in the body's frame.
#[test]
fn glow_and_fill_light_add_up() {
    let (mut dice, normal) = (Dice(101), v(0.6, 0.0, 0.8));
    let moves = dice.velocity(0.7);
    let surface = Surface { glow: glowing(flat(2.0)).glow, ..diffuse(0.5) };
    let mut stage = Stage::of([round(surface).moving(moves)]);
    stage.ambient = Some(flat(3.0));
    let ray = onto(moves, normal);
    let omega = frequency(moves, ray.k.x);
    near(look(&stage.scene(), &ray).radiance[3] * omega.powi(5), 3.5, 1e-10);
}
