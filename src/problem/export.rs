//! The snapshots of a run for ParaView, meshio and DOLFINx.

use super::series::{Series, Shown};
use crate::error::{Error, Result};
use crate::io::grid::Groups;
use crate::io::{mesh_file, pvd, vtu, xdmf};
use crate::observe::{Field, Solution, export};
use crate::run::Folder;
use std::path::{Path, PathBuf};

/// The snapshots of a run, and where their exports go.
pub struct Export {
    series: Series,
    fields: Vec<Field>,
    out: PathBuf,
}

impl Export {
    /// The snapshots of the folder of a run.
    ///
    /// # Errors
    /// A folder that holds no run or no snapshot; one that cannot be written to.
    pub fn new(folder: &Folder) -> Result<Self> {
        let series = Series::of(folder)?.not_empty()?;
        let (fields, out) = (series.scene.export_fields(), folder.export());
        std::fs::create_dir_all(&out).map_err(|why| Error::output(&out, why))?;
        Ok(Self { series, fields, out })
    }

    /// Number of snapshots.
    pub fn count(&self) -> usize {
        self.series.files.len()
    }

    /// The folder that is written to.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// Fields that the solution has.
    fn fields(&self, solution: &Solution) -> Vec<Field> {
        let there = |field: &Field| *field != Field::Displacement || solution.has_displacement();
        self.fields.iter().copied().filter(there).collect()
    }

    /// VTU of grid and material points, with .pvd series.
    ///
    /// # Errors
    /// A snapshot that does not belong to the run; a file that cannot be written.
    pub fn vtu(&self) -> Result<()> {
        let (mut grids, mut points) = (Vec::new(), Vec::new());
        self.series.each(|Shown { step, time, body, solution, cell_fields, from, .. }| {
            let (grid_path, point_path) =
                (self.out.join(format!("grid_{step:06}.vtu")), self.out.join(format!("points_{step:06}.vtu")));
            let fields = self.fields(solution);
            let mut grid = export::grid(&body.mesh, solution, &fields);
            (grid.cell_fields, grid.about) = (cell_fields, from.line());
            grid.groups = Some(Groups::of(&body.mesh));
            vtu::write_grid(&grid_path, &grid)?;
            let mut cloud = export::points(&body.mesh, &body.cloud, &body.virtual_points, solution, &fields);
            cloud.about = from.line();
            vtu::write_points(&point_path, &cloud)?;
            grids.push((time, grid_path));
            points.push((time, point_path));
            Ok(())
        })?;
        pvd::write_series(&self.out.join("grid.pvd"), &grids)?;
        pvd::write_series(&self.out.join("points.pvd"), &points)
    }

    /// XDMF + HDF5: the series, each time on its grid; the mesh alone is that of the start.
    ///
    /// # Errors
    /// A snapshot that does not belong to the run; a file that cannot be written.
    pub fn xdmf(&self) -> Result<()> {
        let first = mesh_file::read_mesh(&self.series.folder.mesh())?;
        xdmf::write_mesh(&self.out.join("mesh.xdmf"), &first)?;
        xdmf::write_boundary(&self.out.join("boundary.xdmf"), &first)?;
        let mut series: Option<xdmf::Series> = None;
        self.series.each(|Shown { time, body, is_new, solution, cell_fields, from, .. }| {
            let grid = export::grid(&body.mesh, solution, &self.fields(solution));
            let series = match &mut series {
                Some(series) => {
                    if is_new {
                        series.regrid(&grid)?;
                    }
                    series
                }
                none => {
                    let series = none.insert(xdmf::Series::create(&self.out.join("series.xdmf"), &grid)?);
                    series.label(from)?;
                    series
                }
            };
            series.push(time, &grid.point_fields, &cell_fields)
        })?;
        series.map_or(Ok(()), xdmf::Series::finish)
    }
}
