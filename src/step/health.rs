//! J where the survey of the points does not look: at the grid nodes of a state, and at the face points whose traces go
//! into the fluxes. And the name of the place where stability was lost.
//!
//! A state is healthy where J > 0 at its material points, at its grid nodes (both seen by the survey at the end of the
//! step), and at its face points. These are seen when the next step has made their traces: for RK they are those of the
//! state, for ADER those of the averages over the step, which is what the law is asked for there. The determinant is at
//! hand, since the wave speed of a trace needs it. A state from outside, and the last of a run, are looked at by
//! [`Scheme::survey_all`] at all three kinds of places.

use super::survey::{Loss, LossKind, Survey};
use super::{Method, Scheme, Work};
use crate::lane::{F8, Lanes};
use crate::mesh::map;
use crate::operators::{Matrix, PointMatrices, Share};
use crate::state::State;
use crate::tensor;
use rayon::prelude::*;

/// A place in a cell where F is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// A material point, numbered in its cell.
    Point(usize),
    /// A grid node a = i M + j.
    Node(usize),
    /// A Gauss point of a face: the face (xi1 = 0, xi1 = 1, xi2 = 0, xi2 = 1) and the number of the point along it.
    Face(usize, usize),
}

impl std::fmt::Display for Site {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Site::Point(point) => write!(f, "material point {point}"),
            Site::Node(node) => write!(f, "grid node {node}"),
            Site::Face(face, point) => write!(f, "face point {point} of face {face}"),
        }
    }
}

/// A face point in a block whose J is not above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FacePoint {
    /// The block.
    pub block: usize,
    /// The lane.
    lane: usize,
    /// The face and the point on it.
    at: [usize; 2],
    /// Its J.
    j: f64,
}

impl FacePoint {
    /// The place in the cell.
    fn site(&self) -> Site {
        Site::Face(self.at[0], self.at[1])
    }

    /// Of two the one in the block that comes first.
    pub fn first(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        match (one, other) {
            (Some(one), Some(other)) => Some(if other.block < one.block { other } else { one }),
            (one, other) => one.or(other),
        }
    }

    /// The point with a J that is not a number, else with the smallest, of the first `count` lanes of a block, from its traces, [face][point][`width`].
    #[cold]
    pub fn find(block: usize, count: usize, traces: &[F8], width: usize) -> Self {
        let m = traces.len() / width / 4;
        let mut worst = Self { block, lane: 0, at: [0; 2], j: f64::INFINITY };
        for (number, trace) in traces.chunks_exact(width).enumerate() {
            for lane in 0..count {
                let j = tensor::det([0, 1, 2, 3].map(|k| trace[k].0[lane]));
                if j < worst.j || (j.is_nan() && !worst.j.is_nan()) {
                    worst = Self { block, lane, at: [number / m, number % m], j };
                }
            }
        }
        worst
    }
}

/// Smallest J of M x M nodes, F being `[component][node]`.
#[inline(always)]
pub(super) fn smallest_j<L: Lanes, const M: usize>(f: &[F8]) -> L {
    let n = M * M;
    let f = &f[..4 * n];
    let mut smallest = L::splat(f64::INFINITY);
    for a in 0..n {
        let f = [L::load(&f[a]), L::load(&f[n + a]), L::load(&f[2 * n + a]), L::load(&f[3 * n + a])];
        smallest = smallest.min(tensor::det(f));
    }
    smallest
}

impl Scheme {
    /// Times at which data of boundaries and sources are looked up in a step of `dt` from `time`, s.
    pub fn data_times(&self, time: f64, dt: f64) -> Vec<f64> {
        let shares = match &self.method {
            Method::Ader { time, .. } => &time.tau,
            Method::RungeKutta(tableau) => &tableau.c,
        };
        shares.iter().map(|share| time + share * dt).collect()
    }

    /// Reference coordinates of a place in a cell, m.
    pub fn position_of(&self, cell: usize, site: Site) -> [f64; 2] {
        let (block, lane) = self.operators.blocks.slot[cell];
        map::position(&self.operators.geometry.corners_of(block, lane), self.parent_of(block, lane, site))
    }

    fn parent_of(&self, block: usize, lane: usize, site: Site) -> [f64; 2] {
        let basis = &self.operators.line.basis;
        match (site, &self.operators.points) {
            (Site::Point(point), Some(points)) => {
                let at = points.first[block] + point;
                [0, 1].map(|k| points.parent[2 * at + k].0[lane])
            }
            (Site::Point(node) | Site::Node(node), _) => basis.node_2d(node),
            (Site::Face(face, point), _) => {
                let (end, along) = ((face % 2) as f64, basis.nodes[point]);
                if face < 2 { [end, along] } else { [along, end] }
            }
        }
    }

    /// Whether the points of a block, where it has some, are its nodes.
    #[inline]
    pub(super) fn samples_at_nodes(&self, block: usize) -> bool {
        let Some(points) = &self.operators.points else { return true };
        match points.pool.share[block] {
            Share::Shared(k) => matches!(points.pool.shared[k], PointMatrices::Nodes(_)),
            Share::Own(k) => matches!(points.pool.own[k], PointMatrices::Nodes(_)),
        }
    }

