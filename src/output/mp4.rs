//! One H.264 track in an MP4 file (ISO/IEC 14496-12, 14496-14 and 14496-15), index first.

use std::io::{self, Read, Write};

/// What the index says about one track of pictures that all last equally long.
#[derive(Debug, Clone)]
pub(super) struct Track {
    /// Pixels across.
    pub(super) width: u16,
    /// Pixels down.
    pub(super) height: u16,
    /// Units of duration in a second.
    pub(super) timescale: u32,
    /// Units that a picture lasts.
    pub(super) duration: u32,
    /// Sequence parameter set, the bare NAL unit.
    pub(super) sequence: Vec<u8>,
    /// Picture parameter set, the bare NAL unit.
    pub(super) picture: Vec<u8>,
    /// The pictures, in order.
    pub(super) samples: Vec<Sample>,
    /// What the film says of itself; nothing is written where it is empty.
    pub(super) comment: String,
}

/// One coded picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Length in bytes.
    pub(super) bytes: u32,
    /// Whether decoding can begin here.
    pub(super) key: bool,
}

/// Writes the file; `data` gives the samples one after the other.
pub(super) fn write(into: &mut impl Write, track: &Track, data: &mut impl Read) -> io::Result<()> {
    let ftyp = boxed("ftyp", &[b"isom", &[0, 0, 2, 0], b"isom", b"iso2", b"avc1", b"mp41"]);
    let length: u64 = track.samples.iter().map(|sample| u64::from(sample.bytes)).sum();
    // Offsets are written in 64 bits, so that the index is as long with them as without.
    let before = (ftyp.len() + moov(track, 0).len() + MDAT_HEADER) as u64;
    into.write_all(&ftyp)?;
    into.write_all(&moov(track, before))?;
    into.write_all(&1_u32.to_be_bytes())?;
    into.write_all(b"mdat")?;
    into.write_all(&(length + MDAT_HEADER as u64).to_be_bytes())?;
    if io::copy(&mut data.take(length), into)? == length {
        Ok(())
    } else {
        Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the coded pictures are cut short"))
    }
}

/// Size, name, and the size again in 64 bits.
const MDAT_HEADER: usize = 16;

/// Samples to a chunk: players read a chunk at a time.
const CHUNK: usize = 16;

const UNITY: [u32; 9] = [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];

fn boxed(name: &str, parts: &[&[u8]]) -> Vec<u8> {
    let length = 8 + parts.iter().map(|part| part.len()).sum::<usize>();
    let mut bytes = Vec::with_capacity(length);
    bytes.extend((length as u32).to_be_bytes());
    bytes.extend(name.as_bytes());
    for part in parts {
        bytes.extend(*part);
    }
    bytes
}

