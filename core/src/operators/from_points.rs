//! Grid unknowns from material points alone, P2G by chi (18): the start from a cloud.
//!
//! With N+2 points per direction the order is kept (design section 8). Momentum and mean F are those of the fit. They
//! are not exactly those of the body that the points came from, because its grid is not known.

use super::carry::{Limits, trees};
use super::certificate::of_points;
use super::{Line, Matrix, PointMatrices, Sampling};
use crate::basis::mls::patch;
use crate::cloud::{Cloud, Tree};
use crate::error::Error;
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

/// Values at the nodes, `[cell][component][node]`, from values at the points, `[point][component]`.
///
/// A cell takes the fit of Q_N to its own points. Where these cannot carry it (`limits`, as for sampling), it takes the
/// fit of P_N in X to the nearest points of its group of cells. Their number is such that their Lebesgue constant at
/// the nodes of the cell (how much the fit amplifies errors there) is within the limit. This fit also has the order
/// N+1, and is exact on P_N.
///
/// # Errors
/// A cell with too few points around it; the error has its number.
pub fn from_points(
    mesh: &Mesh,
    line: &Line,
    cloud: &Cloud,
    limits: &Limits,
    values: &[f64],
    components: usize,
) -> Result<Vec<f64>, Error> {
    let nodes = line.nodes();
    let (class, examples) = Sampling::Cloud(cloud).classes(&nodes, mesh.cells.len());
    let fit = |&cell: &usize| {
        let bad = limits.cause(&of_points(line, cloud.of(cell))?, nodes.len()).is_some();
        if bad { Ok(None) } else { to_nodes(line, cloud.of(cell), mesh.number(cell)).map(Some) }
    };
    let fits = examples.par_iter().map(fit).collect::<Result<Vec<Option<Matrix<f64>>>, Error>>()?;
    let deficient: Vec<usize> = (0..mesh.cells.len()).filter(|&cell| fits[class[cell]].is_none()).collect();
    let trees = trees(mesh, cloud, &deficient)?;
    let of_cell = |cell: usize| {
        let own: Vec<usize> = (cloud.first[cell]..cloud.first[cell + 1]).collect();
        let (weights, points) = match (&fits[class[cell]], &trees[mesh.cell_group[cell]]) {
            (Some(weights), _) => (weights.data.clone(), own),
            (None, Some(tree)) => around(mesh, line, limits, cell, tree)?,
            // `trees` has a tree for each group that has a cell whose points cannot carry Q_N.
            (None, None) => return Err(without_points(mesh, line, cell)),
        };
        let rows = weights.chunks(points.len());
        let value = |row: &[f64], k: usize| row.iter().zip(&points).map(|(w, p)| w * values[p * components + k]).sum();
        Ok((0..components).flat_map(|k| rows.clone().map(move |row| (row, k))).map(|(row, k)| value(row, k)).collect())
    };
    let all = (0..mesh.cells.len()).into_par_iter().map(of_cell).collect::<Result<Vec<Vec<f64>>, Error>>()?;
    Ok(all.concat())
}

/// chi_p at the nodes, (N+1)^2 x N_p.
fn to_nodes(line: &Line, xi: &[[f64; 2]], number: u64) -> Result<Matrix<f64>, Error> {
    match PointMatrices::at_points(line, xi, number)?.to_dense() {
        PointMatrices::Dense { to_nodes, .. } => Ok(to_nodes),
        // `to_dense` gives no other kind.
        PointMatrices::Lattice(_) | PointMatrices::Nodes(_) => Err(Error::input(
            format!("the points of cell {number} have no matrix"),
            "put at least (N+1)^2 points in general position into each cell",
        )),
    }
}

