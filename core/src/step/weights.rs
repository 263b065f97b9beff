//! What a block costs in a step, estimated from what is known before the first step. Tiles are divided by it.
//!
//! The estimate depends on mesh, cloud and scheme alone and never on a clock, so that all ranks of a job divide the blocks alike. (The
//! bits of a run do not depend on the division.) It counts what a block does, and multiplies each count with a time that was measured
//! once ([`TIMES`]). On other processors all times are others, but their ratios, which alone matter, are nearly the same.

use super::law_cost::LawCost;
use super::scheme::{Method, Scheme};
use super::sweeps::Sweep;
use crate::lane::Coefficient;
use crate::mesh::FACES;
use crate::operators::{Neighbour, PointMatrices, Points, Share};
use crate::riemann::Looks;
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// Nanoseconds of a block of eight cells.
struct Times {
    /// In a stage: of the block, and of a node for each node of a line.
    stage: [f64; 2],
    /// Of a point of a face in a stage, by what the flux looks at: nothing, shear, displacement.
    face: [f64; 3],
    /// Of a point of a face of one cell in a stage, where cells are not computed side by side: at the boundary, at another law, and of an
    /// operation of each law for its speeds there.
    lane: [f64; 3],
    /// Of the block after the last stage.
    end: f64,
    /// Of an operation of the law ([`LawCost`]): P in the predictor or in a stage, the speed of a trace, in the survey.
    law: [f64; 3],
    /// Of a point in the survey, beside the law.
    survey: f64,
    /// Of a product of a number with a field at a point or node: by numbers that the cells share, and by those of each cell, which come
    /// from memory.
    product: [f64; 2],
}

