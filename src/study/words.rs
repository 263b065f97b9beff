//! What a study says on the terminal.

use super::measure::Measure;
use super::record::Record;
use crate::format::{count, short_seconds};

/// The head of the rows of [`line`].
pub fn title() -> String {
    format!(
        "  {:<28} {:>7} {:>8} {:>7} {:>10} {:>8} {:>10}   {}",
        "setting", "cells", "dofs", "steps", "CPU s", "MiB", "error", "predicted CPU s, error"
    )
}

/// A record as a row.
pub fn line(r: &Record) -> String {
    let name = format!("{} x{:.4}", r.case.series.name(), r.case.refinement);
    if !r.is_done() {
        return format!("  {name:<28} {}", r.status);
    }
    let of = |error: f64| if error.is_finite() { format!("{error:.2e}") } else { "-".to_owned() };
    let error = r.error_words();
    let predicted = r.predicted.map_or(String::new(), |p| format!("{:.3}, {}", p.cpu, of(p.error)));
    format!(
        "  {name:<28} {:>7} {:>8} {:>7} {:>10.3} {:>8.1} {error:>10}   {predicted}",
        r.cells, r.dofs, r.steps, r.cpu, r.memory
    )
}

/// `for an error of 1 % use rk-dgfem S3 on 60 cells: 180.2 ms (error 6.31e-3)`.
pub fn answer(measure: &Measure, error: f64, record: &Record) -> String {
    let (name, cells) = (record.case.series.name(), count(record.cells, "cell"));
    let (error, found) = (measure.words(error), record.error_words());
    format!("  for an error of {error:<8} use {name} on {cells}: {} (error {found})", short_seconds(record.cpu))
}
