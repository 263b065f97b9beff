//! Finds the cell of any point: first by a walk from the cell of the point before; if this fails, by a bounding volume
//! hierarchy (a tree of boxes) over the cells. Then the inverse map gives its parent coordinates.

use rayon::prelude::*;

use super::Cloud;
use super::walk::Walk;
use crate::mesh::{Mesh, map};

/// Points that are this far outside a cell, in parent coordinates, still belong to it. Corners and edges are computed
/// to a few 1e-16, and a point on the outer boundary must not be lost.
const TOLERANCE: f64 = 1e-12;

/// Cells in a leaf of the hierarchy. CPU s for 1e6 points in 1e6 cells, in random order and row by row: 2.7 and .67 with 2,
/// 2.1 and .63 with 4, 2.2 and .82 with 8, 2.2 and 1.2 with 16.
const LEAF: usize = 4;

/// Points that lie in no cell.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{count} point(s) of the cloud lie outside the mesh, the first is point {first} at ({}, {}); the mesh fills [{}, {}] x [{}, {}]",
    .at[0], .at[1], .extent[0][0], .extent[1][0], .extent[0][1], .extent[1][1])]
pub struct Outside {
    /// How many.
    pub count: usize,
    /// Index of the first, from 0.
    pub first: usize,
    /// The position of the first, in m.
    pub at: [f64; 2],
    /// Lower left and upper right corner of the mesh, in m.
    pub extent: [[f64; 2]; 2],
}

impl From<Outside> for crate::Error {
    fn from(outside: Outside) -> Self {
        let remedy =
            "give points inside the mesh, in metres and in the initial configuration, or a mesh that covers them";
        crate::Error::input(outside.to_string(), remedy)
    }
}

/// A box from its lower left to its upper right corner.
#[derive(Debug, Clone, Copy)]
struct Extent {
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    const EMPTY: Extent = Extent { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn join(self, x: [f64; 2], y: [f64; 2]) -> Self {
        let low = [0, 1].map(|i| self.low[i].min(x[i]).min(y[i]));
        let high = [0, 1].map(|i| self.high[i].max(x[i]).max(y[i]));
        Extent { low, high }
    }

    fn meets(&self, low: [f64; 2], high: [f64; 2]) -> bool {
        (0..2).all(|i| self.low[i] <= high[i] && low[i] <= self.high[i])
    }

    fn has(&self, x: [f64; 2]) -> bool {
        (self.low[0] <= x[0] && x[0] <= self.high[0]) && (self.low[1] <= x[1] && x[1] <= self.high[1])
    }
}

/// A cell in the hierarchy.
#[derive(Debug, Clone, Copy)]
struct Entry {
    corners: map::Corners,
    cell: usize,
    /// In parent coordinates.
    tolerance: f64,
}

impl Entry {
    fn new(corners: map::Corners, cell: usize) -> Self {
        let far = corners.iter().flatten().fold(0.0, |far: f64, x| far.max(x.abs()));
        // Far from the origin coordinates are rounded by eps |x|. In parent coordinates this is eps |x| / h.
        let tolerance = TOLERANCE.max(16.0 * f64::EPSILON * far / map::h_e(&corners));
        Self { corners, cell, tolerance }
    }

    fn extent(&self) -> Extent {
        let tight = self.corners.iter().fold(Extent::EMPTY, |extent, &x| extent.join(x, x));
        let margin = [0, 1].map(|i| 2.0 * self.tolerance * (tight.high[i] - tight.low[i]));
        Extent {
            low: [tight.low[0] - margin[0], tight.low[1] - margin[1]],
            high: [tight.high[0] + margin[0], tight.high[1] + margin[1]],
        }
    }

