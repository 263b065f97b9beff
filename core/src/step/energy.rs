//! Totals of a state by grid quadrature (sums over points with volumes are wrong for most layouts). What a law with memory
//! stores and dissipates is known at its points alone, from their own F and history: there the weights are int chi_p dX.

use super::Scheme;
use super::predictor::transfer::{FieldsToPoints, factors};
use crate::lane::{Coefficient, F8};
use crate::mesh::map;
use crate::operators::{PointMatrices, Share, determinant};
use crate::state::{State, UNKNOWNS};
use crate::sum::exact_sum;
use crate::tensor::{self, DEFORMATION};
use rayon::prelude::*;

/// Totals per unit thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// int |p|^2 / (2 rho0) dX, J/m.
    pub kinetic: f64,
    /// int W dX, J/m: all that is stored.
    pub strain: f64,
    /// What the springs against the creep of faces store ([`crate::riemann::creep`]), J/m: part of the energy.
    pub in_faces: f64,
    /// What laws have dissipated since their material was virgin, J/m; only where one has memory.
    pub dissipated: Option<f64>,
    /// int p dX, kg/s (per metre of thickness).
    pub momentum: [f64; 2],
    /// int (x_1 p_2 - x_2 p_1) dX with x = X + u, kg m/s (per metre of thickness), about the origin; only where the
    /// displacement is known.
    pub angular_momentum: Option<f64>,
    /// int F dX, m^2.
    pub deformation: [f64; DEFORMATION],
    /// min J over the nodes.
    pub min_j: f64,
    /// Largest |dF_i2/dX_1 - dF_i1/dX_2| at the nodes, 1/m.
    pub max_curl: f64,
    /// The largest over the cells of sqrt(int |grad u - (F - 1)|^2 dX / int dX), what F and the shape differ by; only where the
    /// displacement is known. (Of a body that starts strained, with a displacement that counts from there, it holds that strain.)
    pub max_drift: Option<f64>,
}

/// Energy that was made out of nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyMade {
    /// J/m.
    pub joule: f64,
    /// Over the largest of the energy at the start, the work done so far, and what is told from rounding.
    pub share: f64,
    /// When it was found, s.
    pub time: f64,
    /// After so many steps.
    pub step: usize,
    /// Whether laws are sampled away from the Gauss nodes, which may be why.
    pub between_nodes: bool,
}

/// As a clause, for messages.
impl std::fmt::Display for EnergyMade {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let EnergyMade { joule, share, time, step, between_nodes } = self;
        let percent = 100.0 * share;
        write!(
            f,
            "{joule:.3e} J/m made out of nothing ({percent:.2} % of the energy at the start or the work done), step {step}, \
             t = {time:.6e} s"
        )?;
        match between_nodes {
            true => write!(
                f,
                "; laws sampled at the Gauss nodes ([cloud] layout = \"gauss\") or at more points (per_direction) may make none"
            ),
            false => Ok(()),
        }
    }
}

impl Totals {
    /// No cell yet.
    const EMPTY: Totals = Totals {
        kinetic: 0.0,
        strain: 0.0,
        in_faces: 0.0,
        dissipated: None,
        momentum: [0.0; 2],
        angular_momentum: None,
        deformation: [0.0; DEFORMATION],
        min_j: f64::INFINITY,
        max_curl: 0.0,
        max_drift: None,
    };

    /// No cell yet of a state with or without displacement and memory.
    fn empty(state: &State) -> Self {
        let known = state.has_displacement().then_some(0.0);
        Totals {
            angular_momentum: known,
            max_drift: known,
            dissipated: (!state.internal.is_empty()).then_some(0.0),
            ..Totals::EMPTY
        }
    }

    /// Kinetic and strain energy, and that of the springs in faces, J/m.
    pub fn energy(&self) -> f64 {
        self.kinetic + self.strain + self.in_faces
    }

    /// [`Totals::energy`] and what laws have dissipated: what the balance of a step is about, J/m.
    pub fn accounted(&self) -> f64 {
        self.energy() + self.dissipated.unwrap_or(0.0)
    }

