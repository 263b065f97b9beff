//! What a checkpoint holds of the figures of a run, so that those of a run that is resumed go on.

use super::{Limits, Report, Treated, Watch};
use crate::error::Result;
use crate::step::phase::Phases;
use crate::step::{Balance, DeepestOverlap, Totals};
use crate::words::{Saved, Words};
use cpu_time::ProcessTime;
use std::time::Instant;

impl Report {
    /// Saves its figures.
    pub fn save(&self, to: &mut Words) {
        to.count(self.steps).real(self.updates).real(self.min_j).reals(&self.dt).reals(&self.seconds());
        to.reals(&self.phases.seconds).reals(&self.phases.parts).real(self.rescue);
        to.real(self.regrids.0).count(self.regrids.1).count(self.bytes).count(self.observed.len());
        for (seconds, count) in &self.observed {
            to.real(*seconds).count(*count);
        }
        to.flag(self.first.is_some());
        self.first.iter().for_each(|first| save_totals(first, to));
        to.flag(self.balance.is_some());
        self.balance.iter().for_each(|balance| save_balance(balance, to));
        self.watch.save(to);
        to.flag(self.treated.is_some());
        self.treated.iter().for_each(|treated| treated.save(to));
        to.flag(self.overlap.is_some());
        self.overlap.iter().for_each(|deepest| save_overlap(deepest, to));
        to.flag(self.in_obstacle.is_some());
        self.in_obstacle.iter().for_each(|deepest| save_overlap(deepest, to));
        to.flag(self.not_restored.is_some()).real(self.not_restored.unwrap_or(0.0));
        to.count(self.ends.len());
        for (step, end) in &self.ends {
            to.count(*step).real(*end);
        }
    }

    /// The figures of a run that goes on under a watch with these limits.
    ///
    /// # Errors
    /// What was saved by something else.
    pub fn restored(from: &mut Saved, limits: Option<Limits>) -> Result<Self> {
        let mut out = Self { steps: from.count()?, updates: from.real()?, min_j: from.real()?, ..Self::default() };
        let pair = |from: &mut Saved| from.count().and_then(|_| from.array());
        (out.dt, out.before) = (pair(from)?, pair(from)?);
        out.clock = (Instant::now(), ProcessTime::now());
        out.phases = restored_phases(from)?;
        out.rescue = from.real()?;
        (out.regrids, out.bytes) = ((from.real()?, from.count()?), from.count()?);
        for _ in 0..from.count()? {
            out.observed.push((from.real()?, from.count()?));
        }
        out.first = if from.flag()? { Some(restored_totals(from)?) } else { None };
        out.balance = if from.flag()? { Some(restored_balance(from)?) } else { None };
        out.watch = Watch::restored(from, limits)?;
        out.treated = if from.flag()? { Some(Treated::restored(from)?) } else { None };
        out.overlap = if from.flag()? { Some(restored_overlap(from)?) } else { None };
        out.in_obstacle = if from.flag()? { Some(restored_overlap(from)?) } else { None };
        let (is_known, not_restored) = (from.flag()?, from.real()?);
        out.not_restored = is_known.then_some(not_restored);
        for _ in 0..from.count()? {
            out.ends.push((from.count()?, from.real()?));
        }
        Ok(out)
    }
}

fn save_overlap(DeepestOverlap { depth, share, x }: &DeepestOverlap, to: &mut Words) {
    to.real(*depth).real(*share).real(x[0]).real(x[1]);
}

fn restored_overlap(from: &mut Saved) -> Result<DeepestOverlap> {
    let [depth, share, x, y] = from.array()?;
    Ok(DeepestOverlap { depth, share, x: [x, y] })
}

fn restored_phases(from: &mut Saved) -> Result<Phases> {
    let (seconds, parts) = (from.reals()?, from.reals()?);
    let mut out = Phases::default();
    out.seconds.iter_mut().zip(seconds).for_each(|(out, s)| *out = s);
    out.parts.iter_mut().zip(parts).for_each(|(out, s)| *out = s);
    Ok(out)
}

fn save_totals(totals: &Totals, to: &mut Words) {
    let Totals { kinetic, strain, in_faces, momentum, deformation, min_j, max_curl, .. } = totals;
    to.reals(&[*kinetic, *strain, *in_faces, momentum[0], momentum[1], *min_j, *max_curl]).reals(deformation);
    for known in [totals.dissipated, totals.angular_momentum, totals.max_drift] {
        to.flag(known.is_some()).real(known.unwrap_or(0.0));
    }
}

fn restored_totals(from: &mut Saved) -> Result<Totals> {
    from.count()?;
    let [kinetic, strain, in_faces, one, two, min_j, max_curl] = from.array()?;
    from.count()?;
    let (deformation, mut known) = (from.array()?, [None; 3]);
    for known in &mut known {
        let (is_known, value) = (from.flag()?, from.real()?);
        *known = is_known.then_some(value);
    }
    let [dissipated, angular_momentum, max_drift] = known;
    let momentum = [one, two];
    Ok(Totals {
        kinetic,
        strain,
        in_faces,
        dissipated,
        momentum,
        angular_momentum,
        deformation,
        min_j,
        max_curl,
        max_drift,
    })
}

fn save_balance(balance: &Balance, to: &mut Words) {
    let Balance { start, energy, boundary_work, source_work, flux_dissipation, boundary_dissipation, .. } = *balance;
    let Balance { contact_work, curl_dissipation, correction_dissipation, regrid_dissipation, jumps, .. } = *balance;
    to.reals(&[start, energy, boundary_work, source_work, flux_dissipation, boundary_dissipation]);
    to.reals(&[contact_work, curl_dissipation, correction_dissipation, regrid_dissipation, jumps]);
}

fn restored_balance(from: &mut Saved) -> Result<Balance> {
    from.count()?;
    let [start, energy, boundary_work, source_work, flux_dissipation, boundary_dissipation] = from.array()?;
    from.count()?;
    let [contact_work, curl_dissipation, correction_dissipation, regrid_dissipation, jumps] = from.array()?;
    Ok(Balance {
        start,
        energy,
        boundary_work,
        source_work,
        contact_work,
        flux_dissipation,
        boundary_dissipation,
        curl_dissipation,
        correction_dissipation,
        regrid_dissipation,
        jumps,
    })
}
