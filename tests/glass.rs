//! Glass at rest and in motion: where light goes, how long it takes, and how much of it comes through.

use crate::support::{
    Body, Dice, Stage, beta, black_body, built, close, cube, flat, glass, glowing, icosphere, light_from,
    look, near, near_vector, soup, square, v,
};
use glam::{DAffine3, DMat3, DVec3};
use terrell::course::Course;
use terrell::scene::Scene;
use terrell::spacetime::{Boost, Event, Lab, Poincare, Rest, SightRay, Velocity};
use terrell::spectrum::{Beyond, Index, Wavelengths, planck};
use terrell::surface::{Colors, Glow, Paint, Scatter, Surface};

const GLASS: Index = Index::Constant(1.5);

/// What a screen tells of the event at which it is seen.
#[derive(Clone, Copy)]
enum Told {
    /// The share from one edge to the other along x and along y.
    Across,
    Along,
    /// Its own time, from `.0` on, over `.1`.
    Time(f64, f64),
}

/// A square of half width 1 that glows more from one side to the other, or with time.
fn screen(told: Told) -> (terrell::mesh::Mesh, Surface) {
    let mut mesh = square();
    let beyond = Beyond::MEAN;
    let value = |p: &glam::Vec3| match told {
        Told::Across => 0.5 + 0.5 * p.x,
        Told::Along => 0.5 + 0.5 * p.y,
        Told::Time(..) => 1.0,
    };
    mesh.colors = mesh.positions.iter().map(|p| [value(p), value(p), value(p), 1.0]).collect();
    let paint = Colors { color: [1.0; 3], texture: None, vertex_colors: true, beyond };
    let surface = Surface::glowing(Glow { radiance: flat(1.0), paint: Some(Paint::Colors(paint)) });
    let surface = match told {
        Told::Time(from, span) => {
            let course = Course::Keyed(vec![(from, 0.0), (from + span, 1.0)]);
            Surface::new(Scatter::Mixed(vec![(course, surface)]))
        }
        _ => surface,
    };
    (mesh, surface)
}

/// Glass around a screen (half width `half`, its own axes x and y, at `rest_from_screen`), and the event in the
/// screen's rest frame that each wavelength of a ray sees on it. `parts`: what of the light arrives.
fn seen_on_screen(
    bodies: &[Body],
    screen_like: &Body,
    half: f64,
    ray: &SightRay,
    part: f64,
    span: (f64, f64),
) -> Vec<Event<Rest>> {
    let told = |told: Told| {
        let (mesh, surface) = screen(told);
        let mut body = screen_like.clone();
        (body.mesh, body.surface) = (built(mesh), surface);
        let scene = Stage::of(bodies.iter().cloned().chain([body])).scene();
        look(&scene, ray).radiance
    };
    let (across, along, times) = (told(Told::Across), told(Told::Along), told(Told::Time(span.0, span.1)));
    (0..64)
        .map(|i| {
            // Brightness changes by Doppler and by Fresnel alike for all three: a plain screen says by how much.
            let place = |value: f64| 2.0 * value / part - 1.0;
            let (x, y) = (place(across[i]) * half, place(along[i]) * half);
            let at = screen_like.rest_from_mesh.transform_point3(v(x / half, y / half, 0.0));
            Event::new(span.0 + span.1 * times[i] / part, at)
        })
        .collect()
}

/// A plain screen's radiance: what part of 1 arrives at each wavelength.
fn plain(bodies: &[Body], screen_like: &Body, ray: &SightRay) -> [f64; 64] {
    let mut body = screen_like.clone();
    (body.mesh, body.surface) = (built(square()), glowing(flat(1.0)));
    let scene = Stage::of(bodies.iter().cloned().chain([body])).scene();
    look(&scene, ray).radiance
}

/// A ball so large that it is a half space: x > 0 in its rest frame, whose origin is where its face is.
fn half_space(index: Index, velocity: Velocity) -> Body {
    let block = Body::new(&built(cube()), glass()).mapped(DAffine3::from_translation(v(1.0, 0.0, 0.0)));
    block.sized(100.0).filled(index).moving(velocity)
}

