//! The width of a front along a line.

use super::places::Place;
use super::{Component, Places, Quantity, Seen};
use crate::error::Error;
use crate::exact::Exact;
use crate::mesh::Mesh;
use std::sync::Arc;

/// Shares of the jump between which a front is measured.
const LEVELS: [f64; 2] = [0.1, 0.9];

/// The distance between 10 % and 90 % of the jump of a field along a line.
pub struct FrontWidth {
    /// The field.
    pub component: Component,
    /// The line, from behind the front to before it.
    pub line: Places,
    /// Its first and last point X, m.
    pub ends: [[f64; 2]; 2],
    /// The values behind and before the front; none: those of the exact solution at the ends of the line, or of the state.
    pub values: Option<[f64; 2]>,
    /// The exact solution of the scene.
    pub solution: Option<Arc<dyn Exact>>,
    /// Whether the width is in cells instead of m.
    pub in_cells: bool,
}

/// The distance along a line between 10 % and 90 % of a jump, from rows of place and value that rise with the place, the value being
/// 1 behind and 0 before the front; and the places of both. A level is passed where the value last falls below it. NaN where a
/// level is not passed.
pub fn width(rows: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let places = LEVELS.map(|level| {
        let crossing = rows.windows(2).rfind(|pair| pair[0][1] > level && pair[1][1] <= level);
        crossing.map_or(f64::NAN, |pair| {
            let [[x, a], [y, b]] = [pair[0], pair[1]];
            x + (y - x) * (a - level) / (a - b)
        })
    });
    (places[0] - places[1], places)
}

impl Quantity for FrontWidth {
    fn of(&self, seen: &Seen) -> f64 {
        let solution = seen.solution();
        let value = |at: &Place| self.component.of(solution.law(at.cell), &solution.at(at.cell, at.xi));
        let (Some(first), Some(last)) = (self.line.all.first(), self.line.all.last()) else { return f64::NAN };
        let exact = self.solution.as_ref().and_then(|exact| self.exact_ends(exact.as_ref(), seen));
        let [behind, before] = self.values.or(exact).unwrap_or_else(|| [value(first), value(last)]);
        // A field that is the same everywhere has no front.
        if (behind - before).abs() <= self.component.rounding(solution.law(first.cell)) {
            return f64::NAN;
        }
        let row = |at: &Place| [at.s, (value(at) - before) / (behind - before)];
        let rows: Vec<[f64; 2]> = self.line.all.iter().map(row).collect();
        let (width, places) = width(&rows);
        if self.in_cells { width / self.cell_at(seen.mesh, 0.5 * (places[0] + places[1])) } else { width }
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        Ok(self.line.move_to(mesh)?)
    }
}

impl FrontWidth {
    /// The exact solution at the ends of the line.
    fn exact_ends(&self, exact: &dyn Exact, seen: &Seen) -> Option<[f64; 2]> {
        let (first, last) = (self.line.all.first()?, self.line.all.last()?);
        let of = |at: &Place, x| self.component.exact(exact, seen.solution().law(at.cell), x, seen.state.time);
        Some([of(first, self.ends[0])?, of(last, self.ends[1])?])
    }

    /// How far the cell at a place of the line reaches along it, m.
    fn cell_at(&self, mesh: &Mesh, s: f64) -> f64 {
        let Some(place) = self.line.all.iter().find(|place| place.s >= s) else { return f64::NAN };
        let [from, to] = self.ends;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let along = [0, 1].map(|k| (to[k] - from[k]) / length);
        let reach = mesh.corners(place.cell).map(|x| x[0] * along[0] + x[1] * along[1]);
        reach.iter().fold(f64::MIN, |a, b| a.max(*b)) - reach.iter().fold(f64::MAX, |a, b| a.min(*b))
    }
}
