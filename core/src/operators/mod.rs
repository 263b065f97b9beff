//! The stored matrices of the method, built once per mesh, cloud and degree, shared by congruent cells.

pub mod blocks;
pub mod carry;
pub mod certificate;
pub mod curl_core;
pub mod curl_free;
pub mod curved;
pub mod from_points;
pub mod geometry;
mod held_fit;
pub mod held_traces;
pub mod matrix;
mod order;
pub mod point_matrices;
pub mod points;
pub mod sides;
pub mod stored;

pub use blocks::Blocks;
pub use carry::{Carried, Limits, carry};
pub use certificate::{Certificate, Class};
pub use curl_free::CurlFree;
pub use from_points::from_points;
pub(crate) use geometry::with_terms;
pub use geometry::{BlockMetric, Cofactors, Geometry, Metric, NodeMetric, determinant};
pub use held_traces::HeldTraces;
pub use matrix::{Matrix, Pool, Share};
pub use point_matrices::PointMatrices;
pub use points::{Points, Sampling};
pub use sides::{Neighbour, Side};
pub use stored::Stored;

use crate::basis::Lagrange;
use crate::error::Error;
use crate::mesh::{FACES, Link, Mesh};
use crate::quadrature::legendre;

/// Runs `$body` with `$nodes` bound to the constant M = N + 1: loops over the nodes of a line are unrolled. One `match` a
/// block and kernel.
macro_rules! with_nodes {
    ($m:expr, $nodes:ident => $body:expr) => {
        match $m {
            1 => with_nodes!(@ 1, $nodes, $body),
            2 => with_nodes!(@ 2, $nodes, $body),
            3 => with_nodes!(@ 3, $nodes, $body),
            4 => with_nodes!(@ 4, $nodes, $body),
            5 => with_nodes!(@ 5, $nodes, $body),
            6 => with_nodes!(@ 6, $nodes, $body),
            _ => with_nodes!(@ 7, $nodes, $body),
        }
    };
    (@ $value:literal, $nodes:ident, $body:expr) => {{
        const $nodes: usize = $value;
        $body
    }};
}
pub(crate) use with_nodes;

/// Nodes of a cell of the largest degree that steps are compiled for, 6.
pub const MOST_NODES: usize = 49;

/// Points of a face of such a cell.
pub const MOST_FACE_POINTS: usize = 7;

/// Everything that the step needs of mesh and cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct Operators {
    /// Degree N in space.
    pub degree: usize,
    /// The 1D basis on Gauss points and its tables.
    pub line: Line,
    /// How cells lie in blocks of 8.
    pub blocks: Blocks,
    /// Metric terms at nodes and faces.
    pub geometry: Geometry,
    /// The traces of the displacement between unequal cells; none where all cells are equal, or the flux holds no jumps.
    pub held_traces: Option<HeldTraces>,
    /// Transfer between points and nodes, and derivatives at points; `None` for RK-DGFEM.
    pub points: Option<Points>,
    /// The projection onto gradients; `None` if the scene has no control of the curl.
    pub curl_free: Option<CurlFree>,
    /// Hash of the input that the matrices were made from, for files that say where a state comes from; empty where nobody has computed it.
    pub key: String,
}

/// The parts of the operators that a method needs.
#[derive(Debug, Clone, Copy)]
pub struct Needs<'a> {
    /// Degree N in space.
    pub degree: usize,
    /// Where the predictor samples, if there is one.
    pub sampling: Option<Sampling<'a>>,
    /// Whether the curl of F is controlled.
    pub curl_free: bool,
    /// Whether the flux holds jumps of the displacement ([`crate::riemann::Looks::Displacement`]).
    pub held: bool,
}

impl Operators {
    /// Builds all matrices. `material` gives for each cell the number of its law.
    ///
    /// # Errors
    /// A cell whose points cannot carry Q_N, by number and with the remedy.
    pub fn build(mesh: &Mesh, links: &[[Link; FACES]], material: &[usize], needs: &Needs) -> Result<Self, Error> {
        let (line, blocks) = (Line::new(needs.degree), Blocks::new(material, links));
        let stored = Stored::build(mesh, &blocks, &line, needs)?;
        Ok(Self::assemble(mesh, line, blocks, needs, stored))
    }

