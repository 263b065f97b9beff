//! The assembled operator: of a body one matrix, of a patch a symbol by Bloch angles.
//!
//! Matrices act on y = M^(1/2) x, x in units 1 of F and rho0 c_p of p, M = w_a J_a rho0 c_p^2: the norm |y|^2 is
//! int rho0 c_p^2 (|H|^2 + |v|^2 / c_p^2) dX with H the perturbation of F.

use super::Problem;
use super::assemble::{Assembler, Differences, Operator};
use crate::error::{Error, Result};
use faer::{Mat, c64};

/// The operator, as a rate: (S - 1) / (dt c/h) for a step, G itself in the limit.
pub struct Rate {
    /// dt c/h; none in the limit.
    pub courant: Option<f64>,
    /// What entries are off by, c/h.
    pub noise: f64,
    /// M^(1/2) of the unknowns of a unit, or of the body.
    roots: Vec<f64>,
    /// Blocks by the offset of the unit that they act on; of a body one.
    blocks: Vec<([i32; 2], Mat<f64>)>,
    /// Whether angles mean anything.
    pub periodic: bool,
}

impl Rate {
    /// Assembles it.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn new(problem: &Problem, how: &Differences, operator: Operator) -> Result<Self> {
        let (assembler, cells, stride) = (Assembler::new(problem), problem.columns(), problem.per_cell());
        let columns = assembler.columns(&cells, how, operator);
        if columns.iter().flatten().any(|x| !x.is_finite()) {
            let what = "a step gives numbers that are not finite";
            return Err(Error::input(what, "give a smaller step, or another state"));
        }
        let roots_all = roots(problem);
        let mut blocks = Vec::new();
        let units = problem.units as i32;
        let middle = (units - 1) / 2;
        for at in (0..units * units).map(|k| [k % units, k / units]) {
            // The rows of one unit, as `columns` has its own.
            let rows: Vec<usize> = match problem.unit {
                None => cells.clone(),
                Some(unit) => (0..unit[1])
                    .flat_map(|iy| (0..unit[0]).map(move |ix| (ix, iy)))
                    .map(|within| problem.cell_at(at.map(|k| k as usize), within))
                    .collect(),
            };
            let row = |i: usize| rows[i / stride] * stride + i % stride;
            let own = |j: usize| cells[j / stride] * stride + j % stride;
            let size = columns.len();
            let scaled = |i: usize, j: usize| columns[j][row(i)] * roots_all[row(i)] / roots_all[own(j)];
            let block = Mat::from_fn(size, size, scaled);
            if block.norm_max() != 0.0 {
                blocks.push(([at[0] - middle, at[1] - middle], block));
            }
        }
        let courant = match operator {
            Operator::Step(courant) => Some(courant),
            Operator::SemiDiscrete => None,
        };
        if let Some(courant) = courant {
            for (offset, block) in &mut blocks {
                let one = if *offset == [0, 0] { 1.0 } else { 0.0 };
                *block = Mat::from_fn(block.nrows(), block.ncols(), |i, j| {
                    (block[(i, j)] - if i == j { one } else { 0.0 }) / courant
                });
            }
        }
        let roots = cells.iter().flat_map(|cell| roots_all[cell * stride..(cell + 1) * stride].to_vec()).collect();
        Ok(Self { courant, noise: how.noise, roots, blocks, periodic: problem.unit.is_some() })
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.roots.len()
    }

    /// M^(1/2) of the unknowns.
    pub fn roots(&self) -> &[f64] {
        &self.roots
    }

    /// The matrix of a body.
    pub fn matrix(&self) -> Mat<f64> {
        let mut out = Mat::zeros(self.size(), self.size());
        self.blocks.iter().for_each(|(_, block)| out += block);
        out
    }

    /// The symbol sum_k B_k exp(-i theta.k) of a patch.
    pub fn symbol(&self, theta: [f64; 2]) -> Mat<c64> {
        let mut out = Mat::<c64>::zeros(self.size(), self.size());
        for (offset, block) in &self.blocks {
            let angle = -(theta[0] * f64::from(offset[0]) + theta[1] * f64::from(offset[1]));
            let phase = c64::new(angle.cos(), angle.sin());
            for j in 0..self.size() {
                out.col_mut(j).iter_mut().zip(block.col(j).iter()).for_each(|(out, b)| *out += phase * *b);
            }
        }
        out
    }
}

/// M^(1/2) of all unknowns.
fn roots(problem: &Problem) -> Vec<f64> {
    let operators = &problem.scheme.operators;
    let mut out = Vec::new();
    for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
        let modulus = problem.scheme.laws[operators.blocks.material[block]].density() * problem.speeds[cell].powi(2);
        let masses: Vec<f64> = operators.geometry.masses(&operators.line, block, lane).collect();
        (0..crate::state::UNKNOWNS).for_each(|_| out.extend(masses.iter().map(|mass| (mass * modulus).sqrt())));
    }
    out
}
