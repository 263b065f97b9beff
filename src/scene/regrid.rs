//! `[[regrid]]`: when a run gets another grid, and which.

use super::outputs::when;
use super::reader::{Check, FINITE, POSITIVE, Reader};
use super::{Expression, When};
use crate::error::Result;
pub use crate::regrid::points::Policy as Points;
use serde::Serialize;
use std::path::PathBuf;

/// A rule by which a run gets another grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Regrid {
    /// When.
    pub when: When,
    /// Whether steps are shortened to meet the times.
    pub exact_times: bool,
    /// At those times only if one of these is met; none: always.
    pub criteria: Criteria,
    /// The new grid.
    pub grid: NewMesh,
    /// What becomes of the points.
    pub points: Points,
}

/// What makes a grid due. None given: it always is.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Criteria {
    /// The largest face Lebesgue constant of a cell's points is above this.
    pub certificate: Option<f64>,
    /// The scaled Jacobian of a cell in the current configuration is below this; 1 is a parallelogram with right angles.
    pub distortion: Option<f64>,
    /// Velocity varies within a cell by more than this share of its range over the body.
    pub front: Option<f64>,
}

/// Where the new mesh comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NewMesh {
    /// Mesh files in turn, as written in the scene.
    Files(Vec<PathBuf>),
    /// Rectangles of equal cells in turn.
    Rectangles(Vec<([f64; 2], [usize; 2])>),
    /// Each cell of the present mesh into k x k.
    Refine(usize),
    /// k x k cells of the present mesh, a grid of lines, into one.
    Coarsen(usize),
    /// Inner nodes of the present mesh moved, m.
    Shift([f64; 2]),
    /// The mesh of the scene with finer strips.
    Strips(Vec<Strip>),
    /// Gmsh run on a geometry.
    Geometry {
        /// The `.geo` file, as written in the scene.
        path: PathBuf,
        /// Size of the cells over x, y, t, m; none: as the geometry says.
        size: Option<Expression>,
    },
}

/// A part of the scene's mesh (a grid of lines) that is finer along an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Strip {
    /// 0: lines of x, 1: lines of y.
    pub axis: usize,
    /// Where it is.
    pub around: Around,
    /// How far it reaches below and above, m.
    pub reach: [f64; 2],
    /// Into how many each interval is cut.
    pub factor: usize,
}

/// Where a strip is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Around {
    /// From the first to the last cell with a steep front, see [`Criteria::front`].
    Front {
        /// The share of the range of velocity.
        share: f64,
    },
    /// At a position that depends on t, m.
    Position(Expression),
}

/// The share of the range of velocity that makes a front, where none is given: at a shock, which takes one to three cells,
/// it is .3 to .6; in the fan from a free corner .05 to .1 on 30 cells.
const FRONT: f64 = 0.2;
/// Steps between two looks at the criteria, where no times are given.
const LOOK: usize = 10;

const SHARE: Check = Check { range: "between 0 and 1", holds: |x| x > 0.0 && x < 1.0 };
const LENGTH: Check = Check { range: "not negative (m)", holds: |x| x >= 0.0 };
const CELLS: Check =
    Check { range: "whole, from 1 to 100000", holds: |n| n.fract() == 0.0 && (1.0..=100_000.0).contains(&n) };

/// Reads every `[[regrid]]`.
pub(super) fn regrids(tables: Vec<Reader>) -> Result<Vec<Regrid>> {
    tables.into_iter().map(|mut table| regrid(&mut table)).collect()
}

fn regrid(table: &mut Reader) -> Result<Regrid> {
    let times = when(table)?;
    let exact_times = match times {
        Some(When::At(_) | When::Every(_)) => table.boolean("exact_times")?.unwrap_or(false),
        _ => false,
    };
    let criteria = match table.table("when")? {
        Some(mut criteria) => Some(self::criteria(&mut criteria)?),
        None => None,
    };
    let points = table.choice("points", Points::NAMES, &[])?.unwrap_or(Points::Keep);
    let grid = grid(table)?;
    table.finish()?;
    let when = match (times, criteria) {
        (Some(times), _) => times,
        (None, Some(_)) => When::EverySteps(LOOK),
        (None, None) => {
            return Err(table.missing("at", "a list of times, in s; or every (s), every_steps, or when = { .. }"));
        }
    };
    Ok(Regrid { when, exact_times, criteria: criteria.unwrap_or_default(), grid, points })
}

