//! Sums of Runge-Kutta stages, U + sum_j factor_j k_j, read from memory once.

use super::runge_kutta::MOST_STAGES;
use crate::lane::{F8, Lanes};

/// The terms factor_j k_j of a block. Its functions are inlined: a call would hand back a copy of the whole list.
#[derive(Clone, Copy)]
pub struct Terms<'a> {
    list: [(f64, &'a [F8]); MOST_STAGES],
    count: usize,
}

impl<'a> Terms<'a> {
    /// Of those `factors` that are not zero, `rates` being those of the block, [stage][`stride` numbers], cut to `len`.
    #[inline(always)]
    pub fn new(factors: impl Iterator<Item = f64>, rates: &'a [F8], stride: usize, len: usize) -> Self {
        let mut terms = Self { list: [(0.0, &[]); MOST_STAGES], count: 0 };
        for (stage, factor) in factors.enumerate().filter(|(_, factor)| *factor != 0.0).take(MOST_STAGES) {
            terms.list[terms.count] = (factor, &rates[stage * stride..][..len]);
            terms.count += 1;
        }
        terms
    }

    /// With one more.
    #[inline(always)]
    pub fn and(mut self, factor: f64, rate: &'a [F8]) -> Self {
        if factor != 0.0 && self.count < MOST_STAGES {
            self.list[self.count] = (factor, rate);
            self.count += 1;
        }
        self
    }

    /// No term or the only one; none where there are more.
    #[inline]
    #[allow(clippy::option_option)]
    pub fn few(&self) -> Option<Option<(f64, &'a [F8])>> {
        match self.count {
            0 => Some(None),
            1 => Some(Some(self.list[0])),
            _ => None,
        }
    }

    /// out = base + the sum; all have the length of `out`.
    #[inline(always)]
    pub fn add_to<L: Lanes>(&self, base: &[F8], out: &mut [F8]) {
        let (fours, rest) = self.list[..self.count].as_chunks::<4>();
        // Four terms a pass; a pass goes on from the sum of the one before.
        let mut first = Some(base);
        for terms in fours {
            pass::<L, 4>(first.take(), *terms, out);
        }
        match *rest {
            [a] => pass::<L, 1>(first, [a], out),
            [a, b] => pass::<L, 2>(first, [a, b], out),
            [a, b, c] => pass::<L, 3>(first, [a, b, c], out),
            _ => {
                if let Some(base) = first {
                    out.copy_from_slice(&base[..out.len()]);
                }
            }
        }
    }
}

/// out = base (or out, where there is none) + K terms.
#[inline(always)]
fn pass<L: Lanes, const K: usize>(base: Option<&[F8]>, terms: [(f64, &[F8]); K], out: &mut [F8]) {
    let len = out.len();
    let (mut factor, mut rate) = ([L::zero(); K], [&[] as &[F8]; K]);
    for k in 0..K {
        factor[k] = L::splat(terms[k].0);
        rate[k] = &terms[k].1[..len];
    }
    match base {
        Some(base) => {
            let base = &base[..len];
            for e in 0..len {
                let mut sum = L::load(&base[e]);
                for k in 0..K {
                    sum = factor[k].mul_add(L::load(&rate[k][e]), sum);
                }
                sum.store(&mut out[e]);
            }
        }
        None => {
            for e in 0..len {
                let mut sum = L::load(&out[e]);
                for k in 0..K {
                    sum = factor[k].mul_add(L::load(&rate[k][e]), sum);
                }
                sum.store(&mut out[e]);
            }
        }
    }
}
