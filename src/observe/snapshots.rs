//! Snapshots of the grid unknowns and internal variables, one file each: what `export` and a restart read.

use super::{Observer, Schedule, View};
use crate::error::Error;
use crate::io::snapshot::{self, Snapshot};
use crate::state::{State, UNKNOWNS};
use crate::step::Scheme;
use std::path::{Path, PathBuf};

/// Writes `<folder>/<step>.h5`.
pub struct Snapshots {
    schedule: Schedule,
    folder: PathBuf,
}

impl Snapshots {
    /// Snapshots into a folder that exists.
    pub fn new(folder: &Path, schedule: Schedule) -> Self {
        Self { schedule, folder: folder.to_owned() }
    }
}

impl Observer for Snapshots {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        write(view.scheme, view.state, &self.folder).map(|_| ())
    }
}

/// Writes a state into a folder of snapshots; the path of the file.
///
/// # Errors
/// Where the file cannot be written.
pub fn write(scheme: &Scheme, state: &State, folder: &Path) -> Result<PathBuf, Error> {
    let path = snapshot::path(folder, state.step);
    take(scheme, state).write(&path)?;
    Ok(path)
}

/// The state in the order of the mesh's cells.
pub fn take(scheme: &Scheme, state: &State) -> Snapshot {
    let n = scheme.operators.nodes();
    let all = state.unpack(&scheme.operators.blocks, n);
    let (mut u, mut displacement) = (Vec::new(), Vec::new());
    for cell in all.chunks(state.components * n) {
        let (unknowns, others) = cell.split_at(UNKNOWNS * n);
        u.extend_from_slice(unknowns);
        displacement.extend_from_slice(others);
    }
    let internal = scheme.internal_of(state);
    Snapshot { time: state.time, step: state.step, degree: scheme.operators.degree, u, displacement, internal }
}
