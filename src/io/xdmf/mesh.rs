//! The mesh alone, with shared nodes, and its boundary.

use std::path::Path;

use super::{Item, attribute, companion, file_name, uniform_grid, write_document};
use crate::error::Result;
use crate::io::hdf5;
use crate::mesh::{FACE_CORNERS, Mesh};

/// Writes the bilinear mesh as grid `mesh`: cells counter-clockwise, and the cell attribute `group` (index of the
/// material group). `meshio.read` reads it, and DOLFINx by `read_mesh()` and `read_meshtags(mesh, "mesh")`.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<()> {
    let cells: Vec<i64> = mesh.cells.as_flattened().iter().map(|&n| n as i64).collect();
    let groups: Vec<i32> = mesh.cell_group.iter().map(|&g| g as i32).collect();
    write_tagged(path, "mesh", &mesh.nodes, (&cells, 4), &groups)
}

/// Writes the boundary edges that bear a group as grid `boundary`, with the cell attribute `group`; nodes are numbered
/// as in [`write_mesh`]. DOLFINx reads it by `read_meshtags(mesh, "boundary")`.
pub fn write_boundary(path: &Path, mesh: &Mesh) -> Result<()> {
    let corners = |e: &crate::mesh::BoundaryEdge| FACE_CORNERS[e.face].map(|k| mesh.cells[e.cell][k] as i64);
    let edges: Vec<i64> = mesh.edges.iter().flat_map(corners).collect();
    let groups: Vec<i32> = mesh.edges.iter().map(|e| e.group as i32).collect();
    write_tagged(path, "boundary", &mesh.nodes, (&edges, 2), &groups)
}

/// Writes one grid of cells of `size` nodes with their groups.
fn write_tagged(path: &Path, name: &str, nodes: &[[f64; 2]], cells: (&[i64], usize), groups: &[i32]) -> Result<()> {
    let (topology, size) = cells;
    let h5 = companion(path)?;
    let group_name = format!("{name}/group");
    hdf5::create_sealed(&h5, hdf5::Kept::Named, |file| {
        hdf5::put_program(file)?;
        hdf5::put(file, &format!("{name}/topology"), &[groups.len(), size], topology)?;
        hdf5::put(file, &format!("{name}/geometry"), &[nodes.len(), 2], nodes.as_flattened())?;
        hdf5::put(file, &group_name, &[groups.len()], groups)
    })?;
    let file = file_name(&h5);
    write_document(path, |xml| {
        uniform_grid(xml, (&file, name), (groups.len(), size, nodes.len()), |xml| {
            let item = Item { file: &file, name: &group_name, shape: &[groups.len()], number: ("Int", "4") };
            attribute(xml, "group", "Scalar", "Cell", &item)
        })
    })
}
