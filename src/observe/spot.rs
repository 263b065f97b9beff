//! A point of the body whose state is found without looking at the rest of it: for outputs that look at few points often.

use super::{Field, Point};
use crate::state::{State, UNKNOWNS};
use crate::step::{Law, Scheme, history};

/// A point in a cell of a grid, with what its state is found from. Its numbers are those of [`super::Solution::at`], to the bit.
#[derive(Debug, Clone)]
pub struct Spot {
    block: usize,
    lane: usize,
    /// The values of the nodal basis there.
    weights: Vec<f64>,
    /// The point of the cell whose internal variables it has: the nearest one.
    nearest: usize,
    /// The values of the basis at the place of this point, where the law has internal variables ([`Point::stressed`]).
    remembered: Option<Vec<f64>>,
}

impl Spot {
    /// The point at parent coordinates xi of a cell.
    pub fn new(scheme: &Scheme, cell: usize, xi: [f64; 2]) -> Self {
        let operators = &scheme.operators;
        let (block, lane) = operators.blocks.slot[cell];
        let (places, basis) = (operators.places(block, lane), &operators.line.basis);
        let nearest = history::nearest(places.iter().copied(), xi);
        let has_memory = scheme.laws[operators.blocks.material[block]].has_memory();
        let remembered = places.get(nearest).filter(|_| has_memory).map(|place| basis.values_2d(*place));
        Self { block, lane, weights: basis.values_2d(xi), nearest, remembered }
    }

    /// The law there.
    pub fn law<'a>(&self, scheme: &'a Scheme) -> &'a Law {
        &scheme.laws[scheme.operators.blocks.material[self.block]]
    }

    /// The unknowns there.
    pub fn of(&self, scheme: &Scheme, state: &State) -> Point {
        let n = self.weights.len();
        let start = self.block * state.components * n;
        let by = |weights: &[f64], k: usize| -> f64 {
            let nodes = &state.u[start + k * n..start + (k + 1) * n];
            nodes.iter().zip(weights).map(|(u, w)| u.0[self.lane] * w).sum()
        };
        let value = |k: usize| by(&self.weights, k);
        let (density, deformation) = (self.law(scheme).density(), [0, 1, 2, 3].map(value));
        let remembered = self.remembered.as_ref();
        Point {
            deformation,
            stressed: remembered.map_or(deformation, |weights| [0, 1, 2, 3].map(|k| by(weights, k))),
            velocity: [value(4) / density, value(5) / density],
            displacement: if state.has_displacement() { [UNKNOWNS, UNKNOWNS + 1].map(value) } else { [0.0; 2] },
            history: scheme.internal_at(state, self.block, self.lane, self.nearest),
        }
    }

    /// Appends the components of fields there.
    pub fn push(&self, fields: &[Field], scheme: &Scheme, state: &State, out: &mut Vec<f64>) {
        let point = self.of(scheme, state);
        fields.iter().for_each(|field| field.push(self.law(scheme), &point, out));
    }
}
