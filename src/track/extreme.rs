//! The smallest and the largest number of a field through time, and where they are.

use super::{Column, Track};
use crate::basis::Lagrange;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::quantity::{Component, Place, Places, Seen};
use std::collections::HashMap;

/// min and max of a component of a field over places, and the reference coordinates of both, m. NaN where a number is NaN.
pub struct Extremes {
    component: Component,
    unit: &'static str,
    at: Places,
    /// The values of the nodal basis at each xi that places have, and which of them each place has: cells have theirs at the same xi.
    /// Empty before the first state on a grid.
    basis: Basis,
}

/// Values of the nodal basis at places.
#[derive(Default)]
struct Basis {
    values: Vec<Vec<f64>>,
    of: Vec<usize>,
}

impl Basis {
    fn at(places: &Places, basis: &Lagrange) -> Self {
        let (mut out, mut known) = (Self::default(), HashMap::new());
        for place in &places.all {
            let number = *known.entry(place.xi.map(f64::to_bits)).or_insert_with(|| {
                out.values.push(basis.values_2d(place.xi));
                out.values.len() - 1
            });
            out.of.push(number);
        }
        out
    }
}

impl Extremes {
    /// Of a component, its unit (empty for a pure number), at places.
    pub fn new(component: Component, unit: &'static str, at: Places) -> Self {
        Self { component, unit, at, basis: Basis::default() }
    }
}

/// The smallest and the largest number with their places, the first of those that are equal; none where a number is NaN.
fn extremes<'a>(all: impl Iterator<Item = (f64, &'a Place)>) -> Option<[(f64, &'a Place); 2]> {
    let mut out: Option<[(f64, &Place); 2]> = None;
    for (value, place) in all {
        if value.is_nan() {
            return None;
        }
        let [low, high] = out.get_or_insert([(value, place); 2]);
        if value < low.0 {
            *low = (value, place);
        }
        if value > high.0 {
            *high = (value, place);
        }
    }
    out
}

impl Track for Extremes {
    fn columns(&self) -> Vec<Column> {
        let of = |end: &str| {
            [(end.to_owned(), self.unit), (format!("{end}_at_x"), "m"), (format!("{end}_at_y"), "m")].into_iter()
        };
        ["smallest", "largest"].into_iter().flat_map(of).collect()
    }

    fn push(&mut self, seen: &Seen, row: &mut Vec<f64>) {
        let solution = seen.solution();
        if self.basis.of.is_empty() {
            self.basis = Basis::at(&self.at, solution.basis);
        }
        let value = |at: &Place, number: usize| {
            let point = solution.combine(at.cell, at.xi, &self.basis.values[number]);
            self.component.of(solution.law(at.cell), &point)
        };
        match extremes(self.at.all.iter().zip(&self.basis.of).map(|(at, &number)| (value(at, number), at))) {
            Some(ends) => {
                for (value, place) in ends {
                    let x = Places::position(seen.mesh, place);
                    row.extend([value, x[0], x[1]]);
                }
            }
            None => row.extend([f64::NAN; 6]),
        }
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        self.basis = Basis::default();
        Ok(self.at.move_to(mesh)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_numbers_counts_and_nan_leaves_none() {
        let places = [0, 1, 2, 3].map(|cell| Place { cell, xi: [0.5; 2], s: 0.0 });
        let of = |values: [f64; 4]| {
            extremes(values.into_iter().zip(&places)).map(|ends| ends.map(|(value, place)| (value, place.cell)))
        };
        assert_eq!(of([2.0, 1.0, 2.0, 1.0]), Some([(1.0, 1), (2.0, 0)]));
        assert_eq!(of([2.0, f64::NAN, 3.0, 1.0]), None);
        assert_eq!(extremes(std::iter::empty()), None);
    }
}
