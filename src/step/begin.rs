//! `begin`: what a block does alone. ADER: G2P, predictor, averages; RK: the stage; both: volume term, traces.

use super::balance::Sums;
use super::health::FacePoint;
use super::outside::{Given, SourceStage};
use super::phase::Clock;
use super::predictor::Predictor;
use super::predictor::transfer::{FieldsToPoints, ToNodes};
use super::stage::AtNodes;
use super::sums::Terms;
use super::survey::Worst;
use super::volume::{self, with_nodes};
use super::{Method, Phase, Scheme, Scratch, Stage};
use crate::lane::{Coefficient, F8, LANES, Lanes, Work, prefetch};
use crate::material::Material;
use crate::mesh::map;
use crate::operators::{PointMatrices, Points, Share};
use crate::riemann::Looks;
use crate::state::{State, UNKNOWNS};
use crate::with_law;

/// The work on one block.
pub(super) struct Block<'a> {
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The stage.
    pub stage: &'a Stage<'a>,
    /// The block.
    pub block: usize,
    /// The block that begins after it, if there is one.
    pub later: Option<usize>,
    /// The state at t_n.
    pub state: &'a State,
    /// dU/dt of the block in earlier stages, [stage][component][node].
    pub before: &'a [F8],
    /// Volume part of J dU/dt of this block, of the displacement all of d/dt (out).
    pub rate: &'a mut [F8],
    /// Traces of this block (out).
    pub traces: &'a mut [F8],
    /// The work that is done on it from outside (begun here at the first stage); none where nothing outside touches it.
    pub given: Option<&'a mut Given>,
    /// Its balance of energy (begun here at the first stage); none where it is off.
    pub sums: Option<&'a mut Sums>,
    /// The worst of the blocks so far.
    pub worst: &'a mut Worst,
    /// The thread's arrays.
    pub scratch: &'a mut Scratch,
}

/// G2P, predictor and P2G.
struct Predict<'a, 'b>(&'a mut Block<'b>, &'a Points, &'a mut Clock);

impl Work for Predict<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(block, points, clock) = self;
        with_law!(&block.scheme.laws[block.scheme.operators.blocks.material[block.block]], law => {
            // A copy: what is stored in the predictor cannot change it, so its constants stay in registers.
            let law = *law;
            block.predict_with::<L, _>(&law, points, clock);
        });
    }
}

/// Sums of several stages.
struct Sum<'a>(Terms<'a>, &'a [F8], &'a mut [F8]);

impl Work for Sum<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.add_to::<L>(self.1, self.2);
    }
}

/// J rho0 b at the nodes, and the displacement: what not every run has.
struct Extras<'a, 'b>(&'a mut Block<'b>);

impl Work for Extras<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(block) = self;
        let operators = &block.scheme.operators;
        let (n, density) = (operators.nodes(), block.scheme.laws[operators.blocks.material[block.block]].density());
        let nodes = &block.scratch.nodes;
        if !block.scheme.sources.is_empty() {
            for (a, mass) in nodes.masses.iter().enumerate() {
                let factor = L::splat(density / operators.line.basis.weight_2d(a)) * L::load(mass);
                for k in 0..2 {
                    let rate = &mut block.rate[(4 + k) * n + a];
                    factor.mul_add(L::load(&nodes.source[k * n + a]), L::load(rate)).store(rate);
                }
            }
            if let Some(given) = block.given.as_deref_mut() {
                let (masses, mean, source) = (&nodes.masses, &nodes.mean, &nodes.source);
                let factor = block.stage.dt * block.scheme.weight(block.stage.number);
                SourceStage { density, factor, masses, mean, source, given }.add::<L>();
            }
        }
        if block.state.has_displacement() {
            for (a, mean) in nodes.mean.as_chunks::<6>().0.iter().enumerate() {
                block.rate[UNKNOWNS * n + a] = mean[4];
                block.rate[(UNKNOWNS + 1) * n + a] = mean[5];
            }
        }
    }
}

/// u at the nodes, averaged as F and v are: of the stage by Runge-Kutta, u^n + dt/2 v by ADER, which is what the mean over the step is
/// to second order; 0 where the displacement is not carried. Less what is not held ([`State::unheld`]).
struct Place<'a, 'b>(&'a mut Block<'b>);

