//! Light sources' spectra: a smooth part at any wavelength, and lines.

use super::daylight::Filtered;
use super::table::add;
use super::{D65, Table, Tone, planck};
use crate::color;

/// A tabulated or defined CIE illuminant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Illuminant {
    /// Daylight, 6504 K.
    D65,
    /// Incandescent light: a black body of 2855.5 K.
    A,
    /// The same at every wavelength.
    E,
}

/// A spectrum as a manifest describes it: a shape, whose brightness is said elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub enum Spectrum {
    /// A black body, kelvin; as spectral radiance.
    BlackBody(f64),
    /// A spectral line: centre and full width at half maximum in nm (0: without width); total power 1.
    Line {
        /// nm.
        centre_nm: f64,
        /// nm.
        width_nm: f64,
    },
    /// Tabulated; zero outside the table.
    Table(Table),
    /// The same at every wavelength.
    Constant(f64),
    /// D65 seen through a filter of a linear sRGB colour: looks like that colour.
    Rgb([f64; 3]),
    /// A CIE illuminant.
    Illuminant(Illuminant),
    /// All of these together.
    Sum(Vec<Self>),
    /// A spectrum, this many times.
    Scaled(f64, Box<Self>),
}

/// Light of one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// nm, in the source's rest frame.
    pub wavelength_nm: f64,
    /// The quantity (radiance, intensity, ...) integrated over the line.
    pub power: f64,
}

/// A spectrum ready to be evaluated: any spectral quantity of a source in its own rest frame.
#[derive(Debug, Clone, Default)]
pub struct Source {
    smooth: Vec<(f64, Smooth)>,
    lines: Vec<Line>,
}

#[derive(Debug, Clone)]
enum Smooth {
    BlackBody(f64),
    Constant,
    Daylight,
    Filtered(Filtered),
    Table(Table),
    Gauss { centre_nm: f64, sigma_nm: f64 },
}

/// Illuminant A: 2848 K with c₂ = 1.435e-2 m K, on the present temperature scale (CIE 15:2018).
const ILLUMINANT_A_K: f64 = 2848.0 * 1.438_776_877 / 1.435;
/// 1/√(2π).
const FRAC_1_SQRT_TAU: f64 = 0.398_942_280_401_432_7;
/// Lines up to this standard deviation (nm) are carried as points; broader ones are sampled as a curve.
const BROADEST_LINE_NM: f64 = 51.0;
/// Points of a line are no farther apart (nm), so that even shifted by 4 they lie closer than the eye's curves bend.
const POINTS_NM: f64 = 5.0;

impl Source {
    /// `factor` times the spectrum.
    pub fn new(spectrum: &Spectrum, factor: f64) -> Self {
        let mut source = Self::default();
        source.add(spectrum, factor);
        source
    }

    /// The spectrum with a given photometric value: cd for an intensity, lx for an irradiance, cd/m² for a radiance.
    ///
    /// None for a spectrum that no eye sees.
    pub fn with_luminous(spectrum: &Spectrum, value: f64) -> Option<Self> {
        let unit = Self::new(spectrum, 1.0);
        let luminous = unit.xyz().y;
        (luminous > 1e-30).then(|| Self::new(spectrum, value / luminous))
    }

    /// The spectrum with a given radiometric value over all wavelengths: W/sr, W/m² or W/(m² sr).
    ///
    /// None for a spectrum without a finite total (constant, E).
    pub fn with_total(spectrum: &Spectrum, value: f64) -> Option<Self> {
        let total = spectrum.total()?;
        (total > 0.0).then(|| Self::new(spectrum, value / total))
    }

    fn add(&mut self, spectrum: &Spectrum, factor: f64) {
        match spectrum {
            Spectrum::BlackBody(kelvin) => self.smooth.push((factor, Smooth::BlackBody(*kelvin))),
            Spectrum::Line { centre_nm, width_nm } => self.add_line(*centre_nm, *width_nm, factor),
            Spectrum::Table(table) => self.smooth.push((factor, Smooth::Table(table.clone()))),
            Spectrum::Constant(value) => self.smooth.push((factor * value, Smooth::Constant)),
            Spectrum::Rgb(rgb) if rgb[0] == rgb[1] && rgb[1] == rgb[2] => {
                self.smooth.push((factor * rgb[0], Smooth::Daylight));
            }
            Spectrum::Rgb(rgb) => self.smooth.push((factor, Smooth::Filtered(Filtered::new(*rgb)))),
            Spectrum::Illuminant(Illuminant::D65) => self.smooth.push((factor, Smooth::Daylight)),
            Spectrum::Illuminant(Illuminant::A) => {
                self.smooth.push((factor, Smooth::BlackBody(ILLUMINANT_A_K)));
            }
            Spectrum::Illuminant(Illuminant::E) => self.smooth.push((factor, Smooth::Constant)),
            Spectrum::Sum(parts) => parts.iter().for_each(|part| self.add(part, factor)),
            Spectrum::Scaled(times, of) => self.add(of, factor * times),
        }
    }

