//! The energy of a perturbation, and how fast it can grow.
//!
//! E2 = 1/2 int ( A_ijkl H_ij H_kl + |p|^2 / rho0 ) dX is the second derivative of the total energy about the state, with
//! A = dP/dF of the law at the nodes, and the energy sum over faces of K/2 int `[u]`^2 ds of the springs where jumps of u are held. In
//! the variables of [`Rate`] it is (y* E y + z* z) / 2 with E = diag(A / (rho0 c_p^2), 1).
//! Rotations about an unloaded state have no energy and those of a compressed one a negative one: a growth over E2 itself has
//! no bound as soon as such a rotation becomes strain. Measured is the largest eigenvalue of the symmetric part
//! (E G + G* E) / 2: the most that E2 can gain in a unit of time, over the norm |y|^2 / 2, which is the kinetic energy and as
//! much for the perturbation of F. It is 0 or less if and only if no perturbation gains energy.

use super::Problem;
use super::operator::Rate;
use super::spectrum::Number;
use crate::error::Result;
use crate::step::Law;
use crate::step::history;
use faer::{Mat, Side, c64};
use rayon::prelude::*;

/// Distance of the differences that give the tangent; the error of the fourth power is below rounding.
const DISTANCE: f64 = 1e-4;

/// The energy product.
pub struct Energy {
    /// A / (rho0 c_p^2) of each node of each cell of the unit or body.
    tangents: Vec<[[f64; 4]; 4]>,
    nodes: usize,
    /// The lowest eigenvalue of all of them: below 0 the product is indefinite.
    pub lowest: f64,
}

impl Energy {
    /// Of the state of a problem.
    ///
    /// # Errors
    /// The eigenvalues of a tangent cannot be computed.
    pub fn new(problem: &Problem) -> Result<Self> {
        let (scheme, nodes) = (&problem.scheme, problem.scheme.operators.nodes());
        let u = problem.state.unpack(&scheme.operators.blocks, nodes);
        let (places, internal) = (scheme.places(), scheme.internal_of(&problem.state));
        let mut tangents = Vec::new();
        // Histories stand cell by cell, for cells whose law has some.
        let mut first = vec![0];
        for (cell, &(block, _)) in scheme.operators.blocks.slot.iter().enumerate() {
            let count = scheme.laws[scheme.operators.blocks.material[block]].history_len();
            first.push(first[cell] + count * (places.first[cell + 1] - places.first[cell]));
        }
        for cell in problem.columns() {
            let law = &scheme.laws[scheme.operators.blocks.material[scheme.operators.blocks.slot[cell].0]];
            let (count, modulus) = (law.history_len(), law.density() * problem.speeds[cell].powi(2));
            for a in 0..nodes {
                let f = std::array::from_fn(|k| u[cell * problem.at_nodes() + k * nodes + a]);
                let mut known = law.virgin();
                if count > 0 {
                    let xi = places.xi[places.first[cell]..places.first[cell + 1]].iter().copied();
                    let at = first[cell] + count * history::nearest(xi, scheme.operators.line.basis.node_2d(a));
                    known.copy_from_slice(&internal[at..at + count]);
                }
                let tangent = tangent(law, f, &known);
                tangents.push(tangent.map(|row| row.map(|x| x / modulus)));
            }
        }
        let mut lowest = f64::INFINITY;
        for tangent in &tangents {
            let matrix = Mat::from_fn(4, 4, |i, j| tangent[i][j]);
            lowest = lowest.min(smallest(&matrix)?);
        }
        Ok(Self { tangents, nodes, lowest })
    }

    /// E times a matrix.
    fn times<N: Number>(&self, matrix: &Mat<N>) -> Mat<N> {
        let (n, stride) = (self.nodes, crate::state::UNKNOWNS * self.nodes);
        Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            let (cell, k, a) = (i / stride, i % stride / n, i % n);
            // What stands behind F and p of all cells are the jumps of u.
            if cell * n >= self.tangents.len() || k > 3 {
                return matrix[(i, j)];
            }
            let row = &self.tangents[cell * n + a][k];
            let term = |l: usize| matrix[(cell * stride + l * n + a, j)] * row[l];
            term(0) + term(1) + term(2) + term(3)
        })
    }

    /// The largest eigenvalue of (E G + G* E) / 2 for a rate, and with dt G* E G / 2 added for a step.
    fn growth<N: Number>(&self, rate: &Mat<N>, courant: Option<f64>) -> Result<f64> {
        let product = self.times(rate);
        let adjoint = product.adjoint().to_owned();
        let half = faer::Scale(N::from_f64_impl(0.5));
        let mut both = (&product + &adjoint) * half;
        if let Some(dt) = courant {
            both += rate.adjoint() * &product * faer::Scale(N::from_f64_impl(0.5 * dt));
        }
        let values = both.self_adjoint_eigenvalues(Side::Lower).map_err(|_| super::spectrum::no_end())?;
        Ok(values.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    /// The largest growth of energy over some Bloch angles, or of a body, c/h.
    ///
    /// # Errors
    /// Eigenvalues that cannot be computed.
    pub fn largest(&self, rate: &Rate, angles: &[[f64; 2]]) -> Result<f64> {
        if !rate.periodic {
            return self.growth(&rate.matrix()?, rate.courant);
        }
        let of = |theta: &[f64; 2]| self.growth::<c64>(&rate.symbol(*theta)?, rate.courant);
        let all: Vec<f64> = angles.par_iter().map(of).collect::<Result<_>>()?;
        Ok(all.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }
}

fn smallest(matrix: &Mat<f64>) -> Result<f64> {
    let values = matrix.self_adjoint_eigenvalues(Side::Lower).map_err(|_| super::spectrum::no_end())?;
    Ok(values.into_iter().fold(f64::INFINITY, f64::min))
}

/// dP/dF of the law at fixed internal variables of t_n, symmetrised: central differences at two distances.
fn tangent(law: &Law, f: [f64; 4], known: &[f64]) -> [[f64; 4]; 4] {
    let mut columns = [[0.0; 4]; 4];
    for (j, column) in columns.iter_mut().enumerate() {
        let at = |amount: f64| {
            let mut f = f;
            f[j] += amount;
            law.response(f, known).piola
        };
        let [a, b, c, d] = [DISTANCE, -DISTANCE, 2.0 * DISTANCE, -2.0 * DISTANCE].map(at);
        for (i, out) in column.iter_mut().enumerate() {
            *out = (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * DISTANCE);
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (columns[i][j] + columns[j][i])))
}