    /// Completes stored matrices by the parts that are quickly computed from the mesh.
    pub fn assemble(mesh: &Mesh, line: Line, blocks: Blocks, needs: &Needs, stored: Stored) -> Self {
        let geometry = Geometry::new(mesh, &blocks, &line);
        let held_traces = if needs.held { HeldTraces::of(mesh, &blocks, &line) } else { None };
        let points = needs.sampling.zip(stored.points).map(|(s, pool)| Points::new(mesh, &blocks, &line, s, pool));
        let curl_free = stored.curl_free.map(|pool| CurlFree::new(pool, mesh, &blocks, &line));
        Self { degree: needs.degree, line, blocks, geometry, held_traces, points, curl_free, key: String::new() }
    }

    /// The same with `blocks`, the k-th of which is today's block `order[k]`.
    pub(crate) fn with_blocks(self, mesh: &Mesh, blocks: Blocks, order: &[usize]) -> Self {
        let Self { degree, line, held_traces, points, curl_free, key, .. } = self;
        let geometry = Geometry::new(mesh, &blocks, &line);
        let held_traces = held_traces.map(|traces| traces.in_order(order));
        let points = points.map(|points| points.in_order(order));
        let curl_free = curl_free.map(|free| CurlFree { pool: free.pool.in_order(order), ..free });
        Self { degree, line, blocks, geometry, held_traces, points, curl_free, key }
    }

    /// With the hash of their input.
    #[must_use]
    pub fn with_key(self, key: String) -> Self {
        Self { key, ..self }
    }

    /// The hash of their input; empty where none was given.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// (N+1)^2.
    pub fn nodes(&self) -> usize {
        self.line.m * self.line.m
    }

    /// The number of points of a block where the law is evaluated between steps: that of the lane with the most points.
    /// If the method has no points, these are the nodes.
    pub fn block_points(&self, block: usize) -> usize {
        self.points.as_ref().map_or(self.nodes(), |points| points.first[block + 1] - points.first[block])
    }

    /// Parent coordinates of the points of a lane where the law is evaluated between steps.
    pub fn places(&self, block: usize, lane: usize) -> Vec<[f64; 2]> {
        let Some(points) = &self.points else { return self.line.nodes() };
        let at = |p: usize| [0, 1].map(|k| points.parent[2 * (points.first[block] + p) + k].0[lane]);
        (0..points.count[block][lane] as usize).map(at).collect()
    }

    /// w_a J_a of the nodes of a cell, m^2: its mass matrix. Zeros after the last node.
    pub fn node_weights(&self, block: usize, lane: usize) -> [f64; MOST_NODES] {
        let (metric, basis) = (self.geometry.of(block), &self.line.basis);
        let mut out = [0.0; MOST_NODES];
        for (a, weight) in out.iter_mut().enumerate().take(self.nodes()) {
            let (i, j) = (a / self.line.m, a % self.line.m);
            let [one, two] = metric.at_node_of(&self.line, lane, i, j);
            *weight = basis.weights[i] * basis.weights[j] * determinant(one, two);
        }
        out
    }

    /// The factors of all nodes in the trace of the displacement whose jump is held, at a point of a face of the cell in a lane.
    pub fn held_trace(&self, block: usize, face: usize, lane: usize, point: usize) -> Vec<f64> {
        let (m, nodes) = (self.line.m, self.nodes());
        if let Some(factors) = self.held_traces.as_ref().and_then(|all| all.block(block)) {
            return factors[(face * m + point) * nodes..][..nodes].iter().map(|factor| factor.0[lane]).collect();
        }
        self.line.spread(&self.line.held[face % 2], face, point)
    }

