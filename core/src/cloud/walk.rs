//! A walk from cell to cell across faces towards a point. It is fast if the point is near the one before.

use crate::mesh::map::{self, Bulge, CellMap};
use crate::mesh::{Mesh, faces};

/// The walk gives up after so many cells. Two points that follow each other are usually few cells apart, and the
/// hierarchy takes as long as a walk over some ten cells that are not in the cache.
const STEPS: usize = 16;

/// A point that is nearer to a face than this part of the cell is left to the hierarchy, which tests all cells that the
/// point touches.
const MARGIN: f64 = 1e-9;

/// A cell in the walk.
#[derive(Debug, Clone, Copy)]
struct Stop {
    corners: map::Corners,
    /// The neighbour at its side from corner k to corner k + 1; `NOWHERE` at the edge of the body.
    next: [usize; 4],
    /// The limit, m^2, for the cross product of a side and the vector to a point. Below it the point is too near to
    /// this side.
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
    /// The cells of a mesh with convex cells. A point that is up to `tolerance` outside a cell, in parent coordinates, still
    /// belongs to it.
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

    /// The cell that has the point well inside, found from a cell nearby. `None` if the way leaves the body, is long,
    /// or ends near a face.
    pub(super) fn find(&self, from: usize, x: [f64; 2], bulges: &[Bulge]) -> Option<(usize, [f64; 2])> {
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
                w if w > stop.margin && w.is_finite() => {
                    let map = CellMap { corners: stop.corners, bulge: map::bulge_in(bulges, cell) };
                    let xi = map::parent(&map, x)?;
                    // Between its corners a point may still lie beyond a curved edge.
                    let inside = xi.iter().all(|xi| (MARGIN..=1.0 - MARGIN).contains(xi));
                    return (map.bulge.is_none() || inside).then_some((cell, xi));
                }
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
