//! What a run will cost, from two steps on a copy of its state.

use super::Problem;
use crate::operators::Certificate;
use crate::run::Kept;
use crate::step::{Loss, Motion, Survey};
use std::time::Instant;

/// What a run will cost.
#[derive(Debug, Clone)]
pub struct Cost {
    /// Wave speeds of the state.
    pub survey: Survey,
    /// The first step, s.
    pub dt: f64,
    /// Steps to the end, if all were like the first.
    pub steps: f64,
    /// Seconds to the end on the present number of threads.
    pub seconds: f64,
    /// Bytes of operators, state and work.
    pub bytes: usize,
    /// The certificates of the cells, with the step that each of them allows.
    pub certificates: Vec<Certificate>,
}

impl Problem {
    /// The first step size, and the time of the run from two trial steps on a copy of the state.
    ///
    /// # Errors
    /// A state that is not healthy at a point or a face.
    pub fn cost(&self) -> Result<Cost, Loss> {
        let Self { scheme, state, settings, .. } = self;
        let (mut motion, mesh) = (Motion::of_copy(scheme, state)?, &self.body.mesh);
        let dt = settings.stable_step(scheme, [mesh.smallest_h(), mesh.smallest_height()], motion.survey.fastest);
        let steps = ((settings.end - state.time) / dt).ceil();
        let mut trial = || {
            let clock = Instant::now();
            // What becomes of the first step is for the run to say.
            let _ = motion.attempt(scheme, dt);
            clock.elapsed().as_secs_f64()
        };
        // The first trial touches the memory for the first time.
        let _ = trial();
        let seconds = trial() * steps;
        let of_state = size_of_val(&motion.state.u[..]) + size_of_val(&motion.state.internal[..]);
        let states = of_state + size_of_val(&motion.state.creep[..]) + Kept::bytes(&motion.state);
        let bytes = scheme.operators.bytes() + motion.work.bytes() + states;
        let survey = motion.survey;
        let certificates = self.certificates(&survey);
        Ok(Cost { survey, dt, steps, seconds, bytes, certificates })
    }

    /// The certificates with the step of each cell at these wave speeds.
    fn certificates(&self, survey: &Survey) -> Vec<Certificate> {
        let mut all = self.body.certificates.clone();
        for (certificate, &(block, lane)) in all.iter_mut().zip(&self.scheme.operators.blocks.slot) {
            certificate.dt = self.settings.courant * certificate.h / survey.speed[block].fastest.0[lane];
        }
        all
    }
}
