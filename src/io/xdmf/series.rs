//! Fields in time: the uniform grid `mesh`, then a temporal collection that includes it. Times after a regrid have their own
//! uniform grid instead. VTK reads such a series; readers that expect one grid in a series (meshio) do not.

use std::path::{Path, PathBuf};

use super::{Item, Written, Xml, attribute, companion, file_name, uniform_grid, write_document};
use crate::error::{Error, Result};
use crate::io::grid::{Field, HighOrderGrid, Kind, check_fields, lagrange_quad_lattice};
use crate::io::hdf5;
use crate::io::pending::Pending;
use crate::io::provenance::Provenance;
use crate::io::seal;

/// The name of the collection.
pub const SERIES: &str = "series";

/// A series that is being written; its files appear at [`Series::finish`].
pub struct Series {
    path: PathBuf,
    h5: PathBuf,
    file: hdf5_metno::File,
    pending: Pending,
    /// Cells and points of the grids. The last grid is the one in use.
    grids: Vec<(usize, usize)>,
    /// Sub-quadrilaterals of each cell.
    split: usize,
    steps: Vec<Step>,
}

/// A time, and its arrays in the HDF5 file.
struct Step {
    time: f64,
    /// The number of its grid.
    grid: usize,
    fields: Vec<Stored>,
}

/// A field in the HDF5 file.
struct Stored {
    name: String,
    kind: Kind,
    center: &'static str,
    dataset: String,
    rows: usize,
}

impl Series {
    /// Starts a series on the points and cells of a grid. The fields of the grid are ignored.
    pub fn create(path: &Path, grid: &HighOrderGrid) -> Result<Self> {
        grid.check()?;
        let h5 = companion(path)?;
        let pending = Pending::new(&h5)?;
        let file = hdf5::open_new(pending.path()).map_err(|e| Error::output(&h5, hdf5::reason(&e)))?;
        let split = grid.degree.max(1).pow(2);
        let (path, grids) = (path.to_owned(), Vec::new());
        let mut series = Self { path, h5, pending, file, grids, split, steps: Vec::new() };
        series.regrid(grid)?;
        Ok(series)
    }

    /// Says where the states come from and where points are, as attributes of the HDF5 file.
    pub fn label(&self, from: &Provenance, positions: &str) -> Result<()> {
        from.label(&self.file, positions).map_err(|e| Error::output(&self.h5, hdf5::reason(&e)))
    }

    /// Continues the series on another grid of the same degree.
    pub fn regrid(&mut self, grid: &HighOrderGrid) -> Result<()> {
        grid.check()?;
        let name = name_of(self.grids.len());
        let (cells, points) = (grid.cells(), grid.points.len());
        let topology = sub_quads(grid.degree.max(1), cells);
        let geometry: Vec<f64> = grid.points.iter().flat_map(|p| [p[0], p[1]]).collect();
        hdf5::put(&self.file, &format!("{name}/topology"), &[cells * self.split, 4], &topology)
            .and_then(|()| hdf5::put(&self.file, &format!("{name}/geometry"), &[points, 2], &geometry))
            .map_err(|e| Error::output(&self.h5, hdf5::reason(&e)))?;
        self.grids.push((cells, points));
        Ok(())
    }

    /// Adds the fields of a time: with a value at each point, and with a value in each cell.
    pub fn push(&mut self, time: f64, point_fields: &[Field], cell_fields: &[Field]) -> Result<()> {
        let grid = self.grids.len() - 1;
        check_fields(point_fields, self.grids[grid].1)?;
        check_fields(cell_fields, self.grids[grid].0)?;
        let number = self.steps.len();
        let mut fields = Vec::new();
        for field in point_fields {
            fields.push(self.put(number, field, "Node", &field.values)?);
        }
        for field in cell_fields {
            let of_cell = field.values.chunks(field.kind.components());
            let values: Vec<f64> = of_cell.flat_map(|v| v.repeat(self.split)).collect();
            fields.push(self.put(number, field, "Cell", &values)?);
        }
        self.steps.push(Step { time, grid, fields });
        Ok(())
    }

