//! What was measured of a case.

use super::SHORT;
use super::case::{Case, run, why};
use super::reference::Reference;
use crate::accuracy::Errors;
use crate::error::{Error, Result};
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
    /// The estimated errors of what `errors` are taken against, standard and in L1, where they are known.
    pub floor: Option<[f64; 2]>,
    /// The error by the measure of the study, where it is known.
    pub error: Option<f64>,
    /// Where the run is as near to the reference as this is to what is exact, no error is known; it is below this.
    pub below: Option<f64>,
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

    /// The error, or what it is below.
    pub fn bound(&self) -> Option<f64> {
        self.error.or(self.below)
    }

    /// The error in words: `6.31e-3`, or `< 2.1e-5` (rounded up) where it is below that of the reference.
    pub fn error_words(&self) -> String {
        match (self.error, self.below) {
            (Some(error), _) if error.is_finite() => format!("{error:.2e}"),
            (_, Some(below)) => format!("< {:.1e}", rounded_up(below)),
            _ => "-".to_owned(),
        }
    }

    /// Sets the error by the measure from the distance to the reference, whose own error may be known.
    pub(super) fn judge(&mut self, distance: Option<f64>, own: Option<f64>) {
        // The distance of a run that is nearer tells of the reference. By the triangle both together are a bound.
        let below = distance.zip(own).and_then(|(distance, own)| (distance < own).then_some(distance + own));
        (self.error, self.below) = (if below.is_some() { None } else { distance }, below);
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
            floor: None,
            error: None,
            below: None,
            status,
            predicted: None,
        }
    }
}

/// A number above 0 to two digits, not less than it is.
fn rounded_up(x: f64) -> f64 {
    let unit = 10_f64.powf(x.log10().floor() - 1.0);
    (x / unit).ceil() * unit
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
                let culprit = if let Stop::Unstable(loss) = &stop { built.culprit(loss) } else { None };
                let status = match culprit {
                    Some(culprit) => format!("bad input: {}", culprit.what),
                    None => format!("unstable: {}", why(&stop)),
                };
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
    Ok(Record { predicted, h, errors, quantities, quantity_errors, floor: reference.own_errors(), ..record })
}
