//! How far a field leaves the range that it should stay in.

use super::places::Place;
use super::{Component, Places, Quantity, Seen};
use crate::error::Error;
use crate::exact::Exact;
use crate::mesh::Mesh;
use crate::words::{Saved, Words};
use std::sync::Arc;

/// The largest excess of a field above or below a range, over the size of the range; no number while the range has no size.
pub struct Overshoot {
    /// The field.
    pub component: Component,
    /// Where to look.
    pub at: Places,
    /// The range; that of the exact solution takes its place.
    pub range: [f64; 2],
    /// The exact solution of the scene, where the scene gives no range.
    pub solution: Option<Arc<dyn Exact>>,
}

/// The largest excess of values over `range`, by the size of the range; NaN where a value is NaN.
pub fn overshoot(values: impl Iterator<Item = f64>, [low, high]: [f64; 2]) -> f64 {
    let excess = values.map(|x| if x.is_nan() { x } else { (x - high).max(low - x).max(0.0) });
    excess.fold(0.0, |a: f64, b| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }) / (high - low)
}

/// The smallest and the largest of values.
pub(super) fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

impl Overshoot {
    /// The range of a state and of 0: what rests and what moves as at the start.
    pub fn range_of(component: &Component, at: &Places, seen: &Seen) -> [f64; 2] {
        let solution = seen.solution();
        let value = |at: &Place| component.of(solution.law(at.cell), &solution.at(at.cell, at.xi));
        range(at.all.iter().map(value).chain([0.0]))
    }

    /// Whether a range has no size but rounding, for the first law of the scheme.
    pub fn is_empty(component: &Component, [low, high]: [f64; 2], seen: &Seen) -> bool {
        seen.scheme.laws.first().is_some_and(|law| high - low <= component.rounding(law))
    }

    /// The range of the exact solution at the places.
    fn exact_range(&self, seen: &Seen) -> Option<[f64; 2]> {
        let exact = self.solution.as_ref()?;
        let of = |at: &Place| {
            let law = seen.solution().law(at.cell);
            self.component.exact(exact.as_ref(), law, Places::inside(seen.mesh, at), seen.state.time)
        };
        let values: Option<Vec<f64>> = self.at.all.iter().map(of).collect();
        Some(range(values?.into_iter()))
    }
}

impl Quantity for Overshoot {
    fn of(&self, seen: &Seen) -> f64 {
        let solution = seen.solution();
        let value = |at: &Place| self.component.of(solution.law(at.cell), &solution.at(at.cell, at.xi));
        let range = self.exact_range(seen).unwrap_or(self.range);
        // As of an exact solution before it has moved.
        if Self::is_empty(&self.component, range, seen) {
            return f64::NAN;
        }
        overshoot(self.at.all.iter().map(value), range)
    }

    fn save(&self, to: &mut Words) {
        to.reals(&self.range);
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        if let [low, high] = from.reals()?[..] {
            self.range = [low, high];
        }
        Ok(())
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        Ok(self.at.move_to(mesh)?)
    }
}
