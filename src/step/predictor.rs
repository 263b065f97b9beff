//! The local predictor (15)-(21): a space-time collocation at the points of each cell, blind to its neighbours.

use super::dense::apply;
use crate::basis::TimeBasis;
use crate::lane::{Coefficient, F8, Lanes, load_array, store_array};
use crate::material::Material;
use crate::operators::PointMatrices;

/// Arrays of one block at its points; [point][field] each, those of time nodes with the node outermost.
#[derive(Default)]
pub struct Arrays {
    /// U_p^n.
    pub start: Vec<F8>,
    /// u_s,p, [s][p][6].
    u: Vec<F8>,
    /// r_s,p, [s][p][6].
    rate: Vec<F8>,
    /// Q = (P, v) of one time node, [p][6].
    q: Vec<F8>,
    /// Its derivatives along xi1, xi2.
    slope: [Vec<F8>; 2],
    /// Sources b at points and time nodes, [s][p][2]; empty without sources.
    pub source: Vec<F8>,
    /// Time averages of F and v, [p][6].
    pub mean: Vec<F8>,
    /// Time averages of P, [p][4].
    pub mean_stress: Vec<F8>,
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
            mean: zeros(6),
            mean_stress: zeros(4),
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
        for (u, q) in u.as_chunks::<6>().0.iter().zip(q.as_chunks_mut::<6>().0) {
            let [f11, f12, f21, f22, p1, p2] = load_array::<L, 6>(u);
            let stress = self.law.stress([f11, f12, f21, f22], &mut []);
            let v = [p1 * inverse_density, p2 * inverse_density];
            store_array([stress[0], stress[1], stress[2], stress[3], v[0], v[1]], q);
        }
        apply::<L, C, 6>(&self.matrices.slope[0], q, &mut slope[0]);
        apply::<L, C, 6>(&self.matrices.slope[1], q, &mut slope[1]);
        for p in 0..np {
            let at = 6 * p..6 * p + 6;
            let (a, b) = (load_array::<L, 6>(&slope[0][at.clone()]), load_array::<L, 6>(&slope[1][at.clone()]));
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
            store_array(values, &mut rate[at]);
        }
    }

    /// r_p += rho0 b at every time node.
    #[inline(always)]
    fn add_source<L: Lanes>(&self, rate: &mut [F8], source: &[F8]) {
        let density = L::splat(self.law.density());
        for (rate, source) in rate.as_chunks_mut::<6>().0.iter_mut().zip(source.as_chunks::<2>().0) {
            density.mul_add(L::load(&source[0]), L::load(&rate[4])).store(&mut rate[4]);
            density.mul_add(L::load(&source[1]), L::load(&rate[5])).store(&mut rate[5]);
        }
    }

    /// u_s = U^n + dt sum_k At[s, k] r_k.
    #[inline(always)]
    fn integrate<L: Lanes>(&self, start: &[F8], rate: &[F8], u: &mut [F8]) {
        let (size, times) = (start.len(), self.time.len());
        for (s, u) in u.chunks_exact_mut(size).take(times).enumerate() {
            for (k, rate) in rate.chunks_exact(size).take(times).enumerate() {
                let factor = L::splat(self.dt * self.time.integration[s * times + k]);
                // The first node starts from U^n, the others add to it.
                if k == 0 {
                    for (u, (start, rate)) in u.iter_mut().zip(start.iter().zip(rate)) {
                        factor.mul_add(L::load(rate), L::load(start)).store(u);
                    }
                } else {
                    for (u, rate) in u.iter_mut().zip(rate) {
                        factor.mul_add(L::load(rate), L::load(u)).store(u);
                    }
                }
            }
        }
    }

    /// Time averages of F, v and P = P(F) over the time nodes.
    #[inline(always)]
    fn average<L: Lanes>(&self, arrays: &mut Arrays) {
        let np = self.matrices.points();
        let inverse_density = L::splat(1.0 / self.law.density());
        for p in 0..np {
            let (mut mean, mut mean_stress) = ([L::zero(); 6], [L::zero(); 4]);
            for (s, &weight) in self.time.weights.iter().enumerate() {
                let [f11, f12, f21, f22, p1, p2] = load_array::<L, 6>(&arrays.u[6 * (s * np + p)..]);
                let values = [f11, f12, f21, f22, p1 * inverse_density, p2 * inverse_density];
                let stress = self.law.stress([f11, f12, f21, f22], &mut []);
                let w = L::splat(weight);
                for k in 0..6 {
                    mean[k] = w.mul_add(values[k], mean[k]);
                }
                for k in 0..4 {
                    mean_stress[k] = w.mul_add(stress[k], mean_stress[k]);
                }
            }
            store_array(mean, &mut arrays.mean[6 * p..6 * p + 6]);
            store_array(mean_stress, &mut arrays.mean_stress[4 * p..4 * p + 4]);
        }
    }
}
