//! The cost report: seconds per phase of the step, under the paper's names.

use crate::lane::counted;
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

    /// Books the time since `start` on a phase and starts the next.
    #[inline]
    pub(crate) fn book(&mut self, phase: Phase, start: &mut Instant) {
        let now = Instant::now();
        self.seconds[phase as usize] += (now - *start).as_secs_f64();
        *start = now;
        counted::mark(phase as usize);
    }
}
