//! Pictures and films as other programs find them.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use terrell::error::Error;
use terrell::output::{
    Channel, Measured, Picture8, check_exr, exposure_name, exr_texts, write_exr, write_png, write_whole,
};

pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// A disc of changing colour before a field of colours, and a fine dark line.
pub(crate) fn scene(width: u32, height: u32, step: u32) -> Vec<u8> {
    let mut rgb = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let (dx, dy) = (i64::from(x) - i64::from(30 + 3 * step), i64::from(y) - i64::from(height / 2));
            let pixel = if dx * dx + dy * dy < 400 {
                [220, (40 + 5 * step) as u8, 60]
            } else if x == 10 + step {
                [5, 5, 5]
            } else {
                [
                    (x * 200 / width) as u8 + 30,
                    (y * 150 / height) as u8 + 60,
                    ((x + y + step) * 100 / (width + height)) as u8 + 90,
                ]
            };
            rgb.extend(pixel);
        }
    }
    rgb
}

mod a_file {
    use super::*;

    #[test]
    fn that_fails_halfway_leaves_the_old_one_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0001.png");
        fs::write(&path, "old").unwrap();
        let result = write_whole(&path, |file| {
            file.write_all(&vec![0; 100_000])?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        assert!(matches!(result, Err(Error::Machine { path: named, .. }) if named == path));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["0001.png"]);
    }

    #[test]
    fn does_not_stand_under_its_name_before_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/0001.png");
        write_whole(&path, |file| {
            file.write_all(b"half")?;
            file.flush()?;
            assert!(!path.exists());
            file.write_all(b" and half")
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"half and half");
        assert_eq!(names_in(&folder.path().join("new")), ["0001.png"]);
    }

    #[test]
    fn whose_folder_cannot_be_made_is_the_machines_fault_and_the_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let blocked = folder.path().join("blocked");
        fs::write(&blocked, "a file where a folder should be").unwrap();
        let error = write_whole(&blocked.join("out/0001.png"), |_| Ok(())).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        let message = error.to_string();
        assert!(message.contains(blocked.join("out").to_str().unwrap()), "{message}");
        assert!(message.contains("creating the folder"), "{message}");
    }

    #[test]
    fn that_cannot_have_its_name_is_not_left_under_another() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("by"), "something").unwrap();
        assert!(write_whole(&path, |file| file.write_all(b"x")).is_err());
        assert_eq!(names_in(folder.path()), ["taken"]);
    }

    #[test]
    fn whose_path_names_no_file_is_an_error() {
        assert!(matches!(write_whole(Path::new(".."), |_| Ok(())), Err(Error::Machine { .. })));
        assert!(matches!(write_whole(Path::new(""), |_| Ok(())), Err(Error::Machine { .. })));
    }

    #[test]
    fn of_an_exposure_has_a_number_of_four_digits_or_as_many_as_the_film_needs() {
        assert_eq!(exposure_name(12, 96), "0012.png");
        assert_eq!(exposure_name(0, 1), "0000.png");
        assert_eq!(exposure_name(12, 123_456), "000012.png");
    }
}

mod a_png {
    use super::*;

    fn write(folder: &Path, rgb: &[u8], text: &[(&str, String)]) -> Result<Vec<u8>, Error> {
        let path = folder.join("0001.png");
        write_png(&path, &Picture8 { width: 50, height: 31, rgb, text })?;
        Ok(fs::read(path).unwrap())
    }

    #[test]
    fn gives_back_its_pixels_its_colour_space_and_its_texts() {
        let folder = tempfile::tempdir().unwrap();
        let rgb = scene(50, 31, 0);
        let text = [("Software", "terrell".to_owned()), ("Comment", "β = 0.9 → γ = 2.29".to_owned())];
        let bytes = write(folder.path(), &rgb, &text).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        reader.finish().unwrap();
        assert_eq!(pixels, rgb);
        let info = reader.info();
        assert_eq!((info.width, info.height), (50, 31));
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
        assert_eq!(info.uncompressed_latin1_text[0].keyword, "Software");
        assert_eq!(info.uncompressed_latin1_text[0].text, "terrell");
        assert_eq!(info.utf8_text[0].keyword, "Comment");
        assert_eq!(info.utf8_text[0].get_text().unwrap(), text[1].1);
    }

    #[test]
    fn is_the_same_every_time() {
        let folder = tempfile::tempdir().unwrap();
        let text = [("Comment", "once".to_owned()), ("Title", "twice".to_owned())];
        let once = write(folder.path(), &scene(50, 31, 4), &text).unwrap();
        assert_eq!(once, write(folder.path(), &scene(50, 31, 4), &text).unwrap());
    }

