//! Snapshots of the grid unknowns and internal variables, one file each: what `export` and a restart read.

use super::{NewGrid, Observer, Schedule, View};
use crate::error::Error;
use crate::io::fingerprint::Fingerprint;
use crate::io::pending;
use crate::io::provenance::Provenance;
use crate::io::snapshot::{self, GridFiles, OfCells, Snapshot};
use crate::io::store::Rows;
use crate::state::{State, UNKNOWNS};
use crate::step::Scheme;
use crate::tensor::AXES;
use crate::words::{Saved, Words};
use std::path::{Path, PathBuf};

/// Writes `<folder>/<step>.h5`.
pub struct Snapshots {
    schedule: Schedule,
    folder: PathBuf,
    grid: GridFiles,
}

impl Snapshots {
    /// An observer that writes snapshots into a folder. The folder must exist.
    pub fn new(folder: &Path, schedule: Schedule) -> Self {
        Self { schedule, folder: folder.to_owned(), grid: GridFiles::default() }
    }
}

impl Observer for Snapshots {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        pending::check_folder(&self.folder)?;
        let Snapshot { corrected, rescued, .. } = treated(view);
        let path = snapshot::path(&self.folder, view.state.step);
        let rest = without_cells(view.scheme, view.state);
        let snapshot = Snapshot { corrected, rescued, grid: self.grid.clone(), ..rest };
        with_cells(view.scheme, view.state, |made| snapshot.write_with(&path, made))
    }

    fn save(&mut self, to: &mut Words) -> Result<(), Error> {
        to.text(&self.grid.mesh).text(&self.grid.cloud);
        Ok(())
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        self.grid = GridFiles { mesh: from.text()?, cloud: from.text()? };
        Ok(())
    }

    fn regrid(&mut self, grid: &NewGrid) -> Result<(), Error> {
        self.grid = grid.files.clone();
        Ok(())
    }
}

/// What a limiter and the rescue did in the cells, in the order of the mesh.
fn treated(view: &View) -> Snapshot {
    let cells = match view.treated.is_empty() {
        true => vec![],
        false => view.scheme.operators.blocks.unpack(view.treated, 2),
    };
    let of = |k: usize| cells.iter().skip(k).step_by(2).copied().collect();
    Snapshot { corrected: of(0), rescued: of(1), ..Snapshot::default() }
}

/// Writes a state into a folder of snapshots. Returns the path of the file.
///
/// # Errors
/// The file cannot be written.
pub fn write(scheme: &Scheme, state: &State, grid: &GridFiles, folder: &Path) -> Result<PathBuf, Error> {
    let path = snapshot::path(folder, state.step);
    let snapshot = Snapshot { grid: grid.clone(), ..without_cells(scheme, state) };
    with_cells(scheme, state, |made| snapshot.write_with(&path, made))?;
    Ok(path)
}

/// The state in the order of the mesh's cells.
pub fn take(scheme: &Scheme, state: &State) -> Snapshot {
    let all = 0..scheme.operators.blocks.slot.len();
    with_cells(scheme, state, |made| {
        let list = |rows: Option<Rows>| rows.map(|rows| (rows.0)(all.clone())).unwrap_or_default();
        let (u, displacement) = (list(Some(made.u)), list(made.displacement));
        let (unheld, creep) = (list(made.unheld), list(made.creep));
        Snapshot { u, displacement, unheld, creep, ..without_cells(scheme, state) }
    })
}

/// The state without the numbers of cells that [`with_cells`] makes.
pub fn without_cells(scheme: &Scheme, state: &State) -> Snapshot {
    let (internal, boundary) = (scheme.internal_of(state), scheme.boundary_memory_of(state));
    let received = state.received.iter().flat_map(|group| [group.impulse[0], group.impulse[1], group.work]).collect();
    let (time, step, degree, made_on) = (state.time, state.step, scheme.operators.degree, Fingerprint::of(scheme));
    let provenance = Provenance::of(scheme);
    Snapshot { time, step, degree, internal, boundary, received, made_on, provenance, ..Snapshot::default() }
}

/// What `work` does with the numbers of the cells of a state, in the order of the mesh, which are made where they are asked for.
pub fn with_cells<R>(scheme: &Scheme, state: &State, work: impl FnOnce(&OfCells) -> R) -> R {
    let (blocks, n) = (&scheme.operators.blocks, scheme.operators.nodes());
    let (stride, creep_of_block) = (state.components * n, scheme.creep_of_block());
    let u = |cells| blocks.unpack_some(&state.u, stride, 0..UNKNOWNS * n, cells);
    let displacement = |cells| blocks.unpack_some(&state.u, stride, UNKNOWNS * n..stride, cells);
    let unheld = |cells| blocks.unpack_some(&state.unheld, AXES * n, 0..AXES * n, cells);
    let creep = |cells| blocks.unpack_some(&state.creep, creep_of_block, 0..creep_of_block, cells);
    work(&OfCells {
        cells: blocks.slot.len(),
        u: Rows(&u),
        displacement: state.has_displacement().then_some(Rows(&displacement)),
        unheld: (!state.unheld.is_empty()).then_some(Rows(&unheld)),
        creep: (!state.creep.is_empty()).then_some(Rows(&creep)),
    })
}
