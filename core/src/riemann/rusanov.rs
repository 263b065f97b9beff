//! Local Lax-Friedrichs (Rusanov) flux.

use super::{Looks, Medium, Riemann, Trace};
use crate::lane::Lane;

/// Flux* = mean of both sides - c/2 (U^+ - U^-), c the larger current c_p.
#[derive(Debug, Clone, Copy)]
pub struct Rusanov;

impl Riemann for Rusanov {
    const LOOKS: Looks = Looks::Nothing;

    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> [L; 6] {
        // Halves and signs stand in what is the same at all points of a face: fewer operations for each number.
        let half = L::splat(-0.5);
        let back = [half * n[0], half * n[1]];
        let c = half * minus.c[0].max(plus.c[0]);
        let jump = c * medium.density;
        let mut flux = [L::zero(); 6];
        for i in 0..2 {
            let v = minus.v[i] + plus.v[i];
            flux[2 * i] = c.mul_add(plus.f[2 * i] - minus.f[2 * i], v * back[0]);
            flux[2 * i + 1] = c.mul_add(plus.f[2 * i + 1] - minus.f[2 * i + 1], v * back[1]);
            flux[4 + i] = jump.mul_add(plus.v[i] - minus.v[i], half * (minus.t[i] + plus.t[i]));
        }
        flux
    }

    /// In jumps alone: `-c/2 [F] - 1/2 [v] (x) N` for the rows of F. The scale stands in what is the same for all rows.
    #[inline(always)]
    fn lifted<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>, scale: L) -> [L; 6] {
        let half = L::splat(-0.5) * scale;
        let back = [half * n[0], half * n[1]];
        let c = half * minus.c[0].max(plus.c[0]);
        let jump = c * medium.density;
        let mut out = [L::zero(); 6];
        for i in 0..2 {
            let v = plus.v[i] - minus.v[i];
            out[2 * i] = c.mul_add(plus.f[2 * i] - minus.f[2 * i], v * back[0]);
            out[2 * i + 1] = c.mul_add(plus.f[2 * i + 1] - minus.f[2 * i + 1], v * back[1]);
            out[4 + i] = jump.mul_add(v, half * (minus.t[i] + plus.t[i]));
        }
        out
    }
}
