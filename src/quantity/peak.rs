//! The largest or smallest number of a field over the body.

use super::{Component, Places, Quantity, Seen};
use crate::error::Error;
use crate::exact::Exact;
use crate::mesh::Mesh;

names! {
    /// Which end of the values.
    Extreme {
        /// The largest.
        Largest = "largest",
        /// The smallest.
        Smallest = "smallest",
    }
}

impl Extreme {
    /// Of numbers; NaN where one of them is NaN, or where there is none.
    fn of(self, values: impl Iterator<Item = f64>) -> f64 {
        let further = |a: f64, b: f64| match self {
            _ if a.is_nan() || b.is_nan() => f64::NAN,
            Self::Largest => a.max(b),
            Self::Smallest => a.min(b),
        };
        values.reduce(further).unwrap_or(f64::NAN)
    }
}

/// The extreme of a field at the nodes, on the faces and in the corners of all cells.
pub struct Peak {
    /// The field.
    pub component: Component,
    /// Which end.
    pub extreme: Extreme,
    /// All of the body.
    pub at: Places,
}

impl Quantity for Peak {
    fn of(&self, seen: &Seen) -> f64 {
        let solution = seen.solution();
        let places = self.at.all.iter();
        self.extreme.of(places.map(|at| self.component.of(solution.law(at.cell), &solution.at(at.cell, at.xi))))
    }

    fn exact(&self, exact: &dyn Exact, seen: &Seen, time: f64) -> Option<f64> {
        let solution = seen.solution();
        let of = |at| Places::inside(seen.mesh, at);
        let values = self.at.all.iter().map(|at| self.component.exact(exact, solution.law(at.cell), of(at), time));
        let values: Option<Vec<f64>> = values.collect();
        Some(self.extreme.of(values?.into_iter()))
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        Ok(self.at.move_to(mesh)?)
    }
}
