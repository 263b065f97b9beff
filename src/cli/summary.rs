//! The table at the end of a run.

use super::print::{mebibytes, row, seconds, table};
use crate::problem::Outcome;
use crate::run::Report;
use crate::step::{Balance, phase::NAMES};

/// Prints steps, dt, seconds per phase, DoF-updates per second, memory, energy, momentum and errors.
pub fn print(outcome: &Outcome) {
    let mut rows = rows(outcome.report);
    if let Some(errors) = &outcome.errors {
        for (name, norms) in errors.fields() {
            let text = format!("L1 {:.4e}, L2 {:.4e}, Linf {:.4e}", norms.l1, norms.l2, norms.linf);
            rows.push(row(format!("error of {name}"), text));
        }
        rows.push(row("standard error", format!("{:.4e}", errors.standard)));
    }
    rows.push(row("instruction set", format!("{:?}", outcome.problem.scheme.kernel)));
    table(&rows);
}

/// What a run cost, and what became of energy and momentum.
fn rows(report: &Report) -> Vec<(String, String)> {
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
        rows.push(row("total energy", format!("{:.6} of start and work", report.energy_ratio())));
        if let Some((first, last)) = first.dissipated.zip(last.dissipated) {
            rows.push(row("dissipated by laws", format!("{first:.6e} -> {last:.6e} J/m")));
        }
        for (k, axis) in ["1", "2"].iter().enumerate() {
            let change = format!("{:.6e} -> {:.6e} kg/s", first.momentum[k], last.momentum[k]);
            rows.push(row(format!("momentum {axis}"), change));
        }
        if let Some((first, last)) = first.angular_momentum.zip(last.angular_momentum) {
            rows.push(row("angular momentum", format!("{first:.6e} -> {last:.6e} kg m/s")));
        }
        match &report.balance {
            Some(balance) => rows.extend(balance_rows(balance)),
            None => rows.extend(work_rows(report.watch.work)),
        }
        let made = report.watch.made;
        if report.watch.warned() {
            rows.push(row("energy made", format!("{:.3e} J/m, {:.2} %", made.joule, 100.0 * made.share)));
        }
        rows.push(row("min J, max |curl F|", format!("{:.6}, {:.3e} 1/m", report.min_j, last.max_curl)));
    }
    rows
}

/// What came from outside; what a run did not have is left out.
fn work_rows([boundary, sources]: [f64; 2]) -> Vec<(String, String)> {
    let parts = [("work of the boundary", boundary), ("work of sources", sources)];
    let there = parts.into_iter().filter(|(_, joule)| *joule != 0.0);
    there.map(|(name, joule)| row(format!("  {name}"), format!("{joule:.6e} J/m"))).collect()
}

/// Where energy came from and went to.
fn balance_rows(balance: &Balance) -> Vec<(String, String)> {
    let parts = [
        ("lost at faces", balance.flux_dissipation),
        ("lost at the boundary", balance.boundary_dissipation),
        ("lost by the control of the curl", balance.curl_dissipation),
        ("lost by regrids", balance.regrid_dissipation),
    ];
    let there = parts.into_iter().filter(|(_, joule)| *joule != 0.0);
    let lost = there.map(|(name, joule)| row(format!("  {name}"), format!("{joule:.6e} J/m")));
    work_rows([balance.boundary_work, balance.source_work]).into_iter().chain(lost).collect()
}
