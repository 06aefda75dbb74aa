//! Films as players find them.

use crate::output::{names_in, scene};
use openh264::decoder::Decoder;
use openh264::formats::YUVSource;
use std::fs;
use std::path::Path;
use terrell::error::Error;
use terrell::output::{Movie, movie};

fn film(path: &Path, size: (u32, u32), rate: f64, pictures: &[Vec<u8>]) -> Vec<u8> {
    let mut movie = Movie::create(path, size.0, size.1, rate).unwrap();
    for picture in pictures {
        movie.push(picture).unwrap();
    }
    movie.finish().unwrap();
    fs::read(path).unwrap()
}

fn film_of(size: (u32, u32), rate: f64, pictures: &[Vec<u8>]) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    film(&folder.path().join("film.mp4"), size, rate, pictures)
}

fn word(bytes: &[u8], at: usize) -> usize {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// The boxes in a stretch of a file: name and content.
fn boxes(mut bytes: &[u8]) -> Vec<(String, &[u8])> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let name = String::from_utf8(bytes[4..8].to_vec()).unwrap();
        let (header, length) = match word(bytes, 0) {
            1 => (16, word(bytes, 12) + (word(bytes, 8) << 32)),
            length => (8, length),
        };
        found.push((name, &bytes[header..length]));
        bytes = &bytes[length..];
    }
    found
}

fn inside<'a>(bytes: &'a [u8], path: &[&str]) -> &'a [u8] {
    path.iter().fold(bytes, |bytes, wanted| {
        let all = boxes(bytes);
        all.iter().find(|(name, _)| name == wanted).unwrap_or_else(|| panic!("no box {wanted}")).1
    })
}

fn table<'a>(file: &'a [u8], name: &str) -> &'a [u8] {
    inside(file, &["moov", "trak", "mdia", "minf", "stbl", name])
}

/// Where the samples are, by the tables of chunks and sizes.
fn samples(file: &[u8]) -> Vec<&[u8]> {
    let (sizes, runs, chunks) = (table(file, "stsz"), table(file, "stsc"), table(file, "co64"));
    let mut sizes = (0..word(sizes, 8)).map(|i| word(sizes, 12 + 4 * i));
    let mut found = Vec::new();
    for chunk in 0..word(chunks, 4) {
        let run = (0..word(runs, 4)).rfind(|run| word(runs, 8 + 12 * run) <= chunk + 1).unwrap();
        let mut offset = word(chunks, 12 + 8 * chunk);
        for _ in 0..word(runs, 12 + 12 * run) {
            let size = sizes.next().unwrap();
            found.push(&file[offset..offset + size]);
            offset += size;
        }
    }
    assert_eq!(sizes.next(), None, "a sample in no chunk");
    found
}

/// Planes of every picture: width, height, luma, blue and red, without gaps between rows.
fn decoded(file: &[u8]) -> Vec<(usize, usize, [Vec<u8>; 3])> {
    let avc1 = &table(file, "stsd")[16..];
    let avcc = inside(&avc1[78..], &["avcC"]);
    let sequence = u16::from_be_bytes([avcc[6], avcc[7]]) as usize;
    let picture = u16::from_be_bytes([avcc[9 + sequence], avcc[10 + sequence]]) as usize;
    let sets = [&avcc[8..8 + sequence], &avcc[11 + sequence..11 + sequence + picture]];
    let mut decoder = Decoder::new().unwrap();
    let mut stream: Vec<u8> = sets.iter().flat_map(|set| [&[0, 0, 0, 1], *set].concat()).collect();
    let mut pictures = Vec::new();
    for mut sample in samples(file) {
        while !sample.is_empty() {
            let length = word(sample, 0);
            stream.extend([0, 0, 0, 1]);
            stream.extend(&sample[4..4 + length]);
            sample = &sample[4 + length..];
        }
        if let Some(picture) = decoder.decode(&stream).unwrap() {
            pictures.push(tight(&picture));
        }
        stream.clear();
    }
    pictures.extend(decoder.flush_remaining().unwrap().iter().map(tight));
    pictures
}

fn tight(picture: &impl YUVSource) -> (usize, usize, [Vec<u8>; 3]) {
    let ((width, height), strides) = (picture.dimensions(), picture.strides());
    let rows = |plane: &[u8], stride: usize, width: usize, height: usize| {
        plane.chunks(stride).take(height).flat_map(|row| row[..width].to_vec()).collect::<Vec<u8>>()
    };
    let luma = rows(picture.y(), strides.0, width, height);
    let blue = rows(picture.u(), strides.1, width / 2, height / 2);
    (width, height, [luma, blue, rows(picture.v(), strides.2, width / 2, height / 2)])
}

