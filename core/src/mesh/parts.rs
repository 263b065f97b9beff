//! The parts of a mesh that share no edge, and the groups of edges inside the body.

use std::collections::{HashMap, HashSet};

use super::{BoundaryEdge, Mesh};

/// The edges of a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EdgeCount {
    /// Edges with a cell on both sides: they lie inside of the body and are no boundary.
    pub inner: usize,
    /// Edges with a cell on one side.
    pub boundary: usize,
}

/// A part of a mesh: cells that are connected through edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The cell with the lowest index.
    pub first: usize,
    /// How many cells it has.
    pub cells: usize,
}

impl Mesh {
    /// The edges of each group of [`Mesh::edge_groups`]. An edge that is given from both of its cells counts once.
    pub fn edge_counts(&self) -> Vec<EdgeCount> {
        let key = |cell: usize, face: usize| {
            let [a, b] = self.face_nodes(cell, face);
            [a.min(b), a.max(b)]
        };
        let mut of_group = vec![false; self.nodes.len()];
        let mut cells: HashMap<[usize; 2], usize> = HashMap::with_capacity(self.edges.len());
        for edge in &self.edges {
            let nodes = key(edge.cell, edge.face);
            nodes.into_iter().for_each(|node| of_group[node] = true);
            cells.insert(nodes, 0);
        }
        for cell in 0..self.cells.len() {
            for face in 0..4 {
                let nodes = key(cell, face);
                // Most faces have no such node, so their lookup is skipped.
                if nodes.into_iter().all(|node| of_group[node])
                    && let Some(count) = cells.get_mut(&nodes)
                {
                    *count += 1;
                }
            }
        }
        let mut counts = vec![EdgeCount::default(); self.edge_groups.len()];
        let mut seen = HashSet::with_capacity(self.edges.len());
        for edge in &self.edges {
            let nodes = key(edge.cell, edge.face);
            if seen.insert((edge.group, nodes)) {
                let count = &mut counts[edge.group];
                if cells.get(&nodes).is_some_and(|&cells| cells > 1) { count.inner += 1 } else { count.boundary += 1 }
            }
        }
        counts
    }

    /// The edges of each group of [`Mesh::edge_groups`] that both sides of a gap of width 0 bear (a cut, [`Mesh::split`]) as `inner`, once
    /// each, and the others as `boundary`.
    pub fn cut_counts(&self) -> Vec<EdgeCount> {
        let ends = |edge: &BoundaryEdge| {
            let [a, b] = self.face_nodes(edge.cell, edge.face).map(|node| self.nodes[node].map(f64::to_bits));
            [a.min(b), a.max(b)]
        };
        let mut sides: HashMap<(usize, [[u64; 2]; 2]), usize> = HashMap::with_capacity(self.edges.len());
        self.edges.iter().for_each(|edge| *sides.entry((edge.group, ends(edge))).or_default() += 1);
        let mut counts = vec![EdgeCount::default(); self.edge_groups.len()];
        for ((group, _), sides) in sides {
            if sides > 1 { counts[group].inner += 1 } else { counts[group].boundary += 1 }
        }
        counts
    }
}

/// The parts of `cells` cells, in the order of their first cells; `neighbours` are the cells behind the faces of a cell.
///
/// Nothing passes from one part to another: fluxes pass through edges, and contact is not computed.
pub fn parts<I: IntoIterator<Item = usize>>(cells: usize, neighbours: impl Fn(usize) -> I) -> Vec<Part> {
    let mut seen = vec![false; cells];
    let (mut out, mut open) = (Vec::new(), Vec::new());
    for first in 0..cells {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut count = 0;
        open.push(first);
        while let Some(cell) = open.pop() {
            count += 1;
            for other in neighbours(cell) {
                if !std::mem::replace(&mut seen[other], true) {
                    open.push(other);
                }
            }
        }
        out.push(Part { first, cells: count });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Link, links, rectangle};

    /// 4 x 1 cells; the edges between the first two and between the last two are of the group `inside`.
    fn with_inner_edges() -> Mesh {
        let mut mesh = rectangle([4.0, 1.0], [4, 1]).unwrap();
        mesh.edge_groups.push("inside".to_owned());
        mesh.edges.push(BoundaryEdge { cell: 0, face: 1, group: 4 });
        mesh.edges.push(BoundaryEdge { cell: 3, face: 0, group: 4 });
        mesh
    }

    #[test]
    fn edges_between_two_cells_are_inner_ones_and_count_once() {
        let mut mesh = with_inner_edges();
        let count = |inner, boundary| EdgeCount { inner, boundary };
        assert_eq!(mesh.edge_counts(), [count(0, 1), count(0, 1), count(0, 4), count(0, 4), count(2, 0)]);
        // The first of them from its other cell, too; and an edge of the top in the same group.
        mesh.edges.push(BoundaryEdge { cell: 1, face: 0, group: 4 });
        mesh.edges.iter_mut().find(|edge| edge.face == 3).unwrap().group = 4;
        assert_eq!(mesh.edge_counts()[3..], [count(0, 3), count(2, 1)]);
    }

    #[test]
    fn parts_are_what_edges_connect() {
        let of = |mesh: &Mesh| {
            let links = links(mesh).unwrap();
            parts(mesh.cells.len(), |cell| links[cell].iter().filter_map(Link::cell).collect::<Vec<_>>())
        };
        let whole = with_inner_edges();
        assert_eq!(of(&whole), [Part { first: 0, cells: 4 }]);
        // Cell 1 gets nodes of its own at its left side: a gap of width 0.
        let mut split = whole.clone();
        for corner in [0, 3] {
            split.nodes.push(split.nodes[split.cells[1][corner]]);
            split.cells[1][corner] = split.nodes.len() - 1;
        }
        split.edges.push(BoundaryEdge { cell: 1, face: 0, group: 4 });
        assert_eq!(of(&split), [Part { first: 0, cells: 1 }, Part { first: 1, cells: 3 }]);
        // Cells that touch at a corner only do not see each other either.
        let mut corner = rectangle([2.0, 2.0], [2, 2]).unwrap();
        corner.cells = vec![corner.cells[0], corner.cells[3]];
        (corner.cell_group, corner.original) = (vec![0; 2], vec![1, 2]);
        let faces = (0..2).flat_map(|cell| (0..4).map(move |face| BoundaryEdge { cell, face, group: 0 }));
        corner.edges = faces.collect();
        assert_eq!(of(&corner), [Part { first: 0, cells: 1 }, Part { first: 1, cells: 1 }]);
    }
}
