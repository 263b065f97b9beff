//! From cell to cell across faces towards a point: the short way where the next point is near the last one.

use crate::mesh::{Mesh, faces, map};

/// Cells on the way before the walk gives up: points that follow each other are cells apart, not bodies, and the hierarchy is as
/// fast as some ten cells that are not in the cache.
const STEPS: usize = 16;

/// A point nearer to a face than this part of the cell is left to the hierarchy, which looks at all cells that it touches.
const MARGIN: f64 = 1e-9;

/// A cell as the walk sees it.
#[derive(Debug, Clone, Copy)]
struct Stop {
    corners: map::Corners,
    /// Cells across its sides from corner k to corner k + 1; `NOWHERE` at the edge of the body.
    next: [usize; 4],
    /// A cross product of a side and the way to a point below which the point is too near to that side, m^2.
    margin: f64,
}

const NOWHERE: usize = usize::MAX;

/// Local faces in the order of the sides, counter-clockwise from corner 0.
const SIDES: [usize; 4] = [2, 1, 3, 0];

/// All cells with what is next to them.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    stops: Vec<Stop>,
}

impl Walk {
    /// Of a mesh with convex cells; `tolerance` gives how far outside of a cell a point still belongs to it, in parent
    /// coordinates.
    pub(super) fn new(mesh: &Mesh, tolerance: impl Fn(usize) -> f64) -> Self {
        let next = faces::neighbours(mesh);
        let stop = |cell: usize| {
            let corners = mesh.corners(cell);
            let longest = (0..4).map(|k| square(corners[k], corners[(k + 1) % 4])).fold(0.0, f64::max);
            let next = SIDES.map(|face| next[cell][face].unwrap_or(NOWHERE));
            Stop { corners, next, margin: MARGIN.max(1e3 * tolerance(cell)) * longest }
        };
        Self { stops: (0..mesh.cells.len()).map(stop).collect() }
    }

    /// The cell that holds a point well inside, from a cell nearby. None where the way leaves the body, is long, or ends
    /// near a face.
    pub(super) fn find(&self, from: usize, x: [f64; 2]) -> Option<(usize, [f64; 2])> {
        let mut cell = from;
        for _ in 0..STEPS {
            let stop = self.stops.get(cell)?;
            let (mut out, mut worst) = (0, f64::INFINITY);
            for k in 0..4 {
                let [a, b] = [stop.corners[k], stop.corners[(k + 1) % 4]];
                // Twice the area of the triangle of the side and the point: positive inside.
                let inside = (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
                if inside < worst {
                    (out, worst) = (k, inside);
                }
            }
            match worst {
                w if w > stop.margin && w.is_finite() => return Some((cell, map::parent(&stop.corners, x)?)),
                w if w < -stop.margin => cell = stop.next[out],
                _ => return None,
            }
        }
        None
    }
}

fn square(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}