/// A box that begins with its version and flags.
fn full(name: &str, version_and_flags: u32, parts: &[&[u8]]) -> Vec<u8> {
    boxed(name, &[&version_and_flags.to_be_bytes(), &parts.concat()])
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

/// Version and flags of a box that holds `duration`, and the duration at its width; the two dates before
/// it (at the same width) are left at zero, so that the same film gives the same bytes.
struct Span {
    version: u32,
    dates: Vec<u8>,
    duration: Vec<u8>,
}

fn span(track: &Track) -> Span {
    let duration = track.samples.len() as u64 * u64::from(track.duration);
    u32::try_from(duration).map_or_else(
        |_| Span { version: 1 << 24, dates: vec![0; 16], duration: duration.to_be_bytes().to_vec() },
        |short| Span { version: 0, dates: vec![0; 8], duration: short.to_be_bytes().to_vec() },
    )
}

fn moov(track: &Track, first_offset: u64) -> Vec<u8> {
    let Span { version, dates, duration } = span(track);
    let scale = track.timescale.to_be_bytes();
    // Rate 1, volume 1, reserved; later the number that a further track would get.
    let settings = [words(&[0x1_0000]), vec![1, 0], vec![0; 10]].concat();
    let rest = [words(&UNITY), vec![0; 24], words(&[2])].concat();
    let mvhd = full("mvhd", version, &[&dates, &scale, &duration, &settings, &rest]);
    // Layer, group, volume and reserved are zero; the size is in 16.16.
    let size = words(&[u32::from(track.width) << 16, u32::from(track.height) << 16]);
    let tkhd = full(
        "tkhd",
        version | 3, // enabled, and part of the presentation
        &[&dates, &words(&[1, 0]), &duration, &[0; 16], &words(&UNITY), &size],
    );
    let mdhd = full("mdhd", version, &[&dates, &scale, &duration, &[0x55, 0xc4, 0, 0]]); // language "und"
    let hdlr = full("hdlr", 0, &[&[0; 4], b"vide", &[0; 12], b"film\0"]);
    let vmhd = full("vmhd", 1, &[&[0; 8]]);
    let dref = full("dref", 0, &[&words(&[1]), &full("url ", 1, &[])]); // in this very file
    let dinf = boxed("dinf", &[&dref]);
    let minf = boxed("minf", &[&vmhd, &dinf, &stbl(track, first_offset)]);
    let trak = boxed("trak", &[&tkhd, &boxed("mdia", &[&mdhd, &hdlr, &minf])]);
    boxed("moov", &[&mvhd, &trak, &said(&track.comment)])
}

/// The comment, where programs look for it (Apple, `QuickTime` metadata).
fn said(comment: &str) -> Vec<u8> {
    if comment.is_empty() {
        return Vec::new();
    }
    let data = full("data", 1, &[&[0; 4], comment.as_bytes()]); // UTF-8
    let length = (8 + data.len()) as u32;
    let item = [&length.to_be_bytes()[..], b"\xa9cmt", &data].concat();
    let hdlr = full("hdlr", 0, &[&[0; 4], b"mdirappl", &[0; 9]]);
    boxed("udta", &[&full("meta", 0, &[&hdlr, &boxed("ilst", &[&item])])])
}

/// The tables of samples.
fn stbl(track: &Track, first_offset: u64) -> Vec<u8> {
    let count = track.samples.len();
    let keys: Vec<u32> =
        (1..).zip(&track.samples).filter(|(_, sample)| sample.key).map(|(number, _)| number).collect();
    let sizes: Vec<u32> = track.samples.iter().map(|sample| sample.bytes).collect();
    let mut offset = first_offset;
    let mut offsets = Vec::new();
    for chunk in sizes.chunks(CHUNK) {
        offsets.extend(offset.to_be_bytes());
        offset += chunk.iter().map(|bytes| u64::from(*bytes)).sum::<u64>();
    }
    // Runs of chunks alike: first chunk, samples in each, description; the last chunk may be shorter.
    let (whole, left) = (count / CHUNK, count % CHUNK);
    let mut runs = Vec::new();
    if whole > 0 {
        runs.extend([1, CHUNK as u32, 1]);
    }
    if left > 0 {
        runs.extend([whole as u32 + 1, left as u32, 1]);
    }
    let chunks = (whole + usize::from(left > 0)) as u32;
    boxed(
        "stbl",
        &[
            &full("stsd", 0, &[&words(&[1]), &avc1(track)]),
            &full("stts", 0, &[&words(&[1, count as u32, track.duration])]),
            &full("stss", 0, &[&words(&[keys.len() as u32]), &words(&keys)]),
            &full("stsc", 0, &[&words(&[runs.len() as u32 / 3]), &words(&runs)]),
            &full("stsz", 0, &[&words(&[0, count as u32]), &words(&sizes)]),
            &full("co64", 0, &[&words(&[chunks]), &offsets]),
        ],
    )
}

/// How the samples are coded.
fn avc1(track: &Track) -> Vec<u8> {
    let size = [track.width.to_be_bytes(), track.height.to_be_bytes()].concat();
    let avcc = boxed(
        "avcC",
        &[
            &[1],
            track.sequence.get(1..4).unwrap_or(&[0; 3]), // profile, compatibility, level
            &[0xff, 0xe1],                               // lengths of 4 bytes; one sequence parameter set
            &(track.sequence.len() as u16).to_be_bytes(),
            &track.sequence,
            &[1],
            &(track.picture.len() as u16).to_be_bytes(),
            &track.picture,
            &[0xfd, 0xf8, 0xf8, 0], // High profile: 4:2:0, 8 bits, 8 bits, no extensions
        ],
    );
    let colr = boxed("colr", &[b"nclx", &[0, 1, 0, 1, 0, 1, 0]]); // BT.709 thrice, limited range
    let pasp = boxed("pasp", &[&words(&[1, 1])]);
    boxed(
        "avc1",
        &[
            &[0, 0, 0, 0, 0, 0, 0, 1], // the first data reference
            &[0; 16],
            &size,
            &words(&[0x48_0000, 0x48_0000, 0]), // 72 dots an inch, as everybody writes
            &[0, 1],                            // one picture to a sample
            &[0; 32],
            &[0, 24, 0xff, 0xff], // depth; no colour table
            &avcc,
            &colr,
            &pasp,
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_longer_than_32_bits_can_count_has_its_duration_in_64() {
        let sample = Sample { bytes: 1, key: true };
        let track = Track {
            width: 16,
            height: 16,
            timescale: 333_333,
            duration: 1_000_000,
            sequence: vec![0x67, 100, 0, 40],
            picture: vec![0x68],
            samples: vec![sample; 5000],
            comment: String::new(),
        };
        let mut file = Vec::new();
        write(&mut file, &track, &mut vec![7; 5000].as_slice()).unwrap();
        let at = file.windows(4).position(|window| window == b"mvhd").unwrap();
        assert_eq!(file[at + 4], 1);
        assert_eq!(file[at + 28..at + 36], 5_000_000_000_u64.to_be_bytes());
    }

    #[test]
    fn coded_pictures_cut_short_are_an_error() {
        let track = Track {
            width: 16,
            height: 16,
            timescale: 24_000,
            duration: 1000,
            sequence: vec![0x67, 100, 0, 40],
            picture: vec![0x68],
            samples: vec![Sample { bytes: 10, key: true }],
            comment: String::new(),
        };
        let cut = write(&mut Vec::new(), &track, &mut [0_u8; 9].as_slice());
        assert_eq!(cut.unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
    }
}
