//! `OpenEXR`: what every pixel measured, in floating point.

use super::write_whole;
use crate::error::Error;
use exr::meta::attribute::{Chromaticities, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, ChannelDescription, Compression, Encoding, FlatSamples,
    Image, Layer, LayerAttributes, LineOrder, ReadChannels, ReadLayers, SampleType, Vec2, WritableImage, f16,
};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// The measured picture: what goes into an `OpenEXR` file.
#[derive(Debug, Clone)]
pub struct Measured<'a> {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// What is known of each pixel.
    pub channels: Vec<Channel>,
    /// Luminance in cd/m² of `R`, `G`, `B` = (1, 1, 1); attribute `whiteLuminance`. With it a reader gets from them to
    /// absolute units.
    pub white_luminance: f32,
    /// Whether channels hold a spectrum by the layout of Fichet, Pacanowski and Wilkie (JCGT 10(3), 2021): `S0.409,375nm` in
    /// W m⁻² sr⁻¹ nm⁻¹.
    pub spectral: bool,
    /// What is written into the attribute `comments`, one line `keyword: text` each (UTF-8).
    pub text: &'a [(&'a str, String)],
}

/// A value of each pixel, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its name. (Not a bare `Y`: readers take that for the luma of a black-and-white or subsampled picture.)
    pub name: String,
    /// The values.
    pub values: Vec<f32>,
    /// Whether they are stored in 16 bits; those beyond the largest such number (65504) as that.
    pub half: bool,
}

impl Channel {
    /// In 32 bits.
    pub fn new(name: impl Into<String>, values: Vec<f32>) -> Self {
        Self { name: name.into(), values, half: false }
    }

    fn samples(self) -> FlatSamples {
        if self.half {
            let short = |value: f32| f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32()));
            return FlatSamples::F16(self.values.into_iter().map(short).collect());
        }
        FlatSamples::F32(self.values)
    }
}

impl Measured<'_> {
    /// What the file will be like.
    pub fn form(&self) -> ExrForm {
        let channels = self.channels.iter().map(|channel| (channel.name.clone(), channel.half));
        let mut form =
            ExrForm { size: (self.width as u32, self.height as u32), channels: channels.collect() };
        form.channels.sort();
        form
    }

    /// Everything but the pixels. The texts share one attribute because the writer puts attributes of
    /// names of our own in an order that changes from run to run.
    fn attributes(&self) -> LayerAttributes {
        let mut attributes = LayerAttributes {
            white_luminance: Some(self.white_luminance),
            software_name: Some(text(concat!("terrell ", env!("CARGO_PKG_VERSION")))),
            ..LayerAttributes::default()
        };
        if !self.text.is_empty() {
            let lines: Vec<String> = self.text.iter().map(|(key, value)| format!("{key}: {value}")).collect();
            attributes.comments = Some(text(&lines.join("\n")));
        }
        if self.spectral {
            // One here and one among those of the image, for the same reason.
            let units = AttributeValue::Text(text("W.m^-2.sr^-1.nm^-1"));
            attributes.other.insert(text("emissiveUnits"), units);
        }
        attributes
    }
}

/// Writes an `OpenEXR` file of one layer, losslessly compressed, with the chromaticities of Rec. 709. The same
/// channels give the same bytes.
pub fn write_exr(path: &Path, measured: Measured<'_>) -> Result<(), Error> {
    let size = (measured.width, measured.height);
    let count = size.0.checked_mul(size.1).filter(|count| *count > 0);
    if measured.channels.is_empty()
        || measured.channels.iter().any(|channel| Some(channel.values.len()) != count)
    {
        let what = "the channels have not one value for each pixel";
        return Err(Error::machine(path, "writing", io::Error::new(io::ErrorKind::InvalidInput, what)));
    }
    let (attributes, spectral) = (measured.attributes(), measured.spectral);
    let channel = |channel: Channel| AnyChannel::new(&*channel.name.clone(), channel.samples());
    let list = measured.channels.into_iter().map(channel).collect();
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let mut image = Image::from_layer(Layer::new(size, attributes, encoding, AnyChannels::sort(list)));
    image.attributes.chromaticities = Some(REC709);
    if spectral {
        let version = AttributeValue::Text(text("1.0"));
        image.attributes.other.insert(text("spectralLayoutVersion"), version);
    }
    write_whole(path, |file| image.write().to_buffered(file).map_err(machine))
}

fn machine(error: exr::error::Error) -> io::Error {
    match error {
        exr::error::Error::Io(source) => source,
        other => io::Error::other(other.to_string()),
    }
}

/// The lines of the attribute `comments` by their keywords; empty if it is no `OpenEXR` file.
pub fn exr_texts(path: &Path) -> BTreeMap<String, String> {
    let about = exr::meta::MetaData::read_from_file(path, false);
    let header = about.ok().and_then(|about| about.headers.into_iter().next());
    let comments = header.and_then(|header| header.own_attributes.comments).map(|text| text.to_string());
    let comments = comments.unwrap_or_default();
    let pairs = comments.lines().filter_map(|line| line.split_once(": "));
    pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
}

/// Reads an `OpenEXR` file to its last byte; an error if anything is wrong with it, or if it is not of this form.
pub fn check_exr(path: &Path, form: &ExrForm) -> Result<(), Error> {
    let wrong = |error| Error::machine(path, "reading", machine(error));
    let about = exr::meta::MetaData::read_from_file(path, false).map_err(wrong)?;
    let header = about.headers.first().filter(|_| about.headers.len() == 1);
    let is_half = |channel: &ChannelDescription| channel.sample_type == SampleType::F16;
    let found = header.map(|header| ExrForm {
        size: (header.layer_size.0 as u32, header.layer_size.1 as u32),
        channels: header.channels.list.iter().map(|one| (one.name.to_string(), is_half(one))).collect(),
    });
    if found.as_ref() != Some(form) {
        let other = io::Error::new(io::ErrorKind::InvalidData, "it is another kind of picture");
        return Err(Error::machine(path, "reading", other));
    }
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    // Many are read at once.
    let reader = reader.first_valid_layer().all_attributes().non_parallel();
    reader.from_file(path).map(|_| ()).map_err(wrong)
}

/// What an `OpenEXR` file is like.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExrForm {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Names of the channels, sorted by their bytes, each with whether it is in 16 bits.
    pub channels: Vec<(String, bool)>,
}

/// Primaries and white of sRGB, ITU-R BT.709-6 table 1.
const REC709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
