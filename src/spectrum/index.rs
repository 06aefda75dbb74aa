//! Refractive indices of what light goes through, at any wavelength.

/// Terms of a Sellmeier formula.
const TERMS: usize = 6;
/// Where a formula without a range of its own is followed, nm; beyond, its ends are held.
const USUAL_RANGE_NM: (f64, f64) = (300.0, 2500.0);
/// Where a formula must be sound to be one for a transparent body, nm.
const VISIBLE_NM: (f64, f64) = (380.0, 780.0);
/// No index is higher; keeps resonances finite.
const HIGHEST: f64 = 100.0;

/// The refractive index of a transparent body, by the wavelength (in vacuum) in its own rest frame.
///
/// Formulas hold over their range only. Beyond it the index of that end goes on, the same for all wavelengths: a
/// Doppler shift may ask for X-rays or radio waves. No index is ever below 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Index {
    /// The same at all wavelengths.
    Constant(f64),
    /// `n = a + b/λ² + c/λ⁴`, λ in micrometres.
    Cauchy {
        /// The index at long wavelengths.
        a: f64,
        /// µm².
        b: f64,
        /// µm⁴.
        c: f64,
        /// Where the formula is followed, nm.
        range_nm: (f64, f64),
    },
    /// `n² = 1 + Σ b λ²/(λ² - c)`, λ in micrometres; terms that are not needed are zero.
    Sellmeier {
        /// Strengths of the resonances.
        b: [f64; TERMS],
        /// Squares of the resonances' wavelengths, µm².
        c: [f64; TERMS],
        /// Where the formula is followed, nm.
        range_nm: (f64, f64),
    },
}

