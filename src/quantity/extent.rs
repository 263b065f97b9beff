//! How far the body reaches along an axis, in its current configuration.

use super::places::with_ends;
use super::{Quantity, Seen};
use crate::mesh::{FACES, map};
use crate::operators::Neighbour;

/// max x_k - min x_k over the boundary, x = X + u; m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// 0 for x, 1 for y.
    pub axis: usize,
}

/// The parent coordinates of a point of a face.
pub(super) fn on_face(face: usize, along: f64) -> [f64; 2] {
    let end = (face % 2) as f64;
    if face < 2 { [end, along] } else { [along, end] }
}

impl Quantity for Extent {
    fn of(&self, seen: &Seen) -> f64 {
        let (solution, blocks) = (seen.solution(), &seen.scheme.operators.blocks);
        let line = with_ends(&solution.basis.nodes);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
            let outside = |face: &usize| matches!(blocks.neighbours[block][*face][lane], Neighbour::Boundary(_));
            for face in (0..FACES).filter(outside) {
                for &along in &line {
                    let xi = on_face(face, along);
                    let x = map::position(&seen.mesh.corners(cell), xi)[self.axis];
                    let now = x + solution.at(cell, xi).displacement[self.axis];
                    (low, high) = (low.min(now), high.max(now));
                }
            }
        }
        // A periodic body has no boundary along the axis.
        if low <= high { high - low } else { f64::NAN }
    }
}
