//! Only relative motion counts: the same picture from every frame.

use crate::support::{
    Body, Dice, Eye, Lantern, Stage, beta, black_body, boosted, built, coloured, cube, difference, diffuse,
    exposed, flat, glowing, icosphere, line, mirror, square, v,
};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::sync::Arc;
use terrell::lamp::Beam;
use terrell::observer::Aim;
use terrell::scene::Placement;
use terrell::spacetime::{Circle, Course, Event, Poincare, Velocity};
use terrell::spectrum::{Beyond, Source};
use terrell::surface::{Colors, Paint, Scatter, Surface};
use terrell::triangles::Triangles;

pub(crate) const SIZE: (u32, u32) = (80, 60);

fn painted() -> Surface {
    let beyond = Beyond::MEAN;
    let colors = Colors { color: [0.9, 0.8, 0.7], texture: None, vertex_colors: true, beyond };
    Surface::new(Scatter::Diffuse(Paint::Colors(colors)))
}

pub(crate) struct Props {
    ball: Arc<Triangles>,
    die: Arc<Triangles>,
    plate: Arc<Triangles>,
}

impl Props {
    pub(crate) fn new() -> Self {
        Self {
            ball: built(coloured(icosphere(4))),
            die: built(coloured(cube())),
            plate: built(coloured(square())),
        }
    }

    /// Moving bodies of many kinds, moving lamps of every kind, shadows, and a mirror, before the origin's -z.
    pub(crate) fn stage(&self, dice: &mut Dice, fast: f64) -> Stage {
        let mut moves = |limit: f64| {
            let b = dice.between(0.2 * limit, limit);
            dice.velocity(b)
        };
        let floor =
            Body::new(&self.plate, painted()).sized(6.0).facing(v(0.0, 1.0, 0.2)).at(0.0, v(0.0, -2.0, -8.0));
        let squashed =
            DAffine3::from_mat3(DMat3::from_cols(v(0.9, 0.2, 0.0), v(-0.1, 0.7, 0.0), v(0.0, 0.3, -1.1)));
        let mut bodies = vec![
            floor.moving(moves(0.3 * fast)),
            Body::new(&self.ball, painted()).at(-9.0, v(-1.0, 0.5, -8.0)).moving(moves(fast)),
            Body::new(&self.die, painted()).mapped(squashed).at(-7.0, v(1.5, 0.3, -7.0)).moving(moves(fast)),
            Body::new(&self.die, diffuse(0.6)).sized(0.5).at(-8.0, v(0.3, 1.5, -7.5)).moving(moves(fast)),
            Body::new(&self.ball, glowing(black_body(4500.0)))
                .sized(0.3)
                .at(-8.0, v(2.0, 2.0, -9.0))
                .moving(moves(fast)),
        ];
        let plate = Body::new(&self.plate, mirror(0.8)).sized(3.0).facing(v(0.5, 0.1, 1.0));
        bodies.push(plate.at(-9.0, v(-2.5, 0.5, -10.0)).moving(moves(0.4 * fast)));
        let spot =
            Beam::Spot { place: v(0.2, 0.0, 0.0), axis: v(0.0, -0.6, -0.8), cos_inner: 0.9, cos_outer: 0.4 };
        let lamps = [
            Lantern::at(-10.0, v(2.0, 5.0, -4.0), Self::source(3e10)).moving(moves(fast)),
            Lantern::at(-9.0, v(-3.0, 4.0, -5.0), line(570.0, 4e8)).moving(moves(fast)),
            Lantern::at(-9.0, v(0.0, 4.0, -3.0), black_body(4000.0)).with(spot).moving(moves(0.5 * fast)),
            Lantern::at(0.0, DVec3::ZERO, black_body(3500.0))
                .with(Beam::Sun { axis: v(0.48, -0.6, -0.64) })
                .moving(moves(0.4 * fast)),
        ];
        let mut stage = Stage::of(bodies).lit_by(lamps);
        stage.ambient = Some(flat(30.0));
        stage.depth = 3;
        stage
    }

    fn source(value: f64) -> Source {
        flat(value * 1e-8)
    }
}