impl Index {
    /// The names that [`Index::named`] knows.
    pub const NAMES: &'static [&'static str] = &["BK7", "SF11", "fused_silica", "diamond", "water"];

    /// Crown glass, 300 to 2500 nm. Source: Schott catalogue 2017, N-BK7.
    pub const BK7: Self = Self::Sellmeier {
        b: [1.039_612_12, 0.231_792_344, 1.010_469_45, 0.0, 0.0, 0.0],
        c: [0.006_000_698_67, 0.020_017_914_4, 103.560_653, 0.0, 0.0, 0.0],
        range_nm: (300.0, 2500.0),
    };
    /// Dense flint glass, 370 to 2500 nm. Source: Schott catalogue 2017, N-SF11.
    pub const SF11: Self = Self::Sellmeier {
        b: [1.737_596_95, 0.313_747_346, 1.898_781_01, 0.0, 0.0, 0.0],
        c: [0.013_188_707, 0.062_306_814_2, 155.236_29, 0.0, 0.0, 0.0],
        range_nm: (370.0, 2500.0),
    };
    /// Fused silica at 20 °C, 210 to 3710 nm. Source: Malitson, J. Opt. Soc. Am. 55, 1205 (1965).
    pub const FUSED_SILICA: Self = Self::Sellmeier {
        b: [0.696_166_3, 0.407_942_6, 0.897_479_4, 0.0, 0.0, 0.0],
        c: [0.068_404_3 * 0.068_404_3, 0.116_241_4 * 0.116_241_4, 9.896_161 * 9.896_161, 0.0, 0.0, 0.0],
        range_nm: (210.0, 3710.0),
    };
    /// Diamond, 226 to 760 nm (measured to 644 nm). Source: Peter, Z. Phys. 15, 358 (1923).
    pub const DIAMOND: Self = Self::Sellmeier {
        b: [0.3306, 4.3356, 0.0, 0.0, 0.0, 0.0],
        c: [0.1750 * 0.1750, 0.1060 * 0.1060, 0.0, 0.0, 0.0, 0.0],
        range_nm: (226.0, 760.0),
    };
    /// Distilled water at 20 °C, 182 to 1129 nm. Source: Daimon and Masumura, Appl. Opt. 46, 3811 (2007).
    pub const WATER: Self = Self::Sellmeier {
        b: [0.568_402_756_5, 0.172_617_739_1, 0.020_861_895_78, 0.113_074_868_8, 0.0, 0.0],
        c: [0.005_101_829_712, 0.018_211_539_36, 0.026_207_222_93, 10.697_927_21, 0.0, 0.0],
        range_nm: (182.0, 1129.0),
    };

    /// A published one by its name ([`Index::NAMES`]).
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "BK7" => Some(Self::BK7),
            "SF11" => Some(Self::SF11),
            "fused_silica" => Some(Self::FUSED_SILICA),
            "diamond" => Some(Self::DIAMOND),
            "water" => Some(Self::WATER),
            _ => None,
        }
    }

    /// `n = a + b/λ² + c/λ⁴` with λ in micrometres, from 300 to 2500 nm.
    ///
    /// None if a number is not finite or if the index is below 1 at a visible wavelength.
    pub fn cauchy(a: f64, b: f64, c: f64) -> Option<Self> {
        let index = Self::Cauchy { a, b, c, range_nm: USUAL_RANGE_NM };
        is_sound(|nm| cauchy(a, b, c, nm).0).then_some(index)
    }

    /// `n² = 1 + Σ b λ²/(λ² - c)`, with λ in micrometres and c in µm², from 300 to 2500 nm but no nearer to
    /// a resonance than a tenth of its wavelength.
    ///
    /// None if a number is not finite, a `c` is negative, a resonance lies among the visible wavelengths, or the index is
    /// below 1 at one of those.
    pub fn sellmeier(terms: &[[f64; 2]]) -> Option<Self> {
        if terms.len() > TERMS {
            return None;
        }
        let term = |part: usize| std::array::from_fn(|i| terms.get(i).map_or(0.0, |term| term[part]));
        let (b, c): ([f64; TERMS], [f64; TERMS]) = (term(0), term(1));
        let mut range_nm = USUAL_RANGE_NM;
        for (strength, square) in b.into_iter().zip(c) {
            let resonance_nm = 1000.0 * square.sqrt();
            if strength != 0.0 && resonance_nm < VISIBLE_NM.1 {
                range_nm.0 = range_nm.0.max(1.1 * resonance_nm);
            } else if strength != 0.0 {
                range_nm.1 = range_nm.1.min(0.9 * resonance_nm);
            }
        }
        let sound = range_nm.0 <= VISIBLE_NM.0 && range_nm.1 >= VISIBLE_NM.1 && c.iter().all(|c| *c >= 0.0);
        let index = Self::Sellmeier { b, c, range_nm };
        (sound && is_sound(|nm| sellmeier(&b, &c, nm).0)).then_some(index)
    }

    /// glTF's `KHR_materials_dispersion`: the index at the d line (587.56 nm), and 20 over the Abbe number.
    ///
    /// `n = max(n_d + (n_d - 1)/V (523655 nm²/λ² - 1.5168), 1)` with V = 20/dispersion: Cauchy's formula.
    /// It is followed from 300 to 2500 nm.
    pub fn from_dispersion(n_d: f64, dispersion: f64) -> Self {
        if !(dispersion > 0.0 && dispersion.is_finite() && n_d > 1.0) {
            return Self::Constant(n_d);
        }
        let slope = (n_d - 1.0) * dispersion / 20.0;
        Self::Cauchy { a: n_d - 1.5168 * slope, b: 0.523_655 * slope, c: 0.0, range_nm: USUAL_RANGE_NM }
    }

    /// The phase index at a wavelength in vacuum, nm.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        self.at_each(&[wavelength_nm])[0]
    }

    /// The group index `n - λ dn/dλ` at a wavelength in vacuum, nm: light takes `n_g` times as long as in vacuum.
    pub fn group(&self, wavelength_nm: f64) -> f64 {
        self.group_each(&[wavelength_nm])[0]
    }

    /// The phase index at many wavelengths at once.
    #[inline]
    pub fn at_each<const N: usize>(&self, wavelengths_nm: &[f64; N]) -> [f64; N] {
        self.each(wavelengths_nm, |n, _| n)
    }

    /// The group index at many wavelengths at once.
    #[inline]
    pub fn group_each<const N: usize>(&self, wavelengths_nm: &[f64; N]) -> [f64; N] {
        self.each(wavelengths_nm, |_, group| group)
    }

    /// Whether the index differs between wavelengths.
    pub fn disperses(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Cauchy { b, c, .. } => *b != 0.0 || *c != 0.0,
            Self::Sellmeier { b, c, .. } => b.iter().zip(c).any(|(b, c)| b * c != 0.0),
        }
    }

    /// Where the formula is followed, nm; none if there is no formula.
    pub fn range_nm(&self) -> Option<(f64, f64)> {
        match self {
            Self::Constant(_) => None,
            Self::Cauchy { range_nm, .. } | Self::Sellmeier { range_nm, .. } => Some(*range_nm),
        }
    }

    /// One of index and group index for each wavelength: a loop for each kind, so that it runs in vectors.
    #[inline]
    fn each<const N: usize>(&self, wavelengths_nm: &[f64; N], which: impl Fn(f64, f64) -> f64) -> [f64; N] {
        let mut values = *wavelengths_nm;
        match self {
            Self::Constant(n) => values.fill(bounded(*n, 0.0, which)),
            Self::Cauchy { a, b, c, range_nm } => {
                for value in &mut values {
                    *value = held(*value, *range_nm, |nm| cauchy(*a, *b, *c, nm), &which);
                }
            }
            Self::Sellmeier { b, c, range_nm } => {
                for value in &mut values {
                    *value = held(*value, *range_nm, |nm| sellmeier(b, c, nm), &which);
                }
            }
        }
        values
    }
}

