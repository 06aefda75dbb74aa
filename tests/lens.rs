//! Pinholes, fisheyes and panoramas: which direction each place in a picture shows, and how much of it.

use crate::support::{
    Body, Dice, Eye, Heaven, Stage, along, black_body, built, close, frequency, glowing, icosphere,
    light_from, manifested, near, near_vector, pixel_centre, v,
};
use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use terrell::exposure::{Sampling, expose, expose_settled, first_hits};
use terrell::film::{Development, Reconstruction};
use terrell::lens::Lens;
use terrell::observer::View;
use terrell::spacetime::{Event, Velocity};
use terrell::spectrum::Wavelengths;
use terrell::surroundings::Star;
use terrell::texture::{Encoding, Picture, Texels};

fn eye(lens: Lens) -> Eye {
    Eye { lens, ..Eye::at(0.0, DVec3::ZERO) }
}

fn view(lens: Lens, width: u32, height: u32) -> View {
    eye(lens).observer().view(0.0, width, height)
}

fn sampling(width: u32, height: u32) -> Sampling {
    Sampling { width, height, samples: 1, reconstruction: Reconstruction::default(), wavelengths: 8 }
}

/// The solid angle of a pixel, by its corners: two triangles on the sphere (Van Oosterom and Strackee).
fn solid_angle(view: &View, pixel: DVec2) -> f64 {
    let corner = |x: f64, y: f64| view.direction(pixel + DVec2::new(x, y));
    let triangle = |a: DVec3, b: DVec3, c: DVec3| {
        let below = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        2.0 * libm::atan2(a.dot(b.cross(c)), below).abs()
    };
    let [a, b, c, d] = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
    triangle(a, b, c) + triangle(a, c, d)
}

#[test]
fn fisheye_has_angles_in_proportion_to_distances_from_the_middle() {
    let mut dice = Dice(1);
    for degrees in [20.0, 180.0, 360.0] {
        let across = degrees / 180.0 * PI;
        let view = view(Lens::Fisheye { across }, 200, 100);
        for _ in 0..200 {
            let (angle, around) = (dice.between(0.0, PI), dice.between(0.0, TAU));
            let (sin, cos) = libm::sincos(around);
            let radius = angle / across * 200.0;
            let pixel = DVec2::new(100.0, 50.0) + DVec2::new(cos, -sin) * radius;
            assert!(view.shows(pixel));
            let n = view.direction(pixel);
            near(n.length(), 1.0, 1e-14);
            near(libm::atan2(libm::hypot(n.x, n.y), -n.z), angle, 1e-12);
            near(n.x * sin - n.y * cos, 0.0, 1e-13);
            assert!(n.x * cos + n.y * sin >= 0.0);
        }
        assert!(!view.shows(DVec2::new(100.0 + 200.0 * PI / across * 1.0001, 50.0)));
    }
}

/// Longitudes across, from behind on the left by the middle ahead to behind on the right; latitudes down.
#[test]
fn panorama_has_longitudes_across_and_latitudes_down() {
    let view = view(Lens::Panorama, 400, 200);
    let at = |x: f64, y: f64| view.direction(DVec2::new(x, y));
    near_vector(at(200.0, 100.0), DVec3::NEG_Z, 1e-15);
    near_vector(at(300.0, 100.0), DVec3::X, 1e-15);
    near_vector(at(100.0, 100.0), DVec3::NEG_X, 1e-15);
    near_vector(at(0.0, 100.0), DVec3::Z, 1e-15);
    near_vector(at(17.0, 0.0), DVec3::Y, 1e-15);
    near_vector(at(17.0, 200.0), DVec3::NEG_Y, 1e-15);
    near_vector(at(250.0, 50.0), v(0.5, 0.5_f64.sqrt(), -0.5), 1e-15);
    let all: f64 = (0..400 * 200).map(|number| solid_angle(&view, pixel_centre(number, 400))).sum();
    close(all, 4.0 * PI, 1e-4);
}

#[test]
fn pixel_of_a_direction_shows_that_direction() {
    let mut dice = Dice(2);
    let lenses = [
        Lens::Pinhole { across: 1.2 },
        Lens::Fisheye { across: 0.7 },
        Lens::Fisheye { across: TAU },
        Lens::Panorama,
    ];
    for lens in lenses {
        let view = eye(lens).moving(dice.velocity(0.6)).observer().view(0.0, 64, 48);
        for _ in 0..300 {
            let ray = light_from(dice.direction() * 3.0, view.tetrad.event);
            match view.pixel_of(ray.k) {
                Some(pixel) => {
                    assert!(view.shows(pixel));
                    let back = view.ray(pixel).k;
                    near_vector(back.x / back.t, ray.k.x / ray.k.t, 1e-11);
                }
                None => assert!(matches!(lens, Lens::Pinhole { .. })),
            }
        }
    }
}

