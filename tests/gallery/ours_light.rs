//! The ten of our own: shifted, reflected and refracted light, and the stars'.

use super::ours::{backwards, committed, luminance, number, view};
use crate::support::{
    along, angle, close, edge, emission_time, exposed, first, frequency, light_from, look, near, near_vector,
    pixel_centre, speed, v,
};
use glam::DVec3;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::Path;
use terrell::color::xyz_of;
use terrell::spacetime::{Event, SightRay, Velocity};
use terrell::spectrum::{Wavelengths, planck};

/// A ray from a direction of the lab as one who moves has it: frequency 1 for him.
fn ray_of(arrival: Event, velocity: Velocity, toward: DVec3) -> SightRay {
    let ray = light_from(arrival.x + toward, arrival);
    SightRay { k: ray.k * (1.0 / frequency(velocity, -toward.normalize())), ..ray }
}

/// What a ball at rest does to a ray that goes back along `n` from `x`: where it goes on, and along what.
fn by_ball(x: DVec3, n: DVec3, radius: f64, glass: Option<f64>) -> DVec3 {
    let meet = |x: DVec3, n: DVec3, far: f64| {
        let half = x.dot(n);
        x + n * (far * (half * half - x.length_squared() + radius * radius).sqrt() - half)
    };
    let entry = meet(x, n, -1.0);
    let normal = entry / radius;
    let Some(index) = glass else { return n - normal * (2.0 * n.dot(normal)) };
    let refracted = |n: DVec3, normal: DVec3, ratio: f64| {
        let across = (n - normal * n.dot(normal)) / ratio;
        across + normal * ((1.0 - across.length_squared()).sqrt() * n.dot(normal).signum())
    };
    let inside = refracted(n, normal, index);
    let exit = meet(entry, inside, 1.0);
    refracted(inside, exit / radius, 1.0 / index)
}

