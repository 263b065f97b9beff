//! Local Lax-Friedrichs (Rusanov) flux.

use super::{Riemann, Trace};
use crate::lane::Lane;

/// Flux* = mean of both sides - c/2 (U^+ - U^-), c the larger current c_p.
#[derive(Debug, Clone, Copy)]
pub struct Rusanov;

impl Riemann for Rusanov {
    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], density: L) -> [L; 6] {
        let half = L::splat(0.5);
        let c = half * minus.c[0].max(plus.c[0]);
        let jump = c * density;
        let v: [L; 2] = std::array::from_fn(|i| half * (minus.v[i] + plus.v[i]));
        let f: [L; 4] = std::array::from_fn(|k| -(v[k / 2] * n[k % 2]) - c * (plus.f[k] - minus.f[k]));
        let p: [L; 2] = std::array::from_fn(|i| -(half * (minus.t[i] + plus.t[i])) - jump * (plus.v[i] - minus.v[i]));
        [f[0], f[1], f[2], f[3], p[0], p[1]]
    }
}
