//! Snapshots of the grid unknowns and internal variables, one file each: what `export` and a restart read.

use super::{NewGrid, Observer, Schedule, View};
use crate::error::Error;
use crate::io::fingerprint::Fingerprint;
use crate::io::pending;
use crate::io::provenance::Provenance;
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::state::{State, UNKNOWNS};
use crate::step::Scheme;
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
        Snapshot { corrected, rescued, grid: self.grid.clone(), ..take(view.scheme, view.state) }.write(&path)
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
    Snapshot { grid: grid.clone(), ..take(scheme, state) }.write(&path)?;
    Ok(path)
}

/// The state in the order of the mesh's cells.
pub fn take(scheme: &Scheme, state: &State) -> Snapshot {
    let n = scheme.operators.nodes();
    let stride = state.components * n;
    let of = |some| scheme.operators.blocks.unpack_some(&state.u, stride, some);
    let (u, displacement) = (of(0..UNKNOWNS * n), of(UNKNOWNS * n..stride));
    let unheld = match state.unheld.is_empty() {
        true => vec![],
        false => scheme.operators.blocks.unpack(&state.unheld, 2 * n),
    };
    let creep = match state.creep.is_empty() {
        true => vec![],
        false => scheme.operators.blocks.unpack(&state.creep, scheme.creep_of_block()),
    };
    let (internal, boundary) = (scheme.internal_of(state), scheme.boundary_memory_of(state));
    let received = state.received.iter().flat_map(|group| [group.impulse[0], group.impulse[1], group.work]).collect();
    let (time, step, degree, made_on) = (state.time, state.step, scheme.operators.degree, Fingerprint::of(scheme));
    Snapshot {
        time,
        step,
        degree,
        u,
        displacement,
        unheld,
        creep,
        internal,
        boundary,
        received,
        made_on,
        provenance: Provenance::of(scheme),
        ..Snapshot::default()
    }
}