/// How light that meets a moving half space (x > 0) at an angle goes on within it: for how long, and from where to where.
/// It is measured as light that goes out with everything turned back in time, at one of 64 wavelengths.
pub(crate) fn within_moving_glass(index: Index, chosen: usize, incidence: f64, b: DVec3) -> (f64, DVec3) {
    let (sin, cos) = libm::sincos(incidence);
    // The light moves along (cos, sin); turned back in time it leaves along (-cos, -sin) and the glass moves by -b.
    let velocity = Velocity::from_beta(-b).unwrap();
    let block = half_space(index, velocity);
    let rest_from_lab: Poincare<Rest> = block.placement.rest_from_lab();
    let out = Event::ORIGIN;
    let ray = SightRay {
        event: out + terrell::spacetime::FourVector::new(1.0, v(-cos, -sin, 0.0)),
        k: terrell::spacetime::FourVector::new(1.0, v(-cos, -sin, 0.0)),
    };
    let depth = 1.0;
    let turned = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
    let half = 20.0;
    let screen = Body::new(&built(square()), glowing(flat(1.0)))
        .mapped(DAffine3::from_mat3(turned * half))
        .mapped(DAffine3::from_translation(v(depth, 0.0, 0.0)))
        .moving(velocity);
    let part = plain(std::slice::from_ref(&block), &screen, &ray)[chosen];
    let events = seen_on_screen(std::slice::from_ref(&block), &screen, half, &ray, part, (-40.0, 40.0));
    let inside = rest_from_lab.undo(events[chosen]);
    (out.t - inside.t, inside.x - out.x)
}

#[test]
fn light_in_moving_glass_has_the_direction_and_the_speed_of_the_table() {
    let table = [
        (v(0.0, 0.0, 0.0), 19.4712, 0.666_667),
        (v(0.1, 0.0, 0.0), 18.4686, 0.715_857),
        (v(0.5, 0.0, 0.0), 15.3097, 0.865_104),
        (v(-0.5, 0.0, 0.0), 37.2408, 0.285_355),
        (v(0.0, 0.1, 0.0), 24.2756, 0.685_581),
        (v(0.0, 0.5, 0.0), 40.8934, 0.763_763),
        (v(0.0, 0.9, 0.0), 66.2193, 0.888_858),
    ];
    for (b, angle, pace) in table {
        let (t, way) = within_moving_glass(GLASS, 0, 30.0_f64.to_radians(), b);
        near(libm::atan2(way.y, way.x).to_degrees(), angle, 2e-4);
        near(way.length() / t, pace, 2e-6);
        near(way.z, 0.0, 1e-5);
    }
}

/// A plate between two planes of x in its rest frame, as wide as the world.
fn plate(index: Index, thickness: f64) -> Body {
    let plate = Body::new(&built(cube()), glass()).stretched(v(0.5 * thickness, 100.0, 100.0));
    plate.filled(index)
}

/// The largest angle by which a plate in motion turns light.
pub(crate) fn turned_by_moving_plates() -> f64 {
    let mut dice = Dice(7);
    let (mut met, mut worst) = (0, 0.0_f64);
    for _ in 0..30 {
        let fast = 0.8 * dice.part();
        let velocity = dice.velocity(fast);
        let plate = plate(GLASS, 0.5).mapped(DAffine3::from_quat(dice.turn())).moving(velocity);
        let ray = light_from(v(0.0, 0.0, 0.0), Event::new(0.0, dice.direction() * 10.0));
        // A uniform sky of a black body, dark but for a small disk, would do; a far screen tells the direction better.
        let far = 1e7;
        let n = -ray.k.x;
        let screen = Body::new(&built(square()), glowing(flat(1.0)))
            .sized(1e3)
            .facing(-n)
            .mapped(DAffine3::from_translation(ray.event.x + n * far));
        let bare = seen_on_screen(&[], &screen, 1e3, &ray, plain(&[], &screen, &ray)[0], (-2e7, 2e7));
        let part = plain(std::slice::from_ref(&plate), &screen, &ray)[0];
        if !(0.2..=0.999).contains(&part) {
            continue; // Edgewise, past it, or from within it.
        }
        met += 1;
        let through = seen_on_screen(&[plate], &screen, 1e3, &ray, part, (-2e7, 2e7));
        worst = worst.max((through[0].x - bare[0].x).length() / far);
    }
    assert!(met > 15, "{met}");
    worst
}

/// Aside by some decimetres and no more: 2 m at 1e7 m.
#[test]
fn plate_in_any_motion_lets_light_leave_parallel_to_how_it_came() {
    let worst = turned_by_moving_plates();
    assert!(worst < 2e-7, "{worst:e}");
}

