//! The results of a study as CSV and as the tables of a document.

use super::case::Series;
use super::front::{answers, cost};
use super::measure::Measure;
use super::record::Record;
use super::trend::series_of;
use crate::lane::Kernel;
use crate::scene::Quantity;
use std::fmt::Write;

/// Columns of `study.csv`. Errors are of F, v (m/s), P (Pa) at the end of the run; times in s, memory in MiB; `predicted_*`
/// is what the coarser meshes of the series had let expect, by the measure of the study. An error below that of the reference is left
/// out; `error_below` is what the error by the measure is below then, and the norms are distances from the reference. Behind them stand `quantity_NAME` and
/// `quantity_NAME_error` for each quantity of the scene.
pub const COLUMNS: [&str; 29] = [
    "method",
    "degree",
    "time_degree",
    "layout",
    "compared",
    "refinement",
    "cells",
    "dofs",
    "steps",
    "dt_min",
    "dt_max",
    "cpu_seconds",
    "wall_seconds",
    "memory_mib",
    "peak_memory_mib",
    "error",
    "error_l1",
    "deformation_l1",
    "deformation_l2",
    "deformation_linf",
    "velocity_l1",
    "velocity_l2",
    "velocity_linf",
    "piola_l1",
    "piola_l2",
    "piola_linf",
    "predicted_error",
    "predicted_cpu_seconds",
    "error_below",
];

/// The machine, in one line.
pub fn machine(kernel: Kernel) -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or("processor of unknown name", |(_, name)| name.trim());
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = rayon::current_num_threads();
    let set = format!("{kernel:?}").to_lowercase();
    format!("dgmpm {}, {model}, {processors} processors, {set}, threads: {threads}", env!("CARGO_PKG_VERSION"))
}

/// `study.csv`: lines of `#` with problem, reference and machine, then a row a record; the last column says `done` or why
/// a case did not get to its end.
pub fn csv(records: &[Record], quantities: &[Quantity], head: &[String]) -> String {
    let mut text = String::new();
    head.iter().for_each(|line| text += &format!("# {}\n", line.replace('\n', " ")));
    let of_quantities = quantities.iter().map(|q| format!(",quantity_{0},quantity_{0}_error", q.name));
    text += &format!("{}{},status\n", COLUMNS.join(","), of_quantities.collect::<String>());
    for r in records {
        let Series { method, degree, time_degree, layout, sets } = &r.case.series;
        let mut row = vec![method.name().to_owned(), degree.to_string(), time_degree.to_string()];
        row.push(layout.clone().unwrap_or_default());
        row.push(text_cell(&sets.join(" ")));
        row.push(r.case.refinement.to_string());
        row.extend([r.cells, r.dofs, r.steps].map(|n| n.to_string()));
        let dt = if r.steps > 0 { r.dt.map(|dt| format!("{dt:e}")) } else { Default::default() };
        row.extend(dt);
        row.extend([r.cpu, r.wall, r.memory, r.peak].map(|x| format!("{x:.6}")));
        match &r.errors {
            Some(errors) => {
                let floor = r.floor.unwrap_or_default();
                let of = |error: f64, own: f64| if error < own { String::new() } else { format!("{error:e}") };
                row.extend([of(errors.standard, floor[0]), of(errors.standard_l1, floor[1])]);
                let norms = errors.fields().into_iter().flat_map(|(_, n)| [n.l1, n.l2, n.linf]);
                row.extend(norms.map(|norm| format!("{norm:e}")));
            }
            None => row.extend(std::iter::repeat_n(String::new(), 11)),
        }
        match &r.predicted {
            Some(p) => row.extend([number(Some(p.error)), format!("{:.6}", p.cpu)]),
            None => row.extend([String::new(), String::new()]),
        }
        row.push(number(r.below));
        for k in 0..quantities.len() {
            row.push(number(r.quantities.get(k).map(|quantity| quantity.value)));
            row.push(number(r.quantity_errors.get(k).copied().flatten()));
        }
        // The reason of a failure is free text.
        row.push(quoted(&r.status));
        text += &(row.join(",") + "\n");
    }
    text
}

/// Free text as a cell.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "'").replace('\n', " "))
}

/// Text that needs quotes only where a comma or a quote stands in it.
fn text_cell(text: &str) -> String {
    if text.contains([',', '"', '\n']) { quoted(text) } else { text.to_owned() }
}

/// A number of a row; nothing where there is none.
fn number(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or(String::new(), |value| format!("{value:e}"))
}

/// CPU seconds by series for the powers of ten that the study reaches, as a Markdown table; the cheapest of a column is
/// bold.
pub fn markdown(records: &[Record], measure: &Measure) -> String {
    let mut series = series_of(records);
    series.retain(|one| records.iter().any(|r| r.case.series == **one && r.bound().is_some()));
    let errors: Vec<f64> = answers(records).iter().map(|answer| answer.error).collect();
    let mut text = String::from("| CPU s for an error of |");
    errors.iter().for_each(|e| text += &format!(" {} |", measure.words(*e)));
    text += &format!("\n|---|{}\n", "---|".repeat(errors.len()));
    for one in &series {
        let _ = write!(text, "| {} |", one.name());
        for &error in &errors {
            let found = cost(records, one, error);
            let best = series.iter().filter_map(|s| cost(records, s, error)).fold(f64::INFINITY, f64::min);
            text += &match found {
                None => " |".to_owned(),
                Some(s) if s <= best => format!(" **{}** |", short(s)),
                Some(s) => format!(" {} |", short(s)),
            };
        }
        text.push('\n');
    }
    text
}

/// Seconds to two digits.
fn short(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{s:.3}"),
        s if s < 1.0 => format!("{s:.2}"),
        s if s < 10.0 => format!("{s:.1}"),
        s => format!("{s:.0}"),
    }
}