    /// Parent coordinates of a point that belongs to the closed cell.
    fn holds(&self, x: [f64; 2]) -> Option<[f64; 2]> {
        let inside = |xi: &f64| (-self.tolerance..=1.0 + self.tolerance).contains(xi);
        let xi = map::parent(&self.corners, x)?;
        xi.iter().all(inside).then(|| xi.map(|xi| xi.clamp(0.0, 1.0)))
    }
}

/// A node of the hierarchy. Its left child follows it in the list.
#[derive(Debug, Clone, Copy)]
struct Node {
    extent: Extent,
    right: usize,
}

/// Finds cells by position. It keeps its own copy of the corners.
#[derive(Debug, Clone)]
pub struct Locator {
    entries: Vec<Entry>,
    /// A balanced binary tree in depth-first order. Each node covers a run of entries; each of its two children covers
    /// half of it.
    nodes: Vec<Node>,
    walk: Walk,
}

impl Locator {
    /// A locator of a mesh with convex cells ([`Mesh::checked`]).
    pub fn new(mesh: &Mesh) -> Self {
        let mut entries: Vec<_> = (0..mesh.cells.len()).map(|cell| Entry::new(mesh.corners(cell), cell)).collect();
        let walk = Walk::new(mesh, |cell| entries[cell].tolerance);
        let mut nodes = Vec::new();
        build(&mut entries, &mut nodes);
        Self { entries, nodes, walk }
    }

    /// As [`Locator::find`], but faster if the given cell is near the point. The result is the same to the bit.
    pub fn find_from(&self, near: usize, x: [f64; 2]) -> Option<(usize, [f64; 2])> {
        self.walk.find(near, x).or_else(|| self.find(x))
    }

    /// The cell of a point and its parent coordinates in [0, 1]^2, or `None` outside of the mesh.
    ///
    /// A cell includes its edges. A point on an edge or a corner belongs to the cell with the lowest index of all cells
    /// that it touches.
    pub fn find(&self, x: [f64; 2]) -> Option<(usize, [f64; 2])> {
        let mut best: Option<(usize, [f64; 2])> = None;
        // Nodes still to be seen, with their entries: at most one beside each level of the tree, and levels are
        // fewer than the bits of a count.
        let mut stack = [(0, 0, 0); usize::BITS as usize + 1];
        stack[0] = (0, 0, self.entries.len());
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let (node, a, b) = stack[open];
            let Node { extent, right } = self.nodes[node];
            if !extent.has(x) {
                continue;
            }
            if b - a <= LEAF {
                for entry in &self.entries[a..b] {
                    if best.is_none_or(|(cell, _)| entry.cell < cell) {
                        best = entry.holds(x).map(|xi| (entry.cell, xi)).or(best);
                    }
                }
                continue;
            }
            let middle = a.midpoint(b);
            stack[open] = (node + 1, a, middle);
            stack[open + 1] = (right, middle, b);
            open += 2;
        }
        best
    }
}

impl Locator {
    /// Appends the cells whose boxes meet the box from `low` to `high`, in no particular order.
    pub fn overlapping(&self, low: [f64; 2], high: [f64; 2], out: &mut Vec<usize>) {
        let mut stack = [(0, 0, 0); usize::BITS as usize + 1];
        stack[0] = (0, 0, self.entries.len());
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let (node, a, b) = stack[open];
            let Node { extent, right } = self.nodes[node];
            if !extent.meets(low, high) {
                continue;
            }
            if b - a <= LEAF {
                let meets = self.entries[a..b].iter().filter(|entry| entry.extent().meets(low, high));
                out.extend(meets.map(|entry| entry.cell));
                continue;
            }
            let middle = a.midpoint(b);
            stack[open] = (node + 1, a, middle);
            stack[open + 1] = (right, middle, b);
            open += 2;
        }
    }
}

fn build(entries: &mut [Entry], nodes: &mut Vec<Node>) {
    let join = |extent: Extent, entry: &Entry| {
        let own = entry.extent();
        extent.join(own.low, own.high)
    };
    let extent = entries.iter().fold(Extent::EMPTY, join);
    let node = nodes.len();
    nodes.push(Node { extent, right: 0 });
    if entries.len() > LEAF {
        let axis = usize::from(extent.high[1] - extent.low[1] > extent.high[0] - extent.low[0]);
        let key = |entry: &Entry| entry.corners.iter().map(|x| x[axis]).sum::<f64>();
        let middle = entries.len() / 2;
        entries.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cell.cmp(&b.cell)));
        let (left, right) = entries.split_at_mut(middle);
        build(left, nodes);
        nodes[node].right = nodes.len();
        build(right, nodes);
    }
}

