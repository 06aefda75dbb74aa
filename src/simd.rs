//! Several numbers at once, by the best instruction set that the processor has.
//!
//! Sums and products are plain loops that the compiler turns into vector instructions, once for each set ([`with_best`]). What
//! comes of comparisons it gathers badly, one bit at a time, so that is said for each set ([`Lanes`]). All sets give the same
//! bits: nothing here rounds, and no product is ever fused with a sum.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

/// The whole number below a place, and how far beyond it, for places from 0 to 2³²: at a whole number it may be the end of the one
/// below. (No conversion to an integer, so that many places are found at once.)
#[inline(always)]
pub(crate) fn whole_and_part(place: f64) -> (usize, f64) {
    // From here on numbers are whole.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let whole = (place - 0.5).max(0.0) + WHOLE;
    (whole.to_bits() as u32 as usize, place - (whole - WHOLE))
}

/// An instruction set.
pub(crate) trait Lanes: Copy {
    /// Bit i is set where `a[i] <= b[i]`.
    fn at_most_8(self, a: [f32; 8], b: [f32; 8]) -> u32;

    /// Bit i is set where `a[i] <= b[i]`.
    fn at_most_4(self, a: [f64; 4], b: [f64; 4]) -> u32;
}

/// What every processor of the kind has.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plain;

impl Lanes for Plain {
    #[inline(always)]
    fn at_most_8(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        (0..8).fold(0, |bits, lane| bits | u32::from(a[lane] <= b[lane]) << lane)
    }

    #[inline(always)]
    fn at_most_4(self, a: [f64; 4], b: [f64; 4]) -> u32 {
        (0..4).fold(0, |bits, lane| bits | u32::from(a[lane] <= b[lane]) << lane)
    }
}

#[cfg(target_arch = "x86_64")]
mod avx {
    use super::Lanes;
    use pulp::x86::V3;
    use std::arch::x86_64::{__m256, __m256d, _CMP_LE_OQ};

    impl Lanes for V3 {
        #[inline(always)]
        fn at_most_8(self, a: [f32; 8], b: [f32; 8]) -> u32 {
            let (a, b): (__m256, __m256) = (pulp::cast(a), pulp::cast(b));
            self.avx._mm256_movemask_ps(self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32
        }

        #[inline(always)]
        fn at_most_4(self, a: [f64; 4], b: [f64; 4]) -> u32 {
            let (a, b): (__m256d, __m256d) = (pulp::cast(a), pulp::cast(b));
            self.avx._mm256_movemask_pd(self.avx._mm256_cmp_pd::<_CMP_LE_OQ>(a, b)) as u32
        }
    }
}

/// What can be done with any instruction set.
pub(crate) trait Task {
    /// What comes of it.
    type Output;

    /// Does it. Must be inlined, with all that it calls: what is not is compiled for the plain set.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Does something with the best instruction set that this processor has.
#[inline(always)]
pub(crate) fn with_best<T: Task>(task: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        struct On<T>(pulp::x86::V3, T);
        impl<T: Task> pulp::NullaryFnOnce for On<T> {
            type Output = T::Output;

            #[inline(always)]
            fn call(self) -> T::Output {
                self.1.run(self.0)
            }
        }
        return v3.vectorize(On(v3, task));
    }
    task.run(Plain)
}
