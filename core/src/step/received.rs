//! What the sides of contact pairs receive in a step.

use std::sync::atomic::{AtomicU64, Ordering};

/// What a side of a segment receives in a step: impulse (2, N s/m) and work (J/m), as bits. The block of its face alone adds to it, point by
/// point and stage by stage, so that the order of its terms is fixed.
#[derive(Debug, Default)]
pub(super) struct ReceivedBySide([AtomicU64; 3]);

impl ReceivedBySide {
    /// Adds what a force f, N/m, does in `dt` at a point with the velocity v.
    pub fn add(&self, f: [f64; 2], v: [f64; 2], dt: f64) {
        let new = [dt * f[0], dt * f[1], dt * (f[0] * v[0] + f[1] * v[1])];
        for (own, new) in self.0.iter().zip(new) {
            let sum = f64::from_bits(own.load(Ordering::Relaxed)) + new;
            own.store(sum.to_bits(), Ordering::Relaxed);
        }
    }

    /// With these numbers.
    pub fn of(values: [f64; 3]) -> Self {
        Self(values.map(|value| AtomicU64::new(value.to_bits())))
    }

    /// The numbers.
    pub fn values(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| f64::from_bits(self.0[k].load(Ordering::Relaxed)))
    }
}
