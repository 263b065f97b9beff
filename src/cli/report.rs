//! What a problem is made of and what its run will cost, as a table with notices.

use super::print::{mebibytes, note, row, say, seconds, table, warn};
use crate::error::Result;
use crate::operators::{Certificate, Pool};
use crate::problem::{Cost, Problem, certificates, notices};
use crate::step::cfl;

/// Prints classes, memory, the smallest step and the worst cells, and the cost; answers the certificates of the cells.
pub fn report(problem: &Problem) -> Result<Vec<Certificate>> {
    let cost = problem.cost().map_err(|loss| problem.lost_at_start(&loss))?;
    let Problem { scene, body, scheme, .. } = problem;
    table(&rows(problem, &cost));
    certificates::word(scene, body).into_iter().for_each(say);
    notices::of_run(problem, &cost).iter().for_each(note);
    certificates::memory(body).into_iter().for_each(say);
    certificates::warning(problem).iter().for_each(warn);
    if let Some(growth) = cfl::growth(&scheme.method, scene.scheme.degree) {
        note(format!(
            "ADER of degree {} grows weakly at any dt: {growth:.0e} a step, a factor of {:.3} over this run",
            scene.scheme.degree,
            (growth * cost.steps).exp()
        ));
    }
    Ok(cost.certificates)
}

fn rows(problem: &Problem, cost: &Cost) -> Vec<(String, String)> {
    let Problem { scene, body, scheme, .. } = problem;
    let (operators, mesh) = (&scheme.operators, &body.mesh);
    let name = format!("{} S{}T{}", scene.scheme.method.name(), scene.scheme.degree, scene.scheme.time_degree);
    let dofs = crate::run::dofs(scheme);
    let mut rows = vec![
        row("method", name),
        row("cells, points, dofs", format!("{}, {}, {dofs}", mesh.cells.len(), body.cloud.len())),
    ];
    if let Some(points) = &operators.points {
        rows.push(row("point matrices", classes(&points.pool)));
    }
    if let Some(curl_free) = &operators.curl_free {
        rows.push(row("curl-free projections", classes(&curl_free.pool)));
    }
    rows.push(row("memory", mebibytes(cost.bytes)));
    let smallest = extreme(&cost.certificates, |c| -c.h).1;
    rows.push(row("first dt", format!("{:.4e} s, set by cell {}", cost.dt, mesh.number(smallest))));
    let (lebesgue, cell) = extreme(&cost.certificates, |c| c.lebesgue);
    rows.push(row("largest face Lebesgue constant", format!("{lebesgue:.2} in cell {}", mesh.number(cell))));
    rows.extend(certificates::rows(mesh, &cost.certificates));
    rows.push(row("estimate", format!("{:.0} steps, {}", cost.steps, seconds(cost.seconds))));
    rows
}

/// The largest value of a figure, and its cell.
fn extreme(certificates: &[Certificate], figure: impl Fn(&Certificate) -> f64) -> (f64, usize) {
    let values = certificates.iter().map(figure).enumerate();
    let best = |best: (usize, f64), next: (usize, f64)| if next.1 > best.1 { next } else { best };
    let (cell, value) = values.fold((0, f64::NEG_INFINITY), best);
    (value, cell)
}

fn classes<S, O>(pool: &Pool<S, O>) -> String {
    format!("{} shared by congruent cells, {} blocks with their own", pool.shared.len(), pool.own.len())
}
