//! Sums that do not depend on the order of their terms: exact until one rounding at the end. Totals over the body are summed so:
//! their bits do not tell how its cells are ordered or divided.

/// Limbs of 32 bits from 2^-1074, the smallest number, to beyond the largest: ceil(2098 / 32), and one for carries.
const LIMBS: usize = 67;

/// Terms between two carries: each adds less than 2^32 to a limb of 63 bits.
const TERMS: u32 = 1 << 30;

/// An exact sum: an integer in units of 2^-1074, its limb k in units of 2^(32 k).
#[derive(Debug, Clone)]
pub struct ExactSum {
    limbs: [i64; LIMBS],
    terms: u32,
    /// The plain sum of the terms that are not finite.
    odd: f64,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self { limbs: [0; LIMBS], terms: 0, odd: 0.0 }
    }
}

impl ExactSum {
    /// Adds a term.
    pub fn add(&mut self, x: f64) {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as usize;
        if exponent == 0x7ff {
            self.odd += x;
            return;
        }
        let mantissa = bits & ((1 << 52) - 1) | u64::from(exponent > 0) << 52;
        let shift = exponent.max(1) - 1;
        let wide = u128::from(mantissa) << (shift % 32);
        let sign = if x.is_sign_negative() { -1 } else { 1 };
        let limbs = &mut self.limbs[shift / 32..][..3];
        for (k, limb) in limbs.iter_mut().enumerate() {
            *limb += sign * i64::from((wide >> (32 * k)) as u32);
        }
        self.terms += 1;
        if self.terms == TERMS {
            self.carry();
        }
    }

    /// Numbers of [`ExactSum::write`].
    pub const NUMBERS: usize = LIMBS + 1;

    /// Writes it as numbers that hold it exactly: its limbs, carried, and the plain sum of the terms that are not finite.
    pub fn write(&self, to: &mut [f64]) {
        let mut own = self.clone();
        own.carry();
        // Whole numbers up to 2^32, and the last of them small.
        to.iter_mut().zip(own.limbs).for_each(|(to, limb)| *to = limb as f64);
        to[LIMBS] = self.odd;
    }

    /// Adds a sum that was written.
    pub fn add_written(&mut self, from: &[f64]) {
        self.carry();
        self.limbs.iter_mut().zip(from).for_each(|(limb, from)| *limb += *from as i64);
        self.odd += from[LIMBS];
        self.carry();
    }

    /// As it was before its first term.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Brings each limb but the last into 0 .. 2^32.
    fn carry(&mut self) {
        for k in 0..LIMBS - 1 {
            self.limbs[k + 1] += self.limbs[k] >> 32;
            self.limbs[k] &= 0xffff_ffff;
        }
        self.terms = 1;
    }

    /// The nearest number, the even one of two; infinite or NaN where a plain sum of the infinite terms is.
    pub fn value(&self) -> f64 {
        if self.odd != 0.0 {
            return self.odd;
        }
        let mut all = self.clone();
        all.carry();
        let negative = all.limbs[LIMBS - 1] < 0;
        if negative {
            all.limbs.iter_mut().for_each(|limb| *limb = -*limb);
            all.carry();
        }
        let size = rounded(&all.limbs);
        if negative { -size } else { size }
    }
}

/// The number nearest to limbs that are carried and not negative.
fn rounded(limbs: &[i64; LIMBS]) -> f64 {
    let Some(top) = limbs.iter().rposition(|limb| *limb != 0) else { return 0.0 };
    let limb = |back: usize| top.checked_sub(back).map_or(0, |k| limbs[k] as u64);
    let last = 32 * top + 63 - limb(0).leading_zeros() as usize;
    if last <= 52 {
        // Numbers below 2^-1021 are written as such a count.
        return f64::from_bits(limb(0) << (32 * top) | if top == 1 { limb(1) } else { 0 });
    }
    let wide = u128::from(limb(0)) << 64 | u128::from(limb(1) << 32 | limb(2));
    let cut = 128 - wide.leading_zeros() - 53;
    let (mantissa, rest, half) = ((wide >> cut) as u64, wide & ((1 << cut) - 1), 1_u128 << (cut - 1));
    let more = limbs[..top.saturating_sub(2)].iter().any(|limb| *limb != 0);
    let up = rest > half || rest == half && (more || mantissa % 2 == 1);
    let exponent = (last - 51) as u64;
    if exponent >= 0x7ff {
        return f64::INFINITY;
    }
    // Where the mantissa overflows, the carry makes the exponent larger, up to the infinite one.
    f64::from_bits((exponent << 52) + (mantissa - (1 << 52)) + u64::from(up))
}

