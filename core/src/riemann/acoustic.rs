//! Acoustic (linearised Godunov) fluxes.

use super::{Impedance, Looks, Medium, Riemann, Trace, add_tangential, current_normal, star, tangent};
use crate::lane::Lane;
use crate::tensor;

/// v* = mean v + 1/2 Z^-1 (t^+ - t^-), t* = mean t + 1/2 Z (v^+ - v^-), Z with the larger current speeds.
#[derive(Debug, Clone, Copy)]
pub struct Acoustic;

/// [`Acoustic`] with -c_p/2 (`[F]` T) (x) T added to Flux*_F, which damps the jumps that are no gradients.
#[derive(Debug, Clone, Copy)]
pub struct AcousticCurl;

impl Riemann for Acoustic {
    const LOOKS: Looks = Looks::Shear;

    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> [L; 6] {
        let half = L::splat(0.5);
        let c = [minus.c[0].max(plus.c[0]), minus.c[1].max(plus.c[1])];
        let normal = if medium.is_objective { current_normal(minus.f, plus.f, n) } else { n };
        let z = Impedance::new(c, medium.density, normal);
        let dv = z.solve([plus.t[0] - minus.t[0], plus.t[1] - minus.t[1]]);
        let dt = z.times([plus.v[0] - minus.v[0], plus.v[1] - minus.v[1]]);
        let v = [half * (minus.v[0] + plus.v[0] + dv[0]), half * (minus.v[1] + plus.v[1] + dv[1])];
        let t = [half * (minus.t[0] + plus.t[0] + dt[0]), half * (minus.t[1] + plus.t[1] + dt[1])];
        star(v, t, n)
    }
}

impl Riemann for AcousticCurl {
    const LOOKS: Looks = Looks::Shear;

    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> [L; 6] {
        let mut flux = Acoustic.flux(minus, plus, n, medium);
        add_tangential(&mut flux, curl_penalty(minus, plus, n), n);
        flux
    }
}

/// -c/2 [F] T with the larger current c_p.
#[inline(always)]
pub(super) fn curl_penalty<L: Lane>(minus: &Trace<L>, plus: &Trace<L>, n: [L; 2]) -> [L; 2] {
    let c = L::splat(-0.5) * minus.c[0].max(plus.c[0]);
    let (a, b) = (plus.f, minus.f);
    let jump = tensor::times([a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]], tangent(n));
    [c * jump[0], c * jump[1]]
}
