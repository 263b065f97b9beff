//! Eight lanes in two registers of AVX2, with fused multiplication.

use super::single::{CUBE_ROOT_MAGIC, POWER_MAGIC, SPLIT_OFFSET, TWO_52};
use super::{F8, InPlace, LANES, Lane, Lanes, Work, as_f64, assert_within};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Eight lanes in two AVX2 registers. Values exist only inside `enter_avx2`, which is entered only where
/// the processor has AVX2 and FMA: this is what makes each intrinsic below sound.
#[derive(Debug, Clone, Copy)]
pub struct Avx2(__m256d, __m256d);

macro_rules! binary {
    ($trait:ident, $method:ident, $intrinsic:ident) => {
        impl $trait for Avx2 {
            type Output = Avx2;
            #[inline(always)]
            fn $method(self, b: Avx2) -> Avx2 {
                // SAFETY: see Avx2.
                unsafe { Avx2($intrinsic(self.0, b.0), $intrinsic(self.1, b.1)) }
            }
        }
    };
}
binary!(Add, add, _mm256_add_pd);
binary!(Sub, sub, _mm256_sub_pd);
binary!(Mul, mul, _mm256_mul_pd);
binary!(Div, div, _mm256_div_pd);

impl Neg for Avx2 {
    type Output = Avx2;
    #[inline(always)]
    fn neg(self) -> Avx2 {
        // SAFETY: see Avx2. Flipping the sign bit keeps -0 and NaN as `-x` of f64 does.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Avx2(_mm256_xor_pd(self.0, sign), _mm256_xor_pd(self.1, sign))
        }
    }
}

