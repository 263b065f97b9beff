//! Cells of the files of other programs, by the kinds of VTK and XDMF.

use crate::io::gmsh::{LINE, LINE_3, OTHER_QUAD, POINT, QUAD, QUAD_9};
use std::collections::BTreeMap;

/// What is to be done with the nodes of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Nothing: points.
    Point,
    /// A line through its nodes.
    Line,
    /// A quadrilateral, its four nodes one after the other around it.
    Quad,
    /// A quadrilateral whose nodes stand row by row.
    Pixel,
    /// A polygon: a quadrilateral, where it has four nodes.
    Polygon,
    /// A quadrilateral of order 2: four corners, the middles of its edges around it, and its own where it has 9 nodes.
    Quadratic,
    /// A line of order 2: its ends, then its middle.
    Line3,
    /// A quadrilateral of any degree, its corners first.
    Lagrange,
    /// A kind of Gmsh that is not used.
    Other(i32),
}

/// The cells of a grid. Cells are numbered from 0 in the order of the file, and so are nodes.
#[derive(Debug, Clone, Default)]
pub struct Cells {
    /// How many cells of any kind there are.
    pub count: usize,
    /// Number of the cell and its nodes; a line of several pieces has one number.
    pub lines: Vec<(usize, [u64; 2])>,
    /// Number of the cell and its nodes.
    pub quads: Vec<(usize, [u64; 4])>,
    /// Of quadrilaterals of order 2: number of the cell, the middles of its edges around it, its own.
    pub middles: Vec<(usize, [u64; 4], Option<u64>)>,
    /// Cells that cannot be used: for each kind of Gmsh how many, and the number of the first.
    pub refused: BTreeMap<i32, (usize, u64)>,
}

impl Cells {
    /// Adds a cell. `straight` says that quadrilaterals of higher degree are straight: their corners are enough.
    pub fn push(&mut self, shape: Shape, nodes: &[u64], straight: bool) {
        let number = self.count;
        self.count += 1;
        match (shape, nodes) {
            (Shape::Point, _) => {}
            (Shape::Line, [_, _, ..]) => {
                self.lines.extend(nodes.windows(2).map(|ends| (number, [ends[0], ends[1]])));
            }
            (Shape::Quad | Shape::Polygon | Shape::Lagrange, &[a, b, c, d]) => self.quads.push((number, [a, b, c, d])),
            (Shape::Pixel, &[a, b, c, d]) => self.quads.push((number, [a, b, d, c])),
            (Shape::Lagrange, &[a, b, c, d, ..]) if straight => self.quads.push((number, [a, b, c, d])),
            (Shape::Line3, &[a, b, _]) => self.lines.push((number, [a, b])),
            (Shape::Quadratic | Shape::Lagrange, &[a, b, c, d, e, f, g, h, ref own @ ..]) if own.len() < 2 => {
                self.quads.push((number, [a, b, c, d]));
                self.middles.push((number, [e, f, g, h], own.first().copied()));
            }
            _ => self.refuse(shape.kind(nodes.len()), number),
        }
    }

    fn refuse(&mut self, kind: i32, number: usize) {
        self.refused.entry(kind).or_insert((0, number as u64)).0 += 1;
    }
}

impl Shape {
    /// The kind of Gmsh for messages.
    fn kind(self, nodes: usize) -> i32 {
        match self {
            Shape::Point => POINT,
            Shape::Line => LINE,
            Shape::Quad | Shape::Pixel => QUAD,
            Shape::Polygon => TRIANGLE,
            Shape::Quadratic => OTHER_QUAD,
            Shape::Line3 => LINE_3,
            // Those of order 3 to 5 have 16, 25, 36 nodes.
            Shape::Lagrange => match nodes {
                16 => 36,
                25 => 37,
                36 => 38,
                _ => QUAD_9,
            },
            Shape::Other(kind) => kind,
        }
    }
}

const TRIANGLE: i32 = 2;

/// The shape of a cell by its type in VTK.
pub fn of_vtk(kind: u64) -> Option<Shape> {
    Some(match kind {
        1 | 2 => Shape::Point,
        3 | 4 => Shape::Line,
        5 | 6 => Shape::Other(TRIANGLE),
        7 => Shape::Polygon,
        8 => Shape::Pixel,
        9 => Shape::Quad,
        10 => Shape::Other(4),
        11 | 12 => Shape::Other(5),
        13 => Shape::Other(6),
        14 => Shape::Other(7),
        21 => Shape::Line3,
        35 | 60 | 68 => Shape::Other(LINE_3),
        22 | 34 | 61 | 69 => Shape::Other(9),
        23 | 28 => Shape::Quadratic,
        30 => Shape::Other(OTHER_QUAD),
        24 | 71 => Shape::Other(11),
        25 | 33 => Shape::Other(17),
        26 | 31 | 32 => Shape::Other(18),
        27 => Shape::Other(19),
        29 | 72 => Shape::Other(12),
        70 => Shape::Lagrange,
        73 => Shape::Other(13),
        74 => Shape::Other(14),
        _ => return None,
    })
}

/// The shape of the cells of a topology of XDMF by its name, and their nodes where the name tells.
pub fn of_xdmf(name: &str) -> Option<(Shape, Option<usize>)> {
    Some(match name.to_ascii_lowercase().as_str() {
        "polyvertex" => (Shape::Point, None),
        "polyline" => (Shape::Line, None),
        "polygon" => (Shape::Polygon, None),
        "triangle" => (Shape::Other(TRIANGLE), Some(3)),
        "quadrilateral" => (Shape::Quad, Some(4)),
        "tetrahedron" => (Shape::Other(4), Some(4)),
        "pyramid" => (Shape::Other(7), Some(5)),
        "wedge" => (Shape::Other(6), Some(6)),
        "hexahedron" => (Shape::Other(5), Some(8)),
        "edge_3" => (Shape::Line3, Some(3)),
        "triangle_6" => (Shape::Other(9), Some(6)),
        "quadrilateral_8" | "quad_8" => (Shape::Quadratic, Some(8)),
        "quadrilateral_9" | "quad_9" => (Shape::Quadratic, Some(9)),
        "tetrahedron_10" => (Shape::Other(11), Some(10)),
        "hexahedron_27" => (Shape::Other(12), Some(27)),
        _ => return None,
    })
}

/// The shape of a cell in a mixed topology of XDMF by its number, and its nodes; without them their number follows.
pub fn of_mixed(number: u64) -> Option<(Shape, Option<usize>)> {
    Some(match number {
        1 => (Shape::Point, None),
        2 => (Shape::Line, None),
        3 => (Shape::Polygon, None),
        4 => (Shape::Other(TRIANGLE), Some(3)),
        5 => (Shape::Quad, Some(4)),
        6 => (Shape::Other(4), Some(4)),
        7 => (Shape::Other(7), Some(5)),
        8 => (Shape::Other(6), Some(6)),
        9 => (Shape::Other(5), Some(8)),
        34 => (Shape::Line3, Some(3)),
        35 => (Shape::Quadratic, Some(9)),
        36 => (Shape::Other(9), Some(6)),
        37 => (Shape::Quadratic, Some(8)),
        38 => (Shape::Other(11), Some(10)),
        39 => (Shape::Other(19), Some(13)),
        40 => (Shape::Other(18), Some(15)),
        41 => (Shape::Other(13), Some(18)),
        48 => (Shape::Other(17), Some(20)),
        49 | 50 => (Shape::Other(12), Some(if number == 49 { 24 } else { 27 })),
        _ => return None,
    })
}
