//! The local predictor (15)-(21): a space-time collocation at the points of each cell, blind to its neighbours.

use super::dense::{add_scaled, apply, gather, scatter};
use crate::basis::TimeBasis;
use crate::lane::{Coefficient, F8, Lanes, load_array};
use crate::material::Material;
use crate::operators::PointMatrices;

/// Arrays of one block at its points; [field][point] each, those with a time node outermost.
#[derive(Default)]
pub struct Arrays {
    /// U_p^n.
    pub start: Vec<F8>,
    /// u_s,p, [s][6][p].
    u: Vec<F8>,
    /// r_s,p, [s][6][p].
    rate: Vec<F8>,
    /// Q = (P, v) of one time node, [6][p].
    q: Vec<F8>,
    /// Its derivatives along xi1, xi2.
    slope: [Vec<F8>; 2],
    /// Sources b at points and time nodes, [s][2][p]; empty without sources.
    pub source: Vec<F8>,
    /// Time averages, [F (4), v (2), P (4)][p].
    pub mean: Vec<F8>,
}

impl Arrays {
    /// For at most `points` points a cell and `times` time nodes.
    pub fn new(points: usize, times: usize, sources: bool) -> Self {
        let zeros = |fields: usize| vec![F8::ZERO; fields * points];
        Self {
            start: zeros(6),
            u: zeros(6 * times),
            rate: zeros(6 * times),
            q: zeros(6),
            slope: [zeros(6), zeros(6)],
            source: if sources { zeros(2 * times) } else { vec![] },
            mean: zeros(10),
        }
    }
}

/// What the predictor of a block needs beside its arrays.
pub struct Predictor<'a, M, C> {
    /// The law.
    pub law: &'a M,
    /// Matrices of its points.
    pub matrices: &'a PointMatrices<C>,
    /// dxi_b/dX_a at the points.
    pub metric: &'a [F8],
    /// Time nodes.
    pub time: &'a TimeBasis,
    /// Picard sweeps.
    pub sweeps: usize,
    /// Step, s.
    pub dt: f64,
}

impl<M: Material, C: Coefficient> Predictor<'_, M, C> {
    /// From `start` to the time averages `mean`.
    ///
    /// Sweeps u_s <- U^n + dt sum_k At[s, k] r_k(u_k) from u = U^n; the first, from a constant guess, costs one
    /// evaluation instead of N_T + 1.
    #[inline(always)]
    pub fn run<L: Lanes>(&self, arrays: &mut Arrays) {
        let (size, times) = (6 * self.matrices.points(), self.time.len());
        let Arrays { start, u, rate, q, slope, source, .. } = arrays;
        self.rate::<L>(&start[..size], &mut rate[..size], q, slope);
        let (first, others) = rate.split_at_mut(size);
        others[..(times - 1) * size].chunks_exact_mut(size).for_each(|r| r.copy_from_slice(first));
        self.add_source::<L>(rate, source);
        self.integrate::<L>(&start[..size], rate, u);
        for _ in 1..self.sweeps {
            for s in 0..times {
                self.rate::<L>(&u[s * size..(s + 1) * size], &mut rate[s * size..(s + 1) * size], q, slope);
            }
            self.add_source::<L>(rate, source);
            self.integrate::<L>(&start[..size], rate, u);
        }
        self.average::<L>(arrays);
    }

    /// r = (D1 v1, D2 v1, D1 v2, D2 v2, D1 P11 + D2 P12, D1 P21 + D2 P22) at one time node.
    #[inline(always)]
    fn rate<L: Lanes>(&self, u: &[F8], rate: &mut [F8], q: &mut [F8], slope: &mut [Vec<F8>; 2]) {
        let np = self.matrices.points();
        let inverse_density = L::splat(1.0 / self.law.density());
        for p in 0..np {
            let [f11, f12, f21, f22, p1, p2] = gather::<L, 6>(u, np, p);
            let stress = self.law.stress([f11, f12, f21, f22], &mut []);
            let v = [p1 * inverse_density, p2 * inverse_density];
            scatter([stress[0], stress[1], stress[2], stress[3], v[0], v[1]], q, np, p);
        }
        apply::<L, C, 6>(&self.matrices.slope[0], q, &mut slope[0]);
        apply::<L, C, 6>(&self.matrices.slope[1], q, &mut slope[1]);
        for p in 0..np {
            let (a, b) = (gather::<L, 6>(&slope[0], np, p), gather::<L, 6>(&slope[1], np, p));
            // D_a = sum_b dxi_b/dX_a d/dxi_b, from (xi1, xi2) slopes and the metric [b][a].
            let [m11, m12, m21, m22] = load_array::<L, 4>(&self.metric[4 * p..4 * p + 4]);
            let values = [
                a[4].mul_add(m11, b[4] * m21),
                a[4].mul_add(m12, b[4] * m22),
                a[5].mul_add(m11, b[5] * m21),
                a[5].mul_add(m12, b[5] * m22),
                a[0].mul_add(m11, b[0] * m21) + a[1].mul_add(m12, b[1] * m22),
                a[2].mul_add(m11, b[2] * m21) + a[3].mul_add(m12, b[3] * m22),
            ];
            scatter(values, rate, np, p);
        }
    }

    /// r_p += rho0 b at every time node.
    #[inline(always)]
    fn add_source<L: Lanes>(&self, rate: &mut [F8], source: &[F8]) {
        let np = self.matrices.points();
        if source.is_empty() {
            return;
        }
        for s in 0..self.time.len() {
            let momentum = &mut rate[s * 6 * np + 4 * np..(s + 1) * 6 * np];
            add_scaled::<L>(self.law.density(), &source[s * 2 * np..(s + 1) * 2 * np], momentum);
        }
    }

    /// u_s = U^n + dt sum_k At[s, k] r_k.
    #[inline(always)]
    fn integrate<L: Lanes>(&self, start: &[F8], rate: &[F8], u: &mut [F8]) {
        let (size, times) = (start.len(), self.time.len());
        for s in 0..times {
            let row = &self.time.integration[s * times..(s + 1) * times];
            for i in 0..size {
                let mut sum = L::load(&start[i]);
                for (k, entry) in row.iter().enumerate() {
                    sum = L::splat(self.dt * entry).mul_add(L::load(&rate[k * size + i]), sum);
                }
                sum.store(&mut u[s * size + i]);
            }
        }
    }

    /// Time averages of F, v and P = P(F) over the time nodes.
    #[inline(always)]
    fn average<L: Lanes>(&self, arrays: &mut Arrays) {
        let np = self.matrices.points();
        let inverse_density = L::splat(1.0 / self.law.density());
        for p in 0..np {
            let mut mean = [L::zero(); 10];
            for (s, &weight) in self.time.weights.iter().enumerate() {
                let [f11, f12, f21, f22, p1, p2] = gather::<L, 6>(&arrays.u[s * 6 * np..], np, p);
                let f = [f11, f12, f21, f22];
                let stress = self.law.stress(f, &mut []);
                let w = L::splat(weight);
                for k in 0..4 {
                    mean[k] = w.mul_add(f[k], mean[k]);
                    mean[6 + k] = w.mul_add(stress[k], mean[6 + k]);
                }
                mean[4] = w.mul_add(p1 * inverse_density, mean[4]);
                mean[5] = w.mul_add(p2 * inverse_density, mean[5]);
            }
            scatter(mean, &mut arrays.mean, np, p);
        }
    }
}
