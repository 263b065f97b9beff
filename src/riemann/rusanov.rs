//! Local Lax-Friedrichs (Rusanov) flux.

use super::{Riemann, Trace, star};
use crate::lane::Lane;

/// Flux* = mean of both sides - c/2 (U^+ - U^-), c the larger current c_p.
#[derive(Debug, Clone, Copy)]
pub struct Rusanov;

impl Riemann for Rusanov {
    const SHEAR: bool = false;

    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], density: L) -> [L; 6] {
        let half = L::splat(0.5);
        let c = half * minus.c[0].max(plus.c[0]);
        let jump = c * density;
        let v = [half * (minus.v[0] + plus.v[0]), half * (minus.v[1] + plus.v[1])];
        let t = [half * (minus.t[0] + plus.t[0]), half * (minus.t[1] + plus.t[1])];
        let mut flux = star(v, t, n);
        for (flux, (minus, plus)) in flux.iter_mut().zip(minus.f.iter().zip(&plus.f)) {
            *flux = *flux - c * (*plus - *minus);
        }
        for i in 0..2 {
            flux[4 + i] = flux[4 + i] - jump * (plus.v[i] - minus.v[i]);
        }
        flux
    }
}
