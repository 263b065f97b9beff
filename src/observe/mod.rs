//! What a run shows of itself. When (a [`Schedule`]) is apart from what (an [`Observer`]); observing changes no bit of
//! the run. An empty list of observers costs nothing.

pub mod export;
pub mod fields;
mod ledger;
mod line;
mod schedule;
mod snapshots;
mod solution;

pub use fields::Field;
pub use ledger::{Contents, Ledger};
pub use line::{Line, Outside, Samples};
pub use schedule::{Schedule, When};
pub use snapshots::{Snapshots, take, write};
pub use solution::{Point, Solution};

use crate::error::Error;
use crate::io::snapshot::GridFiles;
use crate::mesh::Mesh;
use crate::state::State;
use crate::step::{Balance, EnergyMade, Scheme, Survey};

/// What an observer sees: the state at the end of a step.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The state.
    pub state: &'a State,
    /// Its wave speeds and min J.
    pub survey: &'a Survey,
    /// The balance of energy since the start; none where no observer wants it.
    pub balance: Option<&'a Balance>,
    /// The step that follows, s; 0 at the end of the run.
    pub dt: f64,
}

/// The grid that the run goes on with.
#[derive(Clone, Copy)]
pub struct NewGrid<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The law of each cell.
    pub material: &'a [usize],
    /// Names of its files in the folder of the run.
    pub files: &'a GridFiles,
}

/// Something that looks at the state at certain times.
pub trait Observer {
    /// Whether the run must meter its balance of energy for it.
    fn wants_balance(&self) -> bool {
        false
    }

    /// When it looks.
    fn schedule(&mut self) -> &mut Schedule;

    /// Looks.
    ///
    /// # Errors
    /// Where its output cannot be written.
    fn observe(&mut self, view: &View) -> Result<(), Error>;

    /// The body has made energy out of nothing: said once, while the run goes on. Nothing to do for those that say nothing.
    fn energy_made(&mut self, _: &EnergyMade) {}

    /// Something worth a line, such as what a regrid did. Nothing to do for those that say nothing.
    fn notice(&mut self, _: &str) {}

    /// The run goes on with another grid. Nothing to do for those that keep nothing of the old one.
    ///
    /// # Errors
    /// A grid on which it cannot go on.
    fn regrid(&mut self, _: &NewGrid) -> Result<(), Error> {
        Ok(())
    }
}
