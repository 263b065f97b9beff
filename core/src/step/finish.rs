//! `Finish`: what a block does in a stage with its neighbours' traces: flux (3) and lift (14). After the last stage the update (13),
//! the control of the curl, the internal variables and the survey of what has come out.

use super::balance::BlockBalance;
use super::block::Block;
use super::block_energy::BlockEnergy;
use super::creep::Creep;
use super::lift::Lift;
use super::meetings::Meetings;
use super::meter::Meter;
use super::outside::{ExternalWork, FaceForces, Torques};
use super::phase::Clock;
use super::rotation::Rotation;
use super::sums::Terms;
use super::survey::{Examine, History};
use super::unequal::UnequalLift;
use super::volume::Masses;
use super::worst::Worst;
use super::{Part, Phase, Scratch, Speeds, Survey, across, curl, curl_core};
use crate::built;
use crate::lane::{F8, Lanes, Work};
use crate::operators::curl_free::Relax;
use crate::operators::{with_nodes, with_terms};
use crate::riemann::Looks;
use crate::state::{State, UNKNOWNS};
use crate::tensor::DEFORMATION;

/// The work on one block.
pub(super) struct Finish<'a> {
    /// The block.
    pub block: Block<'a>,
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
    pub external: Option<&'a mut ExternalWork>,
    /// The forces at its faces; none where nobody asks for them.
    pub forces: Option<&'a mut FaceForces>,
    /// The torques there; none where angular momentum is not kept.
    pub torques: Option<&'a mut Torques>,
    /// Its balance of energy; none where it is off.
    pub balance: Option<&'a mut BlockBalance>,
    /// The memory of the conditions at it.
    pub memory: &'a mut [f64],
    /// The creep of its faces; none where they have no springs.
    pub creep: Option<Creep<'a>>,
    /// Where faces meet in the step; none where no condition pairs any.
    pub meetings: Option<&'a Meetings>,
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

impl Finish<'_> {
    /// The phases.
    pub fn run(mut self) {
        let mut clock = self.scratch.phases.clock();
        self.phase(Phase::Flux, &mut clock, Self::flux_and_lift);
        let Some(new) = self.new.take() else { return };
        self.phase(Phase::Corrector, &mut clock, |block| block.update(new.u));
        self.phase(Phase::CurlFree, &mut clock, |block| block.metered_control_of_the_curl(new.u));
        self.histories_and_survey(new);
    }

    /// Does a phase, and books the time that it takes.
    #[inline(always)]
    fn phase(&mut self, phase: Phase, clock: &mut Clock, run: impl FnOnce(&mut Self)) {
        run(self);
        self.scratch.phases.book(phase, clock);
    }

    /// Flux (3) at the face points, conditions of the boundary, and the lift (14) to the nodes.
    fn flux_and_lift(&mut self) {
        let (block, kernel, line) = (self.block, self.block.scheme.kernel, &self.block.scheme.operators.line);
        let (external, balance) = (self.external.as_deref_mut(), self.balance.as_deref_mut());
        let forces = self.forces.as_deref_mut();
        let Scratch { nodes, phases, .. } = &mut *self.scratch;
        let creep = self.creep.as_mut().map(|Creep { start, now }| Creep { start, now });
        let meter = Meter { external, forces, balance, memory: &mut *self.memory, creep, phases };
        block.lifted_fluxes(&self.traces, self.meetings, nodes, meter);
        if let Some(torques) = self.torques.as_deref_mut() {
            block.book_torque(self.state, &nodes.lift, torques);
        }
        let (metric, nodes) = (block.metric(), &*nodes);
        let mut held = (block.scheme.flux.looks() == Looks::Displacement).then_some(&nodes.held[..]);
        if let (Some(all), Some(factors)) = (held, block.held_traces()) {
            let momentum = &mut self.rate[DEFORMATION * line.m * line.m..];
            kernel.run(UnequalLift { line, factors, held: all, rate: momentum });
            held = None;
        }
        let lift = &nodes.lift[..];
        with_terms!(metric, metric => with_nodes!(line.m, M => {
            kernel.run(Lift::<'_, M, _> { line, metric, lift, held, rate: self.rate });
        }));
    }

    /// U^(n+1) = U^n + dt sum_s b_s k_s (13).
    fn update(&mut self, next: &mut [F8]) {
        self.block.scheme.kernel.run(Update(self, next));
    }

    /// The control of the curl, and what is metered before and after it.
    fn metered_control_of_the_curl(&mut self, u: &mut [F8]) {
        self.meter_sources(u);
        self.meter(u, |balance, energy| (balance.corrected, balance.energy) = (energy, energy));
        if built::CURL && self.block.scheme.curl.is_some() {
            self.control_of_the_curl(u);
            self.meter(u, |balance, energy| balance.energy = energy);
        }
    }

    /// Takes rotation and deviator of F - Pi F away at the rate of the compression.
    fn control_of_the_curl(&mut self, u: &mut [F8]) {
        let (kernel, m) = (self.block.scheme.kernel, self.block.scheme.operators.line.m);
        with_nodes!(m, M => kernel.run(Project::<'_, '_, M>(self, u)));
    }

    /// h_(n+1) = law(F, h_n) at the points, then wave speeds and min J of the new state; books its time itself.
    fn histories_and_survey(self, new: New) {
        let (law, Self { block: Block { scheme, number: block, stage }, state, scratch, .. }) =
            (self.block.law(), self);
        let New { u, internal, speed, worst } = new;
        let history = History::Before(scheme.histories.of(state, block), internal, stage.dt);
        law.block().examine(scheme.kernel, Examine { scheme, block, u, history, scratch, speed, worst });
    }

    /// Books the work of sources in the step to `u`.
    fn meter_sources(&mut self, u: &[F8]) {
        if !built::SOURCES || self.block.scheme.sources.is_empty() {
            return;
        }
        let (block, n) = (self.block, self.block.scheme.operators.nodes());
        let Some(external) = self.external.as_deref_mut() else { return };
        let momenta = DEFORMATION * n..UNKNOWNS * n;
        let before = &block.unknowns(self.state)[momenta.clone()];
        block.end_sources(before, &u[momenta], &mut self.scratch.nodes.masses, external);
    }

    /// Books the energy of `u` where the balance is on.
    fn meter(&mut self, u: &[F8], book: impl Fn(&mut BlockBalance, F8)) {
        let (true, Some(balance)) = (built::BALANCE, self.balance.as_deref_mut()) else { return };
        let (Block { scheme, number: block, .. }, dt) = (self.block, self.block.stage.dt);
        let (internal, start) = (self.block.internal(self.state), self.scratch.phases.start());
        let creep = self.creep.as_ref().map_or(&[][..], |creep| &*creep.now);
        book(balance, BlockEnergy { scheme, block, u, internal, creep, dt, scratch: &mut *self.scratch }.find());
        self.scratch.phases.book_part(Part::CellBalance, start);
    }
}

