//! Compressible neo-Hookean solid, (4)-(9) of the paper with (9) read as dW/dF.

use super::{Material, Past};
use crate::lane::Lane;
use crate::tensor;

/// W = kappa/2 (J - 1)^2 + mu/2 (J^(-2/3) I - 3), I = F:F + 1 (the 1 is F33^2).
///
/// W stays finite as J -> 0: the law does not stop inversion, the program must.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookean {
    kappa: f64,
    mu: f64,
    density: f64,
}

/// J and what the stress is made of: P = a F + b cof F.
struct Terms<L> {
    j: L,
    /// 1/J = (J^(-1/3))^3: saves a division.
    inverse: L,
    /// I = F:F + 1.
    invariant: L,
    a: L,
    b: L,
}

impl NeoHookean {
    /// From Young's modulus (Pa), Poisson's ratio and rho0 (kg/m^3): kappa = E/(3(1-2nu)), mu = E/(2(1+nu)).
    pub fn new(young: f64, poisson: f64, density: f64) -> Self {
        Self { kappa: young / (3.0 * (1.0 - 2.0 * poisson)), mu: young / (2.0 * (1.0 + poisson)), density }
    }

    #[inline(always)]
    fn terms<L: Lane>(&self, f: [L; 4]) -> Terms<L> {
        let j = tensor::det(f);
        let root = j.inverse_cube_root();
        let root2 = root * root;
        let squares = f[0].mul_add(f[0], f[1] * f[1]) + f[2].mul_add(f[2], f[3] * f[3]);
        let invariant = squares + L::splat(1.0);
        let a = root2 * L::splat(self.mu);
        // 1/J = (J^(-1/3))^3 saves the division; what does not wait for the root stands in one factor.
        let inverse = root2 * root;
        let third = (invariant * L::splat(-self.mu / 3.0) * root2) * inverse;
        let b = (j - L::splat(1.0)).mul_add(L::splat(self.kappa), third);
        Terms { j, inverse, invariant, a, b }
    }

    /// kappa + 5 A I / (9 J^2), what g g^T counts in the acoustic tensor.
    #[inline(always)]
    fn square<L: Lane>(&self, terms: &Terms<L>) -> L {
        let Terms { inverse, invariant, a, .. } = *terms;
        (a * invariant * inverse * inverse).mul_add(L::splat(5.0 / 9.0), L::splat(self.kappa))
    }
}

impl Material for NeoHookean {
    type History<L: Lane> = [L; 0];

    fn density(&self) -> f64 {
        self.density
    }

    fn shear_modulus(&self) -> f64 {
        self.mu
    }

    /// P = A F + B cof F, A = mu J^(-2/3), B = kappa (J - 1) - A I / (3 J).
    #[inline(always)]
    fn stress<L: Lane>(&self, f: [L; 4], _: &mut Past<[L; 0]>) -> [L; 4] {
        let Terms { a, b, .. } = self.terms(f);
        let g = tensor::cofactor(f);
        [a.mul_add(f[0], b * g[0]), a.mul_add(f[1], b * g[1]), a.mul_add(f[2], b * g[2]), a.mul_add(f[3], b * g[3])]
    }

    /// P33 = A + B J.
    #[inline(always)]
    fn stress33<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        let Terms { j, a, b, .. } = self.terms(f);
        b.mul_add(j, a)
    }

    #[inline(always)]
    fn energy<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        let Terms { j, invariant, a, .. } = self.terms(f);
        let (half, change) = (L::splat(0.5), j - L::splat(1.0));
        half * (change * change * L::splat(self.kappa) + (a * invariant - L::splat(3.0 * self.mu)))
    }

    /// B = A 1 - (2A/3J)(f g^T + g f^T) + (kappa + 5 A I/(9 J^2)) g g^T, f = F N, g = (cof F) N.
    #[inline(always)]
    fn acoustic<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 3] {
        let terms = self.terms(f);
        let Terms { inverse, a, .. } = terms;
        let (u, g) = (tensor::times(f, n), tensor::times(tensor::cofactor(f), n));
        let cross = a * inverse * L::splat(-2.0 / 3.0);
        let square = self.square(&terms);
        // cross (f g^T + g f^T) + square g g^T = h g^T + g h^T with h = cross f + square/2 g.
        let half = L::splat(0.5) * square;
        let h = [cross.mul_add(u[0], half * g[0]), cross.mul_add(u[1], half * g[1])];
        let two = L::splat(2.0);
        [(two * h[0]).mul_add(g[0], a), h[0].mul_add(g[1], h[1] * g[0]), (two * h[1]).mul_add(g[1], a)]
    }

    /// With f.g = J and h = -(2A/3J) f + s/2 g, s what g g^T counts, B = A 1 + h g^T + g h^T has the eigenvalues
    /// A + h.g -+ |h||g|, where h.g = s/2 g.g - 2A/3 and |h|^2 |g|^2 = (h.g)^2 + (2A/3J f x g)^2.
    ///
    /// In the plane g.g = F:F - f.f, and (f x g)^2 = f.f g.g - J^2 (Lagrange).
    #[inline(always)]
    fn moduli<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 2] {
        let root = tensor::det(f).inverse_cube_root();
        let root2 = root * root;
        let inverse2 = root2 * (root2 * root2);
        let squares = f[0].mul_add(f[0], f[1] * f[1]) + f[2].mul_add(f[2], f[3] * f[3]);
        let u = tensor::times(f, n);
        let ff = tensor::dot(u, u);
        let gg = squares - ff;
        let third = root2 * L::splat(self.mu / 3.0);
        // s/2 g.g, with A = 3 `third`.
        let square = (third * (squares + L::splat(1.0))) * inverse2;
        let half = square.mul_add(L::splat(5.0 / 6.0), L::splat(0.5 * self.kappa)) * gg;
        let two_thirds = third + third;
        let along = half - two_thirds;
        let across2 = (two_thirds * two_thirds) * (ff * inverse2).mul_add(gg, L::splat(-1.0));
        let (mean, radius) = (half + third, along.mul_add(along, across2).sqrt());
        [mean + radius, mean - radius]
    }

    /// Along a principal direction of stretch l1, the other being l2, f and g are parallel, f.g = J and g.g = l2^2: B has
    /// the eigenvalues (kappa + 5 A I/(9 J^2)) l2^2 - A/3 and A. The fastest is that of the larger l2.
    #[inline(always)]
    fn largest_squares<L: Lane>(&self, f: [L; 4], _: &[L; 0]) -> [L; 2] {
        let terms = self.terms(f);
        let [c11, c12, c22] = tensor::right_cauchy_green(f);
        let stretch2 = tensor::eigenvalues(c11, c12, c22)[0];
        let along = self.square(&terms).mul_add(stretch2, L::splat(-1.0 / 3.0) * terms.a);
        let inverse = L::splat(1.0 / self.density);
        [along.max(terms.a) * inverse, along.min(terms.a) * inverse]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wave_speeds_of_the_papers_steel_are_those_of_the_design() {
        let [cp, cs] = NeoHookean::new(2e11, 0.3, 7800.0).speeds([1.0, 0.0, 0.0, 1.0], [0.6, 0.8]);
        // The design gives 7 digits.
        assert!((cp - 5875.097).abs() < 1e-3 && (cs - 3140.371).abs() < 1e-3, "{cp} {cs}");
    }
}
