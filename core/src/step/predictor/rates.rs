//! Derivatives of the predictor at the points of a block: r = (Grad v, Div P) of one time node.

use crate::lane::{Coefficient, F8, Lanes, Work, load_array, store_array};
use crate::operators::{Matrix, PointMatrices};
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// The rates of one time node from Q, with the derivatives of chi. A [`Work`] of its own, so that it is compiled once,
/// not once a law.
///
/// Q is [a1, a2, v1, v2, b1, b2] at each point: a_i is differentiated along the first, b_i along the second direction
/// for row i of the divergence, v_i along both. Three cases, by the number of metric terms:
/// - none: the matrices hold derivatives along X1, X2; (a, b) = (P_i1, P_i2);
/// - 4, the same for all points (affine cells): (a, b) are along xi1, xi2, turned before; v is turned behind;
/// - 4 a point: P is differentiated along both directions.
///
/// The output is (D1 v1, D2 v1, D1 v2, D2 v2, D1 P11 + D2 P12, D1 P21 + D2 P22), `[p][6]`.
pub struct Rates<'a, C> {
    /// Matrices of the points.
    pub matrices: &'a PointMatrices<C>,
    /// dxi_b/dX_a, `[point][b][a]`.
    pub metric: &'a [F8],
    /// Q, `[p][6]`.
    pub q: &'a [F8],
    /// The rates (out), `[p][6]`.
    pub out: &'a mut [F8],
}

impl<C: Coefficient> Work for Rates<'_, C> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Rates { matrices, metric, q, out } = self;
        let (q, out) = (q.as_chunks::<UNKNOWNS>().0, out.as_chunks_mut::<UNKNOWNS>().0);
        match matrices {
            PointMatrices::Dense { slope, .. } => dense::<L, C>(slope, metric, q, out),
            PointMatrices::Lattice([a, b]) => lattices::<L, C>([&a.slope, &b.slope], metric, q, out),
            PointMatrices::Nodes(slope) => lattices::<L, C>([slope, slope], metric, q, out),
        }
    }
}

/// The number of points per direction as a constant where it is one of those in use: short loops are unrolled.
#[inline(always)]
fn lattices<L: Lanes, C: Coefficient>(
    slope: [&Matrix<C>; 2],
    metric: &[F8],
    q: &[[F8; UNKNOWNS]],
    out: &mut [[F8; UNKNOWNS]],
) {
    let d = [&slope[0].data[..], &slope[1].data[..]];
    match slope[0].rows {
        1 => lattice::<L, C>(1, d, metric, q, out),
        2 => lattice::<L, C>(2, d, metric, q, out),
        3 => lattice::<L, C>(3, d, metric, q, out),
        4 => lattice::<L, C>(4, d, metric, q, out),
        5 => lattice::<L, C>(5, d, metric, q, out),
        6 => lattice::<L, C>(6, d, metric, q, out),
        7 => lattice::<L, C>(7, d, metric, q, out),
        8 => lattice::<L, C>(8, d, metric, q, out),
        k => lattice::<L, C>(k, d, metric, q, out),
    }
}

/// A line of points of the cell, and the derivatives along it at one of them.
struct Stencil<'a, C> {
    entries: &'a [C],
    first: usize,
    stride: usize,
}

/// Sum factorisation: derivatives of chi along xi1, xi2 are 1D matrices `d`, k x k, along lines of points.
#[inline(always)]
fn lattice<L: Lanes, C: Coefficient>(
    k: usize,
    d: [&[C]; 2],
    metric: &[F8],
    q: &[[F8; UNKNOWNS]],
    out: &mut [[F8; UNKNOWNS]],
) {
    let (d, q, out) = ([&d[0][..k * k], &d[1][..k * k]], &q[..k * k], &mut out[..k * k]);
    let constant = (metric.len() == DEFORMATION).then(|| load_array::<L, DEFORMATION>(metric));
    for i in 0..k {
        for j in 0..k {
            let first = Stencil { entries: &d[0][i * k..(i + 1) * k], first: j, stride: k };
            let second = Stencil { entries: &d[1][j * k..(j + 1) * k], first: i * k, stride: 1 };
            let p = i * k + j;
            let rate = match constant {
                Some(metric) => turned(eight::<L, C>(first, second, q), metric),
                None => twelve::<L, C>(&first, &second, q, &metric[DEFORMATION * p..DEFORMATION * (p + 1)]),
            };
            store_array(rate, &mut out[p]);
        }
    }
}

