//! What a problem is made of and what its run will cost, as rows of a table.

use super::{Cost, Problem, certificates};
use crate::format::{Row, count, mebibytes, row, seconds};
use crate::operators::{Certificate, Pool};

impl Cost {
    /// Method, sizes, classes of matrices, memory, the smallest step, the worst cells and the estimate.
    pub fn rows(&self, problem: &Problem) -> Vec<Row> {
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
            rows.push(row("matrices of the curl control", classes(&curl_free.pool)));
        }
        rows.push(row("memory", mebibytes(self.bytes)));
        let smallest = extreme(&self.certificates, |c| -c.h).1;
        rows.push(row("first dt", format!("{:.4e} s, set by cell {}", self.dt, mesh.number(smallest))));
        let (lebesgue, cell) = extreme(&self.certificates, |c| c.lebesgue);
        rows.push(row("largest face Lebesgue constant", format!("{lebesgue:.2} in cell {}", mesh.number(cell))));
        rows.extend(certificates::rows(mesh, &self.certificates));
        rows.push(row("estimate", format!("{}, {}", count(self.steps as usize, "step"), seconds(self.seconds))));
        rows
    }
}

/// The largest value of a figure, and its cell.
fn extreme(certificates: &[Certificate], figure: impl Fn(&Certificate) -> f64) -> (f64, usize) {
    let values = certificates.iter().map(figure).enumerate();
    let best = |best: (usize, f64), next: (usize, f64)| if next.1 > best.1 { next } else { best };
    let (cell, value) = values.fold((0, f64::NEG_INFINITY), best);
    (value, cell)
}

fn classes<S, O>(pool: &Pool<S, O>) -> String {
    format!("{} shared by congruent cells, {} with their own", pool.shared.len(), count(pool.own.len(), "block"))
}
