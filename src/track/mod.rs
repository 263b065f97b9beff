//! Numbers through time: `tracks/<name>.csv`, a row each time it is asked for. The header has the unit of each column, such as
//! `force_1 [N/m]`; a pure number has none.
//!
//! What the numbers are ([`Track`]) is separate from when a row is due and how it is written ([`Tracked`]). A new one is a file with a
//! type that implements [`Track`], and its entry in the registry. Fields, places, lengths and energies are those of
//! [`crate::quantity`].

mod energy;
mod extreme;
mod force;
mod length;
mod probe;

pub use energy::Energies;
pub use extreme::Extremes;
pub use force::{Forces, Giver};
pub use length::Lengths;
pub use probe::Probe;

use crate::error::Error;
use crate::io::csv::Table;
use crate::mesh::Mesh;
use crate::observe::{NewGrid, Observer, Schedule, View};
use crate::quantity::Seen;
use crate::words::{Saved, Words};
use std::path::Path;

/// A column: its name and its unit, empty for a pure number.
pub type Column = (String, &'static str);

/// Numbers that are followed through time.
pub trait Track {
    /// The columns after the time.
    fn columns(&self) -> Vec<Column>;

    /// Appends the numbers of a state, one for each column; NaN where there is none.
    fn push(&mut self, seen: &Seen, row: &mut Vec<f64>);

    /// Called when the run continues on another mesh. What keeps places or numbers of groups finds them again.
    ///
    /// # Errors
    /// The mesh lacks what is followed.
    fn moved(&mut self, _mesh: &Mesh) -> Result<(), Error> {
        Ok(())
    }

    /// Saves what the next row depends on beside the state. By default nothing.
    fn save(&self, _: &mut Words) {}

    /// Goes on from what [`Track::save`] has saved.
    ///
    /// # Errors
    /// What was saved by another track.
    fn restore(&mut self, _: &mut Saved) -> Result<(), Error> {
        Ok(())
    }

    /// Whether it needs what the body receives through each boundary group.
    fn wants_forces(&self) -> bool {
        false
    }
}

/// Writes the numbers of a track.
pub struct Tracked {
    schedule: Schedule,
    table: Table,
    what: Box<dyn Track>,
    /// The law of each cell.
    material: Vec<usize>,
}

impl Tracked {
    /// Starts `path` with its header. The last row is that of the end of the run. `material` gives the law of each cell.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(path: &Path, what: Box<dyn Track>, material: &[usize], schedule: Schedule) -> Result<Self, Error> {
        let columns: Vec<String> =
            [("t".to_owned(), "s")].into_iter().chain(what.columns()).map(|(name, unit)| header(name, unit)).collect();
        let table = Table::create(path, &columns.iter().map(String::as_str).collect::<Vec<_>>())?;
        Ok(Self { schedule: schedule.with_end(), table, what, material: material.to_vec() })
    }
}

/// `name [unit]`; what separates the columns of a table cannot stand in a name, and may in that of a group.
fn header(name: String, unit: &str) -> String {
    let name = name.replace([',', '"', '\n', '\r'], "_");
    if unit.is_empty() { name } else { format!("{name} [{unit}]") }
}

impl Observer for Tracked {
    fn wants_forces(&self) -> bool {
        self.what.wants_forces()
    }

    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        let seen = Seen::new(view.mesh, view.scheme, view.state, &self.material);
        let mut row = vec![view.state.time];
        self.what.push(&seen, &mut row);
        self.table.push(&row)?;
        // Each row is written to the disk at once, so that a killed run leaves its history.
        self.table.flush()
    }

    fn save(&mut self, to: &mut Words) -> Result<(), Error> {
        self.what.save(to);
        self.table.save(to)
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        self.what.restore(from)?;
        self.table.restore(from)
    }

    fn regrid(&mut self, grid: &NewGrid) -> Result<(), Error> {
        self.material = grid.material.to_vec();
        self.what.moved(grid.mesh)
    }
}
