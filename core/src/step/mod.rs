//! One step of the method, as in section 5 of the paper.
//!
//! Each block of 8 cells begins (`begin`): grid to points (22), predictor (15)-(21), points to grid (18), volume term (11)-(12),
//! traces. With the traces of its neighbours it finishes (`finish`): flux (3), lift (14), update (13), control of the curl,
//! internal variables, survey. `schedule` has the order of the blocks. [`Motion`] goes from step to step; [`Scheme`] is
//! read-only, [`State`] is all that changes, [`Work`] carries nothing from step to step: threads, restart and regrid follow
//! from that.

mod acceleration;
mod across;
mod angular_momentum;
mod at_points;
mod balance;
mod begin;
mod block;
mod block_work;
mod block_energy;
mod block_totals;
mod boundary_memory;
pub mod cfl;
mod compiled;
mod corrected_stages;
mod correction;
mod creep;
mod curl;
mod curl_core;
mod dense;
mod displacement;
mod energy;
mod face_balance;
mod finish;
mod flux;
mod flux_of_blocks;
mod health;
mod held_rate;
pub mod history;
mod law;
mod law_cost;
mod lift;
mod loss;
mod meeting_flux;
mod meetings;
mod meter;
mod motion;
mod numbers;
mod obstacles;
mod outside;
mod parts;
mod partition;
pub mod phase;
mod predictor;
mod ranks;
mod received;
mod rescue;
mod rotation;
mod runge_kutta;
mod schedule;
mod scheme;
mod segments;
mod shape;
mod shared;
mod shares;
mod sides;
mod single_face;
mod single_fluxes;
mod sources;
mod springs;
mod stage;
mod sums;
mod survey;
pub mod sweeps;
mod tile_memory;
mod tiles;
mod trace;
mod unequal;
mod volume;
mod weights;
mod whole_faces;
mod worst;

pub use crate::operators::curl_free::Relax;
pub use balance::Balance;
pub use boundary_memory::PointWithMemory;
pub use correction::{Corrected, Correction, Counts, Made, Notes};
pub use curl::Control;
pub use energy::{EnergyMade, Totals};
pub use flux_of_blocks::Flux;
pub use history::Histories;
pub use law::Law;
pub use loss::{Loss, LossKind, Site};
pub use meetings::Pairing;
pub use motion::Motion;
pub use phase::{Part, Phase, Phases};
pub use rescue::Rescue;
pub use runge_kutta::Tableau;
pub use scheme::{Method, Scheme};
pub use segments::DeepestOverlap;
pub use shares::{Imbalance, Shares};
pub use survey::{Speeds, Survey};
pub use sweeps::Sweeps;

use crate::boundary::TimeNode;
use crate::built;
use crate::lane::{F8, ticks};
use crate::state::State;
use begin::Begin;
use finish::Finish;
use runge_kutta::MOST_STAGES;
use std::sync::Mutex;

/// Memory that a step writes and that nothing reads from an earlier step.
pub struct Work {
    /// The new state, once the step is done; the caller swaps it in if it is healthy.
    pub next: State,
    /// Its wave speeds, see [`Survey`].
    speed: Vec<survey::Speeds>,
    /// Rates and traces under way.
    tiles: tile_memory::Tiles,
    /// The work that the outside did in the step.
    outside: outside::Outside,
    /// The balance of the step, by block; none where nobody asks for it.
    balance: Option<Vec<balance::BlockBalance>>,
    /// What the turning of bodies has taken of their energy in the step, J/m; see [`Scheme::keeping_angular_momentum`].
    turning_loss: f64,
    /// The angular momentum that was not restored since the last report of it, kg m/s.
    not_restored: f64,
    /// The memory of corrections and rescue; none where there are none.
    corrections: Option<Box<correction::Memory>>,
    /// Where faces meet in the step; none where no condition pairs any.
    meetings: Option<Box<meetings::Meetings>>,
    /// Faces under obstacles; none where no condition is one.
    obstacles: Option<Box<obstacles::Obstacles>>,
    /// One a thread.
    scratch: Vec<Mutex<Scratch>>,
    /// The clock of the phases.
    rate: phase::Rate,
}

/// Arrays of one block, and the seconds that its thread spent on each phase.
#[derive(Default)]
pub(crate) struct Scratch {
    pub points: predictor::Arrays,
    pub nodes: volume::Arrays,
    pub phases: phase::Ticks,
}

