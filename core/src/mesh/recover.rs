//! The gradient of values at the nodes of a mesh, of one order more than that of their bilinear interpolation.
//!
//! At each node it is that of the quadratic polynomial that fits the values around the node best (polynomial preserving recovery,
//! Zhang and Naga, SIAM J. Sci. Comput. 26, 2005): exact for quadratic values, of order 2 up to the boundary.

use super::Mesh;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use std::collections::HashMap;

/// Times that a patch grows by the cells around it before a plane is fitted: at a boundary one time gives three rows of nodes.
const GROWTHS: usize = 3;
/// The smallest pivot, over the largest entry, of a fit that counts: patches of good cells have 1e-2, two rows of nodes 1e-16.
const PIVOT: f64 = 1e-6;

/// du_i/dX_j at each node, as 11, 12, 21, 22. Nodes in one place, which a file may have, are one. A node of no cell has zeros.
pub fn gradient(mesh: &Mesh, values: &[[f64; 2]]) -> Vec<[f64; 4]> {
    let around = Around::new(mesh);
    (0..mesh.nodes.len()).into_par_iter().map(|node| around.gradient(node, values)).collect()
}

/// What lies around each place that has nodes.
struct Around<'a> {
    mesh: &'a Mesh,
    /// The place of each node: the first node that is there.
    place: Vec<usize>,
    /// Cells at each place.
    cells: Vec<Vec<usize>>,
}

