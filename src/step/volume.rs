//! Volume term of the corrector (11), (12) and traces, from averages at the Gauss nodes.
//!
//! F rows in strong form (D v; `finish` adds the lifted jump of v), exact on uniform states; p rows in weak form. Both
//! are exact integrals on bilinear cells, so the two forms agree there to rounding.

use crate::lane::{F8, Lanes, Work, load_array, store_array};
use crate::material::{Law, Material};
use crate::operators::{Geometry, Line};
use crate::riemann::tangent;
use crate::tensor;
use crate::with_law;

/// Runs `$body` with `$nodes` bound to the constant M = N + 1: loops over the nodes of a line are unrolled. One `match` a
/// block and kernel.
macro_rules! with_nodes {
    ($m:expr, $nodes:ident => $body:expr) => {
        match $m {
            1 => with_nodes!(@ 1, $nodes, $body),
            2 => with_nodes!(@ 2, $nodes, $body),
            3 => with_nodes!(@ 3, $nodes, $body),
            4 => with_nodes!(@ 4, $nodes, $body),
            5 => with_nodes!(@ 5, $nodes, $body),
            6 => with_nodes!(@ 6, $nodes, $body),
            _ => with_nodes!(@ 7, $nodes, $body),
        }
    };
    (@ $value:literal, $nodes:ident, $body:expr) => {{
        const $nodes: usize = $value;
        $body
    }};
}
pub(super) use with_nodes;

/// Numbers of a trace: F, v, t, c_p, then c_s where the flux is one that looks at it (`shear`), then s = P T where the
/// balance is on (`metered`).
pub const fn width(shear: bool, metered: bool) -> usize {
    9 + shear as usize + 2 * metered as usize
}

/// Arrays of one block at its nodes.
#[derive(Default)]
pub struct Arrays {
    /// U of a Runge-Kutta stage, as in the state.
    pub stage: Vec<F8>,
    /// Averages of F and v, [node][6].
    pub mean: Vec<F8>,
    /// Averages of P, [node][4].
    pub mean_stress: Vec<F8>,
    /// Contravariant tractions J dxi_b/dX_a P_ia, [node][b][i].
    contravariant: Vec<F8>,
    /// Sources b, averaged over time, [2][node].
    pub source: Vec<F8>,
    /// Lifted numbers: [face][component][face point].
    pub lift: Vec<F8>,
    /// Traces across a face whose lanes lie apart.
    pub across: Vec<F8>,
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
            across: zeros(m * width(true, true)),
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

/// The first M rows of M numbers.
#[inline(always)]
fn square<const M: usize>(numbers: &[f64]) -> [[f64; M]; M] {
    let mut out = [[0.0; M]; M];
    for (out, row) in out.iter_mut().zip(numbers.as_chunks::<M>().0) {
        *out = *row;
    }
    out
}

/// dF_ia/dt = dv_i/dX_a, dp_i/dt = - sum_b K_a[., b] P_ia(b), into the first six components of `rate`.
pub struct Volume<'a, const M: usize> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The block.
    pub metric: Metric<'a>,
    /// Averages in.
    pub arrays: &'a mut Arrays,
    /// dU/dt of the block, out.
    pub rate: &'a mut [F8],
}

impl<const M: usize> Work for Volume<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let n = M * M;
        let cofactor = &self.metric.cofactor.as_chunks::<4>().0[..n];
        let stress = &self.arrays.mean_stress.as_chunks::<4>().0[..n];
        let contravariant = &mut self.arrays.contravariant.as_chunks_mut::<4>().0[..n];
        for a in 0..n {
            let (c, p) = (load_array::<L, 4>(&cofactor[a]), load_array::<L, 4>(&stress[a]));
            for b in 0..2 {
                for i in 0..2 {
                    let t = c[2 * b].mul_add(p[2 * i], c[2 * b + 1] * p[2 * i + 1]);
                    t.store(&mut contravariant[a][2 * b + i]);
                }
            }
        }
        self.strong::<L>();
        self.weak::<L>();
    }
}

impl<const M: usize> Volume<'_, M> {
    /// Rows of F: D v.
    #[inline(always)]
    fn strong<L: Lanes>(&mut self) {
        let slope = square::<M>(&self.line.slope);
        let n = M * M;
        let (mean, rate) = (&self.arrays.mean.as_chunks::<6>().0[..n], &mut self.rate[..4 * n]);
        let cofactor = &self.metric.cofactor.as_chunks::<4>().0[..n];
        let scale = Scale::<M>::of(self.line, self.metric);
        for i in 0..M {
            for j in 0..M {
                let a = i * M + j;
                let mut d = [[L::zero(); 2]; 2];
                for k in 0..M {
                    let along = [L::splat(slope[i][k]), L::splat(slope[j][k])];
                    let v = [&mean[k * M + j], &mean[i * M + k]];
                    for r in 0..2 {
                        d[r][0] = along[0].mul_add(L::load(&v[0][4 + r]), d[r][0]);
                        d[r][1] = along[1].mul_add(L::load(&v[1][4 + r]), d[r][1]);
                    }
                }
                let (c, scale) = (load_array::<L, 4>(&cofactor[a]), scale.at::<L>(i, j));
                for r in 0..2 {
                    for axis in 0..2 {
                        let gradient = d[r][0].mul_add(c[axis], d[r][1] * c[2 + axis]);
                        (gradient * scale).store(&mut rate[(2 * r + axis) * n + a]);
                    }
                }
            }
        }
    }

    /// Rows of p in weak form.
    #[inline(always)]
    fn weak<L: Lanes>(&mut self) {
        let weak = square::<M>(&self.line.weak);
        let n = M * M;
        let (traction, rate) = (&self.arrays.contravariant.as_chunks::<4>().0[..n], &mut self.rate[4 * n..6 * n]);
        let scale = Scale::<M>::of(self.line, self.metric);
        for i in 0..M {
            for j in 0..M {
                let mut sum = [[L::zero(); 2]; 2];
                for k in 0..M {
                    let along = [L::splat(weak[i][k]), L::splat(weak[j][k])];
                    let t = [&traction[k * M + j], &traction[i * M + k]];
                    for r in 0..2 {
                        sum[r][0] = along[0].mul_add(L::load(&t[0][r]), sum[r][0]);
                        sum[r][1] = along[1].mul_add(L::load(&t[1][2 + r]), sum[r][1]);
                    }
                }
                let scale = scale.at::<L>(i, j);
                for r in 0..2 {
                    (-((sum[r][0] + sum[r][1]) * scale)).store(&mut rate[r * n + i * M + j]);
                }
            }
        }
    }
}