/// By how much the light's delay in a plate at rest misses `(n_g - 1) L`, at the worst of 64 wavelengths.
pub(crate) fn missed_delay() -> f64 {
    let mut worst = 0.0_f64;
    let (index, thickness) = (Index::SF11, 0.4);
    let ray = light_from(v(10.0, 0.0, 0.0), Event::ORIGIN);
    let away = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
    let screen = Body::new(&built(square()), glowing(flat(1.0)))
        .mapped(DAffine3::from_mat3(away))
        .mapped(DAffine3::from_translation(v(3.0, 0.0, 0.0)));
    let plate = plate(index, thickness).mapped(DAffine3::from_translation(v(2.0, 0.0, 0.0)));
    let bodies = std::slice::from_ref(&plate);
    let parts = plain(bodies, &screen, &ray);
    for (i, nm) in Wavelengths::<64>::new().nm.iter().enumerate() {
        // Light that was reflected twice inside came later still: the first order is what is asked for, so less of it.
        let n = index.at(*nm);
        let r = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
        close(parts[i], (1.0 - r) / (1.0 + r), 1e-5);
        let events = seen_on_screen(bodies, &screen, 1.0, &ray, parts[i], (-8.0, 8.0));
        // The mean over the orders, each later by twice the plate and fainter by r².
        let late =
            (index.group(*nm) - 1.0) * thickness + 2.0 * index.group(*nm) * thickness * r * r / (1.0 - r * r);
        worst = worst.max((-events[i].t - 3.0 - late).abs());
    }
    worst
}

/// Extra delay `(n_g - 1) L`, at each wavelength its own.
#[test]
fn light_is_late_by_the_group_index() {
    let worst = missed_delay();
    assert!(worst < 1e-5, "{worst:e}");
}

#[test]
fn plate_lets_through_what_fresnel_sums_up_to_and_reflects_the_rest() {
    for degrees in [0.0, 20.0, 56.31, 75.0_f64] {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let eye = Event::new(0.0, v(-2.0 * cos, -2.0 * sin, 0.0));
        let ray = light_from(DVec3::ZERO, eye);
        let behind = Body::new(&built(square()), glowing(flat(1.0)))
            .facing(DVec3::NEG_X)
            .sized(1e3)
            .mapped(DAffine3::from_translation(v(5.0, 0.0, 0.0)));
        let before = behind.clone().mapped(DAffine3::from_translation(v(-20.0, 0.0, 0.0)));
        let radiance = |screen: Body| {
            let mut stage = Stage::of([plate(GLASS, 0.1).stretched(v(1.0, 10.0, 10.0)), screen]);
            stage.depth = 24;
            look(&stage.scene(), &ray).radiance[0]
        };
        let snell = sin / 1.5;
        let inside = (1.0 - snell * snell).sqrt();
        let s = (cos - 1.5 * inside) / (cos + 1.5 * inside);
        let p = (1.5 * cos - inside) / (1.5 * cos + inside);
        let r = 0.5 * (s * s + p * p);
        close(radiance(behind), (1.0 - r) / (1.0 + r), 1e-5);
        close(radiance(before), 2.0 * r / (1.0 + r), 1e-4);
    }
}

#[test]
fn beyond_the_critical_angle_all_is_reflected() {
    // From within a half space of glass, looking at its face from below.
    let bright = Body::new(&built(icosphere(2)), glowing(flat(1.0))).sized(1e3);
    let critical = libm::asin(1.0 / 1.5);
    for (angle, through) in [(critical - 1e-3, true), (critical + 1e-3, false)] {
        let block = half_space(GLASS, Velocity::REST);
        let (sin, cos) = libm::sincos(angle);
        let eye = Event::new(0.0, v(1.0, 0.0, 0.0));
        let ray = light_from(eye.x + v(-cos, sin, 0.0), eye);
        // The block is dark at its other sides: it ends at a black wall.
        let mut stage = Stage::of([block, bright.clone()]);
        stage.depth = 1;
        let seen = look(&stage.scene(), &ray).radiance[0];
        assert_eq!(seen > 0.0, through, "{angle}: {seen}");
    }
}

/// Radiance over n²: a glowing body within glass is seen n² fainter, but for what the face reflects.
#[test]
fn glow_inside_glass_is_fainter_by_the_square_of_the_index() {
    for n in [1.2, 1.5, 2.4] {
        let inside = Body::new(&built(icosphere(3)), glowing(flat(1.0))).at(0.0, v(3.0, 0.0, 0.0));
        let ray = light_from(v(3.0, 0.0, 0.0), Event::new(0.0, v(-2.0, 0.0, 0.0)));
        let scene = Stage::of([half_space(Index::Constant(n), Velocity::REST), inside]).scene();
        let r = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
        close(look(&scene, &ray).radiance[9], (1.0 - r) / (n * n), 1e-9);
    }
}