/// Any cloud: derivatives at a point are rows over all points of the cell.
#[inline(always)]
fn dense<L: Lanes, C: Coefficient>(
    slope: &[Matrix<C>; 2],
    metric: &[F8],
    q: &[[F8; UNKNOWNS]],
    out: &mut [[F8; UNKNOWNS]],
) {
    let constant = (metric.len() == DEFORMATION).then(|| load_array::<L, DEFORMATION>(metric));
    for (p, out) in out.iter_mut().enumerate() {
        let first = Stencil { entries: slope[0].row(p), first: 0, stride: 1 };
        let second = Stencil { entries: slope[1].row(p), first: 0, stride: 1 };
        let rate = match constant {
            Some(metric) => turned(eight::<L, C>(first, second, q), metric),
            None if metric.is_empty() => straight(eight::<L, C>(first, second, q)),
            None => twelve::<L, C>(&first, &second, q, &metric[DEFORMATION * p..DEFORMATION * (p + 1)]),
        };
        store_array(rate, out);
    }
}

/// [d1 v1, d1 v2, d2 v1, d2 v2, d1 a1 + d2 b1, d1 a2 + d2 b2] at a point: 12 of 16 registers hold sums.
#[inline(always)]
fn eight<L: Lanes, C: Coefficient>(first: Stencil<C>, second: Stencil<C>, q: &[[F8; UNKNOWNS]]) -> [L; UNKNOWNS] {
    let mut sum = [L::zero(); UNKNOWNS];
    for (k, entry) in first.entries.iter().enumerate() {
        let (entry, q) = (entry.lanes::<L>(), &q[first.first + k * first.stride]);
        sum[4] = entry.mul_add(L::load(&q[0]), sum[4]);
        sum[5] = entry.mul_add(L::load(&q[1]), sum[5]);
        sum[0] = entry.mul_add(L::load(&q[2]), sum[0]);
        sum[1] = entry.mul_add(L::load(&q[3]), sum[1]);
    }
    for (k, entry) in second.entries.iter().enumerate() {
        let (entry, q) = (entry.lanes::<L>(), &q[second.first + k * second.stride]);
        sum[2] = entry.mul_add(L::load(&q[2]), sum[2]);
        sum[3] = entry.mul_add(L::load(&q[3]), sum[3]);
        sum[4] = entry.mul_add(L::load(&q[4]), sum[4]);
        sum[5] = entry.mul_add(L::load(&q[5]), sum[5]);
    }
    sum
}

/// Matrices along X1, X2: nothing to turn.
#[inline(always)]
fn straight<L: Lanes>(sum: [L; UNKNOWNS]) -> [L; UNKNOWNS] {
    [sum[0], sum[2], sum[1], sum[3], sum[4], sum[5]]
}

/// D_a v = sum_b dxi_b/dX_a d_b v with the metric [b][a]; the divergence is done already.
#[inline(always)]
fn turned<L: Lanes>(sum: [L; UNKNOWNS], m: [L; 4]) -> [L; UNKNOWNS] {
    [
        sum[0].mul_add(m[0], sum[2] * m[2]),
        sum[0].mul_add(m[1], sum[2] * m[3]),
        sum[1].mul_add(m[0], sum[3] * m[2]),
        sum[1].mul_add(m[1], sum[3] * m[3]),
        sum[4],
        sum[5],
    ]
}

/// All six fields along both directions, then the metric of the point. Two fields at a time: 8 of 16 registers.
#[inline(always)]
fn twelve<L: Lanes, C: Coefficient>(
    first: &Stencil<C>,
    second: &Stencil<C>,
    q: &[[F8; UNKNOWNS]],
    metric: &[F8],
) -> [L; UNKNOWNS] {
    let a = pair::<L, C, 0>(first, second, q);
    let [m11, m12, m21, m22] = load_array::<L, DEFORMATION>(metric);
    let (div1, div2) = (a[0].mul_add(m11, a[2] * m21), a[1].mul_add(m11, a[3] * m21));
    let b = pair::<L, C, 4>(first, second, q);
    let (div1, div2) = (b[0].mul_add(m12, b[2].mul_add(m22, div1)), b[1].mul_add(m12, b[3].mul_add(m22, div2)));
    let v = pair::<L, C, 2>(first, second, q);
    turned([v[0], v[1], v[2], v[3], div1, div2], [m11, m12, m21, m22])
}

/// Fields F and F + 1: [d1, d1, d2, d2].
#[inline(always)]
fn pair<L: Lanes, C: Coefficient, const F: usize>(
    first: &Stencil<C>,
    second: &Stencil<C>,
    q: &[[F8; UNKNOWNS]],
) -> [L; 4] {
    let mut sum = [L::zero(); 4];
    for (k, entry) in first.entries.iter().enumerate() {
        let (entry, q) = (entry.lanes::<L>(), &q[first.first + k * first.stride]);
        sum[0] = entry.mul_add(L::load(&q[F]), sum[0]);
        sum[1] = entry.mul_add(L::load(&q[F + 1]), sum[1]);
    }
    for (k, entry) in second.entries.iter().enumerate() {
        let (entry, q) = (entry.lanes::<L>(), &q[second.first + k * second.stride]);
        sum[2] = entry.mul_add(L::load(&q[F]), sum[2]);
        sum[3] = entry.mul_add(L::load(&q[F + 1]), sum[3]);
    }
    sum
}
