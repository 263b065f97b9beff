//! What a scene records: its observers, the fields of its export, and when each is due.

use crate::error::Result;
use crate::mesh::Mesh;
use crate::observe::{Contents, Field, Ledger, Line, Observer, Outside, Samples, Schedule, Snapshots};
use crate::run::Folder;
use crate::scene::{Output, Scene, What, When};
use crate::state::UNKNOWNS;

/// Steps between two rows of the ledger, where the scene does not say.
const LEDGER_STEPS: usize = 10;

impl Scene {
    /// Whether an output asks for the displacement: as a field, or for the angular momentum of a ledger.
    pub fn wants_displacement(&self) -> bool {
        let balance = |output: &Output| output.what == What::Ledger { balance: true };
        self.outputs.iter().any(|output| output.fields.contains(&Field::Displacement) || balance(output))
    }

    /// Components of the state: with the displacement where an output asks for it or the flux looks at it.
    pub(super) fn components(&self) -> usize {
        if self.wants_displacement() { UNKNOWNS + 2 } else { self.scheme.flux.build().components() }
    }

    /// Whether all lines of the outputs lie in the mesh.
    ///
    /// # Errors
    /// A line that leaves it, with its place in the scene.
    pub fn check_lines(&self, mesh: &Mesh) -> Result<()> {
        for (i, output) in self.outputs.iter().enumerate() {
            let Some(samples) = samples(output) else { continue };
            samples.check(mesh).map_err(|outside| {
                let key = if outside.sample == 0 { "from" } else { "to" };
                self.error(&format!("output.{i}.{key}"), outside.to_string(), Outside::REMEDY)
            })?;
        }
        Ok(())
    }

    /// The observers that the scene asks for, writing into a run folder; and a ledger in any case.
    ///
    /// # Errors
    /// A line that leaves the mesh ([`Scene::check_lines`] has its place); files that cannot be made.
    pub fn observers(&self, mesh: &Mesh, folder: &Folder) -> Result<Vec<Box<dyn Observer>>> {
        let material = self.material_of_cells(mesh);
        let dissipated = self.laws().iter().any(|law| law.has_memory());
        let drift = self.components() > UNKNOWNS;
        let contents = Contents { drift, dissipated, regrids: !self.regrids.is_empty(), balance: false };
        let mut out: Vec<Box<dyn Observer>> = Vec::new();
        for output in &self.outputs {
            let schedule = schedule(output);
            out.push(match (output.what, samples(output)) {
                (What::Ledger { balance }, _) => {
                    let contents = Contents { balance, ..contents };
                    Box::new(Ledger::create(&folder.ledger(), schedule.with_end(), contents)?)
                }
                (_, Some(samples)) => {
                    Box::new(Line::create(&folder.line(&output.name), mesh, &material, &samples, schedule)?)
                }
                _ => Box::new(Snapshots::new(&folder.snapshots(), schedule)),
            });
        }
        if !self.outputs.iter().any(|output| matches!(output.what, What::Ledger { .. })) {
            let schedule = Schedule::new(crate::observe::When::EverySteps(LEDGER_STEPS), false).with_end();
            out.push(Box::new(Ledger::create(&folder.ledger(), schedule, contents)?));
        }
        Ok(out)
    }

    /// The fields that an export shows: those of the first `fields` output, or all that the state has.
    pub fn export_fields(&self) -> Vec<Field> {
        let asked = self.outputs.iter().find(|output| output.what == What::Fields).map(|output| output.fields.clone());
        let laws = self.laws();
        let all = || Field::of_laws(&laws).into_iter().filter(|field| *field != Field::Displacement).collect();
        asked.unwrap_or_else(all)
    }
}

/// What a line output samples.
fn samples(output: &Output) -> Option<Samples> {
    let What::Line { from, to, samples } = output.what else { return None };
    Some(Samples { ends: [from, to], count: samples, fields: output.fields.clone() })
}

fn schedule(output: &Output) -> Schedule {
    schedule_of(&output.when, output.exact_times)
}

/// When something is done.
pub fn schedule_of(when: &When, exact: bool) -> Schedule {
    let when = match when {
        When::At(times) => crate::observe::When::At(times.clone()),
        When::Every(interval) => crate::observe::When::Every(*interval),
        When::EverySteps(steps) => crate::observe::When::EverySteps(*steps),
    };
    Schedule::new(when, exact)
}