impl Scratch {
    /// For the blocks of `scheme` and states like `state`, without a clock.
    fn new(scheme: &Scheme, state: &State) -> Self {
        let operators = &scheme.operators;
        let points =
            operators.points.as_ref().map_or(0, |p| p.first.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0));
        let creep = if state.creep.is_empty() { 0 } else { scheme.creep_of_block() };
        let added = predictor::Added { sources: !scheme.sources.is_empty(), springs: creep > 0 };
        Self {
            points: predictor::Arrays::new(points, operators.line.m, &scheme.method, added),
            nodes: volume::Arrays::new(operators.line.m, state.components, creep),
            phases: phase::Ticks::default(),
        }
    }

    /// For what a state of `scheme` stores.
    fn for_energy(scheme: &Scheme, state: &State) -> Self {
        match scheme.histories.is_empty() {
            true => {
                Self { nodes: volume::Arrays::new(scheme.operators.line.m, state.components, 0), ..Self::default() }
            }
            false => Self::new(scheme, state),
        }
    }
}

impl Work {
    /// Memory for steps of `scheme` on states like `state`, for the current number of threads.
    pub fn new(scheme: &Scheme, state: &State) -> Self {
        let operators = &scheme.operators;
        let scratch = || {
            let phases = phase::Ticks::of(2 * operators.blocks.len() * scheme.stages());
            Mutex::new(Scratch { phases, ..Scratch::new(scheme, state) })
        };
        let tiles = tile_memory::Tiles::new(scheme, state.components * operators.nodes());
        Self {
            next: Self::next_of(&tiles, scheme, state),
            speed: vec![survey::Speeds::default(); operators.blocks.len()],
            tiles,
            outside: outside::Outside::new(scheme),
            balance: None,
            turning_loss: 0.0,
            not_restored: 0.0,
            corrections: correction::Memory::new(scheme, state),
            meetings: meetings::Meetings::new(scheme),
            obstacles: obstacles::Obstacles::new(scheme).filter(|_| built::OBSTACLES),
            scratch: (0..rayon::current_num_threads().max(1)).map(|_| scratch()).collect(),
            rate: phase::Rate::start(),
        }
    }

    /// Seconds per phase, summed over threads, since the last call.
    pub fn take_phases(&mut self) -> Phases {
        let (mut sum, rate) = (Phases::default(), self.rate.measure());
        for scratch in &mut self.scratch {
            let scratch = scratch.get_mut().unwrap_or_else(|poisoned| poisoned.into_inner());
            sum.add(&scratch.phases.take(rate));
        }
        sum
    }

    /// Adds the step that was done last to the shares of threads and ranks, see [`Shares`].
    pub fn add_shares(&mut self, to: &mut Shares) {
        let rate = &self.rate;
        self.tiles.add_shares(|| rate.measure(), to);
    }

    /// Bytes that are held for single effects, see [`Held`].
    pub fn held(&self) -> Held {
        let corrections = self.corrections.as_ref().map_or(0, |memory| memory.bytes());
        let rescue = self.corrections.as_ref().map_or(0, |memory| memory.rescue.as_ref().map_or(0, |own| own.bytes()));
        Held {
            balance: self.balance.as_ref().map_or(0, |blocks| size_of_val(&blocks[..])),
            forces: self.outside.forces.as_ref().map_or(0, |forces| size_of_val(&forces[..])),
            corrections: corrections - rescue,
            turning: self.outside.torques.as_ref().map_or(0, |torques| size_of_val(&torques[..])),
            rescue,
            // Before and after the step, and that of a block for each thread.
            springs: (2 * self.next.creep.len() + self.creep_of_threads()) * size_of::<F8>(),
        }
    }

    /// Numbers of the creep that threads hold, in lanes.
    fn creep_of_threads(&self) -> usize {
        let of = |scratch: &Mutex<Scratch>| scratch.lock().map_or(0, |own| own.nodes.creep.len());
        self.scratch.iter().map(of).sum()
    }

    /// The energy that contact and cohesive edges store in `state`, J/m.
    pub fn stored_in_contact(&mut self, scheme: &Scheme, state: &State) -> f64 {
        self.meetings.as_mut().map_or(0.0, |meetings| meetings.stored(scheme, state))
    }

    /// The deepest overlap of bodies in the steps so far; none where no condition pairs any.
    pub fn overlap(&self) -> Option<DeepestOverlap> {
        self.meetings.as_ref().map(|meetings| meetings.deepest)
    }

    /// Where a body was deepest in an obstacle at the start of a step so far; none where no condition is an obstacle.
    pub fn in_obstacle(&self) -> Option<DeepestOverlap> {
        self.obstacles.as_ref().map(|obstacles| obstacles.deepest)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let next = self.next.u.len() + self.next.internal.len() + self.next.creep.len();
        let numbers = next + 2 * self.speed.len() + self.tiles.numbers();
        numbers * size_of::<F8>()
            + self.outside.bytes()
            + self.balance.as_ref().map_or(0, |blocks| size_of_val(&blocks[..]))
            + self.corrections.as_ref().map_or(0, |memory| memory.bytes())
            + self.meetings.as_ref().map_or(0, |meetings| meetings.bytes())
            + self.obstacles.as_ref().map_or(0, |obstacles| obstacles.bytes())
    }
}