    /// A line becomes points at most one standard deviation apart: for a Gaussian the sum over them equals the
    /// integral against any curve that is smooth on that scale (to 1e-6 for a constant: what lies beyond 5 of them).
    fn add_line(&mut self, centre_nm: f64, width_nm: f64, power: f64) {
        let sigma_nm = width_nm / 2.354_820_045_030_949_3; // FWHM = 2√(2 ln 2) σ
        if sigma_nm == 0.0 {
            return self.lines.push(Line { wavelength_nm: centre_nm, power });
        }
        if sigma_nm > BROADEST_LINE_NM {
            return self.smooth.push((power, Smooth::Gauss { centre_nm, sigma_nm }));
        }
        let per_sigma = (sigma_nm / POINTS_NM).max(1.0).ceil() as i32;
        for step in -5 * per_sigma..=5 * per_sigma {
            let sigmas = f64::from(step) / f64::from(per_sigma);
            let wavelength_nm = centre_nm + sigmas * sigma_nm;
            if wavelength_nm > 0.0 {
                let weight = libm::exp(-0.5 * sigmas * sigmas) * FRAC_1_SQRT_TAU / f64::from(per_sigma);
                self.lines.push(Line { wavelength_nm, power: power * weight });
            }
        }
    }

    /// The smooth part, per nm, at one wavelength in the source's rest frame.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        self.at_each(&[wavelength_nm])[0]
    }

    /// The smooth part, per nm, at many wavelengths at once.
    #[inline]
    pub fn at_each<const N: usize>(&self, wavelengths_nm: &[f64; N]) -> [f64; N] {
        let mut sum = [0.0; N];
        self.add_each(&mut sum, wavelengths_nm, 1.0);
        sum
    }

    /// Adds the smooth part, so many times, at many wavelengths.
    #[inline]
    pub fn add_each<const N: usize>(&self, sum: &mut [f64; N], wavelengths_nm: &[f64; N], times: f64) {
        for (factor, smooth) in &self.smooth {
            smooth.add_to(sum, wavelengths_nm, factor * times);
        }
    }

    /// What its smooth part is beside daylight.
    pub fn tone(&self) -> Tone {
        let tone = |(_, smooth): &(f64, Smooth)| match smooth {
            Smooth::Daylight => Tone::Grey,
            Smooth::Filtered(_) => Tone::Color,
            _ => Tone::Spectrum,
        };
        self.smooth.iter().map(tone).max().unwrap_or(Tone::Grey)
    }

    /// The width (nm, at half height) of the narrowest peak that a table in it has.
    pub fn narrowest_peak_nm(&self) -> Option<f64> {
        let of = |(_, smooth): &(f64, Smooth)| match smooth {
            Smooth::Table(table) => table.narrowest_peak_nm(),
            _ => None,
        };
        self.smooth.iter().filter_map(of).reduce(f64::min)
    }

    /// Whether nothing is in it.
    pub fn is_dark(&self) -> bool {
        self.smooth.is_empty() && self.lines.is_empty()
    }

    /// Whether there is nothing between its lines.
    pub fn is_of_lines(&self) -> bool {
        self.smooth.is_empty() && !self.lines.is_empty()
    }

    /// The lines, wavelengths in the source's rest frame.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// XYZ as seen at rest: in cd/m² for a radiance and so on.
    pub fn xyz(&self) -> glam::DVec3 {
        let lines = self.lines.iter().map(|line| color::matching(line.wavelength_nm) * line.power);
        color::xyz_of(|nm| self.at(nm)) + lines.sum::<glam::DVec3>() * color::LUMENS_PER_WATT
    }
}

impl Smooth {
    #[inline]
    fn add_to<const N: usize>(&self, sum: &mut [f64; N], wavelengths_nm: &[f64; N], factor: f64) {
        match self {
            Self::BlackBody(kelvin) => add(sum, wavelengths_nm, factor, |nm| planck(nm, *kelvin)),
            Self::Constant => add(sum, wavelengths_nm, factor, |_| 1.0),
            Self::Daylight => D65.add_each(sum, wavelengths_nm, factor),
            Self::Filtered(filtered) => filtered.add_each(sum, wavelengths_nm, factor),
            Self::Table(table) => {
                let (first, last) = table.range();
                let value = |nm| if (first..=last).contains(&nm) { table.at(nm) } else { 0.0 };
                add(sum, wavelengths_nm, factor, value);
            }
            Self::Gauss { centre_nm, sigma_nm } => add(sum, wavelengths_nm, factor, |nm| {
                let z = (nm - centre_nm) / sigma_nm;
                libm::exp(-0.5 * z * z) * FRAC_1_SQRT_TAU / sigma_nm
            }),
        }
    }
}

impl Spectrum {
    /// The illuminant D65.
    pub const DAYLIGHT: Self = Self::Illuminant(Illuminant::D65);

    /// The integral over all wavelengths (nm), where it is finite.
    pub fn total(&self) -> Option<f64> {
        match self {
            // Stefan and Boltzmann, σT⁴/π.
            Self::BlackBody(kelvin) => Some(5.670_374_419e-8 * kelvin.powi(4) / std::f64::consts::PI),
            Self::Line { .. } => Some(1.0),
            Self::Constant(_) | Self::Illuminant(Illuminant::E) => None,
            Self::Table(table) => Some(table.integral()),
            Self::Illuminant(Illuminant::A) => Self::BlackBody(ILLUMINANT_A_K).total(),
            Self::Rgb(_) | Self::Illuminant(Illuminant::D65) => {
                // 20 nm to 100 µm, in the logarithm of the wavelength.
                let source = Source::new(self, 1.0);
                let per_log = |log: f64| source.at(libm::exp(log)) * libm::exp(log);
                Some(integral(per_log, libm::log(20.0), libm::log(1e5)))
            }
            Self::Sum(parts) => parts.iter().map(Self::total).sum(),
            Self::Scaled(times, of) => of.total().map(|total| total * times),
        }
    }
}

/// By the trapezium rule with 20,000 steps.
fn integral(of: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let step = (to - from) / 20_000.0;
    (0..20_000)
        .map(|i| 0.5 * (of(from + step * f64::from(i)) + of(from + step * f64::from(i + 1))) * step)
        .sum()
}
