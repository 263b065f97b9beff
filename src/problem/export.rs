//! The snapshots of a run for ParaView, meshio and DOLFINx.

use super::Body;
use crate::basis::Lagrange;
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::grid::{Field as Values, Groups};
use crate::io::provenance::Provenance;
use crate::io::snapshot::{GridFiles, Snapshot};
use crate::io::{mesh_file, pvd, snapshot, vtu, xdmf};
use crate::observe::{Field, Solution, export};
use crate::run::Folder;
use crate::scene::Scene;
use crate::step::Law;
use std::path::{Path, PathBuf};

/// The snapshots of a run, and what all of them share.
pub struct Export {
    folder: Folder,
    scene: Scene,
    laws: Vec<Law>,
    basis: Lagrange,
    fields: Vec<Field>,
    files: Vec<(usize, PathBuf)>,
    out: PathBuf,
}

/// A grid of the run.
struct GridOfRun {
    files: GridFiles,
    body: Body,
    /// Where internal variables stand.
    places: Cloud,
    cell_fields: Vec<Values>,
}

/// A snapshot that is shown.
struct Shown<'a> {
    step: usize,
    time: f64,
    body: &'a Body,
    /// Whether it is the first on its grid.
    is_new: bool,
    solution: &'a Solution<'a>,
    /// The fields of the grid, and those of the cells at this time.
    cell_fields: Vec<Values>,
    /// Where the snapshot comes from.
    from: &'a Provenance,
}

impl Export {
    /// The snapshots of the folder of a run.
    ///
    /// # Errors
    /// A folder that holds no run or no snapshot; one that cannot be written to.
    pub fn new(folder: &Folder) -> Result<Self> {
        if !folder.scene().is_file() {
            let what = format!("{} is not the folder of a run: it holds no scene.toml", folder.root.display());
            return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
        }
        let files = if folder.snapshots().is_dir() { snapshot::list(&folder.snapshots())? } else { vec![] };
        if files.is_empty() {
            let what = format!("{} holds no snapshot", folder.snapshots().display());
            return Err(Error::input(what, "run a scene with an [[output]] of kind = \"fields\""));
        }
        let scene = Scene::load(&folder.scene(), &[])?;
        let (laws, basis, fields) = (scene.laws(), Lagrange::new(scene.scheme.degree), scene.export_fields());
        let out = folder.export();
        std::fs::create_dir_all(&out).map_err(|why| Error::output(&out, why))?;
        Ok(Self { folder: folder.clone(), laws, basis, fields, files, out, scene })
    }

    /// Number of snapshots.
    pub fn count(&self) -> usize {
        self.files.len()
    }

    /// The folder that is written to.
    pub fn out(&self) -> &Path {
        &self.out
    }

    fn grid_of_run(&self, files: &GridFiles) -> Result<GridOfRun> {
        let mut body = Body::read(&self.scene, &self.folder, files)?;
        if body.certificates.is_empty() {
            // A grid that came in by a regrid, or a run of an older version.
            body.certify(&self.scene)?;
        }
        let cell_fields = export::cell_fields(&body.mesh, &body.certificates, &body.material);
        let places = body.places(&self.scene).into_owned();
        Ok(GridOfRun { files: files.clone(), body, places, cell_fields })
    }

    /// The number of internal variables of all points of a grid.
    fn internal(&self, grid_of_run: &GridOfRun) -> usize {
        let of = |(cell, &law): (usize, &usize)| self.laws[law].history_len() * grid_of_run.places.of(cell).len();
        grid_of_run.body.material.iter().enumerate().map(of).sum()
    }

    /// Reads the snapshots, each with its own grid, and shows them.
    fn each(&self, mut show: impl FnMut(Shown) -> Result<()>) -> Result<()> {
        let mut last: Option<GridOfRun> = None;
        for (step, path) in &self.files {
            let snapshot = Snapshot::read(path)?;
            let (grid_of_run, is_new) = match last.take() {
                Some(grid_of_run) if grid_of_run.files == snapshot.grid => (grid_of_run, false),
                _ => (self.grid_of_run(&snapshot.grid)?, true),
            };
            let fits = snapshot.cells() == grid_of_run.body.mesh.cells.len() && snapshot.degree + 1 == self.basis.len();
            if !fits || snapshot.internal.len() != self.internal(&grid_of_run) {
                let what = format!("{} does not belong to the scene and mesh of this run", path.display());
                return Err(Error::input(what, "run the scene again with --force"));
            }
            let solution = Solution::of_snapshot(
                &snapshot,
                &self.basis,
                &self.laws,
                &grid_of_run.body.material,
                &grid_of_run.places,
            );
            let cell_fields =
                grid_of_run.cell_fields.iter().cloned().chain(export::treated_fields(&snapshot)).collect();
            let (time, body) = (snapshot.time, &grid_of_run.body);
            let from = &snapshot.provenance;
            show(Shown { step: *step, time, body, is_new, solution: &solution, cell_fields, from })?;
            last = Some(grid_of_run);
        }
        Ok(())
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
        self.each(|Shown { step, time, body, solution, cell_fields, from, .. }| {
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
        let first = mesh_file::read_mesh(&self.folder.mesh())?;
        xdmf::write_mesh(&self.out.join("mesh.xdmf"), &first)?;
        xdmf::write_boundary(&self.out.join("boundary.xdmf"), &first)?;
        let mut series: Option<xdmf::Series> = None;
        self.each(|Shown { time, body, is_new, solution, cell_fields, from, .. }| {
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
