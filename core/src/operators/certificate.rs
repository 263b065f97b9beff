//! The certificate of a cell: what its points can carry. It is known before the first step.

use super::{Line, PointMatrices, Sampling};
use crate::basis::MovingLeastSquares;
use crate::error::Error;
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

names! {
    /// How the points of a cell are treated.
    Class {
        /// A lattice: products of 1D matrices.
        Lattice = "lattice",
        /// Any other cloud: dense matrices.
        Dense = "dense",
        /// Points that cannot carry Q_N: virtual ones stand on the Gauss nodes in their place, see [`carry`](mod@super::carry).
        Deficient = "deficient",
        /// The Gauss nodes themselves: methods without points, and laws with memory.
        Nodes = "nodes",
    }
}

/// The certificate of a cell: the points on which the scheme samples, and how well they determine a polynomial of Q_N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// How the points of the cell are treated.
    pub class: Class,
    /// N_p, the number of points.
    pub points: usize,
    /// Numerical rank of the fit; (N+1)^2 where the cell carries Q_N.
    pub rank: usize,
    /// Condition number of the fit.
    pub condition: f64,
    /// Face Lebesgue constant, the largest factor by which the fit can amplify errors of the point values at the faces:
    /// max over face points of sum_p |chi_p|; infinite if the rank is too small.
    pub lebesgue: f64,
    /// The Lebesgue constant over the Gauss nodes. (If all points are near the faces, a function that vanishes at the
    /// faces is nearly zero at all of them, and only this constant is large.)
    pub inside: f64,
    /// h_e, m: the time step is proportional to it.
    pub h: f64,
    /// The largest stable step of the cell at the initial state, s; NaN where no state is known.
    pub dt: f64,
}

/// Certificates of all cells, in the order of the mesh, without dt.
///
/// # Errors
/// The errors of the fit ([`MovingLeastSquares::new`]).
pub fn certify(mesh: &Mesh, line: &Line, sampling: Sampling) -> Result<Vec<Certificate>, Error> {
    let nodes = line.nodes();
    let (class, examples) = sampling.classes(&nodes, mesh.cells.len());
    let fit = |&cell: &usize| {
        let found = of_points(line, sampling.of(&nodes, cell))?;
        let class = if let Sampling::Nodes = sampling { Class::Nodes } else { found.class };
        Ok(Certificate { class, ..found })
    };
    let fits = examples.par_iter().map(fit).collect::<Result<Vec<_>, Error>>()?;
    Ok((0..mesh.cells.len()).map(|cell| Certificate { h: map::h_e(&mesh.map(cell)), ..fits[class[cell]] }).collect())
}

/// The certificate of a cell with these points, without its shape (h = 0, dt = NaN).
///
/// # Errors
/// The errors of the fit ([`MovingLeastSquares::new`]).
pub fn of_points(line: &Line, xi: &[[f64; 2]]) -> Result<Certificate, Error> {
    let fit = MovingLeastSquares::new(line.m - 1, xi)?;
    let along = &line.basis.nodes;
    let faces = along.iter().flat_map(|&s| [[0.0, s], [1.0, s], [s, 0.0], [s, 1.0]]);
    let sum = |x: [f64; 2]| fit.values(x).iter().map(|chi| chi.abs()).sum::<f64>();
    let largest = |at: &mut dyn Iterator<Item = [f64; 2]>| match fit.condition.is_finite() {
        true => at.map(sum).fold(0.0, f64::max),
        false => f64::INFINITY,
    };
    Ok(Certificate {
        class: if PointMatrices::is_lattice(line, xi) { Class::Lattice } else { Class::Dense },
        points: xi.len(),
        rank: fit.rank,
        condition: fit.condition,
        lebesgue: largest(&mut faces.into_iter()),
        inside: largest(&mut line.nodes().into_iter()),
        h: 0.0,
        dt: f64::NAN,
    })
}