    #[test]
    fn of_too_few_bytes_or_with_an_impossible_keyword_is_an_error_and_no_file() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write(folder.path(), &[0; 10], &[]).is_err());
        assert!(write(folder.path(), &scene(50, 31, 0), &[("", String::new())]).is_err());
        assert_eq!(names_in(folder.path()), [""; 0]);
    }
}

mod an_exr {
    use super::*;
    use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};

    const SIZE: (usize, usize) = (37, 19);

    fn values<'a>(text: &'a [(&'a str, String)]) -> Measured<'a> {
        let count = SIZE.0 * SIZE.1;
        let ramp = |scale: f32| (0..count).map(|i| (i as f32 + 0.1) * scale).collect();
        let channels = vec![
            Channel::new("R", ramp(0.01)),
            Channel::new("doppler", ramp(-2.5e8)),
            Channel { half: true, ..Channel::new("B", ramp(100.0)) },
            Channel::new("body", (-1_i16..4).cycle().take(count).map(f32::from).collect()),
        ];
        Measured { width: SIZE.0, height: SIZE.1, channels, white_luminance: 80.0, spectral: true, text }
    }

    fn text() -> [(&'static str, String); 2] {
        [("scene", "Vorbeiflug β = 0.9".to_owned()), ("exposure", "12".to_owned())]
    }

    #[test]
    fn gives_back_every_value_exactly_under_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0001.exr");
        let text = text();
        let values = values(&text);
        write_exr(&path, values.clone()).unwrap();
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_file(&path)
            .unwrap();
        let layer = &image.layer_data;
        assert_eq!((layer.size.0, layer.size.1), SIZE);
        assert_eq!(layer.channel_data.list.len(), values.channels.len());
        for found in &layer.channel_data.list {
            let expected = values.channels.iter().find(|one| found.name == *one.name).unwrap();
            match &found.sample_data {
                FlatSamples::F32(samples) => assert_eq!(samples, &expected.values),
                FlatSamples::F16(samples) => {
                    for (found, expected) in samples.iter().zip(&expected.values) {
                        // Numbers of 11 digits; the largest is 65504.
                        let (found, expected) = (found.to_f32(), expected.min(65_504.0));
                        assert!((found - expected).abs() <= expected / 2048.0, "{found} {expected}");
                    }
                    assert!(expected.half);
                }
                FlatSamples::U32(_) => panic!("{}", found.name),
            }
        }
        let red = image.attributes.chromaticities.unwrap().red;
        assert_eq!((red.0, red.1), (0.64, 0.33));
        assert_eq!(layer.attributes.white_luminance, Some(80.0));
        let comments = layer.attributes.comments.as_ref().unwrap();
        assert_eq!(comments.as_slice(), "scene: Vorbeiflug β = 0.9\nexposure: 12".as_bytes());
    }

    #[test]
    fn is_the_same_every_time() {
        let folder = tempfile::tempdir().unwrap();
        let (one, two) = (folder.path().join("1.exr"), folder.path().join("2.exr"));
        write_exr(&one, values(&text())).unwrap();
        write_exr(&two, values(&text())).unwrap();
        assert_eq!(fs::read(one).unwrap(), fs::read(two).unwrap());
    }

    #[test]
    fn with_a_value_missing_is_an_error_and_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut values = values(&[]);
        values.channels[1].values.pop();
        assert!(write_exr(&folder.path().join("0001.exr"), values).is_err());
        assert_eq!(names_in(folder.path()), [""; 0]);
    }

    #[test]
    fn is_whole_only_with_every_byte_and_every_channel() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0001.exr");
        let text = text();
        let values = values(&text);
        let form = values.form();
        write_exr(&path, values).unwrap();
        check_exr(&path, &form).unwrap();
        assert_eq!(exr_texts(&path)["exposure"], "12");
        let mut other = form.clone();
        other.channels[0].1 = !form.channels[0].1;
        assert!(check_exr(&path, &other).is_err());
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
        assert!(check_exr(&path, &form).is_err());
        let mut garbled = bytes.clone();
        let last = garbled.len() - 20;
        garbled[last] ^= 0xff;
        fs::write(&path, garbled).unwrap();
        assert!(check_exr(&path, &form).is_err());
    }
}

#[cfg(not(feature = "video"))]
#[test]
fn a_build_without_video_says_so() {
    use terrell::output::Movie;
    let Err(Error::Input(faults)) = Movie::create(Path::new("film.mp4"), 64, 48, 24.0) else {
        panic!("it was made")
    };
    assert!(faults[0].hint.contains("feature `video`"));
}
