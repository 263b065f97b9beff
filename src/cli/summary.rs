//! `summary.json` and the table at the end of a run.

use super::pipeline::Body;
use super::print::{mebibytes, row, seconds, table};
use crate::error::Result;
use crate::run::{Folder, Report, norms};
use crate::scene::Scene;
use crate::state::State;
use crate::step::{Scheme, phase::NAMES};
use serde_json::{Value, json};

/// Writes `summary.json`. `status`: done, unstable, interrupted or failed.
pub fn write(
    scene: &Scene,
    body: &Body,
    scheme: &Scheme,
    state: &State,
    report: &Report,
    folder: &Folder,
    status: &str,
) -> Result<()> {
    let mut all = report.json(scheme, state);
    all.insert("title".to_owned(), json!(scene.title));
    all.insert("method".to_owned(), json!(scene.scheme.method.name()));
    all.insert("degree".to_owned(), json!(scene.scheme.degree));
    all.insert("time_degree".to_owned(), json!(scene.scheme.time_degree));
    all.insert("points".to_owned(), json!(body.cloud.len()));
    all.insert("norms".to_owned(), json!(norms(scheme, state, &body.material)));
    all.insert("kernel".to_owned(), json!(format!("{:?}", scheme.kernel).to_lowercase()));
    all.insert("status".to_owned(), json!(status));
    let text = format!("{:#}\n", Value::Object(all));
    crate::io::pending::write_text(&folder.summary(), &text)
}

/// Prints steps, dt, seconds per phase, DoF-updates per second, memory, energy and momentum.
pub fn print(scheme: &Scheme, report: &Report) {
    let mut rows = vec![
        row("steps", report.steps.to_string()),
        row(
            "dt",
            if report.steps > 0 { format!("{:.4e} .. {:.4e} s", report.dt[0], report.dt[1]) } else { "-".into() },
        ),
        row("wall, CPU", format!("{}, {}", seconds(report.wall), seconds(report.cpu))),
    ];
    let all: f64 = report.phases.seconds.iter().sum();
    for (name, s) in NAMES.iter().zip(report.phases.seconds).filter(|(_, s)| *s > 0.0) {
        rows.push(row(format!("  {name}"), format!("{s:8.3} s {:5.1} %", 100.0 * s / all)));
    }
    rows.push(row("DoF-updates/s (CPU)", format!("{:.3e}", report.rate())));
    rows.push(row("memory", mebibytes(report.bytes)));
    if let (Some(first), Some(last)) = (&report.first, &report.last) {
        rows.push(row("kinetic energy", format!("{:.6e} -> {:.6e} J/m", first.kinetic, last.kinetic)));
        rows.push(row("strain energy", format!("{:.6e} -> {:.6e} J/m", first.strain, last.strain)));
        rows.push(row("total energy", format!("{:.6} of the start", report.energy_ratio())));
        for (k, axis) in ["1", "2"].iter().enumerate() {
            let change = format!("{:.6e} -> {:.6e} kg/s", first.momentum[k], last.momentum[k]);
            rows.push(row(format!("momentum {axis}"), change));
        }
        rows.push(row("min J, max |curl F|", format!("{:.6}, {:.3e} 1/m", report.min_j, last.max_curl)));
    }
    rows.push(row("instruction set", format!("{:?}", scheme.kernel)));
    table(&rows);
}
