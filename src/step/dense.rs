//! Products of operator matrices with fields of a block.

use crate::lane::{Coefficient, F8, Lanes};
use crate::operators::Matrix;

/// out[k][r] = sum_c matrix[r][c] input[k][c] for K fields; a field of `input` has `matrix.columns` numbers, one of
/// `out` has `matrix.rows`.
#[inline(always)]
pub fn apply<L: Lanes, C: Coefficient, const K: usize>(matrix: &Matrix<C>, input: &[F8], out: &mut [F8]) {
    let (rows, columns) = (matrix.rows, matrix.columns);
    let input = &input[..K * columns];
    for r in 0..rows {
        let mut sum = [L::zero(); K];
        for (c, entry) in matrix.row(r).iter().enumerate() {
            let entry = entry.lanes::<L>();
            for k in 0..K {
                sum[k] = entry.mul_add(L::load(&input[k * columns + c]), sum[k]);
            }
        }
        for k in 0..K {
            sum[k].store(&mut out[k * rows + r]);
        }
    }
}

/// y += a x.
#[inline(always)]
pub fn add_scaled<L: Lanes>(a: f64, x: &[F8], y: &mut [F8]) {
    let a = L::splat(a);
    for (y, x) in y.iter_mut().zip(x) {
        a.mul_add(L::load(x), L::load(y)).store(y);
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

/// Writes the numbers of K fields of length `len` at index i.
#[inline(always)]
pub fn scatter<L: Lanes, const K: usize>(values: [L; K], fields: &mut [F8], len: usize, i: usize) {
    for (k, value) in values.into_iter().enumerate() {
        value.store(&mut fields[k * len + i]);
    }
}