    fn add(&mut self, other: &Totals) {
        self.kinetic += other.kinetic;
        self.strain += other.strain;
        self.in_faces += other.in_faces;
        self.dissipated = self.dissipated.zip(other.dissipated).map(|(a, b)| a + b);
        self.momentum.iter_mut().zip(other.momentum).for_each(|(a, b)| *a += b);
        self.angular_momentum = self.angular_momentum.zip(other.angular_momentum).map(|(a, b)| a + b);
        self.deformation.iter_mut().zip(other.deformation).for_each(|(a, b)| *a += b);
        self.min_j = self.min_j.min(other.min_j);
        self.max_curl = self.max_curl.max(other.max_curl);
        self.max_drift = self.max_drift.zip(other.max_drift).map(|(a, b)| a.max(b));
    }

    /// The totals of `parts`, of which these, of no cell, know what is to be summed.
    fn with_sums_of(mut self, parts: &[&Totals]) -> Self {
        parts.iter().for_each(|part| self.add(part));
        let sum = |of: &dyn Fn(&Totals) -> f64| exact_sum(parts.iter().map(|part| of(part)));
        let known = |whole: Option<f64>, of: &dyn Fn(&Totals) -> Option<f64>| {
            whole.map(|_| exact_sum(parts.iter().filter_map(|part| of(part))))
        };
        Totals {
            kinetic: sum(&|part| part.kinetic),
            strain: sum(&|part| part.strain),
            in_faces: sum(&|part| part.in_faces),
            dissipated: known(self.dissipated, &|part| part.dissipated),
            momentum: std::array::from_fn(|k| sum(&|part| part.momentum[k])),
            angular_momentum: known(self.angular_momentum, &|part| part.angular_momentum),
            deformation: std::array::from_fn(|k| sum(&|part| part.deformation[k])),
            ..self
        }
    }
}

impl Scheme {
    /// Totals of a state; the sums over the blocks are exact until they are rounded once, so that the order of the blocks does not
    /// matter.
    pub fn totals(&self, state: &State) -> Totals {
        Totals::empty(state).with_sums_of(&self.totals_of_blocks(state).iter().collect::<Vec<_>>())
    }

    /// Totals of the cells of each law, in the order of the laws.
    pub fn totals_by_law(&self, state: &State) -> Vec<Totals> {
        let blocks = self.totals_of_blocks(state);
        let of_law = |law: usize| {
            let own = blocks.iter().zip(&self.operators.blocks.material).filter(|(_, of)| **of == law);
            Totals::empty(state).with_sums_of(&own.map(|(block, _)| block).collect::<Vec<_>>())
        };
        (0..self.laws.len()).map(of_law).collect()
    }

    fn totals_of_blocks(&self, state: &State) -> Vec<Totals> {
        (0..self.operators.blocks.len())
            .into_par_iter()
            .map(|block| {
                let mut sum = Totals::empty(state);
                let points = self.deformation_at_points(state, block);
                let in_faces = self.stored_by_creep(block, self.creep_of(state, block));
                for lane in 0..self.operators.blocks.count[block] {
                    sum.add(&self.totals_of(state, block, lane));
                    sum.add(&self.stored_at_points(state, block, lane, &points));
                    sum.in_faces += in_faces.0[lane];
                }
                sum
            })
            .collect()
    }

    fn totals_of(&self, state: &State, block: usize, lane: usize) -> Totals {
        let (n, law) = (self.operators.nodes(), &self.laws[self.operators.blocks.material[block]]);
        let u = state.of_block(block, n);
        let memory = law.has_memory();
        let mut sum = Totals::empty(state);
        let (mut drift, mut area) = (0.0, 0.0);
        for (a, mass) in self.operators.geometry.masses(&self.operators.line, block, lane).enumerate() {
            let [f11, f12, f21, f22, p1, p2]: [f64; UNKNOWNS] = std::array::from_fn(|k| u[k * n + a].0[lane]);
            let f = [f11, f12, f21, f22];
            sum.add(&Totals {
                kinetic: mass * (p1 * p1 + p2 * p2) / (2.0 * law.density()),
                strain: if memory { 0.0 } else { mass * law.energy(f) },
                in_faces: 0.0,
                dissipated: sum.dissipated.map(|_| 0.0),
                momentum: [mass * p1, mass * p2],
                angular_momentum: self.position(state, block, lane, a).map(|x| mass * (x[0] * p2 - x[1] * p1)),
                deformation: f.map(|x| mass * x),
                min_j: tensor::det(f),
                max_curl: self.curl(u, block, lane, a),
                max_drift: sum.max_drift,
            });
            area += mass;
            if state.has_displacement() {
                let [one, two] =
                    [0, 1].map(|axis| UNKNOWNS + axis).map(|component| self.gradient(u, block, lane, a, component));
                drift += mass
                    * [one[0] - f11 + 1.0, one[1] - f12, two[0] - f21, two[1] - f22 + 1.0]
                        .map(|d| d * d)
                        .iter()
                        .sum::<f64>();
            }
        }
        sum.max_drift = sum.max_drift.map(|_| (drift / area).sqrt());
        sum
    }

