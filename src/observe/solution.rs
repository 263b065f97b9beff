//! The discrete solution as a function of the point: polynomials of F and p, stresses by the law from that F.

use crate::basis::Lagrange;
use crate::material::Law;
use crate::state::UNKNOWNS;

/// The unknowns at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// F.
    pub deformation: [f64; 4],
    /// v, m/s.
    pub velocity: [f64; 2],
    /// u, m; zero where it is not integrated.
    pub displacement: [f64; 2],
}

/// Unknowns of all cells, in the order of the mesh.
#[derive(Debug, Clone)]
pub struct Solution<'a> {
    /// The nodal basis.
    pub basis: &'a Lagrange,
    /// The laws.
    pub laws: &'a [Law],
    /// The law of each cell.
    pub material: &'a [usize],
    /// 6, or 8 with displacement.
    pub components: usize,
    /// [cell][component][node].
    pub u: Vec<f64>,
}

impl Solution<'_> {
    /// The law of a cell.
    pub fn law(&self, cell: usize) -> &Law {
        &self.laws[self.material[cell]]
    }

    /// The unknowns at parent coordinates xi of a cell.
    pub fn at(&self, cell: usize, xi: [f64; 2]) -> Point {
        self.combine(cell, &self.basis.values_2d(xi))
    }

    /// The unknowns of a cell in the weights of its nodes.
    pub fn combine(&self, cell: usize, weights: &[f64]) -> Point {
        let n = weights.len();
        let start = cell * self.components * n;
        let value = |k: usize| -> f64 {
            let nodes = &self.u[start + k * n..start + (k + 1) * n];
            nodes.iter().zip(weights).map(|(u, w)| u * w).sum()
        };
        let density = self.law(cell).density();
        Point {
            deformation: [value(0), value(1), value(2), value(3)],
            velocity: [value(4) / density, value(5) / density],
            displacement: if self.components > UNKNOWNS { [value(6), value(7)] } else { [0.0; 2] },
        }
    }
}
