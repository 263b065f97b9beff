//! A manufactured solution: periodic, smooth, 2D, nonlinear.

use super::{Dual, Exact, acceleration_of_stress};
use crate::lane::Lane;
use crate::step::Law;
use std::f64::consts::TAU;

/// u1 = a/k sin(k X1) cos(k X2 + .4) g(t), u2 = a/k cos(k X1 + .7) sin(k X2) g(t), g = cos(w t + .3), with k = 2 pi / L and
/// w = .8 k c_p: periodic over L in both directions. Its body force is b = d2u/dt2 - Div P / rho0.
#[derive(Debug, Clone)]
pub struct Manufactured {
    law: Law,
    amplitude: f64,
    k: f64,
    frequency: f64,
}

impl Manufactured {
    /// With strain amplitude a and period L (m).
    pub fn new(law: Law, amplitude: f64, length: f64) -> Self {
        let k = TAU / length;
        let c = law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0];
        Self { law, amplitude, k, frequency: 0.8 * k * c }
    }

    fn phase(&self, t: f64) -> f64 {
        self.frequency * t + 0.3
    }

    /// (sin k X1 cos(k X2 + .4), cos(k X1 + .7) sin k X2) / k, m.
    fn shape(&self, x: [f64; 2]) -> [f64; 2] {
        let [a, b] = x.map(|x| self.k * x);
        [a.sin() * (b + 0.4).cos() / self.k, (a + 0.7).cos() * b.sin() / self.k]
    }

    /// F at X, whose coordinates carry their slopes.
    fn gradient(&self, x: [Dual; 2], t: f64) -> [Dual; 4] {
        let scale = Dual::splat(self.amplitude * self.phase(t).cos());
        let angle = |x: Dual, shift: f64| (x * Dual::splat(self.k) + Dual::splat(shift)).sin_cos();
        let ((sin_a, cos_a), (sin_b, cos_b)) = (angle(x[0], 0.0), angle(x[1], 0.4));
        let ((sin_c, cos_c), (sin_d, cos_d)) = (angle(x[0], 0.7), angle(x[1], 0.0));
        let one = Dual::splat(1.0);
        [one + scale * cos_a * cos_b, -(scale * sin_a * sin_b), -(scale * sin_c * sin_d), one + scale * cos_c * cos_d]
    }
}

impl Exact for Manufactured {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        self.gradient(x.map(Dual::splat), t).map(|f| f.value)
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        let rate = -self.amplitude * self.frequency * self.phase(t).sin();
        self.shape(x).map(|u| rate * u)
    }

    fn body_force(&self, x: [f64; 2], t: f64) -> Option<[f64; 2]> {
        let along = |a: usize| [0, 1].map(|k| Dual::new(x[k], if k == a { 1.0 } else { 0.0 }));
        let stress = acceleration_of_stress(&self.law, [self.gradient(along(0), t), self.gradient(along(1), t)]);
        let inertia = -self.amplitude * self.frequency * self.frequency * self.phase(t).cos();
        let shape = self.shape(x);
        Some([0, 1].map(|i| inertia * shape[i] - stress[i]))
    }
}
