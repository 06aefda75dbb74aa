//! Spectra: of lamps, of glowing and of reflecting surfaces, at any wavelength that a Doppler shift may ask for.
//!
//! Wavelengths are sampled in the *observer's* rest frame ([`Wavelengths`]); a source is evaluated at the
//! wavelength that the light had when it left, so nothing is ever resampled. A spectral line is a point and
//! no sample: it is kept apart ([`Line`]) and carried exactly.

mod blackbody;
mod daylight;
mod index;
mod lanes;
mod metal;
mod reflectance;
mod source;
mod table;

pub use blackbody::planck;
pub use daylight::D65;
pub use index::Index;
pub use lanes::Wavelengths;
pub use metal::Metal;
pub use reflectance::{Beyond, End, Reflectance, Tone};
pub use source::{Illuminant, Line, Source, Spectrum};
pub use table::{Table, rows};
