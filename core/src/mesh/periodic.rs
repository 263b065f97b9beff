//! Periodic boundaries: the faces of two boundary groups joined by a translation.

use std::collections::HashMap;

use super::{Error, Link, Mesh, links};

/// Ends that are further apart than this part of the edge, after the translation, do not match. It is far above the rounding
/// of coordinates, and far below any intended shift.
const MATCH: f64 = 1e-6;

/// [`links`] of a mesh whose boundary groups `pairs` (indices in [`Mesh::edge_groups`]) are one boundary each:
/// each face of the first group is translated; the face of the second group at that place is its neighbour.
///
/// The translation takes the centre of the first group to that of the second. Cells may be their own neighbours.
///
/// # Errors
/// The errors of [`links`]; two groups with different numbers of edges; an edge without a match, with its position.
pub fn periodic_links(mesh: &Mesh, pairs: &[[usize; 2]]) -> Result<Vec<[Link; 4]>, Error> {
    let mut links = links(mesh)?;
    for pair in pairs {
        join(mesh, *pair, &mut links)?;
    }
    Ok(links)
}

/// A boundary edge, with its ends in the direction of the face.
struct Edge {
    cell: usize,
    face: usize,
    ends: [[f64; 2]; 2],
    /// From the middle of its chord to its own.
    bulge: [f64; 2],
}

impl Edge {
    fn middle(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * (self.ends[0][k] + self.ends[1][k]))
    }

    fn length(&self) -> f64 {
        distance(self.ends[0], self.ends[1])
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn join(mesh: &Mesh, pair: [usize; 2], links: &mut [[Link; 4]]) -> Result<(), Error> {
    let [first, second] = pair.map(|group| edges(mesh, links, group));
    let groups = || pair.map(|group| mesh.edge_groups[group].clone());
    if first.len() != second.len() {
        return Err(Error::PeriodicCount { groups: groups(), counts: [first.len(), second.len()] });
    }
    let (from, to) = (centre(&first), centre(&second));
    let shift = [to[0] - from[0], to[1] - from[1]];
    let mut partners = Partners::new(&second);
    for edge in &first {
        let moved = edge.ends.map(|x| [x[0] + shift[0], x[1] + shift[1]]);
        let Some((other, flip)) = partners.take(moved, edge.bulge) else {
            return Err(Error::PeriodicMismatch {
                at: edge.ends,
                cell: mesh.number(edge.cell),
                moved,
                groups: groups(),
            });
        };
        links[edge.cell][edge.face] = Link::Cell { cell: other.cell, face: other.face, flip };
        links[other.cell][other.face] = Link::Cell { cell: edge.cell, face: edge.face, flip };
    }
    Ok(())
}

/// The edges of a group that lie on the boundary.
fn edges(mesh: &Mesh, links: &[[Link; 4]], group: usize) -> Vec<Edge> {
    let faces = (0..links.len()).flat_map(|cell| (0..4).map(move |face| (cell, face)));
    let of_group = faces.filter(|&(cell, face)| links[cell][face] == Link::Boundary(group));
    let ends = |cell, face| mesh.face_nodes(cell, face).map(|node| mesh.nodes[node]);
    let bulge = |cell: usize, face: usize| mesh.map(cell).bulge.map_or([0.0; 2], |bulge| bulge[face]);
    of_group.map(|(cell, face)| Edge { cell, face, ends: ends(cell, face), bulge: bulge(cell, face) }).collect()
}

/// The mean of the midpoints of the edges: it differs between the two groups by the translation only.
fn centre(edges: &[Edge]) -> [f64; 2] {
    let count = edges.len().max(1) as f64;
    [0, 1].map(|k| edges.iter().map(|edge| edge.middle()[k]).sum::<f64>() / count)
}

/// Edges by the square buckets of their midpoints. Each edge is taken once.
struct Partners<'a> {
    width: f64,
    buckets: HashMap<[i64; 2], Vec<&'a Edge>>,
}

impl<'a> Partners<'a> {
    fn new(edges: &'a [Edge]) -> Self {
        let width = edges.iter().map(Edge::length).fold(f64::MIN_POSITIVE, f64::max);
        let mut out = Self { width, buckets: HashMap::with_capacity(edges.len()) };
        for edge in edges {
            out.buckets.entry(out.bucket(edge.middle())).or_default().push(edge);
        }
        out
    }

