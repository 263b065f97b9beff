//! `snapshots/000123.h5`: the state after a step. Each state is a file of its own, so that a killed run leaves only whole
//! files.
//!
//! Arrays, with M = degree + 1: `time` in s and `step`; `u` (cells, 6, M, M), the grid unknowns F11, F12, F21, F22, p1,
//! p2 at the Gauss nodes (node i along xi1, j along xi2); `displacement` (cells, 2, M, M) or empty; `creep` (cells, 4, M, 2), what the
//! points of faces have crept in m, where they have springs; `internal` (n), the
//! internal variables point by point: cells in the order of the mesh, points in that of the cloud (nodes a = i M + j for
//! ADER-DGFEM and RK-DGFEM), variables in that of the cell's law, which may have none; `boundary` (n), the memory of boundary
//! conditions, likewise; `received` (groups and 2 pairs, 3), what the body has received through each boundary group, and each side of a
//! contact pair from the other one, since the run began (impulse in N s/m and work in J/m), where an output asks for it; `corrected`, `rescued` (cells), what a limiter and the rescue did, where the run has one. Attributes
//! `mesh`, `cloud`: the files of the run folder that the state lives on; `mesh_hash`, `points_hash`, `densities`, `laws_hash`: what it was
//! made on ([`Fingerprint`]); `program`, `commit`, `kernel`, `scene_hash`, `operators_hash`: by which program it was made, and from what
//! ([`Provenance`]).

use std::path::{Path, PathBuf};

use super::fingerprint::Fingerprint;
use super::hash::Digest;
use super::hdf5;
use super::provenance::Provenance;
use super::store::{ArrayRef, Format, Rows, Store, write_kept};
use crate::error::{Error, Result};
use crate::mesh::FACES;
use crate::state::UNKNOWNS;
use crate::tensor::AXES;

/// The format of snapshots.
pub const FORMAT: Format = Format { name: "dgmpm snapshot", version: 1, remedy: "write it again by `dgmpm solve`" };

/// The state at a time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    /// Time, in s.
    pub time: f64,
    /// Steps done.
    pub step: usize,
    /// Space degree N.
    pub degree: usize,
    /// Grid unknowns `[cell][component 0..6][node i * M + j]`: (F11, F12, F21, F22, p1, p2) at the Gauss nodes.
    pub u: Vec<f64>,
    /// Displacement `[cell][component 0..2][node]`, in m; empty if it is not integrated.
    pub displacement: Vec<f64>,
    /// The part of the displacement whose jumps are not held by the flux, of the same shape; empty if all jumps are held
    /// ([`crate::state::State::unheld`]).
    pub unheld: Vec<f64>,
    /// The creep of face points `[cell][face][point][2]`, in m ([`crate::state::State::creep`]); empty where no springs are asked for.
    pub creep: Vec<f64>,
    /// Internal variables `[cell][point][variable]`, none for cells of elastic laws.
    pub internal: Vec<f64>,
    /// The memory of boundary conditions, cells in the order of the mesh, faces, points along the face, numbers; none for
    /// conditions without memory.
    pub boundary: Vec<f64>,
    /// By boundary group of the mesh impulse (2, N s/m) and work (J/m) since the run began; empty where no output asks for it.
    pub received: Vec<f64>,
    /// Of each cell, 1 where a limiter or another correction changed it in the last step; empty where there is none.
    pub corrected: Vec<f64>,
    /// Of each cell, in how many steps since this grid began it was stepped again at order 0; empty as `corrected`.
    pub rescued: Vec<f64>,
    /// The files of its grid.
    pub grid: GridFiles,
    /// What it was made on; empty texts of files of earlier versions.
    pub made_on: Fingerprint,
    /// By which program it was made, and from what.
    pub provenance: Provenance,
}

