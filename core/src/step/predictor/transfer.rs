//! Transfer of fields between the nodes and the points of a block: G2P (22) and P2G (18).

use super::super::dense::{apply, interleave};
use crate::lane::{Coefficient, F8, Lanes, Work, store_array};
use crate::operators::{Matrix, PointMatrices};

/// K fields from nodes to points, as in the state to [p][K]: U_p = sum_a Phi_a(X_p) U_a.
pub struct FieldsToPoints<'a, C, const K: usize> {
    /// Matrices of the points.
    pub matrices: &'a PointMatrices<C>,
    /// At the nodes, [field][node], no more than K fields.
    pub fields: &'a [F8],
    /// Scratch of as many numbers.
    pub nodes: &'a mut [F8],
    /// Scratch of [`factors`] numbers.
    pub between: &'a mut [F8],
    /// At the points (out).
    pub points: &'a mut [F8],
}

impl<C: Coefficient, const K: usize> Work for FieldsToPoints<'_, C, K> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let FieldsToPoints { matrices, fields, nodes, between, points } = self;
        let n = fields.len() / K;
        match matrices {
            PointMatrices::Dense { from_nodes, .. } => {
                interleave::<K>(fields, n, nodes);
                apply::<L, C, K>(from_nodes, &nodes[..K * n], points);
            }
            PointMatrices::Lattice([a, b]) => {
                product::<L, C, K, true>([&a.from_nodes, &b.from_nodes], fields, between, points);
            }
            PointMatrices::Nodes(_) => interleave::<K>(fields, n, points),
        }
    }
}

/// K fields from nodes to points, [a][K] to [p][K]: U_p = sum_a Phi_a(X_p) U_a.
///
/// Transfers are [`Work`] of their own, so that they are compiled once, not once a law.
pub struct ToPoints<'a, C, const K: usize> {
    /// Matrices of the points.
    pub matrices: &'a PointMatrices<C>,
    /// At the nodes.
    pub nodes: &'a [F8],
    /// Scratch of [`factors`] numbers.
    pub between: &'a mut [F8],
    /// At the points (out).
    pub points: &'a mut [F8],
}

impl<C: Coefficient, const K: usize> Work for ToPoints<'_, C, K> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let ToPoints { matrices, nodes, between, points } = self;
        match matrices {
            PointMatrices::Dense { from_nodes, .. } => apply::<L, C, K>(from_nodes, nodes, points),
            PointMatrices::Lattice([a, b]) => {
                product::<L, C, K, false>([&a.from_nodes, &b.from_nodes], nodes, between, points)
            }
            PointMatrices::Nodes(_) => points[..nodes.len()].copy_from_slice(nodes),
        }
    }
}

/// K fields from points to nodes, [p][K] to [a][K]: U_a = sum_p chi_p(X_a) U_p.
pub struct ToNodes<'a, C, const K: usize> {
    /// Matrices of the points.
    pub matrices: &'a PointMatrices<C>,
    /// At the points.
    pub points: &'a [F8],
    /// Scratch of [`factors`] numbers.
    pub between: &'a mut [F8],
    /// At the nodes (out).
    pub nodes: &'a mut [F8],
}

impl<C: Coefficient, const K: usize> Work for ToNodes<'_, C, K> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let ToNodes { matrices, points, between, nodes } = self;
        match matrices {
            PointMatrices::Dense { to_nodes, .. } => apply::<L, C, K>(to_nodes, points, nodes),
            PointMatrices::Lattice([a, b]) => {
                product::<L, C, K, false>([&a.to_nodes, &b.to_nodes], points, between, nodes)
            }
            PointMatrices::Nodes(_) => {
                let len = nodes.len();
                nodes.copy_from_slice(&points[..len])
            }
        }
    }
}

/// Numbers between the two factors of a transfer of `fields` fields, for m nodes a direction and at most `points`
/// points a cell.
pub fn factors(m: usize, points: usize, fields: usize) -> usize {
    m * points.isqrt() * fields
}

/// out[r][s] = sum_c sum_d first[r][c] second[s][d] input[c][d], K fields each; along xi2 first. The input may be one field
/// behind the other (BY_FIELD).
#[inline(always)]
fn product<L: Lanes, C: Coefficient, const K: usize, const BY_FIELD: bool>(
    [first, second]: [&Matrix<C>; 2],
    input: &[F8],
    between: &mut [F8],
    out: &mut [F8],
) {
    // Rows and columns as constants where points are as many as nodes per direction: short loops are unrolled.
    match (first.rows, first.columns) {
        (2, 2) => factored::<L, C, K, BY_FIELD>(2, 2, [&first.data, &second.data], input, between, out),
        (3, 3) => factored::<L, C, K, BY_FIELD>(3, 3, [&first.data, &second.data], input, between, out),
        (4, 4) => factored::<L, C, K, BY_FIELD>(4, 4, [&first.data, &second.data], input, between, out),
        (5, 5) => factored::<L, C, K, BY_FIELD>(5, 5, [&first.data, &second.data], input, between, out),
        (r, c) => factored::<L, C, K, BY_FIELD>(r, c, [&first.data, &second.data], input, between, out),
    }
}

#[inline(always)]
fn factored<L: Lanes, C: Coefficient, const K: usize, const BY_FIELD: bool>(
    r: usize,
    c: usize,
    [first, second]: [&[C]; 2],
    input: &[F8],
    between: &mut [F8],
    out: &mut [F8],
) {
    let (first, second) = (&first[..r * c], &second[..r * c]);
    let (input, between) = (&input[..K * c * c], &mut between.as_chunks_mut::<K>().0[..c * r]);
    let out = &mut out.as_chunks_mut::<K>().0[..r * r];
    for i in 0..c {
        for s in 0..r {
            let mut sum = [L::zero(); K];
            for d in 0..c {
                let entry = second[s * c + d].lanes::<L>();
                let node = i * c + d;
                for (k, sum) in sum.iter_mut().enumerate() {
                    let at = if BY_FIELD { k * c * c + node } else { node * K + k };
                    *sum = entry.mul_add(L::load(&input[at]), *sum);
                }
            }
            store_array(sum, &mut between[i * r + s]);
        }
    }
    for i in 0..r {
        for s in 0..r {
            let mut sum = [L::zero(); K];
            for d in 0..c {
                let entry = first[i * c + d].lanes::<L>();
                for k in 0..K {
                    sum[k] = entry.mul_add(L::load(&between[d * r + s][k]), sum[k]);
                }
            }
            store_array(sum, &mut out[i * r + s]);
        }
    }
}