/// The update (13) of a block.
struct Update<'a, 'b>(&'a mut Finish<'b>, &'a mut [F8]);

impl Work for Update<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(Finish { block, state, before, rate, .. }, next) = self;
        let (stride, dt, last) = (rate.len(), block.stage.dt, block.stage.number);
        let factors = (0..last).map(|stage| dt * block.scheme.weight(stage));
        let terms = Terms::new(factors, before, stride, stride).and(dt * block.scheme.weight(last), rate);
        terms.add_to::<L>(block.unknowns(state), next);
    }
}

/// The control of the curl of a block.
struct Project<'a, 'b, const M: usize>(&'a mut Finish<'b>, &'a mut [F8]);

impl<const M: usize> Work for Project<'_, '_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(Finish { block, survey, scratch, .. }, next) = self;
        let operators = &block.scheme.operators;
        let (Some(control), Some(curl_free)) = (block.scheme.curl, &operators.curl_free) else { return };
        let (speed, metric) = (&survey.speed[block.number], block.metric());
        let nodes = &mut scratch.nodes;
        let masses = Masses::<'_, M> { line: &operators.line, metric, masses: &mut nodes.masses };
        let arrays = curl_core::Arrays { weighted: &mut nodes.weighted, coefficients: &mut nodes.coefficients };
        let factor = L::splat(control.rate * block.stage.dt) / L::load(metric.h());
        let c = L::load(&speed.fastest);
        match control.relax {
            Relax::Gradient => {
                let theta = curl::relaxation(c * factor);
                curl::project::<L, M>(curl_free, block.number, theta, masses, arrays, next);
            }
            Relax::Rotation => {
                let law = &block.scheme.laws[operators.blocks.material[block.number]];
                if !law.is_objective() {
                    return;
                }
                let prestress = L::load(&speed.prestress);
                let slowest = if law.has_memory() { 0.0 } else { curl::SLOWEST };
                if slowest == 0.0 && speed.prestress.0.iter().all(|c| *c == 0.0) {
                    return;
                }
                let turn = (L::splat(curl::ROTATION) * prestress).max(L::splat(slowest) * c).min(c);
                let theta = [
                    curl::relaxation(turn * factor),
                    curl::relaxation((L::splat(curl::DEVIATOR) * prestress).min(c) * factor),
                ];
                let rotation = Rotation {
                    curl_free,
                    block: block.number,
                    law,
                    kernel: block.scheme.kernel,
                    gradients: &mut nodes.stage,
                };
                rotation.run::<L, M>(theta, masses, arrays, next);
            }
        }
    }
}
