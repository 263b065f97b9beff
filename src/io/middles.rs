//! The nodes of a curved mesh beside its corners, for files: in the middle of each edge and of each cell.

use crate::mesh::{FACES, Mesh, map};
use std::collections::HashMap;

/// Nodes that come after those of the mesh.
#[derive(Debug, Default)]
pub(in crate::io) struct Middles {
    /// X, m: those of edges and cells; empty where the mesh is straight.
    pub places: Vec<[f64; 2]>,
    /// By cell for its faces 0 to 3 and itself: index among all nodes.
    pub of: Vec<[usize; 5]>,
}

impl Middles {
    /// Those of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let mut out = Self::default();
        if mesh.curved_cells() == 0 {
            return out;
        }
        let mut on_edges: HashMap<[usize; 2], usize> = HashMap::new();
        for cell in 0..mesh.cells.len() {
            let middles = map::middles(&mesh.map(cell));
            let mut add = |x: [f64; 2]| {
                out.places.push(x);
                mesh.nodes.len() + out.places.len() - 1
            };
            let mut own = [0; 5];
            for face in 0..FACES {
                let [a, b] = mesh.face_nodes(cell, face);
                own[face] = *on_edges.entry([a.min(b), a.max(b)]).or_insert_with(|| add(middles[face]));
            }
            own[4] = add(middles[4]);
            out.of.push(own);
        }
        out
    }

    /// The numbers from 1 of the nodes in some middles of a cell, each after a blank; nothing of a straight mesh.
    pub fn text(&self, cell: usize, which: &[usize]) -> String {
        let of_cell = self.of.get(cell);
        which.iter().filter_map(|k| of_cell.map(|own| format!(" {}", own[*k] + 1))).collect()
    }
}
