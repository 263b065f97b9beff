//! Gmsh's element types: which are read, and what a message says about the others.

/// An element type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    /// Gmsh's number.
    pub number: i32,
    /// Its name in messages, in the plural.
    pub name: &'static str,
    /// Dimension, 0 to 3.
    pub dimension: u8,
    /// Polynomial order.
    pub order: u8,
    /// Number of nodes.
    pub nodes: usize,
}

const fn kind(number: i32, name: &'static str, dimension: u8, order: u8, nodes: usize) -> Kind {
    Kind { number, name, dimension, order, nodes }
}

/// A two-node line.
pub const LINE: i32 = 1;
/// A four-node quadrilateral.
pub const QUAD: i32 = 3;
/// A line of order 2: its ends, then its middle.
pub const LINE_3: i32 = 8;
/// A quadrilateral of order 2 of 9 nodes: corners, middles of its edges from corner k to k + 1, its own middle.
pub const QUAD_9: i32 = 10;
/// A quadrilateral of order 2 of 8 nodes: without the last.
pub const QUAD_8: i32 = 16;
/// A cell of another program that says to be a quadrilateral of order 2 and has another number of nodes; Gmsh has no number for it.
pub const OTHER_QUAD: i32 = -1;
/// A point.
pub const POINT: i32 = 15;

/// The types of the reference manual that Gmsh's mesher makes, up to order 5.
const KINDS: [Kind; 37] = [
    kind(OTHER_QUAD, "quadrilaterals of order 2 (with neither 8 nor 9 nodes)", 2, 2, 0),
    kind(LINE, "lines", 1, 1, 2),
    kind(2, "triangles", 2, 1, 3),
    kind(QUAD, "quadrilaterals", 2, 1, 4),
    kind(4, "tetrahedra", 3, 1, 4),
    kind(5, "hexahedra", 3, 1, 8),
    kind(6, "prisms", 3, 1, 6),
    kind(7, "pyramids", 3, 1, 5),
    kind(LINE_3, "lines of order 2", 1, 2, 3),
    kind(9, "triangles of order 2", 2, 2, 6),
    kind(QUAD_9, "quadrilaterals of order 2 (9 nodes)", 2, 2, 9),
    kind(11, "tetrahedra of order 2", 3, 2, 10),
    kind(12, "hexahedra of order 2", 3, 2, 27),
    kind(13, "prisms of order 2", 3, 2, 18),
    kind(14, "pyramids of order 2", 3, 2, 14),
    kind(POINT, "points", 0, 1, 1),
    kind(QUAD_8, "quadrilaterals of order 2 (8 nodes)", 2, 2, 8),
    kind(17, "hexahedra of order 2 (20 nodes)", 3, 2, 20),
    kind(18, "prisms of order 2 (15 nodes)", 3, 2, 15),
    kind(19, "pyramids of order 2 (13 nodes)", 3, 2, 13),
    kind(20, "incomplete triangles of order 3", 2, 3, 9),
    kind(21, "triangles of order 3", 2, 3, 10),
    kind(22, "incomplete triangles of order 4", 2, 4, 12),
    kind(23, "triangles of order 4", 2, 4, 15),
    kind(24, "incomplete triangles of order 5", 2, 5, 15),
    kind(25, "triangles of order 5", 2, 5, 21),
    kind(26, "lines of order 3", 1, 3, 4),
    kind(27, "lines of order 4", 1, 4, 5),
    kind(28, "lines of order 5", 1, 5, 6),
    kind(29, "tetrahedra of order 3", 3, 3, 20),
    kind(30, "tetrahedra of order 4", 3, 4, 35),
    kind(31, "tetrahedra of order 5", 3, 5, 56),
    kind(36, "quadrilaterals of order 3 (16 nodes)", 2, 3, 16),
    kind(37, "quadrilaterals of order 4 (25 nodes)", 2, 4, 25),
    kind(38, "quadrilaterals of order 5 (36 nodes)", 2, 5, 36),
    kind(92, "hexahedra of order 3", 3, 3, 64),
    kind(93, "hexahedra of order 4", 3, 4, 125),
];

impl Kind {
    /// The kind with Gmsh's number.
    pub fn of(number: i32) -> Option<Kind> {
        KINDS.into_iter().find(|kind| kind.number == number)
    }

    /// Whether a file may have elements of this kind: they are read, or can be ignored without loss.
    pub fn usable(&self) -> bool {
        self.is_line() || self.is_quad() || self.number == POINT
    }

    /// Whether it is a line that is read.
    pub fn is_line(&self) -> bool {
        [LINE, LINE_3].contains(&self.number)
    }

    /// Whether it is a quadrilateral that is read.
    pub fn is_quad(&self) -> bool {
        [QUAD, QUAD_8, QUAD_9].contains(&self.number)
    }

    /// What to do about elements of this kind.
    pub fn remedy(&self) -> &'static str {
        match (self.dimension, self.order) {
            (3, _) => {
                "dgmpm is two-dimensional: mesh and save surfaces only (`gmsh -2 case.geo`, no `Physical Volume`)"
            }
            (_, 2..) => {
                "cells are quadrilaterals with straight edges or of order 2: in Gmsh `Mesh.ElementOrder = 1;` or `= 2;`"
            }
            _ => {
                "cells are quadrilaterals: in Gmsh add `Recombine Surface {:};` or `Mesh.RecombineAll = 1;` (where triangles stay: `Mesh.RecombinationAlgorithm = 3;` or `Mesh.SubdivisionAlgorithm = 1;`)"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complete_kinds_have_the_node_count_of_their_order() {
        for kind in KINDS.iter().filter(|k| !k.name.contains("incomplete") && !k.name.contains('(')) {
            let p = kind.order as usize + 1;
            let expected = match kind.name.split(' ').next() {
                Some("points") => 1,
                Some("lines") => p,
                Some("triangles") => p * (p + 1) / 2,
                Some("quadrilaterals") => p * p,
                Some("tetrahedra") => p * (p + 1) * (p + 2) / 6,
                Some("hexahedra") => p * p * p,
                Some("prisms") => p * p * (p + 1) / 2,
                Some("pyramids") => p * (p + 1) * (2 * p + 1) / 6,
                other => unreachable!("{other:?}"),
            };
            assert_eq!(kind.nodes, expected, "{}", kind.name);
        }
    }
}
