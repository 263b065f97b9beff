//! Uniform refinement: every cell becomes k x k cells.

use super::map::{self, Bulge};
use super::{BoundaryEdge, FACE_CORNERS, Mesh};
use std::collections::HashMap;

impl Mesh {
    /// The mesh whose cells are k x k parts of these, cut along their parent coordinates (k >= 1): the same
    /// geometry and the same groups. Part (i, j) of cell c has the index k^2 c + k j + i. The new cells are numbered from 1.
    pub fn refined(&self, k: usize) -> Mesh {
        if k <= 1 {
            return self.clone();
        }
        let mut out = Mesh { groups: self.groups.clone(), edge_groups: self.edge_groups.clone(), ..Mesh::default() };
        let mut nodes = Nodes { mesh: self, k, of_mesh: HashMap::new(), on_edges: HashMap::new() };
        for cell in 0..self.cells.len() {
            let grid: Vec<usize> =
                (0..=k).flat_map(|j| (0..=k).map(move |i| [i, j])).map(|at| nodes.find(cell, at, &mut out)).collect();
            let node = |i: usize, j: usize| grid[(k + 1) * j + i];
            for (j, i) in (0..k).flat_map(|j| (0..k).map(move |i| (j, i))) {
                out.cells.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
                out.cell_group.push(self.cell_group[cell]);
            }
        }
        out.original = (1..=out.cells.len() as u64).collect();
        out.bulges = self.bulges.iter().flat_map(|bulge| parts(bulge, k)).collect();
        for edge in &self.edges {
            let part = |along: usize| match edge.face {
                0 => k * along,
                1 => k * along + k - 1,
                2 => along,
                _ => k * (k - 1) + along,
            };
            let parts = (0..k).map(|along| BoundaryEdge { cell: k * k * edge.cell + part(along), ..*edge });
            out.edges.extend(parts);
        }
        out
    }
}

/// The bulges of the k x k parts of a cell. Each is 1/k^2 of the curvature of the line that the edge of the part lies on; that of the
/// middle, which is of degree 2 in both directions, 1/k^4.
fn parts(bulge: &Bulge, k: usize) -> impl Iterator<Item = Bulge> {
    let (bulge, steps) = (*bulge, k as f64);
    let along = move |pair: usize, step: usize| {
        let s = step as f64 / steps;
        // The ends to the last bit, so that neighbours agree.
        [0, 1].map(|i| match step {
            0 => bulge[pair][i],
            _ if step == k => bulge[pair + 1][i],
            _ => (1.0 - s) * bulge[pair][i] + s * bulge[pair + 1][i] + 4.0 * s * (1.0 - s) * bulge[4][i],
        })
    };
    (0..k).flat_map(move |j| (0..k).map(move |i| (i, j))).map(move |(i, j)| {
        let faces =
            [along(0, i), along(0, i + 1), along(2, j), along(2, j + 1)].map(|d| d.map(|d| d / (steps * steps)));
        let [a, b, c, d] = faces;
        [a, b, c, d, bulge[4].map(|d| d / steps.powi(4))]
    })
}

/// Nodes of the finer mesh that cells share.
struct Nodes<'a> {
    mesh: &'a Mesh,
    k: usize,
    /// The new node at each node of the mesh.
    of_mesh: HashMap<usize, usize>,
    /// The new nodes on edges, by the two nodes of the edge (lower index first) and the number of steps from the first.
    on_edges: HashMap<([usize; 2], usize), usize>,
}

