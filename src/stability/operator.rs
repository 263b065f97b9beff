//! The assembled operator: of a body one matrix, of a patch a symbol by Bloch angles.
//!
//! Matrices act on (y, z). y = M^(1/2) x has F and p, x in units 1 of F and rho0 c_p of p, M = w_a J_a rho0 c_p^2: the norm |y|^2 is
//! int rho0 c_p^2 (|H|^2 + |v|^2 / c_p^2) dX with H the perturbation of F. Where the flux holds the jumps of the displacement, z has
//! these jumps ([`Springs`]), and, where faces keep their creep, that: |z|^2 / 2 is the energy of their springs.

use super::Problem;
use super::assemble::{Assembler, Differences, Operator};
use super::springs::Springs;
use crate::error::{Error, Result};
use crate::state::UNKNOWNS;
use faer::{Mat, c64};

/// The operator, as a rate: (S - 1) / (dt c/h) for a step, G itself in the limit.
pub struct Rate {
    /// dt c/h; none in the limit.
    pub courant: Option<f64>,
    /// What entries are off by, c/h.
    pub noise: f64,
    /// M^(1/2) of F and p of a unit, or of the body.
    roots: Vec<f64>,
    /// Blocks by the offset of the unit that they act on; of a body one. F and p of all cells come first, in y, then the creep, in z, then u1
    /// and u2, in units h.
    blocks: Vec<([i32; 2], Mat<f64>)>,
    /// Where jumps of the displacement are held.
    springs: Option<Springs>,
    /// Whether angles mean anything.
    pub periodic: bool,
}

impl Rate {
    /// Assembles it.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn new(problem: &Problem, how: &Differences, operator: Operator) -> Result<Self> {
        let (assembler, cells) = (Assembler::new(problem), problem.columns());
        let columns = assembler.columns(&cells, how, operator);
        if columns.iter().flatten().any(|x| !x.is_finite()) {
            let what = "a step gives numbers that are not finite";
            return Err(Error::input(what, "give a smaller step, or another state"));
        }
        let order = order(problem, &cells);
        let roots_all = roots(problem);
        let own = unknowns(problem, &cells);
        let mut blocks = Vec::new();
        let units = problem.units as i32;
        let middle = (units - 1) / 2;
        for at in (0..units * units).map(|k| [k % units, k / units]) {
            // The rows of one unit, as `columns` has its own.
            let cells: Vec<usize> = match problem.unit {
                None => cells.clone(),
                Some(unit) => (0..unit[1])
                    .flat_map(|iy| (0..unit[0]).map(move |ix| (ix, iy)))
                    .map(|within| problem.cell_at(at.map(|k| k as usize), within))
                    .collect(),
            };
            let rows = unknowns(problem, &cells);
            let scaled = |i: usize, j: usize| {
                let (i, j) = (order[i], order[j]);
                columns[j][rows[i]] * roots_all[rows[i]] / roots_all[own[j]]
            };
            let block = Mat::from_fn(order.len(), order.len(), scaled);
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
        let first = UNKNOWNS * problem.scheme.operators.nodes() * cells.len();
        let roots = order[..first].iter().map(|&at| roots_all[own[at]]).collect();
        let springs = Springs::new(problem);
        Ok(Self { courant, noise: how.noise, roots, blocks, springs, periodic: problem.unit.is_some() })
    }

    /// M^(1/2) of F and p, whose rows and columns come first.
    pub fn roots(&self) -> &[f64] {
        &self.roots
    }

    /// Rows of a block: of y, and of u before it is counted by jumps.
    fn size(&self) -> usize {
        self.blocks.first().map_or(0, |(_, block)| block.nrows())
    }

    /// The matrix of a body.
    ///
    /// # Errors
    /// The jumps of the displacement cannot be told apart.
    pub fn matrix(&self) -> Result<Mat<f64>> {
        let mut out = Mat::zeros(self.size(), self.size());
        self.blocks.iter().for_each(|(_, block)| out += block);
        match &self.springs {
            None => Ok(out),
            Some(springs) => Ok(springs.of_body()?.reduce(&out)),
        }
    }

    /// The symbol sum_k B_k exp(-i theta.k) of a patch.
    ///
    /// # Errors
    /// The jumps of the displacement cannot be told apart.
    pub fn symbol(&self, theta: [f64; 2]) -> Result<Mat<c64>> {
        let mut out = Mat::<c64>::zeros(self.size(), self.size());
        for (offset, block) in &self.blocks {
            let angle = -(theta[0] * f64::from(offset[0]) + theta[1] * f64::from(offset[1]));
            let phase = c64::new(angle.cos(), angle.sin());
            for j in 0..self.size() {
                out.col_mut(j).iter_mut().zip(block.col(j).iter()).for_each(|(out, b)| *out += phase * *b);
            }
        }
        match &self.springs {
            None => Ok(out),
            Some(springs) => Ok(springs.at(theta)?.reduce(&out)),
        }
    }
}

/// The unknowns of some cells among all, as columns of the program have them: `[cell][component][node]`.
fn unknowns(problem: &Problem, cells: &[usize]) -> Vec<usize> {
    let stride = problem.per_cell();
    cells.iter().flat_map(|cell| cell * stride..(cell + 1) * stride).collect()
}

/// The order of the unknowns of some cells, as they stand in the list of all of these cells: F and p, the creep of the faces that are theirs,
/// then u1 and u2, `[component][cell][node]`.
fn order(problem: &Problem, cells: &[usize]) -> Vec<usize> {
    let (n, stride, count) = (problem.scheme.operators.nodes(), problem.per_cell(), cells.len());
    let mut out: Vec<usize> = (0..count).flat_map(|cell| cell * stride..cell * stride + UNKNOWNS * n).collect();
    for (at, &cell) in cells.iter().enumerate() {
        out.extend(problem.own_creep(cell).map(|k| at * stride + problem.at_nodes() + k));
    }
    for k in UNKNOWNS..problem.state.components {
        out.extend((0..count).flat_map(|cell| cell * stride + k * n..cell * stride + (k + 1) * n));
    }
    out
}

/// M^(1/2) of all unknowns; 1 for u, and (k w l)^(1/2) h for the creep.
fn roots(problem: &Problem) -> Vec<f64> {
    let operators = &problem.scheme.operators;
    let mut out = Vec::new();
    for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
        let modulus = problem.scheme.laws[operators.blocks.material[block]].density() * problem.speeds[cell].powi(2);
        let masses: Vec<f64> = operators.geometry.masses(&operators.line, block, lane).collect();
        (0..UNKNOWNS).for_each(|_| out.extend(masses.iter().map(|mass| (mass * modulus).sqrt())));
        out.resize(cell * problem.per_cell() + problem.at_nodes(), 1.0);
        out.extend(
            (problem.at_nodes()..problem.per_cell()).map(|k| problem.root_of_creep(cell, k - problem.at_nodes())),
        );
    }
    out
}
