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
pub use ledger::Ledger;
pub use line::{Line, Outside, Samples};
pub use schedule::{Schedule, When};
pub use snapshots::{Snapshots, take, write};
pub use solution::{Point, Solution};

use crate::error::Error;
use crate::mesh::Mesh;
use crate::state::State;
use crate::step::{Balance, Scheme, Survey};

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
}
