//! Numbers with a unit (`0.8 c`, `0 2 -9.5 m`) and without one.
//!
//! A quantity is its numbers, blanks between them, and one unit. A unit that is missing, unknown or of
//! another dimension is a fault that shows what to type, with the numbers that were written.

use super::node::{Content, Node};
use super::reader::{Read, Reader};
use super::record::{Kind, Shape};
use super::units::{self, Dimension, Unit};
use glam::DVec3;

/// Longest length, time and reciprocal acceleration, metres: products of them stay finite.
const LONGEST: f64 = 1e30;

/// A quantity that may be written in one of several dimensions.
pub(crate) struct Quantity {
    /// "a place".
    pub(crate) what: &'static str,
    /// How many numbers.
    pub(crate) count: usize,
    /// What its unit may measure, the usual one first.
    pub(crate) dimensions: &'static [Dimension],
    /// The unit to propose.
    pub(crate) unit: &'static str,
}

/// Text taken apart: numbers, then whatever follows them.
pub(crate) struct Written<'t> {
    pub(crate) numbers: Vec<f64>,
    words: Vec<&'t str>,
    /// What follows the last number, trimmed.
    pub(crate) rest: &'t str,
}

impl<'t> Written<'t> {
    pub(crate) fn of(text: &'t str) -> Self {
        let (mut numbers, mut words, mut rest) = (Vec::new(), Vec::new(), text.trim());
        while let Some(length) = number_length(rest) {
            let (word, after) = rest.split_at(length);
            let Ok(number) = word.parse() else { break };
            numbers.push(number);
            words.push(word);
            rest = after.trim_start();
            // `1,2` and `1_000` are no numbers and no units either.
            if after.starts_with([',', '_', '.', ':', ';']) {
                break;
            }
        }
        Self { numbers, words, rest }
    }

    /// The numbers as written, cut or filled up with zeros to `count`; an example if there are none.
    fn padded(&self, count: usize, example: String) -> String {
        if self.numbers.is_empty() || !self.numbers.iter().all(|x| x.is_finite()) {
            return example;
        }
        let words = self.words.iter().copied().chain(std::iter::repeat("0"));
        words.take(count).collect::<Vec<_>>().join(" ")
    }
}