/// Rounds a parent coordinate to 2^-40 (1e-12 of the cell). Cells whose points agree up to the rounding of positions
/// then have the same points to the bit, and share matrices.
pub(crate) fn on_lattice(xi: f64) -> f64 {
    const STEPS: f64 = (1_u64 << 40) as f64;
    (xi * STEPS).round() / STEPS
}

/// Points that a thread locates one after the other, each from the cell of the one before.
const RUN: usize = 1024;

/// The cell of each point, as [`Locator::find`] gives it. The points are taken along a Z-curve, in any given order. CPU
/// s for 1e6 points in 6e4 (2.5e5) cells .36 (.50) where they come by cells and .61 (.72) in random order; by the
/// hierarchy alone 1.2 (1.5) and 2.6 (3.5).
pub fn find_all(locator: &Locator, points: &[[f64; 2]]) -> Vec<Option<(usize, [f64; 2])>> {
    let extent = points.iter().fold(Extent::EMPTY, |extent, &x| extent.join(x, x));
    let mut order: Vec<(u32, usize)> = points.par_iter().map(|&x| z_curve(&extent, x)).zip(0..points.len()).collect();
    order.par_sort_unstable();
    let run = |order: &[(u32, usize)]| {
        let mut near = usize::MAX;
        let found = order.iter().map(|&(_, index)| {
            let found = locator.find_from(near, points[index]);
            near = found.map_or(near, |(cell, _)| cell);
            (index, found)
        });
        found.collect::<Vec<_>>()
    };
    let found: Vec<_> = order.par_chunks(RUN).flat_map_iter(run).collect();
    let mut out = vec![None; points.len()];
    found.into_iter().for_each(|(index, found)| out[index] = found);
    out
}

