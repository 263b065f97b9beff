//! Cells cut, and cells of a grid of lines joined.

use super::lines::grid_of_lines;
use super::{Present, Rule, Values};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::regrid::TensorGrid;

/// How many times the cells of the start a mesh may have by `refine`: five halvings of their size. A rule that fires over and
/// over would fill any memory.
const MOST: usize = 1024;

/// Each cell of the present mesh cut into k x k.
pub(super) fn finer(of: &Values, rule: &dyn Rule, present: &Present) -> Result<Mesh> {
    let (k, mesh) = (of.integer("refine"), present.view.mesh);
    let cells = mesh.cells.len().saturating_mul(k * k);
    if cells / MOST > present.start {
        let what = format!(
            "{cells} cells would be more than {MOST} times the {} of the start; `refine` cuts the cells that are there each \
             time that it is due",
            present.start
        );
        return Err(rule.wrong(
            "refine",
            what,
            "let it be due less often (`at`), join cells by `coarsen` between, or start finer",
        ));
    }
    rule.has_room("refine", cells)?;
    Ok(mesh.refined(k))
}

/// k x k cells of a mesh joined into one.
pub(super) fn coarser(of: &Values, rule: &dyn Rule, mesh: &Mesh) -> Result<Mesh> {
    joined(mesh, of.integer("coarsen")).map_err(|what| {
        rule.wrong("coarsen", what, "coarsen grids of lines whose numbers of cells are multiples of it")
    })
}

/// k x k cells of a grid of lines joined into one.
fn joined(mesh: &Mesh, k: usize) -> std::result::Result<Mesh, String> {
    let lines = TensorGrid::of(mesh).filter(|_| mesh.groups.len() == 1);
    let lines = lines.ok_or("the present mesh is not a grid of lines of one group")?.lines;
    let thin = |lines: &[f64]| -> std::result::Result<Vec<f64>, String> {
        let cells = lines.len() - 1;
        if !cells.is_multiple_of(k) {
            return Err(format!("{cells} cells cannot be joined by {k}"));
        }
        Ok(lines.iter().step_by(k).copied().collect())
    };
    let [x, y] = &lines;
    grid_of_lines(mesh, [thin(x)?, thin(y)?])
}
