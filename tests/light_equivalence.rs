//! Only relative motion counts, also where light goes through glass, comes from infinity, blinks, or has one wavelength.

use crate::support::{
    Body, Dice, Eye, Heaven, Lantern, Stage, ball, beta, black_body, blinking, boosted, built, coloured,
    cube, cuboid, difference, diffuse, exposed, flat, glass, glowing, icosphere, line, mirror, mixed, pane,
    plane, square, v,
};
use glam::{DAffine2, DAffine3, DVec2, DVec3};
use std::sync::Arc;
use terrell::course::Course;
use terrell::lamp::Beam;
use terrell::observer::Aim;
use terrell::solid::{Shape, Solid};
use terrell::spacetime::{self, Event, Poincare, Velocity};
use terrell::spectrum::{Beyond, Index, Metal, Reflectance};
use terrell::surface::{Absorption, Checker, Colors, Gloss, Paint, Polish, Scatter, Surface};
use terrell::surroundings::Star;
use terrell::texture::{Encoding, Filter, Picture, Texels, Texture, Wrap};

pub(crate) const SIZE: (u32, u32) = (72, 54);

pub(crate) fn noise(dice: &mut Dice, width: u32, height: u32) -> Arc<Picture> {
    let texels =
        (0..width * height).map(|_| [dice.part() as f32, dice.part() as f32, dice.part() as f32, 1.0]);
    Arc::new(Picture::new(width, height, Texels::Float(texels.collect()), Encoding::Linear))
}

fn textured(dice: &mut Dice) -> Surface {
    let texture = Texture {
        picture: noise(dice, 16, 16),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
        uv_set: 0,
        transform: DAffine2::from_scale(DVec2::splat(1.5)),
    };
    let colors =
        Colors { color: [1.0; 3], texture: Some(texture), vertex_colors: false, beyond: Beyond::MEAN };
    Surface::new(Scatter::Diffuse(Paint::Colors(colors)))
}

fn glossy(roughness: f64) -> Surface {
    let colors = Colors { color: [0.8, 0.4, 0.2], texture: None, vertex_colors: false, beyond: Beyond::MEAN };
    let gloss = Gloss {
        base: Paint::Colors(colors),
        metallic: 0.2,
        roughness,
        metal_rough: None,
        index: 1.5,
        specular: 1.0,
        specular_texture: None,
        specular_color: None,
        clearcoat: None,
    };
    Surface::new(Scatter::Gloss(Box::new(gloss)))
}

/// Squares on a floor without end. Colours of two kinds.
fn squares() -> Surface {
    let checker = Checker {
        size: 1.0,
        even: Reflectance::Rgb([0.7, 0.7, 0.6]),
        odd: Reflectance::Rgb([0.1, 0.2, 0.4]),
    };
    Surface::new(Scatter::Diffuse(Paint::Checker(Box::new(checker))))
}

/// A die with a hole and a rounded corner.
fn carved() -> Solid {
    let drill = Solid::from(Shape::Cylinder)
        .placed(DAffine3::from_axis_angle(DVec3::X, 0.6) * DAffine3::from_scale(v(0.4, 4.0, 0.4)))
        .unwrap();
    let cone = Solid::from(Shape::Cone).placed(DAffine3::from_translation(v(0.0, 1.2, 0.0))).unwrap();
    let die = Solid::intersection([cuboid(DVec3::splat(-0.8), DVec3::splat(0.8)), ball(1.1, DVec3::ZERO)]);
    Solid::union([die.difference([drill]), cone])
}

fn still_and_blinking() -> [Course; 2] {
    [blinking(1.3, 0.6, 0.1), Course::Blinking { period: 1.3, lit: 0.6, start: 0.1, inverted: true }]
}