/// Fitted to the time of a step in 72 cases (means over 288 blocks, AVX-512): all methods, degrees 1 to 4, all laws and fluxes, 4 to 64
/// points a cell on lattices and moved at random, without boundary. The estimate is within 15 % of 67 of them; the others are .70 to .84 of what was measured
/// (docs/ranks.md says how it was done).
const TIMES: Times = Times {
    stage: [170.0, 24.0],
    face: [20.0, 64.0, 62.0],
    lane: [30.0, 200.0, 2.5],
    end: 100.0,
    law: [0.33, 0.41, 0.21],
    survey: 47.0,
    product: [0.33, 0.58],
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
    fn of<C: Coefficient>(matrices: &PointMatrices<C>, m: f64) -> Self {
        let (points, [shared, own]) = (matrices.points() as f64, TIMES.product);
        let (transfer, slope, product) = match matrices {
            PointMatrices::Nodes(_) => (m * m, 2.0 * m * points, shared),
            // The factors of eight lattices are small: they stay in the cache.
            PointMatrices::Lattice([first, _]) => {
                let k = first.slope.rows as f64;
                (m * k * (m + k), 2.0 * k * points, shared)
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
        all.map(|(block, &law)| (self.weight_of(block, &costs[law], &costs).round() as u64).max(1)).collect()
    }

    fn weight_of(&self, block: usize, law: &LawCost, all: &[LawCost]) -> f64 {
        let (n, m, stages) = (self.operators.nodes() as f64, self.operators.line.m as f64, self.stages() as f64);
        let face = match self.flux.looks() {
            Looks::Nothing => TIMES.face[0],
            Looks::Shear => TIMES.face[1],
            Looks::Displacement => TIMES.face[2],
        };
        let [block_in_stage, product] = TIMES.stage;
        let faces = FACES as f64 * (face + TIMES.law[1] * law.speed) + self.weight_of_lanes(block, law, all);
        let stage = block_in_stage + n * m * product + m * faces;
        let cloud = self.operators.points.as_ref().map(|points| Cloud::of_block(points, block, m));
        let stresses = match (&self.method, &cloud) {
            (Method::Ader { sweeps, .. }, Some(cloud)) => predictor(cloud, &sweeps.inner, &sweeps.last, law),
            _ => stages * n * TIMES.law[0] * law.stress,
        };
        let points = cloud.map_or(n, |cloud| cloud.points);
        let remembers = if law.has_memory { STRESSES_OF_MEMORY * law.stress } else { 0.0 };
        let survey = points * (TIMES.survey + TIMES.law[2] * (law.survey + remembers));
        stages * stage + stresses + TIMES.end + survey
    }

    /// ns of a point on each face of single cells at the boundary and at other laws. (What conditions do there is not known.)
    fn weight_of_lanes(&self, block: usize, law: &LawCost, all: &[LawCost]) -> f64 {
        let [boundary, interface, operation] = TIMES.lane;
        let of = |neighbour: &Neighbour| match *neighbour {
            Neighbour::Boundary(_) => boundary + operation * law.speed,
            Neighbour::Interface(_, other) => interface + operation * (law.speed + all[other].speed),
            Neighbour::Cell(_) | Neighbour::Padding => 0.0,
        };
        self.operators.blocks.neighbours[block].iter().flatten().map(of).sum()
    }
}

/// ns of transfers and predictor.
fn predictor(cloud: &Cloud, inner: &[Sweep], last: &Sweep, law: &LawCost) -> f64 {
    let rates = inner.iter().map(|sweep| sweep.to).sum::<usize>() as f64;
    let (evaluations, fields) = (rates + last.to as f64, UNKNOWNS as f64);
    // U to the points, its averages with P back, and F for the survey.
    let transfers = 2.0 * fields + 2.0 * DEFORMATION as f64 + if cloud.fits { 2.0 * fields * rates } else { 0.0 };
    let products = transfers * cloud.transfer + fields * rates * cloud.slope;
    cloud.product * products + cloud.points * evaluations * TIMES.law[0] * law.stress
}

#[cfg(test)]
mod tests {
    use super::super::tests::{KINDS, Kind, midpoints, scheme, wall};
    use crate::cloud::seed::{Layout, seed};
    use crate::mesh::rectangle;

    #[test]
    fn the_estimate_is_within_a_fifth_of_what_was_measured() {
        // Degree, points a direction, moved or not: ns of a block, see docs/ranks.md. Each case is one of the fit.
        let cases = [(1, 2, false, 1836.0), (2, 3, false, 4354.0), (2, 8, false, 22333.0), (3, 4, false, 9333.0)];
        let moved = [(1, 2, true, 2076.0), (2, 3, true, 5998.0), (2, 6, true, 40718.0), (2, 8, true, 124_078.0)];
        let mesh = rectangle([8.0, 1.0], [24, 3]).unwrap();
        for (degree, k, moved, measured) in cases.into_iter().chain(moved) {
            let layout = if moved { Layout::Jitter { seed: 1, amount: 0.2 } } else { Layout::Midpoints };
            let cloud = seed(layout, k, mesh.cells.len());
            let weights = scheme(&mesh, Kind::AderDgmpm, degree, &cloud, wall).weights();
            // That of the block in the middle, which is not at the boundary.
            let ratio = *weights.iter().min().unwrap() as f64 / measured;
            assert!((0.8..1.2).contains(&ratio), "degree {degree}, {k}^2 points, moved: {moved}: {ratio}");
        }
    }

    #[test]
    fn blocks_that_do_the_same_have_the_same_weight_and_those_at_the_boundary_more() {
        let mesh = rectangle([1.0, 1.0], [8, 4]).unwrap();
        for kind in KINDS {
            // Each row is a block.
            let weights = scheme(&mesh, kind, 2, &midpoints(&mesh, 2), wall).weights();
            assert!(
                weights.len() == 4 && weights[0] == weights[3] && weights[1] == weights[2],
                "{kind:?}: {weights:?}"
            );
            assert!(weights[0] > weights[1] && weights[1] > 100, "{kind:?}: {weights:?}");
        }
    }
}