/// They pass each other at 0.8 c, and each shifts what it turns aside: in the ball's rest frame the frequency stays, in the hall
/// it changes with the direction.
#[test]
fn balls_that_pass_shift_the_light_that_they_turn_aside() {
    let lines = ["lights.0", "lights.1", "lights.2"].map(|light| format!("{light}.lamp.spectrum"));
    let mut overrides: Vec<(&str, &str)> =
        lines.iter().map(|key| (key.as_str(), "{ line: 550 nm }")).collect();
    overrides.extend([("ambient", "~"), ("surroundings", "~")]);
    let (manifest, scene, plan) = committed("passing", &overrides);
    let velocity = |name: &str| manifest.bodies[number(&manifest, name) as usize].placement.velocity;
    let (glass, gold) = (velocity("glass"), velocity("gold"));
    close(glass.gamma() * gold.gamma() - glass.proper().dot(gold.proper()), 1.0 / 0.6, 1e-12);
    // The middle of the way of each as it is seen, 4 m and 7 m from the camera.
    let gamma = 1.0 / 0.75_f64.sqrt();
    for (name, own, start, index) in
        [("glass", glass, v(0.0, 1.3, -9.0), Some(1.5)), ("gold", gold, v(0.0, 1.3, -12.0), None)]
    {
        let mut wavelengths = Vec::new();
        for (exposure, offset) in
            [24, 30, 36, 52, 58, 64, 70].into_iter().flat_map(|e| [-0.3, 0.0, 0.25].map(|x| (e, x)))
        {
            let arrival = view(&scene, &plan, exposure).tetrad.event;
            let path = |t: f64| start + own.beta() * t + v(offset, 0.3, 0.0);
            let ray = light_from(path(emission_time(arrival, path)), arrival);
            let body = scene.lit().first(&ray).map(|seen| seen.body);
            if body != Some(number(&manifest, name)) {
                continue; // the other one is before it
            }
            // Into the rest frame, by hand: it moves along x.
            let (since, b) = (arrival.t, own.beta().x);
            let there = arrival.x - start;
            let x = v(gamma * (there.x - b * since), there.y, there.z);
            let n = along(own, -backwards(&ray));
            let before = by_ball(x, -n, 0.9, index);
            let ratio = frequency(-own, -before) / frequency(-own, n);
            let seen = scene.lit().lines_along(&ray);
            let total: f64 = seen.iter().map(|line| line.power).sum();
            if total <= 0.0 {
                continue; // a shadow
            }
            let expected = 550.0 * ratio;
            let near = seen.iter().filter(|line| (line.wavelength_nm - expected).abs() < 0.01);
            // Others meet the other ball, whose light has another shift.
            if near.map(|line| line.power).sum::<f64>() > 0.5 * total {
                wavelengths.push(expected);
            }
        }
        let (least, most) = wavelengths.iter().fold((1e9_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
        assert!(wavelengths.len() >= 6 && most - least > 50.0, "{name}: {wavelengths:?}");
    }
}

/// SF11's index by Schott's own formula, in µm.
fn sf11(nm: f64) -> f64 {
    let w = nm * nm * 1e-6;
    let terms = [(1.737_596_95, 0.013_188_707), (0.313_747_346, 0.062_306_814_2), (1.898_781_01, 155.236_29)];
    (1.0 + terms.iter().map(|(b, c)| b * w / (w - c)).sum::<f64>()).sqrt()
}

/// A ray that goes back from `eye` at an angle, and on through the prism: by how much it passes beside the slit's middle, and how wide
/// half of the slit is for it.
fn misses(eye: DVec3, bearing: f64, index: f64) -> (f64, f64) {
    let (half, top, slit) = (0.5 * 3.0_f64.sqrt(), v(0.0, 0.0, 0.5), v(6.7, 0.0, -4.3));
    let mut n = v(libm::cos(bearing), 0.0, libm::sin(bearing));
    let mut x = eye;
    for (normal, ratio) in [(v(-half, 0.0, 0.5), index), (v(half, 0.0, 0.5), 1.0 / index)] {
        x += n * ((top - x).dot(normal) / n.dot(normal));
        let across = (n - normal * n.dot(normal)) / ratio;
        n = across + normal * ((1.0 - across.length_squared()).sqrt() * n.dot(normal).signum());
    }
    let turn = 57.0_f64.to_radians();
    let half = v(libm::cos(turn), 0.0, -libm::sin(turn)) * 0.03;
    ((slit - x).cross(n).y, half.cross(n).length())
}

/// Each wavelength is where Snell's law has it, and at 0.5 c the rainbow is narrower.
#[test]
fn rainbows_are_where_snell_says() {
    let (mut widths, eye) = (Vec::new(), v(-4.2, 0.0, -2.7));
    for (name, beta) in [("prism", DVec3::ZERO), ("prism_05c", v(0.425, 0.0, 0.263))] {
        let (_, scene, plan) = committed(name, &[]);
        let arrival = view(&scene, &plan, 0).tetrad.event;
        near_vector(arrival.x, eye, 1e-12);
        let velocity = Velocity::from_beta(beta).unwrap();
        let nm = Wavelengths::<64>::new().nm;
        let slit = look(&scene, &ray_of(arrival, velocity, v(6.7, 0.0, -4.3) - eye)).radiance;
        let brightest = slit.iter().copied().fold(0.0, f64::max);
        assert!(brightest > 0.0);
        let mut seen = Vec::new();
        for wanted in [450.0, 500.0, 550.0, 600.0, 650.0] {
            // The wavelength in the glass is longer by the Doppler factor, which the direction decides, and the other way round.
            let (mut bearing, mut ray) = (0.6, ray_of(arrival, velocity, DVec3::X));
            for _ in 0..30 {
                let index = sf11(wanted / ray.k.t);
                bearing = edge(0.5, 0.7, |bearing| misses(eye, bearing, index).0 > 0.0);
                ray = ray_of(arrival, velocity, v(libm::cos(bearing), 0.0, libm::sin(bearing)));
            }
            // Which of the wavelengths that arrive there come from the slit.
            let light = look(&scene, &ray).radiance;
            let mut from_slit = 0;
            for (light, nm) in light.iter().zip(&nm) {
                let (beside, half) = misses(eye, bearing, sf11(nm / ray.k.t));
                let beside = beside.abs() / half;
                // The slit is a centimetre thick: that much more is seen of it.
                if !(0.9..1.5).contains(&beside) {
                    assert_eq!(*light > 0.1 * brightest, beside < 1.0, "{name} {wanted}: {nm} {beside}");
                    from_slit += usize::from(beside < 1.0);
                }
            }
            assert!(from_slit > 0 && from_slit < 60, "{name} {wanted}: {from_slit}");
            seen.push(-along(velocity, -backwards(&ray)));
        }
        widths.push(angle(seen[0], seen[4]));
    }
    assert!(widths[1] < 0.4 * widths[0], "{widths:?}");
}

/// Which lamp of each clock is seen lit, directly and in both mirrors: seconds 0, 7 and 3. The light of a picture in a mirror left the
/// clock where the mirror's own motion has its image.
#[test]
fn moving_mirrors_show_an_earlier_past() {
    let (manifest, scene, plan) = committed("mirrors", &[]);
    let arrival = view(&scene, &plan, 0).tetrad.event;
    let now = 3.0 * 14.7;
    near(arrival.t, now, 1e-9);
    let beta = 0.3_f64;
    let gamma = 1.0 / (1.0 - beta * beta).sqrt();
    // Where a mirror's face is now, and how it moves; the place of what is at z and t, as its image has it.
    let image = |beta: f64, gamma: f64, face: f64, (t, z): (f64, f64)| {
        let (t, z) = (t - now, z - face);
        let (t, z) = (gamma * (t - beta * z), gamma * (beta * t - z));
        (now + gamma * (t + beta * z), face + gamma * (z + beta * t))
    };
    let resting = |event| image(0.0, 1.0, -4.0 + 0.05, event);
    let coming = |event| image(beta, gamma, -4.0 + 0.05 / gamma, event);
    let direct = |event| event;
    type Seen<'s> = (&'s str, f64, &'s dyn Fn((f64, f64)) -> (f64, f64), usize);
    let all: [Seen<'_>; 4] = [
        ("", -2.6, &direct, 0),
        ("", 2.6, &direct, 0),
        ("resting", -2.6, &resting, 7),
        ("coming", 2.6, &coming, 3),
    ];
    for (mirror, middle, seen_at, hour) in all {
        let mut lit = Vec::new();
        for lamp in 0..12 {
            let turn = f64::from(lamp) / 12.0 * TAU;
            let (x, y) = (middle + libm::sin(turn), 2.2 + libm::cos(turn));
            let late = |t: f64| {
                let (then, z) = seen_at((t, 4.0));
                now - then - (v(x, y, z) - arrival.x).length()
            };
            let early = edge(now - 100.0, now, |t| late(t) > 0.0);
            let ray = light_from(v(x, y, seen_at((early, 4.0)).1), arrival);
            if !mirror.is_empty() {
                assert_eq!(first(&scene, &ray).body, number(&manifest, mirror));
            }
            let shines = luminance(&scene, &ray) > 100.0;
            let second = early / 3.0 - f64::from(lamp);
            assert_eq!(shines, second - 12.0 * (second / 12.0).floor() < 1.0, "{mirror} {lamp} {second}");
            if shines {
                lit.push(lamp as usize);
            }
        }
        assert_eq!(lit, [hour], "{mirror}");
    }
}

/// The lamp's one line, shifted on the way to each head and on the way back.
#[test]
fn sodium_light_is_shifted_twice() {
    let (manifest, scene, plan) = committed("hall", &[]);
    let arrival = view(&scene, &plan, 0).tetrad.event;
    let lamp = v(0.0, 3.2, -4.0);
    let heads = [
        ("going_5", -2.7, -0.05, 647.0),
        ("going_2", -1.8, -0.025, 619.0),
        ("resting", -0.9, 0.0, 589.0),
        ("coming_4", 0.0, 0.04, 544.0),
        ("coming_8", 0.9, 0.08, 503.0),
        ("coming_11", 1.8, 0.11, 476.0),
        ("coming_14", 2.7, 0.14, 452.0),
    ];
    let mut seen_at_all = BTreeSet::new();
    for (name, x, beta, said) in heads {
        let body = number(&manifest, name);
        let height = manifest.bodies[body as usize].placement.at.y;
        let path = |t: f64| v(x, height + 0.1, -12.0 + beta * (t + 8.0));
        let ray = light_from(path(emission_time(arrival, path)), arrival);
        let seen = first(&scene, &ray);
        assert_eq!(seen.body, body);
        let (to, from) = ((seen.emission.x - lamp).normalize(), (arrival.x - seen.emission.x).normalize());
        let expected = 589.3 * (1.0 - beta * from.z) / (1.0 - beta * to.z);
        let lines = scene.lit().lines_along(&ray);
        let line = lines.iter().max_by(|a, b| a.power.total_cmp(&b.power)).unwrap();
        close(line.wavelength_nm, expected, 1e-9);
        near(expected, said, 1.0);
        seen_at_all.insert(expected as u32);
    }
    assert_eq!(seen_at_all.len(), 7);
    // All that rests has one colour, whatever its paint.
    let view = view(&scene, &plan, 0);
    for number in 0..400 {
        let pixel =
            glam::DVec2::new(f64::from(number % 20) * 80.0 + 3.0, f64::from(number / 20) * 45.0 + 2.0);
        let ray = view.ray(pixel);
        if first(&scene, &ray).body == 0 {
            assert!(look(&scene, &ray).radiance.iter().all(|radiance| *radiance <= 0.0));
            scene.lit().lines_along(&ray).iter().for_each(|line| close(line.wavelength_nm, 589.3, 1e-12));
        }
    }
}

/// The stars of the catalogue as one who flies to Orion sees them: directions by aberration, brightness by black bodies
/// that are D times as hot, over a sky drawn together by D².
#[test]
fn sky_ahead_has_the_light_of_the_stars_that_are_crowded_there() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/bright_stars.csv"));
    let text = text.unwrap();
    let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    let stars: Vec<[f64; 4]> = rows
        .map(|line| {
            let mut cells = line.split(',').map(|cell| cell.parse().unwrap());
            std::array::from_fn(|_| cells.next().unwrap())
        })
        .collect();
    assert_eq!(stars.len(), 509);
    // Sirius, Betelgeuse and Polaris are where everybody knows them.
    let brightest = stars.iter().min_by(|a, b| a[2].total_cmp(&b[2])).unwrap();
    assert!((brightest[0] - 101.3).abs() < 0.3 && (brightest[1] + 16.7).abs() < 0.1);
    assert!(stars.iter().any(|star| star[1] > 89.0 && (star[2] - 2.0).abs() < 0.1));
    assert!(stars.iter().any(|star| (star[0] - 88.8).abs() < 0.4 && star[3] < 3700.0));

    let ahead = v(-0.9945, 0.0, -0.1045).normalize();
    let within = 20.0_f64.to_radians();
    let mut counts = Vec::new();
    for (name, beta) in
        [("night_sky", 0.0), ("night_sky_05c", 0.5), ("night_sky_09c", 0.9), ("night_sky_099c", 0.99)]
    {
        let (_, scene, plan) = committed(name, &[("surroundings.uniform", "~")]);
        let own = speed(beta + 1e-15, ahead);
        let (mut light, mut count) = (0.0, 0);
        for [ascension, declination, magnitude, kelvin] in &stars {
            let (a, d) = (ascension.to_radians(), declination.to_radians());
            let there = v(-libm::sin(a) * libm::cos(d), libm::sin(d), -libm::cos(a) * libm::cos(d));
            let seen = -along(own, -there);
            if angle(seen, ahead) > within {
                continue;
            }
            let doppler = frequency(own, -there);
            let body = |kelvin: f64| xyz_of(|nm| planck(nm, kelvin)).y;
            let lux = 2.54e-6 * libm::pow(10.0, -0.4 * magnitude);
            light += lux * body(doppler * kelvin) / body(*kelvin) / (doppler * doppler);
            count += 1;
        }
        counts.push(f64::from(count));
        let (width, height) = (320, 180);
        let view = scene.observer.view(plan.exposures[0].tau, width, height);
        let pictured = exposed::<16>(&scene, plan.exposures[0].tau, (width, height));
        let focal = 0.5 * f64::from(width) / libm::tan(40.0_f64.to_radians());
        let mut sum = 0.0;
        for (number, xyz) in pictured.iter().enumerate() {
            let pixel = pixel_centre(number, width);
            let cosine = -view.direction(pixel).normalize().z;
            if libm::acos(cosine.min(1.0)) < within {
                sum += xyz.y * cosine * cosine * cosine / (focal * focal);
            }
        }
        close(sum, light, 0.04);
    }
    // Within 20 degrees there is what was within 2 atan(D tan 10°): 33.9, 75.1 and 136.2 degrees; more stars, all told, by that much sky.
    let sky = |beta: f64| {
        let half = libm::atan(((1.0 + beta) / (1.0 - beta)).sqrt() * libm::tan(0.5 * within));
        libm::pow(libm::sin(half), 2.0) * 509.0
    };
    for (count, beta) in counts.iter().zip([0.0, 0.5, 0.9, 0.99]) {
        let even = sky(beta);
        // Orion is richer than the mean of the sky.
        assert!(
            *count > even - 3.0 * even.sqrt() && *count < 2.0 * even + 3.0 * even.sqrt(),
            "{count} {even}"
        );
    }
    assert!(counts.windows(2).all(|pair| pair[1] > 2.0 * pair[0]), "{counts:?}");
}