impl Nodes<'_> {
    /// The node at (i, j) / k of a cell. It is made if it does not exist yet.
    fn find(&mut self, cell: usize, [i, j]: [usize; 2], out: &mut Mesh) -> usize {
        let k = self.k;
        let map = self.mesh.map(cell);
        let mut new = |x: [f64; 2]| {
            out.nodes.push(x);
            out.nodes.len() - 1
        };
        let face = match (i, j) {
            _ if [0, k].contains(&i) && [0, k].contains(&j) => {
                let corner = [[0, 3], [1, 2]][i / k][j / k];
                let node = self.mesh.cells[cell][corner];
                return *self.of_mesh.entry(node).or_insert_with(|| new(self.mesh.nodes[node]));
            }
            (0, _) => 0,
            _ if i == k => 1,
            (_, 0) => 2,
            _ if j == k => 3,
            _ => return new(map::position(&map, [i as f64 / k as f64, j as f64 / k as f64])),
        };
        let [first, last] = FACE_CORNERS[face].map(|corner| self.mesh.cells[cell][corner]);
        let along = if face < 2 { j } else { i };
        let (ends, step) = if first < last { ([first, last], along) } else { ([last, first], k - along) };
        *self.on_edges.entry((ends, step)).or_insert_with(|| {
            // Computed from the shared ends, not from the cell: both sides get the same bits.
            let [a, b] = ends.map(|node| self.mesh.nodes[node]);
            let s = step as f64 / k as f64;
            let straight = [0, 1].map(|axis| a[axis] + s * (b[axis] - a[axis]));
            let bulge = map.bulge.map_or([0.0; 2], |bulge| bulge[face]);
            new([0, 1].map(|axis| straight[axis] + 4.0 * s * (1.0 - s) * bulge[axis]))
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{links, map, rectangle};

    #[test]
    fn a_refined_rectangle_is_the_finer_rectangle() {
        let (fine, made) = (rectangle([3.0, 2.0], [6, 4]).unwrap(), rectangle([3.0, 2.0], [3, 2]).unwrap().refined(2));
        assert_eq!((made.cells.len(), made.nodes.len(), made.edges.len()), (24, 35, 20));
        let centres = |mesh: &crate::mesh::Mesh| {
            let mut all: Vec<[i64; 2]> = (0..mesh.cells.len())
                .map(|cell| map::position(&mesh.map(cell), [0.5, 0.5]).map(|x| (x * 1e6).round() as i64))
                .collect();
            all.sort_unstable();
            all
        };
        assert_eq!(centres(&fine), centres(&made));
        for edge in &made.edges {
            let ends = made.face_nodes(edge.cell, edge.face).map(|n| made.nodes[n]);
            let (axis, value) = [(0, 0.0), (0, 3.0), (1, 0.0), (1, 2.0)][edge.group];
            assert!(ends.iter().all(|x| x[axis] == value), "{edge:?} at {ends:?}");
        }
    }

    #[test]
    fn a_distorted_mesh_with_turned_cells_stays_whole_and_keeps_its_area() {
        let mut mesh = rectangle([2.0, 2.0], [2, 2]).unwrap();
        mesh.nodes[4] = [1.2, 0.9];
        // The second cell starts at another corner: its faces run against those of its neighbours.
        mesh.cells[1].rotate_left(2);
        for edge in mesh.edges.iter_mut().filter(|edge| edge.cell == 1) {
            edge.face = [1, 0, 3, 2][edge.face];
        }
        let fine = mesh.refined(3);
        assert_eq!((fine.cells.len(), fine.nodes.len(), fine.edges.len()), (36, 49, 24));
        let area =
            |mesh: &crate::mesh::Mesh| -> f64 { (0..mesh.cells.len()).map(|cell| map::area(&mesh.map(cell))).sum() };
        // Rounding of 36 sums.
        assert!((area(&fine) - area(&mesh)).abs() < 1e-13);
        // Every face has its neighbour or its group.
        links(&fine.checked().unwrap()).unwrap();
    }

    #[test]
    fn the_parts_of_a_curved_cell_lie_on_its_map() {
        let mut mesh = rectangle([2.0, 1.0], [2, 1]).unwrap();
        let shared = [0.1, 0.05];
        mesh.bulges = vec![
            [[0.0, 0.02], shared, [0.1, -0.2], [0.0; 2], [0.05, 0.03]],
            [shared, [0.0; 2], [0.0, 0.1], [0.02, 0.1], [0.0; 2]],
        ];
        let fine = mesh.refined(3);
        let area =
            |mesh: &crate::mesh::Mesh| -> f64 { (0..mesh.cells.len()).map(|cell| map::area(&mesh.map(cell))).sum() };
        assert!((area(&fine) - area(&mesh)).abs() < 1e-14);
        for cell in 0..2 {
            for (i, j) in (0..3).flat_map(|j| (0..3).map(move |i| (i, j))) {
                let part = fine.map(9 * cell + 3 * j + i);
                for xi in [[0.2, 0.7], [0.9, 0.1], [0.5, 0.0], [0.0, 0.3]] {
                    let whole = [(i as f64 + xi[0]) / 3.0, (j as f64 + xi[1]) / 3.0];
                    let (x, y) = (map::position(&part, xi), map::position(&mesh.map(cell), whole));
                    assert!((x[0] - y[0]).hypot(x[1] - y[1]) < 1e-15, "cell {cell}, part {i} {j}");
                }
            }
        }
        links(&fine.checked().unwrap()).unwrap();
    }
}
