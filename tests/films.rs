//! GIF and AVI films as other programs read them.

use crate::output::{names_in, scene};
use std::path::Path;
use terrell::error::Error;
use terrell::output::{Avi, FilmKind, Gif};

const SIZE: (u32, u32) = (97, 40);

fn gif(path: &Path, count: usize, rate: f64) -> Result<Vec<u8>, Error> {
    let mut gif = Gif::new(path, SIZE, rate, "Fingerprint: 12");
    let picture = |number: usize| scene(SIZE.0, SIZE.1, number as u32);
    (0..count).try_for_each(|number| gif.push(&picture(number)))?;
    gif.finish(&|number| Ok(picture(number)))?;
    Ok(std::fs::read(path).unwrap())
}

fn number(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte))
}

/// A GIF read by the specification: its comment, and how long each picture lasts (s/100) with what is then seen.
fn shown(file: &[u8]) -> (String, Vec<(usize, Vec<u8>)>) {
    assert_eq!(&file[..6], b"GIF89a");
    let size = (number(&file[6..8]), number(&file[8..10]));
    assert_eq!((size, file[10]), ((97, 40), 0xf7));
    let palette = &file[13..13 + 768];
    let blocks = |mut at: usize| {
        let mut all = Vec::new();
        while file[at] > 0 {
            let next = at + 1 + usize::from(file[at]);
            all.extend(&file[at + 1..next]);
            at = next;
        }
        (all, at + 1)
    };
    let (mut at, mut comment, mut pictures) = (13 + 768, String::new(), Vec::new());
    let mut canvas = vec![0; 3 * size.0 * size.1];
    let mut control = vec![];
    while file[at] != b';' {
        if file[at] == 0x21 {
            let (content, next) = blocks(at + 2);
            match file[at + 1] {
                0xfe => comment = String::from_utf8(content).unwrap(),
                0xf9 => control = content,
                _ => assert_eq!(content, b"NETSCAPE2.0\x01\0\0"),
            }
            at = next;
            continue;
        }
        assert_eq!(file[at], 0x2c);
        assert_eq!((number(&file[at + 5..at + 7]), number(&file[at + 7..at + 9])), size);
        let (coded, next) = blocks(at + 11);
        let mut decoder = weezl::decode::Decoder::new(weezl::BitOrder::Lsb, file[at + 10]);
        let numbers = decoder.decode(&coded).unwrap();
        assert_eq!(numbers.len(), size.0 * size.1);
        for (place, color) in numbers.iter().enumerate() {
            if control[0] & 1 == 0 || *color != control[3] {
                let from = 3 * usize::from(*color);
                canvas[3 * place..3 * place + 3].copy_from_slice(&palette[from..from + 3]);
            }
        }
        pictures.push((number(&control[1..3]), canvas.clone()));
        at = next;
    }
    assert_eq!(at, file.len() - 1);
    (comment, pictures)
}

#[test]
fn a_gif_shows_its_pictures_as_long_as_it_should_and_what_rests_does_not_flicker() {
    let folder = tempfile::tempdir().unwrap();
    let (comment, pictures) = shown(&gif(&folder.path().join("a.gif"), 8, 24.0).unwrap());
    assert_eq!(comment, "Fingerprint: 12");
    assert_eq!(pictures.len(), 8);
    assert_eq!(pictures.iter().map(|(lasts, _)| lasts).sum::<usize>(), 33);
    let all: Vec<Vec<u8>> = (0..8).map(|number| scene(SIZE.0, SIZE.1, number)).collect();
    for (number, ((_, found), right)) in pictures.iter().zip(&all).enumerate() {
        let off: u64 = found.iter().zip(right).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        assert!(off < 7 * found.len() as u64, "{number}: {}", off as f64 / found.len() as f64);
        // The pattern is even: over the picture the light is the same.
        let sum = |of: &[u8]| of.iter().map(|value| f64::from(*value)).sum::<f64>();
        assert!((sum(found) / sum(right) - 1.0).abs() < 0.01);
        for place in (0..found.len()).filter(|_| number > 0) {
            let pixel = place - place % 3;
            if right[pixel..pixel + 3] == all[number - 1][pixel..pixel + 3] {
                assert_eq!(found[place], pictures[number - 1].1[place]);
            }
        }
    }
}

#[test]
fn few_colours_are_kept_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    let picture: Vec<u8> = (0..97 * 40_usize)
        .flat_map(|i| [(i % 5 * 60) as u8, (i % 7 * 40) as u8, (i % 3 * 100) as u8])
        .collect();
    let mut gif = Gif::new(&path, SIZE, 10.0, "");
    gif.push(&picture).unwrap();
    gif.finish(&|_| Ok(picture.clone())).unwrap();
    assert_eq!(shown(&std::fs::read(&path).unwrap()).1[0].1, picture);
}

