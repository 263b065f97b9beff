//! Eight lanes that every processor has: four pairs of numbers, as the baselines of x86_64 (SSE2) and aarch64 have them.

use super::{F8, LANES, Lane, Lanes};
use pair::Pair;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Eight lanes in four pairs.
///
/// Pairs are vectors of the compiler: kernels written out number by number, eight of them, take it several times as long
/// to compile.
///
/// Operations are calls on x86_64 without the feature `kernel-portable`, and in unit tests. Inlined, they took 38 % of the time of LLVM, more
/// than any other path, and a processor with AVX2 never takes this path. As calls they are five times slower.
#[derive(Debug, Clone, Copy)]
pub struct Portable([Pair; 4]);

/// An operation: inlined, or a call, see [`Portable`].
macro_rules! operation {
    ($($item:tt)*) => {
        #[cfg_attr(any(feature = "kernel-portable", not(any(test, target_arch = "x86_64"))), inline(always))]
        #[cfg_attr(all(not(feature = "kernel-portable"), any(test, target_arch = "x86_64")), inline(never))]
        $($item)*
    };
}

/// What is done pair by pair.
macro_rules! by_pair {
    ($($body:tt)*) => {{
        let of = $($body)*;
        Portable([of(0), of(1), of(2), of(3)])
    }};
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Portable {
            type Output = Portable;
            operation! {
                fn $method(self, other: Portable) -> Portable {
                    by_pair!(|i: usize| $trait::$method(self.0[i], other.0[i]))
                }
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Portable {
    type Output = Portable;
    operation! {
        fn neg(self) -> Portable {
            by_pair!(|i: usize| -self.0[i])
        }
    }
}

impl Lane for Portable {
    #[inline(always)]
    fn splat(x: f64) -> Portable {
        Portable([Pair::new([x, x]); 4])
    }
    // Never fused: without the instruction it would be a call of libm, 25 times slower.
    operation! {
        fn mul_add(self, b: Portable, c: Portable) -> Portable {
            self * b + c
        }
    }
    operation! {
        fn sqrt(self) -> Portable {
            by_pair!(|i: usize| self.0[i].sqrt())
        }
    }
    operation! {
        fn min(self, other: Portable) -> Portable {
            by_pair!(|i: usize| self.0[i].min(other.0[i]))
        }
    }
    operation! {
        fn max(self, other: Portable) -> Portable {
            by_pair!(|i: usize| self.0[i].max(other.0[i]))
        }
    }
    operation! {
        fn inverse_cube_root_guess(self) -> Portable {
            by_pair!(|i: usize| self.0[i].each(Lane::inverse_cube_root_guess))
        }
    }
    operation! {
        fn split(self) -> (Portable, Portable) {
            let of = |i: usize| self.0[i].split();
            let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
            (Portable([a.0, b.0, c.0, d.0]), Portable([a.1, b.1, c.1, d.1]))
        }
    }
    operation! {
        fn power_of_two(self) -> Portable {
            by_pair!(|i: usize| self.0[i].each(Lane::power_of_two))
        }
    }
    operation! {
        fn where_positive(self, yes: Portable, no: Portable) -> Portable {
            by_pair!(|i: usize| self.0[i].where_positive(yes.0[i], no.0[i]))
        }
    }
}

impl Lanes for Portable {
    operation! {
        fn load(from: &F8) -> Portable {
            by_pair!(|i: usize| Pair::new([from.0[2 * i], from.0[2 * i + 1]]))
        }
    }
    operation! {
        fn store(self, to: &mut F8) {
            for i in 0..4 {
                [to.0[2 * i], to.0[2 * i + 1]] = self.0[i].numbers();
            }
        }
    }
    operation! {
        fn from_lanes(numbers: [f64; LANES]) -> Portable {
            Self::load(&F8(numbers))
        }
    }
}

impl Pair {
    operation! {
        /// See [`Lane::split`].
        fn split(self) -> (Pair, Pair) {
            let [a, b] = self.numbers().map(Lane::split);
            (Pair::new([a.0, b.0]), Pair::new([a.1, b.1]))
        }
    }
    operation! {
        /// See [`Lane::where_positive`].
        fn where_positive(self, yes: Pair, no: Pair) -> Pair {
            let (x, yes, no) = (self.numbers(), yes.numbers(), no.numbers());
            Pair::new([x[0].where_positive(yes[0], no[0]), x[1].where_positive(yes[1], no[1])])
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod pair {
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// Two numbers in a register of SSE2, which every x86_64 has: its intrinsics are always sound.
    #[derive(Debug, Clone, Copy)]
    pub struct Pair(__m128d);

    macro_rules! operator {
        ($trait:ident, $method:ident, $intrinsic:ident) => {
            impl $trait for Pair {
                type Output = Pair;
                #[inline(always)]
                fn $method(self, other: Pair) -> Pair {
                    // SAFETY: see Pair.
                    Pair(unsafe { $intrinsic(self.0, other.0) })
                }
            }
        };
    }
    operator!(Add, add, _mm_add_pd);
    operator!(Sub, sub, _mm_sub_pd);
    operator!(Mul, mul, _mm_mul_pd);
    operator!(Div, div, _mm_div_pd);

    impl Neg for Pair {
        type Output = Pair;
        #[inline(always)]
        fn neg(self) -> Pair {
            // SAFETY: see Pair.
            Pair(unsafe { _mm_xor_pd(self.0, _mm_set1_pd(-0.0)) })
        }
    }

    impl Pair {
        #[inline(always)]
        pub fn new(x: [f64; 2]) -> Pair {
            // SAFETY: see Pair.
            Pair(unsafe { _mm_set_pd(x[1], x[0]) })
        }
        #[inline(always)]
        pub fn numbers(self) -> [f64; 2] {
            // SAFETY: see Pair.
            unsafe { [_mm_cvtsd_f64(self.0), _mm_cvtsd_f64(_mm_unpackhi_pd(self.0, self.0))] }
        }
        #[inline(always)]
        pub fn sqrt(self) -> Pair {
            // SAFETY: see Pair.
            Pair(unsafe { _mm_sqrt_pd(self.0) })
        }
        /// As `f64 as Lane`: minpd and maxpd return their second operand where either is NaN.
        #[inline(always)]
        pub fn min(self, other: Pair) -> Pair {
            // SAFETY: see Pair.
            Pair(unsafe { _mm_min_pd(self.0, other.0) })
        }
        #[inline(always)]
        pub fn max(self, other: Pair) -> Pair {
            // SAFETY: see Pair.
            Pair(unsafe { _mm_max_pd(self.0, other.0) })
        }
        /// Number by number.
        #[inline(always)]
        pub fn each(self, of: impl Fn(f64) -> f64) -> Pair {
            Pair::new(self.numbers().map(of))
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod pair {
    use super::Lane;
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// Two numbers.
    #[derive(Debug, Clone, Copy)]
    pub struct Pair([f64; 2]);

    macro_rules! operator {
        ($trait:ident, $method:ident) => {
            impl $trait for Pair {
                type Output = Pair;
                #[inline(always)]
                fn $method(self, other: Pair) -> Pair {
                    Pair([$trait::$method(self.0[0], other.0[0]), $trait::$method(self.0[1], other.0[1])])
                }
            }
        };
    }
    operator!(Add, add);
    operator!(Sub, sub);
    operator!(Mul, mul);
    operator!(Div, div);

    impl Neg for Pair {
        type Output = Pair;
        #[inline(always)]
        fn neg(self) -> Pair {
            Pair([-self.0[0], -self.0[1]])
        }
    }

    impl Pair {
        #[inline(always)]
        pub fn new(x: [f64; 2]) -> Pair {
            Pair(x)
        }
        #[inline(always)]
        pub fn numbers(self) -> [f64; 2] {
            self.0
        }
        #[inline(always)]
        pub fn sqrt(self) -> Pair {
            self.each(f64::sqrt)
        }
        #[inline(always)]
        pub fn min(self, other: Pair) -> Pair {
            Pair([Lane::min(self.0[0], other.0[0]), Lane::min(self.0[1], other.0[1])])
        }
        #[inline(always)]
        pub fn max(self, other: Pair) -> Pair {
            Pair([Lane::max(self.0[0], other.0[0]), Lane::max(self.0[1], other.0[1])])
        }
        /// Number by number.
        #[inline(always)]
        pub fn each(self, of: impl Fn(f64) -> f64) -> Pair {
            Pair(self.0.map(of))
        }
    }
}
