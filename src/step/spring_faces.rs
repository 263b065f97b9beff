//! The springs of the faces of a block, by themselves: a run without springs knows nothing of them.

use super::across::{Beyond, Other};
use super::block_work::FluxWork;
use super::creep::Springs;
use super::trace::{trace_of, turned, with_width};
use super::volume::width;
use crate::lane::{F8, Lanes, load_array};
use crate::mesh::FACES;
use crate::operators::BlockMetric;
use crate::riemann::{Looks, Medium, Riemann};
use crate::state::UNKNOWNS;

/// Takes the pull of the springs out of what the faces of a block have lifted, and moves the faces; all lanes as faces between cells of
/// one law.
pub(super) struct SpringFaces<'a> {
    pub metered: bool,
    /// Own traces, [face][point][width].
    pub own: &'a [F8],
    /// The other side's, by face, with its own normal.
    pub other: &'a [Beyond<'a>; FACES],
    pub metric: BlockMetric<'a>,
    /// Points of a face.
    pub points: usize,
    pub medium: Medium<f64>,
    pub springs: Springs<'a>,
    /// [face][point][6], in and out.
    pub lift: &'a mut [F8],
}

impl FluxWork for SpringFaces<'_> {
    #[inline(always)]
    fn run<L: Lanes, R: Riemann>(self, riemann: &R) {
        if R::LOOKS == Looks::Displacement {
            with_width!(R::LOOKS, self.metered, W => self.with::<L, R, W>(riemann));
        }
    }
}

impl SpringFaces<'_> {
    #[inline(always)]
    fn with<L: Lanes, R: Riemann, const W: usize>(mut self, riemann: &R) {
        let (metric, medium) = (self.metric, self.medium.splat::<L>());
        let (own, lift) = (self.own.as_chunks::<W>().0, self.lift.as_chunks_mut::<UNKNOWNS>().0);
        for face in 0..FACES {
            for point in 0..self.points {
                let (normal, length) = metric.at_face::<L>(face, point);
                let at = self.points * face + point;
                let minus = trace_of::<L, R, W>(&load_array::<L, W>(&own[at]));
                let plus = trace_of::<L, R, W>(&turned::<L, R, W>(self.other[face].load::<L, W>(point)));
                self.springs.act(at, riemann, [&minus, &plus], (normal, length), &medium, &mut lift[at]);
            }
        }
    }
}
