//! What a regrid did: in words, and as a row of `regrid.csv`.

use super::Body;
use super::moved::{Moved, scale};
use crate::format::count;
use crate::state::UNKNOWNS;
use crate::step::Totals;
use crate::sum::ExactSum;
use std::time::Instant;

/// Names of the phases of a regrid, in order; `regrid.csv` has their seconds.
const PHASES: [&str; 6] = ["mesh", "transfer", "points", "matrices", "scheme", "files"];

/// Columns of `regrid.csv` before the phases. Energies in J/m, areas in m^2.
const COLUMNS: [&str; 19] = [
    "step",
    "t",
    "rule",
    "cells_before",
    "cells",
    "copied",
    "points_before",
    "points",
    "points_kept",
    "points_outside",
    "kinetic_before",
    "kinetic",
    "strain_before",
    "strain",
    "momentum_1_change",
    "momentum_2_change",
    "deformation_change",
    "transfer_error",
    "uncovered",
];

/// Columns of `regrid.csv`.
pub(super) fn columns() -> Vec<&'static str> {
    [&COLUMNS[..], &PHASES[..]].concat()
}

/// A regrid in numbers.
pub(super) struct Outcome<'a> {
    /// The number of the rule.
    pub rule: usize,
    /// Mesh and points before.
    pub old: &'a Body,
    /// The problem after.
    pub new: &'a Moved,
    /// Totals before and after.
    pub totals: &'a [Totals; 2],
}

impl Outcome<'_> {
    fn copied(&self) -> usize {
        self.new.transfer.same.iter().flatten().count()
    }

    /// The error in the standard measure: over sqrt(int |F - 1|^2 + |v|^2 / c_p^2).
    fn error(&self) -> f64 {
        let (scheme, u) = (&self.new.scheme, &self.new.transfer.u);
        let (n, scale) = (scheme.operators.nodes(), scale(scheme));
        let mut sum = ExactSum::default();
        for (cell, u) in u.chunks_exact(self.new.state.components * n).enumerate() {
            let (block, lane) = scheme.operators.blocks.slot[cell];
            for (a, mass) in scheme.operators.geometry.masses(&scheme.operators.line, block, lane).enumerate() {
                for (k, scale) in scale[self.new.body.material[cell]].iter().enumerate().take(UNKNOWNS) {
                    let rest = if k == 0 || k == 3 { 1.0 } else { 0.0 };
                    sum.add(mass * scale * (u[k * n + a] - rest).powi(2));
                }
            }
        }
        let sum = sum.value();
        if sum > 0.0 { self.new.transfer.error / sum.sqrt() } else { self.new.transfer.error }
    }

    /// The row of `regrid.csv`.
    pub fn row(&self, clock: &Clock) -> Vec<f64> {
        let [before, after] = self.totals;
        let change = |k: usize| after.momentum[k] - before.momentum[k];
        let deformation =
            before.deformation.iter().zip(after.deformation).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let count = |k: usize| k as f64;
        let mut row = vec![
            count(self.new.state.step),
            self.new.state.time,
            count(self.rule),
            count(self.old.mesh.cells.len()),
            count(self.new.body.mesh.cells.len()),
            count(self.copied()),
            count(self.old.cloud.len()),
            count(self.new.placed.cloud.len()),
            count(self.new.placed.kept.iter().filter(|kept| **kept).count()),
            count(self.new.placed.outside),
            before.kinetic,
            after.kinetic,
            before.strain,
            after.strain,
            change(0),
            change(1),
            deformation,
            self.error(),
            self.new.transfer.uncovered[0] + self.new.transfer.uncovered[1],
        ];
        row.extend(clock.seconds);
        row
    }

    /// Lines for the terminal.
    pub fn words(&self, clock: &Clock) -> Vec<String> {
        let (state, [before, after]) = (&self.new.state, self.totals);
        let (transfer, placed) = (&self.new.transfer, &self.new.placed);
        let how = if transfer.structured { "lines" } else { "clipping" };
        let first = format!(
            "regrid at step {}, t = {:.6e} s: {} -> {} cells ({} copied, by {how}), {} -> {} points ({} kept)",
            state.step,
            state.time,
            self.old.mesh.cells.len(),
            self.new.body.mesh.cells.len(),
            self.copied(),
            self.old.cloud.len(),
            placed.cloud.len(),
            placed.kept.iter().filter(|kept| **kept).count(),
        );
        let energies = format!(
            "  error {:.3e}; kinetic {:.9e} -> {:.9e} J/m, strain {:.9e} -> {:.9e} J/m, momentum {:+.1e}, {:+.1e} kg/s",
            self.error(),
            before.kinetic,
            after.kinetic,
            before.strain,
            after.strain,
            after.momentum[0] - before.momentum[0],
            after.momentum[1] - before.momentum[1],
        );
        let mut words = vec![first, energies];
        if transfer.uncovered != [0.0; 2] {
            let [new, old] = transfer.uncovered;
            words.push(format!(
                "  the grids differ at their boundary: {new:.3e} m^2 of the new one filled, {old:.3e} m^2 of the old one left out"
            ));
        }
        if placed.outside > 0 {
            let (points, lie) = (count(placed.outside, "point"), if placed.outside == 1 { "lies" } else { "lie" });
            words.push(format!("  {points} {lie} outside of the new mesh, and the internal variables there are gone"));
        }
        let phases: Vec<String> = PHASES.iter().zip(clock.seconds).map(|(name, s)| format!("{name} {s:.4}")).collect();
        words.push(format!("  seconds: {}", phases.join(", ")));
        words
    }
}

/// Seconds of the phases.
pub(super) struct Clock {
    last: Instant,
    seconds: [f64; PHASES.len()],
}

impl Clock {
    /// Started now.
    pub fn new() -> Self {
        Self { last: Instant::now(), seconds: [0.0; PHASES.len()] }
    }

    /// Books the time since the last lap for a phase.
    pub fn lap(&mut self, phase: &str) {
        if let Some(at) = PHASES.iter().position(|name| *name == phase) {
            self.seconds[at] = self.last.elapsed().as_secs_f64();
        }
        self.last = Instant::now();
    }
}
