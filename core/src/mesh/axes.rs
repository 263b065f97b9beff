//! The axes of cells: the corner from which a cell counts its corners.

use super::{BoundaryEdge, Link, Mesh, links};
use std::collections::VecDeque;

/// The face across a cell.
const OPPOSITE: [usize; 4] = [1, 0, 3, 2];

/// The faces of a cell counter-clockwise, from xi1 = 1.
const AROUND: [usize; 4] = [1, 3, 0, 2];

/// The place of each face in [`AROUND`].
const QUARTER: [usize; 4] = [2, 0, 3, 1];

/// The largest number of rounds in which cells turn to agree with most of their neighbours. Each turn makes more faces
/// agree, so that few rounds are needed.
const ROUNDS: usize = 50;

impl Mesh {
    /// The mesh with its cells turned by quarters (their corners counted from another one on) so that neighbours have
    /// the same axes where this is possible. The step then reads the other sides of the faces of eight cells from fewer
    /// places. A mesh in rows stays as it is, and so does a mesh whose links are wrong.
    ///
    /// Where three or five cells meet at a node, not all of them can have the same axes. First each cell follows its
    /// neighbours that have been turned, outwards from the first cell. Then all cells are turned as long as more faces
    /// agree.
    pub fn with_common_axes(mut self) -> Self {
        let Ok(links) = links(&self) else { return self };
        let mut turns: Vec<Option<usize>> = vec![None; links.len()];
        for cell in outwards(&links) {
            turns[cell] = Some(best(&links, &turns, cell));
        }
        for _ in 0..ROUNDS {
            let mut still = true;
            for cell in 0..links.len() {
                let best = Some(best(&links, &turns, cell));
                still &= turns[cell] == best;
                turns[cell] = best;
            }
            if still {
                break;
            }
        }
        let turns: Vec<usize> = turns.into_iter().map(Option::unwrap_or_default).collect();
        for (cell, &turns) in self.cells.iter_mut().zip(&turns) {
            cell.rotate_left(turns);
        }
        for (bulge, &turns) in self.bulges.iter_mut().zip(&turns) {
            let old = *bulge;
            (0..4).for_each(|face| bulge[turned(face, turns)] = old[face]);
        }
        for BoundaryEdge { cell, face, .. } in &mut self.edges {
            *face = turned(*face, turns[*cell]);
        }
        self
    }
}

/// All cells, breadth first from the first one of each part.
fn outwards(links: &[[Link; 4]]) -> Vec<usize> {
    let (mut order, mut queue, mut seen) = (Vec::new(), VecDeque::new(), vec![false; links.len()]);
    for first in 0..links.len() {
        queue.push_back(first);
        while let Some(cell) = queue.pop_front() {
            if !std::mem::replace(&mut seen[cell], true) {
                order.push(cell);
                queue.extend(links[cell].iter().filter_map(Link::cell));
            }
        }
    }
    order
}

/// The number of quarter turns with which most neighbours of a cell agree. It is the present number if no other is
/// better, and 0 at the start.
fn best(links: &[[Link; 4]], turns: &[Option<usize>], cell: usize) -> usize {
    let agrees = |turn: usize, (face, link): (usize, &Link)| match *link {
        Link::Cell { cell, face: entry, .. } => {
            // At opposite faces both axes run the same way, because all cells are counter-clockwise.
            turns[cell].is_some_and(|theirs| turned(entry, theirs) == OPPOSITE[turned(face, turn)])
        }
        Link::Boundary(_) => false,
    };
    let votes = |turn: usize| links[cell].iter().enumerate().filter(|link| agrees(turn, *link)).count();
    let own = turns[cell].unwrap_or(0);
    (0..4).fold(own, |best, turn| if votes(turn) > votes(best) { turn } else { best })
}

/// The number that a face gets by quarter turns of its cell.
fn turned(face: usize, turns: usize) -> usize {
    AROUND[(QUARTER[face] + 4 - turns) % 4]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    /// A rectangle whose cells count from any corner.
    fn shuffled(n: [usize; 2]) -> Mesh {
        let mut mesh = rectangle([n[0] as f64, n[1] as f64], n).unwrap();
        let turns: Vec<usize> = (0..mesh.cells.len()).map(|cell| (7 * cell + cell / 3) % 4).collect();
        mesh.cells.iter_mut().zip(&turns).for_each(|(cell, &turns)| cell.rotate_left(turns));
        mesh.edges.iter_mut().for_each(|edge| edge.face = turned(edge.face, turns[edge.cell]));
        mesh
    }

    /// The number of inner faces whose two cells have different axes.
    fn broken(mesh: &Mesh) -> usize {
        let links = links(mesh).unwrap();
        let breaks = |(face, link): &(usize, &Link)| match **link {
            Link::Cell { face: entry, flip, .. } => entry != OPPOSITE[*face] || flip,
            Link::Boundary(_) => false,
        };
        links.iter().flat_map(|links| links.iter().enumerate()).filter(breaks).count()
    }

    #[test]
    fn a_turned_cell_keeps_its_faces_where_they_are() {
        let (plain, mesh) = (rectangle([5.0, 4.0], [5, 4]).unwrap(), shuffled([5, 4]));
        let ends = |mesh: &Mesh, edge: &BoundaryEdge| {
            let mut ends = mesh.face_nodes(edge.cell, edge.face);
            ends.sort_unstable();
            ends
        };
        for (a, b) in plain.edges.iter().zip(&mesh.edges) {
            assert_eq!(ends(&plain, a), ends(&mesh, b));
        }
    }

    #[test]
    fn cells_of_a_rectangle_that_count_from_any_corner_get_the_axes_of_the_first() {
        let mesh = shuffled([13, 11]);
        assert!(broken(&mesh) > 0);
        let common = mesh.with_common_axes();
        assert_eq!(broken(&common), 0);
        // The first cell was not turned. So all cells are those of the rectangle, and the groups are at the same edges.
        assert_eq!(common, rectangle([13.0, 11.0], [13, 11]).unwrap());
    }

    #[test]
    fn a_mesh_in_rows_or_with_faults_is_left_as_it_is() {
        let mesh = rectangle([3.0, 2.0], [7, 5]).unwrap();
        assert_eq!(mesh.clone().with_common_axes(), mesh);
        let mut open = shuffled([3, 2]);
        open.edges.pop();
        assert_eq!(open.clone().with_common_axes(), open);
    }

    #[test]
    fn three_cells_around_a_node_cannot_agree_and_stay_whole() {
        // A hexagon of three cells.
        let at = |k: usize| [(k as f64 * 60f64.to_radians()).cos(), (k as f64 * 60f64.to_radians()).sin()];
        let nodes = (0..6).map(at).chain([[0.0; 2]]).collect();
        let cells: Vec<[usize; 4]> = vec![[6, 0, 1, 2], [3, 4, 6, 2], [0, 6, 4, 5]];
        let edge = |cell: usize, face: usize| BoundaryEdge { cell, face, group: 0 };
        let edges = vec![edge(0, 1), edge(0, 3), edge(1, 2), edge(1, 0), edge(2, 3), edge(2, 0)];
        let one = rectangle([1.0, 1.0], [1, 1]).unwrap();
        let mesh = Mesh { nodes, cells, cell_group: vec![0; 3], edges, original: vec![1, 2, 3], ..one };
        let mesh = mesh.checked().unwrap();
        assert!(links(&mesh).is_ok());
        let common = mesh.clone().with_common_axes();
        assert!(links(&common).is_ok());
        // One of the three faces, seen from both sides, must stay broken.
        assert_eq!(broken(&common), 2);
    }
}