/// Weights `[node][point]` of the fit to the points around a cell, and the numbers of these.
fn around(
    mesh: &Mesh,
    line: &Line,
    limits: &Limits,
    cell: usize,
    tree: &Tree,
) -> Result<(Vec<f64>, Vec<usize>), Error> {
    let map = mesh.map(cell);
    let at: Vec<[f64; 2]> = line.nodes().into_iter().map(|xi| map::position(&map, xi)).collect();
    let middle = map::position(&map, [0.5, 0.5]);
    let unknowns = line.m * (line.m + 1) / 2;
    // The number of points goes from as few as are safe on average to those of some rings of cells.
    for count in [2, 3, 4, 6, 8, 12, 16, 24].map(|times| times * unknowns) {
        let near: Vec<_> = tree.nearest_neighbor_iter(middle).take(count).collect();
        let x: Vec<[f64; 2]> = near.iter().map(|point| *point.geom()).collect();
        let Some(rows) = patch(line.m - 1, middle, &x, &at) else { continue };
        let amplification = |row: &Vec<f64>| row.iter().map(|w| w.abs()).sum::<f64>();
        if rows.iter().map(amplification).fold(0.0, f64::max) <= limits.lebesgue {
            return Ok((rows.concat(), near.iter().map(|point| point.data).collect()));
        }
        if near.len() < count {
            break;
        }
    }
    Err(without_points(mesh, line, cell))
}

fn without_points(mesh: &Mesh, line: &Line, cell: usize) -> Error {
    Error::input(
        format!("the points in and around cell {} cannot give its state of degree {}", mesh.number(cell), line.m - 1),
        "give more points there, a coarser mesh, or a lower scheme.degree",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Layout, seed};
    use crate::mesh::rectangle;

    /// Points at random positions, and none in the cells of `empty`.
    fn cloud(cells: usize, k: usize, empty: &[usize]) -> Cloud {
        let whole = seed(Layout::Jitter { seed: 2, amount: 0.3 }, k, cells);
        Cloud::of_cells(cells, |cell, xi| {
            if !empty.contains(&cell) {
                xi.extend_from_slice(whole.of(cell));
            }
        })
    }

    #[test]
    fn polynomials_come_back_from_points_even_in_empty_cells() {
        let mut mesh = rectangle([1.0, 1.0], [4, 4]).unwrap();
        mesh.nodes[6] = [0.28, 0.22];
        for degree in 1..=4_usize {
            let (line, n) = (Line::new(degree), degree as i32);
            // Two cells of the inside, a corner, and a pair at the edge.
            let cloud = cloud(16, degree + 2, &[5, 10, 0, 7, 11]);
            // P_N in X lies in the mapped Q_N of every bilinear cell.
            let field = |x: [f64; 2]| [x[0].powi(n) - 0.5 * x[1], x[1].powi(n) + x[0] + 2.0];
            let values: Vec<f64> = (0..16)
                .flat_map(|cell| cloud.of(cell).iter().map(move |&xi| (cell, xi)))
                .flat_map(|(cell, xi)| field(map::position(&mesh.map(cell), xi)))
                .collect();
            let found = from_points(&mesh, &line, &cloud, &Limits::of_degree(degree), &values, 2).unwrap();
            for (cell, values) in found.chunks(2 * line.m * line.m).enumerate() {
                for (a, &xi) in line.nodes().iter().enumerate() {
                    let exact = field(map::position(&mesh.map(cell), xi));
                    for k in 0..2 {
                        // Rounding of numbers up to 3 times the Lebesgue constant, and the condition of the fit.
                        assert!((values[k * line.m * line.m + a] - exact[k]).abs() < 1e-12, "S{degree} cell {cell}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_cell_that_nothing_stands_around_is_named() {
        let mesh = rectangle([1.0, 1.0], [4, 4]).unwrap();
        let few = Cloud::of_cells(16, |cell, xi| {
            if cell == 3 {
                xi.extend([[0.1, 0.2], [0.7, 0.4]])
            }
        });
        let why = from_points(&mesh, &Line::new(2), &few, &Limits::of_degree(2), &[0.0; 2], 1).unwrap_err();
        assert!(why.to_string().contains("cell 1") && why.exit_code() == 2, "{why}");
    }
}
