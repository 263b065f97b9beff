//! What each cell can carry, known before the first step.

use super::{Line, Sampling};
use crate::basis::MovingLeastSquares;
use crate::error::Error;
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

/// The certificate of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// N_p.
    pub points: usize,
    /// Numerical rank of the fit; (N+1)^2 where the cell carries Q_N.
    pub rank: usize,
    /// Condition number of the fit.
    pub condition: f64,
    /// Face Lebesgue constant: max over face points of sum_p |chi_p|; infinite where the rank is too small.
    pub lebesgue: f64,
    /// h_e, m: the time step is proportional to it.
    pub h: f64,
}

/// Certificates of all cells, in the order of the mesh.
///
/// # Errors
/// As for the fit itself.
pub fn certify(mesh: &Mesh, line: &Line, sampling: Sampling) -> Result<Vec<Certificate>, Error> {
    let nodes = line.nodes();
    let (class, examples) = sampling.classes(&nodes, mesh.cells.len());
    let fit = |&cell: &usize| quality(line, sampling.of(&nodes, cell));
    let fits = examples.par_iter().map(fit).collect::<Result<Vec<_>, Error>>()?;
    Ok((0..mesh.cells.len())
        .map(|cell| Certificate { h: map::h_e(&mesh.corners(cell)), ..fits[class[cell]] })
        .collect())
}

fn quality(line: &Line, xi: &[[f64; 2]]) -> Result<Certificate, Error> {
    let fit = MovingLeastSquares::new(line.m - 1, xi)?;
    let along = &line.basis.nodes;
    let faces = along.iter().flat_map(|&s| [[0.0, s], [1.0, s], [s, 0.0], [s, 1.0]]);
    let sums = faces.map(|x| fit.values(x).iter().map(|chi| chi.abs()).sum::<f64>());
    let lebesgue = if fit.condition.is_finite() { sums.fold(0.0, f64::max) } else { f64::INFINITY };
    Ok(Certificate { points: xi.len(), rank: fit.rank, condition: fit.condition, lebesgue, h: 0.0 })
}
