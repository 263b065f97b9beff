//! Bytes that a step must move where nothing stays in a cache between its sweeps over the mesh.

use super::Subject;
use crate::operators::Operators;
use crate::step::Method;

/// Bytes of a cell in one step: each sweep (`begin` and `finish` of a stage) reads and writes its arrays once. Traces are
/// written once and read once: those of neighbours are near.
pub fn traffic(subject: &Subject) -> f64 {
    let problem = &subject.problem;
    let operators = &problem.scheme.operators;
    let unknowns = size_of_val(&problem.state.u[..]) as f64;
    let traces = problem.scheme.trace_bytes() as f64;
    let geometry = operators.geometry.bytes() as f64;
    let Operators { points, curl_free, .. } = operators;
    let points = points.as_ref().map_or(0, |points| points.bytes()) as f64;
    let curl_free = curl_free.as_ref().map_or(0, |curl_free| curl_free.bytes()) as f64;
    // begin: U in, rate and traces out. finish: rate in and out, traces in, and the neighbours' lists.
    let stage = 4.0 * unknowns + 2.0 * traces + 2.0 * geometry + operators.blocks.bytes() as f64;
    let stages = match &problem.scheme.method {
        Method::Ader { .. } => stage + points,
        Method::RungeKutta(tableau) => {
            let used = |row: &Vec<f64>| row.iter().filter(|a| **a != 0.0).count();
            let before: usize = tableau.a.iter().map(used).sum::<usize>() + used(&tableau.b);
            stage * tableau.stages() as f64 + before as f64 * unknowns
        }
    };
    // The update: U in, its new values out; the projection; matrices to the points for the survey.
    let step = stages + 2.0 * unknowns + curl_free + points;
    step / problem.body.mesh.cells.len() as f64
}
