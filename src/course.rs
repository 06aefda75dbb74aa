//! Courses in a body's own time: what blinks, and what is keyed.

/// A factor that changes with the proper time of what it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Always 1.
    Steady,
    /// 1 for the first part of every period, 0 for the rest.
    Blinking {
        /// Metres of light travel, above zero.
        period: f64,
        /// The part of the period that it is 1 for.
        lit: f64,
        /// When a period begins.
        start: f64,
        /// 0 and 1 changed for one another.
        inverted: bool,
    },
    /// Linear between these (time, factor), times rising; held at the ends.
    Keyed(Vec<(f64, f64)>),
}

impl Course {
    /// This many times as much, if it is keyed.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        match self {
            Self::Keyed(keys) => {
                Self::Keyed(keys.into_iter().map(|(t, value)| (t, value * factor)).collect())
            }
            other => other,
        }
    }

    /// The factor at a proper time, metres.
    pub fn at(&self, tau: f64) -> f64 {
        match self {
            Self::Steady => 1.0,
            Self::Blinking { period, lit, start, inverted } => {
                let phase = (tau - start) / period;
                let on = phase - phase.floor() < *lit;
                f64::from(u8::from(on != *inverted))
            }
            Self::Keyed(keys) => keyed(keys, tau),
        }
    }
}

fn keyed(keys: &[(f64, f64)], tau: f64) -> f64 {
    let after = keys.partition_point(|(t, _)| *t <= tau);
    match (after.checked_sub(1).and_then(|before| keys.get(before)), keys.get(after)) {
        (Some((t0, a)), Some((t1, b))) => a + (b - a) * ((tau - t0) / (t1 - t0)),
        (Some((_, only)), None) | (None, Some((_, only))) => *only,
        (None, None) => 1.0,
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the numbers are binary fractions, and exact")]
mod tests {
    use super::*;

    #[test]
    fn blinking_course_is_lit_for_the_first_part_of_each_period_before_zero_too() {
        let course = Course::Blinking { period: 2.0, lit: 0.25, start: 0.5, inverted: false };
        let at = |tau| course.at(tau);
        assert_eq!(
            [0.25, 0.5, 0.75, 1.0, 2.5, 2.75, -1.5, -1.25, -1.0].map(at),
            [0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0]
        );
        let other = Course::Blinking { period: 2.0, lit: 0.25, start: 0.5, inverted: true };
        assert_eq!([0.25, 0.5, 1.0].map(|tau| other.at(tau)), [1.0, 0.0, 1.0]);
    }

    #[test]
    fn keyed_course_is_linear_between_its_keys_and_held_at_its_ends() {
        let course = Course::Keyed(vec![(-1.0, 0.5), (1.0, 2.5), (2.0, 0.0)]);
        assert_eq!(
            [-9.0, -1.0, 0.0, 1.0, 1.5, 2.0, 7.0].map(|tau| course.at(tau)),
            [0.5, 0.5, 1.5, 2.5, 1.25, 0.0, 0.0]
        );
    }
}
