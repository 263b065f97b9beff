//! Damping in proportion to mass.

use super::{Source, Varies};
use crate::boundary::Data;

/// b = -alpha s(X) v, with the share s cut to 0..1. The velocity of a body that nothing else acts on falls as exp(-alpha t).
#[derive(Clone)]
pub struct Damping {
    /// alpha, 1/s.
    pub rate: f64,
    /// s, as in a layer that absorbs waves; 1 everywhere where there is none.
    pub share: Option<Data>,
    /// The law whose cells it acts on; all where there is none.
    pub material: Option<usize>,
}

impl Source for Damping {
    fn varies(&self) -> Varies {
        if self.share.is_some() { Varies { velocity: true, ..Varies::PLACE_AND_TIME } } else { Varies::VELOCITY }
    }

    fn decay(&self) -> f64 {
        self.rate
    }

    fn acceleration(&self, x: [f64; 2], time: f64, v: [f64; 2], material: usize) -> [f64; 2] {
        if self.material.is_some_and(|only| only != material) {
            return [0.0; 2];
        }
        // A share that is not a number stays so.
        let share = self.share.as_ref().map_or(1.0, |share| share(x, time)).clamp(0.0, 1.0);
        v.map(|v| -self.rate * share * v)
    }
}
