//! The faults of a mesh: what is wrong, where (coordinates and cell numbers), and how to correct it.

/// A mesh that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A rectangle without extent or without cells.
    #[error("a rectangle of {:?} m with {cells:?} cells cannot be meshed", .size)]
    Rectangle {
        /// Width and height, in m.
        size: [f64; 2],
        /// Cells in x and y.
        cells: [usize; 2],
    },
    /// No cells at all.
    #[error("the mesh has no cells")]
    Empty,
    /// Lists of the mesh whose lengths or indices do not fit together (a fault of the program that built it).
    #[error("the mesh is not consistent: {what}")]
    Inconsistent {
        /// Which list or index.
        what: String,
    },
    /// A node with a coordinate that is infinite or not a number.
    #[error("cell {cell} has a corner at {}, which is not finite", point(.at))]
    NotFinite {
        /// Number of the cell.
        cell: u64,
        /// Its corner.
        at: [f64; 2],
    },
    /// A cell with the same node twice.
    #[error("cell {cell} has the node at {} twice: it is not a quadrilateral", point(.at))]
    Repeated {
        /// Number of the cell.
        cell: u64,
        /// The node.
        at: [f64; 2],
    },
    /// A cell whose map is singular or inverted at a corner.
    #[error("cell {cell} is not convex: its corner at {} has scaled Jacobian {scaled:.3e}; corners {}", point(.at), points(.corners))]
    Inverted {
        /// Number of the cell.
        cell: u64,
        /// The worst corner.
        at: [f64; 2],
        /// det / (|a| |b|) of the edges a, b at that corner.
        scaled: f64,
        /// All corners.
        corners: [[f64; 2]; 4],
    },
    /// A curved cell whose edges cross, or whose map folds.
    #[error("the edges of cell {cell} are curved so far that it folds at {}: its scaled Jacobian there is {scaled:.3e}", point(.at))]
    Folded {
        /// Number of the cell.
        cell: u64,
        /// The worst place.
        at: [f64; 2],
        /// det / (|a| |b|) of the tangents a, b there.
        scaled: f64,
    },
    /// An edge that its two cells curve in different ways.
    #[error("the edge {} has different middle nodes in cell {} and in cell {}: the cells overlap or leave a gap", points(.at), .cells[0], .cells[1])]
    TwoCurves {
        /// The ends of the edge.
        at: [[f64; 2]; 2],
        /// Numbers of the cells.
        cells: [u64; 2],
    },
    /// A cell that a move of nodes would turn inside out.
    #[error("cell {cell} with a corner at {} would be turned inside out", point(.at))]
    Turned {
        /// Number of the cell.
        cell: u64,
        /// One of its corners, after the move.
        at: [f64; 2],
    },
    /// An edge of more than two cells.
    #[error("the edge {} belongs to {} cells: {cells:?}", points(.at), .cells.len())]
    Crowded {
        /// The ends of the edge.
        at: [[f64; 2]; 2],
        /// Numbers of the cells.
        cells: Vec<u64>,
    },
    /// Boundary edges without a group.
    #[error("{count} boundary edge(s) belong to no group, the first is {} of cell {cell}", points(.at))]
    Untagged {
        /// How many.
        count: usize,
        /// The ends of the first.
        at: [[f64; 2]; 2],
        /// Number of its cell.
        cell: u64,
    },
    /// A node on the inside of an edge of another cell.
    #[error("the node {} of cell {owner} hangs on the inside of the edge {} of cell {cell}", point(.at), points(.edge))]
    Hanging {
        /// The node.
        at: [f64; 2],
        /// Number of a cell that it belongs to.
        owner: u64,
        /// The ends of the edge.
        edge: [[f64; 2]; 2],
        /// Number of the cell of the edge.
        cell: u64,
    },
    /// Two nodes in one place.
    #[error("{count} pair(s) of nodes lie in one place, the first at {}, of cells {} and {}", point(.at), .cells[0], .cells[1])]
    Duplicate {
        /// How many pairs.
        count: usize,
        /// The position of the first pair.
        at: [f64; 2],
        /// For each of the two nodes, the number of a cell that has it.
        cells: [u64; 2],
    },
    /// A boundary edge in two groups.
    #[error("the boundary edge {} of cell {cell} belongs to two groups, `{}` and `{}`", points(.at), .groups[0], .groups[1])]
    TwoGroups {
        /// The ends of the edge.
        at: [[f64; 2]; 2],
        /// Number of its cell.
        cell: u64,
        /// The names of both groups.
        groups: [String; 2],
    },
    /// A cut of one edge, both ends of which are tips.
    #[error("the edge {} of the group `{group}` lies alone inside of the body: a cut there has no node that could open", points(.at))]
    ShortCrack {
        /// The ends of the edge.
        at: [[f64; 2]; 2],
        /// The name of its group.
        group: String,
    },
    /// Two periodic groups that cannot be joined edge by edge.
    #[error("the periodic groups `{}` and `{}` have {} and {} boundary edges", .groups[0], .groups[1], .counts[0], .counts[1])]
    PeriodicCount {
        /// The names of both groups.
        groups: [String; 2],
        /// How many edges each has.
        counts: [usize; 2],
    },
    /// An edge of a periodic group that has no match in the other.
    #[error("the edge {} of cell {cell} in the periodic group `{}` has no match in `{}`: there is no edge {}", points(.at), .groups[0], .groups[1], points(.moved))]
    PeriodicMismatch {
        /// The ends of the edge.
        at: [[f64; 2]; 2],
        /// Number of its cell.
        cell: u64,
        /// Its ends after the translation between the groups.
        moved: [[f64; 2]; 2],
        /// The names of both groups.
        groups: [String; 2],
    },
}