    /// Bytes held by matrices and metric terms.
    pub fn bytes(&self) -> usize {
        self.geometry.bytes()
            + self.held_traces.as_ref().map_or(0, HeldTraces::bytes)
            + self.points.as_ref().map_or(0, Points::bytes)
            + self.curl_free.as_ref().map_or(0, CurlFree::bytes)
            + self.blocks.bytes()
    }
}

/// The 1D tables of the nodal basis.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The basis itself.
    pub basis: Lagrange,
    /// M = N + 1.
    pub m: usize,
    /// `D[i][k]` = l_k'(x_i).
    pub slope: Vec<f64>,
    /// Weak derivative: w_k l_i'(x_k) / w_i at `[i][k]`.
    pub weak: Vec<f64>,
    /// l_k(0) and l_k(1).
    pub ends: [Vec<f64>; 2],
    /// Lift: l_k(0) / w_k and l_k(1) / w_k.
    pub lift: [Vec<f64>; 2],
    /// Traces of the displacement whose jump is held ([`crate::riemann::hold`]) at 0 and 1: l_k, less w_k P_N(2 x_k - 1) where N is
    /// even, P_N being Legendre's polynomial.
    ///
    /// The part of a smooth function that no polynomial of degree N can represent begins with P_(N+1). If P_(N+1) is
    /// even, it is the same at both ends and does not jump between equal cells. If it is odd, it jumps by 2 (h/2)^(N+1)
    /// u^(N+1) / (2N+1)!!, and to hold that jump would cost an order. The jump is 1/(2N+1) of the jump of the highest
    /// coefficient a_N, and a_N / (2N+1) = sum_k w_k P_N u_k. At degree 0 all of a jump is of this kind, and nothing is held: springs
    /// that hold it store as much energy as the body, and give it back (15 % of the start at the paper's impact).
    pub held: [Vec<f64>; 2],
    /// Lift by those traces: [`Line::held`] / w_k.
    pub held_lift: [Vec<f64>; 2],
}

impl Line {
    /// The nodes a of the line across a face, at a point of it: the first, and how far it is to the next.
    #[inline(always)]
    pub fn across(&self, face: usize, point: usize) -> (usize, usize) {
        if face < 2 { (point, self.m) } else { (point * self.m, 1) }
    }

    /// The factors of the nodes of the line across a face, at a point of it, among those of all nodes; the others are 0.
    pub fn spread(&self, factors: &[f64], face: usize, point: usize) -> Vec<f64> {
        let (first, stride) = self.across(face, point);
        let mut out = vec![0.0; self.m * self.m];
        factors.iter().enumerate().for_each(|(i, factor)| out[first + stride * i] = *factor);
        out
    }

    /// Tables of degree N.
    pub fn new(degree: usize) -> Self {
        let basis = Lagrange::new(degree);
        let (m, slope) = (basis.len(), basis.derivative_matrix());
        let w = &basis.weights;
        let weak = (0..m * m).map(|e| w[e % m] * slope[(e % m) * m + e / m] / w[e / m]).collect();
        let ends = [basis.values(0.0), basis.values(1.0)];
        let lift = [0, 1].map(|end: usize| ends[end].iter().zip(w).map(|(l, w)| l / w).collect());
        let is_even = degree.is_multiple_of(2);
        let of = |k: usize| w[k] * legendre(2.0 * basis.nodes[k] - 1.0).nth(degree).map_or(0.0, |(p, _)| p);
        let left_out = |k: usize| if is_even { of(k) } else { 0.0 };
        let held = [0, 1].map(|end: usize| (0..m).map(|k| ends[end][k] - left_out(k)).collect::<Vec<f64>>());
        let held_lift = [0, 1].map(|end: usize| held[end].iter().zip(w).map(|(l, w)| l / w).collect());
        Self { basis, m, slope, weak, ends, lift, held, held_lift }
    }

    /// Parent coordinates of the nodes a = i M + j.
    pub fn nodes(&self) -> Vec<[f64; 2]> {
        (0..self.m * self.m).map(|a| self.basis.node_2d(a)).collect()
    }
}

#[cfg(test)]
mod tests;
