//! `dgmpm export`: a run's snapshots for ParaView, meshio and DOLFINx.

use super::pipeline::Body;
use super::print::say;
use crate::basis::Lagrange;
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::grid::Field as Values;
use crate::io::snapshot::Snapshot;
use crate::io::{cloud_file, mesh_file, pvd, snapshot, vtu, xdmf};
use crate::material::Law;
use crate::observe::{Field, Solution, export};
use crate::run::Folder;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square; files go to its folder export/
    run: PathBuf,
    /// Formats, separated by commas
    #[arg(long, value_delimiter = ',', default_values_t = [Format::Vtu, Format::Xdmf])]
    format: Vec<Format>,
}

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// VTU of grid and material points, with .pvd series
    Vtu,
    /// XDMF + HDF5 time series, and the mesh alone
    Xdmf,
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if *self == Format::Vtu { "vtu" } else { "xdmf" })
    }
}

/// What all snapshots of a run share.
struct Export {
    body: Body,
    laws: Vec<Law>,
    basis: Lagrange,
    /// Where internal variables stand.
    places: Cloud,
    fields: Vec<Field>,
    cell_fields: Vec<Values>,
    out: PathBuf,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let folder = Folder::new(&args.run);
    if !folder.scene().is_file() {
        let what = format!("{} is not the folder of a run: it holds no scene.toml", args.run.display());
        return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
    }
    let files = if folder.snapshots().is_dir() { snapshot::list(&folder.snapshots())? } else { vec![] };
    if files.is_empty() {
        let what = format!("{} holds no snapshot", folder.snapshots().display());
        return Err(Error::input(what, "run a scene with an [[output]] of kind = \"fields\""));
    }
    let export = Export::new(&folder)?;
    std::fs::create_dir_all(&export.out).map_err(|why| Error::output(&export.out, why))?;
    if args.format.contains(&Format::Vtu) {
        export.vtu(&files)?;
    }
    if args.format.contains(&Format::Xdmf) {
        export.xdmf(&files)?;
    }
    say(format!("{} snapshots exported to {}", files.len(), export.out.display()));
    Ok(())
}

impl Export {
    fn new(folder: &Folder) -> Result<Self> {
        let scene = Scene::load(&folder.scene(), &[])?;
        let mesh = mesh_file::read_mesh(&folder.mesh())?;
        let (cloud, more) = cloud_file::read_with(&folder.cloud(), &mesh)?;
        scene.check_groups(&mesh.groups, &mesh.edge_groups)?;
        let material = scene.material_of_cells(&mesh);
        let body = Body { mesh, cloud, virtual_points: more.virtual_points, deficient: vec![], material };
        let certificates = match more.certificates {
            // A run of an older version.
            none if none.is_empty() => body.certificates(&scene)?,
            all => all,
        };
        let cell_fields = export::cell_fields(&body.mesh, &certificates, &body.material);
        let (laws, basis) = (scene.build_laws(), Lagrange::new(scene.scheme.degree));
        let places = scene.places(&body.cloud);
        Ok(Self { laws, basis, places, fields: scene.export_fields(), cell_fields, out: folder.export(), body })
    }

    /// Reads a snapshot and hands its solution to `use_it`.
    fn with<R>(&self, path: &Path, use_it: impl FnOnce(&Solution, f64) -> Result<R>) -> Result<R> {
        let snapshot = Snapshot::read(path)?;
        let same = snapshot.cells() == self.body.mesh.cells.len() && snapshot.degree + 1 == self.basis.len();
        if !same || snapshot.internal.len() != self.internal() {
            let what = format!("{} does not belong to the scene and mesh of this run", path.display());
            return Err(Error::input(what, "run the scene again with --force"));
        }
        let Self { basis, laws, body, places, .. } = self;
        use_it(&Solution::of_snapshot(&snapshot, basis, laws, &body.material, places), snapshot.time)
    }

    /// The number of internal variables of all points.
    fn internal(&self) -> usize {
        let of = |(cell, &law): (usize, &usize)| self.laws[law].internal().len() * self.places.of(cell).len();
        self.body.material.iter().enumerate().map(of).sum()
    }

    /// Fields that the solution has.
    fn fields(&self, solution: &Solution) -> Vec<Field> {
        let there = |field: &Field| *field != Field::Displacement || solution.has_displacement();
        self.fields.iter().copied().filter(there).collect()
    }

    fn vtu(&self, files: &[(usize, PathBuf)]) -> Result<()> {
        let (mut grids, mut points) = (Vec::new(), Vec::new());
        for (step, path) in files {
            let (grid_path, point_path) =
                (self.out.join(format!("grid_{step:06}.vtu")), self.out.join(format!("points_{step:06}.vtu")));
            let time = self.with(path, |solution, time| {
                let fields = self.fields(solution);
                let mut grid = export::grid(&self.body.mesh, solution, &fields);
                grid.cell_fields = self.cell_fields.clone();
                vtu::write_grid(&grid_path, &grid)?;
                let Body { mesh, cloud, virtual_points, .. } = &self.body;
                vtu::write_points(&point_path, &export::points(mesh, cloud, virtual_points, solution, &fields))?;
                Ok(time)
            })?;
            grids.push((time, grid_path));
            points.push((time, point_path));
        }
        pvd::write_series(&self.out.join("grid.pvd"), &grids)?;
        pvd::write_series(&self.out.join("points.pvd"), &points)
    }

    fn xdmf(&self, files: &[(usize, PathBuf)]) -> Result<()> {
        xdmf::write_mesh(&self.out.join("mesh.xdmf"), &self.body.mesh)?;
        xdmf::write_boundary(&self.out.join("boundary.xdmf"), &self.body.mesh)?;
        let empty = crate::io::grid::HighOrderGrid::of_mesh(&self.body.mesh, self.basis.len() - 1);
        let mut series = xdmf::Series::create(&self.out.join("series.xdmf"), &empty)?;
        for (_, path) in files {
            self.with(path, |solution, time| {
                let grid = export::grid(&self.body.mesh, solution, &self.fields(solution));
                series.push(time, &grid.point_fields, &self.cell_fields)
            })?;
        }
        series.finish()
    }
}
