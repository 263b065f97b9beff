//! `finish`: with the neighbours' traces, flux (3), lift (14), and after the last stage the update (13), the control of the
//! curl, the internal variables and the survey of what has come out.

use super::balance::Sums;
use super::block_energy::BlockEnergy;
use super::curl;
use super::outside::{Given, SourceEnd};
use super::sums::Terms;
use super::survey::{Examine, History, Worst};
use super::volume::{Masses, cofactors, row, with_nodes};
use super::{Phase, Scheme, Scratch, Speeds, Stage, Survey, across, flux};
use crate::lane::{F8, Lanes, Work};
use crate::operators::curl_free::Relax;
use crate::operators::{Line, Metric, determinant};
use crate::riemann::Looks;
use crate::state::State;

/// The work on one block.
pub(super) struct Block<'a> {
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The stage.
    pub stage: &'a Stage<'a>,
    /// The block.
    pub block: usize,
    /// The state at t_n.
    pub state: &'a State,
    /// Its wave speeds.
    pub survey: &'a Survey,
    /// dU/dt of the block in earlier stages, [stage][component][node].
    pub before: &'a [F8],
    /// Volume part of J dU/dt of this block in, dU/dt out.
    pub rate: &'a mut [F8],
    /// Traces under way.
    pub traces: across::Traces<'a>,
    /// What the last stage makes; none before it.
    pub new: Option<New<'a>>,
    /// The work that is done on it from outside; none where nothing outside touches it.
    pub given: Option<&'a mut Given>,
    /// Its balance of energy; none where it is off.
    pub sums: Option<&'a mut Sums>,
    /// The thread's arrays.
    pub scratch: &'a mut Scratch,
}

/// A block after the step (out).
pub(super) struct New<'a> {
    /// Its unknowns.
    pub u: &'a mut [F8],
    /// Its internal variables.
    pub internal: &'a mut [F8],
    /// Its wave speeds.
    pub speed: &'a mut Speeds,
    /// The worst of the blocks so far.
    pub worst: &'a mut Worst,
}

impl Block<'_> {
    /// All of it.
    pub fn run(mut self) {
        let (kernel, operators) = (self.scheme.kernel, &self.scheme.operators);
        let mut clock = self.scratch.phases.clock();
        let place = flux::Place { scheme: self.scheme, stage: self.stage, block: self.block };
        let books = flux::Books { given: self.given.as_deref_mut(), sums: self.sums.as_deref_mut() };
        flux::lift(place, &self.traces, &mut self.scratch.nodes, books);
        let (line, metric, nodes) = (&operators.line, place.metric(), &self.scratch.nodes);
        let held = (self.scheme.flux.looks() == Looks::Displacement).then_some(&nodes.held[..]);
        let lift = &nodes.lift[..];
        with_nodes!(line.m, M => kernel.run(Lift::<'_, M> { line, metric, lift, held, rate: self.rate }));
        self.scratch.phases.book(Phase::Flux, &mut clock);
        let Some(New { u, internal, speed, worst }) = self.new.take() else { return };
        kernel.run(Update(&mut self, u));
        self.scratch.phases.book(Phase::Corrector, &mut clock);
        if !self.scheme.sources.is_empty() {
            self.meter_sources(u);
        }
        self.meter(u, |sums, energy| (sums.corrected, sums.energy) = (energy, energy));
        if self.scheme.curl.is_some() {
            with_nodes!(line.m, M => kernel.run(Project::<'_, '_, M>(&mut self, u)));
            self.meter(u, |sums, energy| sums.energy = energy);
        }
        self.scratch.phases.book(Phase::CurlFree, &mut clock);
        let Self { scheme, block, scratch, .. } = self;
        let history = History::Before(scheme.histories.of(&self.state.internal, block), internal);
        kernel.run(Examine { scheme, block, u, history, scratch, speed, worst });
    }
}

/// The update (13) of a block.
struct Update<'a, 'b>(&'a mut Block<'b>, &'a mut [F8]);

impl Work for Update<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.update::<L>(self.1);
    }
}

/// The control of the curl of a block.
struct Project<'a, 'b, const M: usize>(&'a mut Block<'b>, &'a mut [F8]);

impl<const M: usize> Work for Project<'_, '_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.project::<L, M>(self.1);
    }
}

