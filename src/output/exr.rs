//! `OpenEXR`: what every pixel measured, in floating point.

use super::write_whole;
use crate::error::Error;
use exr::meta::attribute::{Chromaticities, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, Vec2, WritableImage,
};
use std::io;
use std::path::Path;

/// The measured picture: what goes into an `OpenEXR` file. Every list has `width * height` entries, row by row
/// from the top.
#[derive(Debug, Clone, Copy)]
pub struct Layers<'a> {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Linear light in the primaries of sRGB (Rec. 709, white D65); channels `R`, `G`, `B`.
    pub rgb: &'a [[f32; 3]],
    /// Luminance in cd/m² of `rgb` = (1, 1, 1); attribute `whiteLuminance`. With it a reader can get from `R`,
    /// `G`, `B` to absolute units.
    pub white_luminance: f32,
    /// CIE 1931 X, Y, Z in cd/m²; channels `cie.X`, `cie.Y`, `cie.Z`. (Not bare `Y`: readers take that for the
    /// luma of a black-and-white or subsampled picture.)
    pub xyz: &'a [[f32; 3]],
    /// Frequency seen over frequency sent; channel `doppler`.
    pub doppler: &'a [f32],
    /// When the light left what is seen, as lab time in seconds; channel `emission_time`.
    pub emission_time: &'a [f32],
    /// Number of the body seen, -1 for none; channel `body`, as a float, which holds whole numbers
    /// exactly up to 2^24.
    pub body: &'a [i32],
    /// What is written into the attribute `comments`, one line `keyword: text` each (UTF-8).
    pub text: &'a [(&'a str, String)],
}

impl Layers<'_> {
    /// Name and values of each channel; `None` if a list has not one entry a pixel.
    fn channels(&self) -> Option<Vec<(&'static str, Vec<f32>)>> {
        let count = self.width.checked_mul(self.height).filter(|count| *count > 0)?;
        let all_fit = [self.rgb.len(), self.xyz.len(), self.doppler.len(), self.emission_time.len()]
            .into_iter()
            .chain([self.body.len()])
            .all(|length| length == count);
        let part = |of: &[[f32; 3]], which: usize| of.iter().map(|v| v[which]).collect::<Vec<f32>>();
        all_fit.then(|| {
            vec![
                ("R", part(self.rgb, 0)),
                ("G", part(self.rgb, 1)),
                ("B", part(self.rgb, 2)),
                ("cie.X", part(self.xyz, 0)),
                ("cie.Y", part(self.xyz, 1)),
                ("cie.Z", part(self.xyz, 2)),
                ("doppler", self.doppler.to_vec()),
                ("emission_time", self.emission_time.to_vec()),
                ("body", self.body.iter().map(|body| *body as f32).collect()),
            ]
        })
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
        attributes
    }
}

/// Writes an `OpenEXR` file of one layer with all channels in 32 bits, losslessly compressed, with the
/// chromaticities of Rec. 709. The same layers give the same bytes.
pub fn write_exr(path: &Path, layers: &Layers<'_>) -> Result<(), Error> {
    let Some(channels) = layers.channels() else {
        let what = "the layers have not one value for each pixel";
        return Err(Error::machine(path, "writing", io::Error::new(io::ErrorKind::InvalidInput, what)));
    };
    let list =
        channels.into_iter().map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values))).collect();
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (layers.width, layers.height);
    let mut image =
        Image::from_layer(Layer::new(size, layers.attributes(), encoding, AnyChannels::sort(list)));
    image.attributes.chromaticities = Some(REC709);
    write_whole(path, |file| {
        image.write().to_buffered(file).map_err(|error| match error {
            exr::error::Error::Io(source) => source,
            other => io::Error::other(other.to_string()),
        })
    })
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