    fn bucket(&self, x: [f64; 2]) -> [i64; 2] {
        x.map(|x| (x / self.width).floor() as i64)
    }

    /// The edge with these ends and this curve, and whether it runs the other way.
    fn take(&mut self, ends: [[f64; 2]; 2], bulge: [f64; 2]) -> Option<(&'a Edge, bool)> {
        let limit = MATCH * distance(ends[0], ends[1]);
        let near = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| (0..2).all(|k| distance(a[k], b[k]) <= limit);
        let [i, j] = self.bucket([0, 1].map(|k| 0.5 * (ends[0][k] + ends[1][k])));
        // A midpoint may lie on the border of its bucket.
        for key in (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj])) {
            let Some(bucket) = self.buckets.get_mut(&key) else { continue };
            let fits = |edge: &&Edge| {
                let same = near(edge.ends, ends) || near([edge.ends[1], edge.ends[0]], ends);
                same && distance(edge.bulge, bulge) <= limit
            };
            if let Some(k) = bucket.iter().position(fits) {
                let edge = bucket.swap_remove(k);
                return Some((edge, !near(edge.ends, ends)));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    #[test]
    fn opposite_sides_of_a_rectangle_become_neighbours() {
        let links = periodic_links(&rectangle([3.0, 2.0], [3, 2]).unwrap(), &[[0, 1], [3, 2]]).unwrap();
        assert_eq!(links[0][0], Link::Cell { cell: 2, face: 1, flip: false });
        assert_eq!(links[2][1], Link::Cell { cell: 0, face: 0, flip: false });
        assert_eq!(links[1][2], Link::Cell { cell: 4, face: 3, flip: false });
        assert!(links.iter().flatten().all(|link| matches!(link, Link::Cell { .. })));
    }

    #[test]
    fn a_cell_may_be_its_own_neighbour() {
        let links = periodic_links(&rectangle([1.0, 1.0], [1, 1]).unwrap(), &[[0, 1]]).unwrap();
        assert_eq!(links[0][0], Link::Cell { cell: 0, face: 1, flip: false });
        assert_eq!(links[0][2], Link::Boundary(2));
    }

    #[test]
    fn turned_cells_are_joined_with_flips_as_coordinates_say() {
        let mut mesh = rectangle([2.0, 2.0], [2, 2]).unwrap();
        // Half a turn: face 0 becomes 1, 2 becomes 3, and all run the other way.
        mesh.cells[1].rotate_left(2);
        mesh.edges.iter_mut().filter(|edge| edge.cell == 1).for_each(|edge| edge.face ^= 1);
        let links = periodic_links(&mesh, &[[0, 1], [2, 3]]).unwrap();
        assert_eq!(links[0][0], Link::Cell { cell: 1, face: 0, flip: true });
        assert_eq!(links[2][0], Link::Cell { cell: 3, face: 1, flip: false });
        assert_eq!(links[1][3], Link::Cell { cell: 3, face: 3, flip: true });
    }

    #[test]
    fn groups_of_different_numbers_of_edges_and_edges_that_do_not_match_are_named() {
        let error = periodic_links(&rectangle([3.0, 2.0], [3, 2]).unwrap(), &[[0, 2]]).unwrap_err();
        assert_eq!(error, Error::PeriodicCount { groups: ["left".into(), "bottom".into()], counts: [2, 3] });
        let mut mesh = rectangle([2.0, 2.0], [2, 2]).unwrap();
        mesh.nodes[5] = [2.0, 1.1];
        let error = periodic_links(&mesh, &[[0, 1]]).unwrap_err();
        assert!(matches!(error, Error::PeriodicMismatch { at: [[0.0, 0.0], [0.0, 1.0]], cell: 1, .. }), "{error}");
        assert!(error.to_string().contains("`left`") && error.to_string().contains("`right`"), "{error}");
    }

    #[test]
    fn a_group_turned_against_the_other_is_no_translation() {
        let error = periodic_links(&rectangle([2.0, 2.0], [2, 2]).unwrap(), &[[0, 2]]).unwrap_err();
        assert!(matches!(error, Error::PeriodicMismatch { .. }), "{error}");
    }
}