/// BT.709 limited range back to RGB, each chroma sample standing for its four pixels.
fn to_rgb((width, height, [luma, blue, red]): &(usize, usize, [Vec<u8>; 3])) -> Vec<u8> {
    let mut rgb = Vec::new();
    for (y, x) in (0..*height).flat_map(|y| (0..*width).map(move |x| (y, x))) {
        let chroma = y / 2 * (width / 2) + x / 2;
        let luma = (f64::from(luma[y * width + x]) - 16.0) / 219.0;
        let b = luma + 1.8556 * (f64::from(blue[chroma]) - 128.0) / 224.0;
        let r = luma + 1.5748 * (f64::from(red[chroma]) - 128.0) / 224.0;
        let g = (luma - 0.2126 * r - 0.0722 * b) / 0.7152;
        rgb.extend([r, g, b].map(|v| (v * 255.0).round().clamp(0.0, 255.0) as u8));
    }
    rgb
}

fn peak_signal_to_noise(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let error: f64 = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    10.0 * libm::log10(255.0 * 255.0 * a.len() as f64 / error.max(1e-9))
}

/// Luma by definition.
fn luma(rgb: &[u8]) -> Vec<u8> {
    let of = |p: &[u8]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
    rgb.chunks(3).map(|pixel| (16.0 + of(pixel) * 219.0 / 255.0).round() as u8).collect()
}

#[test]
fn a_film_has_its_index_first_and_tables_that_agree() {
    let pictures: Vec<Vec<u8>> = (0..37).map(|step| scene(160, 96, step)).collect();
    let file = film_of((160, 96), 12.0, &pictures);
    let names: Vec<String> = boxes(&file).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["ftyp", "moov", "mdat"]);
    let stts = table(&file, "stts");
    assert_eq!([word(stts, 4), word(stts, 8), word(stts, 12)], [1, 37, 1000]);
    let mdhd = inside(&file, &["moov", "trak", "mdia", "mdhd"]);
    assert_eq!((word(mdhd, 12), word(mdhd, 16)), (12_000, 37_000), "timescale and duration");
    let stss = table(&file, "stss");
    let keys: Vec<usize> = (0..word(stss, 4)).map(|i| word(stss, 8 + 4 * i)).collect();
    assert_eq!(keys, [1, 13, 25, 37], "a key picture every second");
    let samples = samples(&file);
    assert_eq!(samples.len(), 37);
    let mdat = inside(&file, &["mdat"]);
    assert_eq!(samples[0].as_ptr(), mdat.as_ptr(), "the first sample begins the data");
    assert_eq!(samples.iter().map(|sample| sample.len()).sum::<usize>(), mdat.len());
    let avcc = inside(&table(&file, "stsd")[16 + 78..], &["avcC"]);
    assert_eq!((avcc[0], avcc[1]), (1, 100), "High profile");
}

#[test]
fn a_film_shows_what_was_put_in() {
    let pictures: Vec<Vec<u8>> = (0..30).map(|step| scene(160, 96, step)).collect();
    let shown = decoded(&film_of((160, 96), 24.0, &pictures));
    assert_eq!(shown.len(), 30);
    for (picture, shown) in pictures.iter().zip(&shown) {
        let quality = peak_signal_to_noise(&luma(picture), &shown.2[0]);
        assert!(quality > 40.0, "luma {quality} dB");
        let quality = peak_signal_to_noise(picture, &to_rgb(shown));
        assert!(quality > 32.0, "colour {quality} dB"); // the disc's edge is sharper than chroma can be
    }
}

#[test]
fn plain_colours_come_back_within_three_levels() {
    let colours: [[u8; 3]; 9] = [
        [0, 0, 0],
        [255, 255, 255],
        [128, 128, 128],
        [18, 18, 18],
        [255, 0, 0],
        [0, 255, 0],
        [0, 0, 255],
        [255, 200, 0],
        [120, 60, 200],
    ];
    let pictures: Vec<Vec<u8>> = colours.iter().map(|colour| colour.repeat(64 * 48)).collect();
    for (colour, shown) in colours.iter().zip(decoded(&film_of((64, 48), 24.0, &pictures))) {
        let rgb = to_rgb(&shown);
        for pixel in rgb.chunks(3) {
            for (a, b) in colour.iter().zip(pixel) {
                assert!(a.abs_diff(*b) <= 3, "{pixel:?} for {colour:?}");
            }
        }
    }
}

#[test]
fn the_same_pictures_give_the_same_film() {
    let pictures: Vec<Vec<u8>> = (0..30).map(|step| scene(322, 178, step)).collect();
    assert!(film_of((322, 178), 24.0, &pictures) == film_of((322, 178), 24.0, &pictures));
}

