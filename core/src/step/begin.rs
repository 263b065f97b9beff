//! `Begin`: what a block does alone in a stage. ADER: grid to points (22), predictor (15)-(21), points to grid (18); RK: the state
//! of the stage. Both: volume term (11)-(12) and traces.

use super::balance::BlockBalance;
use super::block::Block;
use super::block_work::LawWork;
use super::displacement::{DisplacementRate, MeanDisplacement};
use super::loss::FacePoint;
use super::outside::ExternalWork;
use super::phase::Clock;
use super::predictor::transfer::{FieldsToPoints, ToNodes};
use super::predictor::{self, Predictor};
use super::sweeps::Sweep;
use super::unequal::UnequalTraces;
use super::volume;
use super::worst::Worst;
use super::{Method, Part, Phase, Scratch};
use crate::built;
use crate::lane::{Coefficient, F8, Lanes, prefetch};
use crate::material::Material;
use crate::operators::{PointMatrices, Share, with_nodes, with_terms};
use crate::riemann::Looks;
use crate::state::{State, UNKNOWNS};
use crate::tensor::{AXES, DEFORMATION};

/// The work on one block.
pub(super) struct Begin<'a> {
    /// The block.
    pub block: Block<'a>,
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
    /// The work that is done on it from outside; none where nothing outside touches it.
    pub external: Option<&'a mut ExternalWork>,
    /// Its balance of energy; none where it is off.
    pub balance: Option<&'a mut BlockBalance>,
    /// The worst of the blocks so far.
    pub worst: &'a mut Worst,
    /// The thread's arrays.
    pub scratch: &'a mut Scratch,
}

/// Runs `$body` with the point matrices of a block, and with those of the block that begins after it (to ask memory for them; where
/// several blocks share one, the same). One `match` a block.
macro_rules! with_matrices {
    ($begin:expr, $points:expr, [$matrices:ident, $later:ident] => $body:expr) => {{
        let pool = &$points.pool;
        match pool.share[$begin.block.number] {
            Share::Shared(k) => {
                let ($matrices, $later) = (&pool.shared[k], &pool.shared[k]);
                $body
            }
            Share::Own(k) => {
                let later = match $begin.later.map(|later| pool.share[later]) {
                    Some(Share::Own(later)) => later,
                    _ => k,
                };
                let ($matrices, $later) = (&pool.own[k], &pool.own[later]);
                $body
            }
        }
    }};
}

