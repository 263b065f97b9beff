//! Application of LCF, F <- F - theta C (C^T W F), to one block.

use crate::lane::{Coefficient, F8, Lane, Lanes};
use crate::operators::{Matrix, Pool, Share};

/// Memory of the projection.
pub struct Arrays<'a> {
    /// W F, [row i][direction][node].
    pub weighted: &'a mut [F8],
    /// C^T W F, [row i][column].
    pub coefficients: &'a mut [F8],
}

/// (-1)^k / (k + 1)!, the coefficients of (1 - exp(-y)) / y.
const SERIES: [f64; 16] = {
    let (mut out, mut k) = ([1.0; 16], 1);
    while k < 16 {
        out[k] = -out[k - 1] / (k + 1) as f64;
        k += 1;
    }
    out
};

/// 1 - exp(-x) for x >= 0, to 1e-15 relative.
///
/// q(y) = 1 - exp(-y) by its series at y = x/64 (x beyond 40, where it is 1, is cut off; the first term left out is
/// below 1e-15 of the first one), then six times q(2y) = q (2 - q). The series goes by pairs, pairs of pairs and so on
/// (Estrin's scheme): a term that waits for the one before it would take a third of the projection at low degrees.
#[inline(always)]
pub fn relaxation<L: Lane>(x: L) -> L {
    let y = x.min(L::splat(40.0)) * L::splat(1.0 / 64.0);
    let mut sums = [L::zero(); 8];
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = y.mul_add(L::splat(SERIES[2 * k + 1]), L::splat(SERIES[2 * k]));
    }
    let (mut power, mut count) = (y, 8);
    while count > 1 {
        power = power * power;
        count /= 2;
        for k in 0..count {
            sums[k] = power.mul_add(sums[2 * k + 1], sums[2 * k]);
        }
    }
    let mut q = sums[0] * y;
    for _ in 0..6 {
        q = q * (L::splat(2.0) - q);
    }
    q
}

/// Relaxes the rows of F in `u` towards gradients by the share `theta` of each lane.
#[inline(always)]
pub fn project<L: Lanes>(
    pool: &Pool<Matrix<f64>, Matrix<F8>>,
    block: usize,
    theta: L,
    mass: &[F8],
    arrays: Arrays,
    u: &mut [F8],
) {
    match pool.share[block] {
        Share::Shared(k) => with_matrix::<L, _>(&pool.shared[k], theta, mass, arrays, u),
        Share::Own(k) => with_matrix::<L, _>(&pool.own[k], theta, mass, arrays, u),
    }
}

#[inline(always)]
fn with_matrix<L: Lanes, C: Coefficient>(matrix: &Matrix<C>, theta: L, mass: &[F8], arrays: Arrays, u: &mut [F8]) {
    let (rows, columns, n) = (matrix.rows, matrix.columns, mass.len());
    let Arrays { weighted, coefficients } = arrays;
    for (weighted, u) in weighted.chunks_exact_mut(n).zip(u.chunks_exact(n)).take(4) {
        for a in 0..n {
            (L::load(&mass[a]) * L::load(&u[a])).store(&mut weighted[a]);
        }
    }
    let mut first = 0;
    while first < columns {
        first += match columns - first {
            1 => coefficients_of::<L, C, 1>(matrix, first, theta, weighted, coefficients),
            2 | 4 => coefficients_of::<L, C, 2>(matrix, first, theta, weighted, coefficients),
            _ => coefficients_of::<L, C, 3>(matrix, first, theta, weighted, coefficients),
        };
    }
    let (one, two) = u[..2 * rows].split_at_mut(rows);
    // Rows are two a node: an even number.
    let mut r = 0;
    while r < rows {
        r += match rows - r {
            1 => subtract::<L, C, 1>(matrix, r, coefficients, [&mut *one, &mut *two]),
            2 | 4 => subtract::<L, C, 2>(matrix, r, coefficients, [&mut *one, &mut *two]),
            _ => subtract::<L, C, 3>(matrix, r, coefficients, [&mut *one, &mut *two]),
        };
    }
}

/// theta C^T W F of K columns from `first`; K. Columns (below, rows) are worked on together: the sums of both rows of F stay
/// in registers and do not wait for each other.
#[inline(always)]
fn coefficients_of<L: Lanes, C: Coefficient, const K: usize>(
    matrix: &Matrix<C>,
    first: usize,
    theta: L,
    weighted: &[F8],
    coefficients: &mut [F8],
) -> usize {
    let (rows, columns) = (matrix.rows, matrix.columns);
    let (one, two) = (&weighted[..rows], &weighted[rows..2 * rows]);
    let mut sum = [[L::zero(); 2]; K];
    let mut entries = &matrix.data[first..];
    for r in 0..rows {
        let (one, two, row) = (L::load(&one[r]), L::load(&two[r]), &entries[..K]);
        for k in 0..K {
            let entry = row[k].lanes::<L>();
            sum[k][0] = entry.mul_add(one, sum[k][0]);
            sum[k][1] = entry.mul_add(two, sum[k][1]);
        }
        entries = &entries[columns.min(entries.len())..];
    }
    for k in 0..K {
        (theta * sum[k][0]).store(&mut coefficients[first + k]);
        (theta * sum[k][1]).store(&mut coefficients[columns + first + k]);
    }
    K
}

/// Subtracts K rows of C times the coefficients from both rows of F; K.
#[inline(always)]
fn subtract<L: Lanes, C: Coefficient, const K: usize>(
    matrix: &Matrix<C>,
    first: usize,
    coefficients: &[F8],
    u: [&mut [F8]; 2],
) -> usize {
    let columns = matrix.columns;
    let (one, two) = (&coefficients[..columns], &coefficients[columns..2 * columns]);
    let mut rows = [&[] as &[C]; K];
    for (k, row) in rows.iter_mut().enumerate() {
        *row = &matrix.data[(first + k) * columns..][..columns];
    }
    let mut sum = [[L::zero(); 2]; K];
    for column in 0..columns {
        let (one, two) = (L::load(&one[column]), L::load(&two[column]));
        for k in 0..K {
            let entry = rows[k][column].lanes::<L>();
            sum[k][0] = entry.mul_add(one, sum[k][0]);
            sum[k][1] = entry.mul_add(two, sum[k][1]);
        }
    }
    for (i, u) in u.into_iter().enumerate() {
        for (u, sum) in u[first..first + K].iter_mut().zip(&sum) {
            (L::load(u) - sum[i]).store(u);
        }
    }
    K
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relaxation_is_one_minus_exp_to_rounding_on_its_whole_range() {
        for i in 0..100_000 {
            let x = 10f64.powf(-12.0 + 15.0 * i as f64 / 1e5);
            let relative = (relaxation(x) / -(-x).exp_m1() - 1.0).abs();
            // Six doublings, each with two roundings, halved on the way for small x: measured 8e-16.
            assert!(relative < 2e-15, "x = {x}: {relative:e}");
        }
        assert_eq!(relaxation(0.0), 0.0);
    }
}
