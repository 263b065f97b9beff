//! Absorbing boundary: nothing comes in.

use super::{Boundary, FacePoint, Moment};
use crate::riemann::{Trace, star};

/// The incoming characteristic is zero: t* = (t - Z v)/2, v* = (v - Z^-1 t)/2, Z with the current normal and speeds of the inside.
#[derive(Debug, Clone, Copy)]
pub struct Absorbing;

impl Boundary for Absorbing {
    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, _: &Moment, _: &mut [f64]) -> [f64; 6] {
        let z = at.characteristic(inside);
        let (zv, v) = (z.times(inside.v), z.solve(inside.t));
        let star_v = [0, 1].map(|i| 0.5 * (inside.v[i] - v[i]));
        let star_t = [0, 1].map(|i| 0.5 * (inside.t[i] - zv[i]));
        star(star_v, star_t, at.normal)
    }
}