impl Work for Place<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(block) = self;
        let (n, stride, dt) = (block.scheme.operators.nodes(), block.rate.len(), block.stage.dt);
        let nodes = &mut block.scratch.nodes;
        let place = &mut nodes.place.as_chunks_mut::<2>().0[..n];
        if !block.state.has_displacement() {
            place.fill([F8::ZERO; 2]);
            return;
        }
        let unheld = block.state.unheld.chunks_exact(2 * n).nth(block.block);
        let own = UNKNOWNS * n..(UNKNOWNS + 2) * n;
        let start = &block.state.u[stride * block.block..][own.clone()];
        match &block.scheme.method {
            Method::Ader { .. } => {
                let half = L::splat(0.5 * dt);
                for (a, (place, mean)) in place.iter_mut().zip(nodes.mean.as_chunks::<6>().0).enumerate() {
                    for k in 0..2 {
                        half.mul_add(L::load(&mean[4 + k]), L::load(&start[k * n + a])).store(&mut place[k]);
                    }
                }
            }
            Method::RungeKutta(tableau) => {
                for (a, place) in place.iter_mut().enumerate() {
                    *place = [start[a], start[n + a]];
                }
                let row = &tableau.a[block.stage.number];
                for (stage, factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
                    let (rate, factor) = (&block.before[stage * stride..][own.clone()], L::splat(factor * dt));
                    for (a, place) in place.iter_mut().enumerate() {
                        for k in 0..2 {
                            factor.mul_add(L::load(&rate[k * n + a]), L::load(&place[k])).store(&mut place[k]);
                        }
                    }
                }
            }
        }
        if let Some(unheld) = unheld {
            for (a, place) in place.iter_mut().enumerate() {
                for k in 0..2 {
                    (L::load(&place[k]) - L::load(&unheld[k * n + a])).store(&mut place[k]);
                }
            }
        }
    }
}

/// Entries of a matrix beyond which the processor sees by itself what comes next; asking for them costs 5 % there.
const SEEN: usize = 128;

/// Asks for one of the matrices of any cloud where each cell has its own, in the order in which they are wanted.
#[inline(always)]
fn ask_for<C: Coefficient>(matrices: &PointMatrices<C>, number: usize) {
    if let (true, PointMatrices::Dense { to_nodes, from_nodes, slope: [one, two] }) = (C::OWN, matrices) {
        let data = &[from_nodes, one, two, to_nodes][number].data;
        if data.len() <= SEEN {
            prefetch(data);
        }
    }
}