/// The exact sum of numbers, rounded once.
pub fn exact_sum(terms: impl IntoIterator<Item = f64>) -> f64 {
    let mut sum = ExactSum::default();
    terms.into_iter().for_each(|x| sum.add(x));
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Numbers that are whole multiples of 2^-40 below 2^60 are summed by integers, which Rust rounds to the nearest.
        #[test]
        fn a_sum_is_that_of_integers_rounded_once(terms in prop::collection::vec((-(1_i64 << 53)..1 << 53, 0_u32..47), 0..40)) {
            let whole: i128 = terms.iter().map(|(m, e)| i128::from(*m) << e).sum();
            let numbers = terms.iter().map(|(m, e)| *m as f64 * f64::from(*e).exp2() * (-40_f64).exp2());
            prop_assert_eq!(exact_sum(numbers).to_bits(), ((whole as f64) * (-40_f64).exp2() + 0.0).to_bits());
        }

        #[test]
        fn the_order_of_any_finite_terms_changes_no_bit(
            terms in prop::collection::vec(any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite()), 0..60),
            seed in any::<u64>(),
        ) {
            let mut other = terms.clone();
            other.sort_by_key(|x| x.to_bits().wrapping_mul(seed | 1));
            prop_assert_eq!(exact_sum(terms).to_bits(), exact_sum(other).to_bits());
        }

        #[test]
        fn sums_of_parts_that_were_written_make_the_sum_of_all(
            parts in prop::collection::vec(prop::collection::vec(any::<u64>().prop_map(f64::from_bits), 0..9), 1..5),
        ) {
            let mut all = ExactSum::default();
            for part in &parts {
                let (mut own, mut numbers) = (ExactSum::default(), [0.0; ExactSum::NUMBERS]);
                part.iter().for_each(|x| own.add(*x));
                own.write(&mut numbers);
                all.add_written(&numbers);
            }
            let (all, once) = (all.value(), exact_sum(parts.concat()));
            prop_assert!(all.to_bits() == once.to_bits() || all.is_nan() && once.is_nan());
        }

        #[test]
        fn one_term_is_its_own_sum(x in any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite())) {
            prop_assert_eq!(exact_sum([x]).to_bits(), (x + 0.0).to_bits());
            prop_assert_eq!(exact_sum([x, -x]).to_bits(), 0);
        }
    }

    #[test]
    fn large_terms_that_cancel_leave_the_small_ones() {
        assert_eq!(exact_sum([1e308, 1.0, -1e308]), 1.0);
        assert_eq!(exact_sum([f64::MAX, f64::MAX, -f64::MAX]), f64::MAX);
        assert_eq!(exact_sum([f64::MIN_POSITIVE, -5e-324]), f64::MIN_POSITIVE - 5e-324);
        // Half a unit in the last place of 1 goes to the even neighbour, and up once anything is beyond it.
        let half = f64::EPSILON / 2.0;
        assert_eq!(exact_sum([1.0, half]), 1.0);
        assert_eq!(exact_sum([1.0, half, 5e-324]), 1.0 + f64::EPSILON);
    }

    #[test]
    fn terms_that_are_not_finite_are_summed_as_usual() {
        assert_eq!(exact_sum([f64::MAX, f64::MAX]), f64::INFINITY);
        assert_eq!(exact_sum([1.0, f64::NEG_INFINITY]), f64::NEG_INFINITY);
        assert!(exact_sum([f64::INFINITY, f64::NEG_INFINITY]).is_nan() && exact_sum([f64::NAN, 1.0]).is_nan());
    }
}