/// An eye at the origin, or near it, that sees the stage.
pub(crate) fn eyes(dice: &mut Dice) -> Vec<(Eye, f64)> {
    let still = Eye { rotation: dice.turn(), ..Eye::at(0.0, DVec3::ZERO).wide(70.0) };
    let still = Eye { aim: Aim::Along(still.rotation.inverse() * DVec3::NEG_Z), ..still };
    let axis = dice.direction();
    let circle = Circle::around(-axis.any_orthonormal_vector(), axis, 1.0, 0.3);
    let moves = |eye: Eye, b: f64, dice: &mut Dice| {
        // It looks where the stage's middle appears.
        let b = dice.velocity(b);
        let rest_from_lab = Poincare::to_moving(Velocity::REST, Event::ORIGIN);
        Eye { aim: Aim::At { rest_from_lab, place: v(0.0, 0.0, -8.0) }, ..eye.moving(b) }
    };
    let fast = moves(still.clone(), 0.6, dice);
    let rocket = Eye {
        course: Course::Rocket { acceleration: dice.direction() * 0.3 },
        ..moves(still.clone(), 0.3, dice)
    };
    let orbit =
        Eye { course: Course::Orbit { circle, proper_speed: 0.8 }, ..moves(still.clone(), 0.3, dice) };
    vec![(still, 0.0), (fast, 0.4), (rocket, 1.5), (orbit, 0.7)]
}

/// Everything moves with the same boost more: bodies, lamps, the observer, and all events. Velocities are composed,
/// with their Wigner rotations.
#[test]
fn boosting_everything_leaves_the_picture_as_it_is() {
    let (props, mut dice) = (Props::new(), Dice(2024));
    let pixels = (SIZE.0 * SIZE.1) as usize;
    let (mut worst, mut others, mut pictures) = (0.0_f64, 0, 0);
    for fast in [0.5, 0.8, 0.9] {
        let stage = props.stage(&mut dice, fast);
        for (eye, tau) in eyes(&mut dice) {
            let original = exposed::<16>(&stage.seen_by(&eye), tau, SIZE);
            let lit = original.iter().filter(|xyz| xyz.y > 0.0).count();
            assert!(lit * 8 > pixels, "only {lit} pixels are lit");
            for b in [0.5, 0.9, 0.99] {
                let by = dice.velocity(b);
                let moved = boosted::stage(by, &stage).seen_by(&boosted::eye(by, &eye));
                let (part, edges) = difference(&original, &exposed::<16>(&moved, tau, SIZE));
                (worst, others, pictures) = (worst.max(part), others + edges, pictures + 1);
                assert!(edges * 1000 < pixels, "{edges} pixels differ, boosted by {b}");
            }
        }
    }
    println!("worst {worst:e} relative; {others} of {} pixels are others", pictures * pixels);
    assert!(worst < 1e-8, "{worst:e}");
}

/// The same bodies and lamps at rest.
pub(crate) fn stopped(stage: &Stage) -> Stage {
    let mut still = stage.clone();
    still.bodies.iter_mut().for_each(|body| body.placement.velocity = Velocity::REST);
    still.lamps.iter_mut().for_each(|lamp| lamp.velocity = Velocity::REST);
    still
}

/// A still world that flies with -v instead: the same rest frames, axes and clocks. Each origin is the event that was the
/// still body's at time t', place x'.
pub(crate) fn flown(velocity: Velocity, still: &Stage) -> Stage {
    let mut flying = still.clone();
    let fly = |origin: &mut Event, moves: &mut Velocity| {
        *origin = boosted::event(velocity, *origin);
        *moves = -velocity;
    };
    for Placement { origin, velocity } in flying.bodies.iter_mut().map(|body| &mut body.placement) {
        fly(origin, velocity);
    }
    flying.lamps.iter_mut().for_each(|lamp| fly(&mut lamp.origin, &mut lamp.velocity));
    flying
}

/// A camera that flies at v through a still world, and a still camera before a world that flies at -v.
#[test]
fn flying_camera_equals_flying_world() {
    let (props, mut dice) = (Props::new(), Dice(5));
    let still = stopped(&props.stage(&mut dice, 0.5));
    let eye = Eye::at(0.0, DVec3::ZERO).wide(80.0);
    for velocity in [beta(0.0, 0.0, -0.8), beta(0.3, 0.2, -0.5), beta(-0.6, 0.0, 0.1)] {
        let flying_camera = exposed::<16>(&still.seen_by(&eye.moving(velocity)), 0.0, SIZE);
        let flying = flown(velocity, &still);
        let flying_world = exposed::<16>(&flying.seen_by(&eye), 0.0, SIZE);
        let (worst, others) = difference(&flying_camera, &flying_world);
        println!("flying camera and world differ by {worst:e}, {others} other pixels");
        assert!(worst < 1e-10 && others <= 2, "{worst:e}, {others}");
    }
}

/// At walking pace nothing is left but a part of the order β.
#[test]
fn slow_motion_is_classical() {
    let [slow, slower] = changes_by_slow_motion([1e-3, 1e-4]);
    assert!((5.0..20.0).contains(&(slow / slower)), "{slow:e} {slower:e}");
    assert!(slow < 3e-2 && slower < 3e-3, "{slow:e} {slower:e}");
}

