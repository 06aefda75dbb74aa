//! What is easily lost in glass: lines that come by several ways, narrow things, colours of panes.

use crate::light_equivalence::{SIZE, noise};
use crate::lines::{SODIUM, any};
use crate::lines_in_glass::{rays_to_the_ball, same_with_hardly_dispersive_glass, slits, through_prism};
use crate::support::{
    Body, Dice, Eye, Heaven, Lantern, Stage, along, ball, beta, built, close, cuboid, difference, diffuse,
    exposed, flat, frequency, glass, glowing, light_from, light_to, line, look, near_vector, pane, plane,
    square, v,
};
use glam::{DQuat, DVec3};
use terrell::fresnel;
use terrell::spacetime::Event;
use terrell::spectrum::{Index, Reflectance, Table, Wavelengths};
use terrell::surface::{Paint, Scatter};
use terrell::surroundings::Star;

/// Light that leaves by one face and light that is reflected within and leaves by another come from different directions,
/// and from a moving sky with different wavelengths: all of it is seen.
#[test]
fn hardly_dispersive_ball_shows_moving_sodium_light_as_one_without_dispersion() {
    let stage = |index: Index| {
        let body = Body::of(ball(1.0, DVec3::ZERO), glass()).filled(index);
        let sky = Heaven::uniform(line(SODIUM, 1.0)).moving(beta(0.15, 0.1, 0.0));
        Stage::of([body]).under(sky)
    };
    same_with_hardly_dispersive_glass(stage, &rays_to_the_ball(594, 12));
}

/// Two bodies that move differently, lit by the same sodium lamp: one behind the glass, one mirrored in it.
#[test]
fn one_lamp_on_two_bodies_seen_through_glass_gives_two_lines() {
    let wall = |x: f64, b: f64| -> Body {
        let facing = v(-x, 0.0, 0.0);
        let body = Body::of(plane(v(x, 0.0, 0.0), facing), diffuse(0.8));
        body.moving(beta(0.0, b, 0.0))
    };
    let stage = |index: Index| {
        let plate = cuboid(v(-0.2, -5.0, -5.0), v(0.2, 5.0, 5.0));
        let plate = Body::of(plate, glass()).filled(index);
        let lamp = Lantern::at(0.0, v(0.0, 8.0, 0.0), line(SODIUM, 1.0));
        let mut stage = Stage::of([plate, wall(4.0, 0.2), wall(-4.0, -0.2)]).lit_by([lamp]);
        stage.depth = 6;
        stage
    };
    let ray = light_from(DVec3::ZERO, Event::new(0.0, v(-3.0, 1.0, 0.5)));
    same_with_hardly_dispersive_glass(stage, &[ray]);
}

/// However narrow the slit: at the place where its light arrives it is seen.
#[test]
fn narrow_slit_that_moves_is_seen_through_a_prism() {
    for (prism, moves) in slits() {
        let (scene, ray, expected) = through_prism(prism, moves, 1e-4, 0.0);
        near_vector(any(&scene, &ray, 1e-7), expected, 1e-6 * expected.length());
    }
}

/// A coloured pane that moves takes the same of a lamp's light on its way to a wall as of the wall's light on its way to
/// the eye.
#[test]
fn coloured_pane_takes_as_much_of_a_lamps_light_as_of_the_view() {
    let (mut dice, mut seen) = (Dice(595), 0);
    let tint = Table::new([(200.0, 0.2), (1600.0, 0.9)]).unwrap();
    let mut surface = pane(Index::Constant(1.5));
    if let Scatter::Glass(glass) = &mut surface.scatter {
        glass.color = Some(Paint::Even(Reflectance::Table(tint.clone())));
    }
    while seen < 40 {
        let b = dice.between(0.0, 0.6);
        let moves = dice.velocity(b);
        let n = dice.direction();
        let normal = dice.direction();
        let cosine = along(moves, n).dot(normal).abs();
        if cosine < 0.2 {
            continue;
        }
        seen += 1;
        let omega = frequency(moves, n);
        let through = |nm: f64| tint.at(nm / omega) * (1.0 - fresnel::dielectric(cosine, 1.5));
        let plate = Body::new(&built(square()), surface.clone()).sized(30.0).facing(normal).moving(moves);
        // The view: light along n from a thing behind the pane, which it passes at the origin.
        let wall = Body::of(ball(0.5, n * -4.0), glowing(flat(1.0)));
        let ray = light_from(DVec3::ZERO, Event::new(2.0, n * 2.0));
        let view = look(&Stage::of([plate.clone(), wall]).scene(), &ray).radiance;
        // The lamp: along n too, to a white floor 2 m behind, which is seen from aside.
        let lamp = Lantern::at(0.0, n * -3.0, flat(1.0));
        let white = Body::of(plane(n * 0.5, -n), diffuse(1.0));
        let event = Event::new(0.5, n * 0.5);
        let eye = light_to(event.x - n * 1e-3, event);
        let bare = look(&Stage::of([white.clone()]).lit_by([lamp.clone()]).scene(), &eye).radiance;
        let lit = look(&Stage::of([plate, white]).lit_by([lamp]).scene(), &eye).radiance;
        for (i, nm) in Wavelengths::<64>::new().nm.iter().enumerate() {
            close(view[i], through(*nm), 1e-9);
            close(lit[i] / bare[i], through(*nm), 1e-9);
        }
    }
}

/// Two bodies as large as each other that overlap around the eye: which of them it is in does not depend on their order.
#[test]
fn order_of_equal_bodies_around_the_eye_changes_nothing() {
    let body = |x: f64, n: f64| Body::of(ball(2.0, v(x, 0.0, 0.0)), glass()).filled(Index::Constant(n));
    let sky = || {
        let star = Star { direction: v(0.2, 0.1, -1.0), kelvin: 6000.0, illuminance: 0.1 };
        let mut sky = Heaven::stars([star]);
        sky.picture = Some((noise(&mut Dice(3), 16, 8), 10.0, DQuat::IDENTITY));
        sky
    };
    let eye = Eye::at(0.0, v(0.1, 0.2, 0.3)).wide(60.0);
    let seen = |bodies: [Body; 2]| {
        let mut stage = Stage::of(bodies).under(sky());
        stage.depth = 3;
        exposed::<8>(&stage.seen_by(&eye), 0.0, SIZE)
    };
    let (a, b) = (seen([body(-1.0, 1.3), body(1.0, 1.7)]), seen([body(1.0, 1.7), body(-1.0, 1.3)]));
    let (worst, others) = difference(&a, &b);
    assert!(worst < 1e-11 && others == 0, "{worst:e} {others}");
}
