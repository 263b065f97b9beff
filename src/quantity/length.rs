//! The distance of two points of the material, in the current configuration.

use super::{Place, Places, Quantity, Seen};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::observe::Spot;

/// |x(B) - x(A)|, x = X + u; m.
pub struct Length {
    /// The points A and B.
    pub ends: Places,
}

impl Quantity for Length {
    fn of(&self, seen: &Seen) -> f64 {
        let now = |place: &Place| {
            let spot = Spot::new(seen.scheme, place.cell, place.xi);
            let (x, u) = (Places::position(seen.mesh, place), spot.of(seen.scheme, seen.state).displacement);
            [x[0] + u[0], x[1] + u[1]]
        };
        match &self.ends.all[..] {
            [a, b] => {
                let (a, b) = (now(a), now(b));
                (b[0] - a[0]).hypot(b[1] - a[1])
            }
            _ => f64::NAN,
        }
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        Ok(self.ends.move_to(mesh)?)
    }
}