/// All that there is, before the origin's -z.
pub(crate) fn stage(dice: &mut Dice, fast: f64) -> Stage {
    let mut moves = |limit: f64| {
        let b = dice.between(0.2 * limit, limit);
        dice.velocity(b)
    };
    let (a, b, c) = (moves(0.3 * fast), moves(fast), moves(0.5 * fast));
    let m: [Velocity; 8] = std::array::from_fn(|_| moves(0.6 * fast));
    let lamps = lanterns(&mut moves, fast);
    let skies = skies(dice, fast);
    let [on, off] = still_and_blinking();
    let keyed = |up: bool| {
        Course::Keyed(if up { vec![(-9.0, 0.0), (9.0, 1.0)] } else { vec![(-9.0, 1.0), (9.0, 0.0)] })
    };
    let plate = built(square());
    let absorbs = Absorption { left: Reflectance::Rgb([0.9, 0.5, 0.7]), distance: 1.0 };
    let lens = Solid::intersection([ball(2.0, v(0.0, 0.0, 1.6)), ball(2.0, v(0.0, 0.0, -1.6))]);
    let bodies = vec![
        Body::of(plane(v(0.0, -2.0, 0.0), v(0.1, 1.0, 0.2)), squares()).moving(a),
        Body::of(ball(0.9, DVec3::ZERO), glass())
            .filled(Index::BK7)
            .at(-7.0, v(-0.6, 0.1, -6.5))
            .moving(m[0]),
        Body { absorption: Some(absorbs), ..Body::of(lens, glass()).filled(Index::Constant(1.5)) }
            .at(-6.0, v(1.2, 0.4, -6.0))
            .moving(m[1]),
        Body::new(&plate, pane(Index::Constant(1.5))).sized(1.2).at(-5.0, v(0.2, 1.2, -5.5)).moving(m[2]),
        Body::new(&plate, mirror(0.8))
            .sized(3.0)
            .facing(v(0.5, 0.1, 1.0))
            .at(-9.0, v(-2.5, 0.5, -10.0))
            .moving(c),
        Body::of(ball(0.7, DVec3::ZERO), glossy(0.25)).at(-8.0, v(1.6, 0.9, -8.0)).moving(b),
        Body::of(ball(0.6, DVec3::ZERO), Surface::new(Scatter::Metal(gold())))
            .at(-8.5, v(0.3, 2.0, -8.5))
            .moving(m[3]),
        Body::of(carved(), textured(dice)).at(-9.0, v(2.6, -0.3, -9.0)).moving(m[4]),
        Body::of(ball(0.8, DVec3::ZERO), mixed([(on, glowing(black_body(3000.0))), (off, diffuse(0.5))]))
            .at(-8.0, v(-2.0, 1.8, -8.0))
            .moving(m[5]),
        Body::new(
            &built(coloured(cube())),
            mixed([(keyed(true), diffuse(0.9)), (keyed(false), mirror(0.5))]),
        )
        .sized(0.6)
        .at(-8.0, v(-0.4, -1.0, -7.5))
        .moving(m[6]),
        Body::new(&built(icosphere(3)), textured(dice)).sized(0.5).at(-8.0, v(0.9, -0.9, -7.0)).moving(m[7]),
    ];
    let mut stage = Stage { skies, ..Stage::of(bodies).lit_by(lamps) };
    stage.depth = 5;
    stage.ambient = Some(flat(3.0));
    stage
}

fn gold() -> Polish<Metal> {
    Polish { of: Metal::named("gold").unwrap(), roughness: 0.1 }
}

fn lanterns(moves: &mut impl FnMut(f64) -> Velocity, fast: f64) -> [Lantern; 4] {
    let spot =
        Beam::Spot { place: v(0.2, 0.0, 0.0), axis: v(0.0, -0.6, -0.8), cos_inner: 0.9, cos_outer: 0.3 };
    let keys = Course::Keyed(vec![(-12.0, 0.2), (-9.0, 1.0), (0.0, 0.4)]);
    [
        Lantern::at(-10.0, v(2.0, 5.0, -4.0), flat(300.0)).moving(moves(fast)).by(&blinking(2.1, 0.7, 0.4)),
        Lantern::at(-9.0, v(-3.0, 4.0, -5.0), line(589.0, 4e4)).moving(moves(0.3 * fast)),
        Lantern::at(-9.0, v(0.0, 4.0, -3.0), black_body(4000.0))
            .with(spot)
            .moving(moves(0.5 * fast))
            .by(&keys),
        Lantern::at(0.0, DVec3::ZERO, black_body(3500.0))
            .with(Beam::Sun { axis: v(-0.48, -0.64, -0.6) })
            .moving(moves(0.4 * fast))
            .by(&blinking(5.3, 0.5, 0.0)),
    ]
}