/// Of an observer at 0.9 c all around: each pixel shows the direction of the formula, and what is seen is all there is.
#[test]
fn panorama_of_a_moving_observer_is_aberrated_over_the_whole_sphere() {
    let velocity = Velocity::from_beta(v(0.5, -0.3, 0.68)).unwrap();
    let view = eye(Lens::Panorama).moving(velocity).observer().view(0.0, 240, 120);
    let (mut area, mut energy) = (0.0, 0.0);
    for number in 0..240 * 120 {
        let pixel = pixel_centre(number, 240);
        let (n, k) = (view.direction(pixel), view.ray(pixel).k);
        near_vector(k.x / k.t, along(-velocity, -n), 1e-13);
        // D: the frequency seen over the lab's.
        let doppler = 1.0 / k.t;
        close(doppler, 1.0 / frequency(-velocity, -n), 1e-12);
        let solid = solid_angle(&view, pixel);
        area += solid * doppler * doppler;
        energy += solid * doppler.powi(4);
    }
    // Solid angles are smaller by D² ahead: together they are the lab's sphere.
    close(area, 4.0 * PI, 2e-3);
    let (gamma, beta) = (velocity.gamma(), velocity.beta().length());
    close(energy / (4.0 * PI), gamma * gamma * (1.0 + beta * beta / 3.0), 2e-3);
}

/// Smooth, and different all around.
fn colours(d: DVec3) -> DVec3 {
    v(0.5 + 0.3 * d.x, 0.5 + 0.3 * d.y, 0.5 - 0.3 * d.z)
}

fn sky() -> Heaven {
    let (width, height) = (256, 128);
    let view = view(Lens::Panorama, width, height);
    let texel = |number: u32| {
        let [r, g, b] = colours(view.direction(pixel_centre(number as usize, width))).as_vec3().to_array();
        [r, g, b, 1.0]
    };
    let texels = Texels::Float((0..width * height).map(texel).collect());
    Heaven::picture(Arc::new(Picture::new(width, height, texels, Encoding::Linear)), 100.0)
}

#[test]
fn panorama_of_surroundings_is_their_picture() {
    let scene = Stage::of([]).under(sky()).seen_by(&eye(Lens::Panorama));
    let view = scene.observer.view(0.0, 64, 32);
    let negative = expose(&scene, &view, &sampling(64, 32));
    for (number, xyz) in negative.xyz.iter().enumerate() {
        let rgb = *terrell::color::RGB_FROM_XYZ * DVec3::from(xyz.map(f64::from));
        let (column, row) = (number as u32 % 64, number as u32 / 64);
        // Independent of the lens: longitude and latitude of the pixel.
        let (sin, cos) = libm::sincos((f64::from(column) + 0.5) / 64.0 * TAU - PI);
        let (up, level) = libm::sincos(0.5 * PI - (f64::from(row) + 0.5) / 32.0 * PI);
        let expected = colours(v(sin * level, up, -cos * level)) * 100.0;
        assert!((rgb - expected).length() < 2.0, "{column} {row}: {rgb} for {expected}");
    }
}

