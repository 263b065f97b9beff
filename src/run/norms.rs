//! L2 norms of the solution over the body by grid quadrature.

use crate::observe::{Field, Solution};
use crate::state::State;
use crate::step::Scheme;
use std::collections::BTreeMap;

const FIELDS: [Field; 4] = [Field::Velocity, Field::Deformation, Field::Piola, Field::CauchyStress];

/// sqrt(int f^2 dX) of each component of velocity, F, P and sigma; `material` gives the law of each cell.
pub fn norms(scheme: &Scheme, state: &State, material: &[usize]) -> BTreeMap<String, f64> {
    let solution = Solution::of_state(scheme, state, material);
    let (n, geometry) = (scheme.operators.nodes(), &scheme.operators.geometry);
    let names: Vec<String> = FIELDS.iter().flat_map(|field| field.components()).collect();
    let mut squares = vec![0.0; names.len()];
    let weights: Vec<Vec<f64>> = (0..n).map(|a| (0..n).map(|b| if a == b { 1.0 } else { 0.0 }).collect()).collect();
    let mut values = Vec::with_capacity(names.len());
    for (cell, &(block, lane)) in scheme.operators.blocks.slot.iter().enumerate() {
        let masses = geometry.masses(&scheme.operators.line, block, lane);
        for ((a, weights), mass) in weights.iter().enumerate().zip(masses) {
            let point = solution.combine(cell, scheme.operators.line.basis.node_2d(a), weights);
            values.clear();
            FIELDS.iter().for_each(|field| field.push(solution.law(cell), &point, &mut values));
            squares.iter_mut().zip(&values).for_each(|(sum, value)| *sum += mass * value * value);
        }
    }
    names.into_iter().zip(squares.into_iter().map(f64::sqrt)).collect()
}
