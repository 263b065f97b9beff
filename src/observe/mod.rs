//! Observers of a run: they write tables, snapshots and lines. When they observe ([`Schedule`]) is separate from what
//! they do ([`Observer`]). Observing changes no bit of the run. An empty list of observers costs nothing.

pub mod export;
pub mod fields;
mod ledger;
mod line;
mod schedule;
mod snapshots;
mod solution;
mod spot;

pub use fields::Field;
pub use ledger::{Contents, Ledger};
pub use line::{Line, Outside, Sample, Samples};
pub use schedule::{Schedule, When};
pub use snapshots::{Snapshots, take, with_cells, without_cells, write};
pub use solution::{Point, Solution};
pub use spot::Spot;

use crate::error::Error;
use crate::io::snapshot::GridFiles;
use crate::lane::F8;
use crate::mesh::Mesh;
use crate::state::State;
use crate::step::{Balance, EnergyMade, Scheme, Survey, Totals};
use crate::words::{Saved, Words};

/// What an observer sees: the state at the end of a step.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The state.
    pub state: &'a State,
    /// Its totals, where ranks have added them up; see [`View::totals`].
    pub totals: Option<Totals>,
    /// Its wave speeds and min J.
    pub survey: &'a Survey,
    /// The balance of energy since the start; `None` if no observer needs it.
    pub balance: Option<&'a Balance>,
    /// What a limiter and the rescue did in each cell, see [`crate::step::Work::treated`]; empty where the scheme has neither.
    pub treated: &'a [F8],
    /// The step that follows, s; 0 at the end of the run.
    pub dt: f64,
}

/// What an observer looks at of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sight {
    /// Its time, step and survey.
    Survey,
    /// And its totals: ranks add them up.
    Totals,
    /// And its unknowns: the first rank fetches them.
    Unknowns,
}

impl View<'_> {
    /// The totals of the state.
    pub fn totals(&self) -> Totals {
        self.totals.unwrap_or_else(|| self.scheme.totals(self.state))
    }
}

/// The grid on which the run continues.
#[derive(Clone, Copy)]
pub struct NewGrid<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The law of each cell.
    pub material: &'a [usize],
    /// Names of its files in the folder of the run.
    pub files: &'a GridFiles,
}

/// An observer: it gets the state at certain times.
pub trait Observer {
    /// Whether this observer needs the balance of energy.
    fn wants_balance(&self) -> bool {
        false
    }

    /// Whether this observer needs what the body receives through each boundary group, [`State::received`].
    fn wants_forces(&self) -> bool {
        false
    }

    /// What it looks at of a state. Ranks that share a run find it together, and so each of them has such observers at the same times.
    fn looks_at(&self) -> Sight {
        Sight::Unknowns
    }

    /// The times at which it observes.
    fn schedule(&mut self) -> &mut Schedule;

    /// Observes the state.
    ///
    /// # Errors
    /// The output cannot be written.
    fn observe(&mut self, view: &View) -> Result<(), Error>;

    /// Called once, during the run, if the method has made energy out of nothing. By default it does nothing.
    fn energy_made(&mut self, _: &EnergyMade) {}

    /// Something that deserves a line, such as what a regrid did. By default it does nothing.
    fn notice(&mut self, _: &str) {}

    /// Saves what the observer needs to go on in a run that is resumed, beside its schedule. By default nothing.
    ///
    /// # Errors
    /// A file that the disk does not take.
    fn save(&mut self, _: &mut Words) -> Result<(), Error> {
        Ok(())
    }

    /// Goes on from what [`Observer::save`] has saved, taken in the same order. The observer has been made for the grid of that time.
    ///
    /// # Errors
    /// What was saved by another observer; files that have lost what was in them.
    fn restore(&mut self, _: &mut Saved) -> Result<(), Error> {
        Ok(())
    }

    /// Called when the run continues on another grid. By default it does nothing; observers that keep data of the old
    /// grid need it.
    ///
    /// # Errors
    /// The observer cannot continue on this grid.
    fn regrid(&mut self, _: &NewGrid) -> Result<(), Error> {
        Ok(())
    }
}
