//! Why a run lost stability, what is left of it, and what may help: that depends on what the scene has switched on.

use super::{Culprit, Problem};
use crate::error::{Error, Result};
use crate::format::count;
use crate::operators::Sampling;
use crate::operators::certificate::certify;
use crate::registry::fluxes;
use crate::run::{Lost, Report};
use crate::scene::{Boundary, Scene};
use crate::state::State;
use crate::step::LossKind;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The default of `scheme.safety`.
const SAFETY: f64 = 0.9;
/// Energy over that of the start (and the work done) above which energy has been made, not only moved.
const RISEN: f64 = 1.1;
/// A face Lebesgue constant above which points lie too far from the Gauss nodes to be above suspicion. (`paper` has 2.3 and
/// 26.6 for N = 1, 2, `midpoints` 5.9 and 16.8 for N = 2, 3.)
const LEBESGUE: f64 = 20.0;

/// A run that lost stability, with everything that is known about it.
pub struct Case<'a> {
    /// The problem, with the state before the step that failed.
    pub problem: &'a Problem,
    /// Figures of the run.
    pub report: &'a Report,
    /// The loss.
    pub lost: &'a Lost,
}

/// Where the state is that a run which lost stability has kept.
pub fn kept(lost: &Lost, file: &Result<PathBuf>) -> String {
    let (State { step, time, .. }, before) = (&lost.kept, lost.step - lost.kept.step);
    let state = format!("the good state of step {step}, t = {time:.9e} s, {} before,", count(before, "step"));
    match file {
        Ok(path) => format!("{state} is in {}: a run goes on from it by [initial] snapshot", path.display()),
        Err(why) => format!("{state} could not be kept: {why}"),
    }
}

impl Problem {
    /// The expression of the scene that is not finite, where a run has lost stability by one.
    pub(crate) fn culprit(&self, lost: &Lost) -> Option<Culprit> {
        // An expression that grows beyond bounds at the start or end of the step turns cells inside out before it is infinite.
        let mut times = self.scheme.data_times(lost.time, lost.dt);
        times.extend([lost.time, lost.time + lost.dt]);
        self.scene.culprit(&self.body.mesh, &self.scheme, lost.loss.cell, &times)
    }
}

