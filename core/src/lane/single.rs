//! The single lane, `f64`, and the bits of numbers that all paths work on alike.

use super::Lane;

/// Bits of x^(-1/3): MAGIC - bits / 3, with the magic number of the smallest largest error. A third of the upper 32 bits
/// is enough for a guess, and is one 32-bit product in a vector register.
pub(super) const CUBE_ROOT_MAGIC: u64 = 0x553e_f0ff_289d_d796;

/// Bits of sqrt(1/2), rounded down: where the mantissa of [`Lane::split`] begins. Bits minus these, plus 1024 in the
/// exponent so that they stay positive, have k + 1024 above the fraction.
const HALF_ROOT: u64 = 0x3fe6_a09e_667f_3bcc;
pub(super) const SPLIT_OFFSET: u64 = (1024 << 52) - HALF_ROOT;
/// 2^52 and its bits: a whole number k in the fraction is 2^52 + k.
pub(super) const TWO_52: f64 = 4_503_599_627_370_496.0;
/// Added to k, it leaves k + 1023 in the lowest bits: 1.5 2^52 + 1023.
pub(super) const POWER_MAGIC: f64 = 6_755_399_441_055_744.0 + 1023.0;

impl Lane for f64 {
    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }
    // Never f64::mul_add: without the feature it calls libm, 25 times slower.
    #[inline(always)]
    fn mul_add(self, b: f64, c: f64) -> f64 {
        self * b + c
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> f64 {
        f64::from_bits(CUBE_ROOT_MAGIC.wrapping_sub(((self.to_bits() >> 32) / 3) << 32))
    }
    #[inline(always)]
    fn split(self) -> (f64, f64) {
        let power = self.to_bits().wrapping_add(SPLIT_OFFSET) >> 52;
        let mantissa = self.to_bits().wrapping_sub(power.wrapping_sub(1024) << 52);
        (f64::from_bits(mantissa), f64::from_bits(power | TWO_52.to_bits()) - (TWO_52 + 1024.0))
    }
    #[inline(always)]
    fn power_of_two(self) -> f64 {
        f64::from_bits((self + POWER_MAGIC).to_bits() << 52)
    }
    #[inline(always)]
    fn where_positive(self, yes: f64, no: f64) -> f64 {
        if self > 0.0 { yes } else { no }
    }
}
