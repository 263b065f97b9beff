//! Cuts along edges inside of the body: both sides get nodes of their own.

use std::collections::{HashMap, HashSet};

use super::{BoundaryEdge, Error, Mesh, faces::neighbours};

impl Mesh {
    /// The mesh cut along those edges of `groups` (indices in [`Mesh::edge_groups`]) that lie inside of the body. Both sides of a
    /// cut edge are boundary edges of its group then. A node on a cut becomes as many nodes as the cells around it have parts there
    /// that share no edge; at the tip of a crack it is one part, and one node.
    ///
    /// # Errors
    /// A cut edge both of whose ends are tips: its sides share their nodes still, and nothing opens.
    pub fn split(mut self, groups: &[usize]) -> Result<Self, Error> {
        let cut = self.inner_edges(groups);
        if cut.is_empty() {
            return Ok(self);
        }
        let beyond = neighbours(&self);
        let around = self.cells_around(cut.keys().flatten().copied().collect());
        // By the numbers before the cut.
        let faces = |cell: usize| [0, 1, 2, 3].map(|face| (self.face_nodes(cell, face), self.sorted_nodes(cell, face)));
        let faces: Vec<[([usize; 2], [usize; 2]); 4]> = (0..self.cells.len()).map(faces).collect();
        for (node, cells) in &around {
            let parts = parts_at(cells, |cell, face| {
                let (ends, sorted) = &faces[cell][face];
                beyond[cell][face].filter(|_| ends.contains(node) && !cut.contains_key(sorted))
            });
            for part in &parts[1..] {
                let new = self.nodes.len();
                self.nodes.push(self.nodes[*node]);
                for &cell in part {
                    self.cells[cell].iter_mut().filter(|corner| *corner == node).for_each(|corner| *corner = new);
                }
            }
        }
        self.tag_both_sides(&cut, &beyond)?;
        Ok(self)
    }

    /// The edges of `groups` with a cell on both sides: by their nodes, in ascending order, a side and the group.
    fn inner_edges(&self, groups: &[usize]) -> HashMap<[usize; 2], BoundaryEdge> {
        let beyond = neighbours(self);
        let of_groups = self.edges.iter().filter(|edge| groups.contains(&edge.group));
        let inner = of_groups.filter(|edge| beyond[edge.cell][edge.face].is_some());
        inner.map(|edge| (self.sorted_nodes(edge.cell, edge.face), *edge)).collect()
    }

    fn sorted_nodes(&self, cell: usize, face: usize) -> [usize; 2] {
        let [a, b] = self.face_nodes(cell, face);
        [a.min(b), a.max(b)]
    }

    /// The cells at each of some nodes; nodes and cells in ascending order.
    fn cells_around(&self, nodes: HashSet<usize>) -> Vec<(usize, Vec<usize>)> {
        let mut around: HashMap<usize, Vec<usize>> = nodes.into_iter().map(|node| (node, vec![])).collect();
        for (cell, corners) in self.cells.iter().enumerate() {
            for corner in corners {
                if let Some(cells) = around.get_mut(corner) {
                    cells.push(cell);
                }
            }
        }
        let mut around: Vec<_> = around.into_iter().collect();
        around.sort_unstable();
        around
    }

    /// Gives both sides of the cut edges their group.
    fn tag_both_sides(
        &mut self,
        cut: &HashMap<[usize; 2], BoundaryEdge>,
        beyond: &[[Option<usize>; 4]],
    ) -> Result<(), Error> {
        let mut tagged: HashSet<(usize, usize)> = self.edges.iter().map(|edge| (edge.cell, edge.face)).collect();
        let mut edges: Vec<BoundaryEdge> = cut.values().copied().collect();
        edges.sort_unstable_by_key(|edge| (edge.cell, edge.face));
        for edge in edges {
            let Some(other) = beyond[edge.cell][edge.face] else { continue };
            let back =
                |face: &usize| beyond[other][*face] == Some(edge.cell) && self.is_same_place(&edge, other, *face);
            let Some(face) = (0..4).find(back) else { continue };
            if self.sorted_nodes(edge.cell, edge.face) == self.sorted_nodes(other, face) {
                let at = self.face_nodes(edge.cell, edge.face).map(|node| self.nodes[node]);
                return Err(Error::ShortCrack { at, group: self.edge_groups[edge.group].clone() });
            }
            if tagged.insert((other, face)) {
                self.edges.push(BoundaryEdge { cell: other, face, group: edge.group });
            }
        }
        Ok(())
    }