impl Block<'_> {
    /// All of it.
    pub fn run(mut self) {
        let (kernel, operators) = (self.scheme.kernel, &self.scheme.operators);
        let line = &operators.line;
        let metric = &operators.geometry.blocks[self.block];
        let mut clock = self.scratch.phases.clock();
        match &operators.points {
            None => self.stage(&mut clock),
            Some(points) => kernel.run(Predict(&mut self, points, &mut clock)),
        }
        with_nodes!(line.m, M => kernel.run(volume::Volume::<'_, M> {
            line,
            metric,
            arrays: &mut self.scratch.nodes,
            rate: self.rate,
        }));
        if self.stage.number == 0 {
            self.given.iter_mut().for_each(|given| **given = Given::default());
            self.sums.iter_mut().for_each(|sums| **sums = Sums::default());
        }
        if !self.scheme.sources.is_empty() {
            self.source_at_nodes();
            let masses = &mut self.scratch.nodes.masses;
            with_nodes!(line.m, M => { kernel.run(volume::Masses::<'_, M> { line, metric, masses }); });
        }
        if !self.scheme.sources.is_empty() || self.state.has_displacement() {
            kernel.run(Extras(&mut self));
        }
        self.scratch.phases.book(Phase::Volume, &mut clock);
        let (looks, metered) = (self.scheme.flux.looks(), self.sums.is_some());
        let width = volume::width(looks, metered);
        let placed = looks == Looks::Displacement;
        if placed {
            kernel.run(Place(&mut self));
        }
        let (arrays, traces) = (&self.scratch.nodes, &mut *self.traces);
        with_nodes!(line.m, M => if metered {
            kernel.run(volume::Traces::<'_, M, true> { line, metric, arrays, width, placed, traces });
        } else {
            kernel.run(volume::Traces::<'_, M, false> { line, metric, arrays, width, placed, traces });
        });
        let law = &self.scheme.laws[operators.blocks.material[self.block]];
        // Later stages of RK are no states: what is wrong with them shows in the state that they make.
        let worst = (self.stage.number == 0).then_some((&mut *self.worst, operators.blocks.count[self.block]));
        if kernel.run(volume::Speeds { law, metric, width, looks, traces: self.traces, worst }) {
            let count = operators.blocks.count[self.block];
            self.worst.lost_at(FacePoint::find(self.block, count, self.traces, width));
        }
        self.scratch.phases.book(Phase::Traces, &mut clock);
    }

    /// Runge-Kutta: U = U^n + dt sum_j a_ij k_j, and the law at the nodes.
    fn stage(&mut self, clock: &mut Clock) {
        let (scheme, n, stride) = (self.scheme, self.scheme.operators.nodes(), self.rate.len());
        let Method::RungeKutta(tableau) = &scheme.method else { return };
        let nodes = &mut self.scratch.nodes;
        // The law needs the six of U alone.
        let start = &self.state.u[stride * self.block..][..UNKNOWNS * n];
        let factors = tableau.a[self.stage.number].iter().map(|a| a * self.stage.dt);
        let terms = Terms::new(factors, self.before, stride, UNKNOWNS * n);
        let (start, term) = match terms.few() {
            Some(term) => (start, term),
            None => {
                scheme.kernel.run(Sum(terms, start, &mut nodes.stage[..UNKNOWNS * n]));
                (&nodes.stage[..UNKNOWNS * n], None)
            }
        };
        let law = &scheme.laws[scheme.operators.blocks.material[self.block]];
        let (mean, stress) = (&mut nodes.mean[..6 * n], &mut nodes.mean_stress[..4 * n]);
        let internal = scheme.histories.of(&self.state.internal, self.block);
        scheme.kernel.run(AtNodes { law, start, term, internal, mean, stress });
        self.scratch.phases.book(Phase::Volume, clock);
    }

    #[inline(always)]
    fn predict_with<L: Lanes, M: Material>(&mut self, law: &M, points: &Points, clock: &mut Clock) {
        match points.pool.share[self.block] {
            Share::Shared(k) => self.predict::<L, M, _>(law, points, [&points.pool.shared[k]; 2], clock),
            Share::Own(k) => {
                let later = match self.later.map(|later| points.pool.share[later]) {
                    Some(Share::Own(later)) => later,
                    _ => k,
                };
                let own = &points.pool.own;
                self.predict::<L, M, _>(law, points, [&own[k], &own[later]], clock);
            }
        }
    }

    /// ADER: G2P (22), predictor (15)-(21), P2G of the averages (18). Of the matrices the second are those of a block that
    /// comes later: where each block has its own, they are most of what memory brings, and are asked for piece by piece.
    #[inline(always)]
    fn predict<L: Lanes, M: Material, C: Coefficient>(
        &mut self,
        law: &M,
        points: &Points,
        [matrices, later]: [&PointMatrices<C>; 2],
        clock: &mut Clock,
    ) {
        ask_for(later, 0);
        let Method::Ader { time, sweeps } = &self.scheme.method else { return };
        let (kernel, n, np) = (self.scheme.kernel, self.scheme.operators.nodes(), matrices.points());
        let stride = self.rate.len();
        let start = &self.state.u[stride * self.block..stride * (self.block + 1)];
        let (nodes, arrays) = (&mut self.scratch.nodes.stage, &mut self.scratch.points);
        let (fields, between, points_of) = (&start[..6 * n], &mut arrays.between, &mut arrays.start);
        kernel.run(FieldsToPoints::<C, 6> { matrices, fields, nodes, between, points: points_of });
        if !self.scheme.sources.is_empty() {
            self.source_at_points(points, np);
        }
        self.scratch.phases.book(Phase::GridToPoints, clock);
        ask_for(later, 1);
        let (metric, weights, dt) = (points.metric_of(self.block), &time.weights[..], self.stage.dt);
        let internal = self.scheme.histories.of(&self.state.internal, self.block);
        let predictor = Predictor { law, matrices, metric, weights, sweeps, dt, internal, kernel };
        predictor.run::<L>(&mut self.scratch.points);
        self.scratch.phases.book(Phase::Predictor, clock);
        ask_for(later, 2);
        let (arrays, nodes) = (&mut self.scratch.points, &mut self.scratch.nodes);
        let (points, between) = (&arrays.mean[..6 * np], &mut arrays.between);
        kernel.run(ToNodes::<C, 6> { matrices, points, between, nodes: &mut nodes.mean });
        ask_for(later, 3);
        let (points, between) = (&arrays.mean_stress[..4 * np], &mut arrays.between);
        kernel.run(ToNodes::<C, 4> { matrices, points, between, nodes: &mut nodes.mean_stress });
        self.scratch.phases.book(Phase::PointsToGrid, clock);
    }

    /// b at the points and time nodes.
    fn source_at_points(&mut self, points: &Points, np: usize) {
        for lane in 0..LANES {
            let corners = self.scheme.operators.geometry.corners_of(self.block, lane);
            for p in 0..np {
                let at = points.first[self.block] + p;
                let x = map::position(&corners, [0, 1].map(|k| points.parent[2 * at + k].0[lane]));
                for (s, node) in self.stage.times.iter().enumerate() {
                    let b = self.acceleration(x, node.time, lane);
                    for (k, b) in b.into_iter().enumerate() {
                        self.scratch.points.source[2 * (s * np + p) + k].0[lane] = b;
                    }
                }
            }
        }
    }

    /// b at the nodes, averaged over the time nodes.
    fn source_at_nodes(&mut self) {
        let n = self.scheme.operators.nodes();
        for lane in 0..LANES {
            let corners = self.scheme.operators.geometry.corners_of(self.block, lane);
            for a in 0..n {
                let x = map::position(&corners, self.scheme.operators.line.basis.node_2d(a));
                let mut mean = [0.0; 2];
                for node in self.stage.times {
                    let b = self.acceleration(x, node.time, lane);
                    mean = [0, 1].map(|k| mean[k] + node.weight * b[k]);
                }
                (0..2).for_each(|k| self.scratch.nodes.source[k * n + a].0[lane] = mean[k]);
            }
        }
    }

    /// Sum of all sources; padding lanes stay at rest.
    fn acceleration(&self, x: [f64; 2], time: f64, lane: usize) -> [f64; 2] {
        let blocks = &self.scheme.operators.blocks;
        if lane >= blocks.count[self.block] {
            return [0.0; 2];
        }
        self.scheme.sources.iter().fold([0.0; 2], |sum, source| {
            let b = source.acceleration(x, time, blocks.material[self.block]);
            [sum[0] + b[0], sum[1] + b[1]]
        })
    }
}
