//! `ledger.csv`: energy, momentum and health over time.

use super::{Observer, Schedule, View};
use crate::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

const HEADER: &str = "step,t,dt,kinetic_energy,strain_energy,total_energy,momentum_1,momentum_2,min_j,max_curl_f,c_max";

/// Writes a row each time it looks. Energies in J and momenta in kg m/s, per metre of thickness.
pub struct Ledger {
    schedule: Schedule,
    path: PathBuf,
    file: BufWriter<File>,
}

impl Ledger {
    /// Starts `path` with its header.
    ///
    /// # Errors
    /// Where the file cannot be made.
    pub fn create(path: &Path, schedule: Schedule) -> Result<Self, Error> {
        let file = File::create(path).map_err(|why| Error::output(path, why))?;
        let mut ledger = Self { schedule, path: path.to_owned(), file: BufWriter::new(file) };
        ledger.write(HEADER)?;
        Ok(ledger)
    }

    fn write(&mut self, row: &str) -> Result<(), Error> {
        // Flushed row by row: a run that dies leaves its history.
        let written = writeln!(self.file, "{row}").and_then(|()| self.file.flush());
        written.map_err(|why| Error::output(&self.path, why))
    }
}

impl Observer for Ledger {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        let totals = view.scheme.totals(view.state);
        let numbers = [
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
        ];
        let numbers = numbers.map(|x| format!("{x:e}")).join(",");
        self.write(&format!("{},{numbers}", view.state.step))
    }
}
