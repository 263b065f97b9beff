//! The mesh alone, with shared nodes, and its boundary.

use std::path::Path;

use super::{Item, Written, Xml, attribute, companion, file_name, names, uniform_grid, write_document};
use crate::error::Result;
use crate::io::hdf5;
use crate::io::middles::Middles;
use crate::mesh::Mesh;

/// The file of the boundary beside that of the mesh.
const BOUNDARY: &str = "boundary.xdmf";
/// Names of the grids of mesh tags.
const TAGS: [&str; 2] = ["cell_tags", "facet_tags"];

/// Writes the mesh as grid `mesh`: cells counter-clockwise (of 9 nodes in the order of VTK where the mesh is curved), and the cell attribute `group` (index of the
/// material group). `meshio.read` reads it, with the names of the groups as `field_data`, and DOLFINx by `read_mesh()` and
/// `read_meshtags(mesh, "mesh")`. It says that [`write_boundary`] writes `boundary.xdmf` beside it.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<()> {
    let numbers = Numbers::from_0(mesh);
    write_one(path, mesh, &numbers, &Grid::of_cells(mesh, &numbers, "mesh", "group"), Some(BOUNDARY))
}

/// Writes the boundary edges that bear a group as grid `boundary`, with the cell attribute `group`; nodes are numbered
/// as in [`write_mesh`]. DOLFINx reads it by `read_meshtags(mesh, "boundary")`.
pub fn write_boundary(path: &Path, mesh: &Mesh) -> Result<()> {
    let numbers = Numbers::from_0(mesh);
    write_one(path, mesh, &numbers, &Grid::of_edges(mesh, &numbers, "boundary", "group"), None)
}

/// Writes mesh and groups into one file: the grid `mesh`, and `cell_tags` and `facet_tags` with the groups of cells and of edges,
/// numbered by [`numbers`](names::numbers). DOLFINx reads them by `read_mesh()`, `read_meshtags(mesh, "cell_tags")` and
/// `read_meshtags(mesh, "facet_tags")`; meshio does not read files of several grids.
pub fn write_all(path: &Path, mesh: &Mesh) -> Result<()> {
    let numbers = Numbers::for_others(mesh);
    let grid = Grid::of_cells(mesh, &numbers, "mesh", TAGS[0]);
    let lines = Grid::of_edges(mesh, &numbers, TAGS[1], TAGS[1]);
    let h5 = companion(path)?;
    hdf5::create_sealed(&h5, hdf5::Kept::Named, |file| {
        hdf5::put_program(file)?;
        grid.put(file)?;
        lines.put_cells(file)
    })?;
    let file = file_name(&h5);
    write_document(path, |xml| {
        uniform_grid(xml, (&file, "mesh"), (grid.groups.len(), grid.size, grid.points.len()), |xml| {
            numbers.write(xml, mesh, None)
        })?;
        tags(xml, &file, ("mesh", TAGS[0]), &grid)?;
        tags(xml, &file, (TAGS[1], TAGS[1]), &lines)
    })
}

/// Cells of one kind, and their groups.
struct Grid {
    name: &'static str,
    /// The name of the attribute.
    data: &'static str,
    /// Nodes of a cell.
    size: usize,
    cells: Vec<i64>,
    groups: Vec<i32>,
    /// X of the nodes of the mesh and, of a curved one, of the middles.
    points: Vec<[f64; 2]>,
}

/// The numbers of the groups of a mesh.
struct Numbers {
    cells: Vec<i32>,
    edges: Vec<i32>,
}

impl Numbers {
    /// Their places in the lists of the mesh.
    fn from_0(mesh: &Mesh) -> Self {
        let all = |names: &[String]| (0..).take(names.len()).collect();
        Self { cells: all(&mesh.groups), edges: all(&mesh.edge_groups) }
    }

    /// By their names, see [`names::numbers`].
    fn for_others(mesh: &Mesh) -> Self {
        Self { cells: names::numbers(&mesh.groups), edges: names::numbers(&mesh.edge_groups) }
    }

    fn write(&self, xml: &mut Xml, mesh: &Mesh, facets: Option<&str>) -> Written {
        names::write(xml, [(&mesh.edge_groups, &self.edges), (&mesh.groups, &self.cells)], facets)
    }
}

