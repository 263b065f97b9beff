//! Sources: accelerations b of the momentum balance (2), per unit mass.
//!
//! A new source is one file with a type that implements [`Source`] and its entry in the registry. Without a
//! source nothing is evaluated and nothing stored.

mod damping;
mod pressure_pulse;

pub use damping::Damping;
pub use pressure_pulse::PressurePulse;

use crate::boundary::Data;

/// A source rho0 b of momentum.
pub trait Source: Send + Sync {
    /// Whether b depends on the velocity. Then the predictor evaluates all sources anew in each sweep.
    fn depends_on_velocity(&self) -> bool {
        false
    }

    /// b in m/s^2, at X (m) in the cells with law number `material`, at a time (s) and with the velocity v (m/s) there.
    fn acceleration(&self, x: [f64; 2], time: f64, v: [f64; 2], material: usize) -> [f64; 2];
}

/// A body force given by two expressions, everywhere or in the cells of one law.
#[derive(Clone)]
pub struct BodyForce {
    /// Components of b, m/s^2.
    pub value: [Data; 2],
    /// The law whose cells it acts on; all where there is none.
    pub material: Option<usize>,
}

impl Source for BodyForce {
    fn acceleration(&self, x: [f64; 2], time: f64, _: [f64; 2], material: usize) -> [f64; 2] {
        if self.material.is_some_and(|only| only != material) {
            return [0.0; 2];
        }
        [(self.value[0])(x, time), (self.value[1])(x, time)]
    }
}

#[cfg(test)]
mod tests;
