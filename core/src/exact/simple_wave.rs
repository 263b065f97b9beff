//! The nonlinear simple wave: exact and smooth until it breaks.

use super::{Exact, bisect, speed_integral, uniaxial_speed};
use crate::quadrature::gauss_legendre;
use crate::step::Law;

/// A right-going uniaxial wave: F11(X, t) = F0(xi) on the characteristic X = xi + c(F0(xi)) t,
/// F0 = 1 - a exp(-((X - X0)/w)^2), v1 = -int_1^F11 c dF, c^2 = (dP11/dF11) / rho0.
///
/// Valid where the pulse has left no wall; P11'' < 0 in the neo-Hookean solid, so its compressed front steepens.
#[derive(Debug, Clone)]
pub struct SimpleWave {
    law: Law,
    amplitude: f64,
    centre: f64,
    width: f64,
    /// Gauss rule on [0, 1] for the integral of c, smooth over a strain of a: exact to rounding.
    rule: (Vec<f64>, Vec<f64>),
    /// c at F11 = 1 - a and 1, and nothing outside in between.
    speeds: [f64; 2],
    until: f64,
}

/// Points of the rule: with 16 the integral over strains up to .3 is exact to 1e-16.
const POINTS: usize = 16;
/// Characteristics that the search for the first crossing samples.
const SAMPLES: usize = 4000;

impl SimpleWave {
    /// With amplitude a (below 1), centre X0 and width w (m).
    pub fn new(law: Law, amplitude: f64, centre: f64, width: f64) -> Self {
        let mut wave = Self {
            amplitude,
            centre,
            width,
            rule: gauss_legendre(POINTS),
            speeds: [0.0; 2],
            until: f64::INFINITY,
            law,
        };
        let ends = [uniaxial_speed(&wave.law, 1.0 - amplitude), uniaxial_speed(&wave.law, 1.0)];
        wave.speeds = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        wave.until = wave.breaking();
        wave
    }

    /// F0(X).
    fn start(&self, x: f64) -> f64 {
        1.0 - self.amplitude * (-((x - self.centre) / self.width).powi(2)).exp()
    }

    /// The first time at which two characteristics cross, s: the smallest -1 / (d c(F0)/dX) where c falls.
    fn breaking(&self) -> f64 {
        let h = 1e-5 * self.width;
        let speed = |x: f64| uniaxial_speed(&self.law, self.start(x));
        let at = |k: usize| self.centre + self.width * (6.0 * k as f64 / SAMPLES as f64 - 3.0);
        let slope = |x: f64| (speed(x + h) - speed(x - h)) / (2.0 * h);
        -1.0 / (0..=SAMPLES).map(|k| slope(at(k))).fold(-f64::MIN_POSITIVE, f64::min)
    }

    /// F11 at X and t.
    fn stretch(&self, x: f64, t: f64) -> f64 {
        // Wider than the characteristics need by more than their rounding.
        let reach = self.speeds.map(|c| c * t);
        let pad = 1e-9 * (self.width + reach[1]);
        let gap = |from: f64| from + uniaxial_speed(&self.law, self.start(from)) * t - x;
        self.start(bisect([x - reach[1] - pad, x - reach[0] + pad], gap))
    }
}

impl Exact for SimpleWave {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        [self.stretch(x[0], t), 0.0, 0.0, 1.0]
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        [-speed_integral(&self.law, &self.rule, [1.0, self.stretch(x[0], t)]), 0.0]
    }

    fn until(&self) -> f64 {
        self.until
    }
}
