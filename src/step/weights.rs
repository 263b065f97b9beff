//! What a block costs in a step, estimated from what is known before the first step. Tiles are divided by it.
//!
//! The estimate depends on mesh, cloud and scheme alone and never on a clock, so that all ranks of a job divide the blocks alike. (The
//! bits of a run do not depend on the division.) It counts what a block does, and multiplies each count with a time that was measured
//! once ([`TIMES`]). On other processors all times are others, but their ratios, which alone matter, are nearly the same.

use super::law_cost::LawCost;
use super::scheme::{Method, Scheme};
use super::sweeps::Sweep;
use crate::operators::{PointMatrices, Points, Share};
use crate::riemann::Looks;
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// Nanoseconds of a block of eight cells.
struct Times {
    /// In a stage: of the block, of a node, and of a node for each node of a line.
    stage: [f64; 3],
    /// Of a point of a face in a stage, by what the flux looks at: nothing, shear, displacement.
    face: [f64; 3],
    /// After the last stage: of the block, of a node, and of a node for each node of a line.
    end: [f64; 3],
    /// Of an operation of the law ([`LawCost`]): P in the predictor or in a stage, the speed of a trace, in the survey.
    law: [f64; 3],
    /// Of a point where the law is evaluated: beside the law, for each rate that is added up there, in the survey.
    point: [f64; 3],
    /// Of a product of a number with a field at a point or node: by the factors of a lattice, by a matrix that cells share, by a matrix of
    /// each cell, which comes from memory.
    product: [f64; 3],
}

/// A fit, see docs/ranks.md.
const TIMES: Times = Times {
    stage: [0.0; 3],
    face: [0.0; 3],
    end: [0.0; 3],
    law: [0.0; 3],
    point: [0.0; 3],
    product: [0.0; 3],
};

/// Stresses that the survey evaluates at a point of a law with memory: the history after the step, and the prestress.
const STRESSES_OF_MEMORY: f64 = 2.0;

/// The points of a block and their matrices.
struct Cloud {
    /// How many.
    points: f64,
    /// Products of a number with a field: from nodes to points or back, and differentiated along both axes.
    transfer: f64,
    slope: f64,
    /// Whether a field is fitted before it is differentiated.
    fits: bool,
    /// ns of a product.
    product: f64,
}

impl Cloud {
    fn of<C: crate::lane::Coefficient>(matrices: &PointMatrices<C>, m: f64) -> Self {
        let (points, [lattice, shared, own]) = (matrices.points() as f64, TIMES.product);
        let (transfer, slope, product) = match matrices {
            PointMatrices::Nodes(_) => (m * m, 2.0 * m * points, lattice),
            PointMatrices::Lattice([first, _]) => {
                let k = first.slope.rows as f64;
                (m * k * (m + k), 2.0 * k * points, lattice)
            }
            PointMatrices::Dense { .. } => (m * m * points, 2.0 * points * points, if C::OWN { own } else { shared }),
        };
        Self { points, transfer, slope, fits: matrices.is_overdetermined(), product }
    }

    fn of_block(points: &Points, block: usize, m: f64) -> Self {
        match points.pool.share[block] {
            Share::Shared(k) => Self::of(&points.pool.shared[k], m),
            Share::Own(k) => Self::of(&points.pool.own[k], m),
        }
    }
}

impl Scheme {
    /// The estimate for each block, ns of a step.
    pub(super) fn weights(&self) -> Vec<u64> {
        let costs: Vec<LawCost> = self.laws.iter().map(|law| law.block().cost()).collect();
        let all = self.operators.blocks.material.iter().enumerate();
        // A block without a weight could be left out of all tiles' sums.
        all.map(|(block, &law)| (self.weight_of(block, &costs[law]).round() as u64).max(1)).collect()
    }

    fn weight_of(&self, block: usize, law: &LawCost) -> f64 {
        let (n, m, stages) = (self.operators.nodes() as f64, self.operators.line.m as f64, self.stages() as f64);
        let of_nodes = |[one, node, product]: [f64; 3]| one + n * (node + m * product);
        let face = match self.flux.looks() {
            Looks::Nothing => TIMES.face[0],
            Looks::Shear => TIMES.face[1],
            Looks::Displacement => TIMES.face[2],
        };
        let faces = 4.0 * m * (face + TIMES.law[1] * law.speed);
        let cloud = self.operators.points.as_ref().map(|points| Cloud::of_block(points, block, m));
        let of_points = match (&self.method, &cloud) {
            (Method::Ader { sweeps, .. }, Some(cloud)) => predictor(cloud, &sweeps.inner, &sweeps.last, law),
            _ => stages * n * (TIMES.law[0] * law.stress + TIMES.point[0]),
        };
        let points = cloud.map_or(n, |cloud| cloud.points);
        let stresses = if law.has_memory { STRESSES_OF_MEMORY * law.stress } else { 0.0 };
        let survey = points * (TIMES.point[2] + TIMES.law[2] * (law.survey + stresses));
        stages * (of_nodes(TIMES.stage) + faces) + of_nodes(TIMES.end) + of_points + survey
    }
}

/// ns of transfers and predictor.
fn predictor(cloud: &Cloud, inner: &[Sweep], last: &Sweep, law: &LawCost) -> f64 {
    let rates: usize = inner.iter().map(|sweep| sweep.to).sum();
    let sums: usize = inner.iter().chain([last]).map(|sweep| sweep.to * sweep.from).sum();
    let (rates, sums, evaluations) = (rates as f64, sums as f64, (rates + last.to) as f64);
    let fields = UNKNOWNS as f64;
    // U to the points, its averages with P back, and F for the survey.
    let transfers = 2.0 * fields + 2.0 * DEFORMATION as f64 + if cloud.fits { 2.0 * fields * rates } else { 0.0 };
    let at_points = evaluations * (TIMES.law[0] * law.stress + TIMES.point[0]) + sums * TIMES.point[1];
    cloud.product * (transfers * cloud.transfer + fields * rates * cloud.slope) + cloud.points * at_points
}
