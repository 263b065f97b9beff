//! The force that a boundary exerts on the body.

use super::{Quantity, Seen};
use crate::boundary::{FacePoint, Moment, TimeNode, WholeFace};
use crate::error::Error;
use crate::mesh::{FACES, Mesh, map};
use crate::operators::Neighbour;
use crate::riemann::{Medium, Trace};
use crate::tensor::times;

/// int t*_k dS over the faces of a boundary group, N/m (per metre of thickness): t* is the traction that the condition of the
/// group answers the trace of the state with, at the Gauss points of its faces. Steps take t* of predicted traces between two states:
/// the mean over a run is that of the steps, the impulse that the body has received over the time, so that it is the balance of momentum
/// to rounding.
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
    fn of(&self, seen: &Seen) -> f64 {
        let blocks = &seen.scheme.operators.blocks;
        let mut memory = self.memory(seen);
        let mut force = 0.0;
        for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
            let own = |face: &usize| blocks.neighbours[block][*face][lane] == Neighbour::Boundary(self.group);
            (0..FACES).filter(own).for_each(|face| force += self.of_face(seen, cell, face, &mut memory));
        }
        force
    }

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

impl Force {
    /// The memory of the condition at the points of the group, in the order of cells, faces and points; mostly there is none.
    fn memory(&self, seen: &Seen) -> impl Iterator<Item = Vec<f64>> + use<> {
        let points = seen.scheme.points_with_memory().into_iter().filter(|point| point.group == self.group);
        let ranges: Vec<_> = points.map(|point| point.numbers).collect();
        let all = if ranges.is_empty() { vec![] } else { seen.scheme.boundary_memory_of(seen.state) };
        ranges.into_iter().map(move |range| all[range].to_vec())
    }

    /// The part of a face.
    fn of_face(&self, seen: &Seen, cell: usize, face: usize, memory: &mut impl Iterator<Item = Vec<f64>>) -> f64 {
        let (scheme, solution, time) = (seen.scheme, seen.solution(), seen.state.time);
        let (block, lane) = scheme.operators.blocks.slot[cell];
        let (metric, law) = (scheme.operators.geometry.of(block), solution.law(cell));
        let medium = Medium::new(law.density(), law.shear_modulus(), scheme.operators.degree);
        let times_of_step = [TimeNode { time, weight: 1.0 }];
        let when = Moment { times: &times_of_step, dt: 0.0 };
        let map = seen.mesh.map(cell);
        let trace = |(i, along): (usize, &f64)| {
            let (normal, _) = metric.at_face_of(lane, face, i);
            let point = solution.at(cell, map::on_face(face, *along));
            let (f, t) = (point.deformation, times(point.response(law).piola, normal));
            Trace { f, v: point.velocity, t, c: law.speeds(f, normal) }
        };
        let basis = &solution.basis;
        let inside: Vec<_> = basis.nodes.iter().enumerate().map(trace).collect();
        let place = |along: f64| map::position(&map, map::on_face(face, along));
        let at = |(i, s): (usize, &f64)| FacePoint { x: place(*s), normal: metric.at_face_of(lane, face, i).0, medium };
        let points: Vec<_> = basis.nodes.iter().enumerate().map(at).collect();
        let mut own: Vec<_> = points.iter().map(|_| memory.next().unwrap_or_default()).collect();
        let bulge = map.bulge.map_or([0.0; 2], |bulge| bulge[face]);
        let (condition, mut flux) = (&scheme.boundaries[self.group], vec![[0.0; 6]; points.len()]);
        let whole = WholeFace {
            ends: [place(0.0), place(1.0)],
            bulge,
            points: &points,
            inside: &inside,
            basis,
            beyond: [None; 2],
        };
        if !condition.sees_faces() || !condition.face_flux(&whole, &when, &mut own.concat(), &mut flux) {
            for (i, flux) in flux.iter_mut().enumerate() {
                *flux = condition.flux(&inside[i], &points[i], &when, &mut own[i]);
            }
        }
        // The flux of momentum is -t*.
        let length = |i: usize| metric.at_face_of(lane, face, i).1;
        let weights = basis.weights.iter().enumerate();
        weights.zip(flux).map(|((i, weight), flux)| -weight * length(i) * flux[4 + self.axis]).sum()
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
