//! Application of LCF, F <- F - theta C (C^T W F), to one block.

use crate::lane::{Coefficient, F8, Lanes};
use crate::operators::{Matrix, Pool, Share};

/// Memory of the projection.
pub struct Arrays<'a> {
    /// W F, [row i][direction][node].
    pub weighted: &'a mut [F8],
    /// C^T W F, [row i][column].
    pub coefficients: &'a mut [F8],
}

/// Relaxes the rows of F in `u` towards gradients by the share `theta` of each lane.
#[inline(always)]
pub fn project<L: Lanes>(
    pool: &Pool<Matrix<f64>, Matrix<F8>>,
    block: usize,
    theta: &F8,
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
fn with_matrix<L: Lanes, C: Coefficient>(matrix: &Matrix<C>, theta: &F8, mass: &[F8], arrays: Arrays, u: &mut [F8]) {
    let (rows, columns, n) = (matrix.rows, matrix.columns, mass.len());
    let Arrays { weighted, coefficients } = arrays;
    for component in 0..4 {
        for a in 0..n {
            (L::load(&mass[a]) * L::load(&u[component * n + a])).store(&mut weighted[component * n + a]);
        }
    }
    let theta = L::load(theta);
    for column in 0..columns {
        let mut sum = [L::zero(); 2];
        for r in 0..rows {
            let entry = matrix.row(r)[column].lanes::<L>();
            sum[0] = entry.mul_add(L::load(&weighted[r]), sum[0]);
            sum[1] = entry.mul_add(L::load(&weighted[rows + r]), sum[1]);
        }
        (theta * sum[0]).store(&mut coefficients[column]);
        (theta * sum[1]).store(&mut coefficients[columns + column]);
    }
    for r in 0..rows {
        let mut value = [L::load(&u[r]), L::load(&u[rows + r])];
        for (column, entry) in matrix.row(r).iter().enumerate() {
            let entry = -entry.lanes::<L>();
            value[0] = entry.mul_add(L::load(&coefficients[column]), value[0]);
            value[1] = entry.mul_add(L::load(&coefficients[columns + column]), value[1]);
        }
        value[0].store(&mut u[r]);
        value[1].store(&mut u[rows + r]);
    }
}
