//! Closed rooms in which everything has the same radiance.

use crate::support::{
    Body, Dice, Eye, Stage, beta, black_body, built, close, cube, diffuse, flat, icosphere, look, picture, v,
};
use terrell::spectrum::{Wavelengths, planck};

#[test]
fn white_surface_in_even_light_shows_that_light() {
    let ball = Body::new(&built(icosphere(3)), diffuse(1.0)).at(0.0, v(0.3, -0.2, -4.0));
    let mut stage = Stage::of([ball]);
    stage.ambient = Some(flat(3.5));
    let scene = stage.scene();
    let ray = Eye::at(0.0, v(0.0, 0.0, 0.0)).sight(v(0.4, -0.1, -4.0));
    for value in look(&scene, &ray).radiance {
        close(value, 3.5, 1e-15);
    }
    let (_, negative) = picture(&scene, 32, 32);
    let middle = negative.xyz[16 * 32 + 17];
    let expected = Wavelengths::<8>::new().xyz(&[3.5; 8]);
    close(f64::from(middle[1]), expected.y, 1e-6);
}

#[test]
fn grey_surface_shows_its_part() {
    let ball = Body::new(&built(icosphere(3)), diffuse(0.25)).at(0.0, v(0.0, 0.0, -4.0));
    let mut stage = Stage::of([ball]);
    stage.ambient = Some(flat(8.0));
    for value in look(&stage.scene(), &Eye::at(0.0, v(0.0, 0.0, 0.0)).sight(v(0.1, 0.0, -1.0))).radiance {
        close(value, 2.0, 1e-15);
    }
}

/// Ambient light fills the body's own rest frame: a moving furnace is a black body at DT all over.
#[test]
fn boosted_furnace_is_still_planck() {
    let velocity = beta(0.5, -0.6, 0.3);
    let room = Body::new(&built(cube()), diffuse(1.0)).moving(velocity);
    let mut stage = Stage::of([room]);
    stage.ambient = Some(black_body(5000.0));
    let scene = stage.scene();
    let mut dice = Dice(5);
    for _ in 0..50 {
        let n = dice.direction();
        let light = look(&scene, &Eye::at(0.0, v(0.0, 0.0, 0.0)).sight(n));
        // The room moves, the light comes from n.
        let doppler = 1.0 / (velocity.gamma() * (1.0 + velocity.beta().dot(n)));
        for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(light.radiance) {
            close(got, planck(*nm, 5000.0 * doppler), 1e-11 / doppler);
        }
    }
}
