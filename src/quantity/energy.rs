//! Energies of the body, per metre of thickness.

use super::{Quantity, Seen};

names! {
    /// Which energy, as in the ledger.
    Part {
        /// int |p|^2 / (2 rho0) dX.
        Kinetic = "kinetic",
        /// int W dX: all that is stored.
        Strain = "strain",
        /// What laws have dissipated since their material was virgin.
        Dissipated = "dissipated",
        /// Kinetic and strain energy together.
        Total = "total",
    }
}

/// An energy, J/m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// Which.
    pub part: Part,
}

impl Quantity for Energy {
    fn of(&self, seen: &Seen) -> f64 {
        let totals = seen.totals();
        match self.part {
            Part::Kinetic => totals.kinetic,
            Part::Strain => totals.strain,
            // No law with internal variables: nothing is dissipated.
            Part::Dissipated => totals.dissipated.unwrap_or(0.0),
            Part::Total => totals.energy(),
        }
    }
}
