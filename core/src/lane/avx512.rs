//! Eight lanes in one register of AVX-512.

use super::single::{CUBE_ROOT_MAGIC, POWER_MAGIC, SPLIT_OFFSET, TWO_52};
use super::{F8, InPlace, LANES, Lane, Lanes, Work, as_f64, assert_within};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Eight lanes in one AVX-512 register. Values exist only inside `enter_avx512`, which is entered only where the
/// processor has AVX-512F: this is what makes each intrinsic below sound.
#[derive(Debug, Clone, Copy)]
pub struct Avx512(__m512d);

macro_rules! binary {
    ($trait:ident, $method:ident, $intrinsic:ident) => {
        impl $trait for Avx512 {
            type Output = Avx512;
            #[inline(always)]
            fn $method(self, b: Avx512) -> Avx512 {
                // SAFETY: see Avx512.
                unsafe { Avx512($intrinsic(self.0, b.0)) }
            }
        }
    };
}
binary!(Add, add, _mm512_add_pd);
binary!(Sub, sub, _mm512_sub_pd);
binary!(Mul, mul, _mm512_mul_pd);
binary!(Div, div, _mm512_div_pd);

impl Neg for Avx512 {
    type Output = Avx512;
    #[inline(always)]
    fn neg(self) -> Avx512 {
        // SAFETY: see Avx512. As whole numbers: the operation on doubles is not in AVX-512F.
        unsafe {
            let sign = _mm512_set1_epi64(i64::MIN);
            Avx512(_mm512_castsi512_pd(_mm512_xor_si512(_mm512_castpd_si512(self.0), sign)))
        }
    }
}

impl Lane for Avx512 {
    #[inline(always)]
    fn splat(x: f64) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe { Avx512(_mm512_set1_pd(x)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Avx512, c: Avx512) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe { Avx512(_mm512_fmadd_pd(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe { Avx512(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn min(self, b: Avx512) -> Avx512 {
        // SAFETY: see Avx512. minpd returns its second operand where either is NaN.
        unsafe { Avx512(_mm512_min_pd(self.0, b.0)) }
    }
    #[inline(always)]
    fn max(self, b: Avx512) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe { Avx512(_mm512_max_pd(self.0, b.0)) }
    }
    /// n / 3 of 32 bits is (n * 0xaaaaaaab) >> 33, exactly.
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe {
            let upper = _mm512_srli_epi64::<32>(_mm512_castpd_si512(self.0));
            let third = _mm512_srli_epi64::<33>(_mm512_mul_epu32(upper, _mm512_set1_epi64(0xaaaa_aaab)));
            let magic = _mm512_set1_epi64(CUBE_ROOT_MAGIC as i64);
            Avx512(_mm512_castsi512_pd(_mm512_sub_epi64(magic, _mm512_slli_epi64::<32>(third))))
        }
    }
    /// Operation by operation as for `f64`.
    #[inline(always)]
    fn split(self) -> (Avx512, Avx512) {
        // SAFETY: see Avx512.
        unsafe {
            let bits = _mm512_castpd_si512(self.0);
            let power = _mm512_srli_epi64::<52>(_mm512_add_epi64(bits, _mm512_set1_epi64(SPLIT_OFFSET as i64)));
            let shift = _mm512_slli_epi64::<52>(_mm512_sub_epi64(power, _mm512_set1_epi64(1024)));
            let number = _mm512_or_si512(power, _mm512_set1_epi64(TWO_52.to_bits() as i64));
            let k = _mm512_sub_pd(_mm512_castsi512_pd(number), _mm512_set1_pd(TWO_52 + 1024.0));
            (Avx512(_mm512_castsi512_pd(_mm512_sub_epi64(bits, shift))), Avx512(k))
        }
    }
    #[inline(always)]
    fn power_of_two(self) -> Avx512 {
        let sum = self + Avx512::splat(POWER_MAGIC);
        // SAFETY: see Avx512.
        unsafe { Avx512(_mm512_castsi512_pd(_mm512_slli_epi64::<52>(_mm512_castpd_si512(sum.0)))) }
    }
    #[inline(always)]
    fn where_positive(self, yes: Avx512, no: Avx512) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe {
            let positive = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, _mm512_setzero_pd());
            Avx512(_mm512_mask_blend_pd(positive, no.0, yes.0))
        }
    }
}

impl Lanes for Avx512 {
    #[inline(always)]
    fn load(from: &F8) -> Avx512 {
        // SAFETY: see Avx512; F8 is 64-byte aligned and holds 8 numbers.
        unsafe { Avx512(_mm512_load_pd(from.0.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut F8) {
        // SAFETY: as for load.
        unsafe { _mm512_store_pd(to.0.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn from_lanes(n: [f64; LANES]) -> Avx512 {
        // SAFETY: see Avx512.
        unsafe { Avx512(_mm512_loadu_pd(n.as_ptr())) }
    }
    const PICKS: bool = true;
    /// The processor looks at the lowest three bits of a place only.
    #[inline(always)]
    fn pick(self, number: &F8, from: &[u8; LANES], lanes: u8) -> Avx512 {
        // SAFETY: see Avx512; 8 bytes are read of 8, and as for load.
        unsafe {
            let from = _mm512_cvtepu8_epi64(_mm_loadl_epi64(from.as_ptr().cast()));
            Avx512(_mm512_mask_permutexvar_pd(self.0, lanes, from, _mm512_load_pd(number.0.as_ptr())))
        }
    }
    #[inline(always)]
    fn load_joined<const K: usize>(first: &[F8], second: &[F8], at: usize, r: usize) -> [Avx512; K] {
        assert_within::<K>(first, second, at, r);
        let (first, second) = (as_f64(first).as_ptr(), as_f64(second).as_ptr());
        let mut out = [Avx512::splat(0.0); K];
        let from_second: __mmask8 = 0xff << (LANES - r);
        // SAFETY: see Avx512. Of number k are read 8 (at + k) + r and 7 more of one, 8 (at + k) + r - 8 and 7 more of
        // the other: they lie within, since there is one number at least before and behind the K of both.
        unsafe {
            let (one, two) = (first.add(LANES * at + r), second.add(LANES * (at - 1) + r));
            for (k, out) in out.iter_mut().enumerate() {
                let (one, two) = (_mm512_loadu_pd(one.add(LANES * k)), _mm512_loadu_pd(two.add(LANES * k)));
                *out = Avx512(_mm512_mask_blend_pd(from_second, one, two));
            }
        }
        out
    }
}

#[target_feature(enable = "avx512f")]
pub(super) fn enter_avx512<W: Work>(work: InPlace<W>) -> W::Out {
    work.take().run::<Avx512>()
}