/// Where a prism of 60° bends light least, and by how much, at each wavelength.
#[test]
fn prism_bends_each_wavelength_by_its_own_least_angle() {
    let apex = 60.0_f64.to_radians();
    let index = Index::BK7;
    let (a, b, c) = (v(0.0, 1.0, 0.0), v(-1.0, -0.732_050_8, 0.0), v(1.0, -0.732_050_8, 0.0));
    let end = v(0.0, 0.0, 50.0);
    let quad = |p: DVec3, q: DVec3| [[p - end, q - end, q + end], [p - end, q + end, p + end]];
    let sides: Vec<[DVec3; 3]> = [
        quad(b, a).as_slice(),
        quad(c, b).as_slice(),
        quad(a, c).as_slice(),
        &[[a - end, b - end, c - end], [a + end, c + end, b + end]],
    ]
    .concat();
    // Outward: away from the middle.
    let sides: Vec<[DVec3; 3]> = sides
        .into_iter()
        .map(|[p, q, r]| if (q - p).cross(r - p).dot(p + q + r) > 0.0 { [p, q, r] } else { [p, r, q] })
        .collect();
    let prism = Body::new(&built(soup(&sides)), glass()).filled(index);
    for chosen in [2, 30, 61] {
        let nm = Wavelengths::<64>::new().nm[chosen];
        let incidence = libm::asin(index.at(nm) * libm::sin(0.5 * apex));
        let least = 2.0 * incidence - apex;
        // Symmetric: horizontal inside. Outside it comes from and goes down by half the deviation.
        let toward = v(-libm::cos(0.5 * least), -libm::sin(0.5 * least), 0.0);
        let entry = v(-0.4, 0.3, 0.0);
        let ray = light_from(entry, Event::new(0.0, entry + toward * 3.0));
        let away = v(libm::cos(0.5 * least), -libm::sin(0.5 * least), 0.0);
        let far = 1e4;
        let screen = Body::new(&built(square()), glowing(flat(1.0)))
            .sized(2e3)
            .facing(-away)
            .mapped(DAffine3::from_translation(away * far));
        let part = plain(std::slice::from_ref(&prism), &screen, &ray)[chosen];
        let events = seen_on_screen(std::slice::from_ref(&prism), &screen, 2e3, &ray, part, (-4e4, 4e4));
        let seen = events[chosen].x - v(0.4, 0.3, 0.0);
        near_vector(seen / seen.length(), away, 2e-7 + 1e-4);
        let got = libm::acos((-ray.k.x).dot(seen / seen.length()));
        near(got, least, 2e-6);
    }
}

/// A room of one black body with glass, a mirror and water in it is that black body all over, moving or not.
#[test]
fn furnace_with_glass_in_it_stays_planck() {
    let velocity = beta(0.3, -0.5, 0.4);
    for moving in [Velocity::REST, velocity] {
        let room = Body::new(&built(cube()), glowing(black_body(4000.0))).sized(10.0);
        let ball = Body::new(&built(icosphere(3)), glass()).filled(Index::SF11);
        let block = Body::new(&built(cube()), glass()).sized(0.7).filled(GLASS);
        let block = block.mapped(DAffine3::from_translation(v(0.0, 2.5, 0.0)));
        let mirror = Body::new(&built(icosphere(2)), crate::support::mirror(1.0));
        let mirror = mirror.mapped(DAffine3::from_translation(v(2.5, 0.0, 0.0)));
        let mut stage = Stage::of([room, ball, block, mirror].map(|body| body.moving(moving)));
        stage.depth = 40;
        let scene = stage.scene();
        let mut dice = Dice(3);
        for _ in 0..20 {
            let eye = Event::new(0.0, v(-4.0, 1.0, 0.5));
            let aim = v(dice.between(-1.0, 3.0), dice.between(-1.0, 3.0), dice.between(-1.0, 1.0));
            let ray = light_from(aim, eye);
            let doppler = 1.0 / (Boost::<Rest, Lab>::to_moving(moving) * ray.k).t;
            for (nm, got) in Wavelengths::<64>::new().nm.iter().zip(look(&scene, &ray).radiance) {
                close(got, planck(*nm, 4000.0 * doppler), 1e-4);
            }
        }
    }
}

/// Water in a glass: the water's surface lies in that of the glass, and there is nothing between them.
#[test]
fn touching_media_have_no_gap_between_them() {
    // Two blocks that share the face x = 0.
    let left = half_space(Index::Constant(1.33), Velocity::REST)
        .mapped(DAffine3::from_scale(v(-1.0, 1.0, 1.0)).inverse());
    let right = half_space(GLASS, Velocity::REST);
    let glow = Body::new(&built(icosphere(2)), glowing(flat(1.0))).at(0.0, v(5.0, 0.0, 0.0));
    let from = Event::new(0.0, v(-3.0, 0.1, 0.0));
    let ray = light_from(v(5.0, 0.0, 0.0), from);
    let scene: Scene = Stage::of([left, right, glow]).scene();
    let r = ((1.5 - 1.33) / (1.5 + 1.33_f64)).powi(2);
    // The camera within the water sees L/n².
    close(look(&scene, &ray).radiance[0], (1.0 - r) / (1.5 * 1.5), 1e-3);
}
