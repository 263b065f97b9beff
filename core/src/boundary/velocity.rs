//! Prescribed velocity; with the value zero it is the clamped edge.

use super::{Boundary, Data, FacePoint, Moment, mean};
use crate::riemann::{Trace, star};

/// v* = v_d(X, t), t* = t + z_p (v_d - v).
#[derive(Clone)]
pub struct Velocity {
    /// Components of v_d, m/s.
    pub value: [Data; 2],
}

impl Boundary for Velocity {
    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, _: &mut [f64]) -> [f64; 6] {
        let v = [0, 1].map(|i| mean(&self.value[i], at.x, when));
        let dt = [0, 1].map(|i| at.impedance(inside) * (v[i] - inside.v[i]));
        star(v, [inside.t[0] + dt[0], inside.t[1] + dt[1]], at.normal)
    }
}
