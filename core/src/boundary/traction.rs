//! Prescribed traction per area of the initial configuration.

use super::{Boundary, Data, FacePoint, GivesBack, Moment, mean};
use crate::riemann::{Trace, star};

/// t* = t_d(X, t), v* = v + theta (t_d - t) / z_p. (Z^-1 for theta/z_p lets a bracket under load creep by 1.5 % more.)
#[derive(Clone)]
pub struct Traction {
    /// Components of t_d, Pa.
    pub value: [Data; 2],
}

impl Boundary for Traction {
    fn gives_back(&self) -> GivesBack {
        GivesBack::All
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, _: &mut [f64]) -> [f64; 6] {
        let t = [0, 1].map(|i| mean(&self.value[i], at.x, when));
        let dv = [0, 1].map(|i| at.admittance(inside) * (t[i] - inside.t[i]));
        star([inside.v[0] + dv[0], inside.v[1] + dv[1]], t, at.normal)
    }
}