/// Balls all around, seen through six pinholes, a panorama and a whole fisheye by the same moving observer.
#[test]
fn pinholes_on_all_sides_stitched_together_are_the_panorama_and_the_fisheye() {
    let mut dice = Dice(4);
    let ball = |_| {
        let at = DAffine3::from_translation(dice.direction() * 4.0);
        Body::new(&built(icosphere(2)), glowing(black_body(3000.0 + 200.0 * dice.between(0.0, 20.0))))
            .mapped(at)
    };
    let stage = Stage::of((0..20).map(ball)).under(sky());
    let velocity = Velocity::from_beta(v(0.3, 0.2, -0.5)).unwrap();
    let six = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let faces = six.map(|axis| {
        let up = if axis.y.abs() > 0.5 { DVec3::Z } else { DVec3::Y };
        let eye = Eye { up, ..Eye::at(0.0, DVec3::ZERO).moving(velocity).toward(axis).wide(90.0) };
        let scene = stage.seen_by(&eye);
        let view = scene.observer.view(0.0, 128, 128);
        let negative = expose(&scene, &view, &sampling(128, 128));
        (view, negative)
    });
    for (lens, width, height) in [(Lens::Panorama, 128, 64), (Lens::Fisheye { across: TAU }, 96, 96)] {
        let scene = stage.seen_by(&eye(lens).moving(velocity));
        let view = scene.observer.view(0.0, width, height);
        let negative = expose(&scene, &view, &sampling(width, height));
        let (mut all, mut other) = (0, 0);
        for number in 0..(width * height) as usize {
            let pixel = pixel_centre(number, width);
            let own = DVec3::from(negative.xyz[number].map(f64::from));
            if !view.shows(pixel) {
                assert_eq!(own, DVec3::ZERO);
                continue;
            }
            let k = view.ray(pixel).k;
            let within = |at: &DVec2| at.min_element() >= -1e-9 && at.max_element() <= 128.0 + 1e-9;
            let face = faces.iter().find_map(|(face, picture)| {
                let at = face.pixel_of(k).filter(within)?;
                Some(picture.xyz[(at.y as usize).min(127) * 128 + (at.x as usize).min(127)])
            });
            let face = DVec3::from(face.unwrap().map(f64::from));
            all += 1;
            other += usize::from((own - face).length() > 0.05 * own.length());
        }
        // Those through which an outline passes are others.
        assert!(all > 5000 && other * 20 < all, "{lens:?}: {other} of {all}");
    }
}

#[test]
fn light_of_a_star_is_all_in_the_picture_wherever_it_stands() {
    let mut dice = Dice(6);
    for lens in [Lens::Panorama, Lens::Fisheye { across: PI }, Lens::Fisheye { across: TAU }] {
        for at in [v(0.1, 0.3, -1.0), v(0.9, -0.3, -0.4), v(0.02, 1.0, -0.05), dice.direction()] {
            let n = at / at.length();
            let star = Star::of_magnitude(n, 6000.0, 0.0);
            let scene = Stage::of([]).under(Heaven::stars([star])).seen_by(&eye(lens));
            let (width, height) = if lens == Lens::Panorama { (200, 100) } else { (140, 140) };
            let view = scene.observer.view(0.0, width, height);
            if view.pixel_of(light_from(n, Event::ORIGIN).k).is_none_or(|p| {
                p.min_element() < 3.0
                    || p.max_element() > 197.0
                    || (lens != Lens::Panorama && p.max_element() > 137.0)
            }) {
                continue;
            }
            let (lit, wavelengths) = (scene.lit(), Wavelengths::<16>::new());
            let fine = 3;
            let sum: f64 = (0..(width * height) as usize * fine * fine)
                .map(|number| {
                    let place = pixel_centre(number, width * fine as u32) / fine as f64;
                    let (ray, cone) = view.sight(place, 1.0);
                    let light = wavelengths.xyz(&lit.seen_within(&ray, cone, &wavelengths).radiance).y;
                    if light > 0.0 { light * solid_angle(&view, place) / (fine * fine) as f64 } else { 0.0 }
                })
                .sum();
            close(sum, star.illuminance, 0.02);
        }
    }
}

#[test]
fn what_a_fisheye_does_not_show_is_black_and_settled() {
    let scene = Stage::of([]).under(sky()).seen_by(&eye(Lens::Fisheye { across: TAU }));
    let view = scene.observer.view(0.0, 32, 32);
    let development = Development::new(100.0, 1.0);
    let settled = expose_settled(&scene.lit(), &view, &sampling(32, 32), &development, 1.0);
    assert_eq!(settled.negative.xyz[0], [0.0; 3]);
    assert!(settled.negative.xyz[16 * 32 + 16][1] > 1.0, "{:?}", settled.negative.xyz[16 * 32 + 16]);
    assert!(first_hits(&scene, &view, 32, 32).iter().all(Option::is_none));
}

#[test]
fn manifest_has_a_fisheye_of_180_degrees_unless_it_says_another() {
    let lens = |text: &str| {
        let text = format!("bodies: []\nobserver: {{ {text} }}\npicture: {{ size: 64 32 }}\noutput: out");
        manifested(&text).1.observer.lens
    };
    assert_eq!(lens("lens: fisheye"), Lens::Fisheye { across: PI });
    assert_eq!(lens("lens: fisheye, field_of_view: 360 deg"), Lens::Fisheye { across: TAU });
    assert_eq!(lens("lens: panorama"), Lens::Panorama);
    assert_eq!(lens("lens: pinhole"), Lens::Pinhole { across: 50.0 * PI / 180.0 });
}
