//! The units that a manifest may use, and what they are in house units.
//!
//! A factor is `up / down` times a power of the speed of light in m/s: times become metres of light travel,
//! speeds fractions of c, accelerations per metre. Keeping `up` and `down` apart rounds once: `7 cm` is 0.07.

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dimension {
    /// Metres.
    Length,
    /// Metres of light travel.
    Duration,
    /// Nanometres.
    Wavelength,
    /// Radians.
    Angle,
    /// Kelvin.
    Temperature,
    /// Of c.
    Speed,
    /// Per metre (c² per metre).
    Acceleration,
    /// cd.
    Intensity,
    /// W/sr.
    RadiantIntensity,
    /// lm.
    Flux,
    /// W.
    Power,
    /// cd/m².
    Luminance,
    /// W/m²/sr.
    Radiance,
    /// lx.
    Illuminance,
    /// W/m².
    Irradiance,
}

impl Dimension {
    /// "a length".
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Duration => "a time",
            Self::Wavelength => "a wavelength",
            Self::Angle => "an angle",
            Self::Temperature => "a temperature",
            Self::Speed => "a speed",
            Self::Acceleration => "an acceleration",
            Self::Intensity => "a luminous intensity",
            Self::RadiantIntensity => "a radiant intensity",
            Self::Flux => "a luminous flux",
            Self::Power => "a power",
            Self::Luminance => "a luminance",
            Self::Radiance => "a radiance",
            Self::Illuminance => "an illuminance",
            Self::Irradiance => "an irradiance",
        }
    }

    /// The units to show to someone who needs one.
    pub(crate) fn units(self) -> &'static str {
        match self {
            Self::Length => "m, km, cm, mm, um, nm, ls, ly, au, pc",
            Self::Duration => "s, ms, us, ns, ps, min, h, d, yr",
            Self::Wavelength => "nm, um, mm, m",
            Self::Angle => "deg, rad, turn",
            Self::Temperature => "K",
            Self::Speed => "c, m/s, km/s, km/h",
            Self::Acceleration => "m/s2, g, c/s",
            Self::Intensity => "cd",
            Self::RadiantIntensity => "W/sr",
            Self::Flux => "lm",
            Self::Power => "W",
            Self::Luminance => "cd/m2",
            Self::Radiance => "W/m2/sr",
            Self::Illuminance => "lx",
            Self::Irradiance => "W/m2",
        }
    }
}

/// A unit: `house = written · up / down · (speed of light in m/s)^light`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub(crate) dimension: Dimension,
    up: f64,
    down: f64,
    light: i32,
}

impl Unit {
    /// A written number in house units.
    pub(crate) fn house(self, number: f64, light_speed: f64) -> f64 {
        match self.light {
            0 => number * self.up / self.down,
            1 => number * self.up * light_speed / self.down,
            -1 => number * self.up / (self.down * light_speed),
            _ => number * self.up / (self.down * light_speed) / light_speed,
        }
    }
}

const TURN: f64 = std::f64::consts::TAU;
/// The Julian year.
const YEAR: f64 = 31_557_600.0;
/// IAU 2012, resolution B2.
const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;
/// IAU 2015, resolution B2: 648000/π astronomical units.
const PARSEC: f64 = 648_000.0 / std::f64::consts::PI * ASTRONOMICAL_UNIT;
/// Standard gravity, m/s² (CGPM 1901).
const GRAVITY: f64 = 9.806_65;

use Dimension as D;
/// Name, dimension, up, down, power of the speed of light.
const UNITS: &[(&str, Dimension, f64, f64, i32)] = &[
    ("m", D::Length, 1.0, 1.0, 0),
    ("km", D::Length, 1e3, 1.0, 0),
    ("cm", D::Length, 1.0, 1e2, 0),
    ("mm", D::Length, 1.0, 1e3, 0),
    ("um", D::Length, 1.0, 1e6, 0),
    ("nm", D::Length, 1.0, 1e9, 0),
    ("au", D::Length, ASTRONOMICAL_UNIT, 1.0, 0),
    ("pc", D::Length, PARSEC, 1.0, 0),
    // The way of light in this manifest's second and year, whatever its speed.
    ("ls", D::Length, 1.0, 1.0, 1),
    ("ly", D::Length, YEAR, 1.0, 1),
    ("s", D::Duration, 1.0, 1.0, 1),
    ("ms", D::Duration, 1.0, 1e3, 1),
    ("us", D::Duration, 1.0, 1e6, 1),
    ("ns", D::Duration, 1.0, 1e9, 1),
    ("ps", D::Duration, 1.0, 1e12, 1),
    ("fs", D::Duration, 1.0, 1e15, 1),
    ("min", D::Duration, 60.0, 1.0, 1),
    ("h", D::Duration, 3600.0, 1.0, 1),
    ("d", D::Duration, 86_400.0, 1.0, 1),
    ("yr", D::Duration, YEAR, 1.0, 1),
    ("nm", D::Wavelength, 1.0, 1.0, 0),
    ("um", D::Wavelength, 1e3, 1.0, 0),
    ("mm", D::Wavelength, 1e6, 1.0, 0),
    ("m", D::Wavelength, 1e9, 1.0, 0),
    ("deg", D::Angle, TURN, 360.0, 0),
    ("°", D::Angle, TURN, 360.0, 0),
    ("rad", D::Angle, 1.0, 1.0, 0),
    ("turn", D::Angle, TURN, 1.0, 0),
    ("turns", D::Angle, TURN, 1.0, 0),
    ("K", D::Temperature, 1.0, 1.0, 0),
    ("c", D::Speed, 1.0, 1.0, 0),
    ("g", D::Acceleration, GRAVITY, 1.0, -2),
    ("cd", D::Intensity, 1.0, 1.0, 0),
    ("lm/sr", D::Intensity, 1.0, 1.0, 0),
    ("W/sr", D::RadiantIntensity, 1.0, 1.0, 0),
    ("lm", D::Flux, 1.0, 1.0, 0),
    ("W", D::Power, 1.0, 1.0, 0),
    ("kW", D::Power, 1e3, 1.0, 0),
    ("mW", D::Power, 1.0, 1e3, 0),
    ("cd/m2", D::Luminance, 1.0, 1.0, 0),
    ("nit", D::Luminance, 1.0, 1.0, 0),
    ("W/m2/sr", D::Radiance, 1.0, 1.0, 0),
    ("W/sr/m2", D::Radiance, 1.0, 1.0, 0),
    ("W/(m2sr)", D::Radiance, 1.0, 1.0, 0),
    ("lx", D::Illuminance, 1.0, 1.0, 0),
    ("lm/m2", D::Illuminance, 1.0, 1.0, 0),
    ("W/m2", D::Irradiance, 1.0, 1.0, 0),
];