/// By what part nine in ten pixels change at most when bodies, lamps and the eye move at paces instead of resting.
pub(crate) fn changes_by_slow_motion(paces: [f64; 2]) -> [f64; 2] {
    let (props, mut dice) = (Props::new(), Dice(77));
    let stage = props.stage(&mut dice, 0.5);
    let eye = Eye::at(0.0, DVec3::ZERO).wide(70.0);
    let at_pace = |pace: f64| {
        let mut stage = stage.clone();
        let slow = |velocity: Velocity| Velocity::from_beta(velocity.beta() * pace).unwrap();
        stage.bodies.iter_mut().for_each(|body| body.placement.velocity = slow(body.placement.velocity));
        stage.lamps.iter_mut().for_each(|lamp| lamp.velocity = slow(lamp.velocity));
        exposed::<16>(&stage.seen_by(&eye.moving(beta(0.3 * pace, -0.2 * pace, 0.4 * pace))), 0.0, SIZE)
    };
    let rest = at_pace(0.0);
    let change = |pace: f64| {
        let pixels = at_pace(pace).into_iter().zip(&rest).filter(|(_, still)| still.y > 0.0);
        let mut parts: Vec<f64> =
            pixels.map(|(moving, still)| (moving.y - still.y).abs() / still.y).collect();
        parts.sort_by(f64::total_cmp);
        parts[parts.len() * 9 / 10]
    };
    paces.map(change)
}

/// Bodies, frames and lamps in another order: the same bits.
#[test]
fn order_of_bodies_changes_nothing() {
    let (props, mut dice) = (Props::new(), Dice(8));
    let stage = props.stage(&mut dice, 0.8);
    let mut turned = stage.clone();
    turned.bodies.reverse();
    let eye = Eye::at(0.0, DVec3::ZERO).moving(beta(0.1, 0.4, -0.3)).wide(80.0);
    let (a, b) =
        (exposed::<16>(&stage.seen_by(&eye), 0.0, SIZE), exposed::<16>(&turned.seen_by(&eye), 0.0, SIZE));
    let bits = |xyz: &DVec3| xyz.to_array().map(f64::to_bits);
    assert!(a.iter().map(bits).eq(b.iter().map(bits)));
}

/// A body's own clock and the order of its travels play no part: any event on its centre's path will do.
#[test]
fn any_event_on_the_path_places_a_body() {
    let (props, mut dice) = (Props::new(), Dice(18));
    let stage = props.stage(&mut dice, 0.8);
    let mut later = stage.clone();
    for body in &mut later.bodies {
        let step = dice.between(-4.0, 9.0);
        body.placement.origin = body.placement.origin + body.placement.velocity.four() * step;
    }
    for lamp in &mut later.lamps {
        let step = dice.between(-4.0, 9.0);
        lamp.origin = lamp.origin + lamp.velocity.four() * step;
    }
    let eye = Eye::at(0.0, DVec3::ZERO).moving(beta(0.1, 0.4, -0.3)).wide(80.0);
    let (worst, others) = difference(
        &exposed::<16>(&stage.seen_by(&eye), 0.0, SIZE),
        &exposed::<16>(&later.seen_by(&eye), 0.0, SIZE),
    );
    assert!(worst < 1e-6 && others <= 3, "{worst:e} {others}");
}

/// Mesh coordinates are nobody's business: turned in its own file and turned back it is the same body.
#[test]
fn turning_the_mesh_and_turning_it_back_changes_nothing() {
    let turn = DQuat::from_axis_angle(v(1.0, 2.0, 2.0) / 3.0, 1.0);
    let plain = icosphere(3);
    let mut turned = plain.clone();
    for position in &mut turned.positions {
        *position = (turn * position.as_dvec3()).as_vec3();
    }
    for normal in &mut turned.normals {
        *normal = (turn * normal.as_dvec3()).as_vec3();
    }
    let lamp = Lantern::at(0.0, v(3.0, 3.0, 0.0), flat(100.0));
    let body = |mesh, map: DQuat| {
        let body = Body::new(&built(mesh), diffuse(0.5)).mapped(DAffine3::from_quat(map));
        Stage::of([body.at(-5.0, v(0.0, 0.0, -4.0)).moving(beta(0.5, 0.3, 0.1))])
            .lit_by([lamp.clone()])
            .scene()
    };
    let (a, b) = (
        exposed::<16>(&body(plain, DQuat::IDENTITY), 0.0, SIZE),
        exposed::<16>(&body(turned, turn.inverse()), 0.0, SIZE),
    );
    let (worst, others) = difference(&a, &b);
    assert!(worst < 1e-5 && others < 5, "{worst:e} {others}");
}