    /// F at the points of a block whose law has memory, [point][4]; empty for an elastic law.
    fn deformation_at_points(&self, state: &State, block: usize) -> Vec<F8> {
        let count = self.histories.weights(block).len();
        let (n, m) = (self.operators.nodes(), self.operators.line.m);
        let u = &state.of_block(block, n)[..DEFORMATION * n];
        let mut points = vec![F8::ZERO; DEFORMATION * count];
        match self.operators.points.as_ref().map(|points| (&points.pool, points.pool.share[block])) {
            _ if count == 0 => {}
            None => super::dense::interleave::<DEFORMATION>(u, n, &mut points),
            Some((pool, Share::Shared(k))) => self.to_points(&pool.shared[k], u, m, &mut points),
            Some((pool, Share::Own(k))) => self.to_points(&pool.own[k], u, m, &mut points),
        }
        points
    }

    fn to_points<C: Coefficient>(&self, matrices: &PointMatrices<C>, fields: &[F8], m: usize, points: &mut [F8]) {
        let (mut nodes, mut between) = (fields.to_vec(), vec![F8::ZERO; factors(m, matrices.points(), DEFORMATION)]);
        let (nodes, between) = (&mut nodes[..], &mut between[..]);
        self.kernel.run(FieldsToPoints::<C, DEFORMATION> { matrices, fields, nodes, between, points });
    }

    /// What a law with memory stores and has dissipated in a lane, from F at the points. A point is where the last step has
    /// left it, so that the law returns nothing once more.
    fn stored_at_points(&self, state: &State, block: usize, lane: usize, points: &[F8]) -> Totals {
        let law = &self.laws[self.operators.blocks.material[block]];
        let mut sum = Totals::empty(state);
        let at_points = points.as_chunks::<DEFORMATION>().0.iter().zip(self.histories.weights(block));
        for (p, (f, weight)) in at_points.enumerate() {
            let response = law.response(f.map(|f| f.0[lane]), &self.internal_at(state, block, lane, p));
            sum.strain += weight.0[lane] * response.energy;
            sum.dissipated = sum.dissipated.map(|dissipated| dissipated + weight.0[lane] * response.dissipated);
        }
        sum
    }

    /// x = X + u of node a, where the displacement is known.
    fn position(&self, state: &State, block: usize, lane: usize, a: usize) -> Option<[f64; 2]> {
        let (operators, n) = (&self.operators, self.operators.nodes());
        state.has_displacement().then(|| {
            let x = map::position(&operators.geometry.map_of(block, lane), operators.line.basis.node_2d(a));
            let u = &state.of_block(block, n)[UNKNOWNS * n + a..];
            [x[0] + u[0].0[lane], x[1] + u[n].0[lane]]
        })
    }

    /// Larger of the two rows' |dF_i2/dX_1 - dF_i1/dX_2| at node a.
    fn curl(&self, u: &[F8], block: usize, lane: usize, a: usize) -> f64 {
        let of = |component: usize| self.gradient(u, block, lane, a, component);
        (of(1)[0] - of(0)[1]).abs().max((of(3)[0] - of(2)[1]).abs())
    }

    /// The gradient of a component of a block at node a.
    pub(super) fn gradient(&self, u: &[F8], block: usize, lane: usize, a: usize, component: usize) -> [f64; 2] {
        let (line, n) = (&self.operators.line, self.operators.nodes());
        let (m, i, j) = (line.m, a / line.m, a % line.m);
        let [one, two] = self.operators.geometry.of(block).at_node_of(line, lane, i, j);
        let at = |node: usize| u[component * n + node].0[lane];
        let along1: f64 = (0..m).map(|k| line.slope[i * m + k] * at(k * m + j)).sum();
        let along2: f64 = (0..m).map(|k| line.slope[j * m + k] * at(i * m + k)).sum();
        [0, 1].map(|axis| (along1 * one[axis] + along2 * two[axis]) / determinant(one, two))
    }
}
