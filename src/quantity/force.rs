//! The force that a boundary exerts on the body.

use super::extent::on_face;
use super::{Quantity, Seen};
use crate::boundary::{FacePoint, Moment, TimeNode};
use crate::mesh::{FACES, map};
use crate::operators::Neighbour;
use crate::riemann::{Medium, Trace};
use crate::tensor::times;

/// int t*_k dS over the faces of a boundary group, N/m (per metre of thickness): t* is the traction that the condition of the
/// group answers the trace of the body with. The steps take the same t*.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Force {
    /// The boundary group of the mesh, by number.
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
        let metric = scheme.operators.geometry.blocks[block].lane(lane);
        let (normal, length, law) = (metric.normal(face), metric.length(face), solution.law(cell));
        let medium = Medium::new(law.density(), law.shear_modulus(), scheme.operators.degree);
        let times_of_step = [TimeNode { time, weight: 1.0 }];
        let when = Moment { times: &times_of_step, dt: 0.0 };
        let mut force = 0.0;
        for (&along, weight) in solution.basis.nodes.iter().zip(&solution.basis.weights) {
            let xi = on_face(face, along);
            let point = solution.at(cell, xi);
            let (f, t) = (point.deformation, times(point.response(law).piola, normal));
            let inside = Trace { f, v: point.velocity, t, c: law.speeds(f, normal) };
            let at = FacePoint { x: map::position(&seen.mesh.corners(cell), xi), normal, medium };
            let mut own = memory.next().unwrap_or_default();
            let flux = scheme.boundaries[self.group].flux(&inside, &at, &when, &mut own);
            // The flux of momentum is -t*.
            force -= weight * length * flux[4 + self.axis];
        }
        force
    }
}
