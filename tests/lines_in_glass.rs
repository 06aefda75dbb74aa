//! Spectral lines through prisms and balls that disperse: a line goes the way of its own wavelength.

use crate::lines::{SODIUM, all, any, xyz};
use crate::support::{
    Body, Dice, Eye, Heaven, Stage, ball, beta, black_body, boosted, frequency, glass, glowing, light_from,
    line, near_vector, plane, speed, v,
};
use glam::DVec3;
use terrell::fresnel;
use terrell::scene::Scene;
use terrell::solid::Solid;
use terrell::spacetime::{Event, SightRay, Velocity};
use terrell::spectrum::Index;

/// A prism of 60° at rest, its edge along z at (0, 1): what a ray back in time does in it.
pub(crate) struct Bent {
    /// Where it enters and leaves the glass, going back.
    entry: DVec3,
    exit: DVec3,
    /// Where it goes from there.
    pub(crate) onward: DVec3,
    /// What both faces let through.
    pub(crate) part: f64,
}

/// Normals of the faces to the right and to the left.
fn faces() -> [DVec3; 2] {
    let half = 0.5 * 3.0_f64.sqrt();
    [v(half, 0.5, 0.0), v(-half, 0.5, 0.0)]
}

pub(crate) fn prism_body(index: Index) -> Body {
    let top = v(0.0, 1.0, 0.0);
    let [right, left] = faces();
    let wedge = Solid::intersection([
        plane(top, right),
        plane(top, left),
        plane(v(0.0, -1.0, 0.0), DVec3::NEG_Y),
        plane(v(0.0, 0.0, 50.0), DVec3::Z),
        plane(v(0.0, 0.0, -50.0), DVec3::NEG_Z),
    ]);
    Body::of(wedge, glass()).filled(index)
}

/// Snell's law: the unit direction beyond, and what part goes through. `ratio`: index beyond over index before.
fn snell(n: DVec3, normal: DVec3, ratio: f64) -> (DVec3, f64) {
    let cosine = n.dot(normal);
    let across = (n - normal * cosine) / ratio;
    let beyond = across + normal * ((1.0 - across.length_squared()).sqrt() * cosine.signum());
    (beyond, 1.0 - fresnel::dielectric(cosine.abs(), ratio))
}

/// By hand: a ray that goes back from `eye` along `n` and enters the right face.
pub(crate) fn bend(eye: DVec3, n: DVec3, index: f64) -> Bent {
    let top = v(0.0, 1.0, 0.0);
    let [right, left] = faces();
    let entry = eye + n * ((top - eye).dot(right) / n.dot(right));
    let (inside, first) = snell(n, right, index);
    let exit = entry + inside * ((top - entry).dot(left) / inside.dot(left));
    let (onward, second) = snell(inside, left, 1.0 / index);
    assert!(entry.y.abs() < 1.0 && exit.y.abs() < 1.0, "{entry} {exit}");
    Bent { entry, exit, onward, part: first * second }
}

/// The event, in the prism's frame, at which light left that is at `eye` at time 0, `far` metres behind the prism.
pub(crate) fn sent(eye: DVec3, bent: &Bent, index: Index, nm: f64, far: f64) -> Event {
    let glass = (bent.exit - bent.entry).length() * index.group(nm);
    Event::new(-(bent.entry - eye).length() - glass - far, bent.exit + bent.onward * far)
}

/// Where the eye of these tests is, and where it looks.
pub(crate) fn from_the_right() -> (DVec3, DVec3) {
    (v(4.0, -1.6, 0.3), v(-4.2, 1.9, -0.2).normalize())
}

/// What is seen, through a prism that moves by `prism`, of a ball that moves by `moves` in the prism's frame, of radius
/// `width` times its distance and `aside` times that off where the line is to be seen; and what is to be seen.
pub(crate) fn through_prism(
    prism: Velocity,
    moves: Velocity,
    width: f64,
    aside: f64,
) -> (Scene, SightRay, DVec3) {
    let (eye, n) = from_the_right();
    let (index, far) = (Index::BK7, 5.0);
    // The wavelength in the prism's frame depends on the direction of the light behind it, and that on the wavelength.
    let mut nm = SODIUM;
    for _ in 0..60 {
        nm = SODIUM * frequency(moves, -bend(eye, n, index.at(nm)).onward);
    }
    let bent = bend(eye, n, index.at(nm));
    let event = sent(eye, &bent, index, nm, far);
    let omega = nm / SODIUM;
    let off = bent.onward.any_orthonormal_vector() * (aside * width * far);
    let target = Body::of(ball(width * far, DVec3::ZERO), glowing(line(SODIUM, 1.0)));
    let target = target.at(event.t, event.x + off).moving(moves);
    let stage = Stage::of([prism_body(index), target]);
    let ray = light_from(eye + n, Event::new(0.0, eye));
    // Now let it all move: the new lab moves by -prism in the prism's frame.
    let seen = boosted::ray(-prism, &ray);
    let scale = 1.0 / frequency(-prism, ray.k.x);
    let omega = omega * scale;
    let expected = xyz(SODIUM * omega, bent.part / (omega * omega * omega * omega));
    (boosted::stage(-prism, &stage).scene(), seen, expected)
}