fn skies(dice: &mut Dice, fast: f64) -> Vec<Heaven> {
    let star = |dice: &mut Dice| Star {
        direction: dice.direction(),
        kelvin: dice.between(3e3, 9e3),
        illuminance: 0.1,
    };
    let stars: Vec<Star> = (0..400).map(|_| star(dice)).collect();
    let mut sky = Heaven::stars(stars).moving(dice.velocity(0.6 * fast));
    sky.uniform = Some(line(560.0, 0.05));
    let picture =
        Heaven::picture(noise(dice, 16, 8), 50.0).turned(dice.turn()).moving(dice.velocity(0.3 * fast));
    vec![sky, picture, Heaven::uniform(black_body(2000.0)).moving(dice.velocity(0.5 * fast))]
}

/// At rest, fast, and a rocket.
pub(crate) fn eyes(dice: &mut Dice) -> Vec<(Eye, f64)> {
    let rest_from_lab = Poincare::to_moving(Velocity::REST, Event::ORIGIN);
    let aim = Aim::At { rest_from_lab, place: v(0.0, 0.0, -8.0) };
    let still = Eye { rotation: dice.turn(), aim, ..Eye::at(0.0, DVec3::ZERO).wide(60.0) };
    let course = spacetime::Course::Rocket { acceleration: dice.direction() * 0.3 };
    let rocket = Eye { course, ..still.moving(dice.velocity(0.3)) };
    vec![(still.clone(), 0.0), (still.moving(dice.velocity(0.6)), 0.0), (rocket, 1.0)]
}

