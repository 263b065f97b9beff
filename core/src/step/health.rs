//! J where the survey of the points does not look: at the grid nodes of a state, and at the face points whose traces go
//! into the fluxes. And the name of the place where stability was lost.
//!
//! A state is healthy where J > 0 at its material points, at its grid nodes (both seen by the survey at the end of the
//! step), and at its face points. These are seen when the next step has made their traces: for RK they are those of the
//! state, for ADER those of the averages over the step, which is what the law is asked for there. The determinant is at
//! hand, since the wave speed of a trace needs it. A state from outside, and the last of a run, are looked at by
//! [`Scheme::survey_all`] at all three kinds of places.

use super::loss::{FacePoint, Loss, LossKind, Site};
use super::{Method, Scheme};
use crate::lane::{F8, Lanes};
use crate::mesh::map;
use crate::operators::{Matrix, PointMatrices, Share};
use crate::state::State;
use crate::tensor::{self, DEFORMATION};

/// Smallest J of M x M nodes, F being `[component][node]`.
#[inline(always)]
pub(super) fn smallest_j<L: Lanes, const M: usize>(f: &[F8]) -> L {
    let n = M * M;
    let f = &f[..DEFORMATION * n];
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
        map::position(&self.operators.geometry.map_of(block, lane), self.parent_of(block, lane, site))
    }

    fn parent_of(&self, block: usize, lane: usize, site: Site) -> [f64; 2] {
        let basis = &self.operators.line.basis;
        match (site, &self.operators.points) {
            (Site::Point(point), Some(points)) => {
                let at = points.first[block] + point;
                [0, 1].map(|k| points.parent[2 * at + k].0[lane])
            }
            (Site::Point(node) | Site::Node(node), _) => basis.node_2d(node),
            (Site::Face(face, point), _) => map::on_face(face, basis.nodes[point]),
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

    /// The loss at a face point.
    pub(super) fn loss_at_face(&self, face: &FacePoint) -> Loss {
        let cell = self.operators.blocks.cells[self.of_first_number(face.block)][face.lane];
        let kind = if face.j.is_finite() { LossKind::Inverted(face.j) } else { LossKind::NotFinite };
        Loss { cell, site: face.site(), kind }
    }

    /// The worst place in a block that is known to be lost: a number that is not finite, else the smallest J where it is not
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
    pub(super) fn losses(&self, state: &State, block: usize, lane: usize, see: &mut dyn FnMut(Site, LossKind)) {
        let n = self.operators.nodes();
        let u = state.of_block(block, n);
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
            let f: [f64; DEFORMATION] = std::array::from_fn(at);
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
    pub(super) fn points_from_nodes(&self, block: usize, lane: usize) -> Option<Matrix<f64>> {
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
