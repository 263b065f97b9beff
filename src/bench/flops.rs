//! Flops of one cell in one step, by phase, from the real kernels on counting lanes.

use super::peaks::pool;
use super::{Domain, Setup, Subject};
use crate::error::Result;
use crate::lane::Kernel;
use crate::lane::counted::{self, Counts};
use crate::problem::Problem;
use crate::step::Motion;
use crate::step::phase::PHASES;

/// Cells per direction of the small mesh that stands for a large one of equal cells: whole blocks, no boundary.
const SMALL: [usize; 2] = [8, 8];

/// Operations of one cell in one step and the survey of its result, in the order of [`crate::step::Phase`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flops {
    /// Operations by phase.
    pub phases: [Counts; PHASES],
}

impl Flops {
    /// Flops by phase.
    pub fn of(&self, phase: usize) -> f64 {
        self.phases[phase].flops() as f64
    }

    /// Flops of all phases.
    pub fn total(&self) -> f64 {
        (0..PHASES).map(|phase| self.of(phase)).sum()
    }
}

/// Counts a setup. Fluxes at boundaries and between materials, which go cell by cell, are not on lanes and not counted; the
/// periodic wave has none.
///
/// # Errors
/// Bad input.
pub fn count(setup: &Setup) -> Result<Flops> {
    let domain = match &setup.domain {
        Domain::Cells(_) => Domain::Cells(SMALL),
        file => file.clone(),
    };
    let subject = Setup { domain, kernel: Kernel::Counting, ..setup.clone() }.build()?;
    // Counts are kept by thread.
    Ok(pool(1)?.install(|| count_step(&subject)))
}

fn count_step(subject: &Subject) -> Flops {
    let Subject { problem: Problem { scheme, state: start, settings, .. }, h, .. } = subject;
    let mut motion = Motion::unsurveyed(scheme, start.clone());
    // The wave at its start is healthy, and so after a stable step.
    let _ = motion.survey(scheme);
    let dt = settings.courant * h / motion.survey.fastest;
    let slots = counted::count(|| {
        let _ = motion.advance(scheme, dt);
    });
    let blocks = scheme.operators.blocks.len() as u64;
    let mean = |c: &Counts| Counts {
        additions: c.additions / blocks,
        multiplications: c.multiplications / blocks,
        fused: c.fused / blocks,
        divisions: c.divisions / blocks,
        roots: c.roots / blocks,
    };
    let mut phases = [Counts::ZERO; PHASES];
    phases.iter_mut().zip(&slots).for_each(|(phase, slot)| *phase = mean(slot));
    Flops { phases }
}