/// 1 / J_a = w_a / (w_a J_a).
struct Scale<'a, const M: usize> {
    weights: [f64; M],
    inverse_mass: &'a [F8],
}

impl<'a, const M: usize> Scale<'a, M> {
    #[inline(always)]
    fn of(line: &Line, metric: Metric<'a>) -> Self {
        Self { weights: row(&line.basis.weights), inverse_mass: &metric.inverse_mass[..M * M] }
    }

    #[inline(always)]
    fn at<L: Lanes>(&self, i: usize, j: usize) -> L {
        L::splat(self.weights[i] * self.weights[j]) * L::load(&self.inverse_mass[i * M + j])
    }
}

/// The first M numbers.
#[inline(always)]
pub fn row<const M: usize>(numbers: &[f64]) -> [f64; M] {
    let mut out = [0.0; M];
    for (out, x) in out.iter_mut().zip(numbers) {
        *out = *x;
    }
    out
}

/// Traces of all faces but for the speeds, from the averages at the nodes.
pub struct Traces<'a, const M: usize> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The block.
    pub metric: Metric<'a>,
    /// Averages in.
    pub arrays: &'a Arrays,
    /// Numbers of a trace, see [`width`].
    pub width: usize,
    /// Whether s = P T is wanted.
    pub metered: bool,
    /// [face][point][`width`], out.
    pub traces: &'a mut [F8],
}

impl<const M: usize> Work for Traces<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        for face in 0..2 {
            self.of_face::<L, true>(face);
        }
        for face in 2..4 {
            self.of_face::<L, false>(face);
        }
    }
}

impl<const M: usize> Traces<'_, M> {
    /// Those of a face that xi1 runs towards (FIRST), or xi2.
    #[inline(always)]
    fn of_face<L: Lanes, const FIRST: bool>(&mut self, face: usize) {
        let ends = row::<M>(&self.line.ends[face % 2]);
        let normal = load_array::<L, 2>(&self.metric.normal[2 * face..2 * face + 2]);
        let mean = &self.arrays.mean.as_chunks::<6>().0[..M * M];
        let mean_stress = &self.arrays.mean_stress.as_chunks::<4>().0[..M * M];
        let width = self.width;
        let out = &mut self.traces[face * M * width..(face + 1) * M * width];
        for (point, out) in out.chunks_exact_mut(width).enumerate().take(M) {
            let mut stress = [L::zero(); 4];
            for k in 0..M {
                let values = &mean_stress[if FIRST { k * M + point } else { point * M + k }];
                let end = L::splat(ends[k]);
                for e in 0..4 {
                    stress[e] = end.mul_add(L::load(&values[e]), stress[e]);
                }
            }
            store_array(tensor::times(stress, normal), &mut out[6..8]);
            if self.metered {
                store_array(tensor::times(stress, tangent(normal)), &mut out[width - 2..]);
            }
            let mut sum = [L::zero(); 6];
            for k in 0..M {
                let values = &mean[if FIRST { k * M + point } else { point * M + k }];
                let end = L::splat(ends[k]);
                for e in 0..6 {
                    sum[e] = end.mul_add(L::load(&values[e]), sum[e]);
                }
            }
            store_array(sum, &mut out[..6]);
        }
    }
}

/// The speeds of all traces: those of the averaged F.
pub struct Speeds<'a> {
    /// The law.
    pub law: &'a Law,
    /// Outward normals, [face][2].
    pub normal: &'a [F8],
    /// Numbers of a trace, see [`width`].
    pub width: usize,
    /// Whether c_s is wanted.
    pub shear: bool,
    /// [face][point][`width`]; F in, c out.
    pub traces: &'a mut [F8],
}

impl Work for Speeds<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        with_law!(self.law, law => self.with::<L, _>(law));
    }
}

impl Speeds<'_> {
    #[inline(always)]
    fn with<L: Lanes, M: Material>(self, law: &M) {
        let points = self.traces.len() / (4 * self.width);
        for (face, traces) in self.traces.chunks_exact_mut(points * self.width).enumerate() {
            let normal = load_array::<L, 2>(&self.normal[2 * face..2 * face + 2]);
            for trace in traces.chunks_exact_mut(self.width) {
                let f = load_array::<L, 4>(&trace[..4]);
                if self.shear {
                    store_array(law.speeds(f, normal), &mut trace[8..10]);
                } else {
                    law.pressure_speed(f, normal).store(&mut trace[8]);
                }
            }
        }
    }
}
