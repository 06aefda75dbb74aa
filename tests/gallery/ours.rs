//! The ten of our own: shapes and places. What is expected is derived here by hand, from the numbers in the manifests' comments.

use crate::support::{angle, close, emission_time, first, light_from, light_to, look, near, near_vector, v};
use glam::DVec3;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use terrell::error::Report;
use terrell::manifest::{self, Manifest};
use terrell::observer::View;
use terrell::plan::Plan;
use terrell::scene::{Scene, compose};
use terrell::spacetime::{Event, SightRay};
use terrell::spectrum::Wavelengths;

/// A manifest of the gallery, as it is committed but for what is given.
#[track_caller]
pub(super) fn committed(name: &str, overrides: &[(&str, &str)]) -> (Manifest, Scene, Plan) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("manifests/gallery/{name}.yaml"));
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect();
    let mut report = Report::default();
    let manifest = manifest::load_with(&path, &overrides, &mut report);
    let scene = manifest.as_ref().and_then(|manifest| compose(manifest, &path, &mut report));
    let plan = manifest.as_ref().zip(scene.as_ref());
    let plan = plan.map(|(manifest, scene)| Plan::of(manifest, scene, &path, &mut report));
    assert!(report.faults.is_empty() && report.warnings.is_empty(), "{report:?}");
    (manifest.unwrap(), scene.unwrap(), plan.unwrap())
}

pub(super) fn view(scene: &Scene, plan: &Plan, exposure: usize) -> View {
    scene.observer.view(plan.exposures[exposure].tau, plan.sampling.width, plan.sampling.height)
}

#[track_caller]
pub(super) fn number(manifest: &Manifest, name: &str) -> u32 {
    manifest.bodies.iter().position(|body| body.known_as() == name).unwrap() as u32
}

/// Luminance along a ray.
pub(super) fn luminance(scene: &Scene, ray: &SightRay) -> f64 {
    let light = look(scene, ray);
    (Wavelengths::<64>::new().xyz(&light.radiance) + light.lines).y
}

/// Where the light goes that comes along a ray, backwards: a unit vector in the lab.
pub(super) fn backwards(ray: &SightRay) -> DVec3 {
    -ray.k.x / ray.k.x.length()
}

/// Each pip of the five, and the one beside it, is seen where its light comes from; the front of the middle die is as wide as
/// cos of the angle by which it seems turned and the side as its sine, the angle being arcsin β.
#[test]
fn dice_seem_turned_by_the_arc_sine_of_their_speed() {
    let (manifest, scene, plan) = committed("dice", &[]);
    let arrival = view(&scene, &plan, 0).tetrad.event;
    let (beta, inverse_gamma, pip) = (0.8, 0.6, 0.24);
    for (name, middle) in [("moving_m1", -2.2), ("moving_0", 0.0), ("moving_1", 2.2), ("moving_2", 4.4)] {
        let apparent = |p: DVec3| {
            let path = |t: f64| v(middle + beta * (t + 9.5) + p.x * inverse_gamma, 2.0 + p.y, p.z);
            path(emission_time(arrival, path))
        };
        let body = number(&manifest, name);
        let is_pip = |p: DVec3, beside: DVec3| {
            let ray = light_from(apparent(p), arrival);
            let seen = first(&scene, &ray);
            assert_eq!(seen.body, body, "{name} {p}");
            near_vector(seen.emission.x, apparent(p), 0.1); // pips are 0.05 m deep
            let ivory = luminance(&scene, &light_from(apparent(beside), arrival));
            assert!(luminance(&scene, &ray) < 0.6 * ivory, "{name} {p}");
        };
        is_pip(v(0.0, 0.0, 0.5), v(0.0, 0.2, 0.5));
        for (y, z) in [(0.0, 0.0), (pip, pip), (pip, -pip), (-pip, pip), (-pip, -pip)] {
            is_pip(v(-0.5, y, z), v(-0.5, 0.0, pip));
        }
    }
    // Along a line across the middle die, between its pips: from which side of it each ray comes, by the normal.
    let body = number(&manifest, "moving_0");
    let steps = (-2000..2000).map(|step| f64::from(step) * 5e-4);
    let (mut front, mut side) = (0.0, 0.0);
    for x in steps {
        let Some(seen) = scene.lit().first(&light_from(v(x, 2.12, 0.0), arrival)) else { continue };
        if seen.body == body {
            let along = if seen.normal.x.z > 0.7 { &mut front } else { &mut side };
            *along += 5e-4;
        }
    }
    // The near edge of the side is nearer than its far one: two degrees are left for perspective.
    near(libm::atan2(side, front).to_degrees(), libm::asin(beta).to_degrees(), 2.0);
    close(libm::hypot(side, front), 1.0, 0.07);
    // At rest the same die shows its front alone.
    let at_rest = |x: f64| scene.lit().first(&light_from(v(x, 0.62, 0.0), arrival)).unwrap();
    assert!((-38..=38).all(|step| at_rest(f64::from(step) * 0.01).normal.x.z > 0.7));
}

