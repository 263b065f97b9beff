//! When something is done, for outputs and changes of grid: the keys `at`, `every`, `every_steps` and `exact_times`.

use super::When;
use super::reader::Reader;
use super::tables::{CHECKPOINT, EXACT_TIMES, WHEN};
use crate::error::Result;
use serde::Serialize;

/// Times that a run may have of one kind: more than the steps of any run that ends.
const MOST: f64 = 1e9;

/// What a table says of its times.
pub(super) struct Times {
    /// When; none: the table gives no times.
    pub when: Option<When>,
    /// Whether steps are shortened to meet them.
    pub exact: bool,
}

/// Reads the times of a table, in a run from `span[0]` to `span[1]`, s.
pub(super) fn read(table: &mut Reader, span: [f64; 2]) -> Result<Times> {
    let when = when(table, span)?;
    let exact = table.boolean(EXACT_TIMES.name)?;
    if exact.is_some() && !matches!(when, Some(When::At(_) | When::Every(_))) {
        let what = format!("`exact_times` shortens steps to meet times in s, and {} gives none", table.title());
        return Err(table.wrong(EXACT_TIMES.name, what, "give `at` or `every`, or remove `exact_times`"));
    }
    Ok(Times { when, exact: exact.unwrap_or(false) })
}

/// The keys at, every, every_steps: at most one.
fn when(table: &mut Reader, [start, end]: [f64; 2]) -> Result<Option<When>> {
    let values = table.values(WHEN)?;
    let given: Vec<&str> = WHEN.iter().map(|key| key.name).filter(|key| table.has(key)).collect();
    if let [first, second, ..] = given[..] {
        let what = format!("{} has both `{first}` and `{second}`", table.title());
        return Err(table.wrong(second, what, "keep one of at, every, every_steps"));
    }
    if let Some(early) = values.numbers("at").iter().position(|time| *time < start) {
        let what = format!("{} s lies before the start of the run, {start:e} s", values.numbers("at")[early]);
        return Err(table.wrong_entry("at", early, what, "give times from [time] start on"));
    }
    if let Some(every) = values.maybe("every").filter(|every| (end - start) / every > MOST) {
        let what = format!("`every` is {every:e} s, which is more than {MOST:e} times in a run of {:e} s", end - start);
        return Err(table.wrong("every", what, "give a longer time, or every_steps = 1 for each step"));
    }
    let at = values.has("at").then(|| {
        let mut times = values.numbers("at").to_vec();
        times.sort_by(f64::total_cmp);
        times.dedup();
        When::At(times)
    });
    let every_steps = values.maybe_integer("every_steps").map(When::EverySteps);
    Ok(at.or(values.maybe("every").map(When::Every)).or(every_steps))
}

/// When a run is kept so that it can be resumed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Checkpoint {
    /// Every so many minutes.
    Minutes(f64),
    /// Every so many steps.
    Steps(usize),
}

/// Minutes between two checkpoints, where the table does not say. A checkpoint of 1e6 DoF takes .2 s.
const MINUTES: f64 = 10.0;

/// Reads `[checkpoint]`.
pub(super) fn checkpoint(table: &mut Reader) -> Result<Checkpoint> {
    let values = table.values(CHECKPOINT)?;
    table.finish()?;
    match (values.maybe_integer("every_steps"), values.maybe("every_minutes")) {
        (Some(_), Some(_)) => Err(table.wrong(
            "every_minutes",
            "[checkpoint] has both `every_steps` and `every_minutes`",
            "keep one of them",
        )),
        (Some(steps), None) => Ok(Checkpoint::Steps(steps)),
        (None, minutes) => Ok(Checkpoint::Minutes(minutes.unwrap_or(MINUTES))),
    }
}
