//! Pictures to coded pictures to a film.

use super::film::timing;
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

/// The quantiser: sharp edges and faint noise are kept. It must not be much finer: `OpenH264` does not check its
/// buffer, which holds 12 bits a pixel, while it fills it. The worst picture found (noise of the extreme colours
/// in every pixel) takes some 10.5 bits at 18, and would overrun it from about 13 down.
const FINE: u8 = 18;

/// The quantiser of pictures that come to more than the 8 bits a pixel that `OpenH264` accepts in the end, as white
/// noise does. The worst picture found takes 6.9 bits.
const COARSE: u8 = 30;

/// A film being coded.
pub(super) struct Reel {
    path: PathBuf,
    width: usize,
    height: usize,
    rate: f64,
    encoder: Encoder,
    quantiser: u8,
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
        let encoder = encoder(width * height, rate, FINE)
            .map_err(|source| Error::machine(path, "starting the encoder", source))?;
        let (timescale, duration) = timing(rate);
        let track = Track {
            width: width.next_multiple_of(2) as u16,
            height: height.next_multiple_of(2) as u16,
            timescale,
            duration,
            sequence: Vec::new(),
            picture: Vec::new(),
            samples: Vec::new(),
            comment: String::new(),
        };
        let (name, spool) = Temporary::beside(path)?;
        let spool = BufWriter::with_capacity(1 << 16, spool);
        let path = path.to_owned();
        Ok(Self { path, width, height, rate, encoder, quantiser: FINE, planes, track, spool, _name: name })
    }

    pub(super) fn comment(&mut self, comment: &str) {
        comment.clone_into(&mut self.track.comment);
    }

    pub(super) fn push(&mut self, rgb: &[u8]) -> Result<(), Error> {
        self.code(rgb).map_err(|source| Error::machine(&self.path, "writing the film", source))
    }

    fn code(&mut self, rgb: &[u8]) -> io::Result<()> {
        if rgb.len() != 3 * self.width * self.height {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the picture is not of the film's size"));
        }
        self.planes.take(rgb, self.width, self.height);
        if self.quantiser == COARSE && self.track.samples.len().is_multiple_of(group(self.rate)) {
            self.restart(FINE)?;
        }
        match self.encode() {
            Err(error) if error.kind() == io::ErrorKind::InvalidData && self.quantiser == FINE => {
                self.restart(COARSE)?;
                self.encode()
            }
            done => done,
        }
    }

    /// A new encoder, as one is of no use after an error. It begins with a key picture.
    fn restart(&mut self, quantiser: u8) -> io::Result<()> {
        self.encoder = encoder(self.width * self.height, self.rate, quantiser)?;
        self.quantiser = quantiser;
        Ok(())
    }

    /// Codes the planes; `InvalidData`, and nothing written, if the encoder cannot.
    fn encode(&mut self) -> io::Result<()> {
        let refused = |error| io::Error::new(io::ErrorKind::InvalidData, error);
        let coded = self.encoder.encode(&self.planes).map_err(refused)?;
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

/// Pictures from one key picture to the next.
fn group(rate: f64) -> usize {
    rate.round().clamp(1.0, 1000.0) as usize
}

/// Buffer-based rate control is, without a receiver that reports its buffer, a constant quantiser; the true
/// quality mode changes it with a guess at the bit rate, and prints a warning when it may not leave pictures out.
fn encoder(pixels: usize, rate: f64, quantiser: u8) -> io::Result<Encoder> {
    // From bit rate and pictures a second (of which it knows 1 to 60) the encoder only derives the level.
    let known = rate.clamp(1.0, 60.0);
    let bits = (0.5 * pixels as f64 * known).clamp(1e5, 2.4e8);
    let config = EncoderConfig::new()
        .rate_control_mode(RateControlMode::Bufferbased)
        .qp(QpRange::new(quantiser, quantiser))
        .bitrate(BitRate::from_bps(bits as u32))
        .max_frame_rate(FrameRate::from_hz(known as f32))
        .skip_frames(false)
        .adaptive_quantization(false)
        .background_detection(false)
        .scene_change_detect(false) // it would coarsen such pictures
        .num_threads(1)
        .profile(Profile::High)
        .complexity(Complexity::Medium)
        .intra_frame_period(IntraFramePeriod::from_num_frames(group(rate) as u32))
        .vui(VuiConfig::bt709());
    Encoder::with_api_config(OpenH264API::from_source(), config).map_err(io::Error::other)
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
