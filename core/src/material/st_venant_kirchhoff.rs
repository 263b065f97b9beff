//! St. Venant-Kirchhoff solid: Hooke's law between Green's strain and the second Piola-Kirchhoff stress.

use super::{Material, Past};
use crate::lane::Lane;
use crate::tensor;

/// W = lambda/2 (tr E)^2 + mu E:E, E = (F^T F - 1)/2, E33 = 0 (plane strain).
///
/// It stiffens in tension, where a wave of tension becomes a shock, and softens in compression, where hyperbolicity is lost at
/// uniaxial F11 = .7055 for nu = .3 and .5855 for nu = 0, in a direction between the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StVenantKirchhoff {
    lambda: f64,
    mu: f64,
    density: f64,
}

/// Directions N in which hyperbolicity is looked at, over half a turn.
const DIRECTIONS: usize = 16;

impl StVenantKirchhoff {
    /// From Young's modulus (Pa), Poisson's ratio and rho0 (kg/m^3): lambda = E nu/((1+nu)(1-2nu)), mu = E/(2(1+nu)).
    pub fn new(young: f64, poisson: f64, density: f64) -> Self {
        let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        Self { lambda, mu: young / (2.0 * (1.0 + poisson)), density }
    }

    /// [E11, E12, E22].
    #[inline(always)]
    fn strain<L: Lane>(f: [L; 4]) -> [L; 3] {
        let ([c11, c12, c22], half, one) = (tensor::right_cauchy_green(f), L::splat(0.5), L::splat(1.0));
        [half * (c11 - one), half * c12, half * (c22 - one)]
    }

    /// S = lambda (tr E) 1 + 2 mu E, [S11, S12, S22].
    #[inline(always)]
    fn second_piola<L: Lane>(&self, [e11, e12, e22]: [L; 3]) -> [L; 3] {
        let (pressure, twice) = (L::splat(self.lambda) * (e11 + e22), L::splat(2.0 * self.mu));
        [twice.mul_add(e11, pressure), twice * e12, twice.mul_add(e22, pressure)]
    }
}

impl Material for StVenantKirchhoff {
    type History<L: Lane> = [L; 0];

    fn density(&self) -> f64 {
        self.density
    }

    fn shear_modulus(&self) -> f64 {
        self.mu
    }

    /// P = F S.
    #[inline(always)]
    fn stress<L: Lane>(&self, f: [L; 4], _: &mut Past<[L; 0]>) -> [L; 4] {
        let [s11, s12, s22] = self.second_piola(Self::strain(f));
        [
            f[0].mul_add(s11, f[1] * s12),
            f[0].mul_add(s12, f[1] * s22),
            f[2].mul_add(s11, f[3] * s12),
            f[2].mul_add(s12, f[3] * s22),
        ]
    }

    /// P33 = lambda tr E.
    #[inline(always)]
    fn stress33<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        let [e11, _, e22] = Self::strain(f);
        L::splat(self.lambda) * (e11 + e22)
    }

    #[inline(always)]
    fn energy<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        let [e11, e12, e22] = Self::strain(f);
        let (trace, squares) = (e11 + e22, e11.mul_add(e11, e22 * e22) + L::splat(2.0) * e12 * e12);
        (L::splat(0.5 * self.lambda) * trace).mul_add(trace, L::splat(self.mu) * squares)
    }

    /// B = (N . S N) 1 + (lambda + mu) F N (x) F N + mu F F^T.
    #[inline(always)]
    fn acoustic<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 3] {
        let [s11, s12, s22] = self.second_piola(Self::strain(f));
        let along = n[0] * s11.mul_add(n[0], s12 * n[1]) + n[1] * s12.mul_add(n[0], s22 * n[1]);
        let (a, left) = (tensor::times(f, n), tensor::times_transposed(f, f));
        let (sum, mu) = (L::splat(self.lambda + self.mu), L::splat(self.mu));
        [
            along + mu.mul_add(left[0], sum * a[0] * a[0]),
            mu.mul_add(left[1], sum * a[0] * a[1]),
            along + mu.mul_add(left[3], sum * a[1] * a[1]),
        ]
    }

    /// Waves are fastest along the largest stretch; hyperbolicity is lost in a direction between the axes, and is looked at in 16.
    #[inline(always)]
    fn largest_squares<L: Lane>(&self, f: [L; 4], _: &Self::History<L>) -> [L; 2] {
        let inverse = L::splat(1.0 / self.density);
        let [c11, c12, c22] = tensor::right_cauchy_green(f);
        let [n1, n2] = tensor::smaller_eigenvector(c11, c12, c22);
        let mut smallest = L::splat(f64::INFINITY);
        for (cos, sin) in HALF_TURN {
            let [b11, b12, b22] = self.acoustic(f, [L::splat(cos), L::splat(sin)]);
            smallest = smallest.min(tensor::eigenvalues(b11, b12, b22)[1]);
        }
        [self.moduli(f, [-n2, n1])[0] * inverse, smallest * inverse]
    }
}

/// (cos, sin) of pi k / 16.
const HALF_TURN: [(f64, f64); DIRECTIONS] = {
    const C: [f64; 9] = [
        1.0,
        0.980_785_280_403_230_4,
        0.923_879_532_511_286_7,
        0.831_469_612_302_545_2,
        std::f64::consts::FRAC_1_SQRT_2,
        0.555_570_233_019_602_2,
        0.382_683_432_365_089_8,
        0.195_090_322_016_128_27,
        0.0,
    ];
    let mut out = [(0.0, 0.0); DIRECTIONS];
    let mut k = 0;
    while k < DIRECTIONS {
        out[k] = if k <= 8 { (C[k], C[8 - k]) } else { (-C[16 - k], C[k - 8]) };
        k += 1;
    }
    out
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PointLaw;

    /// The largest F11 in uniaxial compression at which a speed is no number.
    fn lost_at(poisson: f64) -> f64 {
        let law = StVenantKirchhoff::new(1.0, poisson, 1.0);
        let is_lost = |f11: f64| law.largest_speeds([f11, 0.0, 0.0, 1.0], &[]).iter().any(|c| c.is_nan());
        (0..5000).map(|k| 1.0 - 1e-4 * k as f64).find(|f11| is_lost(*f11)).unwrap()
    }

    #[test]
    fn uniaxial_compression_loses_hyperbolicity_where_theory_says() {
        // .7055 and .5855 over all directions; 16 of them find it .5 % late at most.
        for (poisson, theory) in [(0.3, 0.7055), (0.0, 0.5855)] {
            let found = lost_at(poisson);
            assert!((found / theory - 1.0).abs() < 5e-3, "nu = {poisson}: {found} instead of {theory}");
        }
    }

    #[test]
    fn half_a_turn_is_sampled_evenly() {
        for (k, (cos, sin)) in HALF_TURN.into_iter().enumerate() {
            let angle = std::f64::consts::PI * k as f64 / 16.0;
            assert!((cos - angle.cos()).abs() < 1e-15 && (sin - angle.sin()).abs() < 1e-15, "{k}");
        }
    }

    #[test]
    fn uniaxial_stress_is_the_cubic_of_the_stretch() {
        let law = StVenantKirchhoff::new(1.0, 0.0, 1.0);
        // nu = 0: lambda = 0, 2 mu = 1, P11 = F11 (F11^2 - 1) / 2.
        for f11 in [0.7, 1.0, 1.5] {
            let p = PointLaw::stress(&law, [f11, 0.0, 0.0, 1.0]);
            assert!((p[0] - 0.5 * f11 * (f11 * f11 - 1.0)).abs() < 1e-15 && p[3] == 0.0);
        }
    }
}
