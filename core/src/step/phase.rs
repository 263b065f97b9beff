//! The cost report: seconds per phase of the step, under the paper's names.

use crate::lane::{counted, ticks};
use std::time::Instant;

/// A phase of the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum Phase {
    /// Grid to points (22).
    GridToPoints,
    /// Local space-time predictor (15)-(21).
    Predictor,
    /// Points to grid of the time averages (18).
    PointsToGrid,
    /// Volume term of the corrector (11)-(12), and for RK the law at the nodes.
    Volume,
    /// Traces at the faces.
    Traces,
    /// Interface flux (3), boundary conditions and lift (14).
    Flux,
    /// Update of the unknowns (13).
    Corrector,
    /// The control of the curl of F.
    CurlFree,
    /// Law and health at the points: wave speeds, min J.
    Survey,
    /// Corrections of the new state, and the survey of what they changed.
    Corrections,
}

/// Number of phases.
pub const PHASES: usize = 10;

/// Names as printed, in the order of [`Phase`].
pub const NAMES: [&str; PHASES] = [
    "grid to points (22)",
    "predictor (15)-(21)",
    "points to grid (18)",
    "volume term (11)",
    "traces",
    "flux (3), (14)",
    "corrector (13)",
    "control of the curl",
    "survey (law at points)",
    "corrections",
];

/// A part of phases that a scene asks for: its time counts in the phases too.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum Part {
    /// Conditions at the boundary, and fluxes between materials: in the flux.
    Conditions,
    /// Sources: with grid to points, in the predictor and in the volume term.
    Sources,
    /// The balance of energy at the faces between cells: in the flux.
    FaceBalance,
    /// The energy of the cells for the balance: with the control of the curl.
    CellBalance,
    /// Bodies that keep their angular momentum: with the corrections.
    AngularMomentum,
    /// What springs in the faces give the predictor of ADER. In the flux they have no clock of their own; at boundaries and between materials
    /// they are with the conditions.
    Springs,
}

/// Number of parts.
pub const PARTS: usize = 6;

/// Seconds per phase.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phases {
    /// Seconds, in the order of [`Phase`].
    pub seconds: [f64; PHASES],
    /// Seconds of parts of them, in the order of [`Part`].
    pub parts: [f64; PARTS],
}

impl Phases {
    /// Adds another's seconds.
    pub fn add(&mut self, other: &Phases) {
        self.seconds.iter_mut().zip(other.seconds).for_each(|(a, b)| *a += b);
        self.parts.iter_mut().zip(other.parts).for_each(|(a, b)| *a += b);
    }
}

/// Reads the clock between phases. The phases of a block last about a microsecond: the processor's own counter is read,
/// at a tenth of the cost of the system's clock, and where there are many blocks only for some of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    /// Ticks at the start of the phase.
    start: u64,
    /// For how many blocks it stands; 0 where it is not read.
    weight: u32,
}

/// Ticks per phase of one thread.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ticks {
    sums: [u64; PHASES],
    parts: [u64; PARTS],
    /// For how many blocks the one under way stands; 0 where the clock is not read.
    weight: u32,
    /// The clock is read for one in so many; 0 is as 1.
    every: u32,
    /// Since it was read.
    turn: u32,
}

impl Ticks {
    /// For a thread that begins and finishes blocks `events` times a step: where that is often, one in seven is looked at, a
    /// number that no pattern of stages is a multiple of.
    pub fn of(events: usize) -> Self {
        Self { every: if events > 200 { 7 } else { 1 }, ..Self::default() }
    }

    /// Starts, for one block.
    #[inline(always)]
    pub fn clock(&mut self) -> Clock {
        self.turn += 1;
        if self.turn < self.every {
            self.weight = 0;
            return Clock { start: 0, weight: 0 };
        }
        self.turn = 0;
        self.weight = self.every.max(1);
        Clock { start: ticks(), weight: self.every.max(1) }
    }

    /// Books the time since the start of `clock` on a phase and starts the next.
    #[inline(always)]
    pub fn book(&mut self, phase: Phase, clock: &mut Clock) {
        if clock.weight > 0 {
            let now = ticks();
            self.sums[phase as usize] += now.wrapping_sub(clock.start) * u64::from(clock.weight);
            clock.start = now;
        }
        counted::mark(phase as usize);
    }

    /// Starts a part of a phase of the block under way. Only what a scene asks for has parts.
    #[inline]
    pub fn start(&self) -> u64 {
        if self.weight > 0 { ticks() } else { 0 }
    }

    /// Books the time since [`Ticks::start`] on a part.
    #[inline]
    pub fn book_part(&mut self, part: Part, start: u64) {
        if self.weight > 0 {
            self.add_part(part, ticks().wrapping_sub(start));
        }
    }

    /// Books ticks of a part of the block under way.
    #[inline]
    pub fn add_part(&mut self, part: Part, ticks: u64) {
        self.parts[part as usize] += ticks * u64::from(self.weight);
    }

    /// Books ticks that passed outside of blocks.
    pub fn add(&mut self, phase: Phase, ticks: u64) {
        self.sums[phase as usize] += ticks;
    }

    /// Books ticks that passed outside of blocks on a phase, and on a part of it.
    pub fn add_both(&mut self, phase: Phase, part: Part, ticks: u64) {
        self.add(phase, ticks);
        self.parts[part as usize] += ticks;
    }

    /// The seconds so far at `rate` ticks each; from here on they count anew.
    pub fn take(&mut self, rate: f64) -> Phases {
        let (sums, parts) = (std::mem::take(&mut self.sums), std::mem::take(&mut self.parts));
        Phases { seconds: sums.map(|ticks| ticks as f64 / rate), parts: parts.map(|ticks| ticks as f64 / rate) }
    }
}

/// How fast ticks run, measured since it was made.
pub(crate) struct Rate {
    instant: Instant,
    start: u64,
}

impl Rate {
    /// Starts to measure.
    pub fn start() -> Self {
        Self { instant: Instant::now(), start: ticks() }
    }

    /// Ticks per second.
    pub fn measure(&self) -> f64 {
        let ticks = ticks().wrapping_sub(self.start).max(1);
        ticks as f64 / self.instant.elapsed().as_secs_f64().max(1e-9)
    }
}
