//! `dgmpm export`: a run's snapshots for ParaView, meshio and DOLFINx.

use super::pipeline::Body;
use super::print::say;
use crate::basis::Lagrange;
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::grid::Field as Values;
use crate::io::snapshot::{GridFiles, Snapshot};
use crate::io::{cloud_file, mesh_file, pvd, snapshot, vtu, xdmf};
use crate::material::Law;
use crate::observe::{Field, Solution, export};
use crate::run::Folder;
use crate::scene::Scene;
use std::path::PathBuf;

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
    folder: Folder,
    scene: Scene,
    laws: Vec<Law>,
    basis: Lagrange,
    fields: Vec<Field>,
    out: PathBuf,
}

/// A grid of the run.
struct Sheet {
    files: GridFiles,
    body: Body,
    /// Where internal variables stand.
    places: Cloud,
    cell_fields: Vec<Values>,
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
        let (laws, basis, fields) = (scene.build_laws(), Lagrange::new(scene.scheme.degree), scene.export_fields());
        Ok(Self { folder: folder.clone(), laws, basis, fields, out: folder.export(), scene })
    }

    fn sheet(&self, files: &GridFiles) -> Result<Sheet> {
        let mesh = mesh_file::read_mesh(&self.folder.root.join(&files.mesh))?;
        let (cloud, more) = cloud_file::read_with(&self.folder.root.join(&files.cloud), &mesh)?;
        self.scene.check_groups(&mesh.groups, &mesh.edge_groups)?;
        let material = self.scene.material_of_cells(&mesh);
        let body = Body { mesh, cloud, virtual_points: more.virtual_points, deficient: vec![], material };
        let certificates = match more.certificates {
            // A grid that came in by a regrid, or a run of an older version.
            none if none.is_empty() => body.certificates(&self.scene)?,
            all => all,
        };
        let cell_fields = export::cell_fields(&body.mesh, &certificates, &body.material);
        let places = body.places(&self.scene).into_owned();
        Ok(Sheet { files: files.clone(), body, places, cell_fields })
    }

    /// The number of internal variables of all points of a grid.
    fn internal(&self, sheet: &Sheet) -> usize {
        let of = |(cell, &law): (usize, &usize)| self.laws[law].internal().len() * sheet.places.of(cell).len();
        sheet.body.material.iter().enumerate().map(of).sum()
    }

    /// Reads the snapshots, each with its own grid, and hands their solutions to `use_it`, with whether the grid is new.
    fn each(
        &self,
        files: &[(usize, PathBuf)],
        mut use_it: impl FnMut(usize, &Sheet, &Solution, f64, bool) -> Result<()>,
    ) -> Result<()> {
        let mut last: Option<Sheet> = None;
        for (step, path) in files {
            let snapshot = Snapshot::read(path)?;
            let (sheet, is_new) = match last.take() {
                Some(sheet) if sheet.files == snapshot.grid => (sheet, false),
                _ => (self.sheet(&snapshot.grid)?, true),
            };
            let fits = snapshot.cells() == sheet.body.mesh.cells.len() && snapshot.degree + 1 == self.basis.len();
            if !fits || snapshot.internal.len() != self.internal(&sheet) {
                let what = format!("{} does not belong to the scene and mesh of this run", path.display());
                return Err(Error::input(what, "run the scene again with --force"));
            }
            let solution =
                Solution::of_snapshot(&snapshot, &self.basis, &self.laws, &sheet.body.material, &sheet.places);
            use_it(*step, &sheet, &solution, snapshot.time, is_new)?;
            last = Some(sheet);
        }
        Ok(())
    }

    /// Fields that the solution has.
    fn fields(&self, solution: &Solution) -> Vec<Field> {
        let there = |field: &Field| *field != Field::Displacement || solution.has_displacement();
        self.fields.iter().copied().filter(there).collect()
    }

    fn vtu(&self, files: &[(usize, PathBuf)]) -> Result<()> {
        let (mut grids, mut points) = (Vec::new(), Vec::new());
        self.each(files, |step, sheet, solution, time, _| {
            let (grid_path, point_path) =
                (self.out.join(format!("grid_{step:06}.vtu")), self.out.join(format!("points_{step:06}.vtu")));
            let (fields, body) = (self.fields(solution), &sheet.body);
            let mut grid = export::grid(&body.mesh, solution, &fields);
            grid.cell_fields = sheet.cell_fields.clone();
            vtu::write_grid(&grid_path, &grid)?;
            vtu::write_points(
                &point_path,
                &export::points(&body.mesh, &body.cloud, &body.virtual_points, solution, &fields),
            )?;
            grids.push((time, grid_path));
            points.push((time, point_path));
            Ok(())
        })?;
        pvd::write_series(&self.out.join("grid.pvd"), &grids)?;
        pvd::write_series(&self.out.join("points.pvd"), &points)
    }

    /// The series, each time on its grid; the mesh alone is that of the start.
    fn xdmf(&self, files: &[(usize, PathBuf)]) -> Result<()> {
        let first = mesh_file::read_mesh(&self.folder.mesh())?;
        xdmf::write_mesh(&self.out.join("mesh.xdmf"), &first)?;
        xdmf::write_boundary(&self.out.join("boundary.xdmf"), &first)?;
        let mut series: Option<xdmf::Series> = None;
        self.each(files, |_, sheet, solution, time, is_new| {
            let grid = export::grid(&sheet.body.mesh, solution, &self.fields(solution));
            let series = match &mut series {
                Some(series) => {
                    if is_new {
                        series.regrid(&grid)?;
                    }
                    series
                }
                none => none.insert(xdmf::Series::create(&self.out.join("series.xdmf"), &grid)?),
            };
            series.push(time, &grid.point_fields, &sheet.cell_fields)
        })?;
        series.map_or(Ok(()), xdmf::Series::finish)
    }
}
