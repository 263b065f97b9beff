//! The generalised vortex: an annulus of pure rotation, isochoric, at any size of rotation.

use super::{Dual, Exact, acceleration_of_stress};
use crate::lane::Lane;
use crate::step::Law;
use crate::tensor;
use std::f64::consts::PI;

/// x = C + R(q) (X - C), q = g(t) h(|X - C|), g = G sin(pi t / T), h = 1 - 32 s^2 + 256 s^4 with s = |X - C| / L - 1 in the
/// annulus |s| < 1/4 and 0 outside; J = 1, and no traction at the rims, where h' = 0.
///
/// A. de Vaucorbeil, V. P. Nguyen, C. R. Hutchinson, "A Total-Lagrangian Material Point Method for solid mechanics
/// problems involving large deformations", CMAME 360 (2020), with the body force derived for the law given here.
#[derive(Debug, Clone)]
pub struct Vortex {
    law: Law,
    centre: [f64; 2],
    radius: f64,
    amplitude: f64,
    period: f64,
}

impl Vortex {
    /// About `centre` with mean radius L (m), amplitude G (rad) and half period T (s).
    pub fn new(law: Law, centre: [f64; 2], radius: f64, amplitude: f64, period: f64) -> Self {
        Self { law, centre, radius, amplitude, period }
    }

    /// h and dh/dR.
    fn profile(&self, distance: Dual) -> [Dual; 2] {
        let number = Dual::splat;
        let s = distance / number(self.radius) - number(1.0);
        if s.value.abs() >= 0.25 {
            return [number(0.0); 2];
        }
        let square = s * s;
        let h = number(1.0) - number(32.0) * square + number(256.0) * square * square;
        let slope = s * (number(1024.0) * square - number(64.0)) / number(self.radius);
        [h, slope]
    }

    /// The rotation of X in units of g, dh/dR / R, and Y = X - C.
    fn at(&self, x: [Dual; 2]) -> (Dual, Dual, [Dual; 2]) {
        let y = [0, 1].map(|k| x[k] - Dual::splat(self.centre[k]));
        let distance = tensor::dot(y, y).sqrt();
        let [h, slope] = self.profile(distance);
        // At the centre the square root has no slope, and the profile none either.
        if slope.value == 0.0 && h.value == 0.0 { (h, h, y) } else { (h, slope / distance, y) }
    }

    /// F = R(q) (1 + S Y (x) grad q), S = [[0, -1], [1, 0]], grad q = g h' Y / R.
    fn gradient(&self, x: [Dual; 2], t: f64) -> [Dual; 4] {
        let g = Dual::splat(self.amplitude * (PI * t / self.period).sin());
        let (h, slope, y) = self.at(x);
        let ((sine, cosine), k) = ((g * h).sin_cos(), g * slope);
        let one = Dual::splat(1.0);
        let shear = [one - k * y[1] * y[0], -(k * y[1] * y[1]), k * y[0] * y[0], one + k * y[0] * y[1]];
        tensor::times_transposed([cosine, -sine, sine, cosine], [shear[0], shear[2], shear[1], shear[3]])
    }

    /// The current position relative to C, and h.
    fn rotated(&self, x: [f64; 2], t: f64) -> ([f64; 2], f64) {
        let (h, _, y) = self.at(x.map(Dual::splat));
        let (sine, cosine) = (self.amplitude * (PI * t / self.period).sin() * h.value).sin_cos();
        (tensor::times([cosine, -sine, sine, cosine], y.map(|y| y.value)), h.value)
    }
}

impl Exact for Vortex {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        self.gradient(x.map(Dual::splat), t).map(|f| f.value)
    }

    /// v = dq/dt S (x - C).
    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        let (r, h) = self.rotated(x, t);
        let rate = h * self.amplitude * PI / self.period * (PI * t / self.period).cos();
        [-rate * r[1], rate * r[0]]
    }

    fn body_force(&self, x: [f64; 2], t: f64) -> Option<[f64; 2]> {
        let along = |a: usize| [0, 1].map(|k| Dual::new(x[k], if k == a { 1.0 } else { 0.0 }));
        let stress = acceleration_of_stress(&self.law, [self.gradient(along(0), t), self.gradient(along(1), t)]);
        let (r, h) = self.rotated(x, t);
        let pace = PI / self.period;
        let (sine, cosine) = (pace * t).sin_cos();
        let (rate, second) = (h * self.amplitude * pace * cosine, -h * self.amplitude * pace * pace * sine);
        let inertia = [-second * r[1] - rate * rate * r[0], second * r[0] - rate * rate * r[1]];
        Some([0, 1].map(|i| inertia[i] - stress[i]))
    }
}