/// tan(θ/2) = √((1 + β)/(1 - β)) tan(θ'/2), in every part of the picture.
#[test]
fn streets_are_drawn_together_by_aberration() {
    let names = [("street", 0.0_f64), ("street_05c", 0.5), ("street_09c", 0.9), ("street_099c", 0.99)];
    for (name, beta) in names {
        let (_, scene, plan) = committed(name, &[]);
        let view = view(&scene, &plan, 0);
        let (width, height) = (f64::from(plan.sampling.width), f64::from(plan.sampling.height));
        let ahead = v(1.0, 0.12, -0.02).normalize();
        let right = ahead.cross(DVec3::Y).normalize();
        let mut widest = 0.0_f64;
        for (x, y) in [(0.0, 0.5), (0.2, 0.1), (0.5, 0.5), (0.7, 0.9), (1.0, 0.6)] {
            // 90 degrees across.
            let (across, up) = (2.0 * x - 1.0, (1.0 - 2.0 * y) * height / width);
            let seen = ahead + right * across + right.cross(ahead) * up;
            let there = 2.0
                * libm::atan(((1.0 + beta) / (1.0 - beta)).sqrt() * libm::tan(0.5 * angle(seen, DVec3::X)));
            let ray = view.ray(glam::DVec2::new(x * width, y * height));
            near(angle(backwards(&ray), DVec3::X), there, 1e-9);
            widest = widest.max(there);
        }
        // At 0.99 c the edges of the picture look back.
        assert!((widest.to_degrees() > 150.0) == (beta > 0.95), "{widest}");
    }
}

/// All cameras stand on a circle around where the car is at one instant of the lab, and are released then; what they see left the
/// car at other times.
#[test]
fn turntable_is_frozen() {
    let (manifest, scene, plan) = committed("turntable", &[]);
    let car = number(&manifest, "car");
    assert_eq!(plan.exposures.len(), 96);
    let mut before = None;
    for exposure in 0..96 {
        let view = view(&scene, &plan, exposure);
        let event = view.tetrad.event;
        near(event.t, 0.0, 1e-12);
        near_vector(event.x - event.x.with_y(0.0), v(0.0, 1.52, 0.0), 1e-12);
        near(event.x.with_y(0.0).length(), 5.7, 1e-12);
        near((view.tetrad.velocity().t - 1.0).abs(), 0.0, 1e-15);
        if let Some(before) = before {
            near(angle(event.x.with_y(0.0), before), TAU / 96.0, 1e-12);
        }
        before = Some(event.x.with_y(0.0));
    }
    // Nose and tail, from ahead and from behind: how far they are from its middle is seen of the car at rest.
    let (_, resting, _) = committed("turntable", &[("bodies.car.velocity", "~")]);
    let inverse_gamma = 0.84_f64.sqrt();
    for (exposure, end) in [(24, 1.0), (72, -1.0)] {
        let event = view(&scene, &plan, exposure).tetrad.event;
        near_vector(event.x, v(5.7 * end, 1.52, 0.0), 1e-9);
        let own = first(&resting, &light_from(v(2.0 * end, 0.6, 0.0), event)).emission.x;
        assert!((1.9..2.1).contains(&(own.x * end)), "{own}");
        let path = |t: f64| v(own.x * inverse_gamma + 0.4 * t, own.y, 0.0);
        let apparent = path(emission_time(event, path));
        let seen = first(&scene, &light_from(apparent, event));
        assert_eq!(seen.body, car);
        near_vector(seen.emission.x, apparent, 0.02);
        // By hand, for one who looks along its way: x (1 - β) = n/γ - 5.7 β from ahead.
        let by_hand = (own.x * inverse_gamma - 5.7 * 0.4) / (1.0 - 0.4 * end);
        near(apparent.x, by_hand, 0.05);
    }
}