impl Grid {
    fn of_cells(mesh: &Mesh, numbers: &Numbers, name: &'static str, data: &'static str) -> Self {
        let groups = mesh.cell_group.iter().map(|&group| numbers.cells[group]).collect();
        let middles = Middles::of(mesh);
        let more = |cell: usize| middles.of.get(cell).map(|own| [2, 1, 3, 0, 4].map(|k| own[k]));
        let nodes = |cell: usize| mesh.cells[cell].into_iter().chain(more(cell).into_iter().flatten());
        let cells = (0..mesh.cells.len()).flat_map(nodes).map(|node| node as i64).collect();
        let size = if middles.of.is_empty() { 4 } else { 9 };
        Self { name, data, size, cells, groups, points: points(mesh, &middles) }
    }

    fn of_edges(mesh: &Mesh, numbers: &Numbers, name: &'static str, data: &'static str) -> Self {
        let middles = Middles::of(mesh);
        let nodes = |e: &crate::mesh::BoundaryEdge| {
            let middle = middles.of.get(e.cell).map(|own| own[e.face]);
            mesh.face_nodes(e.cell, e.face).into_iter().chain(middle)
        };
        let cells = mesh.edges.iter().flat_map(nodes).map(|node| node as i64).collect();
        let groups = mesh.edges.iter().map(|edge| numbers.edges[edge.group]).collect();
        let size = if middles.of.is_empty() { 2 } else { 3 };
        Self { name, data, size, cells, groups, points: points(mesh, &middles) }
    }

    /// Writes its arrays, the points too.
    fn put(&self, file: &hdf5_metno::File) -> hdf5_metno::Result<()> {
        let geometry = format!("{}/geometry", self.name);
        hdf5::put(file, &geometry, &[self.points.len(), 2], self.points.as_flattened())?;
        self.put_cells(file)
    }

    /// Writes its cells and groups.
    fn put_cells(&self, file: &hdf5_metno::File) -> hdf5_metno::Result<()> {
        let count = self.groups.len();
        hdf5::put(file, &format!("{}/topology", self.name), &[count, self.size], &self.cells)?;
        hdf5::put(file, &format!("{}/{}", self.name, self.data), &[count], &self.groups)
    }
}

/// X of the nodes of a mesh and of its middles.
fn points(mesh: &Mesh, middles: &Middles) -> Vec<[f64; 2]> {
    mesh.nodes.iter().chain(&middles.places).copied().collect()
}

/// Writes one grid of cells with their groups.
fn write_one(path: &Path, mesh: &Mesh, numbers: &Numbers, grid: &Grid, facets: Option<&str>) -> Result<()> {
    let h5 = companion(path)?;
    hdf5::create_sealed(&h5, hdf5::Kept::Named, |file| {
        hdf5::put_program(file)?;
        grid.put(file)
    })?;
    let file = file_name(&h5);
    let (count, place) = (grid.groups.len(), format!("{}/{}", grid.name, grid.data));
    write_document(path, |xml| {
        uniform_grid(xml, (&file, grid.name), (count, grid.size, grid.points.len()), |xml| {
            numbers.write(xml, mesh, facets)?;
            attribute(xml, grid.data, "Scalar", "Cell", &groups(&file, &place, &[count]))
        })
    })
}

fn groups<'a>(file: &'a str, name: &'a str, shape: &'a [usize]) -> Item<'a> {
    Item { file, name, shape, number: ("Int", "4") }
}

/// A grid of mesh tags as DOLFINx writes it: cells on the points of the mesh, and one attribute. Its arrays stand below `place`.
fn tags(xml: &mut Xml, file: &str, (place, name): (&str, &str), grid: &Grid) -> Written {
    let count = grid.groups.len();
    let (cells, values) = (format!("{place}/topology"), format!("{place}/{}", grid.data));
    let head = [("Name", name), ("GridType", "Uniform")];
    xml.create_element("Grid").with_attributes(head).write_inner_content(|xml| {
        let points = ("xpointer", "xpointer(/Xdmf/Domain/Grid/Geometry)");
        xml.create_element("xi:include").with_attribute(points).write_empty()?;
        super::topology(
            xml,
            grid.size,
            count,
            &Item { file, name: &cells, shape: &[count, grid.size], number: ("Int", "8") },
        )?;
        attribute(xml, grid.data, "Scalar", "Cell", &groups(file, &values, &[count]))
    })?;
    Ok(())
}