impl Lane for Avx2 {
    #[inline(always)]
    fn splat(x: f64) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe { Avx2(_mm256_set1_pd(x), _mm256_set1_pd(x)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Avx2, c: Avx2) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe { Avx2(_mm256_fmadd_pd(self.0, b.0, c.0), _mm256_fmadd_pd(self.1, b.1, c.1)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe { Avx2(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn min(self, b: Avx2) -> Avx2 {
        // SAFETY: see Avx2. minpd returns its second operand where either is NaN.
        unsafe { Avx2(_mm256_min_pd(self.0, b.0), _mm256_min_pd(self.1, b.1)) }
    }
    #[inline(always)]
    fn max(self, b: Avx2) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe { Avx2(_mm256_max_pd(self.0, b.0), _mm256_max_pd(self.1, b.1)) }
    }
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe { Avx2(guess(self.0), guess(self.1)) }
    }
    #[inline(always)]
    fn split(self) -> (Avx2, Avx2) {
        // SAFETY: see Avx2.
        let ((m0, k0), (m1, k1)) = unsafe { (split(self.0), split(self.1)) };
        (Avx2(m0, m1), Avx2(k0, k1))
    }
    #[inline(always)]
    fn power_of_two(self) -> Avx2 {
        let sum = self + Avx2::splat(POWER_MAGIC);
        // SAFETY: see Avx2.
        unsafe { Avx2(shifted(sum.0), shifted(sum.1)) }
    }
    #[inline(always)]
    fn where_positive(self, yes: Avx2, no: Avx2) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe {
            let zero = _mm256_setzero_pd();
            let (low, high) = (_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, zero), _mm256_cmp_pd::<_CMP_GT_OQ>(self.1, zero));
            Avx2(_mm256_blendv_pd(no.0, yes.0, low), _mm256_blendv_pd(no.1, yes.1, high))
        }
    }
}

/// [`Lane::split`] of four lanes, operation by operation as for `f64`.
#[inline(always)]
unsafe fn split(x: __m256d) -> (__m256d, __m256d) {
    // SAFETY: see Avx2.
    unsafe {
        let bits = _mm256_castpd_si256(x);
        let power = _mm256_srli_epi64::<52>(_mm256_add_epi64(bits, _mm256_set1_epi64x(SPLIT_OFFSET as i64)));
        let shift = _mm256_slli_epi64::<52>(_mm256_sub_epi64(power, _mm256_set1_epi64x(1024)));
        let number = _mm256_or_si256(power, _mm256_set1_epi64x(TWO_52.to_bits() as i64));
        let k = _mm256_sub_pd(_mm256_castsi256_pd(number), _mm256_set1_pd(TWO_52 + 1024.0));
        (_mm256_castsi256_pd(_mm256_sub_epi64(bits, shift)), k)
    }
}

/// The lowest bits in the place of the exponent.
#[inline(always)]
unsafe fn shifted(x: __m256d) -> __m256d {
    // SAFETY: see Avx2.
    unsafe { _mm256_castsi256_pd(_mm256_slli_epi64::<52>(_mm256_castpd_si256(x))) }
}

/// The guess of x^(-1/3) for four lanes: n / 3 of 32 bits is (n * 0xaaaaaaab) >> 33, exactly.
#[inline(always)]
unsafe fn guess(x: __m256d) -> __m256d {
    // SAFETY: see Avx2.
    unsafe {
        let upper = _mm256_srli_epi64::<32>(_mm256_castpd_si256(x));
        let third = _mm256_srli_epi64::<33>(_mm256_mul_epu32(upper, _mm256_set1_epi64x(0xaaaa_aaab)));
        let magic = _mm256_set1_epi64x(CUBE_ROOT_MAGIC as i64);
        _mm256_castsi256_pd(_mm256_sub_epi64(magic, _mm256_slli_epi64::<32>(third)))
    }
}

impl Lanes for Avx2 {
    #[inline(always)]
    fn load(from: &F8) -> Avx2 {
        // SAFETY: see Avx2; F8 is 64-byte aligned and holds 8 numbers.
        unsafe { Avx2(_mm256_load_pd(from.0.as_ptr()), _mm256_load_pd(from.0.as_ptr().add(4))) }
    }
    #[inline(always)]
    fn store(self, to: &mut F8) {
        // SAFETY: as for load.
        unsafe {
            _mm256_store_pd(to.0.as_mut_ptr(), self.0);
            _mm256_store_pd(to.0.as_mut_ptr().add(4), self.1);
        }
    }
    #[inline(always)]
    fn from_lanes(n: [f64; LANES]) -> Avx2 {
        // SAFETY: see Avx2.
        unsafe { Avx2(_mm256_setr_pd(n[0], n[1], n[2], n[3]), _mm256_setr_pd(n[4], n[5], n[6], n[7])) }
    }
    #[inline(always)]
    fn load_joined<const K: usize>(first: &[F8], second: &[F8], at: usize, r: usize) -> [Avx2; K] {
        assert_within::<K>(first, second, at, r);
        let (first, second) = (as_f64(first).as_ptr(), as_f64(second).as_ptr());
        let mut out = [Avx2::splat(0.0); K];
        // SAFETY: see Avx2. Of number k are read 8 (at + k) + r and 7 more of one, 8 (at + k) + r - 8 and 7 more of
        // the other: they lie within, since there is one number at least before and behind the K of both.
        unsafe {
            let masks = [_mm256_loadu_pd(SECOND.as_ptr().add(r)), _mm256_loadu_pd(SECOND.as_ptr().add(r + 4))];
            let (one, two) = (first.add(LANES * at + r), second.add(LANES * (at - 1) + r));
            for (k, out) in out.iter_mut().enumerate() {
                let (one, two) = (one.add(LANES * k), two.add(LANES * k));
                let low = _mm256_blendv_pd(_mm256_loadu_pd(one), _mm256_loadu_pd(two), masks[0]);
                let high = _mm256_blendv_pd(_mm256_loadu_pd(one.add(4)), _mm256_loadu_pd(two.add(4)), masks[1]);
                *out = Avx2(low, high);
            }
        }
        out
    }
}

/// The sign is set from number 8 on: where the second of two numbers is taken.
static SECOND: [f64; 16] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0];

#[target_feature(enable = "avx2,fma")]
pub(super) fn enter_avx2<W: Work>(work: InPlace<W>) -> W::Out {
    work.take().run::<Avx2>()
}
