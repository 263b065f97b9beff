//! What a block sees at a face: the traces of both sides, and the other faces that it meets.

use super::across::{Beyond, Traces};
use super::meetings::Meetings;
use crate::lane::F8;

/// Where the faces of a block meet others in this step, and the traces there.
#[derive(Clone, Copy)]
pub(super) struct Met<'a> {
    /// The meetings of the step.
    pub meetings: &'a Meetings,
    /// All traces under way.
    pub traces: &'a Traces<'a>,
}

/// The traces of a face of a block, [point][width].
#[derive(Clone, Copy)]
pub(super) struct Sides<'a> {
    pub face: usize,
    pub own: &'a [F8],
    /// With its own normal; lanes at a boundary see themselves or what they must not use.
    pub other: &'a Beyond<'a>,
    /// What else faces of the block meet; none where no condition pairs faces.
    pub met: Option<Met<'a>>,
}

impl<'a> Sides<'a> {
    /// The own numbers of a point of a face that has `points`.
    #[inline(always)]
    pub fn of_point(&self, point: usize, points: usize) -> &'a [F8] {
        let width = self.own.len() / points;
        &self.own[point * width..][..width]
    }
}
