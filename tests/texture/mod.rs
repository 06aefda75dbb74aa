//! The mean of a texture over what a sample sees.

mod horizon;

use super::support::Dice;
use glam::{DAffine2, DVec2};
use std::sync::Arc;
use terrell::texture::{Encoding, Filter, Footprint, Picture, Texels, Texture, Wrap};

/// A texture of floats, bytes or words as it would come from a file.
fn texture(width: u32, height: u32, texels: Texels, encoding: Encoding) -> Texture {
    Texture {
        picture: Arc::new(Picture::new(width, height, texels, encoding)),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
        uv_set: 0,
        transform: DAffine2::IDENTITY,
    }
}

/// Opaque noise.
fn noise(width: u32, height: u32, dice: &mut Dice) -> Vec<[f32; 4]> {
    let mut value = || dice.between(0.0, 1.0) as f32;
    (0..width * height).map(|_| [value(), value(), value(), 1.0]).collect()
}

fn bytes(texels: &[[f32; 4]]) -> Vec<[u8; 4]> {
    texels.iter().map(|texel| texel.map(|c| (c * 255.0).round() as u8)).collect()
}

fn round(radius: f64) -> Footprint {
    Footprint { u: DVec2::new(radius, 0.0), v: DVec2::new(0.0, radius) }
}

fn footprint(dice: &mut Dice, longest: f64) -> Footprint {
    let size = longest * libm::exp(-dice.between(0.0, 6.0));
    let mut axis = || DVec2::new(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)) * size;
    Footprint { u: axis(), v: axis() * 0.3 }
}

fn place(dice: &mut Dice) -> DVec2 {
    DVec2::new(dice.between(-3.0, 3.0), dice.between(-3.0, 3.0))
}

/// The largest difference in a channel.
fn apart(a: [f32; 4], b: [f32; 4]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Pictures of noise in every kind of storage, of sizes that are powers of two and not.
fn pictures(dice: &mut Dice) -> Vec<Texture> {
    let mut all = Vec::new();
    for (width, height) in [(1, 1), (64, 64), (61, 37), (1, 50), (96, 5)] {
        let floats = noise(width, height, dice);
        let small = bytes(&floats);
        let words: Vec<_> = small.iter().map(|texel| texel.map(|c| u16::from(c) * 257)).collect();
        all.push(texture(width, height, Texels::Float(floats), Encoding::Linear));
        for encoding in [Encoding::Srgb, Encoding::Linear] {
            all.push(texture(width, height, Texels::Byte(small.clone()), encoding));
            all.push(texture(width, height, Texels::Word(words.clone()), encoding));
        }
    }
    all
}

/// The mean of all texels' linear values, each looked up at its centre.
fn mean(texture: &Texture) -> [f32; 4] {
    let (width, height) = (texture.picture.width, texture.picture.height);
    let mut sum = [0.0; 4];
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let value = texture.rgba(centre / DVec2::new(f64::from(width), f64::from(height)));
        for (sum, value) in sum.iter_mut().zip(value) {
            *sum += f64::from(value);
        }
    }
    sum.map(|sum| (sum / f64::from(width * height)) as f32)
}

#[test]
fn sample_that_sees_no_more_than_a_texel_gets_the_bits_of_the_point() {
    let mut dice = Dice(1);
    for mut texture in pictures(&mut dice) {
        let (width, height) = (texture.picture.width, texture.picture.height);
        for filter in [Filter::Linear, Filter::Nearest] {
            texture.filter = filter;
            for _ in 0..20 {
                let uv = place(&mut dice);
                let turn = DVec2::from_angle(dice.between(0.0, 6.0)) * 0.4999;
                let size = DVec2::new(f64::from(width), f64::from(height));
                let seen = Footprint { u: turn / size, v: turn.perp() / size };
                assert_eq!(texture.over(uv, &seen), texture.rgba(uv));
            }
        }
    }
}

#[test]
fn sample_that_sees_everything_gets_the_mean_of_the_linear_values() {
    let mut dice = Dice(2);
    for texture in pictures(&mut dice) {
        let expected = mean(&texture);
        assert!(apart(texture.picture.pyramid().mean(), expected) < 1e-6);
        for size in [1e3, 1e100, f64::MAX, f64::INFINITY, f64::NAN] {
            let got = texture.over(place(&mut dice), &round(size));
            assert!(apart(got, expected) < 1e-6, "{got:?} for {expected:?} over {size}");
        }
        let got = texture.over(DVec2::NAN, &Footprint { u: DVec2::NAN, v: DVec2::ZERO });
        assert!(apart(got, expected) < 1e-6, "{got:?} for {expected:?}");
        // The last level before the mean is the mean to within a step of its storage.
        let size = f64::from(texture.picture.width.max(texture.picture.height));
        let ripple = apart(texture.over(place(&mut dice), &round(size * 0.75)), expected);
        assert!(ripple < 4e-5, "{ripple}");
    }
}

