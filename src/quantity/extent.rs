//! How far the body reaches along an axis, in its current configuration.

use super::places::with_ends;
use super::{Places, Quantity, Seen};
use crate::error::Error;
use crate::mesh::{FACES, Mesh, map};
use crate::operators::Neighbour;

/// max x_k - min x_k over the boundary or over places, x = X + u; m.
#[derive(Debug, Clone, PartialEq)]
pub struct Extent {
    /// 0 for x, 1 for y.
    pub axis: usize,
    /// Where to look; none: on the whole boundary, where a body is widest.
    pub at: Option<Places>,
}

impl Quantity for Extent {
    fn of(&self, seen: &Seen) -> f64 {
        match &self.at {
            Some(at) => self.span(seen, at.all.iter().map(|place| (place.cell, place.xi))),
            None => self.span(seen, boundary(seen).into_iter()),
        }
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        match &mut self.at {
            Some(at) => Ok(at.move_to(mesh)?),
            None => Ok(()),
        }
    }
}

impl Extent {
    /// max - min over points of cells; NaN without any, as along the axis of a periodic body.
    fn span(&self, seen: &Seen, points: impl Iterator<Item = (usize, [f64; 2])>) -> f64 {
        let (solution, mut low, mut high) = (seen.solution(), f64::INFINITY, f64::NEG_INFINITY);
        for (cell, xi) in points {
            let x = map::position(&seen.mesh.map(cell), xi)[self.axis];
            let now = x + solution.at(cell, xi).displacement[self.axis];
            (low, high) = (low.min(now), high.max(now));
        }
        if low <= high { high - low } else { f64::NAN }
    }
}

/// The nodes and ends of all faces on the boundary.
fn boundary(seen: &Seen) -> Vec<(usize, [f64; 2])> {
    let (line, blocks) = (with_ends(&seen.solution().basis.nodes), &seen.scheme.operators.blocks);
    let mut out = Vec::new();
    for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
        let outside = |face: &usize| matches!(blocks.neighbours[block][*face][lane], Neighbour::Boundary(_));
        for face in (0..FACES).filter(outside) {
            out.extend(line.iter().map(|&along| (cell, map::on_face(face, along))));
        }
    }
    out
}
