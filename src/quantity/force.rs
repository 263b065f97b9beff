//! The force that a boundary group receives.

use super::{Quantity, Seen};
use crate::error::Error;
use crate::mesh::Mesh;

/// int t*_k dS over the faces of a boundary group, N/m (per metre of thickness): t* is the traction of the corrector's own fluxes, of the condition
/// or of what the group touches. It is known of steps, not of states: the force at a time is the mean over the step that the time lies in, and
/// the mean over a run is the impulse that the body has received over the time, so that it is the balance of momentum to rounding. The
/// output `force` has the same numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Force {
    /// The name of the boundary group.
    pub name: String,
    /// Its number in the mesh.
    pub group: usize,
    /// 0 for the force along x, 1 along y.
    pub axis: usize,
}

impl Quantity for Force {
    fn integral(&self, seen: &Seen) -> Option<f64> {
        seen.state.received.get(self.group).map(|group| group.impulse[self.axis])
    }

    fn is_metered(&self) -> bool {
        true
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        // Another mesh may have its groups in another order.
        let found = mesh.edge_groups.iter().position(|name| *name == self.name);
        self.group = found.ok_or_else(|| {
            let what = format!("the new mesh has no group \"{}\", whose force is a quantity", self.name);
            Error::input(what, "give the boundary its old name in the new mesh")
        })?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_is_found_by_its_name_on_a_mesh_with_its_groups_in_another_order() {
        let mut mesh = crate::mesh::rectangle([1.0, 1.0], [1, 1]).unwrap();
        let group = mesh.edge_groups.iter().position(|name| name == "left").unwrap();
        let mut force = Force { name: "left".to_owned(), group, axis: 0 };
        mesh.edge_groups.reverse();
        force.moved(&mesh).unwrap();
        assert_eq!(mesh.edge_groups[force.group], "left");
        mesh.edge_groups[force.group] = "other".to_owned();
        assert!(force.moved(&mesh).unwrap_err().to_string().contains("no group \"left\""));
    }
}