/// A picture all of one texel, in every kind of storage, with the coarseness of its levels: half a step of 16 bits,
/// and of 16 bits of a square root.
fn plain(width: u32, height: u32, texel: [u8; 4]) -> [(Texture, f32); 5] {
    let count = (width * height) as usize;
    let bytes = Texels::Byte(vec![texel; count]);
    let words = Texels::Word(vec![texel.map(|c| u16::from(c) * 257); count]);
    let floats = Texels::Float(vec![texel.map(|c| f32::from(c) / 255.0); count]);
    [
        (floats, Encoding::Linear, 0.0),
        (words.clone(), Encoding::Linear, 0.5 / 65535.0),
        (bytes.clone(), Encoding::Linear, 0.5 / 65535.0),
        (words, Encoding::Srgb, 1.0 / 65535.0),
        (bytes, Encoding::Srgb, 1.0 / 65535.0),
    ]
    .map(|(texels, encoding, coarse)| (texture(width, height, texels, encoding), coarse + 1e-6))
}

#[test]
fn one_colour_stays_that_colour_over_every_footprint() {
    let mut dice = Dice(3);
    for stored in [0, 1, 9, 77, 188, 255] {
        let pictures = [plain(16, 16, [stored, 255, stored, 255]), plain(13, 29, [stored, 255, stored, 255])];
        for (texture, coarse) in pictures.as_flattened() {
            for _ in 0..50 {
                let (uv, seen) = (place(&mut dice), footprint(&mut dice, 2.0));
                assert!(apart(texture.over(uv, &seen), texture.rgba(uv)) <= *coarse);
            }
        }
    }
}

#[test]
fn one_colour_half_or_hardly_there_stays_that_colour() {
    let mut dice = Dice(13);
    for alpha in [128, 20, 1] {
        for (texture, coarse) in plain(13, 29, [188, 255, 9, alpha]) {
            // Both the colour, multiplied by alpha, and alpha are so coarse.
            let coarse = 2.0 * coarse / (f32::from(alpha) / 255.0).sqrt();
            for _ in 0..50 {
                let (uv, seen) = (place(&mut dice), footprint(&mut dice, 2.0));
                assert!(apart(texture.over(uv, &seen), texture.rgba(uv)) <= coarse);
            }
        }
    }
    for (texture, _) in plain(13, 29, [188, 255, 9, 0]) {
        assert_eq!(texture.over(DVec2::ZERO, &round(0.5))[3], 0.0);
    }
}

#[test]
fn it_is_linear_in_the_texels() {
    let mut dice = Dice(4);
    for (width, height) in [(32, 32), (27, 45)] {
        let [a, b] = [(); 2].map(|()| noise(width, height, &mut dice));
        let both = a.iter().zip(&b).map(|(a, b)| [0, 1, 2, 3].map(|i| 0.25 * a[i] + 0.75 * b[i])).collect();
        let [a, b, both] = [a, b, both].map(|t| texture(width, height, Texels::Float(t), Encoding::Linear));
        for _ in 0..200 {
            let (uv, seen) = (place(&mut dice), footprint(&mut dice, 2.0));
            let [a, b, both] = [&a, &b, &both].map(|texture| texture.over(uv, &seen));
            assert!(apart(both, [0, 1, 2, 3].map(|i| 0.25 * a[i] + 0.75 * b[i])) < 1e-6);
        }
    }
}

#[test]
fn any_two_conjugate_axes_of_an_ellipse_give_the_same() {
    let mut dice = Dice(5);
    for texture in pictures(&mut dice) {
        for _ in 0..50 {
            let (uv, seen) = (place(&mut dice), footprint(&mut dice, 1.0));
            let (sin, cos) = libm::sincos(dice.between(-3.0, 3.0));
            let turned = Footprint { u: seen.u * cos + seen.v * sin, v: seen.v * cos - seen.u * sin };
            let swapped = Footprint { u: -seen.v, v: seen.u };
            let got = texture.over(uv, &seen);
            assert!(apart(got, texture.over(uv, &turned)) < 2e-6);
            assert!(apart(got, texture.over(uv, &swapped)) < 2e-6);
        }
    }
}

#[test]
fn nothing_pops_as_a_footprint_grows() {
    let mut dice = Dice(6);
    for mut texture in pictures(&mut dice) {
        for filter in [Filter::Linear, Filter::Nearest] {
            texture.filter = filter;
            for flat in [1.0, 0.3, 0.02, 0.0] {
                let (uv, turn) = (place(&mut dice), DVec2::from_angle(dice.between(0.0, 6.0)));
                let at = |i: i32| {
                    let size = 1e-3 * libm::pow(1.002, f64::from(i));
                    texture.over(uv, &Footprint { u: turn * size, v: turn.perp() * (size * flat) })
                };
                for i in 0..4000 {
                    let step = apart(at(i), at(i + 1));
                    assert!(step < 0.01, "{step} at {i}, {flat}, {:?}", texture.picture);
                }
            }
        }
    }
}

