//! Linear elastic solid: Hooke's law in the small strain, with the full gradient in its symmetric part.

use super::{Material, Past};
use crate::lane::Lane;

/// W = lambda/2 (tr eps)^2 + mu eps:eps, eps = (F + F^T)/2 - 1, eps33 = 0.
///
/// For exact solutions and for equalities that hold for a linear law only. It is not objective: a rotation strains it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearElastic {
    lambda: f64,
    mu: f64,
    density: f64,
}

impl LinearElastic {
    /// From Young's modulus (Pa), Poisson's ratio and rho0 (kg/m^3): lambda = E nu/((1+nu)(1-2nu)), mu = E/(2(1+nu)).
    pub fn new(young: f64, poisson: f64, density: f64) -> Self {
        let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        Self { lambda, mu: young / (2.0 * (1.0 + poisson)), density }
    }

    /// tr eps = F11 + F22 - 2.
    #[inline(always)]
    fn trace<L: Lane>(f: [L; 4]) -> L {
        (f[0] - L::splat(1.0)) + (f[3] - L::splat(1.0))
    }
}

impl Material for LinearElastic {
    type History<L: Lane> = [L; 0];
    const OBJECTIVE: bool = false;

    fn density(&self) -> f64 {
        self.density
    }

    fn shear_modulus(&self) -> f64 {
        self.mu
    }

    /// P = lambda (tr eps) 1 + 2 mu eps.
    #[inline(always)]
    fn stress<L: Lane>(&self, f: [L; 4], _: &mut Past<[L; 0]>) -> [L; 4] {
        let pressure = L::splat(self.lambda) * Self::trace(f);
        let (one, twice) = (L::splat(1.0), L::splat(2.0 * self.mu));
        let shear = L::splat(self.mu) * (f[1] + f[2]);
        [twice.mul_add(f[0] - one, pressure), shear, shear, twice.mul_add(f[3] - one, pressure)]
    }

    /// P33 = lambda tr eps.
    #[inline(always)]
    fn stress33<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        L::splat(self.lambda) * Self::trace(f)
    }

    #[inline(always)]
    fn energy<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        let one = L::splat(1.0);
        let (trace, e11, e22, twice_e12) = (Self::trace(f), f[0] - one, f[3] - one, f[1] + f[2]);
        let squares = e11.mul_add(e11, e22 * e22) + L::splat(0.5) * twice_e12 * twice_e12;
        (L::splat(0.5 * self.lambda) * trace).mul_add(trace, L::splat(self.mu) * squares)
    }

    /// B = mu 1 + (lambda + mu) N N^T.
    #[inline(always)]
    fn acoustic<L: Lane>(&self, _: [L; 4], n: [L; 2]) -> [L; 3] {
        let (mu, sum) = (L::splat(self.mu), L::splat(self.lambda + self.mu));
        [(sum * n[0]).mul_add(n[0], mu), sum * n[0] * n[1], (sum * n[1]).mul_add(n[1], mu)]
    }
}
