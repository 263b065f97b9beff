//! What contact pairs give to each other in a step: force and work of one boundary group on another.

use super::meetings::Meetings;
use super::{Scheme, Work};
use crate::state::Received;
use crate::sum::ExactSum;
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

    fn values(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| f64::from_bits(self.0[k].load(Ordering::Relaxed)))
    }
}

impl Scheme {
    /// How many entries [`crate::state::State::received`] has: the boundary groups, then both sides of each pair of [`Scheme::pairs`], what
    /// the first receives from the second and the second from the first.
    pub fn receivers(&self) -> usize {
        self.boundaries.len() + 2 * self.contacts.as_ref().map_or(0, |contacts| contacts.len())
    }
}

impl Work {
    /// Adds what pairs gave to each other in the last step to the entries behind the `groups` of the new state, by exact sums over segments.
    pub(super) fn receive_from_pairs(&mut self, groups: usize) {
        let Some(Meetings { segments, received: Some(received), .. }) = self.meetings.as_deref() else { return };
        let into = self.next.received.get_mut(groups..).unwrap_or_default();
        for (pairing, into) in into.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let own = || segments.iter().zip(received).filter(|(segment, _)| segment.pairing == pairing);
            for (side, Received { impulse, work }) in into.iter_mut().enumerate() {
                let mut sums: [ExactSum; 3] = Default::default();
                for (_, received) in own() {
                    sums.iter_mut().zip(received[side].values()).for_each(|(sum, value)| sum.add(value));
                }
                let [one, two, more] = sums.map(|sum| sum.value());
                *impulse = [impulse[0] + one, impulse[1] + two];
                *work += more;
            }
        }
    }
}
