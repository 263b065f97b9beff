//! Pressure that follows the surface.

use super::{Boundary, Data, FacePoint, GivesBack, Moment, mean};
use crate::riemann::{Trace, star};
use crate::tensor::{cofactor, times};

/// t* = -p (cof F) N, the pressure p on the current area and along the current normal, with F of the inside;
/// v* = v + theta (t* - t) / z_p as under a prescribed traction.
#[derive(Clone)]
pub struct Pressure {
    /// p(X, t), Pa.
    pub value: Data,
}

impl Boundary for Pressure {
    fn gives_back(&self) -> GivesBack {
        GivesBack::All
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, _: &mut [f64]) -> [f64; 6] {
        let p = mean(&self.value, at.x, when);
        let t = times(cofactor(inside.f), at.normal).map(|area| -p * area);
        let v = [0, 1].map(|i| inside.v[i] + at.admittance(inside) * (t[i] - inside.t[i]));
        star(v, t, at.normal)
    }
}