impl Error {
    /// How to correct it.
    pub fn remedy(&self) -> String {
        let text = match self {
            Error::Rectangle { .. } => "give two finite sizes above 0 and at least one cell in each direction",
            Error::Empty => "mesh a surface with quadrilaterals and save it with the file",
            Error::Inconsistent { .. } => {
                "each cell needs four nodes and one group of the mesh, each edge a cell, a face 0..4 and a group"
            }
            Error::NotFinite { .. } => "give finite coordinates in metres",
            Error::Repeated { .. } => "merge or remove the cell; collapsed quadrilaterals (triangles) cannot be used",
            Error::Inverted { .. } => {
                "every corner must turn the same way with an angle between 0 and 180 degrees: smooth the mesh there, or mesh it finer"
            }
            Error::Folded { .. } => {
                "move the middle nodes of its edges towards the middles of their chords, mesh it finer there, or save the mesh with first-order elements (in Gmsh `Mesh.ElementOrder = 1;`)"
            }
            Error::TwoCurves { .. } => {
                "give both cells the same node in the middle of their edge (in Gmsh mesh all surfaces with one `Mesh.ElementOrder`)"
            }
            Error::Turned { .. } => "move the nodes by less: by a small part of the smallest cell",
            Error::Crowded { .. } => "remove the cells that lie upon each other; a surface was perhaps meshed twice",
            Error::Untagged { .. } => {
                "put every boundary edge into a group: in Gmsh add its curve to a `Physical Curve(\"name\") = {...};`"
            }
            Error::Hanging { .. } => {
                "neighbouring cells must share whole edges: give both sides of the interface one common curve (in Gmsh `Coherence;` or `BooleanFragments`) and the same divisions; for two bodies in contact put both edges into groups"
            }
            Error::Duplicate { .. } => {
                "merge them (in Gmsh `Coherence Mesh;`, or `Geometry.AutoCoherence = 1;` before meshing); where a gap of width 0 is meant, put the edges of both sides into groups"
            }
            Error::TwoGroups { .. } => "keep each curve in one `Physical Curve` only",
            Error::ShortCrack { .. } => {
                "give the crack two edges or more (a finer mesh), or let it begin at the boundary"
            }
            Error::PeriodicCount { .. } | Error::PeriodicMismatch { .. } => {
                "a translation must take one group to the other: give both the same shape and divisions (in Gmsh `Periodic Curve` and equal `Transfinite Curve`)"
            }
        };
        text.to_owned()
    }
}

impl From<Error> for crate::Error {
    fn from(error: Error) -> Self {
        let remedy = error.remedy();
        crate::Error::input(error.to_string(), remedy)
    }
}

fn point(at: &[f64; 2]) -> String {
    // Without an exponent 1e200 has two hundred zeros.
    let number = |x: f64| if x == 0.0 || (1e-4..1e7).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") };
    format!("({}, {})", number(at[0]), number(at[1]))
}

fn points(at: &[[f64; 2]]) -> String {
    at.iter().map(point).collect::<Vec<_>>().join("-")
}