/// A sodium slit seen through a prism appears at the one deviation that belongs to its wavelength in the prism's frame.
#[test]
fn sodium_seen_through_a_prism_is_deviated_by_the_index_at_its_wavelength() {
    let still = Velocity::REST;
    for prism in [still, beta(0.0, 0.0, -0.3), beta(0.2, 0.1, -0.2)] {
        for width in [0.01, 1e-4, 1e-6] {
            let (scene, ray, expected) = through_prism(prism, still, width, 0.0);
            let got = any(&scene, &ray, 1e-7);
            near_vector(got, expected, 1e-6 * expected.length());
            let (scene, ray, _) = through_prism(prism, still, width, 1.02);
            near_vector(any(&scene, &ray, 1e-7), DVec3::ZERO, 1e-6 * expected.length());
        }
    }
}

/// The same where a wide slit moves relative to the prism: it is the shifted wavelength that is bent.
#[test]
fn wide_slit_that_moves_is_seen_through_a_prism_at_the_deviation_of_its_shifted_wavelength() {
    for (prism, moves) in slits() {
        let (scene, ray, expected) = through_prism(prism, moves, 0.02, 0.0);
        near_vector(any(&scene, &ray, 1e-7), expected, 1e-6 * expected.length());
        let (scene, ray, _) = through_prism(prism, moves, 0.02, 1.1);
        near_vector(any(&scene, &ray, 1e-7), DVec3::ZERO, 1e-6 * expected.length());
    }
}

pub(crate) fn slits() -> [(Velocity, Velocity); 4] {
    let still = Velocity::REST;
    [
        (still, beta(0.15, 0.1, 0.0)),
        (beta(0.1, 0.0, 0.1), beta(-0.1, 0.0, 0.05)),
        (beta(0.2, 0.1, 0.0), beta(0.2, 0.1, 0.0)),
        (beta(0.0, 0.1, 0.1), beta(0.0, 0.3, 0.0)),
    ]
}

/// A ball of glass in sodium light that is the same all around cannot be seen, but for what is followed no further.
#[test]
fn glass_in_even_sodium_light_is_invisible() {
    let mut dice = Dice(592);
    for index in [Index::Constant(1.5), Index::BK7] {
        let body = Body::of(ball(1.0, DVec3::ZERO), glass()).filled(index);
        let mut stage = Stage::of([body]).under(Heaven::uniform(line(SODIUM, 1.0)));
        stage.depth = 14;
        let scene = stage.scene();
        for _ in 0..6 {
            let ray = light_from(dice.in_cube() * 0.5, Event::new(0.0, dice.direction() * 3.0));
            let expected = xyz(SODIUM, 1.0);
            near_vector(any(&scene, &ray, 1e-7), expected, 1e-5 * expected.length());
        }
    }
}

/// What a glass shows that hardly disperses is what one shows that does not.
fn hardly() -> Index {
    Index::cauchy(1.5, 1e-9, 0.0).unwrap()
}

/// What is seen of the same stage with glass that does not disperse and with glass that hardly does.
#[track_caller]
pub(crate) fn same_with_hardly_dispersive_glass(stage: impl Fn(Index) -> Stage, rays: &[SightRay]) {
    let (without, with) = (stage(Index::Constant(1.5)).scene(), stage(hardly()).scene());
    for ray in rays {
        let (a, b) = (all::<16>(&without, ray), all::<16>(&with, ray));
        assert!(a.y > 0.0);
        near_vector(b, a, 1e-5 * a.length());
    }
}

pub(crate) fn rays_to_the_ball(seed: u64, count: usize) -> Vec<SightRay> {
    let mut dice = Dice(seed);
    let ray = |_| light_from(dice.in_cube() * 0.4, Event::new(0.0, dice.direction() * 4.0));
    (0..count).map(ray).collect()
}

#[test]
fn hardly_dispersive_ball_shows_a_smooth_sky_as_one_without_dispersion() {
    let stage = |index: Index| {
        let body = Body::of(ball(1.0, DVec3::ZERO), glass()).filled(index);
        let sky = Heaven::uniform(black_body(5000.0)).moving(beta(0.3, 0.1, 0.0));
        Stage::of([body]).under(sky)
    };
    same_with_hardly_dispersive_glass(stage, &rays_to_the_ball(593, 12));
}

/// From a rocket: the eye's frame has no part in what glass does.
#[test]
fn fast_eye_sees_the_line_at_the_same_glass() {
    for b in [-0.1, 0.1, 0.25_f64] {
        let (eye, n) = from_the_right();
        let (scene, ray, _) = through_prism(Velocity::REST, Velocity::REST, 1e-3, 0.0);
        let observer = Eye::at(0.0, eye).moving(speed(b.abs(), n * b.signum()));
        let seen = observer.sight(n);
        near_vector(seen.k.x / seen.k.t, ray.k.x, 1e-12);
        let omega = seen.k.t;
        let bent = bend(eye, n, Index::BK7.at(SODIUM));
        let expected = xyz(SODIUM * omega, bent.part / omega.powi(4));
        near_vector(any(&scene, &seen, 1e-7), expected, 1e-6 * expected.length());
    }
}
