//! Elastoplastic solid at finite strain: J2 yield with linear isotropic hardening, logarithmic elastic strain.

use super::{Material, Past, Rank, Variable, virgin};
use crate::lane::{Lane, functions};
use crate::tensor;

/// W = kappa/2 (J - 1)^2 + mu dev e : dev e + H/2 p^2, with e = 1/2 ln b_e, b_e = F Cp^-1 F^T and p the cumulated plastic
/// strain; yield where |dev tau| = sqrt(2/3) (sigma_y + H p). Volumetric part as in (4), not kappa ln J.
///
/// Internal variables: Cp^-1 (11, 22, 12, 33), Cp the plastic right Cauchy-Green tensor, det Cp = 1; p. The backward Euler
/// step from their values h_n to F is a radial return in the logarithmic strain; what is done elastically leaves them bit
/// for bit. sigma_y p is dissipated, H/2 p^2 stored.
///
/// Spectral decompositions stay in the plane and need no eigenvectors: with m, r centre and radius of Mohr's circle of
/// b_e, e1 - e2 = w = atanh(r/m), and w (b_e - m 1)/r is smooth where both eigenvalues are the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct J2 {
    kappa: f64,
    mu: f64,
    density: f64,
    yield_stress: f64,
    hardening: f64,
}

/// Where p stands among the internal variables.
pub const PLASTIC_STRAIN: usize = 4;

/// sqrt(2/3)
const ROOT: f64 = 0.816_496_580_927_726;

/// What a law with the internal variables h_n makes of F.
struct Step<L> {
    /// J.
    j: L,
    /// 1/J.
    inverse: L,
    /// F Cp^-1.
    product: [L; 4],
    /// Of b_e: [11, 12, 22] and m = (b_11 + b_22)/2.
    b: [L; 3],
    centre: L,
    /// w/r of the trial state.
    ratio: L,
    /// w^2 of the trial state.
    square: L,
    /// (dev e)_33 = -2 `mean`, and `mean` is that of the plane: the trial state.
    mean: L,
    /// |dev e| of the trial state.
    size: L,
    /// dev e over its trial value; 1 where the step is elastic.
    factor: L,
    /// What p grows by; 0 where the step is elastic.
    flow: L,
}

impl J2 {
    /// What it is, in one line.
    pub const ABOUT: &'static str = "elastoplastic (von Mises), finite strain: radial return in the logarithmic elastic strain; it has internal variables";

    /// From Young's modulus (Pa), Poisson's ratio, rho0 (kg/m^3), sigma_y and H (Pa).
    pub fn new(young: f64, poisson: f64, density: f64, yield_stress: f64, hardening: f64) -> Self {
        let (kappa, mu) = (young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)));
        Self { kappa, mu, density, yield_stress, hardening }
    }

    /// Trial state and radial return: f = 2 mu |d| - sqrt(2/3)(sigma_y + H p); where f > 0, with
    /// dg = f/(2 mu + 2H/3), d -= dg d/|d| and p += sqrt(2/3) dg.
    #[inline(always)]
    fn step<L: Lane>(&self, f: [L; 4], internal: &[L; 5]) -> Step<L> {
        let (one, half) = (L::splat(1.0), L::splat(0.5));
        let (c11, c22, c12, c33) = (internal[0], internal[1], internal[2], internal[3]);
        let j = tensor::det(f);
        let product = tensor::times_transposed(f, [c11, c12, c12, c22]);
        let [b11, b12, _, b22] = tensor::times_transposed(product, f);
        let (centre, difference) = (half * (b11 + b22), half * (b11 - b22));
        let radius2 = difference.mul_add(difference, b12 * b12);
        let inverse_centre = one / centre;
        let ratio = functions::atanh_ratio(radius2 * inverse_centre * inverse_centre) * inverse_centre;
        let square = radius2 * ratio * ratio;
        // Of e1 + e2 and e3 only dev e is needed: with tr e = ln J, (e1 + e2 - 2 e3)/6 = ln(det b_e / b_e33^2)/12.
        let plane = (j * j) * (c11 * c22 - c12 * c12);
        let mean = functions::ln(plane / (c33 * c33)) * L::splat(1.0 / 12.0);
        let size = (L::splat(6.0) * mean).mul_add(mean, half * square).sqrt();
        let strength = L::splat(self.hardening).mul_add(internal[PLASTIC_STRAIN], L::splat(self.yield_stress));
        let excess = L::splat(2.0 * self.mu).mul_add(size, L::splat(-ROOT) * strength);
        let rate = excess * L::splat(1.0 / (2.0 * self.mu + 2.0 / 3.0 * self.hardening));
        let factor = excess.where_positive(one - rate / size, one);
        let flow = excess.where_positive(L::splat(ROOT) * rate, L::zero());
        let b = [b11, b12, b22];
        Step { j, inverse: one / j, product, b, centre, ratio, square, mean, size, factor, flow }
    }

    /// Cp^-1 <- F^-1 b_e F^-T, where b_e has the new elastic strain, and p.
    ///
    /// b_e = s (cosh w 1 + sinh w (b - m 1)/r) with the trial's b, m, r: Cp^-1 = s ((cosh w - k m) C^-1 + k Cp^-1_n), k = sinh w / r,
    /// s = J^(2/3) exp(2 mean): det b_e = J^2 anew at each step, so that det Cp = 1 does not drift.
    #[inline(always)]
    fn update<L: Lane>(f: [L; 4], step: &Step<L>, internal: &mut [L; 5]) {
        let (one, half) = (L::splat(1.0), L::splat(0.5));
        let w = step.factor * step.square.sqrt();
        let (up, spread) = (functions::exp(w), functions::exp(L::splat(2.0) * step.factor * step.mean));
        let down = one / up;
        // Where w = 0 so is b - m 1: any k will do.
        let k = half * (up - down) / w.max(L::splat(f64::MIN_POSITIVE)) * (step.factor * step.ratio);
        let volume = step.j * step.j.inverse_cube_root();
        let scale = volume * spread;
        let [s11, s12, s22] = tensor::right_cauchy_green(f);
        let outer = scale * (half * (up + down) - k * step.centre) * (step.inverse * step.inverse);
        let inner = scale * k;
        let new = [
            inner.mul_add(internal[0], outer * s22),
            inner.mul_add(internal[1], outer * s11),
            inner.mul_add(internal[2], -(outer * s12)),
            volume / (spread * spread),
            internal[PLASTIC_STRAIN] + step.flow,
        ];
        for (old, new) in internal.iter_mut().zip(new) {
            *old = step.flow.where_positive(new, *old);
        }
    }

    /// (w coth w - 1)/w^2 for z = w^2: the continued fraction 1/(3 + z/(5 + z/(7 + ..))), to rounding for w up to 3.
    #[inline(always)]
    fn cotangent_series<L: Lane>(z: L) -> L {
        let (mut last, mut before) = (L::splat(1.0), L::splat(0.0));
        for k in 0..13 {
            (last, before) = (L::splat(f64::from(27 - 2 * k)).mul_add(last, z * before), last);
        }
        before / last
    }
}

