//! `[[regrid]]`: when a run gets another grid, and which.

use super::When;
use super::reader::Reader;
use super::tables::{CRITERIA, REGRID};
use super::times::{self, Times};
use crate::error::Result;
use crate::registry::grids::Grid;
use crate::registry::{Chosen, GRIDS, Policy, Values};
use serde::Serialize;

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
    pub grid: Chosen<Grid>,
    /// What becomes of the points.
    pub points: Policy,
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

impl Criteria {
    /// Whether none is given.
    pub fn are_none(&self) -> bool {
        *self == Self::default()
    }

    fn of(values: &Values) -> Self {
        let [certificate, distortion, front] = ["certificate", "distortion", "front"].map(|name| values.maybe(name));
        Self { certificate, distortion, front }
    }
}

/// Steps between two looks at the criteria, where no times are given.
const LOOK: usize = 10;

/// Reads every `[[regrid]]`, in a run from `span[0]` to `span[1]`.
pub(super) fn regrids(tables: Vec<Reader>, span: [f64; 2], degree: usize) -> Result<Vec<Regrid>> {
    tables.into_iter().map(|mut table| regrid(&mut table, span, degree)).collect()
}

fn regrid(table: &mut Reader, span: [f64; 2], degree: usize) -> Result<Regrid> {
    let Times { when: times, exact: exact_times } = times::read(table, span)?;
    let [when, points] = REGRID.each_ref().map(std::slice::from_ref);
    let criteria = match table.table(when[0].name)? {
        Some(mut table) => Some(criteria(&mut table)?),
        None => None,
    };
    let values = table.values(points)?;
    let policy = Policy::NAMES.iter().find(|(name, _)| *name == values.text("points")).map(|(_, policy)| *policy);
    let grid = grid(table, degree)?;
    let when = match (times, criteria) {
        (Some(times), _) => times,
        (None, Some(_)) => When::EverySteps(LOOK),
        (None, None) => {
            return Err(table.missing("at", "a list of times, in s; or every (s), every_steps, or when = { .. }"));
        }
    };
    let (criteria, points) = (criteria.unwrap_or_default(), policy.unwrap_or(Policy::Keep));
    Ok(Regrid { when, exact_times, criteria, grid, points })
}

fn criteria(table: &mut Reader) -> Result<Criteria> {
    let criteria = Criteria::of(&table.all(CRITERIA)?);
    match criteria.are_none() {
        true => Err(table.missing("certificate", "or distortion, or front: at least one")),
        false => Ok(criteria),
    }
}

/// One of the keys that name a grid, and what belongs to it.
fn grid(table: &mut Reader, degree: usize) -> Result<Chosen<Grid>> {
    let given: Vec<_> = GRIDS.iter().filter(|entry| table.has(entry.name)).collect();
    if let [_, second, ..] = given[..] {
        let names: Vec<&str> = given.iter().map(|entry| entry.name).collect();
        let what = format!("a [[regrid]] has {}", names.join(" and "));
        return Err(table.wrong(second.name, what, "keep one: it says what the new grid is"));
    }
    match given.first() {
        Some(entry) => table.rest_of(entry, degree),
        None => {
            GRIDS.iter().for_each(|entry| table.know(entry.name));
            table.finish()?;
            let others: Vec<&str> = GRIDS.iter().skip(1).map(|entry| entry.name).collect();
            Err(table.missing(GRIDS.first().name, &format!("or another of {}", others.join(", "))))
        }
    }
}
