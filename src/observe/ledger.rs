//! `ledger.csv`: energy, momentum and health over time.

use super::{Observer, Schedule, View};
use crate::error::Error;
use crate::io::csv::Table;
use std::path::Path;

const COLUMNS: [&str; 11] = [
    "step",
    "t",
    "dt",
    "kinetic_energy",
    "strain_energy",
    "total_energy",
    "momentum_1",
    "momentum_2",
    "min_j",
    "max_curl_f",
    "c_max",
];

/// Writes a row each time it looks. Energies in J and momenta in kg m/s, per metre of thickness.
pub struct Ledger {
    schedule: Schedule,
    table: Table,
}

impl Ledger {
    /// Starts `path` with its header.
    ///
    /// # Errors
    /// Where the file cannot be made.
    pub fn create(path: &Path, schedule: Schedule) -> Result<Self, Error> {
        Ok(Self { schedule, table: Table::create(path, &COLUMNS)? })
    }
}

impl Observer for Ledger {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        let totals = view.scheme.totals(view.state);
        self.table.push(&[
            view.state.step as f64,
            view.state.time,
            view.dt,
            totals.kinetic,
            totals.strain,
            totals.energy(),
            totals.momentum[0],
            totals.momentum[1],
            view.survey.min_j,
            totals.max_curl,
            view.survey.fastest,
        ])?;
        // Row by row on the disk: a run that dies leaves its history.
        self.table.flush()
    }
}
