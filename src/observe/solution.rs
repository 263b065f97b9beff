//! The discrete solution as a function of the point: polynomials of F and p, stresses by the law from that F.

use crate::basis::Lagrange;
use crate::io::snapshot::Snapshot;
use crate::material::Law;
use crate::state::{State, UNKNOWNS};
use crate::step::Scheme;

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
    /// `[cell][component][node]`.
    pub u: Vec<f64>,
}

impl<'a> Solution<'a> {
    /// That of a state; `material` gives the law of each cell.
    pub fn of_state(scheme: &'a Scheme, state: &State, material: &'a [usize]) -> Self {
        let operators = &scheme.operators;
        Self {
            basis: &operators.line.basis,
            laws: &scheme.laws,
            material,
            components: state.components,
            u: state.unpack(&operators.blocks, operators.nodes()),
        }
    }

    /// That of a snapshot.
    pub fn of_snapshot(snapshot: &Snapshot, basis: &'a Lagrange, laws: &'a [Law], material: &'a [usize]) -> Self {
        let nodes = basis.len() * basis.len();
        let components = if snapshot.displacement.is_empty() { UNKNOWNS } else { UNKNOWNS + 2 };
        let mut u = Vec::with_capacity(snapshot.u.len() + snapshot.displacement.len());
        for (cell, unknowns) in snapshot.u.chunks(UNKNOWNS * nodes).enumerate() {
            u.extend_from_slice(unknowns);
            if !snapshot.displacement.is_empty() {
                u.extend_from_slice(&snapshot.displacement[2 * nodes * cell..2 * nodes * (cell + 1)]);
            }
        }
        Self { basis, laws, material, components, u }
    }

    /// Whether the displacement is integrated.
    pub fn has_displacement(&self) -> bool {
        self.components > UNKNOWNS
    }

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
            displacement: if self.has_displacement() { [value(6), value(7)] } else { [0.0; 2] },
        }
    }
}
