//! L2 norms of the solution over the body by grid quadrature.

use crate::observe::{Field, Solution};
use crate::state::State;
use crate::step::Scheme;
use crate::sum::ExactSum;
use std::collections::BTreeMap;

const FIELDS: [Field; 4] = [Field::Velocity, Field::Deformation, Field::Piola, Field::CauchyStress];

/// sqrt(int f^2 dX) of each component of velocity, F, P and sigma; `material` gives the law of each cell. Of a law with memory
/// f is what the grid sees of it, sum_p chi_p f_p from the points' own F and history.
pub fn norms(scheme: &Scheme, state: &State, material: &[usize]) -> BTreeMap<String, f64> {
    let solution = Solution::of_state(scheme, state, material);
    let geometry = &scheme.operators.geometry;
    let names: Vec<String> = FIELDS.iter().flat_map(|field| field.components()).collect();
    let mut squares = vec![ExactSum::default(); names.len()];
    for (cell, &(block, lane)) in scheme.operators.blocks.slot.iter().enumerate() {
        let nodes = at_nodes(scheme, &solution, cell);
        let masses = geometry.masses(&scheme.operators.line, block, lane);
        for (values, mass) in nodes.iter().zip(masses) {
            squares.iter_mut().zip(values).for_each(|(sum, value)| sum.add(mass * value * value));
        }
    }
    names.into_iter().zip(squares.iter().map(|sum| sum.value().sqrt())).collect()
}

/// All components at the nodes of a cell.
fn at_nodes(scheme: &Scheme, solution: &Solution, cell: usize) -> Vec<Vec<f64>> {
    let (operators, law) = (&scheme.operators, solution.law(cell));
    let (block, lane) = operators.blocks.slot[cell];
    let at = |xi: &[f64; 2], weights: &[f64]| {
        let (point, mut values) = (solution.combine(cell, *xi, weights), vec![]);
        FIELDS.iter().for_each(|field| field.push(law, &point, &mut values));
        values
    };
    let nodes = operators.line.nodes();
    match &operators.points {
        Some(points) if law.has_memory() => {
            let places = operators.places(block, lane);
            let at_points: Vec<Vec<f64>> =
                places.iter().map(|xi| at(xi, &operators.line.basis.values_2d(*xi))).collect();
            let to_nodes = points.to_nodes(block, lane);
            let sum = |a: usize, k: usize| to_nodes.row(a).iter().zip(&at_points).map(|(chi, f)| chi * f[k]).sum();
            let count = at_points.first().map_or(0, Vec::len);
            (0..nodes.len()).map(|a| (0..count).map(|k| sum(a, k)).collect()).collect()
        }
        _ => {
            let unit = |a: usize| (0..nodes.len()).map(|b| if a == b { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
            nodes.iter().enumerate().map(|(a, xi)| at(xi, &unit(a))).collect()
        }
    }
}