/// Length of the number that the text begins with.
fn number_length(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let digits =
        |from: usize| bytes[from.min(bytes.len())..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut at = usize::from(bytes.first().is_some_and(|b| matches!(b, b'+' | b'-')));
    let whole = digits(at);
    at += whole;
    let mut fraction = 0;
    if bytes.get(at) == Some(&b'.') {
        fraction = digits(at + 1);
        at += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    if bytes.get(at).is_some_and(|b| matches!(b, b'e' | b'E')) {
        let sign = usize::from(bytes.get(at + 1).is_some_and(|b| matches!(b, b'+' | b'-')));
        let power = digits(at + 1 + sign);
        if power > 0 {
            at += 1 + sign + power;
        }
    }
    Some(at)
}

/// "1 number", "3 numbers".
fn counted(count: usize) -> String {
    if count == 1 { "one number".to_owned() } else { format!("{count} numbers") }
}

impl Quantity {
    /// Numbers that are never wrong: half the speed of light, or one of anything else.
    fn example(&self) -> String {
        if self.unit == "c" { "0 ".repeat(self.count - 1) + "0.5" } else { example(self.count) }
    }

    /// The numbers that were written, as so many; an example if they are none, or at the speed of light and above.
    fn numbers(&self, written: &Written<'_>, unit: &str) -> String {
        let square: f64 = written.numbers.iter().map(|x| x * x).sum();
        if unit == "c" && square >= 1.0 { self.example() } else { written.padded(self.count, self.example()) }
    }
}

impl Reader<'_> {
    /// The text of a value that is written as text.
    pub(crate) fn text<'n>(&mut self, node: &'n Node, what: &str, example: &str) -> Read<&'n str> {
        if let Some(text) = node.text() {
            return Ok(text);
        }
        let joined = match &node.content {
            Content::List(items) => items.iter().map(|item| item.text()).collect::<Option<Vec<_>>>(),
            _ => None,
        };
        let unit = example.rsplit(' ').next().filter(|unit| number_length(unit).is_none());
        let is_quantity = number_length(example).is_some();
        let example = joined.filter(|items| !items.is_empty()).map_or(example.to_owned(), |items| {
            let joined = items.join(" ");
            match unit {
                Some(unit) if is_quantity && Written::of(&joined).rest.is_empty() => {
                    format!("{joined} {unit}")
                }
                _ if !is_quantity && number_length(&joined).is_some() => example.to_owned(),
                _ => joined,
            }
        });
        let what = format!("{what} is written as text, not as {}", node.describe());
        let hint = self.typed(&example);
        Err(self.fault(&node.place, what, hint))
    }

    /// The numbers of a quantity in house units, and what its unit measures.
    pub(crate) fn quantity(&mut self, node: &Node, quantity: &Quantity) -> Read<(Vec<f64>, Dimension)> {
        let text = self.text(node, quantity.what, &format!("{} {}", quantity.example(), quantity.unit))?;
        let written = Written::of(text);
        self.countable(node, text, &written, quantity)?;
        let unit = self.unit(node, &written, quantity)?;
        let light_speed = self.light_speed;
        let house: Vec<f64> = written.numbers.iter().map(|x| unit.house(*x, light_speed)).collect();
        if house.iter().all(|x| x.is_finite() && (x.abs() <= LONGEST || !is_extent(unit.dimension))) {
            return Ok((house, unit.dimension));
        }
        Err(self.fault(&node.place, format!("`{text}` is too large"), "at most 1e30 m, or the like"))
    }

    /// Faults too few or too many numbers.
    fn countable(&mut self, node: &Node, text: &str, written: &Written<'_>, quantity: &Quantity) -> Read<()> {
        let (found, count) = (written.numbers.len(), quantity.count);
        let unit = unit_or(written, quantity);
        let proposed = format!("{} {unit}", quantity.numbers(written, unit));
        self.numeric(node, text, written, quantity.what, &proposed)?;
        if found == count {
            return Ok(());
        }
        let what = format!("{} is {} and a unit; here are {found}", quantity.what, counted(count));
        let what = if found == 1 { what.replace("here are 1", "here is one") } else { what };
        let hint = self.typed(&proposed);
        Err(self.fault(&node.place, what, hint))
    }

    /// Faults what does not begin with finite numbers.
    pub(crate) fn numeric(
        &mut self,
        node: &Node,
        text: &str,
        written: &Written<'_>,
        what: &str,
        proposed: &str,
    ) -> Read<()> {
        let hint = self.typed(proposed);
        let first = written.rest.trim_start_matches(['+', '-', '.']).to_lowercase();
        let fault = if first.starts_with("nan") || first.starts_with("inf") {
            format!("`{text}` is not finite")
        } else if !written.numbers.iter().all(|x| x.is_finite()) {
            format!("`{text}` is too large")
        } else if written.rest.starts_with([',', ';']) {
            let spaced = text.replace([',', ';'], " ");
            let spaced = spaced.split_whitespace().collect::<Vec<_>>().join(" ");
            let hint = format!("{}, and a decimal point is a `.`", self.typed(&spaced));
            return Err(self.fault(&node.place, "numbers are separated by blanks, not commas", hint));
        } else if written.rest.starts_with(['_', '.', ':']) {
            format!("`{text}` is not a number")
        } else if written.numbers.is_empty() {
            format!("`{text}` is not {what}")
        } else {
            return Ok(());
        };
        Err(self.fault(&node.place, fault, hint))
    }

    fn unit(&mut self, node: &Node, written: &Written<'_>, quantity: &Quantity) -> Read<Unit> {
        let plain = units::plain(written.rest);
        if let Some(unit) = units::find(&plain, quantity.dimensions) {
            return Ok(unit);
        }
        let all: Vec<_> = quantity.dimensions.iter().map(|dimension| dimension.units()).collect();
        let all = all.join(", ");
        if plain.is_empty() {
            // Nobody writes 3e8 and means c.
            let fast = quantity.unit == "c" && written.numbers.iter().any(|x| x.abs() >= 1.0);
            let unit = if fast { "m/s" } else { quantity.unit };
            let hint = self.typed(&format!("{} {unit}", quantity.numbers(written, unit)));
            return Err(self.fault(&node.place, format!("{} needs a unit", quantity.what), hint));
        }
        let (what, unit) = match units::dimension_of(&plain) {
            Some(other) => (
                format!("`{}` is {}, and {} is wanted", written.rest, other.name(), quantity.what),
                quantity.unit,
            ),
            None => (
                format!("`{}` is not a unit of {}", written.rest, quantity.what),
                units::meant(&plain, quantity.dimensions).unwrap_or(quantity.unit),
            ),
        };
        let hint =
            format!("{} (units: {all})", self.typed(&format!("{} {unit}", quantity.numbers(written, unit))));
        Err(self.fault(&node.place, what, hint))
    }

    /// Bare numbers.
    pub(crate) fn bare(&mut self, node: &Node, what: &str, count: usize) -> Read<Vec<f64>> {
        // The usual view is along z.
        let usual = if self.key() == Some("up") { "0 1 0".to_owned() } else { example(count) };
        let text = self.text(node, what, &usual)?;
        let written = Written::of(text);
        let proposed = written.padded(count, usual);
        self.numeric(node, text, &written, what, &proposed)?;
        let hint = self.typed(&proposed);
        if !written.rest.is_empty() {
            let fault = format!("{what} has no unit; here is `{}`", written.rest);
            return Err(self.fault(&node.place, fault, hint));
        }
        if written.numbers.len() != count {
            let fault = format!("{what} is {}; here are {}", counted(count), written.numbers.len());
            return Err(self.fault(&node.place, fault, hint));
        }
        if written.numbers.iter().any(|x| x.abs() > LONGEST) {
            return Err(self.fault(&node.place, format!("`{text}` is too large"), "at most 1e30"));
        }
        Ok(written.numbers)
    }
}

