//! Products of operator matrices with fields of a block.

use crate::lane::{Coefficient, F8, Lanes, store_array};
use crate::operators::Matrix;

/// out[r][k] = sum_c matrix[r][c] input[c][k] for K fields that lie behind each other at each point.
#[inline(always)]
pub fn apply<L: Lanes, C: Coefficient, const K: usize>(matrix: &Matrix<C>, input: &[F8], out: &mut [F8]) {
    let (input, out) = (input.as_chunks::<K>().0, out.as_chunks_mut::<K>().0);
    for (row, out) in matrix.data.chunks_exact(matrix.columns.max(1)).zip(out) {
        let mut sum = [L::zero(); K];
        for (entry, values) in row.iter().zip(input) {
            let entry = entry.lanes::<L>();
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum = entry.mul_add(L::load(value), *sum);
            }
        }
        store_array(sum, out);
    }
}

/// From [field][node] as in the state to [node][field], for K fields.
#[inline(always)]
pub fn interleave<const K: usize>(fields: &[F8], nodes: usize, out: &mut [F8]) {
    for (a, out) in out.as_chunks_mut::<K>().0.iter_mut().take(nodes).enumerate() {
        for (k, out) in out.iter_mut().enumerate() {
            *out = fields[k * nodes + a];
        }
    }
}

/// The numbers of field k at index i, for K fields of length `len`.
#[inline(always)]
pub fn gather<L: Lanes, const K: usize>(fields: &[F8], len: usize, i: usize) -> [L; K] {
    let mut out = [L::zero(); K];
    for k in 0..K {
        out[k] = L::load(&fields[k * len + i]);
    }
    out
}
