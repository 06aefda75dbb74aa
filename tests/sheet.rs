//! Contact sheets.

use crate::cli::{said, terrell};
use image::{Rgb, RgbImage};
use terrell::output::contact_sheet;

const GAP: u32 = 6;

#[test]
fn pictures_are_made_smaller_by_their_light() {
    // Half of the light of white is 188 of 255 (IEC 61966-2-1), not 128.
    let fine = RgbImage::from_fn(160, 120, |column, row| Rgb([255 * ((column + row) % 2) as u8; 3]));
    let sheet = contact_sheet(&[(String::new(), fine)], 1, 40);
    let within = |column: u32, row: u32| sheet.get_pixel(GAP + column, GAP + row).0;
    for place in [(5, 5), (20, 15), (33, 27)] {
        assert!(
            within(place.0, place.1).iter().all(|value| value.abs_diff(188) <= 2),
            "{:?}",
            within(place.0, place.1)
        );
    }
}

#[test]
fn each_picture_is_whole_in_its_place_with_its_name_below() {
    let of = |wide: u32, high: u32, color| RgbImage::from_pixel(wide, high, Rgb(color));
    let colors = [[250, 10, 10], [10, 250, 10], [10, 10, 250]];
    let shapes = [(400, 300), (400, 100), (100, 400)];
    let pictures: Vec<_> = shapes
        .iter()
        .zip(colors)
        .map(|(shape, color)| ("Il".to_owned(), of(shape.0, shape.1, color)))
        .collect();
    let sheet = contact_sheet(&pictures, 2, 80);
    let count = |color: [u8; 3]| sheet.pixels().filter(|pixel| pixel.0 == color).count();
    assert_eq!(colors.map(count), [80 * 60, 80 * 20, 15 * 60]);
    let middle = |place: u32| {
        let high = sheet.height() / 2 - 3;
        sheet.get_pixel(GAP + 40 + place % 2 * (80 + GAP), GAP + 30 + place / 2 * high).0
    };
    assert_eq!([0, 1, 2].map(middle), colors);
    // An i has 10 dots, an l 9.
    assert_eq!(count([230, 230, 230]), 3 * (10 + 9));
}

#[test]
fn a_sheet_is_made_of_files_and_folders() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::create_dir(place("film")).unwrap();
    for (name, color) in [
        ("film/0.png", [9; 3]),
        ("film/1.png", [200, 9, 9]),
        ("film/2.png", [9; 3]),
        ("film/1.doppler.png", [9; 3]),
        ("one.png", [9, 200, 9]),
    ] {
        RgbImage::from_pixel(64, 48, Rgb(color)).save(place(name)).unwrap();
    }
    let out = place("sheet.png");
    let told = said(&terrell(&["sheet", &place("film"), &place("one.png"), "--width", "32", "--out", &out]));
    assert_eq!(told, format!("2 pictures in {out}\n"));
    let sheet = image::open(&out).unwrap().to_rgb8();
    let count = |color: [u8; 3]| sheet.pixels().filter(|pixel| pixel.0 == color).count();
    assert_eq!([[200, 9, 9], [9, 200, 9], [9; 3]].map(count), [32 * 24, 32 * 24, 0]);

    std::fs::create_dir(place("empty")).unwrap();
    std::fs::write(place("words.png"), "no picture").unwrap();
    for (arguments, expected) in [
        (vec![place("empty")], "there are no pictures in it"),
        (vec![place("words.png")], "name a picture"),
        (vec![place("none.png")], "name a picture"),
        (vec![place("one.png"), "--out".to_owned(), place("sheet.jpg")], "sheet.png"),
        (
            vec![
                place("one.png"),
                "--width".to_owned(),
                "2000".to_owned(),
                "--columns".to_owned(),
                "100".to_owned(),
            ],
            "--width 500",
        ),
    ] {
        let mut all = vec!["sheet"];
        all.extend(arguments.iter().map(String::as_str));
        let output = terrell(&all);
        assert_eq!(output.status.code(), Some(2), "{all:?}");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains(expected), "{text}");
    }
}