    fn put(&self, number: usize, field: &Field, center: &'static str, values: &[f64]) -> Result<Stored> {
        let rows = values.len() / field.kind.components();
        let name = field.name.clone();
        let written = Stored { name, kind: field.kind, center, dataset: dataset(number, center, field), rows };
        hdf5::put(&self.file, &written.dataset, &written.shape(), values)
            .map_err(|e| Error::output(&self.h5, hdf5::reason(&e)))?;
        Ok(written)
    }

    /// Finishes both files and gives them their names.
    pub fn finish(self) -> Result<()> {
        let Self { path, h5, pending, file, grids, split, steps } = self;
        file.flush().and_then(|()| file.close()).map_err(|e| Error::output(&h5, hdf5::reason(&e)))?;
        seal::put(pending.path()).map_err(|e| Error::output(&h5, e))?;
        pending.commit()?;
        let file = file_name(&h5);
        write_document(&path, |xml| {
            let size = |grid: usize| (grids[grid].0 * split, 4, grids[grid].1);
            uniform_grid(xml, (&file, "mesh"), size(0), |_| Ok(()))?;
            let names = [("Name", SERIES), ("GridType", "Collection"), ("CollectionType", "Temporal")];
            let collection = xml.create_element("Grid").with_attributes(names);
            if steps.is_empty() {
                return collection.write_empty().map(drop);
            }
            collection
                .write_inner_content(|xml| steps.iter().try_for_each(|s| step(xml, &file, s, size(s.grid))))
                .map(drop)
        })
    }
}

impl Stored {
    fn shape(&self) -> Vec<usize> {
        match self.kind {
            Kind::Scalar => vec![self.rows],
            kind => vec![self.rows, kind.components()],
        }
    }
}

fn dataset(number: usize, center: &str, field: &Field) -> String {
    format!("step{number:06}/{}/{}", if center == "Node" { "point" } else { "cell" }, field.name)
}

/// The name of a grid by its number.
fn name_of(grid: usize) -> String {
    if grid == 0 { "mesh".to_owned() } else { format!("mesh{grid}") }
}

fn step(xml: &mut Xml, file: &str, step: &Step, size: (usize, usize, usize)) -> Written {
    if step.grid > 0 {
        return uniform_grid(xml, (file, &name_of(step.grid)), size, |xml| values(xml, file, step));
    }
    let names = [("Name", "mesh"), ("GridType", "Uniform")];
    xml.create_element("Grid").with_attributes(names).write_inner_content(|xml| {
        let mesh = "xpointer(/Xdmf/Domain/Grid[@GridType='Uniform'][1]/*[self::Topology or self::Geometry])";
        xml.create_element("xi:include").with_attribute(("xpointer", mesh)).write_empty()?;
        values(xml, file, step)
    })?;
    Ok(())
}

/// The time of a step, and its fields.
fn values(xml: &mut Xml, file: &str, step: &Step) -> Written {
    let time = format!("{:e}", step.time);
    xml.create_element("Time").with_attribute(("Value", time.as_str())).write_empty()?;
    step.fields.iter().try_for_each(|field| {
        let kind = match field.kind {
            Kind::Scalar => "Scalar",
            Kind::Vector => "Vector",
            Kind::Tensor => "Tensor",
        };
        let shape = field.shape();
        let values = Item { file, name: &field.dataset, shape: &shape, number: ("Float", "8") };
        attribute(xml, &field.name, kind, field.center, &values)
    })
}

/// The n x n bilinear quadrilaterals of each cell, counter-clockwise, on its nodes in the order of VTK.
fn sub_quads(n: usize, cells: usize) -> Vec<i64> {
    let side = n + 1;
    let mut number = vec![0i64; side * side];
    for (node, [i, j]) in lagrange_quad_lattice(n).into_iter().enumerate() {
        number[j * side + i] = node as i64;
    }
    let corners = |k: usize| {
        let at = (k / n) * side + k % n;
        [at, at + 1, at + side + 1, at + side]
    };
    let one: Vec<i64> = (0..n * n).flat_map(|k| corners(k).map(|at| number[at])).collect();
    (0..cells).flat_map(|c| one.iter().map(move |&node| (c * side * side) as i64 + node)).collect()
}
