//! Logarithm, exponential and atanh on lanes, without branches, from operations on the bits of each lane:
//! [`Lane::split`], [`Lane::power_of_two`], [`Lane::where_positive`].

use super::Lane;

/// ln 2 in two parts; k times the first is exact for |k| < 2^11.
const LN_2: [f64; 2] = [f64::from_bits(0x3fe6_2e42_fee0_0000), f64::from_bits(0x3dea_39ef_3579_3c76)];

/// Coefficients of R(z), log(1 + f) = 2 s + s R(s^2), s = f / (2 + f), z = s^2 <= 0.0295: the minimax polynomial of fdlibm's
/// `e_log.c`, error below 2^-58.
const LOG: [f64; 7] = [
    f64::from_bits(0x3fe5_5555_5555_5593),
    f64::from_bits(0x3fd9_9999_9997_fa04),
    f64::from_bits(0x3fd2_4924_9422_9359),
    f64::from_bits(0x3fcc_71c5_1d8e_78af),
    f64::from_bits(0x3fc7_4664_96cb_03de),
    f64::from_bits(0x3fc3_9a09_d078_c69f),
    f64::from_bits(0x3fc2_f112_df3e_5244),
];

/// R(z) of [`LOG`].
#[inline(always)]
fn log_series<L: Lane>(z: L) -> L {
    let mut sum = L::splat(LOG[6]);
    for k in 0..6 {
        sum = sum.mul_add(z, L::splat(LOG[5 - k]));
    }
    sum * z
}

/// ln x for normal x > 0, within 1 ulp of that of std; garbage elsewhere.
///
/// x = 2^k (1 + f), 1 + f in sqrt(1/2) .. sqrt(2); ln x = k ln 2 + f - (f^2/2 - s (f^2/2 + R)) as in fdlibm.
#[inline(always)]
pub fn ln<L: Lane>(x: L) -> L {
    let (mantissa, k) = x.split();
    let f = mantissa - L::splat(1.0);
    let s = f / (f + L::splat(2.0));
    let half = L::splat(0.5) * f * f;
    let small = s.mul_add(half + log_series(s * s), k * L::splat(LN_2[1]));
    k.mul_add(L::splat(LN_2[0]), f - (half - small))
}

/// exp x for |x| <= 700, within 1 ulp of that of std; garbage beyond.
///
/// x = k ln 2 + r, |r| <= ln 2 / 2; the Taylor polynomial of degree 13, whose rest is below 5e-18.
#[inline(always)]
pub fn exp<L: Lane>(x: L) -> L {
    let k = (x * L::splat(std::f64::consts::LOG2_E)).nearest();
    let (high, low) = (k.mul_add(L::splat(-LN_2[0]), x), k * L::splat(LN_2[1]));
    let r = high - low;
    let mut sum = L::splat(1.0 / 6_227_020_800.0);
    for factorial in [479_001_600.0, 39_916_800.0, 3_628_800.0, 362_880.0, 40_320.0, 5_040.0, 720.0, 120.0, 24.0, 6.0] {
        sum = sum.mul_add(r, L::splat(1.0 / factorial));
    }
    sum = sum.mul_add(r, L::splat(0.5));
    // 1 + (r + r^2 sum), the rounding of r put right.
    let rest = (r * r).mul_add(sum, (high - r) - low);
    (L::splat(1.0) + (r + rest)) * k.power_of_two()
}