impl Material for J2 {
    const HISTORY: &'static [Variable] = &[
        Variable {
            name: "inverse_plastic_metric",
            about: "Cp^-1, the inverse of the plastic right Cauchy-Green tensor",
            rank: Rank::SymmetricTensor,
            numbers: &[("_11", 1.0), ("_22", 1.0), ("_12", 0.0), ("_33", 1.0)],
        },
        Variable {
            name: "plastic_strain",
            about: "cumulated plastic strain p",
            rank: Rank::Scalar,
            numbers: &[("", 0.0)],
        },
    ];
    type History<L: Lane> = [L; 5];

    fn density(&self) -> f64 {
        self.density
    }

    fn shear_modulus(&self) -> f64 {
        self.mu
    }

    /// P = A F Cp^-1 + B cof F, A = mu w/r, B = kappa (J - 1) + (2 mu `mean` - A m)/J.
    #[inline(always)]
    fn stress<L: Lane>(&self, f: [L; 4], past: &mut Past<[L; 5]>) -> [L; 4] {
        let step = self.step(f, &past.history);
        let (g, u) = (tensor::cofactor(f), step.product);
        let a = L::splat(self.mu) * step.factor * step.ratio;
        let deviator = (L::splat(2.0 * self.mu) * step.factor).mul_add(step.mean, -(a * step.centre));
        let b = (step.j - L::splat(1.0)).mul_add(L::splat(self.kappa), deviator * step.inverse);
        let p = [
            a.mul_add(u[0], b * g[0]),
            a.mul_add(u[1], b * g[1]),
            a.mul_add(u[2], b * g[2]),
            a.mul_add(u[3], b * g[3]),
        ];
        Self::update(f, &step, &mut past.history);
        p
    }

    /// P33 = tau33 = kappa J (J - 1) + 2 mu (dev e)_33.
    #[inline(always)]
    fn stress33<L: Lane>(&self, f: [L; 4], past: &Past<[L; 5]>) -> L {
        let step = self.step(f, &past.history);
        let pressure = step.j * (step.j - L::splat(1.0)) * L::splat(self.kappa);
        (L::splat(-4.0 * self.mu) * step.factor).mul_add(step.mean, pressure)
    }

    #[inline(always)]
    fn energy<L: Lane>(&self, f: [L; 4], past: &Past<[L; 5]>) -> L {
        let step = self.step(f, &past.history);
        let (change, size) = (step.j - L::splat(1.0), step.factor * step.size);
        let p = past.history[PLASTIC_STRAIN] + step.flow;
        let hardening = L::splat(0.5 * self.hardening) * p * p;
        let deviator = (L::splat(self.mu) * size).mul_add(size, hardening);
        (L::splat(0.5 * self.kappa) * change).mul_add(change, deviator)
    }

    /// sigma_y p.
    #[inline(always)]
    fn dissipated<L: Lane>(&self, f: [L; 4], past: &Past<[L; 5]>) -> L {
        L::splat(self.yield_stress) * (past.history[PLASTIC_STRAIN] + self.step(f, &past.history).flow)
    }

    /// Cp^-1 <- (J_to/J_from)^(2/3) F_to^-1 b_e F_to^-T: b_e without its volume, and the yield function, stay; that of material
    /// which has never yielded is left as it is.
    #[inline(always)]
    fn move_history<L: Lane>(&self, from: [L; 4], to: [L; 4], internal: &mut [L; 5]) {
        let (c11, c22, c12, c33) = (internal[0], internal[1], internal[2], internal[3]);
        let product = tensor::times_transposed(from, [c11, c12, c12, c22]);
        let b = tensor::times_transposed(product, from);
        let inverse = L::splat(1.0) / tensor::det(to);
        let ratio = tensor::det(from) * inverse;
        // F^-1 = (cof F)^T / J.
        let [g11, g12, g21, g22] = tensor::cofactor(to);
        let back = [g11, g21, g12, g22];
        let new = tensor::times_transposed(tensor::times_transposed(back, b), back);
        let volume = ratio.inverse_cube_root() * ratio.inverse_cube_root();
        let scale = volume * inverse * inverse;
        let new = [scale * new[0], scale * new[3], scale * new[1], volume * c33];
        let strain = internal[PLASTIC_STRAIN];
        for (old, new) in internal.iter_mut().zip(new) {
            *old = strain.where_positive(new, *old);
        }
    }

    /// Elastic, in the state that virgin material has after one step to F.
    ///
    /// With n = F^-T N = g/J, g = (cof F) N, and the deviator D of 2e in the plane (eigenvalues +-w):
    /// B = kappa g g^T + mu (n.n (1 - D) - G (n.D n) D + (1/3 + w^2 G - 2 `mean`) n n^T), G = (w coth w - 1)/w^2.
    #[inline(always)]
    fn acoustic<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 3] {
        let step = self.step(f, &virgin::<L, Self>());
        let g = tensor::times(tensor::cofactor(f), n);
        let n = [g[0] * step.inverse, g[1] * step.inverse];
        let scale = step.factor * step.ratio;
        let d = [scale * (step.b[0] - step.centre), scale * step.b[1], scale * (step.b[2] - step.centre)];
        let square = step.factor * step.factor * step.square;
        let series = Self::cotangent_series(square);
        let (nn, dn) = (tensor::dot(n, n), [d[0].mul_add(n[0], d[1] * n[1]), d[1].mul_add(n[0], d[2] * n[1])]);
        let with_d = nn + series * tensor::dot(n, dn);
        let with_n = square.mul_add(series, L::splat(1.0 / 3.0)) - L::splat(2.0) * step.factor * step.mean;
        let mu = L::splat(self.mu);
        let (round, with_d, with_n, with_g) = (mu * nn, -(mu * with_d), mu * with_n, L::splat(self.kappa));
        let mut b = [round, L::zero(), round];
        for (k, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
            b[k] = with_d.mul_add(d[k], with_n.mul_add(n[i] * n[j], with_g.mul_add(g[i] * g[j], b[k])));
        }
        b
    }

    /// Along the smaller eigenvalue of b_e, rho0 c_p^2 = kappa J^2 + mu (4/3 + w - 2 `mean`) and
    /// rho0 c_s^2 = mu (w coth w - w), both times the largest |F^-T N|^2: where b_e and F F^T have the same axes (always in
    /// virgin material) the speeds along the smallest stretch, else an upper bound of those of all directions.
    #[inline(always)]
    fn largest_squares<L: Lane>(&self, f: [L; 4], internal: &[L; 5]) -> [L; 2] {
        let step = self.step(f, internal);
        let [c11, c12, c22] = tensor::right_cauchy_green(f);
        let normal2 = tensor::eigenvalues(c11, c12, c22)[0] * (step.inverse * step.inverse);
        let square = step.factor * step.factor * step.square;
        let (w, mu) = (square.sqrt(), L::splat(self.mu));
        let along = w + (L::splat(4.0 / 3.0) - L::splat(2.0) * step.factor * step.mean);
        let pressure = mu.mul_add(along, L::splat(self.kappa) * (step.j * step.j));
        let shear = mu * (square.mul_add(Self::cotangent_series(square), L::splat(1.0)) - w);
        let scale = normal2 * L::splat(1.0 / self.density);
        [pressure.max(shear) * scale, pressure.min(shear) * scale]
    }
}

#[cfg(test)]
mod tests;
