//! Meshes as VTU and XDMF files have them: grids of points and cells of any kind, with numbers at the cells that name groups.
//!
//! A [`Part`] is one grid of a file. The first with quadrilaterals is the mesh ([`assemble()`]). Groups come from its data, or from
//! those of other parts, as DOLFINx writes mesh tags ([`tags`]): the groups of cells from data of quadrilaterals, those of edges from
//! data of lines. What is not in a group is in `body` or `boundary`.

mod assemble;
mod cells;
mod tags;

pub use assemble::{Source, assemble, nodal};
pub use cells::{Cells, Shape, of_mixed, of_vtk, of_xdmf};

use crate::error::Result;
use crate::mesh::map::Bulge;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What of a file of another program names the groups. [`Default`] is what [`tags`] finds by itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tags {
    /// The name of the data.
    pub data: Option<String>,
    /// The file of the lines with the groups of edges, where it is not that of the mesh.
    pub facets: Option<PathBuf>,
    /// Names for numbers.
    pub names: Vec<(Of, i64, String)>,
}

/// What is in a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Of {
    /// Boundary edges.
    Edges = 1,
    /// Cells.
    Cells = 2,
}

/// Names of the numbers of groups.
pub type Names = BTreeMap<(Of, i64), String>;

/// One grid of a file.
#[derive(Default)]
pub struct Part<'a> {
    /// Its name.
    pub name: String,
    /// Its points, X in m; none where it stands on those of the mesh.
    pub points: Option<Vec<[f64; 3]>>,
    /// Its cells.
    pub cells: Cells,
    /// Numbers at all of its cells.
    pub data: Vec<Data<'a>>,
    /// Names of groups.
    pub names: Names,
    /// Set where it is an export of this program in which each cell has points of its own: the edges of groups as cell, local
    /// face, number of the group.
    pub own_edges: Option<Vec<[usize; 3]>>,
    /// How its cells are curved ([`Bulge`]), where such an export says that; else empty.
    pub own_bulges: Vec<Bulge>,
    /// The file beside it that has the lines.
    pub facets: Option<String>,
}

/// Numbers at the cells of a part, which are read when they are needed.
pub struct Data<'a> {
    /// Their name.
    pub name: String,
    /// Whether their type is that of whole numbers.
    pub whole: bool,
    /// Reads them.
    pub values: Box<dyn Fn() -> Result<Vec<f64>> + 'a>,
}

/// Numbers at all nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AtNodes {
    /// Their name.
    pub name: String,
    /// Numbers of a node.
    pub components: usize,
    /// `[node][component]`.
    pub values: Vec<f64>,
}

/// What takes the place of exports of this program, for messages.
pub const OWN: &str =
    "a state of dgmpm goes on from a snapshot, or from points_*.vtu of an export: `path` in [cloud], from = \"cloud\"";
