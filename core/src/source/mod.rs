//! Sources: accelerations b of the momentum balance (2), per unit mass.
//!
//! A new source is one file with a type that implements [`Source`] and its entry in the registry. Without a
//! source nothing is evaluated and nothing stored.

mod damping;
mod pressure_pulse;

pub use damping::Damping;
pub use pressure_pulse::PressurePulse;

use crate::boundary::Data;

/// What an acceleration varies with. It is evaluated once for all that it does not vary with: gravity once for 8 cells, a force
/// that stands still once for all time nodes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Varies {
    /// X.
    pub place: bool,
    /// t.
    pub time: bool,
    /// v. Then the predictor evaluates all sources anew in each sweep.
    pub velocity: bool,
}

impl Varies {
    /// With X and t.
    pub const PLACE_AND_TIME: Varies = Varies { place: true, time: true, velocity: false };
    /// With v alone.
    pub const VELOCITY: Varies = Varies { place: false, time: false, velocity: true };

    /// What the sum of two accelerations varies with.
    pub fn or(self, other: Varies) -> Varies {
        Varies {
            place: self.place || other.place,
            time: self.time || other.time,
            velocity: self.velocity || other.velocity,
        }
    }
}

/// A source rho0 b of momentum.
pub trait Source: Send + Sync {
    /// What b varies with; place and time unless said otherwise.
    fn varies(&self) -> Varies {
        Varies::PLACE_AND_TIME
    }

    /// The largest rate at which b slows v down, |db/dv|, 1/s: it limits the step. 0 unless said otherwise.
    fn decay(&self) -> f64 {
        0.0
    }

    /// b in m/s^2, at X (m) in the cells with law number `material`, at a time (s) and with the velocity v (m/s) there.
    fn acceleration(&self, x: [f64; 2], time: f64, v: [f64; 2], material: usize) -> [f64; 2];
}

/// A body force given by two expressions, everywhere or in the cells of one law.
#[derive(Clone)]
pub struct BodyForce {
    /// Components of b, m/s^2.
    pub value: [Data; 2],
    /// What they vary with.
    pub varies: Varies,
    /// The law whose cells it acts on; all where there is none.
    pub material: Option<usize>,
}

impl Source for BodyForce {
    fn varies(&self) -> Varies {
        self.varies
    }

    fn acceleration(&self, x: [f64; 2], time: f64, _: [f64; 2], material: usize) -> [f64; 2] {
        if self.material.is_some_and(|only| only != material) {
            return [0.0; 2];
        }
        [(self.value[0])(x, time), (self.value[1])(x, time)]
    }
}

#[cfg(test)]
mod tests;
