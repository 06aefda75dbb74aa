//! Light in moving water and in moving prisms. V11; Fizeau 1851.
//!
//! ~~~text
//! u = (1/n + β)/(1 + β/n)        n, the group index, at the wavelength in the water's own frame
//! ~~~

use crate::support::{
    Body, Dice, Heaven, Stage, along, beta, black_body, built, close, cuboid, flat, frequency, glass,
    glowing, light_from, look, mixed, near, plane, square, v,
};
use glam::DVec3;
use terrell::course::Course;
use terrell::solid::Solid;
use terrell::spacetime::{Event, FourVector, Poincare, Rest, SightRay, Velocity};
use terrell::spectrum::{Index, Wavelengths, planck};

/// A screen's own time at which each wavelength of a ray sees it; it faces +x and rests with `placement` of the water.
fn seen_at(water: &Body, ray: &SightRay, screen_x: f64) -> [f64; 64] {
    let (from, span) = (-100.0, 200.0);
    let screen = |timed: bool| {
        let surface = glowing(flat(1.0));
        let surface = if timed {
            mixed([(Course::Keyed(vec![(from, 0.0), (from + span, 1.0)]), surface)])
        } else {
            surface
        };
        let screen = Body::new(&built(square()), surface).sized(9.0).facing(DVec3::X);
        let screen = screen.mapped(glam::DAffine3::from_translation(v(screen_x, 0.0, 0.0)));
        look(&Stage::of([water.clone(), Body { placement: water.placement, ..screen }]).scene(), ray).radiance
    };
    let (plain, timed) = (screen(false), screen(true));
    std::array::from_fn(|i| {
        assert!(plain[i] > 0.0);
        from + span * timed[i] / plain[i]
    })
}

/// Water from x = -40 to x = 0 of its rest frame, flowing along x.
fn water(index: Index, b: f64) -> Body {
    let body = Body::of(cuboid(v(-40.0, -20.0, -20.0), v(0.0, 20.0, 20.0)), glass()).filled(index);
    body.moving(beta(b, 0.0, 0.0))
}

/// The pace in the lab of the light that comes out of the water's end at the event of its origin, for each wavelength.
pub(crate) fn paces(index: Index, b: f64) -> [f64; 64] {
    let (water, depth) = (water(index, b), 7.0);
    let ray = light_from(DVec3::ZERO, Event::new(3.0, v(3.0, 0.0, 0.0)));
    let into: Poincare<Rest> = water.placement.rest_from_lab();
    seen_at(&water, &ray, -depth).map(|tau| {
        let start = into.undo(Event::new(tau, v(-depth, 0.0, 0.0)));
        -start.x.x / -start.t
    })
}

#[test]
fn flowing_water_carries_light_along_as_fizeau_found() {
    let table = [
        (1.5, 0.5, 0.875),
        (1.5, -0.5, 0.25),
        (1.333, 0.1, 0.790_858),
        (2.4, 0.9, 0.957_576),
        // Faster than the light in it: this goes backward, and leaves by the end that comes to meet it.
        (2.4, -0.9, -0.773_333),
        (2.4, -0.4, 0.02),
        (1.5, 0.0, 0.666_667),
        (1.333, -0.1, 0.702_920),
    ];
    for (n, b, pace) in table {
        let by_formula: f64 = (1.0 / n + b) / (1.0 + b / n);
        near(by_formula, pace, 6e-7);
        for got in paces(Index::Constant(n), b) {
            near(got, by_formula, 1e-9);
        }
    }
}

/// Real water: each wavelength by the group index at the wavelength that it has in the water's own frame.
#[test]
fn dispersion_of_flowing_water_is_taken_at_the_shifted_wavelength() {
    for b in [0.1, -0.1, 0.3, -0.3_f64] {
        let omega = frequency(beta(b, 0.0, 0.0), DVec3::X);
        let pace = |n: f64| (1.0 / n + b) / (1.0 + b / n);
        let mut differs = 0;
        for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(paces(Index::WATER, b)) {
            let expected = pace(Index::WATER.group(nm / omega));
            near(got, expected, 1e-8);
            // Neither the unshifted wavelength nor the phase index would do.
            let unshifted = pace(Index::WATER.group(*nm));
            let phase = pace(Index::WATER.at(nm / omega));
            differs += i32::from((unshifted - expected).abs() > 1e-5 && (phase - expected).abs() > 1e-5);
        }
        assert!(differs > 60, "{differs}");
    }
}