/// Numbers of the cells of a state that are made while a snapshot is written, in the order of the mesh: in the place of the lists of
/// [`Snapshot`], which are then empty. None for what the state does not have.
#[derive(Clone, Copy)]
pub struct OfCells<'a> {
    /// The number of cells.
    pub cells: usize,
    /// [`Snapshot::u`].
    pub u: Rows<'a>,
    /// [`Snapshot::displacement`].
    pub displacement: Option<Rows<'a>>,
    /// [`Snapshot::unheld`].
    pub unheld: Option<Rows<'a>>,
    /// [`Snapshot::creep`].
    pub creep: Option<Rows<'a>>,
}

/// Names of the files of a grid in the folder of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GridFiles {
    /// The mesh.
    pub mesh: String,
    /// The cloud.
    pub cloud: String,
}

impl Default for GridFiles {
    fn default() -> Self {
        Self { mesh: "mesh.h5".to_owned(), cloud: "cloud.h5".to_owned() }
    }
}

impl GridFiles {
    /// The names for a grid that the run changed to after a step: `mesh_000120.h5`, `cloud_000120.h5`.
    pub fn after(step: usize) -> Self {
        Self { mesh: format!("mesh_{step:06}.h5"), cloud: format!("cloud_{step:06}.h5") }
    }
}

impl Snapshot {
    /// Number of cells in the list of unknowns.
    pub fn cells(&self) -> usize {
        self.u.len() / (UNKNOWNS * (self.degree + 1).pow(2))
    }

    /// The first `components` of F, p, u as `[cell][component][node]`. u is 0 if the snapshot has no displacement.
    pub fn unknowns(&self, components: usize) -> Vec<f64> {
        let nodes = (self.degree + 1).pow(2);
        let mut all = Vec::with_capacity(self.cells() * components * nodes);
        for (cell, unknowns) in self.u.chunks(UNKNOWNS * nodes).enumerate() {
            all.extend_from_slice(unknowns);
            let (others, wanted) =
                (self.displacement.get(AXES * nodes * cell..).unwrap_or_default(), (components - UNKNOWNS) * nodes);
            all.extend(others.iter().copied().chain(std::iter::repeat(0.0)).take(wanted));
        }
        all
    }

    /// How many numbers each cell has in [`Snapshot::unheld`]; 0 if it is empty.
    pub fn unheld_stride(&self) -> usize {
        if self.unheld.is_empty() { 0 } else { 2 * (self.degree + 1).pow(2) }
    }

    /// How many numbers each cell has in [`Snapshot::creep`]; 0 if it is empty.
    pub fn creep_stride(&self) -> usize {
        if self.creep.is_empty() { 0 } else { FACES * (self.degree + 1) * AXES }
    }

    /// A hash of the state, of its time and step, to the bit; not of what corrections did in the last step, which not all snapshots have.
    pub fn bits(&self) -> String {
        let mut all = Digest::new();
        all.count(self.step).count(self.degree).reals([self.time].into_iter());
        let of_grid = [&self.u, &self.displacement, &self.unheld, &self.creep];
        for values in of_grid.into_iter().chain([&self.internal, &self.boundary, &self.received]) {
            all.reals(values.iter().copied());
        }
        all.finish()
    }

    fn fault(&self) -> Option<String> {
        if !self.time.is_finite() {
            return Some(format!("its time is {}", self.time));
        }
        let nodes = (self.degree + 1).pow(2);
        if !self.u.len().is_multiple_of(UNKNOWNS * nodes) {
            return Some(format!(
                "{} unknowns are no multiple of {UNKNOWNS} x {nodes} (degree {})",
                self.u.len(),
                self.degree
            ));
        }
        let wanted = 2 * nodes * self.cells();
        let given = self.displacement.len();
        for treated in [&self.corrected, &self.rescued].into_iter().filter(|treated| !treated.is_empty()) {
            if treated.len() != self.cells() {
                return Some(format!(
                    "{} numbers of corrected or rescued cells instead of {}",
                    treated.len(),
                    self.cells()
                ));
            }
        }
        let unheld = self.unheld.len();
        if unheld != 0 && unheld != wanted {
            return Some(format!("{unheld} displacements that are not held instead of {wanted} or none"));
        }
        let (creep, of_faces) = (self.creep.len(), self.creep_stride() * self.cells());
        if creep != of_faces {
            return Some(format!("{creep} numbers of the creep of faces instead of {of_faces} or none"));
        }
        (given != 0 && given != wanted).then(|| format!("{given} displacements instead of {wanted} or none"))
    }

