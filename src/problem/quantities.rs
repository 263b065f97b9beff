//! The quantities of interest of a scene.

use super::Problem;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::quantity::{Gauge, Named, Seen};
use crate::registry::quantities::Start;
use crate::scene::Scene;

impl Scene {
    /// Whether the mesh has what the quantities look at.
    ///
    /// # Errors
    /// A point outside of the mesh or a group that it lacks, with its place in the scene.
    pub fn check_quantities(&self, mesh: &Mesh) -> Result<()> {
        for (i, quantity) in self.quantities.iter().enumerate() {
            let check = (quantity.what.build().check)(&quantity.what.values, mesh);
            check.map_err(|fault| self.error(&format!("quantity.{i}.{}", fault.key), fault.what, fault.remedy))?;
        }
        Ok(())
    }
}

impl Problem {
    /// The observer of the quantities of the scene, from its present state on; none where the scene names none.
    ///
    /// # Errors
    /// What the mesh lacks ([`Scene::check_quantities`]), or a time before the present state.
    pub fn gauge(&self) -> Result<Option<Gauge>> {
        let Self { scene, body, scheme, state, .. } = self;
        if scene.quantities.is_empty() {
            return Ok(None);
        }
        scene.check_quantities(&body.mesh)?;
        let (seen, exact) = (Seen::new(&body.mesh, scheme, state, &body.material), scene.build_exact());
        let start = Start { seen: &seen, exact: exact.as_ref() };
        let named = scene.quantities.iter().enumerate().map(|(i, quantity)| {
            if quantity.when.is_before(state.time) && self.resumed.is_none() {
                let what = format!("`time` is before the start of the run, {:e} s", state.time);
                return Err(scene.error(&format!("quantity.{i}.time"), what, "give a later time"));
            }
            let (kind, values) = (quantity.what.build(), &quantity.what.values);
            let (unit, made) = ((kind.unit)(values), (kind.make)(values, &start)?);
            Ok(Named { name: quantity.name.clone(), unit, when: quantity.when, quantity: made })
        });
        let named = named.collect::<Result<Vec<_>>>()?;
        Ok(Some(Gauge::new(named, &body.material, exact)))
    }
}
