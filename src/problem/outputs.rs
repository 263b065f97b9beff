//! What a scene records: its observers, the fields of its export, and when each is due.

use super::Problem;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::observe::{Contents, Field, Observer, Schedule};
use crate::registry::outputs::{Recording, fields_of};
use crate::registry::{self, Chosen, Entry, OUTPUTS, defaults};
use crate::run::Folder;
use crate::scene::{Boundary, Output, Quantity, Scene, When};
use crate::state::UNKNOWNS;

impl Scene {
    /// Whether an output or a quantity asks for the displacement: as a field, for the angular momentum of a ledger, for a length; and
    /// where faces meet others, which takes their current positions.
    pub fn wants_displacement(&self) -> bool {
        let laws = self.laws();
        let wants = |output: &Output| {
            let shown = fields_of(&output.what, &laws).contains(&Field::Displacement);
            shown || (output.what.build().displacement)(&output.what.values)
        };
        let needs = |quantity: &Quantity| (quantity.what.build().displacement)(&quantity.what.values);
        let meets = |boundary: &Boundary| boundary.condition.build().between.is_some();
        let turns = self.scheme.angular_momentum;
        turns
            || self.outputs.iter().any(wants)
            || self.quantities.iter().any(needs)
            || self.boundaries.iter().any(meets)
    }

    /// The fields that an output shows.
    pub fn fields_of(&self, output: &Output) -> Vec<Field> {
        fields_of(&output.what, &self.laws())
    }

    /// Components of the state: with the displacement where an output or a quantity asks for it or the flux looks at it.
    pub(super) fn components(&self) -> usize {
        if self.wants_displacement() { UNKNOWNS + 2 } else { (self.scheme.flux.build().make)().components() }
    }

    /// Whether the mesh has what the outputs record.
    ///
    /// # Errors
    /// A line that leaves it, with its place in the scene.
    pub fn check_lines(&self, mesh: &Mesh) -> Result<()> {
        for (i, output) in self.outputs.iter().enumerate() {
            self.check_joined(i, (output.what.build().conditions)(&output.what.values))?;
            let check = (output.what.build().check)(&output.what.values, mesh);
            check.map_err(|fault| self.error(&format!("output.{i}.{}", fault.key), fault.what, fault.remedy))?;
        }
        Ok(())
    }

    /// Whether a condition acts on the groups that an output looks at: the faces of periodic groups are inner faces.
    fn check_joined(&self, output: usize, groups: &[String]) -> Result<()> {
        let is_joined = |name: &String| {
            let joined = self.boundaries.iter().filter(|boundary| boundary.is_joined());
            joined.flat_map(Boundary::groups).any(|group| group == name)
        };
        let Some(k) = groups.iter().position(is_joined) else { return Ok(()) };
        let what = format!("\"{}\" is periodic: no condition acts there", groups[k]);
        Err(self.error(&format!("output.{output}.groups.{k}"), what, "name a group with a condition"))
    }

    /// The fields that an export shows: those of the first `fields` output, or all that the state has.
    pub fn export_fields(&self) -> Vec<Field> {
        let (laws, snapshots) = (self.laws(), self.outputs.iter().find(|output| output.what.build().snapshots));
        let all = || Field::of_laws(&laws).into_iter().filter(|field| *field != Field::Displacement).collect();
        snapshots.map_or_else(all, |output| fields_of(&output.what, &laws))
    }
}

impl Problem {
    /// The observers that the scene asks for, writing into a run folder; and a ledger in any case.
    ///
    /// # Errors
    /// A line that leaves the mesh ([`Scene::check_lines`] has its place); files that cannot be made.
    pub fn observers(&self, folder: &Folder) -> Result<Vec<Box<dyn Observer>>> {
        let Self { scene, body, scheme, state, .. } = self;
        let contents = Contents {
            drift: state.has_displacement(),
            springs: scheme.has_springs(),
            dissipated: !scheme.histories.is_empty(),
            regrids: !scene.regrids.is_empty(),
            contact: scheme.has_contacts(),
            corrections: !scheme.corrections.is_empty() || scheme.rescue.is_some() || scheme.keeps_angular_momentum(),
            balance: false,
        };
        let (mesh, material) = (&body.mesh, &body.material[..]);
        let materials =
            scene.materials.iter().map(|material| material.group.clone().unwrap_or_else(|| "body".to_owned()));
        let materials: Vec<String> = materials.collect();
        let make = |name: &str, what: &Chosen<_>, schedule: Schedule| {
            let fields = fields_of(what, &scheme.laws);
            let materials = materials.clone();
            let to = Recording { name, fields, schedule, mesh, scheme, material, materials, folder, contents };
            (what.build().make)(&what.values, to)
        };
        let mut out: Vec<Box<dyn Observer>> = Vec::new();
        for output in &scene.outputs {
            out.push(make(&output.name, &output.what, schedule_of(&output.when, output.exact_times))?);
        }
        for entry in always(scene) {
            let Some(always) = entry.build.always else { continue };
            let mut values = defaults(entry.parameters, scene.scheme.degree);
            let schedule = schedule_of(&When::EverySteps(always(&mut values)), false);
            out.push(make(entry.name, &Chosen { entry, values }, schedule)?);
        }
        Ok(out)
    }
}

/// The outputs that every run has, and this scene does not name.
pub(super) fn always(scene: &Scene) -> impl Iterator<Item = &'static Entry<registry::outputs::Output>> {
    let named = |name: &str| scene.outputs.iter().any(|output| output.what.name() == name);
    OUTPUTS.iter().filter(move |entry| entry.build.always.is_some() && !named(entry.name))
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
