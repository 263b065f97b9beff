//! The state of a snapshot as the initial state of a run.

use super::Scene;
use crate::error::Result;
use crate::io::snapshot::Snapshot;
use crate::state::State;
use crate::step::Scheme;
use std::path::Path;

impl Scene {
    /// The state of a snapshot, with its time and step.
    ///
    /// # Errors
    /// A snapshot of another grid, degree, law or time.
    pub(super) fn state_of_snapshot(&self, path: &Path, scheme: &Scheme) -> Result<State> {
        let snapshot = Snapshot::read(path)?;
        let (cells, n) = (scheme.operators.blocks.slot.len(), scheme.operators.nodes());
        let fail = |what: String, remedy: &str| self.error("initial.snapshot", what, remedy);
        if snapshot.cells() != cells || snapshot.degree != scheme.operators.degree {
            let (given, degree) = (snapshot.cells(), snapshot.degree);
            let what = format!(
                "the snapshot has {given} cells of degree {degree}, the scene {cells} of {}",
                scheme.operators.degree
            );
            return Err(fail(what, "give the mesh of that run, or bring it over by `dgmpm regrid`"));
        }
        if snapshot.time >= self.end {
            let what = format!("the snapshot is at {:e} s, and the run ends at {:e} s", snapshot.time, self.end);
            return Err(fail(what, "give a later time.end"));
        }
        if self.wants_displacement() && snapshot.displacement.is_empty() {
            let what = "an output asks for the displacement, which the snapshot lacks".to_owned();
            return Err(fail(what, "leave out the field `displacement` and the balance of the ledger"));
        }
        // Where no output asks for it, the displacement may count from here: what is held are jumps that come now.
        let components = self.components();
        let state = State::pack(&scheme.operators.blocks, n, components, &snapshot.unknowns(components));
        let unheld = scheme.operators.blocks.pack(&snapshot.unheld, snapshot.unheld_stride(), |_| 0.0);
        let mut state = State { time: snapshot.time, step: snapshot.step, unheld, ..state };
        if snapshot.internal.len() != scheme.virgin_internal().len() {
            let what = "the snapshot has the internal variables of other laws or points".to_owned();
            return Err(fail(what, "give the materials and the cloud of that run"));
        }
        scheme.set_internal(&mut state, &snapshot.internal);
        Ok(state)
    }
}