impl Case<'_> {
    /// The error: bad input where an expression of the scene is not finite, which no other step size can mend; else lost
    /// stability. `kept` says where a state is from which the run can go on.
    pub fn error(&self, kept: &str) -> Error {
        let Self { problem, lost, .. } = self;
        let scene = &problem.scene;
        if let Some(culprit) = problem.culprit(lost) {
            let what = format!("step {}, t = {:.9e} s: {}", lost.step, lost.time, culprit.what);
            let remedy = format!("give an expression that is finite at all places and times of the run\n  {kept}");
            return scene.error(&culprit.key, what, remedy);
        }
        let hints = self.hints().join("\n  - ");
        Error::Unstable {
            what: problem.describe(&lost.loss),
            time: lost.time,
            step: lost.step,
            remedy: format!("{kept}\n  what may help:\n  - {hints}"),
        }
    }

    /// For `summary.json`.
    pub fn json(&self) -> Value {
        let Lost { loss, step, time, kept, .. } = self.lost;
        let at = self.problem.scheme.position_of(loss.cell, loss.site);
        json!({
            "step": step,
            "time": time,
            "what": loss.kind.to_string(),
            "cell": self.problem.body.mesh.number(loss.cell),
            "place": loss.site.to_string(),
            "at": at,
            "kept_step": kept.step,
            "kept_time": kept.time,
        })
    }

    /// What may help, the most likely first.
    fn hints(&self) -> Vec<String> {
        let all = [
            self.step_size(),
            self.limiter(),
            self.curl(),
            self.regrid(),
            self.energy(),
            self.points(),
            self.flux(),
            self.law(),
        ];
        let mut out: Vec<String> = all.into_iter().flatten().collect();
        out.push(self.crushed().to_owned());
        out
    }

    fn step_size(&self) -> Option<String> {
        let scene = &self.problem.scene;
        let safety = scene.settings().ok()?.courant / scene.step_limit();
        // A share that is written as a cfl number is rounded.
        (safety > SAFETY + 1e-9).then(|| {
            format!("the step is {safety:.2} of the limit, which is that of small waves: give scheme.safety = {SAFETY}")
        })
    }

    fn limiter(&self) -> Option<String> {
        let scheme = &self.problem.scheme;
        (scheme.rescue.is_none()).then(|| {
            "[limiter] kind = \"moment\" damps cells at shocks and corners, and steps lost cells again at order 0"
                .to_owned()
        })
    }

    fn curl(&self) -> Option<String> {
        let hint = self.problem.scene.curl.build().when_lost;
        (!hint.is_empty() && self.problem.scene.scheme.degree > 0).then(|| hint.to_owned())
    }

    fn regrid(&self) -> Option<String> {
        let Lost { step, since, .. } = self.lost;
        let began = self.problem.state.step.saturating_sub(self.report.steps);
        (*since > began).then(|| {
            let before = count(step - since, "step");
            format!(
                "the grid was new at step {since}, {before} before: let the run begin with it, or regrid less often"
            )
        })
    }

    /// Kinetic and strain energy and what laws with memory dissipated, over those of the start and the work done; none where the
    /// work is not known.
    fn risen(&self) -> Option<f64> {
        let first = self.report.first?.accounted();
        let now = self.problem.scheme.totals(&self.problem.state).accounted();
        let work = match &self.report.balance {
            Some(balance) => balance.work(),
            None if self.is_driven() => return None,
            None => 0.0,
        };
        let given = first + work.max(0.0);
        (given > 0.0 && now > RISEN * given).then_some(now / given)
    }

    /// Whether boundaries or sources can do work.
    fn is_driven(&self) -> bool {
        let still = |boundary: &Boundary| {
            let mut all = boundary.condition.expressions().flat_map(|(_, all)| all);
            all.all(|expression| expression.constant() == Some(0.0)) && boundary.condition.files().next().is_none()
        };
        !self.problem.scheme.sources.is_empty() || !self.problem.scene.boundaries.iter().all(still)
    }

    fn energy(&self) -> Option<String> {
        let risen = self.risen()?;
        let degree = self.problem.scene.scheme.degree;
        let lower = if degree > 1 { format!(", or scheme.degree = {}", degree - 1) } else { String::new() };
        Some(format!(
            "the energy had risen to {risen:.3} of the start and the work done, so the scheme was unstable before (ledger.csv \
             has since when): try a finer mesh{lower}"
        ))
    }

    fn has_memory(&self) -> bool {
        !self.problem.scheme.histories.is_empty()
    }

    fn points(&self) -> Option<String> {
        let Scene { scheme, cloud, .. } = &self.problem.scene;
        let memory = self.has_memory();
        if !scheme.method.has_points() || cloud.layout.build().on_nodes {
            return None;
        }
        let (mesh, line) = (&self.problem.body.mesh, &self.problem.scheme.operators.line);
        let all = certify(mesh, line, Sampling::Cloud(&self.problem.body.cloud));
        let lebesgue = all.ok()?.iter().map(|c| c.lebesgue).fold(0.0, f64::max);
        let far = lebesgue > LEBESGUE;
        (memory || far).then(|| {
            let why = if memory { "a law has memory" } else { "points amplify what they see at the faces" };
            format!(
                "{why} (face Lebesgue constant {lebesgue:.1}): give cloud.layout = \"gauss\", points at the Gauss nodes"
            )
        })
    }

    fn flux(&self) -> Option<String> {
        let flux = &self.problem.scene.scheme.flux;
        let why = (flux.build().when_lost)(self.has_memory())?;
        let (name, default) = (flux.name(), fluxes::DEFAULT);
        Some(match name == default {
            true => why.to_owned(),
            false => format!("scheme.flux = \"{name}\" {why}: leave it out, for the default \"{default}\""),
        })
    }

    fn law(&self) -> Option<String> {
        let law = self.problem.body.material[self.lost.loss.cell];
        // A law of the small strain is the same in tension and in compression.
        let is_stiffening = self.problem.scheme.laws[law].is_objective();
        (!is_stiffening).then(|| {
            "a linear law does not stiffen where it is crushed: give law = \"neo-hookean\" for large strains".to_owned()
        })
    }

    fn crushed(&self) -> &'static str {
        match self.lost.loss.kind {
            LossKind::Inverted(_) => {
                "the law lets the material be crushed to J = 0: a finer mesh at that place, or a load that comes more slowly"
            }
            LossKind::NotHyperbolic => "the law has no waves at this deformation: a stiffer law, or a smaller load",
            LossKind::NotFinite => "a smaller scheme.safety, or a finer mesh",
        }
    }
}