/// A prism of 45° whose long side turns light by a right angle: n = 1.5 reflects all of it. Its corner is the origin, its
/// short sides are x = 0 and y = 0.
fn turning_prism(index: Index) -> Body {
    let wedge = Solid::intersection([
        plane(DVec3::ZERO, DVec3::NEG_X),
        plane(DVec3::ZERO, DVec3::NEG_Y),
        plane(v(1.0, 0.0, 0.0), v(1.0, 1.0, 0.0)),
        plane(v(0.0, 0.0, 20.0), DVec3::Z),
        plane(v(0.0, 0.0, -20.0), DVec3::NEG_Z),
    ]);
    Body::of(wedge, glass()).filled(index)
}

/// Light that enters one short side of a moving prism squarely, in its own frame, leaves by the other: all of it but for
/// what the short sides reflect. In the lab it has another direction and another colour.
#[test]
fn moving_prism_reflects_totally_in_its_own_frame() {
    let mut dice = Dice(90);
    for fast in [0.0, 0.3, 0.6, 0.9] {
        let moves = dice.velocity(fast);
        let kelvin = 5000.0;
        let mut stage = Stage::of([turning_prism(Index::Constant(1.5)).moving(moves)]);
        stage = stage.under(Heaven::uniform(black_body(kelvin)));
        stage.depth = 20;
        // In the prism's frame the light leaves along -y by the side y = 0, to an eye at (0.4, -2, 0).
        let leaves = along(-moves, DVec3::NEG_Y);
        let into: Poincare<Rest> = Poincare::to_moving(moves, Event::ORIGIN);
        let eye = into.undo(Event::new(0.0, v(0.4, -2.0, 0.3)));
        let ray = SightRay { event: eye, k: FourVector::new(1.0, leaves) };
        let at_prism = frequency(moves, leaves);
        // It came along +x (from x < 0), or, reflected, from where the eye is.
        let before = |way: DVec3| at_prism * frequency(-moves, way);
        let (through, back) = (before(DVec3::X), before(DVec3::Y));
        let r = 0.04;
        let seen = look(&stage.scene(), &ray);
        for (nm, value) in Wavelengths::<64>::new().nm.iter().zip(seen.radiance) {
            let expected = planck(*nm, kelvin / through) * (1.0 - r) / (1.0 + r)
                + planck(*nm, kelvin / back) * 2.0 * r / (1.0 + r);
            close(value, expected, 1e-7);
        }
    }
}

/// The critical angle is that of the prism's own frame.
#[test]
fn total_reflection_ends_at_the_critical_angle_of_the_rest_frame() {
    // A half space of glass x < 0 that slides along y; the eye within it, at rest with it.
    for moves in [Velocity::REST, beta(0.0, 0.6, 0.0), beta(-0.2, 0.5, 0.3)] {
        let block = Body::of(cuboid(v(-60.0, -60.0, -60.0), v(0.0, 60.0, 60.0)), glass());
        let block = block.filled(Index::Constant(1.5)).moving(moves);
        let mut stage = Stage::of([block]).under(Heaven::uniform(flat(1.0)));
        stage.depth = 1;
        let scene = stage.scene();
        let into: Poincare<Rest> = Poincare::to_moving(moves, Event::ORIGIN);
        let sees = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            // The light's way in the block's frame: from the face, inward.
            let way = v(-cos, sin, 0.0);
            let event = into.undo(Event::new(0.0, v(-1.0, 0.0, 0.0)));
            let k = into.boost().inverse() * FourVector::<Rest>::new(1.0, way);
            look(&scene, &SightRay { event, k }).radiance[0] > 0.0
        };
        near(crate::support::edge(0.3, 1.2, sees), libm::asin(1.0 / 1.5), 1e-9);
    }
}
