//! From raw lists to a checked mesh.

use super::{Error, Mesh, map, quality};
use std::collections::HashMap;

/// The part of its chord by which the curves of an edge may differ between its two cells: rounding of other programs.
const SAME_CURVE: f64 = 1e-9;

/// A corner below this scaled Jacobian is an error. The time step shrinks in proportion to it, and the inverse map of such a
/// cell is exact to half of the digits at most.
pub const SMALLEST_SCALED_JACOBIAN: f64 = 1e-8;

/// The local face that each face of a reversed cell becomes: corner 0 stays, xi1 and xi2 are exchanged.
const REVERSED: [usize; 4] = [2, 3, 0, 1];

impl Mesh {
    /// The mesh with every cell counter-clockwise (corner 0 stays where it was), or the first fault of its cells:
    /// lists that do not fit, coordinates that are not finite, repeated nodes, corners that are flat or concave.
    pub fn checked(mut self) -> Result<Self, Error> {
        self.consistent()?;
        let mut reversed = vec![false; self.cells.len()];
        for (cell, turned) in reversed.iter_mut().enumerate() {
            self.distinct(cell)?;
            if map::area(&self.corners(cell)) < 0.0 {
                self.cells[cell].swap(1, 3);
                if let Some(bulge) = self.bulges.get_mut(cell) {
                    bulge.swap(0, 2);
                    bulge.swap(1, 3);
                }
                *turned = true;
            }
            self.convex(cell)?;
            self.unfolded(cell)?;
        }
        for edge in self.edges.iter_mut().filter(|edge| reversed[edge.cell]) {
            edge.face = REVERSED[edge.face];
        }
        for [(first, face), (cell, own)] in self.shared_curves()? {
            // Equal but for rounding: both sides see the same bits.
            self.bulges[cell][own] = self.bulges[first][face];
        }
        Ok(self)
    }

    /// Whether the mesh is as [`Mesh::checked`] leaves one: the same faults, and cells that run clockwise are one too. A mesh
    /// from a file of this program or from a caller is not changed behind their back.
    ///
    /// # Errors
    /// The first fault of its cells.
    pub fn check(&self) -> Result<(), Error> {
        self.consistent()?;
        (0..self.cells.len()).try_for_each(|cell| {
            self.distinct(cell).and_then(|()| self.convex(cell)).and_then(|()| self.unfolded(cell))
        })?;
        self.shared_curves().map(drop)
    }

    /// Checks that all indices point into their lists, and that there are cells.
    pub fn consistent(&self) -> Result<(), Error> {
        let refuse = |what: String| Err(Error::Inconsistent { what });
        let count = self.cells.len();
        if count == 0 {
            return Err(Error::Empty);
        }
        if self.cell_group.len() != count || self.original.len() != count {
            let (groups, numbers) = (self.cell_group.len(), self.original.len());
            return refuse(format!("{count} cells, {groups} group indices, {numbers} cell numbers"));
        }
        if ![0, count].contains(&self.bulges.len()) {
            return refuse(format!("{count} cells, {} of them with the curves of their edges", self.bulges.len()));
        }
        if let Some(cell) = (0..count).find(|&c| self.cells[c].iter().any(|&n| n >= self.nodes.len())) {
            return refuse(format!("cell {} names a node beyond the {} nodes", self.number(cell), self.nodes.len()));
        }
        if let Some(cell) = (0..count).find(|&c| self.cell_group[c] >= self.groups.len()) {
            return refuse(format!("cell {} has no group", self.number(cell)));
        }
        let fits = |e: &&super::BoundaryEdge| e.cell < count && e.face < 4 && e.group < self.edge_groups.len();
        match self.edges.iter().find(|e| !fits(e)) {
            Some(edge) => refuse(format!("{edge:?} points beyond the lists")),
            None => Ok(()),
        }
    }

    fn distinct(&self, cell: usize) -> Result<(), Error> {
        let number = self.number(cell);
        let corners = self.corners(cell);
        if let Some(&at) = corners.iter().find(|x| !(x[0].is_finite() && x[1].is_finite())) {
            return Err(Error::NotFinite { cell: number, at });
        }
        let nodes = self.cells[cell];
        let repeated = |k: &usize| nodes[k + 1..].contains(&nodes[*k]) || corners[k + 1..].contains(&corners[*k]);
        match (0..4).find(repeated) {
            Some(k) => Err(Error::Repeated { cell: number, at: corners[k] }),
            None => Ok(()),
        }
    }

