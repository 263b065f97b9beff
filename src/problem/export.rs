//! The snapshots of a run for ParaView, meshio and DOLFINx.

use super::series::{Series, Shown};
use crate::error::{Error, Result};
use crate::io::grid::{Groups, HighOrderGrid, PointCloud};
use crate::io::{mesh_file, pvd, vtkhdf, vtu, xdmf};
use crate::observe::export::Positions;
use crate::observe::{Field, Solution, export};
use crate::run::Folder;
use std::path::{Path, PathBuf};

/// The snapshots of a run, and where their exports go.
pub struct Export {
    series: Series,
    fields: Vec<Field>,
    out: PathBuf,
    positions: Positions,
}

impl Export {
    /// The snapshots of the folder of a run; grid and points are shown in the initial configuration.
    ///
    /// # Errors
    /// A folder that holds no run or no snapshot; one that cannot be written to.
    pub fn new(folder: &Folder) -> Result<Self> {
        let series = Series::of(folder)?.not_empty()?;
        let (fields, out) = (series.scene.export_fields(), folder.export());
        std::fs::create_dir_all(&out).map_err(|why| Error::output(&out, why))?;
        Ok(Self { series, fields, out, positions: Positions::Initial })
    }

    /// The same with grid and points where they are at each time, x = X + u, in files whose names end in `_deformed`.
    pub fn deformed(self) -> Self {
        Self { positions: Positions::Deformed, ..self }
    }

    /// Number of snapshots.
    pub fn count(&self) -> usize {
        self.series.files.len()
    }

    /// The folder that is written to.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// The path of a file of the export: `name`, then the number of a step, then the ending.
    fn path(&self, name: &str, step: Option<usize>, ending: &str) -> PathBuf {
        let deformed = if self.positions == Positions::Deformed { "_deformed" } else { "" };
        let step = step.map_or_else(String::new, |step| format!("_{step:06}"));
        self.out.join(format!("{name}{deformed}{step}.{ending}"))
    }

    /// Fields that the solution has.
    fn fields(&self, solution: &Solution) -> Vec<Field> {
        let there = |field: &Field| *field != Field::Displacement || solution.has_displacement();
        self.fields.iter().copied().filter(there).collect()
    }

    /// The grid of a snapshot with its fields.
    fn grid(&self, shown: &Shown) -> Result<HighOrderGrid> {
        if self.positions == Positions::Deformed && !shown.solution.has_displacement() {
            let what = format!("step {} has no displacement, by which its points could be moved", shown.step);
            return Err(Error::input(what, "run the scene with the output field `displacement`"));
        }
        let mut grid = export::grid(&shown.body.mesh, shown.solution, &self.fields(shown.solution), self.positions);
        (grid.cell_fields, grid.about) = (shown.cell_fields.clone(), self.about(shown));
        grid.groups = Some(Groups::of(&shown.body.mesh));
        Ok(grid)
    }

    /// The material points of a snapshot with their fields.
    fn points(&self, shown: &Shown) -> PointCloud {
        let (body, fields) = (shown.body, self.fields(shown.solution));
        let mut cloud =
            export::points(&body.mesh, &body.cloud, &body.virtual_points, shown.solution, &fields, self.positions);
        cloud.about = self.about(shown);
        cloud
    }

    /// Where the fields come from, and where points are.
    fn about(&self, shown: &Shown) -> String {
        format!("{}, positions: {}", shown.from.line(), self.positions.words())
    }

    /// VTU of grid and material points, with .pvd series.
    ///
    /// # Errors
    /// A snapshot that does not belong to the run, or has no displacement where points are to be moved; a file that cannot be written.
    pub fn vtu(&self) -> Result<()> {
        let (mut grids, mut points) = (Vec::new(), Vec::new());
        self.series.each(|shown| {
            let [grid_path, point_path] = ["grid", "points"].map(|name| self.path(name, Some(shown.step), "vtu"));
            vtu::write_grid(&grid_path, &self.grid(&shown)?)?;
            vtu::write_points(&point_path, &self.points(&shown))?;
            grids.push((shown.time, grid_path));
            points.push((shown.time, point_path));
            Ok(())
        })?;
        pvd::write_series(&self.path("grid", None, "pvd"), &grids)?;
        pvd::write_series(&self.path("points", None, "pvd"), &points)
    }

    /// VTKHDF of grid and material points: each a file for all times.
    ///
    /// # Errors
    /// As [`Export::vtu`].
    pub fn vtkhdf(&self) -> Result<()> {
        let [mut grids, mut points] = [
            vtkhdf::Series::create(&self.path("grid", None, "vtkhdf"))?,
            vtkhdf::Series::create(&self.path("points", None, "vtkhdf"))?,
        ];
        let mut is_first = true;
        self.series.each(|shown| {
            if std::mem::take(&mut is_first) {
                [&grids, &points]
                    .into_iter()
                    .try_for_each(|series| series.label(shown.from, self.positions.words()))?;
            }
            grids.push_grid(shown.time, &self.grid(&shown)?)?;
            points.push_points(shown.time, &self.points(&shown))
        })?;
        grids.finish()?;
        points.finish()
    }

    /// XDMF + HDF5: the series, each time on its grid; the mesh alone is that of the start.
    ///
    /// # Errors
    /// As [`Export::vtu`].
    pub fn xdmf(&self) -> Result<()> {
        let first = mesh_file::read_mesh(&self.series.folder.mesh())?;
        xdmf::write_mesh(&self.out.join("mesh.xdmf"), &first)?;
        xdmf::write_boundary(&self.out.join("boundary.xdmf"), &first)?;
        let mut series: Option<xdmf::Series> = None;
        self.series.each(|shown| {
            let grid = self.grid(&shown)?;
            let is_new = shown.is_new || self.positions == Positions::Deformed;
            let series = match &mut series {
                Some(series) => {
                    if is_new {
                        series.regrid(&grid)?;
                    }
                    series
                }
                none => {
                    let series = none.insert(xdmf::Series::create(&self.path("series", None, "xdmf"), &grid)?);
                    series.label(shown.from, self.positions.words())?;
                    series
                }
            };
            series.push(shown.time, &grid.point_fields, &grid.cell_fields)
        })?;
        series.map_or(Ok(()), xdmf::Series::finish)
    }
}
