//! Slope limiters: step 3(c) of the paper's scheme, a non-oscillatory approximation at shocks.
//!
//! A [`Sensor`] marks the cells whose jumps are too large for a smooth solution; a [`CellLimiter`] cuts the modes of these cells back to
//! what their neighbours allow. Other cells keep their bits. Where a law has internal variables, which stay at their points, the
//! momentum alone is limited: another F with the internal variables of the old one would be another elastic strain (a copper bar makes 10 % of
//! its energy so). The displacement of a cell whose F is limited follows it in the mean; its velocity alone would not know.
//!
//! For ADER a limiter acts after the corrector and the control of the curl, for Runge-Kutta after each stage. Rotations of a cell that
//! it leaves behind are for the control of the curl of the next step.
//!
//! A new limiter is one file with a type that implements [`CellLimiter`] and its entry in the registry.

mod cell;
mod energy;
mod modes;
mod moment;
mod neighbour;
mod sensor;
mod vertex;
mod waves;

pub use cell::{Beside, Cell};
pub use modes::Modes;
pub use moment::MomentLimiter;
pub use sensor::Sensor;
pub use vertex::VertexLimiter;

use crate::lane::LANES;
use crate::operators::Operators;
use crate::riemann::Looks;
use crate::state::UNKNOWNS;
use crate::step::{Corrected, Correction, Made, Notes, Scheme};
use crate::tensor::DEFORMATION;
use energy::Nodal;
use modes::Legendre;

/// Limits one cell.
pub trait CellLimiter: Send + Sync + 'static {
    /// The name, as printed.
    fn name(&self) -> &'static str;

    /// The modes of the cell after limiting; none where nothing has to be cut.
    fn limit(&self, cell: &Cell) -> Option<Modes>;
}

/// A limiter of the cells that a sensor marks.
pub struct Limiter<K> {
    /// Which cells.
    pub sensor: Sensor,
    /// How.
    pub kind: K,
    legendre: Legendre,
}

impl<K: CellLimiter> Limiter<K> {
    /// For degree N in space.
    pub fn new(degree: usize, sensor: Sensor, kind: K) -> Self {
        Self { sensor, kind, legendre: Legendre::new(degree) }
    }

    /// Limits a lane; whether it has changed.
    fn limit(&self, made: &Made, block: &mut Corrected, lane: usize) -> bool {
        let cell = Cell { made, legendre: &self.legendre, block: block.number, lane };
        let Some(modes) = self.kind.limit(&cell) else { return false };
        let n = self.legendre.nodes();
        let weights = made.scheme.operators.node_weights(block.number, lane);
        let area: f64 = weights[..n].iter().sum();
        let old = Nodal::of(block.u, n, lane);
        let mut new = old.clone();
        let first = if cell.law().has_memory() { DEFORMATION } else { 0 };
        let values = self.legendre.values(&modes.of);
        // Modes of the parent cell are not orthogonal with J: a constant brings the means back.
        let shifts: [f64; UNKNOWNS] =
            std::array::from_fn(|k| (0..n).map(|a| weights[a] * (old.of[a][k] - values[a][k])).sum::<f64>() / area);
        for (new, values) in new.of[..n].iter_mut().zip(&values) {
            (first..UNKNOWNS).for_each(|k| new[k] = values[k] + shifts[k]);
        }
        energy::hold(cell.law(), &weights[..n], &old, &mut new);
        new.store(block.u, n, lane);
        // A displacement whose jumps the flux holds has energy of its own.
        if first == 0 && made.scheme.flux.looks() != Looks::Displacement {
            made.scheme.follow(block.number, lane, block.u);
        }
        true
    }
}

impl<K: CellLimiter> Correction for Limiter<K> {
    fn name(&self) -> &str {
        self.kind.name()
    }

    fn after_stages(&self) -> bool {
        true
    }

    fn numbers(&self, scheme: &Scheme) -> usize {
        Sensor::numbers(&scheme.operators)
    }

    fn look(&self, made: &Made, notes: &mut Notes) {
        self.sensor.mark(made, notes);
    }

    fn applies(&self, made: &Made, block: usize) -> bool {
        made.notes.marked[block] != 0
    }

    fn correct(&self, made: &Made, block: &mut Corrected) {
        let marked = made.notes.marked[block.number];
        block.changed = 0;
        for lane in (0..LANES).filter(|lane| marked >> lane & 1 == 1) {
            block.changed |= u8::from(self.limit(made, block, lane)) << lane;
        }
    }
}

/// The cells of a block as bits, without padding.
fn cells(operators: &Operators, block: usize) -> u8 {
    (u16::from(u8::MAX) >> (LANES - operators.blocks.count[block])) as u8
}

#[cfg(test)]
mod tests;
