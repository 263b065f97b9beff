//! A pulse of pressure in a disc of the body.

use super::Source;
use std::f64::consts::PI;

/// b = -grad p / rho0 of a pressure p = A (1 - q^2)^3 sin^2(pi s) within q = |X - X_c|/R < 1, 0 < s = (t - t_0)/D < 1, in the initial
/// configuration. p is twice differentiable over the edge of the disc, b is once, and sin^2 starts and ends without a jump of its rate. The
/// sum of the forces is 0 where the disc lies within the body.
#[derive(Debug, Clone, Copy)]
pub struct PressurePulse {
    /// A, Pa.
    pub amplitude: f64,
    /// X_c, m.
    pub centre: [f64; 2],
    /// R, m.
    pub radius: f64,
    /// t_0, s.
    pub start: f64,
    /// D, s.
    pub duration: f64,
    /// rho0 of the body, kg/m^3.
    pub density: f64,
    /// The law whose cells it acts on; all where there is none.
    pub material: Option<usize>,
}

impl Source for PressurePulse {
    fn acceleration(&self, x: [f64; 2], time: f64, _: [f64; 2], material: usize) -> [f64; 2] {
        let s = (time - self.start) / self.duration;
        if self.material.is_some_and(|only| only != material) || !(0.0..1.0).contains(&s) {
            return [0.0; 2];
        }
        let off = [0, 1].map(|i| (x[i] - self.centre[i]) / self.radius);
        let left = 1.0 - (off[0] * off[0] + off[1] * off[1]);
        if left <= 0.0 {
            return [0.0; 2];
        }
        let now = self.amplitude * (PI * s).sin().powi(2);
        off.map(|off| 6.0 * now * left * left * off / (self.radius * self.density))
    }
}
