//! `[[quantity]]`: quantities of interest, and when they are taken.

use super::outputs::fit_for_a_file;
use super::reader::Reader;
use super::tables::{OVER, QUANTITY};
use super::{Material, Quantity};
use crate::error::Result;
use crate::registry::quantities::{Statistic, When};
use crate::registry::{QUANTITIES, Values, fields};

/// What a study measures besides quantities: no quantity can have these names.
pub const MEASURES: [&str; 2] = ["standard", "l1"];

/// Reads every `[[quantity]]` of a body of these materials, in a run from `span[0]` to `span[1]`.
pub(super) fn quantities(
    tables: Vec<Reader>,
    materials: &[Material],
    span: [f64; 2],
    degree: usize,
) -> Result<Vec<Quantity>> {
    let laws: Vec<_> = materials.iter().map(|material| (material.law.build())(&material.law.values)).collect();
    let mut all: Vec<Quantity> = Vec::with_capacity(tables.len());
    for mut table in tables {
        let quantity = quantity(&mut table, span, degree)?;
        fields::check_field(&quantity.what.values, &laws).map_err(|fault| table.fault(&fault))?;
        if all.iter().any(|other| other.name == quantity.name) {
            let what = format!("two [[quantity]] have the name \"{}\"", quantity.name);
            return Err(table.wrong("name", what, "give each a `name` of its own"));
        }
        all.push(quantity);
    }
    Ok(all)
}

fn quantity(table: &mut Reader, span: [f64; 2], degree: usize) -> Result<Quantity> {
    let (kind, others) = (&QUANTITY[1], [&QUANTITY[..1], &QUANTITY[2..]].concat());
    let entry = table.entry(kind, &QUANTITIES)?;
    table.of_kind(entry.name);
    let given = table.values(&others)?;
    let what = table.rest_of(entry, degree)?;
    let Some(name) = given.maybe_text("name") else {
        return Err(table.missing("name", "a name for results, such as \"final_length\""));
    };
    if !fit_for_a_file(name) {
        let remedy = "it becomes the name of a column: letters, digits, `_`, `-` and `.`, not a `.` first";
        return Err(table.wrong("name", format!("`name` is \"{name}\""), remedy));
    }
    if MEASURES.contains(&name) {
        let remedy =
            format!("`dgmpm study --measure` means something else by {}: give another name", MEASURES.join(", "));
        return Err(table.wrong("name", format!("`name` is \"{name}\""), remedy));
    }
    Ok(Quantity { name: name.to_owned(), what, when: when(table, &given, span)? })
}

/// The keys over, time, statistic.
fn when(table: &Reader, given: &Values, [start, end]: [f64; 2]) -> Result<When> {
    let over_run = given.maybe_text("over") == Some(OVER[1]);
    if let Some(time) = given.maybe("time") {
        if table.has("over") {
            let what = format!("{} has both `over` and `time`", table.title());
            return Err(table.wrong("time", what, "keep one of them"));
        }
        if !(start..=end).contains(&time) {
            let (side, other) = if time > end { ("after the end", end) } else { ("before the start", start) };
            let what = format!("`time` is {time:e} s, {side} of the run, {other:e} s");
            return Err(table.wrong("time", what, format!("give a time from {start:e} to {end:e} s")));
        }
    }
    match given.maybe_text("statistic") {
        Some(_) if !over_run => {
            let what = format!("{} is taken at one time, and `statistic` needs several", table.title());
            Err(table.wrong("statistic", what, "add over = \"run\", or remove `statistic`"))
        }
        named if over_run => Ok(When::Over(named.and_then(Statistic::named).unwrap_or(Statistic::Max))),
        _ => Ok(given.maybe("time").map_or(When::End, When::At)),
    }
}
