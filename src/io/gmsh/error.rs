//! What can be wrong with an MSH file.

use std::path::Path;

use super::kinds::Kind;
use crate::error::Place;
use crate::mesh;

/// A place in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// Line and column, from 1, of a text file.
    Line(usize, usize),
    /// Offset in bytes, from 0, in a binary file.
    Byte(usize),
}

/// An MSH file that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The file has something else at a place where the format requires a certain item.
    #[error("{expected} expected, but {found}")]
    Syntax {
        /// The place in the file.
        at: At,
        /// What the format requires here.
        expected: String,
        /// What the file has here.
        found: String,
    },
    /// Not an MSH file at all.
    #[error("this is not an MSH file: it does not begin with `$MeshFormat`")]
    NotMsh,
    /// A version of the format that is not read.
    #[error("MSH version {0} is not read")]
    Version(String),
    /// A binary file from a big-endian machine, or with sizes that are not 8 bytes.
    #[error("this binary file is {0}")]
    Binary(&'static str),
    /// A section that must be there is not.
    #[error("the file has no `${0}` section")]
    Missing(&'static str),
    /// Elements that are not first-order quadrilaterals, lines or points.
    #[error("{count} element(s) are {}, the first is element {first}", .kind.name)]
    Element {
        /// The kind of the elements.
        kind: Kind,
        /// How many.
        count: usize,
        /// Number of the first.
        first: u64,
    },
    /// A node number that is used twice.
    #[error("node number {0} is given twice")]
    RepeatedNode(u64),
    /// An element with a node that is not in the file.
    #[error("element {element} names node {node}, which the file does not have")]
    UnknownNode {
        /// Number of the element.
        element: u64,
        /// Number of the node.
        node: u64,
    },
    /// A node outside the plane.
    #[error("node {node} at ({x}, {y}) has z = {z}", x = .at[0], y = .at[1], z = .at[2])]
    NotPlane {
        /// Number of the node.
        node: u64,
        /// Its coordinates.
        at: [f64; 3],
    },
    /// A curve or surface, or an element, in several physical groups.
    #[error("{what} belongs to several physical groups: {}", .names.join(", "))]
    ManyGroups {
        /// The curve, surface or element.
        what: String,
        /// Names of the groups.
        names: Vec<String>,
    },
    /// Two elements with the same number, or a quadrilateral that is given twice.
    #[error("elements {0} and {1} are the same")]
    RepeatedElement(u64, u64),
    /// Quadrilaterals outside the physical surfaces.
    #[error("{count} quadrilateral(s) belong to no physical surface, the first is element {first}")]
    NoGroup {
        /// How many.
        count: usize,
        /// Number of the first.
        first: u64,
    },
    /// Elements that all have the physical tag 0, in a file that names physical groups.
    #[error("the file names the physical groups {}, but all its {count} lines and quadrilaterals have the physical tag 0", .names.join(", "))]
    NoTags {
        /// How many elements.
        count: usize,
        /// Names of the groups.
        names: Vec<String>,
    },
    /// Lines of physical curves that are no edge of any quadrilateral.
    #[error(
        "{count} line(s) of physical curve `{name}` are not an edge of any quadrilateral, the first is element {first}"
    )]
    Stray {
        /// Name of the physical curve.
        name: String,
        /// How many.
        count: usize,
        /// Number of the first.
        first: u64,
    },
    /// A mesh that cannot be used, whatever its file.
    #[error("{0}")]
    Mesh(#[from] mesh::Error),
}

impl Error {
    /// How to correct it.
    pub fn remedy(&self) -> String {
        let text = match self {
            Error::Syntax { .. } => "the file is damaged or cut off: save it again from Gmsh as MSH 4.1 or 2.2",
            Error::NotMsh => {
                "give a mesh saved by Gmsh as MSH 4.1 or 2.2 (a .geo file must be meshed first: `gmsh -2 case.geo`)"
            }
            Error::Version(_) => {
                "save it as MSH 4.1 or 2.2: in Gmsh `Mesh.MshFileVersion = 4.1;`, or `gmsh -format msh41`"
            }
            Error::Binary(_) => "save it as text: in Gmsh `Mesh.Binary = 0;`",
            Error::Missing(_) => "mesh the surfaces and save the file again (`gmsh -2 case.geo`)",
            Error::Element { kind, .. } => kind.remedy(),
            Error::RepeatedNode(_) | Error::UnknownNode { .. } => {
                "the file is damaged: save it again from Gmsh (`Mesh.SaveAll = 0;` with all surfaces in physical groups)"
            }
            Error::NotPlane { .. } => "draw the surfaces in the plane z = 0",
            Error::ManyGroups { .. } => {
                "keep each curve in one `Physical Curve` and each surface in one `Physical Surface` only"
            }
            Error::RepeatedElement(..) => "mesh each surface once and keep it in one `Physical Surface` only",
            Error::NoGroup { .. } => {
                "add their surfaces to a `Physical Surface(\"name\") = {...};`, or define none at all (then all cells are `body`)"
            }
            Error::NoTags { .. } => {
                "MSH 2.2 with `Mesh.SaveAll = 1` loses the groups: save it with `Mesh.SaveAll = 0;`, or as MSH 4.1 (`Mesh.MshFileVersion = 4.1;`)"
            }
            Error::Stray { .. } => {
                "take the curve out of the physical curve, or mesh the surface beside it with quadrilaterals"
            }
            Error::Mesh(error) => return error.remedy(),
        };
        text.to_owned()
    }

    /// The error of the library's surface, with file and place.
    pub fn in_file(self, path: &Path) -> crate::Error {
        let remedy = self.remedy();
        match self {
            Error::Syntax { at: At::Line(line, column), .. } => {
                crate::Error::at(Place::line(path, line, column), self.to_string(), remedy)
            }
            Error::Syntax { at: At::Byte(byte), .. } => {
                crate::Error::at(Place::file(path), format!("byte {byte}: {self}"), remedy)
            }
            _ => crate::Error::at(Place::file(path), self.to_string(), remedy),
        }
    }
}