#[test]
fn films_are_the_same_every_time_and_whole_or_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    assert_eq!(gif(&at("a.gif"), 3, 24.0).unwrap(), gif(&at("b.gif"), 3, 24.0).unwrap());
    assert_eq!(avi(&at("a.avi"), 3, 24.0).unwrap(), avi(&at("b.avi"), 3, 24.0).unwrap());
    assert!(gif(&at("c.gif"), 0, 24.0).is_err());
    assert!(avi(&at("c.avi"), 0, 24.0).is_err());
    let mut broken = Gif::new(&at("c.gif"), SIZE, 24.0, "");
    broken.push(&scene(97, 40, 0)).unwrap();
    assert!(broken.push(&[0; 10]).is_err());
    assert!(broken.finish(&|_| Err(Error::fault(terrell::error::Place::Command, "gone", ""))).is_err());
    assert_eq!(names_in(folder.path()), ["a.avi", "a.gif", "b.avi", "b.gif"]);
}

fn avi(path: &Path, count: usize, rate: f64) -> Result<Vec<u8>, Error> {
    let mut avi = Avi::create(path, SIZE, rate, "Fingerprint: 12")?;
    (0..count).try_for_each(|number| avi.push(&scene(SIZE.0, SIZE.1, number as u32)))?;
    avi.finish()?;
    Ok(std::fs::read(path).unwrap())
}

/// The chunks in a stretch of a RIFF: name, place of the content, content.
fn chunks(bytes: &[u8]) -> Vec<(String, usize, &[u8])> {
    let (mut all, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let length = number(&bytes[at + 4..at + 8]);
        let name = String::from_utf8_lossy(&bytes[at..at + 4]).into_owned();
        all.push((name, at + 8, &bytes[at + 8..at + 8 + length]));
        at += 8 + length + length % 2;
    }
    all
}

#[test]
fn an_avi_has_its_pictures_where_its_index_says() {
    let folder = tempfile::tempdir().unwrap();
    let file = avi(&folder.path().join("a.avi"), 5, 23.976).unwrap();
    let riff = chunks(&file);
    assert_eq!((riff.len(), &*riff[0].0, &riff[0].2[..4]), (1, "RIFF", &b"AVI "[..]));
    let inside = chunks(&riff[0].2[4..]);
    let names: Vec<&str> = inside.iter().map(|(name, _, _)| &**name).collect();
    assert_eq!(names, ["LIST", "LIST", "LIST", "idx1"]);
    let header = chunks(&inside[0].2[4..]);
    assert_eq!([0, 16, 32, 36].map(|at| number(&header[0].2[at..at + 4])), [41708, 5, 97, 40]);
    let stream = chunks(&header[1].2[4..]);
    assert_eq!((&stream[0].2[..8], number(&stream[0].2[20..24])), (&b"vidsMJPG"[..], 1001));
    assert_eq!((number(&stream[0].2[24..28]), number(&stream[0].2[32..36])), (24_000, 5));
    let info = chunks(&inside[1].2[4..]);
    assert_eq!((&*info[1].0, info[1].2), ("ICMT", &b"Fingerprint: 12\0"[..]));
    let (movi, index) = (inside[2].2, inside[3].2);
    assert_eq!((&movi[..4], index.len()), (&b"movi"[..], 5 * 16));
    for (picture, entry) in index.chunks(16).enumerate() {
        let (at, length) = (number(&entry[8..12]), number(&entry[12..16]));
        assert_eq!((&entry[..4], &movi[at..at + 4]), (&b"00dc"[..], &b"00dc"[..]));
        let found = image::load_from_memory(&movi[at + 8..at + 8 + length]).unwrap().into_rgb8();
        let right = scene(SIZE.0, SIZE.1, picture as u32);
        let off: u64 = found.iter().zip(&right).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        assert!(off < 3 * right.len() as u64, "{}", off as f64 / right.len() as f64);
    }
}

#[test]
fn films_that_cannot_be_are_refused_beforehand() {
    let refused = |kind: FilmKind, size, rate| kind.refusal(size, rate).is_some();
    assert!(refused(FilmKind::Mp4, (8, 8), 24.0) && !refused(FilmKind::Gif, (8, 8), 24.0));
    assert!(refused(FilmKind::Gif, (64, 48), 60.0) && !refused(FilmKind::Avi, (64, 48), 60.0));
    assert!(refused(FilmKind::Avi, (65_536, 2), 24.0) && refused(FilmKind::Gif, (2, 65_536), 24.0));
    // What is said to type instead is none of these.
    for kind in [FilmKind::Mp4, FilmKind::Gif, FilmKind::Avi] {
        for size in
            [(8, 8), (3, 5000), (5000, 3), (15, 16), (4096, 2304), (3840, 2400), (100_000, 9), (6000, 6000)]
        {
            let Some(refusal) = kind.refusal(size, 24.0) else { continue };
            let typed =
                refusal.hint.strip_prefix("size: ").and_then(|hint| hint.split_once(", or ")).unwrap().0;
            let sides: Vec<u32> = typed.split(' ').map(|side| side.parse().unwrap()).collect();
            assert!(!refused(kind, (sides[0], sides[1]), 24.0), "{size:?}: {}", refusal.hint);
        }
    }
    assert!(FilmKind::Mp4.refusal((7680, 4320), 24.0).unwrap().hint.starts_with("size: 3840 2160, or "));
    assert_eq!(FilmKind::of("a.b.gif"), Some(FilmKind::Gif));
    assert_eq!(FilmKind::of("gif"), None);
}
