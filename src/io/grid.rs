//! The output model, independent of the solver: fields on a grid of high-order quadrilaterals, and on points.

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::map::{self, Bulge};

/// How many components a field has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// 1 component.
    Scalar,
    /// 3 components (the third is 0 in the plane).
    Vector,
    /// 9 components, row-major.
    Tensor,
}

impl Kind {
    /// Number of components.
    pub fn components(self) -> usize {
        match self {
            Kind::Scalar => 1,
            Kind::Vector => 3,
            Kind::Tensor => 9,
        }
    }
}

/// A named field: the values of all points (or cells), each with its components.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// The name, such as `cauchy_stress`.
    pub name: String,
    /// Scalar, vector or tensor.
    pub kind: Kind,
    /// `[point][component]`.
    pub values: Vec<f64>,
}

impl Field {
    /// A field from its name, its number of components and its values.
    pub fn new(name: impl Into<String>, kind: Kind, values: Vec<f64>) -> Self {
        Self { name: name.into(), kind, values }
    }
}

/// A grid of quadrilaterals. Each cell has its own nodes, so that fields may jump from cell to cell.
///
/// Cell c owns the points `c * n .. (c + 1) * n` with n = [`HighOrderGrid::nodes_per_cell`], in the order of
/// [`lagrange_quad_nodes`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HighOrderGrid {
    /// Degree N of the fields; N = 0 and N = 1 have the 4 corners.
    pub degree: usize,
    /// Coordinates, in m.
    pub points: Vec<[f64; 3]>,
    /// Fields with a value at each point.
    pub point_fields: Vec<Field>,
    /// Fields with a value in each cell.
    pub cell_fields: Vec<Field>,
    /// The groups of the mesh, where the file is to be read as a mesh again.
    pub groups: Option<Groups>,
    /// Where the fields come from, for a comment.
    pub about: String,
}

/// The groups of a mesh, numbered from 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Groups {
    /// Names of the groups of cells; a cell field `group` has the number of each cell.
    pub cells: Vec<String>,
    /// Names of the groups of boundary edges.
    pub edges: Vec<String>,
    /// Cell, local face, group.
    pub tagged: Vec<[usize; 3]>,
    /// How the edges of the cells are curved, as in the mesh; empty where all are straight.
    pub bulges: Vec<Bulge>,
}

impl Groups {
    /// Those of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let tagged = mesh.edges.iter().map(|edge| [edge.cell, edge.face, edge.group]).collect();
        let bulges = if mesh.curved_cells() > 0 { mesh.bulges.clone() } else { vec![] };
        Self { cells: mesh.groups.clone(), edges: mesh.edge_groups.clone(), tagged, bulges }
    }
}

/// Points with fields, written as vertices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PointCloud {
    /// Coordinates, in m.
    pub points: Vec<[f64; 3]>,
    /// Fields with a value at each point.
    pub fields: Vec<Field>,
    /// Where the fields come from, for a comment.
    pub about: String,
}

impl HighOrderGrid {
    /// The cells of a mesh in their initial configuration, without fields.
    pub fn of_mesh(mesh: &Mesh, degree: usize) -> Self {
        let nodes = lagrange_quad_nodes(degree);
        let points = (0..mesh.cells.len()).flat_map(|cell| {
            let map = mesh.map(cell);
            nodes.iter().map(move |&xi| map::position(&map, xi)).map(|[x, y]| [x, y, 0.0])
        });
        Self { degree, points: points.collect(), ..Self::default() }
    }

    /// Nodes of each cell: (N + 1)^2, and 4 for N = 0.
    pub fn nodes_per_cell(&self) -> usize {
        (self.degree.max(1) + 1).pow(2)
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.points.len() / self.nodes_per_cell()
    }

    /// Checks that points and fields fit together.
    pub fn check(&self) -> Result<()> {
        if !self.points.len().is_multiple_of(self.nodes_per_cell()) {
            let what = format!("{} points are no multiple of {} per cell", self.points.len(), self.nodes_per_cell());
            return Err(Error::input(what, "give each cell its own nodes"));
        }
        check_fields(&self.point_fields, self.points.len())?;
        check_fields(&self.cell_fields, self.cells())
    }
}

impl PointCloud {
    /// Checks that points and fields fit together.
    pub fn check(&self) -> Result<()> {
        check_fields(&self.fields, self.points.len())
    }
}

/// Checks lengths and names of fields with a value at each of `count` points or cells.
pub(super) fn check_fields(fields: &[Field], count: usize) -> Result<()> {
    for (k, field) in fields.iter().enumerate() {
        let name = &field.name;
        if name.is_empty() || name.contains(|c: char| c == '/' || c == ':' || c.is_control()) {
            return Err(Error::input(format!("`{name}` cannot be the name of a field"), "use letters, digits and _"));
        }
        if fields[..k].iter().any(|other| other.name == *name) {
            return Err(Error::input(format!("two fields have the name `{name}`"), "give each field its own name"));
        }
        let wanted = count * field.kind.components();
        if field.values.len() != wanted {
            let what = format!("the field `{name}` has {} values instead of {wanted}", field.values.len());
            return Err(Error::input(what, "give each point (or cell) all components"));
        }
    }
    Ok(())
}

/// Lattice indices (i, j) in 0..=n of the nodes of a Lagrange quadrilateral of degree n >= 1 in the order of VTK
/// (`vtkHigherOrderQuadrilateral::PointIndexFromIJK`): corners counter-clockwise; edges bottom, right, top, left, each
/// in the direction of its increasing coordinate; then the inside, i fastest.
pub fn lagrange_quad_lattice(n: usize) -> Vec<[usize; 2]> {
    let inside = 1..n;
    let mut lattice = vec![[0, 0], [n, 0], [n, n], [0, n]];
    lattice.extend(inside.clone().map(|i| [i, 0]));
    lattice.extend(inside.clone().map(|j| [n, j]));
    lattice.extend(inside.clone().map(|i| [i, n]));
    lattice.extend(inside.clone().map(|j| [0, j]));
    lattice.extend(inside.clone().flat_map(|j| inside.clone().map(move |i| [i, j])));
    lattice
}

/// Parent coordinates in [0, 1]^2 of the output nodes of a cell of this degree, equispaced, in the order of VTK; the
/// 4 corners for degree 0.
pub fn lagrange_quad_nodes(degree: usize) -> Vec<[f64; 2]> {
    let n = degree.max(1);
    lagrange_quad_lattice(n).into_iter().map(|ij| ij.map(|i| i as f64 / n as f64)).collect()
}
