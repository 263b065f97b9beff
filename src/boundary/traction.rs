//! Prescribed traction per area of the initial configuration.

use super::{Boundary, Data, FacePoint, TimeNode, mean};
use crate::riemann::{Trace, star};

/// t* = t_d(X, t), v* = v + Z^-1 (t_d - t).
#[derive(Clone)]
pub struct Traction {
    /// Components of t_d, Pa.
    pub value: [Data; 2],
}

impl Boundary for Traction {
    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, times: &[TimeNode]) -> [f64; 6] {
        let t = [0, 1].map(|i| mean(&self.value[i], at.x, times));
        let dv = at.characteristic(inside).solve([0, 1].map(|i| t[i] - inside.t[i]));
        star([inside.v[0] + dv[0], inside.v[1] + dv[1]], t, at.normal)
    }
}