/// 1 m/s where light goes at 1.25 m/s: the walker's clock, the speed in the middle, and how far back one sees.
#[test]
fn walk_is_at_a_metre_in_a_second() {
    let (_, scene, plan) = committed("slow_walk", &[]);
    let second = 1.25; // in metres of light travel
    let ends = [0, plan.exposures.len() - 1].map(|exposure| view(&scene, &plan, exposure).tetrad);
    for (end, (z, t)) in ends.iter().zip([(-3.0, 0.0), (-14.0, 16.0)]) {
        near_vector(end.event.x, v(0.0, 1.7, z), 0.01);
        near(end.event.t, t * second, 0.1);
        near(end.velocity().t, 1.0, 1e-3);
    }
    // The proper time of a way whose speed goes up and down as 3u² - 2u³ in three seconds, by the midpoint rule.
    let ramp = |u: f64| 0.8 * u * u * (3.0 - 2.0 * u);
    let steps = 1000;
    let part: f64 =
        (0..steps).map(|i| (1.0 - ramp((f64::from(i) + 0.5) / 1000.0).powi(2)).sqrt() / 1000.0).sum();
    let own = 2.0 + 8.0 * 0.6 + 2.0 * 3.0 * part;
    close(plan.exposures.last().unwrap().tau / second, own, 3e-3);
    let middle = view(&scene, &plan, plan.exposures.len() / 2);
    let velocity = middle.tetrad.velocity();
    near_vector(velocity.x / velocity.t, v(0.0, 0.0, -0.8), 1e-3);
    // The edge of the picture, 40 degrees from ahead, shows what is 95 degrees from it: tan(θ/2) = 3 tan 20°.
    let edge = middle.ray(glam::DVec2::new(0.0, 0.5 * f64::from(plan.sampling.height)));
    let back = 2.0 * libm::atan(3.0 * libm::tan(20.0_f64.to_radians()));
    assert!(back > 0.5 * PI);
    near(angle(backwards(&edge), DVec3::NEG_Z), back, 0.01); // it looks up a little
}

/// Ten thousand velocities, no two alike, to all sides, rapidities even up to that of 0.8 c; and each die that is seen has the Doppler
/// factor and the place of its own.
#[test]
fn swarm_has_ten_thousand_velocities() {
    let (manifest, scene, plan) = committed("swarm", &[]);
    let all = manifest.bodies[0].placements();
    assert_eq!((all.len(), scene.world.frames.len()), (10_000, 10_000));
    let fastest = libm::atanh(0.8);
    let mean = |of: &dyn Fn(&manifest::Placement) -> f64| all.iter().map(of).sum::<f64>() / 1e4;
    // Within four of the mean's own deviations.
    near(mean(&|one| one.velocity.rapidity()), 0.5 * fastest, 4.0 * fastest / 12.0_f64.sqrt() / 100.0);
    for axis in 0..3 {
        let to = |one: &manifest::Placement| one.velocity.proper().normalize()[axis];
        near(mean(&to), 0.0, 4.0 / 3.0_f64.sqrt() / 100.0);
        near(mean(&|one| to(one) * to(one)), 1.0 / 3.0, 4.0 * 0.3 / 100.0);
        let half = 0.5 * v(90.0, 50.0, 90.0)[axis];
        assert!(all.iter().all(|one| one.at[axis].abs() <= half));
        near(mean(&|one| one.at[axis]), 0.0, 4.0 * half / 3.0_f64.sqrt() / 100.0);
    }
    // A turn of all turns alike takes an axis everywhere.
    near_vector(
        all.iter().fold(DVec3::ZERO, |sum, one| sum + one.rotation * DVec3::Z) / 1e4,
        DVec3::ZERO,
        0.04,
    );
    let bits: BTreeSet<[u64; 3]> =
        all.iter().map(|one| one.velocity.proper().to_array().map(f64::to_bits)).collect();
    assert_eq!(bits.len(), 10_000);
    // Where the first of them are seen something is met, there or before.
    let view = view(&scene, &plan, 0);
    let arrival = view.tetrad.event;
    let mut own = 0;
    for one in &all[..300] {
        let path = |t: f64| one.at + one.velocity.beta() * (t - one.at_time);
        let sent = emission_time(arrival, path);
        let ray = light_to(arrival.x, Event::new(sent, path(sent)));
        let met = first(&scene, &light_from(path(sent), arrival));
        let way = arrival.t - sent;
        assert!((ray.event - arrival).t.abs() < 1e-9 && met.s < way);
        own += usize::from(met.s > way - 0.6 * 3.0_f64.sqrt());
    }
    assert!(own > 30, "{own}");
}
