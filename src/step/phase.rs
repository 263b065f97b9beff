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
    /// The curl-free projection.
    CurlFree,
    /// Law and health at the points: wave speeds, min J.
    Survey,
}

/// Number of phases.
pub const PHASES: usize = 9;

/// Names as printed, in the order of [`Phase`].
pub const NAMES: [&str; PHASES] = [
    "grid to points (22)",
    "predictor (15)-(21)",
    "points to grid (18)",
    "volume term (11)",
    "traces",
    "flux (3), (14)",
    "corrector (13)",
    "curl-free projection",
    "survey (law at points)",
];

/// Seconds per phase.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phases {
    /// Seconds, in the order of [`Phase`].
    pub seconds: [f64; PHASES],
}

impl Phases {
    /// Adds another's seconds.
    pub fn add(&mut self, other: &Phases) {
        self.seconds.iter_mut().zip(other.seconds).for_each(|(a, b)| *a += b);
    }
}

/// Reads the clock between phases. The phases of a block last about a microsecond: the processor's own counter is read,
/// at a tenth of the cost of the system's clock.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock(u64);

impl Clock {
    /// Starts.
    #[inline(always)]
    pub fn now() -> Self {
        Self(ticks())
    }
}

/// Ticks per phase of one thread.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ticks([u64; PHASES]);

impl Ticks {
    /// Books the time since `start` on a phase and starts the next.
    #[inline(always)]
    pub fn book(&mut self, phase: Phase, start: &mut Clock) {
        let now = Clock::now();
        self.0[phase as usize] += now.0.wrapping_sub(start.0);
        *start = now;
        counted::mark(phase as usize);
    }

    /// In seconds of `rate` ticks each.
    pub fn seconds(&self, rate: f64) -> Phases {
        Phases { seconds: self.0.map(|ticks| ticks as f64 / rate) }
    }
}

/// How fast ticks run, measured since it was made.
pub(crate) struct Rate {
    instant: Instant,
    clock: Clock,
}

impl Rate {
    /// Starts to measure.
    pub fn start() -> Self {
        Self { instant: Instant::now(), clock: Clock::now() }
    }

    /// Ticks per second.
    pub fn measure(&self) -> f64 {
        let ticks = Clock::now().0.wrapping_sub(self.clock.0).max(1);
        ticks as f64 / self.instant.elapsed().as_secs_f64().max(1e-9)
    }
}
