//! The energies of the cells of each material through time.

use super::{Column, Track};
use crate::quantity::Seen;

/// Kinetic, strain and dissipated energy (as in the ledger, J/m) of each material, by its name. The dissipated energy is that since the
/// material was virgin, 0 for a law without internal variables.
pub struct Energies {
    /// The name of each material, in the order of the laws of the scheme.
    pub names: Vec<String>,
}

impl Track for Energies {
    fn columns(&self) -> Vec<Column> {
        let of = |name: &String| ["kinetic", "strain", "dissipated"].map(|part| (format!("{name}_{part}"), "J/m"));
        self.names.iter().flat_map(of).collect()
    }

    fn push(&mut self, seen: &Seen, row: &mut Vec<f64>) {
        let all = seen.scheme.totals_by_law(seen.state);
        // A material of the scene without a cell has no energy.
        for number in 0..self.names.len() {
            let of = all.get(number).map(|totals| [totals.kinetic, totals.strain, totals.dissipated.unwrap_or(0.0)]);
            row.extend(of.unwrap_or_default());
        }
    }
}
