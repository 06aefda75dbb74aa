//! Effects switched off: exactly that factor is one, and nothing else changes.

use crate::support::{
    Body, Eye, Lantern, Stage, angle, beta, black_body, built, close, diffuse, flat, glowing, icosphere,
    light_to, look, near, speed, square, v,
};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;
use terrell::observer::Unaberrated;
use terrell::spacetime::{Boost, Event, Lab, Rest, Velocity};
use terrell::spectrum::{Wavelengths, planck};
use terrell::trace::Effects;

const FORWARD: DVec3 = v(1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0);

fn doppler(beta: f64, n: DVec3) -> f64 {
    (1.0 - beta * beta).sqrt() / (1.0 - beta * n.dot(FORWARD))
}

#[test]
fn glow_loses_exactly_the_effect_that_is_switched_off() {
    let sky = Body::new(&built(icosphere(2)), glowing(black_body(5000.0))).sized(40.0);
    let eye = Eye::at(0.0, DVec3::ZERO).moving(speed(0.6, FORWARD));
    for (shifted, brighter) in [(true, true), (false, true), (true, false), (false, false)] {
        let mut stage = Stage::of([sky.clone()]);
        stage.effects = Effects { doppler: shifted, searchlight: brighter, ..Effects::ALL };
        let scene = stage.seen_by(&eye);
        for n in [FORWARD, v(0.0, 0.6, 0.8), v(-0.8, 0.0, 0.6)] {
            let d = doppler(0.6, n);
            let wavelength = if shifted { d } else { 1.0 };
            let gain = if brighter { d.powi(5) } else { 1.0 };
            for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &eye.sight(n)).radiance) {
                close(got, gain * planck(nm * wavelength, 5000.0), 1e-11);
            }
        }
    }
}

/// Lamp to surface as well: the patch stands still before the eye, the lamp moves.
#[test]
fn lamplight_loses_exactly_the_effect_that_is_switched_off() {
    let patch = Body::new(&built(square()), diffuse(1.0)).facing(v(0.0, 0.0, 1.0));
    let lamp = Lantern::at(-4.0, v(0.0, 0.0, 4.0), black_body(4000.0)).moving(beta(0.0, 0.0, -0.6));
    for (shifted, brighter) in [(true, true), (false, true), (true, false), (false, false)] {
        let mut stage = Stage::of([patch.clone()]).lit_by([lamp.clone()]);
        stage.effects = Effects { doppler: shifted, searchlight: brighter, ..Effects::ALL };
        let light = look(&stage.scene(), &light_to(v(0.3, 0.1, 1.0), Event::ORIGIN));
        // Approaching at 0.6: D = 2; 4 m in the lab from the event of emission, and r' = r/D = 2 m in the lamp's frame.
        let (d, r_rest) = (2.0_f64, 2.0);
        let wavelength = if shifted { d } else { 1.0 };
        let gain = if brighter { d.powi(3) } else { 1.0 };
        for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(light.radiance) {
            close(got * PI, gain * planck(nm * wavelength, 4000.0) / (r_rest * r_rest), 1e-10);
        }
    }
}

/// With aberration off directions are those of a camera that stands still beside the bodies; colours and brightness
/// are still the moving observer's.
#[test]
fn without_aberration_things_stay_in_their_places_and_keep_their_colours() {
    let velocity = speed(0.8, FORWARD);
    let sky = Body::new(&built(icosphere(2)), glowing(black_body(5000.0))).sized(40.0);
    let mut stage = Stage::of([sky]);
    stage.effects.aberration = false;
    let eye = Eye::at(0.0, DVec3::ZERO).moving(velocity).toward(v(0.2, 0.1, -1.0)).wide(80.0);
    let mut scene = stage.seen_by(&eye);
    let rest_from_lab = Boost::<Rest, Lab>::to_moving(Velocity::REST);
    scene.observer.unaberrated = Some(Unaberrated { rest_from_lab, rotation: DQuat::IDENTITY });
    let still = Eye::at(0.0, DVec3::ZERO).toward(v(0.2, 0.1, -1.0)).wide(80.0).observer().view(0.0, 64, 48);
    let view = scene.observer.view(0.0, 64, 48);
    for pixel in [(3.0, 5.0), (40.0, 20.0), (63.0, 47.0)] {
        let (ray, plain) = (view.ray(pixel.into()), still.ray(pixel.into()));
        near(angle(ray.k.x, plain.k.x), 0.0, 1e-14);
        // The light's true D for this observer.
        let n = -plain.k.x / plain.k.x.length();
        let d = velocity.gamma() * (1.0 + velocity.beta().dot(n));
        close(scene.lit().first(&ray).unwrap().doppler.factor(), d, 1e-12);
        for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &ray).radiance) {
            close(got, planck(*nm, 5000.0 * d), 1e-10);
        }
        let back = view.pixel_of(ray.k).unwrap();
        near(back.distance(pixel.into()), 0.0, 1e-10);
    }
    // At rest nothing of all this makes a difference.
    let ball = Body::new(&built(icosphere(2)), glowing(flat(2.0))).at(0.0, v(0.0, 0.0, -4.0));
    let mut off = Stage::of([ball]);
    let ray = Eye::at(0.0, DVec3::ZERO).sight(v(0.05, 0.0, -1.0));
    let on = look(&off.scene(), &ray).radiance;
    off.effects = Effects { aberration: false, doppler: false, searchlight: false };
    assert!(on.iter().zip(look(&off.scene(), &ray).radiance).all(|(a, b)| a.to_bits() == b.to_bits()));
}