#[test]
fn odd_sizes_are_made_even_by_repeating_the_edge() {
    let pictures: Vec<Vec<u8>> = (0..3).map(|step| scene(101, 67, step)).collect();
    let file = film_of((101, 67), 24.0, &pictures);
    let shown = decoded(&file);
    assert_eq!((shown[2].0, shown[2].1), (102, 68));
    let rows: Vec<&[u8]> = shown[2].2[0].chunks(102).collect();
    let kept: Vec<u8> = rows[..67].iter().flat_map(|row| row[..101].to_vec()).collect();
    assert!(peak_signal_to_noise(&luma(&pictures[2]), &kept) > 40.0);
    assert!(peak_signal_to_noise(rows[67], rows[66]) > 40.0);
    assert!(rows.iter().all(|row| row[101].abs_diff(row[100]) < 12), "the last column is the one before");
}

#[test]
fn rates_of_television_are_exact() {
    let file = film_of((32, 32), 29.97, &vec![scene(32, 32, 0); 4]);
    let mdhd = inside(&file, &["moov", "trak", "mdia", "mdhd"]);
    assert_eq!((word(mdhd, 12), word(mdhd, 16)), (30_000, 4 * 1001));
}

/// Noise of extreme colours in every pixel, the worst for the encoder.
fn noise(width: usize, height: usize, mut state: u32) -> Vec<u8> {
    let mut bit = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if state >> 31 == 0 { 0 } else { 255 }
    };
    (0..3 * width * height).map(|_| bit()).collect()
}

#[test]
fn noise_costs_no_picture_and_calm_pictures_after_it_are_as_good_as_ever() {
    let mut pictures: Vec<Vec<u8>> = (0..5).map(|step| scene(160, 96, step)).collect();
    pictures.extend((0..5).map(|seed| noise(160, 96, seed)));
    pictures.extend((0..20).map(|step| scene(160, 96, step)));
    let shown = decoded(&film_of((160, 96), 12.0, &pictures));
    assert_eq!(shown.len(), pictures.len());
    let quality: Vec<f64> = pictures
        .iter()
        .zip(&shown)
        .map(|(picture, shown)| peak_signal_to_noise(&luma(picture), &shown.2[0]))
        .collect();
    assert!(quality[5..12].iter().all(|quality| *quality > 28.0), "until the next key picture: {quality:?}");
    // Pictures 12 to 14 are 2 to 4 again.
    assert!((2..5).all(|i| quality[i + 10] > quality[i] - 1.0), "from then on: {quality:?}");
}

#[test]
fn an_unfinished_film_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.mp4");
    let mut movie = Movie::create(&path, 64, 48, 24.0).unwrap();
    movie.push(&scene(64, 48, 0)).unwrap();
    assert!(!path.exists());
    drop(movie);
    assert_eq!(names_in(folder.path()), [""; 0]);
    film(&path, (64, 48), 24.0, &[scene(64, 48, 0)]);
    assert_eq!(names_in(folder.path()), ["film.mp4"]);
}

#[test]
fn a_film_without_pictures_is_a_fault_and_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let movie = Movie::create(&folder.path().join("film.mp4"), 64, 48, 24.0).unwrap();
    assert!(matches!(movie.finish(), Err(Error::Input(_))));
    assert_eq!(names_in(folder.path()), [""; 0]);
}

#[test]
fn a_picture_of_another_size_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut movie = Movie::create(&folder.path().join("film.mp4"), 64, 48, 24.0).unwrap();
    assert!(movie.push(&[0; 100]).is_err());
}

#[test]
fn sizes_and_rates_that_no_film_can_have_are_faults_with_a_way_out() {
    let path = Path::new("film.mp4");
    for (width, height) in [(15, 64), (64, 8), (3842, 2160), (3840, 2161), (2200, 2200), (u32::MAX, u32::MAX)]
    {
        let Err(Error::Input(faults)) = movie::check(path, width, height, 24.0) else {
            panic!("{width} x {height} passed")
        };
        assert_eq!(faults.len(), 1);
        assert!(faults[0].what.contains(&format!("{width} x {height}")), "{}", faults[0].what);
        assert!(!faults[0].hint.is_empty());
    }
    for rate in [0.0, -24.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(matches!(movie::check(path, 64, 48, rate), Err(Error::Input(_))), "{rate}");
    }
    let Err(Error::Input(both)) = movie::check(path, 1, 1, 0.0) else { panic!("1 x 1 passed") };
    assert_eq!(both.len(), 2);
}

#[test]
fn films_of_the_smallest_and_the_largest_size_are_written() {
    for (width, height) in [(16, 16), (17, 31), (3840, 2160), (2160, 3840), (3839, 2159)] {
        let picture = [90, 120, 200].repeat(width as usize * height as usize);
        let shown = decoded(&film_of((width, height), 24.0, &[picture]));
        assert_eq!(shown[0].0, width.next_multiple_of(2) as usize);
        assert_eq!(shown[0].1, height.next_multiple_of(2) as usize);
    }
}