impl Begin<'_> {
    /// The phases.
    pub fn run(mut self) {
        let mut clock = self.scratch.phases.clock();
        match &self.block.scheme.method {
            Method::Ader { .. } => {
                self.phase(Phase::GridToPoints, &mut clock, Self::grid_to_points);
                self.phase(Phase::Predictor, &mut clock, Self::predictor);
                self.phase(Phase::PointsToGrid, &mut clock, Self::points_to_grid);
            }
            Method::RungeKutta(_) => self.phase(Phase::Volume, &mut clock, Self::stage_at_nodes),
        }
        self.phase(Phase::Volume, &mut clock, Self::volume_term);
        self.phase(Phase::Traces, &mut clock, Self::traces);
    }

    /// Does a phase, and books the time that it takes.
    #[inline(always)]
    fn phase(&mut self, phase: Phase, clock: &mut Clock, run: impl FnOnce(&mut Self)) {
        run(self);
        self.scratch.phases.book(phase, clock);
    }

    /// U_p = sum_a Phi_a(X_p) U_a (22), and b and what springs hold at the points.
    fn grid_to_points(&mut self) {
        let (block, Some(points)) = (self.block, self.block.points()) else { return };
        let n = block.scheme.operators.nodes();
        let fields = &block.unknowns(self.state)[..UNKNOWNS * n];
        let Scratch { nodes, points: arrays, phases } = &mut *self.scratch;
        let (nodes, between) = (&mut nodes.stage, &mut arrays.between);
        with_matrices!(self, points, [matrices, later] => {
            ask_for(later, 0);
            let points = &mut arrays.start;
            block.scheme.kernel.run(FieldsToPoints::<_, UNKNOWNS> { matrices, fields, nodes, between, points });
            if !arrays.held.is_empty() {
                let start = phases.start();
                block.held_rate(self.state, &mut arrays.held_at_nodes);
                let (fields, points) = (&arrays.held_at_nodes[..], &mut arrays.held);
                block.scheme.kernel.run(FieldsToPoints::<_, AXES> { matrices, fields, nodes, between, points });
                phases.book_part(Part::Springs, start);
            }
        });
        if built::SOURCES && !block.scheme.sources.is_empty() {
            block.first_sources(points, arrays, phases);
        }
    }

    /// u_s,p <- U_p + dt sum_k At[s,k] r_k,p (15)-(21) and the averages over the step.
    fn predictor(&mut self) {
        let (block, Some(points)) = (self.block, self.block.points()) else { return };
        let (internal, metric) = (block.internal(self.state), points.metric_of(block.number));
        let arrays = &mut self.scratch.points;
        with_matrices!(self, points, [matrices, later] => {
            ask_for(later, 1);
            ForCoefficient::predict(block, Predict { block, matrices, metric, internal, arrays });
        });
        if built::SOURCES && !block.scheme.sources.is_empty() {
            self.scratch.book_ticks_of_sources();
        }
    }

    /// The averages of F, v and P by chi_p(X_a) (18).
    fn points_to_grid(&mut self) {
        let Some(points) = self.block.points() else { return };
        let kernel = self.block.scheme.kernel;
        let Scratch { nodes, points: arrays, .. } = &mut *self.scratch;
        let between = &mut arrays.between;
        with_matrices!(self, points, [matrices, later] => {
            ask_for(later, 2);
            let np = matrices.points();
            let (points, nodes_of) = (&arrays.mean[..UNKNOWNS * np], &mut nodes.mean);
            kernel.run(ToNodes::<_, UNKNOWNS> { matrices, points, between, nodes: nodes_of });
            ask_for(later, 3);
            let (points, nodes_of) = (&arrays.mean_stress[..DEFORMATION * np], &mut nodes.mean_stress);
            kernel.run(ToNodes::<_, DEFORMATION> { matrices, points, between, nodes: nodes_of });
        });
    }

    /// RK: U = U^n + dt sum_j a_ij k_j, and the law at the nodes.
    fn stage_at_nodes(&mut self) {
        self.block.stage_at_nodes(self.state, self.before, &mut self.scratch.nodes);
    }

    /// sum_b K_alpha[a,b] Flux_alpha(q_b) (11)-(12), with sources, and the rate of the displacement.
    fn volume_term(&mut self) {
        let (block, kernel, line) = (self.block, self.block.scheme.kernel, &self.block.scheme.operators.line);
        let (metric, arrays, rate) = (block.metric(), &mut self.scratch.nodes, &mut *self.rate);
        with_terms!(metric, metric => with_nodes!(line.m, M => kernel.run(volume::Volume::<'_, M, _> { line, metric, arrays, rate })));
        if built::SOURCES && !block.scheme.sources.is_empty() {
            block.add_sources(self.scratch, self.rate, self.external.as_deref_mut());
        }
        if self.state.has_displacement() {
            let count = block.scheme.operators.nodes();
            kernel.run(DisplacementRate { mean: &self.scratch.nodes.mean, rate: self.rate, nodes: count });
        }
    }

    /// q at the face points, and the wave speeds there.
    fn traces(&mut self) {
        let (block, kernel, line) = (self.block, self.block.scheme.kernel, &self.block.scheme.operators.line);
        let (looks, metered) = (block.scheme.flux.looks(), self.balance.is_some());
        let width = volume::width(looks, metered);
        let with_displacement = looks == Looks::Displacement;
        if with_displacement {
            let (state, before, nodes) = (self.state, self.before, &mut self.scratch.nodes);
            kernel.run(MeanDisplacement { block, state, before, nodes });
        }
        let (metric, arrays, traces) = (block.metric(), &self.scratch.nodes, &mut *self.traces);
        with_nodes!(line.m, M => if metered {
            kernel.run(volume::Traces::<'_, M, true> { line, metric, arrays, width, with_displacement, traces });
        } else {
            kernel.run(volume::Traces::<'_, M, false> { line, metric, arrays, width, with_displacement, traces });
        });
        if let (true, Some(factors)) = (with_displacement, block.held_traces()) {
            let displacement = &self.scratch.nodes.displacement;
            kernel.run(UnequalTraces { line, factors, displacement, width, traces: self.traces });
        }
        // Later stages of RK are no states: what is wrong with them shows in the state that they make.
        let worst = (block.stage.number == 0).then_some((&mut *self.worst, block.cells()));
        let speeds = volume::Speeds { metric, width, looks, traces: self.traces, worst };
        if block.law().block().speeds_of_traces(kernel, speeds) {
            self.worst.lost_at(FacePoint::find(
                block.scheme.first_number(block.number),
                block.cells(),
                self.traces,
                width,
            ));
        }
    }
}

/// The predictor under the type of the law.
pub(super) struct Predict<'a, C> {
    block: Block<'a>,
    matrices: &'a PointMatrices<C>,
    metric: &'a [F8],
    internal: &'a [F8],
    arrays: &'a mut predictor::Arrays,
}

/// The predictor by the kind of its matrices.
trait ForCoefficient: Coefficient + Sized {
    fn predict(block: Block, work: Predict<Self>);
}

impl ForCoefficient for f64 {
    #[inline]
    fn predict(block: Block, work: Predict<f64>) {
        block.law().block().predict_shared(block.scheme.kernel, work);
    }
}

impl ForCoefficient for F8 {
    #[inline]
    fn predict(block: Block, work: Predict<F8>) {
        block.law().block().predict_own(block.scheme.kernel, work);
    }
}

impl<C: Coefficient> LawWork for Predict<'_, C> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes, M: Material>(self, law: M) {
        let Self { block, matrices, metric, internal, arrays } = self;
        let Method::Ader { time, sweeps } = &block.scheme.method else { return };
        let (weights, dt, kernel) = (&time.weights[..], block.stage.dt, block.scheme.kernel);
        let renew = |sweep: &Sweep, arrays: &mut predictor::Arrays| {
            block.renew_sources(&time.integration, sweep, arrays);
        };
        let moving = built::SOURCES && block.sources_move();
        let renew: Option<predictor::Renew> = if moving { Some(&renew) } else { None };
        Predictor { law: &law, matrices, metric, weights, sweeps, dt, internal, renew, kernel }.run::<L>(arrays);
    }
}

/// Entries of a matrix beyond which the processor sees by itself what comes next; asking for them costs 5 % there.
const SEEN_BY_ITSELF: usize = 128;

/// Asks for one of the matrices of any cloud where each cell has its own, in the order in which they are wanted.
#[inline(always)]
fn ask_for<C: Coefficient>(matrices: &PointMatrices<C>, number: usize) {
    if let (true, PointMatrices::Dense { to_nodes, from_nodes, slope: [one, two] }) = (C::OWN, matrices) {
        let data = &[from_nodes, one, two, to_nodes][number].data;
        if data.len() <= SEEN_BY_ITSELF {
            prefetch(data);
        }
    }
}
