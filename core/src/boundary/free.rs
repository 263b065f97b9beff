//! Free surface.

use super::{Boundary, FacePoint, GivesBack, Moment};
use crate::riemann::{Trace, star};

/// t* = 0, v* = v - Z^-1 t: the outgoing characteristic is kept. (With theta/z_p for Z^-1 a square that spins loses three times as much.)
#[derive(Debug, Clone, Copy)]
pub struct Free;

impl Boundary for Free {
    fn gives_back(&self) -> GivesBack {
        GivesBack::All
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, _: &Moment, _: &mut [f64]) -> [f64; 6] {
        star(velocity(inside, at), [0.0; 2], at.normal)
    }
}

/// v* of a free surface, m/s.
pub(super) fn velocity(inside: &Trace<f64>, at: &FacePoint) -> [f64; 2] {
    let dv = at.characteristic(inside).solve(inside.t);
    [inside.v[0] - dv[0], inside.v[1] - dv[1]]
}
