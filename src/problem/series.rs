//! The snapshots of a run, each with its own grid.

use super::Body;
use crate::basis::Lagrange;
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::grid::Field as Values;
use crate::io::hdf5;
use crate::io::provenance::Provenance;
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::observe::{Solution, export};
use crate::run::Folder;
use crate::scene::Scene;
use crate::step::Law;
use std::path::PathBuf;

/// The snapshots of a run, and what all of them share.
pub struct Series {
    /// The folder of the run.
    pub folder: Folder,
    /// The scene as run.
    pub scene: Scene,
    /// The laws.
    pub laws: Vec<Law>,
    basis: Lagrange,
    /// Step and file of each snapshot, in the order of steps.
    pub files: Vec<(usize, PathBuf)>,
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
pub struct Shown<'a> {
    /// Steps done.
    pub step: usize,
    /// Time, s.
    pub time: f64,
    /// Mesh and material points.
    pub body: &'a Body,
    /// Whether it is the first on its grid.
    pub is_new: bool,
    /// The unknowns.
    pub solution: &'a Solution<'a>,
    /// The fields of the grid, and those of the cells at this time.
    pub cell_fields: Vec<Values>,
    /// Where the snapshot comes from.
    pub from: &'a Provenance,
}

impl Series {
    /// The snapshots of the folder of a run, which may have none.
    ///
    /// # Errors
    /// A folder that holds no run.
    pub fn of(folder: &Folder) -> Result<Self> {
        if !folder.scene().is_file() {
            let what = format!("{} is not the folder of a run: it holds no scene.toml", folder.root.display());
            return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
        }
        let files = if folder.snapshots().is_dir() { snapshot::list(&folder.snapshots())? } else { vec![] };
        let scene = Scene::load(&folder.scene(), &[])?;
        let (laws, basis) = (scene.laws(), Lagrange::new(scene.scheme.degree));
        Ok(Self { folder: folder.clone(), laws, basis, files, scene })
    }

    /// The same, where there is a snapshot.
    ///
    /// # Errors
    /// There is none.
    pub fn not_empty(self) -> Result<Self> {
        if self.files.is_empty() {
            let what = format!("{} holds no snapshot", self.folder.snapshots().display());
            return Err(Error::input(what, "run a scene with an [[output]] of kind = \"fields\""));
        }
        Ok(self)
    }

    /// The time of each snapshot, s.
    ///
    /// # Errors
    /// A snapshot that cannot be read.
    pub fn times(&self) -> Result<Vec<f64>> {
        let time = |path: &PathBuf| {
            let reader = hdf5::Reader::open(path, snapshot::FORMAT.remedy)?;
            match reader.get("time")? {
                (_, hdf5::Values::F64(values)) if values.len() == 1 => Ok(values[0]),
                _ => Err(reader.error("`time` is not one real number")),
            }
        };
        self.files.iter().map(|(_, path)| time(path)).collect()
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
    ///
    /// # Errors
    /// A snapshot that cannot be read or does not belong to the run; what `show` answers.
    pub fn each(&self, mut show: impl FnMut(Shown) -> Result<()>) -> Result<()> {
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
            let material = &grid_of_run.body.material;
            let solution = Solution::of_snapshot(&snapshot, &self.basis, &self.laws, material, &grid_of_run.places);
            let cell_fields =
                grid_of_run.cell_fields.iter().cloned().chain(export::treated_fields(&snapshot)).collect();
            let (time, body) = (snapshot.time, &grid_of_run.body);
            let from = &snapshot.provenance;
            show(Shown { step: *step, time, body, is_new, solution: &solution, cell_fields, from })?;
            last = Some(grid_of_run);
        }
        Ok(())
    }
}
