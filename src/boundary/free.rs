//! Free surface.

use super::{Boundary, FacePoint, TimeNode};
use crate::riemann::{Trace, star};

/// t* = 0, v* = v - theta t / z_p.
#[derive(Debug, Clone, Copy)]
pub struct Free;

impl Boundary for Free {
    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, _: &[TimeNode]) -> [f64; 6] {
        let dv = inside.t.map(|t| at.admittance(inside) * t);
        star([inside.v[0] - dv[0], inside.v[1] - dv[1]], [0.0; 2], at.normal)
    }
}