/// atanh(q) / q for z = q^2, 0 <= z < 1, to 4 ulp: smooth in z at 0, where it is 1.
///
/// (1 + q)/(1 - q) = 2^k m: atanh q = k ln 2 / 2 + atanh s with s = (m - 1)/(m + 1), and s = q where k = 0.
#[inline(always)]
pub fn atanh_ratio<L: Lane>(z: L) -> L {
    let (one, half) = (L::splat(1.0), L::splat(0.5));
    let q = z.sqrt();
    // 1 - q without cancellation: (1 - z)/(1 + q).
    let (above, below) = (one + q, (one - z) / (one + q));
    let (m, k) = (above / below).split();
    let s = (m - one) / (m + one);
    let square = k.where_positive(s * s, z);
    let ratio = (half * log_series(square)) + one;
    let whole = k.mul_add(L::splat(0.5 * (LN_2[0] + LN_2[1])), s * ratio) / q;
    k.where_positive(whole, ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::{F8, Kernel, Lanes, Work};

    #[derive(Clone, Copy)]
    enum Function {
        Ln,
        Exp,
        AtanhRatio,
    }

    impl Function {
        #[inline(always)]
        fn of<L: Lane>(self, x: L) -> L {
            match self {
                Function::Ln => ln(x),
                Function::Exp => exp(x),
                Function::AtanhRatio => atanh_ratio(x),
            }
        }
    }

    struct Apply<'a>(&'a [F8], Function);
    impl Work for Apply<'_> {
        type Out = Vec<F8>;
        #[inline(always)]
        fn run<L: Lanes>(self) -> Vec<F8> {
            let mut out = vec![F8::ZERO; self.0.len()];
            for (x, out) in self.0.iter().zip(&mut out) {
                self.1.of(L::load(x)).store(out);
            }
            out
        }
    }

    /// Largest error in units of the last place of `expected`, over all paths.
    fn worst(numbers: &[f64], function: Function, expected: impl Fn(f64) -> f64) -> f64 {
        let packed: Vec<F8> = numbers.as_chunks::<8>().0.iter().map(|x| F8(*x)).collect();
        let mut worst: f64 = 0.0;
        let mut see = |x: f64, found: f64| {
            let right = expected(x);
            let ulp = f64::from_bits(right.abs().to_bits() + 1) - right.abs();
            let error = (found - right).abs() / ulp;
            assert!(error.is_finite(), "{x}: {found} {right}");
            worst = worst.max(error);
        };
        for &(_, kernel) in Kernel::NAMES.iter().filter(|(_, kernel)| kernel.is_available()) {
            let found = kernel.enter(Apply(&packed, function));
            for (x, found) in packed.iter().zip(&found) {
                (0..8).for_each(|lane| see(x.0[lane], found.0[lane]));
            }
        }
        numbers.iter().for_each(|&x| see(x, function.of(x)));
        println!("{worst:.2} ulp");
        worst
    }

    /// 80 000 numbers from `from` to `to`.
    fn sweep(from: f64, to: f64, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..80_000).map(|i| of(from + (to - from) * f64::from(i) / 79_999.0)).collect()
    }

    #[test]
    fn ln_is_that_of_std_to_1_ulp_on_all_normal_numbers() {
        let tiny = sweep(-16.0, -1.0, |e| 1.0 - 10f64.powf(e));
        let near = sweep(0.4, 3.0, |x| x);
        let all = sweep(-307.6, 308.2, |e| 10f64.powf(e));
        for numbers in [tiny, near, all] {
            // std's own is off by half an ulp at most; found to differ by 1 at most.
            let worst = worst(&numbers, Function::Ln, f64::ln);
            assert!(worst <= 1.0, "{worst}");
        }
        assert_eq!([ln(1.0), ln(f64::MIN_POSITIVE)], [0.0, f64::MIN_POSITIVE.ln()]);
    }

    #[test]
    fn exp_is_that_of_std_to_1_ulp_from_its_smallest_to_its_largest_normal_result() {
        let small = sweep(-18.0, 0.0, |e| 10f64.powf(e));
        for numbers in [small.iter().map(|x| -x).collect(), small, sweep(-2.0, 2.0, |x| x), sweep(-700.0, 700.0, |x| x)]
        {
            let worst = worst(&numbers, Function::Exp, f64::exp);
            assert!(worst <= 1.0, "{worst}");
        }
        assert_eq!(exp(0.0), 1.0);
    }

    #[test]
    fn atanh_over_its_argument_is_exact_to_4_ulp_from_0_to_1() {
        let expected = |z: f64| {
            let q = z.sqrt();
            // The series where the quotient of ln_1p loses digits. (1 - q does, too: 1 - z is exact where it is small.)
            if z < 1e-6 { 1.0 + z / 3.0 + z * z / 5.0 } else { 0.5 * (2.0 * q * (1.0 + q) / (1.0 - z)).ln_1p() / q }
        };
        // Up to 1 - z = 1e-3, eigenvalues 4000 to 1.
        for numbers in [sweep(0.0, 0.999, |z| z), sweep(-300.0, -3e-4, |e| 10f64.powf(e))] {
            let worst = worst(&numbers, Function::AtanhRatio, expected);
            // Measured 3 and 4, of which the expression for comparison has its part.
            assert!(worst <= 4.0, "{worst}");
        }
        assert_eq!(atanh_ratio(0.0), 1.0);
    }
}
