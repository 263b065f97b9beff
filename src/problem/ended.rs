//! How a run ended: its status, the state that is kept, and what a user is told.

use super::Problem;
use super::lost::{Case, kept};
use crate::error::{Error, Result};
use crate::format::shell;
use crate::io::{pending, snapshot};
use crate::observe;
use crate::registry::{controls, fluxes};
use crate::run::{Folder, Report, Stop};
use crate::scene::Scene;
use crate::state::State;
use crate::step::EnergyMade;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// How a run ended.
pub struct Ended {
    /// For `summary.json`: done, unstable, interrupted or failed.
    pub status: &'static str,
    /// What is known of a loss of stability, for `summary.json`.
    pub loss: Option<Value>,
    /// The error for the user, where there is one.
    pub result: Result<()>,
}

impl Ended {
    /// Keeps a good state of a run that stopped, in its folder, and says why it ended.
    pub fn of(ended: std::result::Result<(), Stop>, problem: &Problem, report: &Report, folder: &Folder) -> Self {
        let Err(stop) = ended else { return Self { status: "done", loss: None, result: Ok(()) } };
        let Problem { scheme, state, files, .. } = problem;
        // That before a step which lost stability is nearly lost itself.
        let good = match &stop {
            Stop::Unstable(lost) => &lost.kept,
            Stop::EnergyMade(made) => &made.1,
            _ => state,
        };
        // A folder that was removed is not made anew.
        let written = pending::check_folder(&folder.snapshots()).and_then(|()| problem.keep_files(folder));
        let file = written.and_then(|()| {
            kept_snapshot(&stop, good, &folder.snapshots(), |to| observe::write(scheme, good, files, to))
        });
        let ended = |status, error| Self { status, loss: None, result: Err(error) };
        match stop {
            Stop::Output(error) => ended("failed", error),
            Stop::Interrupted => {
                let place = match &file {
                    Ok(path) => format!("the last good state is in {}{}", path.display(), resume(folder, state.step)),
                    Err(why) => format!("the last good state could not be kept: {why}"),
                };
                let at = format!("at step {}, t = {:.6e} s; {place}", state.step, state.time);
                ended("interrupted", Error::Interrupted(at))
            }
            Stop::EnergyMade(made) => ended("unstable", too_much(&made.0, &problem.scene, &file)),
            Stop::Unstable(lost) => {
                let case = Case { problem, report, lost: &lost };
                let (loss, error) = (Some(case.json()), case.error(&kept(&lost, &file)));
                let status = if let Error::Unstable { .. } = error { "unstable" } else { "failed" };
                Self { status, loss, result: Err(error) }
            }
        }
    }
}

/// The snapshot of the state that is kept. Where an output has written one of the step at which a run was interrupted, it stays.
fn kept_snapshot(
    stop: &Stop,
    state: &State,
    folder: &Path,
    write: impl FnOnce(&Path) -> Result<PathBuf>,
) -> Result<PathBuf> {
    let there = snapshot::path(folder, state.step);
    match stop {
        Stop::Interrupted if there.exists() => Ok(there),
        _ => write(folder),
    }
}

/// How to go on with a run that was kept at its last step.
fn resume(folder: &Folder, step: usize) -> String {
    match snapshot::path(&folder.checkpoints(), step).exists() {
        true => format!("; go on by: dgmpm resume {}", shell(folder.root.display())),
        false => String::new(),
    }
}

/// What may keep the energy of a run, by what it has on.
fn holds(made: &EnergyMade, scene: &Scene) -> String {
    let (flux, control) = (fluxes::DEFAULT, controls::DEFAULT);
    let all = [
        (scene.scheme.flux.name() != flux).then(|| format!("scheme.flux = \"{flux}\"")),
        (scene.curl.name() != control).then(|| format!("[curl] control = \"{control}\"")),
        made.between_nodes.then(|| "points on the Gauss nodes ([cloud] layout = \"gauss\")".to_owned()),
    ];
    let mut all: Vec<String> = all.into_iter().flatten().collect();
    if let Ok(settings) = scene.settings() {
        all.push(format!("a smaller step (scheme.safety = {:.2})", 0.5 * settings.courant / scene.step_limit()));
    }
    all.push("a finer mesh".to_owned());
    all.join(" or ")
}

/// The error of a run that made so much energy that it was stopped.
fn too_much(made: &EnergyMade, scene: &Scene, kept: &Result<PathBuf>) -> Error {
    let place = match kept {
        Ok(path) => format!("a state of some steps before is in {}", path.display()),
        Err(why) => format!("the state of some steps before could not be kept: {why}"),
    };
    Error::Unstable {
        what: format!("the body has energy that nothing gave to it: {made}"),
        time: made.time,
        step: made.step,
        remedy: format!(
            "{place}; see ledger.csv for when it began; [watch] energy = {:.0e} or \"off\" lets it go on; {} may hold it",
            10.0 * made.share,
            holds(made, scene)
        ),
    }
}
