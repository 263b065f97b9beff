//! Eigenvalues, with the eigenvalue 0 split off where it hides what is looked for.
//!
//! Rigid rotations and their rates make Jordan blocks of the eigenvalue 0 of G, which rounding of 1e-16 scatters over 1e-8.
//! The kernel is split off: with an orthonormal basis (N, R) of kernel and rest, G has the eigenvalues 0 and those of
//! R* G R; so it is done again until no kernel is left.

use crate::error::{Error, Result};
use faer::traits::ComplexField;
use faer::traits::ext::ComplexFieldExt;
use faer::{Mat, c64};
use std::ops::{Add, Mul};

/// Singular values below this, in c/h, are 0.
const KERNEL: f64 = 1e-8;
/// Growth below this, in c/h, may be 0 that rounding has scattered.
const DOUBTFUL: f64 = 1e-4;
/// A number of matrices.
pub trait Number: ComplexField<Real = f64> + Copy + Add<Output = Self> + Mul<f64, Output = Self> {}

impl Number for f64 {}
impl Number for c64 {}

/// ln |1 + dt mu| / dt, in c/h, of an eigenvalue mu of a rate; its real part in the limit.
pub fn growth(mu: c64, courant: Option<f64>) -> f64 {
    match courant {
        None => mu.re,
        Some(dt) => 0.5 * (dt * (2.0 * mu.re + dt * mu.norm_sqr())).ln_1p() / dt,
    }
}

/// The largest growth of a matrix of a rate, c/h.
///
/// # Errors
/// The QR algorithm does not end.
pub fn worst<N: Number>(matrix: Mat<N>, courant: Option<f64>) -> Result<f64> {
    let largest = |matrix: &Mat<N>| -> Result<f64> {
        Ok(eigenvalues(matrix)?.into_iter().map(|mu| growth(mu, courant)).fold(f64::NEG_INFINITY, f64::max))
    };
    let first = largest(&matrix)?;
    if !(0.0..DOUBTFUL).contains(&first) {
        return Ok(first);
    }
    let before = matrix.nrows();
    let rest = without_kernel(matrix)?;
    match rest.nrows() {
        0 => Ok(0.0),
        left if left == before => Ok(first),
        _ => Ok(largest(&rest)?.max(0.0)),
    }
}

/// The matrix on what is left of its kernel.
fn without_kernel<N: Number>(mut matrix: Mat<N>) -> Result<Mat<N>> {
    loop {
        let size = matrix.nrows();
        if size == 0 {
            return Ok(matrix);
        }
        // Singular values fall.
        let svd = matrix.svd().map_err(|_| no_end())?;
        let rank = (0..size).filter(|&k| svd.S().column_vector()[k].abs() > KERNEL).count();
        if rank == size {
            return Ok(matrix);
        }
        let rest = svd.V().subcols(0, rank);
        matrix = rest.adjoint() * &matrix * rest;
    }
}

/// All eigenvalues. Where the QR algorithm does not end, it is tried again on a reflected matrix, which has the same ones and
/// other roundings.
fn eigenvalues<N: Number>(matrix: &Mat<N>) -> Result<Vec<c64>> {
    let again = || reflected(matrix).eigenvalues();
    matrix.eigenvalues().or_else(|_| again()).map_err(|_| no_end())
}

/// Q A Q with the reflection Q = 1 - 2 v v* / |v|^2, v = (1, 2, ..): all rows are mixed.
fn reflected<N: Number>(matrix: &Mat<N>) -> Mat<N> {
    let n = matrix.nrows();
    let length = (0..n).map(|k| (1.0 + k as f64).powi(2)).sum::<f64>();
    let entry = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * (1.0 + i as f64) * (1.0 + j as f64) / length;
    let q = Mat::from_fn(n, n, |i, j| N::from_f64_impl(entry(i, j)));
    &q * matrix * &q
}

/// The error of eigenvalues or singular values that cannot be computed.
pub fn no_end() -> Error {
    Error::input(
        "the iteration for the eigenvalues of this case does not converge",
        "give a --deformation, --dt or body that differs a little, a lower --degree, or a smaller body",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Q diag(blocks) Q^T with an orthogonal Q that mixes all rows: a reflection.
    fn mixed(blocks: Mat<f64>) -> Mat<f64> {
        reflected(&blocks)
    }

    #[test]
    fn jordan_blocks_of_zero_do_not_look_like_growth() {
        // Blocks of zero of sizes 3 and 2, and two decaying numbers.
        let blocks = Mat::from_fn(7, 7, |i, j| match (i, j) {
            (0, 1) | (1, 2) | (3, 4) => 1.0,
            (5, 5) | (6, 6) => -1.0,
            (5, 6) => 5.0,
            _ => 0.0,
        });
        let matrix = mixed(blocks);
        let bare = matrix.eigenvalues().unwrap().into_iter().map(|mu| mu.re).fold(0.0, f64::max);
        // A cube root of rounding: what is cured.
        assert!(bare > 1e-9, "{bare:e}");
        assert_eq!(worst(matrix, None).unwrap(), 0.0);
    }

    #[test]
    fn small_growth_beside_a_kernel_is_kept() {
        let blocks = Mat::from_fn(4, 4, |i, j| match (i, j) {
            (0, 1) => 1.0,
            (2, 2) => 1e-6,
            (3, 3) => -2.0,
            _ => 0.0,
        });
        // Rounding of a matrix of order one.
        assert!((worst(mixed(blocks), None).unwrap() - 1e-6).abs() < 1e-14);
    }

    #[test]
    fn eigenvalues_that_cannot_be_computed_are_an_error_that_says_what_to_do() {
        let error = worst(Mat::from_fn(3, 3, |_, _| f64::NAN), None).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("does not converge") && error.to_string().contains("--degree"), "{error}");
    }

    #[test]
    fn growth_of_a_step_is_the_logarithm_of_the_modulus() {
        let (mu, dt) = (c64::new(-0.3, 2.0), 0.2_f64);
        let expected = (c64::new(1.0, 0.0) + mu * dt).norm().ln() / dt;
        assert!((growth(mu, Some(dt)) - expected).abs() < 1e-14);
    }
}
