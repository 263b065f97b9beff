//! What was measured of a case.

use super::SHORT;
use super::case::{Case, run, why};
use super::reference::Reference;
use crate::error::{Error, Result};
use crate::exact::Errors;
use crate::quantity::Measured;
use crate::run::{Report, Stop, dofs};
use crate::scene::Scene;
use crate::state::State;
use std::sync::atomic::AtomicBool;

/// The status of a run that got to its end.
const DONE: &str = "done";

/// What is expected of a run.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Prediction {
    /// CPU seconds.
    pub cpu: f64,
    /// The error by the measure of the study; NaN where the meshes so far tell none.
    pub error: f64,
}

/// What was measured of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The case.
    pub case: Case,
    /// min_e h_e of the mesh, m.
    pub h: f64,
    /// Number of cells.
    pub cells: usize,
    /// Grid unknowns, 6 (N+1)^2 cells.
    pub dofs: usize,
    /// Steps of the run.
    pub steps: usize,
    /// Smallest and largest step, s.
    pub dt: [f64; 2],
    /// CPU seconds of the steps; the fastest of the repeats.
    pub cpu: f64,
    /// Seconds on the clock of that run.
    pub wall: f64,
    /// MiB of operators, state and work.
    pub memory: f64,
    /// The largest resident memory of the program so far, MiB.
    pub peak: f64,
    /// Errors at the end; none of a case that did not get there, or of a study without a reference.
    pub errors: Option<Errors>,
    /// The quantities that the scene names; empty of a case that did not get to its end.
    pub quantities: Vec<Measured>,
    /// Their errors, as far as the meshes of the series tell them: relative, or the value of a quantity that is an error itself.
    pub quantity_errors: Vec<Option<f64>>,
    /// The error by the measure of the study, where it is known.
    pub error: Option<f64>,
    /// `done`, or why it did not get there.
    pub status: String,
    /// What earlier records had let expect.
    pub predicted: Option<Prediction>,
}

impl Record {
    /// The error by the measure of the study, of a run that went well.
    pub fn error(&self) -> Option<f64> {
        self.error
    }

    /// Whether the run got to its end.
    pub fn is_done(&self) -> bool {
        self.status == DONE
    }

    pub(super) fn failed(case: Case, status: String) -> Self {
        Self::new(case, [0, 0], &Report::default(), status)
    }

    fn new(case: Case, sizes: [usize; 2], report: &Report, status: String) -> Self {
        Self {
            case,
            h: 0.0,
            cells: sizes[0],
            dofs: sizes[1],
            steps: report.steps,
            dt: report.dt,
            cpu: report.cpu,
            wall: report.wall,
            memory: report.bytes as f64 / (1024.0 * 1024.0),
            peak: crate::run::peak_memory_mib(),
            errors: None,
            quantities: vec![],
            quantity_errors: vec![],
            error: None,
            status,
            predicted: None,
        }
    }
}

/// Builds, runs and compares.
///
/// # Errors
/// An interrupt.
pub(super) fn measure(
    scene: &Scene,
    case: Case,
    reference: &Reference,
    predicted: Option<Prediction>,
    repeat: usize,
    interrupt: &AtomicBool,
) -> Result<Record> {
    let built = match case.build(scene) {
        Ok(built) => built,
        Err(why) => return Ok(Record { predicted, ..Record::failed(case, why.to_string()) }),
    };
    let sizes = [built.body.mesh.cells.len(), dofs(&built.scheme)];
    let mut best: Option<(State, Report, Vec<Measured>)> = None;
    for _ in 0..repeat.max(1) {
        match run(&built, interrupt) {
            Ok(run) if best.as_ref().is_none_or(|(_, old, _)| run.1.cpu < old.cpu) => best = Some(run),
            Ok(_) => {}
            Err(Stop::Interrupted) => return Err(Error::Interrupted("in a study; its table is kept".into())),
            Err(Stop::Output(why)) => return Err(why),
            Err(stop @ (Stop::Unstable(_) | Stop::EnergyMade(_))) => {
                let status = format!("unstable: {}", why(&stop));
                return Ok(Record { predicted, ..Record::new(case, sizes, &Report::default(), status) });
            }
        }
        if best.as_ref().is_some_and(|(_, report, _)| report.cpu > SHORT) {
            break;
        }
    }
    let Some((state, report, quantities)) = best else { return Ok(Record::failed(case, "no run".into())) };
    let errors = reference.errors(&built, &state);
    let (quantity_errors, h) = (vec![None; quantities.len()], built.body.mesh.smallest_h());
    let record = Record::new(case, sizes, &report, DONE.into());
    Ok(Record { predicted, h, errors, quantities, quantity_errors, ..record })
}