#[test]
fn colours_of_what_is_transparent_do_not_bleed_and_data_in_alpha_does_not_weigh() {
    // Opaque red and transparent green, in turns.
    let texels: Vec<[u8; 4]> =
        (0..64).map(|i| if i % 2 == 0 { [255, 0, 0, 255] } else { [0, 255, 0, 0] }).collect();
    let floats = texels.iter().map(|texel| texel.map(|c| f32::from(c) / 255.0)).collect();
    let mut dice = Dice(7);
    for _ in 0..50 {
        let (uv, seen) = (place(&mut dice), round(dice.between(0.25, 2.0)));
        for (texels, encoding) in [
            (Texels::Byte(texels.clone()), Encoding::Srgb),
            (Texels::Float(Clone::clone(&floats)), Encoding::Linear),
        ] {
            let got = texture(8, 8, texels, encoding).over(uv, &seen);
            assert!(apart(got, [1.0, 0.0, 0.0, 0.5]) < 2e-5, "{got:?}");
        }
        let got = texture(8, 8, Texels::Byte(texels.clone()), Encoding::Linear).over(uv, &seen);
        assert!(apart(got, [0.5, 0.5, 0.0, 0.5]) < 2e-5, "{got:?}");
    }
}

#[test]
fn every_level_wraps_as_the_texture_does() {
    let mut dice = Dice(8);
    for mut texture in pictures(&mut dice) {
        for _ in 0..100 {
            let (uv, seen) = (place(&mut dice), footprint(&mut dice, 1.0));
            let mirrored = Footprint { u: seen.u * DVec2::new(-1.0, 1.0), v: seen.v * DVec2::new(-1.0, 1.0) };
            let mut over = |wrap, uv, seen: &Footprint| {
                texture.wrap = [wrap; 2];
                texture.over(uv, seen)
            };
            let got = over(Wrap::Repeat, uv, &seen);
            assert!(apart(got, over(Wrap::Repeat, uv + DVec2::new(2.0, -5.0), &seen)) < 1e-5);
            let got = over(Wrap::Mirror, uv, &seen);
            assert!(apart(got, over(Wrap::Mirror, uv + DVec2::new(2.0, -4.0), &seen)) < 1e-5);
            assert!(apart(got, over(Wrap::Mirror, uv * DVec2::new(-1.0, 1.0), &mirrored)) < 1e-5);
            // So far out that the whole footprint is beyond the edge.
            let far = DVec2::new(40.0 + uv.x, 40.0 + uv.y);
            let got = over(Wrap::Clamp, far, &seen);
            assert!(apart(got, over(Wrap::Clamp, far + 20.0, &seen)) < 1e-5);
            // From one side of the seam to the other nothing jumps.
            let seam = DVec2::new(0.0, uv.y);
            for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
                let [left, right] = [-1e-8, 1e-8].map(|x| over(wrap, seam + DVec2::new(x, 0.0), &seen));
                assert!(apart(left, right) < 1e-5, "{wrap:?}");
            }
        }
    }
}

#[test]
fn transform_is_applied_to_the_footprint_too() {
    let mut dice = Dice(9);
    let texels = noise(48, 20, &mut dice);
    let plain = texture(48, 20, Texels::Float(texels), Encoding::Linear);
    let transform = DAffine2::from_scale_angle_translation(DVec2::new(3.0, 0.5), 0.7, DVec2::new(0.2, -0.4));
    let laid = Texture { transform, ..plain.clone() };
    for _ in 0..100 {
        let (uv, seen) = (place(&mut dice), footprint(&mut dice, 1.0));
        let [u, v] = [seen.u, seen.v].map(|axis| transform.transform_vector2(axis));
        let expected = plain.over(transform.transform_point2(uv), &Footprint { u, v });
        assert!(apart(laid.over(uv, &seen), expected) < 1e-6);
    }
}

#[test]
fn minified_nearest_texels_are_averaged_like_others() {
    let mut dice = Dice(10);
    for linear in pictures(&mut dice) {
        let nearest = Texture { filter: Filter::Nearest, ..linear.clone() };
        for _ in 0..20 {
            // One texel of the smaller side of any of the pictures, or more.
            let (uv, seen) = (place(&mut dice), round(dice.between(1.0, 3.0)));
            assert_eq!(nearest.over(uv, &seen), linear.over(uv, &seen));
        }
    }
}

#[test]
fn levels_take_less_than_a_byte_for_every_channel_and_texel() {
    let mut dice = Dice(11);
    let floats = noise(256, 128, &mut dice);
    let per_texel = |texels| {
        let picture = Picture::new(256, 128, texels, Encoding::Srgb);
        picture.pyramid().bytes() as f64 / (256.0 * 128.0)
    };
    assert!(per_texel(Texels::Byte(bytes(&floats))) < 8.0 / 3.0 + 0.01);
    assert!(per_texel(Texels::Float(floats)) < 16.0 / 3.0 + 0.01);
}

#[test]
fn threads_that_ask_at_once_get_the_same_levels() {
    let mut dice = Dice(12);
    let picture =
        Arc::new(Picture::new(300, 200, Texels::Float(noise(300, 200, &mut dice)), Encoding::Linear));
    let asked: Vec<usize> = std::thread::scope(|scope| {
        let ask = || std::ptr::from_ref(picture.pyramid()) as usize;
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(ask)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(asked.iter().all(|&levels| levels == asked[0]));
    assert_eq!(picture.pyramid().mean(), Picture::clone(&picture).pyramid().mean());
}
