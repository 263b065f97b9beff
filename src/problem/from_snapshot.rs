//! The state of a snapshot as the initial state of a run.

use super::{Body, Problem, Setup};
use crate::error::{Error, Result};
use crate::io::fingerprint::Fingerprint;
use crate::io::snapshot::Snapshot;
use crate::run::Folder;
use crate::scene::Scene;
use crate::state::{Received, State, UNKNOWNS};
use crate::step::Scheme;
use std::path::Path;

impl Problem {
    /// The problem of a stopped run at one of its snapshots, on the grid that it had there.
    ///
    /// # Errors
    /// Files that cannot be read; a snapshot that does not belong to the scene and mesh of the run.
    pub fn of_snapshot(scene: &Scene, folder: &Folder, snapshot: &Snapshot) -> Result<Self> {
        let body = Body::read(scene, folder, &snapshot.grid)?;
        Setup::of(scene).build_from(body, |_, scheme| {
            let blocks = &scheme.operators.blocks;
            if snapshot.cells() != blocks.slot.len() || snapshot.degree != scheme.operators.degree {
                let what = "the snapshot does not belong to the scene and mesh of this run";
                return Err(Error::input(what, "run the scene again with --force"));
            }
            let components = if snapshot.displacement.is_empty() { UNKNOWNS } else { UNKNOWNS + 2 };
            Ok(unpacked(snapshot, scheme, components))
        })
    }
}

/// The state of a snapshot, with its time and step.
fn unpacked(snapshot: &Snapshot, scheme: &Scheme, components: usize) -> State {
    let blocks = &scheme.operators.blocks;
    let state = State::pack(blocks, scheme.operators.nodes(), components, &snapshot.unknowns(components));
    let unheld = blocks.pack(&snapshot.unheld, snapshot.unheld_stride(), |_| 0.0);
    let creep = blocks.pack(&snapshot.creep, snapshot.creep_stride(), |_| 0.0);
    let received = snapshot.received.as_chunks::<3>().0.iter();
    let received = received.map(|&[one, two, work]| Received { impulse: [one, two], work }).collect();
    let mut state = State { time: snapshot.time, step: snapshot.step, unheld, creep, received, ..state };
    scheme.set_internal(&mut state, &snapshot.internal);
    scheme.set_boundary_memory(&mut state, &snapshot.boundary);
    state
}

impl Scene {
    /// The state of a snapshot, with its time and step.
    ///
    /// # Errors
    /// A snapshot of another grid, degree, law or time.
    pub(super) fn state_of_snapshot(&self, path: &Path, scheme: &Scheme) -> Result<State> {
        let snapshot = Snapshot::read(path)?;
        self.check_time(&snapshot)?;
        self.state_of(&snapshot, scheme)
    }

    /// The state of a snapshot that was read.
    ///
    /// # Errors
    /// A snapshot of another grid, degree or law.
    pub(super) fn state_of(&self, snapshot: &Snapshot, scheme: &Scheme) -> Result<State> {
        self.check_snapshot(snapshot, scheme.operators.blocks.slot.len())?;
        let fail = |what: String, remedy: &str| self.error("initial.snapshot", what, remedy);
        if let Some((what, remedy)) = snapshot.made_on.misfit(&Fingerprint::of(scheme)) {
            return Err(fail(format!("the snapshot is of a run with {what}"), remedy));
        }
        if snapshot.internal.len() != scheme.virgin_internal().len() {
            let what = "the snapshot has the internal variables of other laws or points".to_owned();
            return Err(fail(what, "give the materials and the cloud of that run"));
        }
        let wanted: usize = scheme.points_with_memory().iter().map(|point| point.numbers.len()).sum();
        // A run without such conditions keeps none: theirs is then the memory of a start.
        if !snapshot.boundary.is_empty() && snapshot.boundary.len() != wanted {
            let what = "the snapshot has the memory of other boundary conditions".to_owned();
            return Err(fail(what, "give the [[boundary]] conditions of that run"));
        }
        // Snapshots of earlier versions have no forces of pairs.
        let fits = [0, scheme.boundaries.len(), scheme.receivers()].contains(&(snapshot.received.len() / 3));
        if !fits {
            let what = "the snapshot has the forces of other boundary groups".to_owned();
            return Err(fail(what, "give the mesh of that run, with its groups"));
        }
        // Where no output asks for it, the displacement may count from here: what is held are jumps that come now.
        Ok(unpacked(snapshot, scheme, self.components()))
    }

    /// Whether a run that begins at a snapshot has a step to do.
    pub(super) fn check_time(&self, snapshot: &Snapshot) -> Result<()> {
        if snapshot.time.is_nan() || snapshot.time >= self.end {
            let what = format!("the snapshot is at {:e} s, and the run ends at {:e} s", snapshot.time, self.end);
            return Err(self.error("initial.snapshot", what, "give a later time.end"));
        }
        Ok(())
    }

    /// Whether a snapshot is of a mesh of so many cells and of the degree of the scene, and has what its outputs ask for.
    pub(super) fn check_snapshot(&self, snapshot: &Snapshot, cells: usize) -> Result<()> {
        let fail = |what: String, remedy: &str| self.error("initial.snapshot", what, remedy);
        if snapshot.cells() != cells || snapshot.degree != self.scheme.degree {
            let (given, degree) = (snapshot.cells(), snapshot.degree);
            let what = format!(
                "the snapshot has {given} cells of degree {degree}, the scene {cells} of {}",
                self.scheme.degree
            );
            return Err(fail(what, "give the mesh of that run, or bring it over by `dgmpm regrid`"));
        }
        if self.wants_displacement() && snapshot.displacement.is_empty() {
            let what = "an output asks for the displacement, which the snapshot lacks".to_owned();
            return Err(fail(what, "leave out the field `displacement` and the balance of the ledger"));
        }
        Ok(())
    }
}
