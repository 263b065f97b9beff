//! A field at a point.

use super::{Component, Places, Quantity, Seen};
use crate::error::Error;
use crate::exact::Exact;
use crate::mesh::Mesh;

/// The number of a field at a point X of the body.
pub struct PointValue {
    /// The field.
    pub component: Component,
    /// The point.
    pub at: Places,
}

impl Quantity for PointValue {
    fn of(&self, seen: &Seen) -> f64 {
        let solution = seen.solution();
        let of = |cell, xi| self.component.of(solution.law(cell), &solution.at(cell, xi));
        self.at.all.first().map_or(f64::NAN, |place| of(place.cell, place.xi))
    }

    fn exact(&self, exact: &dyn Exact, seen: &Seen, time: f64) -> Option<f64> {
        let place = self.at.all.first()?;
        self.component.exact(exact, seen.solution().law(place.cell), Places::inside(seen.mesh, place), time)
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        Ok(self.at.move_to(mesh)?)
    }
}