/// So many numbers.
fn example(count: usize) -> String {
    "0 ".repeat(count - 1) + "1"
}

fn is_extent(dimension: Dimension) -> bool {
    use Dimension::{Acceleration, Duration, Length, Speed, Wavelength};
    matches!(dimension, Length | Duration | Wavelength | Speed | Acceleration)
}

/// The unit written, if it fits, or the usual one.
fn unit_or<'a>(written: &Written<'a>, quantity: &Quantity) -> &'a str {
    let fits = units::find(&units::plain(written.rest), quantity.dimensions).is_some();
    if fits { written.rest } else { quantity.unit }
}

/// Declares kinds of one number with a unit, in house units.
macro_rules! scalars {
    ($( $(#[doc = $doc:literal])* $name:ident: $what:literal, [$($dimension:ident),*], $unit:literal $(, $check:expr, $right:literal)?; )*) => {$(
        $(#[doc = $doc])*
        pub(crate) struct $name;
        impl $name {
            pub(crate) const QUANTITY: Quantity =
                Quantity { what: $what, count: 1, dimensions: &[$(Dimension::$dimension),*], unit: $unit };
        }
        impl Kind for $name {
            type Value = f64;
            fn shape() -> Shape {
                Shape::Text(concat!($what, " with its unit, in ", $unit, " for example"))
            }
            fn read(node: &Node, reader: &mut Reader<'_>) -> Read<f64> {
                let (numbers, _) = reader.quantity(node, &Self::QUANTITY)?;
                let number = numbers.first().copied().unwrap_or_default();
                $( if !($check as fn(f64) -> bool)(number) {
                    let hint = reader.typed($right);
                    return Err(reader.fault(&node.place, format!("`{}` is out of range", node.text().unwrap_or_default()), hint));
                } )?
                Ok(number)
            }
        }
    )*};
}

scalars! {
    /// Metres, > 0.
    Length: "a length", [Length], "m", |x| x > 0.0, "2 m (above zero)";
    /// Metres, either way.
    Offset: "a length", [Length], "m";
    /// Metres of light travel.
    Instant: "a time", [Duration, Length], "s";
    /// Metres of light travel, > 0.
    Period: "a time", [Duration, Length], "s", |x| x >= 1e-30, "2 s (above zero)";
    /// Radians.
    Angle: "an angle", [Angle], "deg";
    /// Radians, between 0 and 180 degrees.
    ViewAngle: "an angle", [Angle], "deg", |x| x > 0.0 && x < std::f64::consts::PI, "50 deg (between 0 and 180), or lens: fisheye";
    /// Radians, above 0 and up to 360 degrees.
    ConeAngle: "an angle", [Angle], "deg", |x| x > 0.0 && x <= std::f64::consts::TAU, "40 deg (up to 360)";
    /// Radians, above 0 and below 90 degrees.
    DiscAngle: "an angle", [Angle], "deg", |x| x > 0.0 && x < std::f64::consts::FRAC_PI_2, "0.6 deg (below 90)";
    /// Kelvin, > 0.
    Temperature: "a temperature", [Temperature], "K", |x| x > 0.0 && x <= 1e12, "5600 K (above 0, up to 1e12)";
    /// Nanometres, > 0.
    Wavelength: "a wavelength", [Wavelength], "nm", |x| x > 0.0 && x <= 1e12, "589 nm (above zero)";
}

/// Declares kinds of three numbers with a unit, in house units.
macro_rules! vectors {
    ($( $(#[doc = $doc:literal])* $name:ident: $what:literal, $dimension:ident, $unit:literal; )*) => {$(
        $(#[doc = $doc])*
        pub(crate) struct $name;
        impl $name {
            pub(crate) const QUANTITY: Quantity =
                Quantity { what: $what, count: 3, dimensions: &[Dimension::$dimension], unit: $unit };
        }
        impl Kind for $name {
            type Value = DVec3;
            fn shape() -> Shape {
                Shape::Text(concat!($what, ": three numbers and a unit, as in 0 2 -9.5 ", $unit))
            }
            fn read(node: &Node, reader: &mut Reader<'_>) -> Read<DVec3> {
                Ok(vector(&reader.quantity(node, &Self::QUANTITY)?.0))
            }
        }
    )*};
}

vectors! {
    /// Metres.
    Point: "a place", Length, "m";
    /// Fractions of c; not checked.
    VelocityVector: "a velocity", Speed, "c";
    /// Per metre.
    Acceleration: "an acceleration", Acceleration, "m/s2";
}

/// The first three numbers.
pub(crate) fn vector(numbers: &[f64]) -> DVec3 {
    let at = |index: usize| numbers.get(index).copied().unwrap_or_default();
    DVec3::new(at(0), at(1), at(2))
}