impl<'a> Around<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let mut known = HashMap::new();
        let places = mesh.nodes.iter().enumerate();
        // + 0.0: -0 is 0.
        let place: Vec<usize> =
            places.map(|(node, x)| *known.entry(x.map(|x| (x + 0.0).to_bits())).or_insert(node)).collect();
        let mut cells = vec![Vec::new(); mesh.nodes.len()];
        for (cell, nodes) in mesh.cells.iter().enumerate() {
            nodes.iter().for_each(|&node| cells[place[node]].push(cell));
        }
        Self { mesh, place, cells }
    }

    fn gradient(&self, node: usize, values: &[[f64; 2]]) -> [f64; 4] {
        let mut patch = self.grown(&[node]);
        let parabola = |patch: &[usize]| fit::<6>(&self.mesh.nodes, values, patch, self.mesh.nodes[node]);
        for _ in 0..GROWTHS {
            if let Some(gradient) = parabola(&patch) {
                return gradient;
            }
            patch = self.grown(&patch);
        }
        // A body of few cells.
        let plane = || fit::<3>(&self.mesh.nodes, values, &self.grown(&[node]), self.mesh.nodes[node]);
        parabola(&patch).or_else(plane).unwrap_or_default()
    }

    /// The nodes of all cells at some nodes, by their numbers.
    fn grown(&self, nodes: &[usize]) -> Vec<usize> {
        let cells = nodes.iter().flat_map(|&node| &self.cells[self.place[node]]);
        let mut all: Vec<usize> = cells.flat_map(|&cell| self.mesh.cells[cell]).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// The gradient at `at` of the polynomials of M terms (3: linear, 6: quadratic) that fit the values at some nodes best; none where these
/// cannot carry them.
fn fit<const M: usize>(nodes: &[[f64; 2]], values: &[[f64; 2]], patch: &[usize], at: [f64; 2]) -> Option<[f64; 4]> {
    if patch.len() < M {
        return None;
    }
    // About the mean and by the size of the patch the sums are well conditioned.
    let mean = |of: &[[f64; 2]]| [0, 1].map(|i| patch.iter().map(|&p| of[p][i]).sum::<f64>() / patch.len() as f64);
    let (centre, level) = (mean(nodes), mean(values));
    let away = |x: [f64; 2]| [x[0] - centre[0], x[1] - centre[1]];
    let size = patch.iter().flat_map(|&p| away(nodes[p])).fold(0.0, |size: f64, x| size.max(x.abs()));
    let terms = |x: [f64; 2]| {
        let [x, y] = away(x).map(|x| x / size);
        SVector::<f64, M>::from_fn(|k, _| [1.0, x, y, x * x, x * y, y * y][k])
    };
    let (mut normal, mut right) = (SMatrix::<f64, M, M>::zeros(), SMatrix::<f64, M, 2>::zeros());
    for &p in patch {
        let t = terms(nodes[p]);
        normal += t * t.transpose();
        right += t * SMatrix::<f64, 1, 2>::new(values[p][0] - level[0], values[p][1] - level[1]);
    }
    let factor = normal.cholesky()?;
    let pivots = factor.l_dirty().diagonal();
    if pivots.min().powi(2) <= PIVOT * normal.max() {
        return None;
    }
    let found = factor.solve(&right);
    let [x, y] = away(at).map(|x| x / size);
    let slope = |i: usize| {
        let of = |k: usize| if k < M { found[(k, i)] } else { 0.0 };
        [of(1) + 2.0 * of(3) * x + of(4) * y, of(2) + of(4) * x + 2.0 * of(5) * y].map(|slope| slope / size)
    };
    let [[a, b], [c, d]] = [slope(0), slope(1)];
    Some([a, b, c, d])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    fn skewed(n: usize) -> Mesh {
        let mut mesh = rectangle([1.0, 1.0], [n, n]).unwrap();
        for x in &mut mesh.nodes {
            // No cell is a parallelogram.
            *x = [x[0] + 0.1 * x[0] * x[1], x[1] - 0.05 * x[0] * x[0]];
        }
        mesh
    }

    #[test]
    fn the_gradient_of_quadratic_values_is_exact_at_all_nodes_also_where_each_cell_has_its_own() {
        let shared = skewed(4);
        let mut own = shared.clone();
        own.nodes = own.cells.iter().flatten().map(|&node| shared.nodes[node]).collect();
        (0..own.cells.len()).for_each(|cell| own.cells[cell] = [0, 1, 2, 3].map(|k| 4 * cell + k));
        for mesh in [shared, own] {
            let values: Vec<[f64; 2]> =
                mesh.nodes.iter().map(|&[x, y]| [1e3 + 2.0 * x - y + x * x - 3.0 * x * y, y * y - x]).collect();
            for (&[x, y], found) in mesh.nodes.iter().zip(gradient(&mesh, &values)) {
                let exact = [2.0 + 2.0 * x - 3.0 * y, -1.0 - 3.0 * x, -1.0, 2.0 * y];
                for (a, b) in found.into_iter().zip(exact) {
                    // Values of 1e3 over distances of 0.1, with the rounding of the sums.
                    assert!((a - b).abs() < 1e-10, "{x} {y}: {found:?} {exact:?}");
                }
            }
        }
    }

    #[test]
    fn where_a_body_has_too_few_nodes_for_a_parabola_a_plane_is_fitted() {
        for cells in [[1, 1], [3, 1]] {
            let mesh = rectangle([1.0, 1.0], cells).unwrap();
            let values: Vec<[f64; 2]> = mesh.nodes.iter().map(|&[x, y]| [3.0 * x - y, 2.0 * y]).collect();
            for found in gradient(&mesh, &values) {
                let exact = [3.0, -1.0, 0.0, 2.0];
                assert!(found.into_iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-14), "{cells:?}: {found:?}");
            }
        }
    }

    #[test]
    fn the_gradient_of_smooth_values_has_order_2_up_to_the_boundary() {
        let error = |n: usize| {
            let mesh = skewed(n);
            let values: Vec<[f64; 2]> = mesh.nodes.iter().map(|&[x, y]| [(3.0 * x + y).sin(), 0.0]).collect();
            let all = mesh.nodes.iter().zip(gradient(&mesh, &values));
            all.map(|(&[x, y], found)| (found[0] - 3.0 * (3.0 * x + y).cos()).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(16), error(32));
        // h^2, less what terms of h^3 take at 32 cells.
        assert!(coarse / fine > 3.5, "{coarse:e} {fine:e}");
    }
}