    /// Writes the snapshot, bit for bit.
    pub fn write(&self, path: &Path) -> Result<()> {
        self.write_as(path, None, (FORMAT, hdf5::Kept::Named), vec![], vec![])
    }

    /// The same with numbers of the cells that are made while they are written.
    pub fn write_with(&self, path: &Path, made: &OfCells) -> Result<()> {
        self.write_as(path, Some(made), (FORMAT, hdf5::Kept::Named), vec![], vec![])
    }

    /// Writes the snapshot as a part of a file of another format, with further attributes and arrays.
    pub(super) fn write_as<'a>(
        &'a self,
        path: &Path,
        made: Option<&OfCells<'a>>,
        (format, kept): (Format, hdf5::Kept),
        more_attributes: Vec<(&'a str, String)>,
        more_arrays: Vec<(&'a str, Vec<usize>, ArrayRef<'a>)>,
    ) -> Result<()> {
        // What is made as it is written is not here to be looked at: each piece has as many numbers as its shape, or is an error.
        if let Some(what) = made.map_or_else(|| self.fault(), |_| None) {
            return Err(Error::output(path, what));
        }
        let (time, step, degree) = ([self.time], [self.step], [self.degree]);
        let mut arrays = vec![
            ("time", vec![], ArrayRef::F64(&time)),
            ("step", vec![1], ArrayRef::Index(&step)),
            ("degree", vec![1], ArrayRef::Index(&degree)),
        ];
        arrays.extend(self.arrays_of_cells(made));
        if !self.boundary.is_empty() {
            arrays.push(("boundary", vec![self.boundary.len()], ArrayRef::F64(&self.boundary)));
        }
        if !self.received.is_empty() {
            arrays.push(("received", vec![self.received.len() / 3, 3], ArrayRef::F64(&self.received)));
        }
        if !self.corrected.is_empty() {
            arrays.push(("corrected", vec![self.corrected.len()], ArrayRef::F64(&self.corrected)));
            arrays.push(("rescued", vec![self.rescued.len()], ArrayRef::F64(&self.rescued)));
        }
        arrays.extend(more_arrays);
        let mut attributes = more_attributes;
        attributes.extend([("mesh", self.grid.mesh.clone()), ("cloud", self.grid.cloud.clone())]);
        attributes.extend(self.provenance.attributes());
        attributes.extend(self.made_on.attributes());
        write_kept(path, format, &attributes, &arrays, kept)
    }