/// Bytes that the memory of steps holds for single effects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Held {
    /// The balance of energy.
    pub balance: usize,
    /// The meter of forces.
    pub forces: usize,
    /// Limiter and other corrections.
    pub corrections: usize,
    /// The torques of angular momentum that is kept.
    pub turning: usize,
    /// The rescue.
    pub rescue: usize,
    /// The creep of faces with springs.
    pub springs: usize,
}

/// A stage of a step; ADER has one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage<'a> {
    /// Its number, from 0.
    pub number: usize,
    /// The time nodes over which data that depends on time is averaged.
    pub times: &'a [TimeNode],
    /// Runge-Kutta: a_ij of this stage i, U = U^n + dt sum_j a_ij k_j; empty for ADER.
    pub row: &'a [f64],
    /// Step, s.
    pub dt: f64,
    /// From t_n to a Runge-Kutta stage, c_i dt, s; 0 for ADER, whose time nodes have their own.
    pub elapsed: f64,
    /// Faces under obstacles at the start of the step; none where no condition is one.
    obstacles: Option<&'a obstacles::Obstacles>,
}

/// Runs `body` with the scratch of the current thread. Uncontended: a thread holds one block at a time.
pub(crate) fn with_scratch<R>(scratch: &[Mutex<Scratch>], body: impl FnOnce(&mut Scratch) -> R) -> R {
    let thread = rayon::current_thread_index().unwrap_or(0) % scratch.len();
    let mut guard = scratch[thread].lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    body(&mut guard)
}

impl Scheme {
    /// Advances `state`, whose survey this is, by `dt` into `work.next`; [`Scheme::surveyed`] has the survey of the result.
    /// [`Motion`] does both.
    pub fn step(&self, state: &State, dt: f64, survey: &Survey, work: &mut Work) {
        self.step_to(state, survey, dt, state.time + dt, work);
    }

    /// The same; the time of the result is `time`: t + dt, but for a rounding.
    fn step_to(&self, state: &State, survey: &Survey, dt: f64, time: f64, work: &mut Work) {
        let (begin, finish) = (|block: Begin| block.run(), |block: Finish| block.run());
        if let (true, Some(meetings)) = (built::CONTACT, &mut work.meetings) {
            meetings.find(self, state);
        }
        // Out of the memory that the blocks write while they read it.
        let mut own = work.obstacles.take();
        if let Some(obstacles) = &mut own {
            obstacles.look(self, state);
        }
        let obstacles = own.as_deref();
        match &self.method {
            Method::Ader { time: basis, .. } => {
                let node = |(tau, weight): (&f64, &f64)| TimeNode { time: state.time + tau * dt, weight: *weight };
                // At most 7 nodes: on the stack, no allocation in a step.
                let mut times = [TimeNode { time: 0.0, weight: 0.0 }; 8];
                times.iter_mut().zip(basis.tau.iter().zip(&basis.weights)).for_each(|(t, n)| *t = node(n));
                let stage = Stage { number: 0, times: &times[..basis.len()], row: &[], dt, elapsed: 0.0, obstacles };
                self.on_all_blocks(&[stage], (state, survey), work, begin, finish);
            }
            Method::RungeKutta(tableau) => {
                let mut times = [[TimeNode { time: 0.0, weight: 1.0 }]; MOST_STAGES];
                times.iter_mut().zip(&tableau.c).for_each(|(node, c)| node[0].time = state.time + c * dt);
                // Where corrections act on stages, blocks begin with what they have made of the sum.
                let summed = work.corrections.as_ref().is_some_and(|memory| memory.stage.is_some());
                let rows = if summed { &[][..] } else { &tableau.a[..] };
                let row = |number: usize| rows.get(number).map_or(&[][..], |row| &row[..]);
                let stages: [Stage; MOST_STAGES] = std::array::from_fn(|number| {
                    let elapsed = tableau.c.get(number).map_or(0.0, |c| c * dt);
                    Stage { number, times: &times[number], row: row(number), dt, elapsed, obstacles }
                });
                self.on_all_blocks(&stages[..tableau.stages()], (state, survey), work, begin, finish);
            }
        }
        work.obstacles = own;
        work.next.time = time;
        work.next.step = state.step + 1;
        if work.is_shared() {
            work.share(self);
        }
        if built::CORRECTIONS && work.corrections.is_some() {
            let start = ticks();
            self.correct(state, dt, work);
            let scratch = work.scratch[0].get_mut().unwrap_or_else(|poisoned| poisoned.into_inner());
            scratch.phases.add(Phase::Corrections, ticks().wrapping_sub(start));
        }
    }

    /// What the rate of a stage counts in U^(n+1) = U^n + dt sum_s b_s k_s; 1 for ADER.
    fn weight(&self, stage: usize) -> f64 {
        match &self.method {
            Method::Ader { .. } => 1.0,
            Method::RungeKutta(tableau) => tableau.b[stage],
        }
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod sweep_tests;
#[cfg(test)]
mod rotation_tests;
