//! What cells can carry, in words: classes, the worst cells, those with virtual points, the refusal of `--strict`, and
//! where laws with memory sample.

use super::{Body, Problem};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::operators::carry::{Cause, Deficient, stand_on_nodes};
use crate::operators::{Certificate, Class, Limits, Line};
use crate::scene::{Histories, Scene};

/// Cells that a list names before it only counts.
const NAMED: usize = 3;

/// Rows of the table: classes, and the worst cells where cells differ.
pub fn rows(mesh: &Mesh, certificates: &[Certificate]) -> Vec<(String, String)> {
    let row = |name: &str, value: String| (name.to_owned(), value);
    let count = |class: Class| certificates.iter().filter(|c| c.class == class).count();
    let classes = Class::NAMES.iter().map(|&(name, class)| (count(class), name)).filter(|(count, _)| *count > 0);
    let classes: Vec<String> = classes.map(|(count, name)| format!("{count} {name}")).collect();
    let mut rows = vec![row("classes of cells", classes.join(", "))];
    let mut worst = |name: &str, figure: &dyn Fn(&Certificate) -> f64, show: &dyn Fn(f64) -> String| {
        let mut order: Vec<(f64, usize)> = certificates.iter().map(figure).zip(0..).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        // Where all are alike none is worst; 1e-9 is rounding of the same shape at another place.
        if let [first, .., last] = order[..]
            && (first.0 - last.0).abs() > 1e-9 * first.0.abs()
        {
            let cells = order.iter().take(NAMED).map(|&(f, cell)| format!("{} in cell {}", show(f), mesh.number(cell)));
            rows.push(row(name, cells.collect::<Vec<_>>().join(", ")));
        }
    };
    worst("worst face Lebesgue constants", &|c| c.lebesgue, &|f| format!("{f:.2}"));
    worst("worst conditions", &|c| c.condition, &|f| format!("{f:.1}"));
    worst("smallest dt limits", &|c| -c.dt, &|f| format!("{:.3e} s", -f));
    rows
}

/// The word on cells of laws with memory that sample on their Gauss nodes and not at their points; none where there are none.
pub fn memory(body: &Body) -> Option<String> {
    let (count, cells) = (body.deficient.iter().filter(|d| d.cause == Cause::Memory).count(), body.mesh.cells.len());
    let say = || {
        format!(
            "{count} of {cells} cells sample on their Gauss nodes, and have their internal variables there: {}; their \
             material points are carried along",
            why(Cause::Memory, &Limits::of_degree(0))
        )
    };
    (count > 0).then(say)
}

/// The warning on internal variables that the scene keeps at points away from the Gauss nodes; none where none are.
pub fn warning(problem: &Problem) -> Option<String> {
    let Problem { scene, body, .. } = problem;
    let at_points = |cell: &usize| scene.materials[body.material[*cell]].histories == Some(Histories::Points);
    if !scene.scheme.method.has_points() {
        return None;
    }
    let nodes = Line::new(scene.scheme.degree).nodes();
    let away = (0..body.mesh.cells.len()).filter(at_points).filter(|&c| !stand_on_nodes(&nodes, body.cloud.of(c)));
    let largest = away.map(|cell| body.certificates[cell].lebesgue).reduce(f64::max)?;
    Some(format!(
        "histories = \"points\": this layout makes energy where the law flows (face Lebesgue constant {largest:.2}; Taylor bars \
         gained 4 to 80 % and more); with histories = \"nodes\" or layout = \"gauss\" they gain none"
    ))
}