    /// The two sides, cell and face, of each edge between cells of a curved mesh; an error where they have different curves.
    fn shared_curves(&self) -> Result<Vec<[(usize, usize); 2]>, Error> {
        let mut first: HashMap<[usize; 2], (usize, usize)> = HashMap::new();
        let mut out = vec![];
        for (cell, face) in (0..self.bulges.len()).flat_map(|cell| (0..4).map(move |face| (cell, face))) {
            let [a, b] = self.face_nodes(cell, face);
            let Some((other, theirs)) = first.insert([a.min(b), a.max(b)], (cell, face)) else { continue };
            let (d, e) = (self.bulges[cell][face], self.bulges[other][theirs]);
            let [p, q] = [a, b].map(|node| self.nodes[node]);
            // Written so that NaN is an error too.
            let near = (d[0] - e[0]).hypot(d[1] - e[1]) <= SAME_CURVE * (p[0] - q[0]).hypot(p[1] - q[1]);
            if !near {
                return Err(Error::TwoCurves { at: [p, q], cells: [other, cell].map(|cell| self.number(cell)) });
            }
            out.push([(other, theirs), (cell, face)]);
        }
        Ok(out)
    }

    /// An error of a curved cell whose map folds.
    fn unfolded(&self, cell: usize) -> Result<(), Error> {
        let map = self.map(cell);
        let Some(bulge) = map.bulge else { return Ok(()) };
        let number = self.number(cell);
        if bulge.iter().flatten().any(|x| !x.is_finite()) {
            return Err(Error::NotFinite { cell: number, at: map.corners[0] });
        }
        let (scaled, xi) = quality::smallest_scaled_jacobian(&map);
        if scaled >= SMALLEST_SCALED_JACOBIAN {
            return Ok(());
        }
        Err(Error::Folded { cell: number, at: map::position(&map, xi), scaled })
    }

    fn convex(&self, cell: usize) -> Result<(), Error> {
        let corners = self.corners(cell);
        let scaled = quality::corner_jacobians(&corners);
        let worst = (1..4).fold(0, |worst, k| if scaled[k] < scaled[worst] { k } else { worst });
        // Written so that NaN (edges whose squares underflow or overflow) is an error too.
        if scaled.iter().all(|s| *s >= SMALLEST_SCALED_JACOBIAN) {
            return Ok(());
        }
        Err(Error::Inverted { cell: self.number(cell), at: corners[worst], scaled: scaled[worst], corners })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Link, links, rectangle};

    fn single(corners: [[f64; 2]; 4]) -> Mesh {
        Mesh { nodes: corners.to_vec(), original: vec![77], ..rectangle([1.0, 1.0], [1, 1]).unwrap() }
    }

    #[test]
    fn a_good_mesh_is_left_as_it_is() {
        let mesh = rectangle([3.0, 1.0], [3, 2]).unwrap();
        assert_eq!(mesh.clone().checked().unwrap(), mesh);
    }

    #[test]
    fn clockwise_cells_are_turned_around_corner_0_and_their_edges_follow() {
        let good = rectangle([2.0, 2.0], [2, 2]).unwrap();
        let mut mesh = good.clone();
        for cell in [0, 3] {
            mesh.cells[cell].swap(1, 3);
            for edge in mesh.edges.iter_mut().filter(|e| e.cell == cell) {
                edge.face = REVERSED[edge.face];
            }
        }
        let checked = mesh.checked().unwrap();
        assert_eq!(checked, good);
        assert_eq!(links(&checked).unwrap()[3][1], Link::Boundary(1));
    }

