//! A run at its end, as rows of a table.

use super::Report;
use crate::format::{Row, mebibytes, row, seconds};
use crate::step::{Balance, DeepestOverlap, Imbalance, Totals, phase::NAMES};

impl Report {
    /// What the run cost, and what became of energy and momentum.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = vec![
            row("steps", self.steps.to_string()),
            row("dt", if self.steps > 0 { format!("{:.4e} .. {:.4e} s", self.dt[0], self.dt[1]) } else { "-".into() }),
            row("wall, CPU", format!("{}, {}", seconds(self.wall), seconds(self.cpu))),
        ];
        let all: f64 = self.phases.seconds.iter().sum();
        for (name, s) in NAMES.iter().zip(self.phases.seconds).filter(|(_, s)| *s > 0.0) {
            rows.push(row(format!("  {name}"), format!("{s:8.3} s {:5.1} %", 100.0 * s / all)));
        }
        for (who, imbalance) in [("threads", self.shares.of_threads()), ("ranks", self.shares.of_ranks())] {
            let Some(Imbalance { predicted, measured }) = imbalance else { continue };
            let text = format!("{measured:.3} (estimated {predicted:.3}): the most of one over the mean");
            rows.push(row(format!("imbalance of {who}"), text));
        }
        let most = |k: usize| self.shares.messages().iter().map(|rank| rank[k]).fold(0.0, f64::max);
        if !self.shares.messages().is_empty() {
            let [pack, wait, unpack] = [0, 1, 2].map(|k| seconds(most(k)));
            rows.push(row(
                "messages",
                format!("packed {pack}, waited {wait}, unpacked {unpack}: the most of one rank"),
            ));
        }
        rows.push(row("DoF-updates/s (CPU)", format!("{:.3e}", self.rate())));
        rows.push(row("memory", mebibytes(self.bytes)));
        if let (Some(first), Some(last)) = (&self.first, &self.last) {
            rows.extend(self.changes(first, last));
        }
        rows
    }

    /// Energy and momentum at the start and the end, and what took them.
    fn changes(&self, first: &Totals, last: &Totals) -> Vec<Row> {
        let mut rows = vec![
            row("kinetic energy", format!("{:.6e} -> {:.6e} J/m", first.kinetic, last.kinetic)),
            row("strain energy", format!("{:.6e} -> {:.6e} J/m", first.strain, last.strain)),
            row("total energy", format!("{:.6} of start and work", self.energy_ratio())),
        ];
        if first.in_faces.max(last.in_faces) > 0.0 {
            rows.insert(2, row("  in faces", format!("{:.6e} -> {:.6e} J/m", first.in_faces, last.in_faces)));
        }
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
        if let Some(rest) = self.not_restored.filter(|rest| *rest > 0.0) {
            rows.push(row("  not restored", format!("{rest:.6e} kg m/s: the steps had not lost the energy for it")));
        }
        match &self.balance {
            Some(balance) => rows.extend(balance_rows(balance)),
            None => rows.extend(work_rows([self.watch.work[0], self.watch.work[1], self.watch.contact_work])),
        }
        for (name, deepest) in [("deepest overlap", self.overlap), ("deepest in an obstacle", self.in_obstacle)] {
            let Some(DeepestOverlap { depth, share, x: [x, y] }) = deepest else { continue };
            let at = if share > 0.0 { format!(", at ({x:.4}, {y:.4})") } else { String::new() };
            rows.push(row(name, format!("{depth:.3e} m, {:.1} % of a cell{at}", 100.0 * share)));
        }
        rows.extend(self.treated.iter().flat_map(|treated| treated.rows()));
        let made = self.watch.made;
        if self.watch.warned() {
            rows.push(row("energy made", format!("{:.3e} J/m, {:.2} %", made.joule, 100.0 * made.share)));
        }
        rows.push(row("min J, max |curl F|", format!("{:.6}, {:.3e} 1/m", self.min_j, last.max_curl)));
        rows
    }
}

/// What came from outside and from contact; what a run did not have is left out.
fn work_rows([boundary, sources, contact]: [f64; 3]) -> Vec<Row> {
    let parts = [("work of the boundary", boundary), ("work of sources", sources), ("work of contact", contact)];
    let there = parts.into_iter().filter(|(_, joule)| *joule != 0.0);
    there.map(|(name, joule)| row(format!("  {name}"), format!("{joule:.6e} J/m"))).collect()
}

/// Where energy came from and went to.
fn balance_rows(balance: &Balance) -> Vec<Row> {
    let parts = [
        ("lost at faces", balance.flux_dissipation),
        ("lost at the boundary", balance.boundary_dissipation),
        ("lost by the control of the curl", balance.curl_dissipation),
        ("lost by regrids", balance.regrid_dissipation),
        ("taken by corrections", balance.correction_dissipation),
    ];
    let there = parts.into_iter().filter(|(_, joule)| *joule != 0.0);
    let lost = there.map(|(name, joule)| row(format!("  {name}"), format!("{joule:.6e} J/m")));
    work_rows([balance.boundary_work, balance.source_work, balance.contact_work]).into_iter().chain(lost).collect()
}