/// The word on cells that cannot carry the degree and have virtual points; none where there are none.
pub fn notice(scene: &Scene, body: &Body) -> Option<String> {
    let all: Vec<&Deficient> = body.deficient.iter().filter(|d| d.cause != Cause::Memory).collect();
    let cells = body.mesh.cells.len();
    if all.is_empty() {
        return None;
    }
    let count = |cause: Cause| all.iter().filter(|d| d.cause == cause).count();
    let causes = [Cause::Few, Cause::Rank, Cause::Lebesgue, Cause::Condition];
    let causes = causes.into_iter().map(|cause| (count(cause), cause)).filter(|(count, _)| *count > 0);
    let causes: Vec<String> =
        causes.map(|(count, cause)| format!("{count} {}", why(cause, &scene.limits_of_cells()))).collect();
    let mut worst = all.clone();
    worst.sort_by(|a, b| {
        (a.given.rank, b.given.lebesgue).partial_cmp(&(b.given.rank, a.given.lebesgue)).unwrap_or(a.cell.cmp(&b.cell))
    });
    let worst: Vec<String> = worst.iter().take(NAMED).map(|d| figures(&body.mesh, d.cell, &d.given)).collect();
    Some(format!(
        "{} of {cells} cells cannot carry degree {} and have virtual points on their Gauss nodes: {}; worst: {}",
        all.len(),
        scene.scheme.degree,
        causes.join(", "),
        worst.join(", ")
    ))
}

fn why(cause: Cause, limits: &Limits) -> String {
    match cause {
        Cause::Few => "with too few points".to_owned(),
        Cause::Rank => "with points in bad places".to_owned(),
        Cause::Lebesgue => format!("beyond a Lebesgue constant of {}", limits.lebesgue),
        Cause::Condition => format!("beyond a condition of {:e}", limits.condition),
        Cause::Memory => {
            "their law has memory (internal variables) and their points are not on the Gauss nodes".to_owned()
        }
    }
}

fn figures(mesh: &Mesh, cell: usize, c: &Certificate) -> String {
    let (number, points) = (mesh.number(cell), if c.points == 1 { "point" } else { "points" });
    match c.condition.is_finite() {
        true => format!(
            "cell {number} ({} {points}, face Lebesgue constant {:.1}, at nodes {:.1}, condition {:.2e})",
            c.points, c.lebesgue, c.inside, c.condition
        ),
        false => format!("cell {number} ({} {points}, rank {})", c.points, c.rank),
    }
}

/// Refuses cells beyond the limits, lattices too.
///
/// # Errors
/// The cells with their figures, and the remedy.
pub fn strict(scene: &Scene, body: &Body) -> Result<()> {
    if !scene.scheme.method.has_points() {
        return Ok(());
    }
    let m = scene.scheme.degree + 1;
    let limits = Limits { lattices: true, ..scene.limits_of_cells() };
    let kept = body.certificates.iter().copied().enumerate();
    let lattices = kept.filter(|(_, c)| c.class != Class::Deficient && limits.cause(c, m * m).is_some());
    // Where the law has memory nothing is asked of the points.
    let replaced = body.deficient.iter().filter(|d| d.cause != Cause::Memory).map(|d| (d.cell, d.given));
    let mut bad: Vec<(usize, Certificate)> = replaced.chain(lattices).collect();
    bad.sort_by_key(|(cell, _)| *cell);
    if bad.is_empty() {
        return Ok(());
    }
    let mut cells: Vec<String> = bad.iter().take(10).map(|(cell, c)| figures(&body.mesh, *cell, c)).collect();
    if bad.len() > cells.len() {
        cells.push(format!("and {} more", bad.len() - cells.len()));
    }
    let Limits { lebesgue, condition, .. } = limits;
    Err(Error::input(
        format!(
            "{} of {} cells are beyond the limits (rank {}, Lebesgue constants {lebesgue}, condition {condition:e}): {}",
            bad.len(),
            body.mesh.cells.len(),
            m * m,
            cells.join(", ")
        ),
        format!(
            "put at least {m} x {m} points in general position into each cell (layout = \"midpoints\", a larger \
             per_direction), raise [cloud] face_lebesgue or condition, or leave out --strict: cells whose points carry too \
             little then have virtual ones"
        ),
    ))
}