#[test]
fn boosting_everything_leaves_glass_skies_and_clocks_as_they_are() {
    let mut dice = Dice(4711);
    let pixels = (SIZE.0 * SIZE.1) as usize;
    let mut failures = Vec::new();
    for fast in [0.4, 0.8] {
        let stage = stage(&mut dice, fast);
        for (eye, tau) in eyes(&mut dice) {
            let original = exposed::<8>(&stage.seen_by(&eye), tau, SIZE);
            let lit = original.iter().filter(|xyz| xyz.y > 0.0).count();
            assert!(lit * 2 > pixels, "only {lit} pixels are lit");
            for b in [0.5, 0.9, 0.99] {
                let by = dice.velocity(b);
                let moved = boosted::stage(by, &stage).seen_by(&boosted::eye(by, &eye));
                let (part, edges) = difference(&original, &exposed::<8>(&moved, tau, SIZE));
                println!("{fast} boosted by {b}: worst {part:e}, {edges} others");
                if part > 1e-6 || edges * 200 > pixels {
                    failures.push((fast, b, part, edges));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}

/// The same from within a ball of water that moves, as a diver sees it.
#[test]
fn boosting_everything_leaves_a_divers_view_as_it_is() {
    let mut dice = Dice(4712);
    let mut stage = stage(&mut dice, 0.5);
    let water = Body::of(ball(1.5, DVec3::ZERO), glass()).filled(Index::WATER);
    let water = Body {
        absorption: Some(Absorption { left: Reflectance::Rgb([0.5, 0.8, 0.9]), distance: 2.0 }),
        ..water
    };
    stage.bodies.push(water.at(-1.0, v(0.1, -0.2, 0.0)).moving(dice.velocity(0.4)));
    for (eye, tau) in eyes(&mut dice).into_iter().skip(1) {
        let original = exposed::<8>(&stage.seen_by(&eye), tau, SIZE);
        let lit = original.iter().filter(|xyz| xyz.y > 0.0).count();
        // Toward the water's rim some of it is reflected for ever.
        assert!(lit * 3 > original.len(), "only {lit} pixels are lit");
        let by = dice.velocity(0.95);
        let moved = boosted::stage(by, &stage).seen_by(&boosted::eye(by, &eye));
        let (part, edges) = difference(&original, &exposed::<8>(&moved, tau, SIZE));
        println!("diver: worst {part:e}, {edges} others");
        assert!(part < 1e-6 && edges * 200 <= original.len(), "{part:e} {edges}");
    }
}

/// Bodies of glass that overlap, touch and contain one another, in an order and in another.
#[test]
fn order_of_bodies_of_glass_changes_nothing() {
    let moves = beta(0.2, 0.3, -0.1);
    let crown =
        |solid: Solid| Body::of(solid, glass()).filled(Index::BK7).at(-5.0, DVec3::ZERO).moving(moves);
    let plain = |solid: Solid, n: f64| {
        Body::of(solid, glass()).filled(Index::Constant(n)).at(-5.0, DVec3::ZERO).moving(moves)
    };
    let bodies = vec![
        crown(ball(1.0, v(-0.5, 0.0, -5.0))),
        plain(ball(1.3, v(0.6, 0.2, -5.2)), 1.33),
        plain(cuboid(v(-0.4, -0.3, -5.6), v(0.3, 0.5, -4.6)), 1.8),
        plain(cuboid(v(0.3, -0.3, -5.6), v(0.9, 0.5, -4.6)), 1.2),
        Body::of(ball(0.2, v(0.0, 0.1, -5.1)), diffuse(0.7)).at(-5.0, DVec3::ZERO).moving(moves),
        Body::of(ball(0.9, v(1.2, 0.8, -4.5)), glass())
            .filled(Index::WATER)
            .at(-5.0, DVec3::ZERO)
            .moving(beta(-0.3, 0.0, 0.2)),
        Body::of(plane(v(0.0, -1.5, 0.0), DVec3::Y), squares()),
    ];
    let lamp = Lantern::at(0.0, v(2.0, 4.0, -2.0), flat(300.0));
    let mut stage = Stage::of(bodies).lit_by([lamp]).under(Heaven::uniform(black_body(3000.0)));
    stage.depth = 6;
    let eye = Eye::at(0.0, DVec3::ZERO).wide(50.0);
    let first = exposed::<8>(&stage.seen_by(&eye), 0.0, SIZE);
    // What is within others is seen: without it the picture is another.
    let mut without = stage.clone();
    without.bodies.remove(2);
    let (_, others) = difference(&first, &exposed::<8>(&without.seen_by(&eye), 0.0, SIZE));
    assert!(others > 100, "{others}");
    let mut dice = Dice(12);
    for _ in 0..3 {
        for i in (1..stage.bodies.len()).rev() {
            stage.bodies.swap(i, dice.below(i + 1));
        }
        let (worst, others) = difference(&first, &exposed::<8>(&stage.seen_by(&eye), 0.0, SIZE));
        assert!(worst < 1e-11 && others == 0, "{worst:e} {others}");
    }
}

/// A camera that flies at v through a still world, and a still camera before a world that flies at -v.
#[test]
fn flying_camera_equals_flying_world_with_glass_and_stars() {
    let mut dice = Dice(6);
    let mut still = stage(&mut dice, 0.5);
    still.bodies.iter_mut().for_each(|body| body.placement.velocity = Velocity::REST);
    still.lamps.iter_mut().for_each(|lamp| lamp.velocity = Velocity::REST);
    still.skies.iter_mut().for_each(|sky| sky.velocity = Velocity::REST);
    let eye = Eye::at(0.0, DVec3::ZERO).wide(80.0);
    for velocity in [beta(0.0, 0.0, -0.8), beta(0.3, 0.2, -0.5)] {
        let flying_camera = exposed::<8>(&still.seen_by(&eye.moving(velocity)), 0.0, SIZE);
        // The same rest frames, axes and clocks.
        let mut flying = still.clone();
        for body in &mut flying.bodies {
            body.placement.origin = boosted::event(velocity, body.placement.origin);
            body.placement.velocity = -velocity;
        }
        for lamp in &mut flying.lamps {
            lamp.origin = boosted::event(velocity, lamp.origin);
            lamp.velocity = -velocity;
        }
        flying.skies.iter_mut().for_each(|sky| sky.velocity = -velocity);
        let (worst, others) = difference(&flying_camera, &exposed::<8>(&flying.seen_by(&eye), 0.0, SIZE));
        println!("flying camera and world differ by {worst:e}, {others} other pixels");
        assert!(worst < 1e-8 && others <= 4, "{worst:e}, {others}");
    }
}
