//! Moving least squares on the points of a cell: the shape functions chi_p of the cloud (18).
//!
//! chi(xi) = p(xi)^T Pmat^+, Pmat[q, m] = p_m(xi_q), with the full Q_N in parent coordinates as orthonormal shifted
//! Legendre products and constant weight. The basis must be the full Q_N: with total-degree P_N the scheme is unstable.

use crate::error::Error;
use crate::quadrature;
use nalgebra::DMatrix;

/// Singular values below this share of the largest do not count for the rank: the points of a cell in real use are
/// conditioned below 1e4, those on a line above 1e15.
const RANK_TOLERANCE: f64 = 1e-10;

/// The fit of Q_N to the points of one cell.
#[derive(Debug, Clone)]
pub struct MovingLeastSquares {
    degree: usize,
    /// Pmat^+, (N+1)^2 x N_p; zero where the rank is too small.
    inverse: DMatrix<f64>,
    /// Numerical rank of Pmat; the cell can carry Q_N where it is (N+1)^2.
    pub rank: usize,
    /// Ratio of the extreme singular values of Pmat (infinite where rank-deficient).
    pub condition: f64,
}

impl MovingLeastSquares {
    /// Fits Q_N to points with parent coordinates `xi`.
    ///
    /// # Errors
    /// Where the singular values do not converge, which finite coordinates do not cause.
    pub fn new(degree: usize, xi: &[[f64; 2]]) -> Result<Self, Error> {
        let size = (degree + 1) * (degree + 1);
        let rows: Vec<Vec<f64>> = xi.iter().map(|&x| legendre_2d(degree, x)).collect();
        let matrix = DMatrix::from_fn(xi.len().max(1), size, |p, m| rows.get(p).map_or(0.0, |row| row[m]));
        let svd = matrix.clone().try_svd(false, false, f64::EPSILON, 0).ok_or_else(|| {
            Error::input("the points of a cell have coordinates that no fit can use", "give finite coordinates")
        })?;
        let (largest, smallest) = (svd.singular_values.max(), svd.singular_values.min());
        let rank = svd.rank(RANK_TOLERANCE * largest);
        let condition = if rank < size { f64::INFINITY } else { largest / smallest };
        let inverse = if rank < size { None } else { inverse(matrix) };
        Ok(Self { degree, inverse: inverse.unwrap_or_else(|| DMatrix::zeros(size, xi.len())), rank, condition })
    }

    /// chi_p(xi) for each point p.
    pub fn values(&self, xi: [f64; 2]) -> Vec<f64> {
        self.combine(&legendre_2d(self.degree, xi))
    }

    /// d chi_p / d xi_b at xi for b = 1, 2.
    pub fn gradients(&self, xi: [f64; 2]) -> [Vec<f64>; 2] {
        let (values, slopes) = (xi.map(|x| legendre(self.degree, x).0), xi.map(|x| legendre(self.degree, x).1));
        [self.combine(&outer(&slopes[0], &values[1])), self.combine(&outer(&values[0], &slopes[1]))]
    }

    fn combine(&self, basis: &[f64]) -> Vec<f64> {
        combine(&self.inverse, basis)
    }
}

/// The fit of P_N to points of a line. On a lattice chi is the product of the functions of its two lines.
#[derive(Debug, Clone)]
pub struct LineFit {
    degree: usize,
    inverse: DMatrix<f64>,
}

impl LineFit {
    /// Fits P_N to points at `x`; none where they cannot carry it well enough for the rank of a product of two lines to
    /// be beyond doubt.
    pub fn new(degree: usize, x: &[f64]) -> Option<Self> {
        let rows: Vec<Vec<f64>> = x.iter().map(|&x| legendre(degree, x).0).collect();
        if rows.len() <= degree {
            return None;
        }
        let matrix = DMatrix::from_fn(x.len(), degree + 1, |p, m| rows[p][m]);
        let svd = matrix.clone().try_svd(false, false, f64::EPSILON, 0)?;
        if svd.singular_values.min() <= RANK_TOLERANCE.sqrt() * svd.singular_values.max() {
            return None;
        }
        Some(Self { degree, inverse: inverse(matrix)? })
    }

    /// chi_p(x) for each point p.
    pub fn values(&self, x: f64) -> Vec<f64> {
        combine(&self.inverse, &legendre(self.degree, x).0)
    }

    /// chi_p'(x) for each point p.
    pub fn derivatives(&self, x: f64) -> Vec<f64> {
        combine(&self.inverse, &legendre(self.degree, x).1)
    }
}

