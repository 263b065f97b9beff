//! Volume term of the corrector (11), (12) and traces, from averages at the Gauss nodes.
//!
//! F rows in strong form (D v; `finish` adds the lifted jump of v), exact on uniform states; p rows in weak form. Both
//! are exact integrals on bilinear cells, so the two forms agree there to rounding.

use crate::lane::{F8, Lanes, load_array, store_array};
use crate::material::Material;
use crate::operators::{Geometry, Line};
use crate::riemann::{TRACE, tangent};
use crate::tensor;

/// Arrays of one block at its nodes.
#[derive(Default)]
pub struct Arrays {
    /// U of a Runge-Kutta stage, as in the state.
    pub stage: Vec<F8>,
    /// Averages of F and v, [node][6].
    pub mean: Vec<F8>,
    /// Averages of P, [node][4].
    pub mean_stress: Vec<F8>,
    /// Contravariant tractions J dxi_b/dX_a P_ia, [b][i][node].
    contravariant: Vec<F8>,
    /// Sources b, averaged over time, [2][node].
    pub source: Vec<F8>,
    /// Lifted numbers: [face][component][face point].
    pub lift: Vec<F8>,
    /// Rows of F in the weighted inner product, and their coefficients, for the curl-free projection.
    pub weighted: Vec<F8>,
    /// Coefficients of the complement, [row][column].
    pub coefficients: Vec<F8>,
}

impl Arrays {
    /// For M nodes a direction and `components` components of the state.
    pub fn new(m: usize, components: usize) -> Self {
        let zeros = |count: usize| vec![F8::ZERO; count];
        let n = m * m;
        Self {
            stage: zeros(components * n),
            mean: zeros(6 * n),
            mean_stress: zeros(4 * n),
            contravariant: zeros(4 * n),
            source: zeros(2 * n),
            lift: zeros(4 * 6 * m),
            weighted: zeros(4 * n),
            coefficients: zeros(4 * n),
        }
    }
}

/// Geometry of one block.
#[derive(Clone, Copy)]
pub struct Metric<'a> {
    /// J dxi_b/dX_a, [node][b][a].
    pub cofactor: &'a [F8],
    /// 1 / (w_a J_a).
    pub inverse_mass: &'a [F8],
    /// w_a J_a.
    pub mass: &'a [F8],
    /// Outward normals, [face][2].
    pub normal: &'a [F8],
    /// Lengths of the faces.
    pub length: &'a [F8],
}

impl<'a> Metric<'a> {
    /// That of a block with n nodes a cell.
    pub fn of(geometry: &'a Geometry, block: usize, n: usize) -> Self {
        Self {
            cofactor: &geometry.cofactor[4 * n * block..4 * n * (block + 1)],
            inverse_mass: &geometry.inverse_mass[n * block..n * (block + 1)],
            mass: &geometry.mass[n * block..n * (block + 1)],
            normal: &geometry.normal[8 * block..8 * (block + 1)],
            length: &geometry.length[4 * block..4 * (block + 1)],
        }
    }
}

/// dF_ia/dt = dv_i/dX_a, dp_i/dt = - sum_b K_a[., b] P_ia(b), into the first six components of `rate`.
#[inline(always)]
pub fn volume<L: Lanes>(line: &Line, metric: Metric, arrays: &mut Arrays, rate: &mut [F8]) {
    let (m, n) = (line.m, line.m * line.m);
    for a in 0..n {
        let c = load_array::<L, 4>(&metric.cofactor[4 * a..4 * a + 4]);
        let p = load_array::<L, 4>(&arrays.mean_stress[4 * a..4 * a + 4]);
        for b in 0..2 {
            for i in 0..2 {
                let t = c[2 * b].mul_add(p[2 * i], c[2 * b + 1] * p[2 * i + 1]);
                t.store(&mut arrays.contravariant[(2 * b + i) * n + a]);
            }
        }
    }
    for i in 0..m {
        for j in 0..m {
            let a = i * m + j;
            let weight = L::splat(line.basis.weights[i] * line.basis.weights[j]);
            let inverse_mass = L::load(&metric.inverse_mass[a]);
            let c = load_array::<L, 4>(&metric.cofactor[4 * a..4 * a + 4]);
            let mut slope = [[L::zero(); 2]; 2];
            let mut weak = [L::zero(); 2];
            for k in 0..m {
                let (along1, along2) = (k * m + j, i * m + k);
                let d = [L::splat(line.slope[i * m + k]), L::splat(line.slope[j * m + k])];
                let w = [L::splat(line.weak[i * m + k]), L::splat(line.weak[j * m + k])];
                for r in 0..2 {
                    slope[r][0] = d[0].mul_add(L::load(&arrays.mean[6 * along1 + 4 + r]), slope[r][0]);
                    slope[r][1] = d[1].mul_add(L::load(&arrays.mean[6 * along2 + 4 + r]), slope[r][1]);
                    weak[r] = w[0].mul_add(L::load(&arrays.contravariant[r * n + along1]), weak[r]);
                    weak[r] = w[1].mul_add(L::load(&arrays.contravariant[(2 + r) * n + along2]), weak[r]);
                }
            }
            let scale = weight * inverse_mass;
            for r in 0..2 {
                for axis in 0..2 {
                    let gradient = slope[r][0].mul_add(c[axis], slope[r][1] * c[2 + axis]);
                    (gradient * scale).store(&mut rate[(2 * r + axis) * n + a]);
                }
                (-(weak[r] * scale)).store(&mut rate[(4 + r) * n + a]);
            }
        }
    }
}

/// Traces of all faces from the averages at the nodes; the speeds are those of the averaged F. Where a trace has more
/// than [`TRACE`] numbers (W), s = P T is behind them.
#[inline(always)]
pub fn traces<L: Lanes, M: Material, const W: usize>(
    law: &M,
    line: &Line,
    metric: Metric,
    arrays: &Arrays,
    traces: &mut [F8],
) {
    let m = line.m;
    for face in 0..4 {
        let ends = &line.ends[face % 2];
        let normal = load_array::<L, 2>(&metric.normal[2 * face..2 * face + 2]);
        for point in 0..m {
            let (mut sum, mut stress) = ([L::zero(); 6], [L::zero(); 4]);
            for (k, &end) in ends.iter().enumerate() {
                let a = if face < 2 { k * m + point } else { point * m + k };
                let end = L::splat(end);
                for (sum, value) in sum.iter_mut().zip(&arrays.mean[6 * a..6 * a + 6]) {
                    *sum = end.mul_add(L::load(value), *sum);
                }
                for (sum, value) in stress.iter_mut().zip(&arrays.mean_stress[4 * a..4 * a + 4]) {
                    *sum = end.mul_add(L::load(value), *sum);
                }
            }
            let f = [sum[0], sum[1], sum[2], sum[3]];
            let t = tensor::times(stress, normal);
            let c = law.speeds(f, normal);
            let values = [f[0], f[1], f[2], f[3], sum[4], sum[5], t[0], t[1], c[0], c[1]];
            let out = &mut traces[(face * m + point) * W..(face * m + point + 1) * W];
            for (value, out) in values.into_iter().zip(&mut out[..TRACE]) {
                value.store(out);
            }
            if W > TRACE {
                store_array(tensor::times(stress, tangent(normal)), &mut out[TRACE..W]);
            }
        }
    }
}
