//! What a run came to: `summary.json`.

use super::Problem;
use super::effects::{self, effects};
use crate::accuracy::{Errors, errors};
use crate::error::Result;
use crate::exact::Exact;
use crate::format::{Row, row};
use crate::io::fingerprint::Fingerprint;
use crate::io::pending;
use crate::io::provenance::Provenance;
use crate::quantity::Measured;
use crate::run::{Folder, Report, norms};
use crate::step::Scheme;
use serde_json::{Value, json};
use std::sync::Arc;

/// A run at its end.
pub struct Outcome<'a> {
    /// The problem with the last good state.
    pub problem: &'a Problem,
    /// Figures of the run.
    pub report: &'a Report,
    /// Errors, where the scene names an exact solution.
    pub errors: Option<Errors>,
    /// The quantities that the scene names.
    pub quantities: Vec<Measured>,
}

impl<'a> Outcome<'a> {
    /// With the errors against the exact solution of the scene.
    pub fn new(problem: &'a Problem, report: &'a Report) -> Self {
        let Problem { scene, body, scheme, state, .. } = problem;
        let of = |exact: Arc<dyn Exact>| errors(exact.as_ref(), &body.mesh, scheme, state, &body.material);
        Self { problem, report, errors: scene.build_exact().map(of), quantities: vec![] }
    }

    /// What the run cost, what became of energy and momentum, and the errors, as rows of a table.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = self.report.rows();
        if let Some(errors) = &self.errors {
            for (name, norms) in errors.fields() {
                let text = format!("L1 {:.4e}, L2 {:.4e}, Linf {:.4e}", norms.l1, norms.l2, norms.linf);
                rows.push(row(format!("error of {name}"), text));
            }
            rows.push(row("standard error", format!("{:.4e}", errors.standard)));
            rows.push(row("standard error in L1", format!("{:.4e}", errors.standard_l1)));
        }
        for Measured { name, unit, value, .. } in &self.quantities {
            let text = if value.is_nan() { "none".to_owned() } else { format!("{value:.6e} {unit}") };
            rows.push(row(name, text.trim_end()));
        }
        rows.push(row("instruction set", format!("{:?}", self.problem.scheme.kernel)));
        rows.extend(effects::rows(&effects(self.problem, self.report), self.report));
        rows
    }

    /// Writes `summary.json`. `status`: done, unstable, interrupted or failed; `loss`: what is known of a loss of stability.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, folder: &Folder, status: &str, loss: Option<Value>) -> Result<()> {
        pending::check_folder(&folder.root)?;
        let Problem { scene, body, scheme, state, .. } = self.problem;
        let mut all = self.report.json(scheme, state);
        if let Some(errors) = &self.errors {
            all.insert("errors".to_owned(), error_json(errors));
        }
        if !self.quantities.is_empty() {
            let numbers = self.quantities.iter().map(|measured| (measured.name.clone(), json!(measured.value)));
            all.insert("quantities".to_owned(), Value::Object(numbers.collect()));
        }
        all.insert("effects".to_owned(), effects::json(&effects(self.problem, self.report), self.report));
        all.insert("title".to_owned(), json!(scene.title));
        all.insert("method".to_owned(), json!(scene.scheme.method.name()));
        all.insert("degree".to_owned(), json!(scene.scheme.degree));
        all.insert("time_degree".to_owned(), json!(scene.scheme.time_degree));
        all.insert("points".to_owned(), json!(body.cloud.len()));
        all.insert("norms".to_owned(), json!(norms(scheme, state, &body.material)));
        all.insert("kernel".to_owned(), json!(format!("{:?}", scheme.kernel).to_lowercase()));
        all.insert("status".to_owned(), json!(status));
        all.insert("provenance".to_owned(), provenance(scheme));
        if let Some(loss) = loss {
            all.insert("loss".to_owned(), loss);
        }
        let text = format!("{:#}\n", Value::Object(all));
        pending::write_text(&folder.summary(), &text)
    }
}

/// What made the results, and from what; the number of threads stands beside it.
fn provenance(scheme: &Scheme) -> Value {
    let (made_on, from) = (Fingerprint::of(scheme), Provenance::of(scheme));
    let all = from.attributes().into_iter().chain(made_on.attributes());
    Value::Object(all.map(|(key, text)| (key.to_owned(), json!(text))).collect())
}

fn error_json(errors: &Errors) -> Value {
    let mut all: serde_json::Map<String, Value> =
        errors.fields().iter().map(|(name, norms)| ((*name).to_owned(), json!(norms))).collect();
    all.insert("standard".to_owned(), json!(errors.standard));
    all.insert("standard_l1".to_owned(), json!(errors.standard_l1));
    Value::Object(all)
}
