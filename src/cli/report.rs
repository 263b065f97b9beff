//! What a problem is made of and what its run will cost, as a table with notices.

use super::print::{note, say, table, warn};
use crate::error::Result;
use crate::operators::Certificate;
use crate::problem::{Problem, certificates, notices};

/// Prints classes, memory, the smallest step and the worst cells, and the cost; answers the certificates of the cells.
pub fn report(problem: &Problem) -> Result<Vec<Certificate>> {
    let cost = problem.cost().map_err(|loss| problem.lost_at_start(&loss))?;
    table(&cost.rows(problem));
    certificates::notice(&problem.scene, &problem.body).iter().for_each(say);
    notices::of_run(problem, &cost).iter().for_each(note);
    certificates::memory(&problem.body).iter().for_each(say);
    certificates::warning(problem).iter().for_each(warn);
    notices::of_growth(problem, &cost).iter().for_each(note);
    Ok(cost.certificates)
}
