//! Pictures to coded pictures to a film.

use super::mp4::{self, Sample, Track};
use super::yuv::Planes;
use super::{Temporary, write_whole};
use crate::error::{Error, Place};
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, Profile, QpRange,
    RateControlMode, VuiConfig,
};
use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

/// The quantiser of every picture: the eye finds no fault in sharp edges, and faint noise is kept.
const QUANTISER: u8 = 18;

/// A film being coded.
pub(super) struct Reel {
    path: PathBuf,
    width: usize,
    height: usize,
    encoder: Encoder,
    planes: Planes,
    track: Track,
    /// The coded pictures so far. It is declared before its name, so that it is closed before it is removed.
    spool: BufWriter<File>,
    _name: Temporary,
}

impl fmt::Debug for Reel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Reel({}, {} pictures)", self.path.display(), self.track.samples.len())
    }
}

impl Reel {
    pub(super) fn create(path: &Path, width: usize, height: usize, rate: f64) -> Result<Self, Error> {
        let planes = Planes::new(width, height);
        let config = config(width * height, rate);
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config)
            .map_err(|error| Error::machine(path, "starting the encoder", io::Error::other(error)))?;
        let (timescale, duration) = mp4::timing(rate);
        let track = Track {
            width: width.next_multiple_of(2) as u16,
            height: height.next_multiple_of(2) as u16,
            timescale,
            duration,
            sequence: Vec::new(),
            picture: Vec::new(),
            samples: Vec::new(),
        };
        let (name, spool) = Temporary::beside(path)?;
        let spool = BufWriter::with_capacity(1 << 16, spool);
        Ok(Self { path: path.to_owned(), width, height, encoder, planes, track, spool, _name: name })
    }

    pub(super) fn push(&mut self, rgb: &[u8]) -> Result<(), Error> {
        self.code(rgb).map_err(|source| Error::machine(&self.path, "writing the film", source))
    }

    fn code(&mut self, rgb: &[u8]) -> io::Result<()> {
        if rgb.len() != 3 * self.width * self.height {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the picture is not of the film's size"));
        }
        self.planes.take(rgb, self.width, self.height);
        let coded = self.encoder.encode(&self.planes).map_err(io::Error::other)?;
        let key = coded.frame_type() == FrameType::IDR;
        if !key && coded.frame_type() != FrameType::P {
            return Err(io::Error::other("the encoder left out a picture"));
        }
        let mut bytes = 0;
        for layer in (0..coded.num_layers()).filter_map(|i| coded.layer(i)) {
            for unit in (0..layer.nal_count()).filter_map(|i| layer.nal_unit(i)) {
                let unit = bare(unit);
                match unit.first().map(|header| header & 31) {
                    Some(7) => settle(&mut self.track.sequence, unit)?,
                    Some(8) => settle(&mut self.track.picture, unit)?,
                    Some(_) => {
                        self.spool.write_all(&(unit.len() as u32).to_be_bytes())?;
                        self.spool.write_all(unit)?;
                        bytes += 4 + unit.len() as u32;
                    }
                    None => {}
                }
            }
        }
        self.track.samples.push(Sample { bytes, key });
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), Error> {
        if self.track.samples.is_empty() {
            let hint = "give it at least one exposure";
            return Err(Error::fault(Place::file(&self.path), "a film cannot be without pictures", hint));
        }
        let Self { path, track, spool, _name, .. } = self;
        let rewound = |spool: BufWriter<File>| -> io::Result<File> {
            let mut file = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
            file.rewind()?;
            Ok(file)
        };
        let mut data = rewound(spool).map_err(|source| Error::machine(&path, "writing the film", source))?;
        write_whole(&path, |file| mp4::write(file, &track, &mut data))
    }
}

/// Buffer-based rate control is, without a receiver that reports its buffer, a constant quantiser; the true
/// quality mode changes it with a guess at the bit rate, and prints a warning when it may not leave pictures out.
fn config(pixels: usize, rate: f64) -> EncoderConfig {
    // The encoder knows rates from 1 to 60, and only derives the level from them and the bit rate.
    let rate = rate.clamp(1.0, 60.0);
    let bits = (0.5 * pixels as f64 * rate).clamp(1e5, 2.4e8);
    EncoderConfig::new()
        .rate_control_mode(RateControlMode::Bufferbased)
        .qp(QpRange::new(QUANTISER, QUANTISER))
        .bitrate(BitRate::from_bps(bits as u32))
        .max_frame_rate(FrameRate::from_hz(rate as f32))
        .skip_frames(false)
        .adaptive_quantization(false)
        .background_detection(false)
        .num_threads(1)
        .profile(Profile::High)
        .complexity(Complexity::Medium)
        .intra_frame_period(IntraFramePeriod::from_num_frames(rate.round() as u32))
        .vui(VuiConfig::bt709())
}

/// A NAL unit without the start code before it.
fn bare(unit: &[u8]) -> &[u8] {
    let zeros = unit.iter().take_while(|byte| **byte == 0).count();
    unit.get(zeros + 1..).unwrap_or(&[])
}

/// Keeps a parameter set, which the index gives once for the whole film.
fn settle(kept: &mut Vec<u8>, set: &[u8]) -> io::Result<()> {
    if kept.is_empty() {
        set.clone_into(kept);
    }
    if kept == set { Ok(()) } else { Err(io::Error::other("the encoder changed its parameters")) }
}
