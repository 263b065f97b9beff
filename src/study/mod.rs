//! What accuracy costs in time: one scene by many settings, the error and the seconds of each, the cheapest setting for
//! an error or a time.
//!
//! The one number that stands for the error is a [`Measure`]: the standard one of [`crate::accuracy::Errors`] or the same in L1, against
//! the exact solution of the scene or, where none is known, against a finer run whose own error is estimated; or the error of a
//! quantity that the scene names, against its exact value or, where none is known, by Richardson's extrapolation. Every method steps
//! by the same share of its own stability limit, so that none is slowed down by a rule made for another.

mod case;
mod choice;
mod compared;
mod front;
mod measure;
mod plot;
mod predict;
mod record;
mod reference;
mod request;
mod richardson;
mod session;
mod table;
mod trend;
mod words;

pub use case::{Case, Series};
pub use choice::{Aim, Choice, ranked};
pub use compared::{Comparison, compared};
pub use front::{Answer, answers, cost, front};
pub use measure::Measure;
pub use plot::{Axis, plot};
pub use predict::{Model, Size};
pub use record::{Prediction, Record};
pub use reference::Reference;
pub use request::Request;
pub use richardson::{Doubt, Estimate, estimate};
pub use session::{Plan, Session};
pub use table::{COLUMNS, csv, machine, markdown};
pub use trend::{Limit, Trend, trends};

use crate::error::Result;
use crate::lane::LANES;
use crate::scene::Scene;
use std::sync::atomic::AtomicBool;

/// CPU seconds below which a run is repeated: clock and cache count there.
const SHORT: f64 = 0.5;

/// A scene under study, and what was measured so far.
pub struct Study<'a> {
    /// The scene, as it stands.
    pub scene: &'a Scene,
    /// Cells of its mesh.
    pub cells: usize,
    /// min_e h_e of its mesh, m.
    pub h: f64,
    /// What errors are taken against.
    pub reference: Reference,
    /// What settings are compared by.
    pub measure: Measure,
    /// What was measured.
    pub records: Vec<Record>,
    /// Runs of a short case, of which the fastest counts.
    pub repeat: usize,
    /// Set from outside to stop.
    pub interrupt: &'a AtomicBool,
}

impl Study<'_> {
    /// Runs a case, with what was expected of it, and keeps its record; a case that cannot run or loses stability is
    /// recorded with the reason.
    ///
    /// # Errors
    /// None of the case itself: only an interrupt.
    pub fn measure(&mut self, case: Case) -> Result<&Record> {
        // One mesh alone tells no rate.
        let model = self.model(&case.series).filter(|model| model.levels() > 1);
        let predicted = model.map(|model| model.at(self.size(&case)));
        let record = record::measure(self.scene, case, &self.reference, predicted, self.repeat, self.interrupt)?;
        let series = record.case.series.clone();
        self.records.push(record);
        // Another mesh may tell more of those before, too.
        trend::rate(&mut self.records, &series, self.scene, &self.measure);
        // The one just pushed.
        Ok(&self.records[self.records.len() - 1])
    }

    /// What the records of a series tell of finer meshes; none without a run that went well.
    pub fn model(&self, series: &Series) -> Option<Model> {
        Model::fit(series.degree, self.records.iter().filter(|r| r.case.series == *series))
    }

    /// The size of a case's mesh.
    pub fn size(&self, case: &Case) -> Size {
        let blocks = case.cells(self.scene, self.cells).div_ceil(LANES) as f64;
        Size { refinement: case.refinement, h: case.h(self.scene, self.h), blocks }
    }
}