    /// [`Scheme::survey`], and the health at face points: of a state that no step has made, or that none will look at.
    ///
    /// # Errors
    /// As there.
    pub fn survey_all(&self, state: &State, memory: &Work, out: &mut Survey) -> Result<(), Loss> {
        self.survey(state, memory, out)?;
        let blocks = (0..self.operators.blocks.len()).into_par_iter();
        let faces = blocks.map(|block| self.smallest_j_at_faces(state, block));
        let worst = faces.reduce_with(|a, b| if b.j < a.j || (b.j == a.j && b.block < a.block) { b } else { a });
        match worst {
            Some(face) if face.j <= 0.0 => Err(self.loss_at_face(&face)),
            Some(face) => {
                out.min_j = out.min_j.min(face.j);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// The smallest J at the face points of the real cells of a block.
    fn smallest_j_at_faces(&self, state: &State, block: usize) -> FacePoint {
        let lanes = 0..self.operators.blocks.count[block];
        let none = FacePoint { block, lane: 0, at: [0; 2], j: f64::INFINITY };
        lanes.map(|lane| self.faces_of_lane(state, block, lane)).fold(none, |a, b| if b.j < a.j { b } else { a })
    }

    /// The same of one lane.
    fn faces_of_lane(&self, state: &State, block: usize, lane: usize) -> FacePoint {
        let (line, n) = (&self.operators.line, self.operators.nodes());
        let (m, u) = (line.m, &state.u[block * state.components * n..][..4 * n]);
        let mut worst = FacePoint { block, lane, at: [0; 2], j: f64::INFINITY };
        for face in 0..4 {
            let ends = &line.ends[face % 2];
            for point in 0..m {
                let (first, stride) = if face < 2 { (point, m) } else { (point * m, 1) };
                let component = |k: usize| -> f64 {
                    ends.iter().enumerate().map(|(i, l)| l * u[k * n + first + stride * i].0[lane]).sum()
                };
                let j = tensor::det([0, 1, 2, 3].map(component));
                // A NaN is for those who look at the nodes.
                if j < worst.j {
                    worst = FacePoint { at: [face, point], j, ..worst };
                }
            }
        }
        worst
    }

    /// The loss at a face point.
    pub(super) fn loss_at_face(&self, face: &FacePoint) -> Loss {
        let cell = self.operators.blocks.cells[face.block][face.lane];
        let kind = if face.j.is_finite() { LossKind::Inverted(face.j) } else { LossKind::NotFinite };
        Loss { cell, site: face.site(), kind }
    }

    /// The worst place in a block that is known to be sick: a number that is not finite, else the smallest J where it is not
    /// above 0, else the first point where the law is not hyperbolic.
    pub(super) fn find_loss(&self, state: &State, block: usize) -> Loss {
        let blocks = &self.operators.blocks;
        let mut worst = Loss { cell: blocks.cells[block][0], site: Site::Node(0), kind: LossKind::NotFinite };
        let mut rank = (u8::MAX, f64::INFINITY);
        for lane in 0..blocks.count[block] {
            let mut see = |site: Site, kind: LossKind| {
                let new = match kind {
                    LossKind::NotFinite => (0, 0.0),
                    LossKind::Inverted(j) => (1, j),
                    LossKind::NotHyperbolic => (2, 0.0),
                };
                if new < rank {
                    (rank, worst) = (new, Loss { cell: blocks.cells[block][lane], site, kind });
                }
            };
            self.losses(state, block, lane, &mut see);
        }
        worst
    }

    /// All losses of a lane at its nodes and points.
    fn losses(&self, state: &State, block: usize, lane: usize, see: &mut dyn FnMut(Site, LossKind)) {
        let n = self.operators.nodes();
        let stride = state.components * n;
        let u = &state.u[block * stride..(block + 1) * stride];
        let law = &self.laws[self.operators.blocks.material[block]];
        let number = |k: usize, a: usize| u[k * n + a].0[lane];
        for a in 0..n {
            let j = tensor::det([0, 1, 2, 3].map(|k| number(k, a)));
            if !(0..state.components).all(|k| number(k, a).is_finite()) {
                see(Site::Node(a), LossKind::NotFinite);
            } else if j <= 0.0 {
                see(Site::Node(a), LossKind::Inverted(j));
            }
        }
        let points = self.points_from_nodes(block, lane);
        let count = self.operators.points.as_ref().map_or(n, |points| points.count[block][lane] as usize);
        for point in 0..count {
            let at = |k: usize| match &points {
                None => number(k, point),
                Some(m) => m.row(point).iter().enumerate().map(|(a, w)| w * number(k, a)).sum(),
            };
            let f: [f64; 4] = std::array::from_fn(at);
            let j = tensor::det(f);
            let site = if points.is_some() { Site::Point(point) } else { Site::Node(point) };
            let speeds = law.largest_speeds(f, &self.internal_at(state, block, lane, point));
            if j <= 0.0 {
                see(site, LossKind::Inverted(j));
            } else if speeds.iter().any(|c| c.is_nan()) {
                see(site, LossKind::NotHyperbolic);
            }
        }
    }

    /// Phi_a(xi_p) of one lane of a block; none where points are nodes.
    fn points_from_nodes(&self, block: usize, lane: usize) -> Option<Matrix<f64>> {
        if self.samples_at_nodes(block) {
            return None;
        }
        let pool = &self.operators.points.as_ref()?.pool;
        let one = match pool.share[block] {
            Share::Shared(k) => pool.shared[k].to_dense(),
            Share::Own(k) => pool.own[k].lane(lane).to_dense(),
        };
        if let PointMatrices::Dense { from_nodes, .. } = one { Some(from_nodes) } else { None }
    }
}

#[cfg(test)]
mod tests;
