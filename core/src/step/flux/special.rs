//! The faces of blocks that have more than others: springs ([`super::super::creep`]), cells with curved edges, or a law of the small strain.
//!
//! A kernel of their own, so that all other blocks pay nothing for them. As a branch in the loops of [`Faces`] they took 12 % more
//! instructions there, with neither in the scene: a metric that may lie in memory or not is no longer kept in registers.

use super::super::across::{Beyond, LaneByLane, Other};
use super::super::block_work::FluxWork;
use super::super::creep::Springs;
use super::super::trace::{held, trace_of, turn, turned, with_width};
use super::super::volume::width;
use super::{Faces, with_other};
use crate::lane::{Lanes, load_array, store_array};
use crate::mesh::FACES;
use crate::operators::BlockMetric;
use crate::riemann::{Looks, Riemann};
use crate::state::UNKNOWNS;

/// The four faces of such a block.
pub(in crate::step) struct SpecialFaces<'a> {
    /// What all blocks have.
    pub faces: Faces<'a>,
    /// The metric terms as they are.
    pub metric: BlockMetric<'a>,
    /// The springs of the faces; none where they have none.
    pub springs: Option<Springs<'a>>,
}

impl FluxWork for SpecialFaces<'_> {
    #[inline(always)]
    fn run<L: Lanes, R: Riemann>(mut self, riemann: &R) {
        with_width!(R::LOOKS, self.faces.metered, W => {
            for face in 0..FACES {
                with_other!(L, W, self.faces.other[face], other => self.of_face::<L, _, _, W>(face, other, riemann));
            }
        });
    }
}

impl SpecialFaces<'_> {
    #[inline(always)]
    fn of_face<L: Lanes, O: Other, R: Riemann, const W: usize>(&mut self, face: usize, other: O, riemann: &R) {
        let faces = &mut self.faces;
        let m = faces.points;
        let mut medium = faces.medium.splat::<L>();
        let own = &faces.own.as_chunks::<W>().0[face * m..(face + 1) * m];
        if R::LOOKS == Looks::Displacement {
            medium.turn = turn::<L, O, W>(own, &other, faces.turning);
        }
        let lift = &mut faces.lift.as_chunks_mut::<UNKNOWNS>().0[m * face..m * (face + 1)];
        let [runs, points] = self.metric.runs(m);
        for run in 0..runs {
            let (normal, length) = self.metric.at_face::<L>(face, run);
            // No closures in kernels, see `lane`.
            let mut springs = match (R::LOOKS, &mut self.springs) {
                (Looks::Displacement, Some(springs)) => {
                    let inverse = self.metric.inverse_length::<L>(face, run);
                    Some((springs.pull.face::<L, O, W>(own, &other, (normal, inverse)), springs))
                }
                _ => None,
            };
            for point in run * points..(run + 1) * points {
                let minus = trace_of::<L, R, W>(&load_array::<L, W>(&own[point]));
                let there = turned::<L, R, W>(other.load::<L, W>(point));
                let plus = trace_of::<L, R, W>(&there);
                if R::LOOKS == Looks::Displacement {
                    let held = held(&load_array::<L, W>(&own[point]), &there, faces.medium.density);
                    store_array(held, &mut faces.held.as_chunks_mut::<2>().0[m * face + point]);
                }
                let (mut lifted, twice) = riemann.lifted_and_admittance(&minus, &plus, normal, &medium, length);
                if let Some((of_face, springs)) = &mut springs {
                    let admittance = L::splat(0.5) * twice;
                    springs.act(m * face + point, of_face, [&minus, &plus], admittance, &mut lifted);
                }
                store_array(lifted, &mut lift[point]);
            }
        }
    }
}