    #[test]
    fn concave_and_crossed_and_flat_cells_are_refused_by_number_and_corner() {
        let concave = single([[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]]).checked().unwrap_err();
        assert!(matches!(concave, Error::Inverted { cell: 77, at: [0.2, 0.2], .. }), "{concave}");
        let crossed = single([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).checked();
        assert!(matches!(crossed, Err(Error::Inverted { cell: 77, .. })), "{crossed:?}");
        let flat = single([[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [0.0, 1.0]]).checked();
        assert!(matches!(flat, Err(Error::Inverted { at: [0.5, 0.5], .. })), "{flat:?}");
        let line = single([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]).checked();
        assert!(matches!(line, Err(Error::Inverted { .. })), "{line:?}");
    }

    #[test]
    fn a_mesh_that_must_stay_as_it_is_has_no_cell_that_runs_clockwise() {
        let mut mesh = rectangle([2.0, 2.0], [2, 2]).unwrap();
        assert_eq!(mesh.check(), Ok(()));
        mesh.cells[3].swap(1, 3);
        assert!(matches!(mesh.check(), Err(Error::Inverted { cell: 4, .. })), "{:?}", mesh.check());
    }

    #[test]
    fn repeated_nodes_are_refused() {
        let collapsed = single([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).checked();
        assert_eq!(collapsed, Err(Error::Repeated { cell: 77, at: [1.0, 0.0] }));
        let mut same = rectangle([1.0, 1.0], [1, 1]).unwrap();
        same.cells[0][2] = same.cells[0][1];
        assert!(matches!(same.checked(), Err(Error::Repeated { .. })));
    }

    #[test]
    fn infinite_coordinates_and_broken_lists_are_refused() {
        let infinite = single([[0.0, 0.0], [f64::INFINITY, 0.0], [1.0, 1.0], [0.0, 1.0]]).checked();
        assert!(matches!(infinite, Err(Error::NotFinite { cell: 77, .. })));
        assert_eq!(Mesh::default().checked(), Err(Error::Empty));
        let good = rectangle([1.0, 1.0], [1, 1]).unwrap();
        let broken: [fn(&mut Mesh); 6] = [
            |m| m.cells[0][1] = 99,
            |m| m.cell_group[0] = 1,
            |m| m.cell_group.clear(),
            |m| m.edges[0].face = 4,
            |m| m.edges[0].cell = 1,
            |m| m.edges[0].group = 4,
        ];
        for break_it in broken {
            let mut mesh = good.clone();
            break_it(&mut mesh);
            assert!(matches!(links(&mesh), Err(Error::Inconsistent { .. })));
            assert!(matches!(mesh.checked(), Err(Error::Inconsistent { .. })));
        }
    }

    #[test]
    fn the_smallest_and_the_largest_sizes_of_f64_do_not_pass_as_good_by_overflow() {
        for size in [1e-200, 1e200] {
            let square = single([[0.0, 0.0], [size, 0.0], [size, size], [0.0, size]]);
            assert!(square.checked().is_err(), "{size}");
        }
    }

    #[test]
    fn a_curved_cell_that_folds_is_refused_by_number_and_a_turned_one_takes_its_curves_along() {
        let square = single([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
        let curved =
            |by: f64| Mesh { bulges: vec![[[0.0; 2], [0.0; 2], [0.0, by], [0.0; 2], [0.0; 2]]], ..square.clone() };
        assert!(curved(-0.3).checked().is_ok() && curved(0.2).checked().is_ok());
        // The lower edge comes near the upper one: dX_2/dxi_2 = 1 - b(xi1) by at its middle is .02 at by = .98 and -.1 at 1.1.
        assert!(matches!(curved(1.1).checked(), Err(Error::Folded { cell: 77, .. })), "{:?}", curved(1.1).checked());
        let mut turned = curved(-0.3);
        turned.cells[0].swap(1, 3);
        turned.bulges[0].swap(0, 2);
        let (checked, wanted) = (turned.checked().unwrap(), curved(-0.3));
        assert_eq!((checked.cells, checked.bulges), (wanted.cells, wanted.bulges));
    }

    #[test]
    fn an_edge_has_one_curve_for_both_of_its_cells() {
        let mut mesh = rectangle([2.0, 1.0], [2, 1]).unwrap();
        let shared = [0.1, 0.05];
        let bulge = |face: usize| std::array::from_fn(|k| if k == face { shared } else { [0.0; 2] });
        mesh.bulges = vec![bulge(1), bulge(0)];
        assert_eq!(mesh.clone().checked().unwrap(), mesh);
        // Rounding: the second cell takes the bits of the first.
        mesh.bulges[1][0][0] += 1e-12;
        assert_eq!(mesh.clone().checked().unwrap().bulges[1][0], shared);
        mesh.bulges[1][0][0] = 0.08;
        assert!(matches!(mesh.check(), Err(Error::TwoCurves { cells: [1, 2], .. })), "{:?}", mesh.check());
        mesh.bulges[1] = Default::default();
        assert!(matches!(mesh.checked(), Err(Error::TwoCurves { .. })));
    }

    #[test]
    fn a_fold_between_corners_and_middles_is_found() {
        // det = 1 - b(xi1) d at xi2 = 0, with b(.5) = 1: below 0 for d above 1, in a strip about the middle that has no corner.
        let folded = |d: f64| {
            let square = single([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
            Mesh { bulges: vec![[[0.0; 2], [0.0; 2], [0.0, d], [0.0; 2], [0.0; 2]]], ..square }.checked()
        };
        assert!(folded(0.999).is_ok() && folded(1.001).is_err());
    }
}
