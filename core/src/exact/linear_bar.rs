//! The linear elastic bar: d'Alembert's solution with its reflections.

use super::{Exact, uniaxial_speed};
use crate::step::Law;

/// A bar 0 < X1 < L, a wall at its left end and a free right end, which cannot widen and is released at rest from the
/// strain e0 = -a exp(-((X1 - X0)/w)^2).
///
/// v = (l + r)/2, c e = (l - r)/2 with r = v - c e constant on X1 - c t, l = v + c e on X1 + c t; at the wall v = 0,
/// r = -l, at the free end e = 0, l = r. The strain at both ends must vanish at the start.
#[derive(Debug, Clone)]
pub struct LinearBar {
    length: f64,
    amplitude: f64,
    centre: f64,
    width: f64,
    c: f64,
}

impl LinearBar {
    /// With length L (m), amplitude a, centre X0 and width w (m); the law is linear.
    pub fn new(law: &Law, length: f64, amplitude: f64, centre: f64, width: f64) -> Self {
        Self { length, amplitude, centre, width, c: uniaxial_speed(law, 1.0) }
    }

    /// c e0, m/s.
    fn start(&self, x: f64) -> f64 {
        -self.c * self.amplitude * (-((x - self.centre) / self.width).powi(2)).exp()
    }

    /// r or l (`leftward`) carried to the end of its characteristic from X1 = x at t = 0, beyond the ends of the bar.
    fn carried(&self, mut x: f64, mut leftward: bool) -> f64 {
        let mut sign = 1.0;
        loop {
            if x < 0.0 && !leftward {
                (x, leftward, sign) = (-x, true, -sign);
            } else if x > self.length && leftward {
                (x, leftward) = (2.0 * self.length - x, false);
            } else {
                return sign * if leftward { self.start(x) } else { -self.start(x) };
            }
        }
    }

    /// r and l.
    fn invariants(&self, x: f64, t: f64) -> [f64; 2] {
        [self.carried(x - self.c * t, false), self.carried(x + self.c * t, true)]
    }
}

impl Exact for LinearBar {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        let [r, l] = self.invariants(x[0], t);
        [1.0 + 0.5 * (l - r) / self.c, 0.0, 0.0, 1.0]
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        let [r, l] = self.invariants(x[0], t);
        [0.5 * (l + r), 0.0]
    }
}
