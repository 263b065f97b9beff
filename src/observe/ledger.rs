//! `ledger.csv`: energy, momentum, smallest J and largest speed over time, and the balance of energy.

use super::{Observer, Schedule, Sight, View};
use crate::error::Error;
use crate::io::csv::Table;
use crate::step::{Balance, Totals};
use crate::words::{Saved, Words};
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

/// The next column, if the displacement is known: the difference between F and the shape, [`Totals::max_drift`].
const DRIFT: &str = "max_drift";

/// The next column of a run with springs in the faces: what they store, [`Totals::in_faces`], part of the total energy.
const FACES: &str = "face_energy";

/// The next column, if a law has memory: the energy that laws have dissipated since their material was virgin.
const DISSIPATED: &str = "material_dissipation";

/// The last column, if the scene changes its grid: the energy that these changes have lost since the start of the run.
const REGRIDS: &str = "regrid_dissipation";
/// The next column of a run whose faces act on each other.
const CONTACT: &str = "contact_work";
/// The next column of a run with corrections.
const CORRECTIONS: &str = "correction_dissipation";
/// The last columns of a run with corrections or a rescue: how many cells a correction changed in the last step, and how often cells
/// were stepped again at order 0 since this grid began.
const TREATED: [&str; 2] = ["corrected_cells", "rescued_cells"];

/// The columns of the balance, after those before. All but the last are cumulated since the start of the run.
const BALANCE: [&str; 7] = [
    "boundary_work",
    "source_work",
    "flux_dissipation",
    "boundary_dissipation",
    "curl_dissipation",
    "remainder",
    "angular_momentum",
];

/// The further columns of a ledger.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Contents {
    /// The difference between F and the shape.
    pub drift: bool,
    /// The energy in the springs of faces.
    pub springs: bool,
    /// The energy that laws have dissipated.
    pub dissipated: bool,
    /// The columns of [`Balance`].
    pub balance: bool,
    /// With the balance: the energy that changes of grid have lost.
    pub regrids: bool,
    /// With the balance: the work between faces that act on each other.
    pub contact: bool,
    /// The cells that corrections and the rescue treat; with the balance, the energy that they have taken.
    pub corrections: bool,
}

/// Writes a row each time it observes. Energies in J, momenta in kg m/s and kg m^2/s, per metre of thickness.
pub struct Ledger {
    schedule: Schedule,
    contents: Contents,
    table: Table,
}

impl Ledger {
    /// Starts `path` with its header.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(path: &Path, schedule: Schedule, contents: Contents) -> Result<Self, Error> {
        let Contents { drift, springs, dissipated, balance, regrids, contact, corrections } = contents;
        let mut columns = COLUMNS.to_vec();
        columns.extend(drift.then_some(DRIFT));
        columns.extend(springs.then_some(FACES));
        columns.extend(dissipated.then_some(DISSIPATED));
        columns.extend(BALANCE.iter().filter(|_| balance));
        columns.extend((balance && regrids).then_some(REGRIDS));
        columns.extend((balance && contact).then_some(CONTACT));
        columns.extend((balance && corrections).then_some(CORRECTIONS));
        columns.extend(TREATED.iter().filter(|_| corrections));
        Ok(Self { schedule, contents, table: Table::create(path, &columns)? })
    }
}

/// The numbers of the columns of the balance.
fn columns(balance: &Balance, totals: &Totals) -> [f64; BALANCE.len()] {
    [
        balance.boundary_work,
        balance.source_work,
        balance.flux_dissipation,
        balance.boundary_dissipation,
        balance.curl_dissipation,
        balance.remainder(totals.accounted()),
        totals.angular_momentum.unwrap_or(f64::NAN),
    ]
}

/// The numbers of [`TREATED`].
fn treated(view: &View) -> [f64; TREATED.len()] {
    let mut sums = [0.0; TREATED.len()];
    for (cells, &count) in view.treated.as_chunks::<2>().0.iter().zip(&view.scheme.operators.blocks.count) {
        sums.iter_mut().zip(cells).for_each(|(sum, lanes)| *sum += lanes.0[..count].iter().sum::<f64>());
    }
    sums
}

impl Observer for Ledger {
    fn wants_balance(&self) -> bool {
        self.contents.balance
    }

    fn looks_at(&self) -> Sight {
        Sight::Totals
    }

    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        let totals = view.totals();
        let mut row = vec![
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
        ];
        row.extend(self.contents.drift.then(|| totals.max_drift.unwrap_or(f64::NAN)));
        row.extend(self.contents.springs.then_some(totals.in_faces));
        row.extend(self.contents.dissipated.then(|| totals.dissipated.unwrap_or(0.0)));
        if let Some(balance) = view.balance.filter(|_| self.contents.balance) {
            row.extend(columns(balance, &totals));
            row.extend(self.contents.regrids.then_some(balance.regrid_dissipation));
            row.extend(self.contents.contact.then_some(balance.contact_work));
            row.extend(self.contents.corrections.then_some(balance.correction_dissipation));
        }
        if self.contents.corrections {
            row.extend(treated(view));
        }
        self.table.push(&row)?;
        // Each row is written to the disk at once, so that a killed run leaves its history.
        self.table.flush()
    }

    fn save(&mut self, to: &mut Words) -> Result<(), Error> {
        self.table.save(to)
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        self.table.restore(from)
    }
}
