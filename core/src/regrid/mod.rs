//! The transfer of a state from one grid to another (section 5, step 5 of the paper; by the recipe of the design, which was
//! measured there).
//!
//! U_new = M^-1 sum over intersections of new and old cells of int Phi_a^new U_old dX. This is the L2 projection. It
//! keeps the integral of every component and never raises the integral of its square. So momentum and mean F stay, and
//! kinetic energy does not rise. Then F <- Pi F once ([`curl_free`]), if the curl of F is controlled. A new cell that
//! equals an old one to the bit is copied without change. Internal variables are never projected: they stay at their
//! points ([`points`]).
//!
//! Not controlled: the curl of F between cells and the strain energy are those of the projection. Strain energy is
//! convex in F near F = 1, and falls there.

mod clip;
mod general;
mod nodal;
pub mod points;
mod tensor;

pub use tensor::TensorGrid;

use crate::basis::Lagrange;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::mesh::map::{self, CellMap};
use crate::state::UNKNOWNS;
use crate::step::{Relax, Scheme};
use crate::sum::exact_sum;
use rayon::prelude::*;
use std::collections::HashMap;

/// Two meshes that differ by more than this part of their area are not meshes of the same body. (A hole of radius r
/// that is meshed with edges of length h differs from the circle by h^2/(12 r^2) of its area.)
pub const LARGEST_DIFFERENCE: f64 = 0.02;

/// A mesh with the number of the material of each cell; materials keep their numbers from grid to grid (by the names of
/// their groups).
#[derive(Debug, Clone, Copy)]
pub struct Grid<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The material of each cell.
    pub material: &'a [usize],
}

/// Unknowns on a grid.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    /// The nodal basis of the cells.
    pub basis: &'a Lagrange,
    /// 6, or 8 with displacement.
    pub components: usize,
    /// `[cell][component][node]`.
    pub u: &'a [f64],
    /// The weight of each component's squared difference in the error, for each material.
    pub scale: &'a [[f64; 8]],
}

/// The result of the transfer.
#[derive(Debug, Clone, PartialEq)]
pub struct Transfer {
    /// The unknowns on the new grid, `[cell][component][node]`.
    pub u: Vec<f64>,
    /// For each new cell the old cell that it equals to the bit, if there is one. It has the unknowns of that cell.
    pub same: Vec<Option<usize>>,
    /// Whether both grids are products of lines, so that no cell was clipped.
    pub structured: bool,
    /// Area of the new grid that the old one does not cover, and of the old one that the new one does not, m^2.
    pub uncovered: [f64; 2],
    /// sqrt(int sum_k scale_k (U_new - U_old)_k^2 dX).
    pub error: f64,
}

/// The share of a new cell in the sums.
#[derive(Debug, Clone, Default)]
struct Share {
    /// Squared error, as in [`Transfer::error`].
    error: f64,
    /// Area that no old cell of its material covers, m^2.
    uncovered: f64,
    /// What it got from each old cell.
    taken: Vec<Taken>,
}

/// What a new cell got from an old cell.
#[derive(Debug, Clone, Copy)]
struct Taken {
    /// The old cell.
    old: usize,
    /// The area in common, m^2.
    area: f64,
    /// int U_old over this area, by quadrature.
    total: [f64; 8],
}

/// For each new cell the old cell of the same material whose corners and edges are the same to the bit, in the same order.
pub fn same_cells(old: &Grid, new: &Grid) -> Vec<Option<usize>> {
    let key = |grid: &Grid, cell: usize| {
        let CellMap { corners, bulge } = grid.mesh.map(cell);
        let bulge = bulge.map(|bulge| bulge.map(|d| d.map(f64::to_bits)));
        (corners.map(|x| x.map(f64::to_bits)), bulge, grid.material[cell])
    };
    let by_key: HashMap<_, usize> = (0..old.mesh.cells.len()).map(|cell| (key(old, cell), cell)).collect();
    (0..new.mesh.cells.len()).into_par_iter().map(|cell| by_key.get(&key(new, cell)).copied()).collect()
}

/// Projects a field onto a new grid.
///
/// # Errors
/// Grids that differ by more than [`LARGEST_DIFFERENCE`] of their area, or a material that the old grid lacks.
pub fn transfer(old: &Grid, new: &Grid, field: &Field) -> Result<Transfer, Error> {
    match field.basis.len() {
        1 => with_nodes::<1>(old, new, field),
        2 => with_nodes::<2>(old, new, field),
        3 => with_nodes::<3>(old, new, field),
        4 => with_nodes::<4>(old, new, field),
        5 => with_nodes::<5>(old, new, field),
        6 => with_nodes::<6>(old, new, field),
        7 => with_nodes::<7>(old, new, field),
        m => Err(Error::input(format!("there is no transfer of degree {}", m - 1), "choose a degree from 0 to 6")),
    }
}

fn with_nodes<const M: usize>(old: &Grid, new: &Grid, field: &Field) -> Result<Transfer, Error> {
    let same = same_cells(old, new);
    let mut u = vec![0.0; new.mesh.cells.len() * field.components * M * M];
    let tensor = tensor::project::<M>(old, new, field, &same, &mut u);
    let structured = tensor.is_some();
    let shares = match tensor {
        Some(shares) => shares,
        None => general::project::<M>(old, new, field, &same, &mut u)?,
    };
    let error = exact_sum(shares.iter().map(|share| share.error)).sqrt();
    let mut out = Transfer { u, same, structured, uncovered: [0.0; 2], error };
    if !structured {
        general::settle(old, new, field, &shares, &mut out)?;
    }
    Ok(out)
}

/// F <- Pi F in the cells that are not copies, with theta = 1, if F is controlled by this projection
/// ([`Relax::Gradient`]). It turns rotations inside a cell into strain, so that energy may rise. With
/// [`Relax::Rotation`] F is not changed here.
pub fn curl_free(scheme: &Scheme, components: usize, same: &[Option<usize>], u: &mut [f64]) {
    let operators = &scheme.operators;
    let gradients = scheme.curl.is_some_and(|control| control.relax == Relax::Gradient);
    let Some(curl_free) = operators.curl_free.as_ref().filter(|_| gradients) else { return };
    let n = operators.nodes();
    u.par_chunks_exact_mut(components * n).zip(same).enumerate().for_each(|(cell, (u, same))| {
        if same.is_none() {
            let (block, lane) = operators.blocks.slot[cell];
            curl_free.project(&operators.line, &operators.geometry, [block, lane], &mut u[..4 * n]);
        }
    });
}

/// w_a J_a of a cell.
fn mass(mesh: &Mesh, cell: usize, basis: &Lagrange, a: usize) -> f64 {
    basis.weight_2d(a) * map::determinant(&map::jacobian(&mesh.map(cell), basis.node_2d(a)))
}

/// int U dX of a cell, by its own quadrature.
fn integral(grid: &Grid, field: &Field, cell: usize, u: &[f64]) -> [f64; 8] {
    let n = field.basis.len() * field.basis.len();
    let mut sum = [0.0; 8];
    for a in 0..n {
        let mass = mass(grid.mesh, cell, field.basis, a);
        (0..field.components).for_each(|k| sum[k] += mass * u[k * n + a]);
    }
    sum
}

/// Whether component k belongs to F. The mean of such a component is kept; of the others the total is kept.
fn is_momentum(k: usize) -> bool {
    (4..UNKNOWNS).contains(&k)
}

#[cfg(test)]
mod tests;