/// Whether a formula gives an index that a body can have, all over the visible wavelengths.
fn is_sound(formula: impl Fn(f64) -> f64) -> bool {
    let step = (VISIBLE_NM.1 - VISIBLE_NM.0) / 100.0;
    (0..=100).all(|i| (1.0..HIGHEST).contains(&formula(VISIBLE_NM.0 + step * f64::from(i))))
}

/// A formula within its range, its end value beyond.
#[inline]
fn held(
    nm: f64,
    range_nm: (f64, f64),
    formula: impl Fn(f64) -> (f64, f64),
    which: impl Fn(f64, f64) -> f64,
) -> f64 {
    let inside = nm.max(range_nm.0).min(range_nm.1);
    let (n, lag) = formula(inside);
    bounded(n, if inside == nm { lag } else { 0.0 }, which)
}

/// Index and group index from `n` and `-λ dn/dλ`, neither of them below 1.
#[inline]
fn bounded(n: f64, lag: f64, which: impl Fn(f64, f64) -> f64) -> f64 {
    // Also for a square root of less than nothing.
    let possible = if n >= 1.0 { n.min(HIGHEST) } else { 1.0 };
    let group = if possible == n { (n + lag).max(1.0) } else { possible };
    which(possible, group)
}

/// `n` and `-λ dn/dλ`.
#[inline]
fn cauchy(a: f64, b: f64, c: f64, nm: f64) -> (f64, f64) {
    let inverse = 1e6 / (nm * nm);
    (a + inverse * (b + inverse * c), inverse * (2.0 * b + 4.0 * c * inverse))
}

/// `n` and `-λ dn/dλ`, which is `Σ b c λ²/(λ² - c)² / n`.
#[inline]
fn sellmeier(b: &[f64; TERMS], c: &[f64; TERMS], nm: f64) -> (f64, f64) {
    let square = nm * nm * 1e-6;
    let (mut n2, mut lag) = (1.0, 0.0);
    for (b, c) in b.iter().zip(c) {
        let inverse = 1.0 / (square - c);
        n2 += b * square * inverse;
        lag += b * c * square * inverse * inverse;
    }
    let n = n2.sqrt();
    (n, lag / n)
}
