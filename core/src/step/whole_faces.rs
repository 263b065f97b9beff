//! The flux at faces whose condition looks at them as a whole.

use super::block::Block;
use super::segments::{MOST, on_face};
use crate::boundary::{FacePoint, Moment, WholeFace};
use crate::lane::{F8, LANES};
use crate::mesh::map;
use crate::operators::Neighbour;
use crate::riemann::Trace;
use crate::state::UNKNOWNS;

/// A lane, and the flux at the points of its face.
pub(super) type OfLane = (usize, [[f64; UNKNOWNS]; MOST]);

impl Block<'_> {
    /// The fluxes of the lanes of a face whose conditions decide for all points at once; mostly there are none. `own`: the numbers of the
    /// points of the face.
    pub(super) fn fluxes_of_whole_faces(&self, face: usize, own: &[F8], memory: &mut [f64]) -> Vec<OfLane> {
        let lanes = &self.scheme.operators.blocks.neighbours[self.number][face];
        let sees = |lane: &usize| match lanes[*lane] {
            Neighbour::Boundary(group) => self.scheme.boundaries[group].sees_faces(),
            _ => false,
        };
        (0..LANES).filter(sees).filter_map(|lane| self.flux_of_whole_face([face, lane], own, memory)).collect()
    }

    fn flux_of_whole_face(&self, [face, lane]: [usize; 2], own: &[F8], memory: &mut [f64]) -> Option<OfLane> {
        let (scheme, line) = (self.scheme, &self.scheme.operators.line);
        let Neighbour::Boundary(group) = scheme.operators.blocks.neighbours[self.number][face][lane] else {
            return None;
        };
        let width = own.len() / line.m;
        let points = self.face_points(face, lane);
        let of = |(at, own): (&FacePoint, &[F8])| {
            let x = |k: usize| own[k].0[lane];
            let f = [x(0), x(1), x(2), x(3)];
            Trace { f, v: [x(4), x(5)], t: [x(6), x(7)], c: self.law().speeds(f, at.normal) }
        };
        let inside: Vec<_> = points.iter().zip(own.chunks_exact(width)).map(of).collect();
        let corners = scheme.operators.geometry.map_of(self.number, lane);
        let ends = [0.0, 1.0].map(|s| map::position(&corners, on_face(face, s)));
        let beyond = self.stage.obstacles.map_or([None; 2], |all| all.beyond([self.number, face, lane]));
        let bulge = corners.bulge.map_or([0.0; 2], |bulge| bulge[face]);
        let whole = WholeFace { ends, bulge, points: &points, inside: &inside, basis: &line.basis, beyond };
        let when = Moment { times: self.stage.times, dt: self.factor() };
        let memory = scheme.boundary_memory.of_face(memory, [self.number, face, lane], line.m);
        let mut flux = [[0.0; UNKNOWNS]; MOST];
        scheme.boundaries[group].face_flux(&whole, &when, memory, &mut flux[..line.m]).then_some((lane, flux))
    }
}
