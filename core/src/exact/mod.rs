//! Exact and manufactured solutions.
//!
//! A new solution is one file with a type that implements [`Exact`] and its entry in the registry.

mod linear_bar;
mod manufactured;
mod j2_impact;
mod riemann;
mod simple_wave;
mod vortex;
mod wall_impact;

pub use crate::lane::Dual;
pub use j2_impact::J2Impact;
pub use linear_bar::LinearBar;
pub use manufactured::Manufactured;
pub use riemann::Riemann;
pub use simple_wave::SimpleWave;
pub use vortex::Vortex;
pub use wall_impact::WallImpact;

use crate::source::Source;
use crate::step::Law;
use std::sync::Arc;

/// A solution of (1), (2) in reference coordinates X (m) and time t (s).
pub trait Exact: Send + Sync {
    /// F = [F11, F12, F21, F22].
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4];

    /// v, m/s.
    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2];

    /// Internal variables, of a solution for a law with memory.
    fn internal(&self, _x: [f64; 2], _t: f64) -> Option<Vec<f64>> {
        None
    }

    /// b, m/s^2, of a solution that needs a body force: b = dv/dt - Div P / rho0.
    fn body_force(&self, _x: [f64; 2], _t: f64) -> Option<[f64; 2]> {
        None
    }

    /// The time until which it is the solution, s (a simple wave breaks).
    fn until(&self) -> f64 {
        f64::INFINITY
    }

    /// The number of the law that holds at X, in a solution of several materials.
    fn material(&self, _x: [f64; 2]) -> usize {
        0
    }
}

/// The body force of an exact solution, as a source.
pub struct ExactForce(pub Arc<dyn Exact>);

impl Source for ExactForce {
    fn acceleration(&self, x: [f64; 2], time: f64, _: [f64; 2], _: usize) -> [f64; 2] {
        self.0.body_force(x, time).unwrap_or_default()
    }
}

/// Div P / rho0, m/s^2, where `slopes[a]` is F and its derivative along X_a: through the code of the law itself.
fn acceleration_of_stress(law: &Law, slopes: [[Dual; 4]; 2]) -> [f64; 2] {
    let [along1, along2] = slopes.map(|f| law.stress_and_slope(f));
    [0, 1].map(|i| (along1[2 * i].slope + along2[2 * i + 1].slope) / law.density())
}

/// The law's c_p (m/s) along X1 under uniaxial F11.
fn uniaxial_speed(law: &Law, f11: f64) -> f64 {
    law.speeds([f11, 0.0, 0.0, 1.0], [1.0, 0.0])[0]
}

/// int c dF11 between two values of F11, m/s, by a rule on [0, 1].
fn speed_integral(law: &Law, rule: &(Vec<f64>, Vec<f64>), [from, to]: [f64; 2]) -> f64 {
    let points = rule.0.iter().zip(&rule.1);
    let mean: f64 = points.map(|(s, w)| w * uniaxial_speed(law, from + s * (to - from))).sum();
    mean * (to - from)
}

/// The zero of a function with opposite signs at the ends, to the last bit that bisection can tell.
fn bisect(ends: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    let [mut low, mut high] = ends;
    let sign = function(low) > 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            return middle;
        }
        if (function(middle) > 0.0) == sign { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests;