/// The least-squares fit of P_N (total degree) in X to points at `x`, evaluated at the points `at`: weights `[at][x]`. About
/// `middle`, in units of the farthest point. None where the points do not carry P_N.
pub fn patch(degree: usize, middle: [f64; 2], x: &[[f64; 2]], at: &[[f64; 2]]) -> Option<Vec<Vec<f64>>> {
    let far = x.iter().map(|x| (x[0] - middle[0]).hypot(x[1] - middle[1])).fold(f64::MIN_POSITIVE, f64::max);
    let row = |x: &[f64; 2]| -> Vec<f64> {
        let [a, b] = [0, 1].map(|i| legendre(degree, 0.5 + 0.5 * (x[i] - middle[i]) / far).0);
        (0..=degree).flat_map(|i| (0..=degree - i).map(move |j| (i, j))).map(|(i, j)| a[i] * b[j]).collect()
    };
    let size = (degree + 1) * (degree + 2) / 2;
    if x.len() < size {
        return None;
    }
    let rows: Vec<Vec<f64>> = x.iter().map(row).collect();
    let matrix = DMatrix::from_fn(x.len(), size, |p, m| rows[p][m]);
    let svd = matrix.clone().try_svd(false, false, f64::EPSILON, 0)?;
    if svd.rank(RANK_TOLERANCE * svd.singular_values.max()) < size {
        return None;
    }
    let inverse = inverse(matrix)?;
    Some(at.iter().map(|x| combine(&inverse, &row(x))).collect())
}

fn combine(inverse: &DMatrix<f64>, basis: &[f64]) -> Vec<f64> {
    inverse.column_iter().map(|column| column.iter().zip(basis).map(|(a, b)| a * b).sum()).collect()
}

/// Pmat^+ = R^-1 Q^T of a matrix of full column rank. Not from singular vectors: the SVD at hand is off by up to 1e-8 where
/// singular values nearly meet, as they do on lattices of which a few points are moved.
fn inverse(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let qr = matrix.qr();
    qr.r().solve_upper_triangular(&qr.q().transpose())
}

/// Orthonormal shifted Legendre polynomials sqrt(2k+1) P_k(2x - 1) and their derivatives, k = 0..=N.
pub fn legendre(degree: usize, x: f64) -> (Vec<f64>, Vec<f64>) {
    let of = |(k, (p, slope))| {
        let norm = (2.0 * k as f64 + 1.0).sqrt();
        (p * norm, 2.0 * slope * norm)
    };
    quadrature::legendre(2.0 * x - 1.0).take(degree + 1).enumerate().map(of).unzip()
}

fn legendre_2d(degree: usize, xi: [f64; 2]) -> Vec<f64> {
    outer(&legendre(degree, xi[0]).0, &legendre(degree, xi[1]).0)
}

fn outer(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().flat_map(|x| b.iter().map(move |y| x * y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lattice(at: &[f64]) -> Vec<[f64; 2]> {
        at.iter().flat_map(|&x| at.iter().map(move |&y| [x, y])).collect()
    }

    proptest! {
        // Many, since it is rare clouds that a poor factorisation fails on: one in a thousand by nalgebra's SVD.
        #![proptest_config(ProptestConfig::with_cases(5000))]
        #[test]
        fn reproduces_q_n_and_its_gradient_on_any_unisolvent_cloud(
            degree in 1usize..=4, extra in 0usize..=1, seed in prop::collection::vec(-0.2..0.2f64, 72), x in 0.0..1.0f64, y in 0.0..1.0f64) {
            let k = degree + 1 + extra;
            let at: Vec<f64> = (0..k).map(|i| (i as f64 + 0.5) / k as f64).collect();
            let mut cloud = lattice(&at);
            for (i, point) in cloud.iter_mut().enumerate() {
                point[0] += seed[2 * i] / k as f64;
                point[1] += seed[2 * i + 1] / k as f64;
            }
            let fit = MovingLeastSquares::new(degree, &cloud).unwrap();
            let n = degree as i32;
            let field = |p: [f64; 2]| -> f64 { p[0].powi(n) * p[1].powi(n) + p[0] - 2.0 * p[1] };
            let sum = |weights: Vec<f64>| -> f64 { weights.iter().zip(&cloud).map(|(w, p)| w * field(*p)).sum() };
            let [dx, dy] = fit.gradients([x, y]);
            // Rounding times the condition (below 1e3 here) and the Lebesgue constant of the corner (below 1e3).
            let bound = 1e-9;
            prop_assert!((sum(fit.values([x, y])) - field([x, y])).abs() < bound);
            let power = |p: i32, x: f64| -> f64 { if n == 0 { 0.0 } else { p as f64 * x.powi(p - 1) } };
            prop_assert!((sum(dx) - (power(n, x) * y.powi(n) + 1.0)).abs() < bound);
            prop_assert!((sum(dy) - (power(n, y) * x.powi(n) - 2.0)).abs() < bound);
        }
    }

    #[test]
    fn points_on_a_line_are_seen_as_rank_deficient() {
        let line: Vec<[f64; 2]> = (0..9).map(|i| [0.1 * i as f64, 0.1 * i as f64]).collect();
        let fit = MovingLeastSquares::new(2, &line).unwrap();
        // Q_2 on a diagonal holds polynomials of degree 4 in one variable.
        assert_eq!((fit.rank, fit.condition), (5, f64::INFINITY));
        assert_eq!(MovingLeastSquares::new(1, &[]).unwrap().rank, 0);
    }
}
