//! `mesh.h5`: a mesh between the steps of the pipeline.
//!
//! Arrays: `nodes` (n, 2) in m; `cells` (c, 4), counter-clockwise; `cell_group` (c); `groups`; `edges` (e, 3) as cell,
//! local face, group; `edge_groups`; `original` (c), the numbers in the file that the mesh came from; and where cells are curved
//! `bulges` (c, 5, 2) in m: for the faces 0 to 3 the vector from the middle of the chord to that of the edge, then what is left at
//! the middle of the cell.

use std::path::Path;

use super::store::{ArrayRef, Format, Store, write_arrays};
use crate::error::{Place, Result};
use crate::mesh::{BoundaryEdge, FACES, Mesh};

/// The format of `mesh.h5`.
pub const FORMAT: Format = Format { name: "dgmpm mesh", version: 1, remedy: "write it again by `dgmpm mesh`" };

/// Writes a mesh.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<()> {
    let edges: Vec<usize> = mesh.edges.iter().flat_map(|e| [e.cell, e.face, e.group]).collect();
    let mut arrays = vec![
        ("nodes", vec![mesh.nodes.len(), 2], ArrayRef::F64(mesh.nodes.as_flattened())),
        ("cells", vec![mesh.cells.len(), 4], ArrayRef::Index(mesh.cells.as_flattened())),
        ("cell_group", vec![mesh.cell_group.len()], ArrayRef::Index(&mesh.cell_group)),
        ("groups", vec![mesh.groups.len()], ArrayRef::Text(&mesh.groups)),
        ("edges", vec![mesh.edges.len(), 3], ArrayRef::Index(&edges)),
        ("edge_groups", vec![mesh.edge_groups.len()], ArrayRef::Text(&mesh.edge_groups)),
        ("original", vec![mesh.original.len()], ArrayRef::U64(&mesh.original)),
    ];
    if mesh.curved_cells() > 0 {
        let bulges = ArrayRef::F64(mesh.bulges.as_flattened().as_flattened());
        arrays.push(("bulges", vec![mesh.bulges.len(), 5, 2], bulges));
    }
    write_arrays(path, FORMAT, &[], &arrays)
}

/// Reads a mesh; every index in it is within range, and every cell is convex and runs counter-clockwise.
pub fn read_mesh(path: &Path) -> Result<Mesh> {
    let mut store = Store::read(path, FORMAT)?;
    let nodes = store.reals("nodes", &[2])?;
    let cells = store.indices("cells", &[4])?;
    let edges = store.indices("edges", &[3])?;
    let bulges = if store.names().any(|name| name == "bulges") { store.reals("bulges", &[5, 2])? } else { vec![] };
    let mesh = Mesh {
        nodes: nodes.as_chunks::<2>().0.to_vec(),
        cells: cells.as_chunks::<4>().0.to_vec(),
        cell_group: store.indices("cell_group", &[])?,
        groups: store.texts("groups")?,
        edges: edges.as_chunks().0.iter().map(|&[cell, face, group]| BoundaryEdge { cell, face, group }).collect(),
        edge_groups: store.texts("edge_groups")?,
        original: store.unsigned("original", &[])?,
        bulges: bulges.as_chunks::<2>().0.as_chunks::<5>().0.to_vec(),
    };
    match fault(&mesh) {
        Some(what) => Err(store.error(what)),
        None => mesh.check().map(|()| mesh).map_err(|why| crate::Error::from(why).or_at(Place::file(path))),
    }
}

/// The first fault in the numbers of a mesh, if there is one: lengths and ranges, not geometry.
fn fault(mesh: &Mesh) -> Option<String> {
    let cells = mesh.cells.len();
    if mesh.cell_group.len() != cells || mesh.original.len() != cells {
        let (groups, original) = (mesh.cell_group.len(), mesh.original.len());
        return Some(format!("{cells} cells, but {groups} values of `cell_group` and {original} of `original`"));
    }
    if let Some(n) = mesh.nodes.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
        return Some(format!("node {n} has a coordinate that is not finite"));
    }
    let bad_cell = mesh.cells.iter().position(|cell| cell.iter().any(|&n| n >= mesh.nodes.len()));
    if let Some(c) = bad_cell {
        return Some(format!("cell {c} refers to nodes {:?}, but there are {}", mesh.cells[c], mesh.nodes.len()));
    }
    if let Some(c) = mesh.cell_group.iter().position(|&g| g >= mesh.groups.len()) {
        return Some(format!("cell {c} is of group {}, but there are {}", mesh.cell_group[c], mesh.groups.len()));
    }
    if ![0, cells].contains(&mesh.bulges.len()) {
        return Some(format!("{cells} cells, but {} values of `bulges`", mesh.bulges.len()));
    }
    let good_edge = |e: &BoundaryEdge| e.cell < cells && e.face < FACES && e.group < mesh.edge_groups.len();
    let bad_edge = mesh.edges.iter().position(|e| !good_edge(e))?;
    Some(format!("boundary edge {bad_edge} refers to a cell, face or group that does not exist"))
}
