//! Uniaxial impact on a wall: the exact shock.

use super::{Exact, bisect};
use crate::step::Law;

/// A body in X1 > 0 that flies at v1 = -V against a wall at X1 = 0, and cannot widen.
///
/// Jump conditions (3) across the shock at X1 = S t: S (1 - J) = V and P11(J) (1 - J) = -rho0 V^2. Valid until a wave
/// from another boundary arrives.
#[derive(Debug, Clone)]
pub struct WallImpact {
    speed: f64,
    stretch: f64,
    shock: f64,
}

/// The smallest stretch that is looked at.
const SMALLEST: f64 = 1e-6;

impl WallImpact {
    /// At speed V > 0, m/s.
    pub fn new(law: &Law, speed: f64) -> Self {
        let balance = |j: f64| law.stress([j, 0.0, 0.0, 1.0])[0] * (1.0 - j) + law.density() * speed * speed;
        let stretch = bisect([SMALLEST, 1.0], balance);
        Self { speed, stretch, shock: speed / (1.0 - stretch) }
    }

    /// J = F11 behind the shock.
    pub fn stretch(&self) -> f64 {
        self.stretch
    }

    /// Speed S of the shock in X, m/s.
    pub fn shock(&self) -> f64 {
        self.shock
    }
}

impl Exact for WallImpact {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        [if x[0] < self.shock * t { self.stretch } else { 1.0 }, 0.0, 0.0, 1.0]
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        [if x[0] < self.shock * t { 0.0 } else { -self.speed }, 0.0]
    }
}