    /// The arrays with numbers of cells, and that of the internal variables: their order in the file.
    fn arrays_of_cells<'a>(&'a self, made: Option<&OfCells<'a>>) -> Vec<(&'a str, Vec<usize>, ArrayRef<'a>)> {
        let (side, cells) = (self.degree + 1, made.map_or_else(|| self.cells(), |made| made.cells));
        let of = |numbers: &'a [f64], rows: fn(&OfCells<'a>) -> Option<Rows<'a>>| match made.and_then(rows) {
            Some(rows) => (cells, ArrayRef::Rows(rows)),
            None => (if numbers.is_empty() { 0 } else { cells }, ArrayRef::F64(numbers)),
        };
        let (u, moved) = (of(&self.u, |made| Some(made.u)), of(&self.displacement, |made| made.displacement));
        let (unheld, creep) = (of(&self.unheld, |made| made.unheld), of(&self.creep, |made| made.creep));
        let mut arrays = vec![
            ("u", vec![u.0, UNKNOWNS, side, side], u.1),
            ("displacement", vec![moved.0, 2, side, side], moved.1),
            ("unheld", vec![unheld.0, 2, side, side], unheld.1),
            ("internal", vec![self.internal.len()], ArrayRef::F64(&self.internal)),
        ];
        if creep.0 > 0 {
            arrays.push(("creep", vec![creep.0, FACES, side, AXES], creep.1));
        }
        arrays
    }

    /// Reads a snapshot.
    pub fn read(path: &Path) -> Result<Self> {
        Self::take(&mut Store::read(path, FORMAT)?)
    }

    /// Takes the snapshot out of a file that holds more.
    pub(super) fn take(store: &mut Store) -> Result<Self> {
        let mut one = |name: &str| match store.indices(name, &[])?[..] {
            [value] => Ok(value),
            _ => Err(store.error(format!("`{name}` is not one number"))),
        };
        let (step, degree) = (one("step")?, one("degree")?);
        if degree > 64 {
            return Err(store.error(format!("the degree {degree} is not possible")));
        }
        let side = degree + 1;
        // Files of earlier versions have no such names: there was one grid a run.
        let name = |key: &str, usual: String| store.attribute(key).map_or(usual, str::to_owned);
        let GridFiles { mesh, cloud } = GridFiles::default();
        let grid = GridFiles { mesh: name("mesh", mesh), cloud: name("cloud", cloud) };
        let made_on = Fingerprint::by(|key| name(key, String::new()));
        let provenance = Provenance::by(|key| name(key, String::new()));
        // Files of earlier versions have no `unheld`, and those of runs without such a memory no `boundary`.
        let knows = |name: &str| store.names().any(|known| known == name);
        let knows_creep = knows("creep");
        let known = [knows("unheld"), knows("boundary"), knows("corrected") && knows("rescued"), knows("received")];
        let unheld = if known[0] { store.reals("unheld", &[2, side, side])? } else { vec![] };
        let boundary = if known[1] { store.reals("boundary", &[])? } else { vec![] };
        let creep = if knows_creep { store.reals("creep", &[FACES, side, AXES])? } else { vec![] };
        let received = if known[3] { store.reals("received", &[3])? } else { vec![] };
        let [corrected, rescued] = match known[2] {
            true => [store.reals("corrected", &[])?, store.reals("rescued", &[])?],
            false => [vec![], vec![]],
        };
        Ok(Self {
            grid,
            made_on,
            provenance,
            corrected,
            rescued,
            unheld,
            creep,
            boundary,
            received,
            time: store.real("time")?,
            step,
            degree,
            u: store.reals("u", &[UNKNOWNS, side, side])?,
            displacement: store.reals("displacement", &[2, side, side])?,
            internal: store.reals("internal", &[])?,
        })
        .and_then(|snapshot| match snapshot.fault() {
            Some(what) => Err(store.error(what)),
            None => Ok(snapshot),
        })
    }
}

/// The file name of the snapshot after a step: `000123.h5`.
pub fn path(folder: &Path, step: usize) -> PathBuf {
    folder.join(format!("{step:06}.h5"))
}

/// The snapshots of a folder, as (step, file), in the order of steps.
pub fn list(folder: &Path) -> Result<Vec<(usize, PathBuf)>> {
    let fail = |e: std::io::Error| {
        let place = crate::error::Place::file(folder);
        Error::at(place, format!("cannot be listed: {e}"), "name the folder `snapshots` of a run")
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        let is_h5 = path.extension().is_some_and(|e| e == "h5");
        let step = path.file_stem().and_then(|s| s.to_str()).and_then(|s| s.parse().ok());
        if let (true, Some(step)) = (is_h5, step) {
            found.push((step, path));
        }
    }
    found.sort();
    Ok(found)
}