    /// Whether a face of another cell has the ends of an edge, to the last bit: they were the same nodes.
    fn is_same_place(&self, edge: &BoundaryEdge, cell: usize, face: usize) -> bool {
        let ends = |cell, face| self.face_nodes(cell, face).map(|node| self.nodes[node]);
        let ([a, b], [c, d]) = (ends(edge.cell, edge.face), ends(cell, face));
        (a == c && b == d) || (a == d && b == c)
    }
}

/// The cells at a node by the parts that edges at the node connect; `beyond` is the cell behind a face at the node that is not
/// cut.
fn parts_at(cells: &[usize], beyond: impl Fn(usize, usize) -> Option<usize>) -> Vec<Vec<usize>> {
    let (mut left, mut parts): (Vec<usize>, Vec<Vec<usize>>) = (cells.to_vec(), vec![]);
    while let Some(first) = left.first().copied() {
        let (mut part, mut next) = (vec![], vec![first]);
        left.retain(|cell| *cell != first);
        while let Some(cell) = next.pop() {
            part.push(cell);
            for other in (0..4).filter_map(|face| beyond(cell, face)) {
                if let Some(at) = left.iter().position(|left| *left == other) {
                    next.push(left.swap_remove(at));
                }
            }
            left.sort_unstable();
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Link, links, rectangle};

    /// A rectangle of 4 x 2 cells with a crack of so many edges from the left along its middle.
    fn cracked(edges: usize) -> Mesh {
        let mut mesh = rectangle([4.0, 2.0], [4, 2]).unwrap();
        mesh.edge_groups.push("crack".to_owned());
        mesh.edges.extend((0..edges).map(|cell| BoundaryEdge { cell, face: 3, group: 4 }));
        mesh
    }

    #[test]
    fn both_sides_of_a_crack_have_their_own_nodes_but_at_its_tip() {
        let (whole, split) = (cracked(2), cracked(2).split(&[4]).unwrap());
        assert_eq!(split.nodes.len(), whole.nodes.len() + 2);
        assert_eq!(split.edge_counts()[4].boundary, 4);
        assert_eq!(split.edge_counts()[4].inner, 0);
        let links = links(&split).unwrap();
        for cell in 0..2 {
            assert_eq!(links[cell][3], Link::Boundary(4));
            assert_eq!(links[cell + 4][2], Link::Boundary(4));
        }
        assert!(matches!(links[2][3], Link::Cell { cell: 6, .. }));
    }

    #[test]
    fn a_cut_through_the_body_makes_two_parts_and_one_of_one_edge_inside_is_refused() {
        let split = cracked(4).split(&[4]).unwrap();
        assert_eq!(split.nodes.len(), 15 + 5);
        let mut inside = rectangle([3.0, 2.0], [3, 2]).unwrap();
        inside.edge_groups.push("crack".to_owned());
        inside.edges.push(BoundaryEdge { cell: 1, face: 3, group: 4 });
        assert!(matches!(inside.split(&[4]), Err(Error::ShortCrack { .. })));
    }

    #[test]
    fn where_cuts_cross_each_quarter_has_a_node_of_its_own() {
        let mut mesh = rectangle([2.0, 2.0], [2, 2]).unwrap();
        mesh.edge_groups.push("cross".to_owned());
        mesh.edges.extend([(0, 1), (0, 3), (3, 0), (3, 2)].map(|(cell, face)| BoundaryEdge { cell, face, group: 4 }));
        let split = mesh.split(&[4]).unwrap();
        assert_eq!(split.nodes.len(), 16);
        assert!(links(&split).unwrap().iter().flatten().all(|link| link.cell().is_none()));
    }

    #[test]
    fn a_group_without_inner_edges_leaves_the_mesh_as_it_is() {
        let mesh = rectangle([4.0, 2.0], [4, 2]).unwrap();
        assert_eq!(mesh.clone().split(&[0, 1, 2, 3]).unwrap(), mesh);
    }
}