/// The place of a point on a Z-curve through 2^16 x 2^16 parts of an extent: the bits of both coordinates in turn.
fn z_curve(extent: &Extent, x: [f64; 2]) -> u32 {
    let spread = |i: usize| {
        let share = (x[i] - extent.low[i]) / (extent.high[i] - extent.low[i]);
        // NaN becomes 0.
        let mut bits = (share * 65535.0) as u16 as u32;
        for (shift, mask) in [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)] {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    spread(0) | spread(1) << 1
}

/// The cloud of located points, and for each point of the cloud its number in the given list. Points of a cell keep
/// their order.
pub fn sorted(cells: usize, found: impl Iterator<Item = Option<(usize, [f64; 2])>>) -> (Cloud, Vec<usize>) {
    let located = found.enumerate().filter_map(|(index, found)| found.map(|(cell, xi)| (cell, index, xi)));
    let mut located: Vec<_> = located.collect();
    located.sort_unstable_by_key(|&(cell, index, _)| (cell, index));
    let mut first = vec![0; cells + 1];
    located.iter().for_each(|(cell, _, _)| first[cell + 1] += 1);
    for cell in 0..cells {
        first[cell + 1] += first[cell];
    }
    let cloud = Cloud { first, xi: located.iter().map(|&(_, _, xi)| xi.map(on_lattice)).collect() };
    (cloud, located.iter().map(|&(_, index, _)| index).collect())
}

/// The cloud of points given by their positions X, in m, and for each point of the cloud its index in `points`.
/// Points of a cell keep their order; parent coordinates are exact to 2^-41 (5e-13).
pub fn from_points(mesh: &Mesh, locator: &Locator, points: &[[f64; 2]]) -> Result<(Cloud, Vec<usize>), Outside> {
    let found = find_all(locator, points);
    if let Some(first) = found.iter().position(Option::is_none) {
        let count = found.iter().filter(|f| f.is_none()).count();
        let extent = mesh.nodes.iter().fold(Extent::EMPTY, |extent, &x| extent.join(x, x));
        return Err(Outside { count, first, at: points[first], extent: [extent.low, extent.high] });
    }
    Ok(sorted(mesh.cells.len(), found.into_iter()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Layout, seed};
    use crate::mesh::rectangle;

    /// A 7 x 5 rectangle with its inner nodes moved: all cells are distorted, none is concave.
    fn distorted() -> Mesh {
        let mut mesh = rectangle([7.0, 5.0], [7, 5]).unwrap();
        for (k, x) in mesh.nodes.iter_mut().enumerate() {
            let inner = x[0] % 7.0 != 0.0 && x[1] % 5.0 != 0.0;
            if inner {
                x[0] += 0.3 * (k as f64 * 1.7).sin();
                x[1] += 0.3 * (k as f64 * 2.9).cos();
            }
        }
        mesh.checked().unwrap()
    }

    #[test]
    fn trees_of_every_size_find_all_their_cells() {
        for n in 1..50 {
            let locator = Locator::new(&rectangle([n as f64, 1.0], [n, 1]).unwrap());
            assert!((0..n).all(|cell| locator.find([cell as f64 + 0.25, 0.5]).map(|f| f.0) == Some(cell)));
        }
        assert_eq!(Locator::new(&Mesh::default()).find([0.0, 0.0]), None);
    }

    #[test]
    fn cells_whose_boxes_meet_a_box_are_all_found_and_no_others() {
        let mesh = distorted();
        let locator = Locator::new(&mesh);
        for [low, high] in
            [[[0.0, 0.0], [7.0, 5.0]], [[2.2, 1.1], [3.4, 1.3]], [[6.5, 4.9], [9.0, 9.0]], [[8.0, 1.0], [9.0, 2.0]]]
        {
            let mut found = Vec::new();
            locator.overlapping(low, high, &mut found);
            found.sort_unstable();
            let meets = |cell: &usize| {
                let corners = mesh.corners(*cell);
                (0..2).all(|i| corners.iter().any(|x| x[i] <= high[i]) && corners.iter().any(|x| x[i] >= low[i]))
            };
            assert_eq!(found, (0..mesh.cells.len()).filter(meets).collect::<Vec<_>>());
        }
    }

    #[test]
    fn points_inside_cells_are_found_with_their_parent_coordinates() {
        let mesh = distorted();
        let locator = Locator::new(&mesh);
        let cloud = seed(Layout::Jitter { seed: 4, amount: 0.3 }, 4, mesh.cells.len());
        for cell in 0..mesh.cells.len() {
            for &xi in cloud.of(cell) {
                let (found, at) = locator.find(map::position(&mesh.corners(cell), xi)).unwrap();
                // Newton ends at rounding, amplified by 1 / det of these cells, above 0.1.
                assert!(found == cell && (at[0] - xi[0]).abs().max((at[1] - xi[1]).abs()) < 1e-14);
            }
        }
    }

    #[test]
    fn points_on_edges_and_corners_belong_to_the_lowest_cell_that_they_touch() {
        for mesh in [distorted(), rectangle([7.0, 5.0], [7, 5]).unwrap()] {
            let locator = Locator::new(&mesh);
            for cell in 0..mesh.cells.len() {
                for t in [0.0, 0.3, 0.5, 1.0] {
                    for xi in [[0.0, t], [1.0, t], [t, 0.0], [t, 1.0]] {
                        let x = map::position(&mesh.corners(cell), xi);
                        let touches = |&c: &usize| {
                            map::parent(&mesh.corners(c), x)
                                .is_some_and(|xi| xi.iter().all(|xi| (-1e-9..=1.0 + 1e-9).contains(xi)))
                        };
                        let lowest = (0..mesh.cells.len()).find(touches);
                        assert_eq!(locator.find(x).map(|f| f.0), lowest, "{x:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_outer_boundary_belongs_to_the_mesh_up_to_1e_12_and_not_beyond() {
        let locator = Locator::new(&rectangle([3.0, 3.0], [30, 30]).unwrap());
        assert_eq!(locator.find([3.0 + 0.5e-13, 3.0]), Some((899, [1.0, 1.0])));
        assert_eq!(locator.find([-0.5e-13, 0.05]).map(|f| f.0), Some(0));
        // Cells are 0.1 m wide: 1e-12 of that.
        assert_eq!(locator.find([3.0 + 1e-11, 1.5]), None);
        assert_eq!(locator.find([f64::NAN, 0.0]), None);
        assert_eq!(locator.find([f64::INFINITY, 0.0]), None);
    }

    /// A rectangle without the cells of its middle: not convex, with a hole.
    fn frame() -> Mesh {
        let mut mesh = distorted();
        let keep = |cell: usize| !((2..5).contains(&(cell % 7)) && (1..4).contains(&(cell / 7)));
        let kept: Vec<usize> = (0..35).filter(|&cell| keep(cell)).collect();
        mesh.cells = kept.iter().map(|&cell| mesh.cells[cell]).collect();
        (mesh.cell_group, mesh.original) = (vec![0; kept.len()], vec![]);
        mesh.edges.clear();
        mesh
    }

    #[test]
    fn the_walk_finds_what_the_hierarchy_finds_to_the_bit_from_any_cell() {
        for mesh in [distorted(), frame(), rectangle([7.0, 5.0], [7, 5]).unwrap()] {
            let locator = Locator::new(&mesh);
            let random = seed(Layout::Random { seed: 5 }, 20, 1);
            // Some lie outside, and in the hole.
            let mut points: Vec<_> = random.xi.iter().map(|x| [7.4 * x[0] - 0.2, 5.4 * x[1] - 0.2]).collect();
            for cell in 0..mesh.cells.len() {
                let edge = [[0.0, 0.0], [1.0, 0.37], [0.37, 1.0], [0.5, 0.0], [1.0, 1.0], [1e-11, 0.5]];
                points.extend(edge.map(|xi| map::position(&mesh.corners(cell), xi)));
            }
            points.extend([[f64::NAN, 1.0], [f64::INFINITY, 1.0], [1e300, -1e300]]);
            let mut walked = 0;
            for (k, &x) in points.iter().enumerate() {
                let expected = locator.find(x);
                for from in [0, (k * 7) % mesh.cells.len(), mesh.cells.len() - 1, usize::MAX] {
                    walked += usize::from(locator.walk.find(from, x).is_some());
                    assert_eq!(locator.find_from(from, x), expected, "{x:?} from {from}");
                }
            }
            // Not by falling back to the hierarchy: of 400 points from three cells each most are walked to, or, around the
            // hole, nearly half (484).
            assert!(walked > 450, "{walked}");
        }
    }

    #[test]
    fn points_on_edges_are_not_lost_far_from_the_origin() {
        let mut mesh = rectangle([1e-3, 1e-3], [10, 10]).unwrap();
        mesh.nodes.iter_mut().flatten().for_each(|x| *x += 1234.5678);
        let locator = Locator::new(&mesh);
        for cell in 0..100 {
            for t in [0.0, 0.123, 0.77, 1.0] {
                assert!(locator.find(map::position(&mesh.corners(cell), [t, 1.0])).is_some());
                assert!(locator.find(map::position(&mesh.corners(cell), [1.0, t])).is_some());
            }
        }
    }

    #[test]
    fn a_seeded_cloud_shuffled_comes_back_from_its_positions() {
        let mesh = distorted();
        let cloud = seed(Layout::Midpoints, 3, mesh.cells.len());
        let mut points: Vec<[f64; 2]> = (0..mesh.cells.len())
            .flat_map(|c| cloud.of(c).iter().map(|&xi| map::position(&mesh.corners(c), xi)).collect::<Vec<_>>())
            .collect();
        points.reverse();
        let (found, order) = from_points(&mesh, &Locator::new(&mesh), &points).unwrap();
        assert_eq!(found.first, cloud.first);
        // Points of a cell keep their order among each other, which is the reversed one here.
        for cell in 0..mesh.cells.len() {
            let mut xi = found.of(cell).to_vec();
            xi.reverse();
            for (a, b) in xi.iter().flatten().zip(cloud.of(cell).iter().flatten()) {
                // Half a step of 2^-40, and Newton's rounding amplified by 1 / det of these cells, above 0.1.
                assert!((a - b).abs() < 0.5 * 2f64.powi(-40) + 1e-14);
            }
        }
        let last = points.len() - 1;
        assert_eq!(order[..9], [8, 7, 6, 5, 4, 3, 2, 1, 0].map(|k| last - k));
    }

    #[test]
    fn points_outside_are_counted_and_the_first_is_named() {
        let mesh = rectangle([1.0, 1.0], [2, 2]).unwrap();
        let points = [[0.5, 0.5], [1.5, 0.5], [0.1, 0.2], [0.5, f64::NAN]];
        let outside = from_points(&mesh, &Locator::new(&mesh), &points).unwrap_err();
        assert_eq!(outside, Outside { count: 2, first: 1, at: [1.5, 0.5], extent: [[0.0, 0.0], [1.0, 1.0]] });
        assert_eq!(crate::Error::from(outside).exit_code(), 2);
    }
}