fn criteria(table: &mut Reader) -> Result<Criteria> {
    let criteria = Criteria {
        certificate: table.number("certificate", POSITIVE)?,
        distortion: table.number("distortion", SHARE)?,
        front: table.number("front", SHARE)?,
    };
    table.finish()?;
    if criteria == Criteria::default() {
        return Err(table.missing("certificate", "or distortion, or front: at least one"));
    }
    Ok(criteria)
}

/// The keys that name a grid: one of them.
const GRIDS: [&str; 8] = ["mesh", "rectangle", "rectangles", "refine", "coarsen", "shift", "strips", "geo"];

fn grid(table: &mut Reader) -> Result<NewMesh> {
    let given: Vec<&str> = GRIDS.into_iter().filter(|key| table.has(key)).collect();
    if let [_, second, ..] = given[..] {
        let what = format!("a [[regrid]] has {}", given.join(" and "));
        return Err(table.wrong(second, what, "keep one: it says what the new grid is"));
    }
    let mut out = None;
    if let Some(files) = table.texts_or_text("mesh")? {
        out = Some(NewMesh::Files(files.into_iter().map(PathBuf::from).collect()));
    }
    if let Some(mut one) = table.table("rectangle")? {
        out = Some(NewMesh::Rectangles(vec![rectangle(&mut one)?]));
    }
    let several = table.tables("rectangles")?;
    if !several.is_empty() {
        let all = several.into_iter().map(|mut one| rectangle(&mut one)).collect::<Result<_>>()?;
        out = Some(NewMesh::Rectangles(all));
    }
    out = out.or(table.integer("refine", 2..=64)?.map(NewMesh::Refine));
    out = out.or(table.integer("coarsen", 2..=64)?.map(NewMesh::Coarsen));
    out = out.or(table.array("shift", FINITE)?.map(NewMesh::Shift));
    let strips = table.tables("strips")?;
    if !strips.is_empty() {
        out = Some(NewMesh::Strips(strips.into_iter().map(|mut one| strip(&mut one)).collect::<Result<_>>()?));
    }
    if let Some(path) = table.text("geo")? {
        out = Some(NewMesh::Geometry { path: PathBuf::from(path), size: table.expression("size")? });
    }
    out.ok_or_else(|| table.missing("mesh", &format!("or another of {}", GRIDS[1..].join(", "))))
}

fn rectangle(table: &mut Reader) -> Result<([f64; 2], [usize; 2])> {
    let size = table.array("size", POSITIVE)?;
    let cells = table.array("cells", CELLS)?;
    table.finish()?;
    let size = size.ok_or_else(|| table.missing("size", "for instance size = [3.0, 3.0], in m"))?;
    let cells = cells.ok_or_else(|| table.missing("cells", "for instance cells = [30, 30]"))?;
    Ok((size, cells.map(|n: f64| n as usize)))
}

fn strip(table: &mut Reader) -> Result<Strip> {
    let axis = table.choice("axis", &[("x", 0), ("y", 1)], &[])?;
    let is_front = table.is_text("around", "front");
    let around = if is_front {
        table.text("around")?;
        Some(Around::Front { share: table.number("share", SHARE)?.unwrap_or(FRONT) })
    } else {
        table.expression("around")?.map(Around::Position)
    };
    let (behind, ahead) = (table.number("behind", LENGTH)?, table.number("ahead", LENGTH)?);
    let factor = table.integer("factor", 2..=64)?.unwrap_or(2);
    table.finish()?;
    let axis = axis.ok_or_else(|| table.missing("axis", "\"x\" or \"y\""))?;
    let around = around.ok_or_else(|| table.missing("around", "\"front\", or an expression of t, in m"))?;
    let behind = behind.ok_or_else(|| table.missing("behind", "how far it reaches below, in m"))?;
    let ahead = ahead.ok_or_else(|| table.missing("ahead", "how far it reaches above, in m"))?;
    Ok(Strip { axis, around, reach: [behind, ahead], factor })
}
