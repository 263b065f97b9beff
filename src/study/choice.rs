//! The cheapest setting that meets an error, or the most accurate one within a time, from a short calibrated series.

use super::Study;
use super::case::{Case, Series};
use super::record::Prediction;
use crate::lane::LANES;
use crate::scene;

/// What a user asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// An error by the measure of the study.
    Error(f64),
    /// CPU seconds of the run (those on the clock, on one thread).
    Seconds(f64),
}

/// Share of the aim that a setting is chosen for, so that a prediction a little off still meets it.
const SHARE: f64 = 0.85;
/// Cells per direction over those of the finest mesh of a series that its model is trusted for.
const REACH: f64 = 2.0;
/// Cells of the largest mesh that is thought of: with some kB a cell, tens of GB.
const MOST: f64 = 1e7;

impl Aim {
    /// Whether a result meets it.
    pub fn is_met(self, cpu: f64, error: f64) -> bool {
        match self {
            Self::Error(aim) => error <= aim,
            Self::Seconds(aim) => cpu <= aim,
        }
    }

    /// Seconds that are allowed.
    fn seconds(self) -> f64 {
        match self {
            Self::Error(_) => f64::INFINITY,
            Self::Seconds(seconds) => seconds,
        }
    }

    /// The smaller the better: the seconds for an error, the error for seconds.
    fn merit(self, prediction: &Prediction) -> f64 {
        match self {
            Self::Error(_) => prediction.cpu,
            Self::Seconds(_) => prediction.error,
        }
    }
}

/// A setting that is expected to meet the aim.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The setting.
    pub case: Case,
    /// What is expected of it.
    pub prediction: Prediction,
    /// Whether the series was measured close enough by; else a mesh in between is to be measured first.
    pub calibrated: bool,
}

/// The settings of `series` by what was measured so far, the best first; empty where no mesh of any meets the aim.
pub fn ranked(study: &Study, series: &[Series], aim: Aim) -> Vec<Choice> {
    let mut all: Vec<Choice> = series.iter().filter_map(|series| candidate(study, series, aim)).collect();
    all.sort_by(|a, b| aim.merit(&a.prediction).total_cmp(&aim.merit(&b.prediction)));
    all
}

fn candidate(study: &Study, series: &Series, aim: Aim) -> Option<Choice> {
    let model = study.model(series).filter(|model| model.levels() > 1 && model.knows_errors())?;
    let expect = |refinement: f64| {
        let case = Case { series: series.clone(), refinement };
        (model.at(study.size(&case)), case)
    };
    let refinement = match aim {
        Aim::Error(error) => round(study, model.refinement_for(SHARE * error), true),
        Aim::Seconds(seconds) => {
            let dear = |refinement: f64| expect(refinement).0.cpu > SHARE * seconds;
            round(study, last_before(model.reach(), dear), false)
        }
    };
    let (prediction, case) = expect(refinement);
    // A mesh beyond what memory holds meets nothing.
    let fits = prediction.cpu <= aim.seconds() && study.size(&case).blocks * LANES as f64 <= MOST;
    fits.then(|| Choice { calibrated: refinement <= REACH * model.reach(), case, prediction })
}

/// Where a property that larger numbers have begins, to a percent.
fn last_before(start: f64, has: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (start, start);
    for _ in 0..40 {
        if has(low) {
            low *= 0.5;
        }
        if !has(high) {
            high *= 2.0;
        }
    }
    while high > 1.01 * low {
        let middle = (low * high).sqrt();
        if has(middle) { high = middle } else { low = middle }
    }
    low
}

/// The nearest refinement that gives whole cells, upwards or downwards.
fn round(study: &Study, refinement: f64, up: bool) -> f64 {
    let cells = match study.scene.mesh {
        scene::Mesh::Rectangle { cells, .. } => cells[0].max(cells[1]) as f64,
        scene::Mesh::File(_) => 1.0,
    };
    let whole = if up { (refinement * cells).ceil() } else { (refinement * cells).floor() };
    whole.max(1.0) / cells
}