impl Block<'_> {
    /// Books the work of sources in the step to `u`.
    fn meter_sources(&mut self, u: &[F8]) {
        let Some(given) = self.given.as_deref_mut() else { return };
        let (operators, n, stride) = (&self.scheme.operators, self.scheme.operators.nodes(), self.rate.len());
        let (line, metric) = (&operators.line, &operators.geometry.blocks[self.block]);
        let masses = &mut self.scratch.nodes.masses;
        with_nodes!(line.m, M => { self.scheme.kernel.run(Masses::<'_, M> { line, metric, masses }); });
        let momenta = 4 * n..6 * n;
        let before = &self.state.u[stride * self.block..][momenta.clone()];
        self.scheme.kernel.run(SourceEnd { masses, before, after: &u[momenta], given });
    }

    /// Books the energy of `u` where the balance is on.
    fn meter(&mut self, u: &[F8], book: impl Fn(&mut Sums, F8)) {
        let Some(sums) = self.sums.as_deref_mut() else { return };
        let (scheme, block) = (self.scheme, self.block);
        let internal = scheme.histories.of(&self.state.internal, block);
        book(sums, BlockEnergy { scheme, block, u, internal, scratch: self.scratch }.find());
    }

    /// U^(n+1) = U^n + dt sum_s b_s k_s.
    #[inline(always)]
    fn update<L: Lanes>(&mut self, next: &mut [F8]) {
        let (stride, dt, last) = (self.rate.len(), self.stage.dt, self.stage.number);
        let begin = stride * self.block;
        let factors = (0..last).map(|stage| dt * self.scheme.weight(stage));
        let terms = Terms::new(factors, self.before, stride, stride).and(dt * self.scheme.weight(last), self.rate);
        terms.add_to::<L>(&self.state.u[begin..begin + stride], next);
    }

    /// The control of the curl of F.
    #[inline(always)]
    fn project<L: Lanes, const M: usize>(&mut self, next: &mut [F8]) {
        let operators = &self.scheme.operators;
        let (Some(control), Some(curl_free)) = (self.scheme.curl, &operators.curl_free) else { return };
        let (speed, metric) = (&self.survey.speed[self.block], &operators.geometry.blocks[self.block]);
        let nodes = &mut self.scratch.nodes;
        let masses = Masses::<'_, M> { line: &operators.line, metric, masses: &mut nodes.masses };
        let arrays = curl::Arrays { weighted: &mut nodes.weighted, coefficients: &mut nodes.coefficients };
        let factor = L::splat(control.rate * self.stage.dt) / L::load(&metric.h);
        let c = L::load(&speed.fastest);
        match control.relax {
            Relax::Gradient => {
                let theta = curl::relaxation(c * factor);
                curl::project::<L, M>(curl_free, self.block, theta, masses, arrays, next);
            }
            Relax::Rotation => {
                let law = &self.scheme.laws[operators.blocks.material[self.block]];
                if !law.is_objective() {
                    return;
                }
                let prestress = L::load(&speed.prestress);
                let slowest = if law.internal().is_empty() { curl::SLOWEST } else { 0.0 };
                if slowest == 0.0 && speed.prestress.0.iter().all(|c| *c == 0.0) {
                    return;
                }
                let turn = (L::splat(curl::ROTATION) * prestress).max(L::splat(slowest) * c).min(c);
                let theta = [
                    curl::relaxation(turn * factor),
                    curl::relaxation((L::splat(curl::DEVIATOR) * prestress).min(c) * factor),
                ];
                let rotation = curl::Rotation { curl_free, block: self.block, law, gradients: &mut nodes.stage };
                rotation.run::<L, M>(theta, masses, arrays, next);
            }
        }
    }
}

/// The sum over the faces of what is lifted to node (i, j), number k of W.
#[inline(always)]
fn at_node<L: Lanes, const W: usize, const M: usize>(
    lift: &[[F8; W]],
    ends: &[[f64; M]; 2],
    [i, j]: [usize; 2],
    k: usize,
) -> L {
    let mut sum = L::splat(ends[0][i]) * L::load(&lift[j][k]);
    sum = L::splat(ends[1][i]).mul_add(L::load(&lift[M + j][k]), sum);
    sum = L::splat(ends[0][j]).mul_add(L::load(&lift[2 * M + i][k]), sum);
    L::splat(ends[1][j]).mul_add(L::load(&lift[3 * M + i][k]), sum)
}

/// dU_a/dt = (J dU_a/dt - Phi_a(x_fk) w_k lifted_fk / w_a) / J_a; w_k and one factor of w_a are the same number.
struct Lift<'a, const M: usize> {
    line: &'a Line,
    metric: &'a Metric<F8>,
    /// [face][point][6].
    lift: &'a [F8],
    /// [face][point][2], by the traces of what is held; none where the flux holds nothing.
    held: Option<&'a [F8]>,
    rate: &'a mut [F8],
}

impl<const M: usize> Work for Lift<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = M * M;
        let ends = [row::<M>(&self.line.lift[0]), row::<M>(&self.line.lift[1])];
        let lift = &self.lift.as_chunks::<6>().0[..4 * M];
        let [one, two] = cofactors::<L, M>(self.line, &self.metric.load::<L>());
        let mut inverse = [[L::zero(); M]; M];
        for i in 0..M {
            for j in 0..M {
                inverse[i][j] = L::splat(1.0) / determinant(one[i], two[j]);
            }
        }
        for (k, rate) in self.rate.chunks_exact_mut(n).enumerate().take(6) {
            for (i, inverse) in inverse.iter().enumerate() {
                for (j, inverse) in inverse.iter().enumerate() {
                    let a = i * M + j;
                    let sum = at_node::<L, 6, M>(lift, &ends, [i, j], k);
                    ((L::load(&rate[a]) - sum) * *inverse).store(&mut rate[a]);
                }
            }
        }
        let Some(held) = self.held else { return };
        let ends = [row::<M>(&self.line.held_lift[0]), row::<M>(&self.line.held_lift[1])];
        let held = &held.as_chunks::<2>().0[..4 * M];
        for (k, rate) in self.rate[4 * n..6 * n].chunks_exact_mut(n).enumerate() {
            for (i, inverse) in inverse.iter().enumerate() {
                for (j, inverse) in inverse.iter().enumerate() {
                    let a = i * M + j;
                    let sum = at_node::<L, 2, M>(held, &ends, [i, j], k);
                    (-*inverse).mul_add(sum, L::load(&rate[a])).store(&mut rate[a]);
                }
            }
        }
    }
}
