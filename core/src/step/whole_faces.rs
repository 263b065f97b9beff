//! The flux at faces whose condition looks at them as a whole.

use super::block::Block;
use super::segments::MOST;
use crate::boundary::{FacePoint, Moment, WholeFace};
use crate::lane::F8;
use crate::mesh::map;
use crate::operators::Neighbour;
use crate::riemann::Trace;
use crate::state::UNKNOWNS;

impl Block<'_> {
    /// The flux at the points of the face of a lane, if its condition decides for all of them at once. `own`: the numbers of the points of the face.
    pub(super) fn flux_of_whole_face(
        &self,
        [face, lane]: [usize; 2],
        own: &[F8],
        memory: &mut [f64],
    ) -> Option<[[f64; UNKNOWNS]; MOST]> {
        let (scheme, line) = (self.scheme, &self.scheme.operators.line);
        let Neighbour::Boundary(group) = scheme.operators.blocks.neighbours[self.number][face][lane] else {
            return None;
        };
        if !scheme.boundaries[group].sees_faces() {
            return None;
        }
        let width = own.len() / line.m;
        let points = self.face_points(face, lane);
        let of = |(at, own): (&FacePoint, &[F8])| {
            let x = |k: usize| own[k].0[lane];
            let f = [x(0), x(1), x(2), x(3)];
            Trace { f, v: [x(4), x(5)], t: [x(6), x(7)], c: self.law().speeds(f, at.normal) }
        };
        let inside: Vec<_> = points.iter().zip(own.chunks_exact(width)).map(of).collect();
        let corners = scheme.operators.geometry.map_of(self.number, lane);
        let ends = [0.0, 1.0].map(|s| map::position(&corners, map::on_face(face, s)));
        let beyond = self.stage.obstacles.map_or([None; 2], |all| all.beyond([self.number, face, lane]));
        let bulge = corners.bulge.map_or([0.0; 2], |bulge| bulge[face]);
        let whole = WholeFace { ends, bulge, points: &points, inside: &inside, basis: &line.basis, beyond };
        let when = Moment { times: self.stage.times, dt: self.factor() };
        let memory = scheme.boundary_memory.of_face(memory, [self.number, face, lane], line.m);
        let mut flux = [[0.0; UNKNOWNS]; MOST];
        scheme.boundaries[group].face_flux(&whole, &when, memory, &mut flux[..line.m]).then_some(flux)
    }
}