/// What people write for a unit that has another name here.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("metre", "m"),
    ("meter", "m"),
    ("kilometre", "km"),
    ("kilometer", "km"),
    ("millimetre", "mm"),
    ("millimeter", "mm"),
    ("nanometre", "nm"),
    ("nanometer", "nm"),
    ("micron", "um"),
    ("second", "s"),
    ("sec", "s"),
    ("nanosecond", "ns"),
    ("microsecond", "us"),
    ("millisecond", "ms"),
    ("minute", "min"),
    ("hour", "h"),
    ("hr", "h"),
    ("day", "d"),
    ("year", "yr"),
    ("y", "yr"),
    ("a", "yr"),
    ("light-second", "ls"),
    ("lightsecond", "ls"),
    ("light-year", "ly"),
    ("lightyear", "ly"),
    ("degree", "deg"),
    ("radian", "rad"),
    ("revolution", "turn"),
    ("kelvin", "K"),
    ("lightspeed", "c"),
    ("mps", "m/s"),
    ("kph", "km/h"),
    ("kmh", "km/h"),
    ("candela", "cd"),
    ("lumen", "lm"),
    ("lux", "lx"),
    ("watt", "W"),
    ("cd/m", "cd/m2"),
    ("W/m", "W/m2"),
];

/// A unit as written, without blanks, powers as plain digits and the micro sign as u.
pub(crate) fn plain(written: &str) -> String {
    let kept = written.chars().filter(|c| !c.is_whitespace() && !matches!(c, '^' | '*' | '·'));
    kept.map(|c| match c {
        '²' => '2',
        'µ' | 'μ' => 'u',
        other => other,
    })
    .collect()
}

/// The unit written, in one of the dimensions wanted.
pub(crate) fn find(plain: &str, wanted: &[Dimension]) -> Option<Unit> {
    wanted.iter().find_map(|dimension| {
        simple(plain, *dimension).or_else(|| match dimension {
            Dimension::Speed => per(plain, Dimension::Length, "", Dimension::Speed),
            Dimension::Acceleration => per(plain, Dimension::Length, "2", Dimension::Acceleration)
                .or_else(|| per(plain, Dimension::Speed, "", Dimension::Acceleration)),
            _ => None,
        })
    })
}

/// What a unit measures, of everything that is known.
pub(crate) fn dimension_of(plain: &str) -> Option<Dimension> {
    let composed = [Dimension::Speed, Dimension::Acceleration];
    let simple = UNITS.iter().find(|(name, ..)| *name == plain).map(|row| row.1);
    simple.or_else(|| find(plain, &composed).map(|unit| unit.dimension))
}

/// The unit that was probably meant, of the dimensions wanted.
pub(crate) fn meant(plain: &str, wanted: &[Dimension]) -> Option<&'static str> {
    let candidates = UNITS.iter().filter(|row| wanted.contains(&row.1)).map(|row| row.0);
    let lower = plain.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let other =
        OTHER_NAMES.iter().find(|(name, _)| name.eq_ignore_ascii_case(singular)).map(|(_, unit)| *unit);
    other
        .filter(|unit| find(unit, wanted).is_some())
        .or_else(|| candidates.clone().find(|name| name.to_lowercase() == lower))
}

fn simple(plain: &str, dimension: Dimension) -> Option<Unit> {
    UNITS
        .iter()
        .find(|(name, of, ..)| *name == plain && *of == dimension)
        .map(|&(_, dimension, up, down, light)| Unit { dimension, up, down, light })
}

/// `plain` as `upper/duration`, the duration to the power written.
fn per(plain: &str, upper: Dimension, power: &str, dimension: Dimension) -> Option<Unit> {
    let (above, below) = plain.split_once('/')?;
    let above = simple(above, upper)?;
    let below = simple(below.strip_suffix(power)?, Dimension::Duration)?;
    let times = if power == "2" { 2 } else { 1 };
    let raise = |x: f64| if times == 2 { x * x } else { x };
    Some(Unit {
        dimension,
        up: above.up * raise(below.down),
        down: above.down * raise(below.up),
        light: above.light - times,
    })
}
