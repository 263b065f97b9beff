//! A cohesive edge: a crack that takes energy to open.

use super::{Interaction, Meeting, Pairs};
use crate::riemann::tangent;
use crate::tensor::dot;

/// Bilinear law of traction and separation: with the opening w (normal part w_n, tangential part w_s), its size
/// l = sqrt(max(0, w_n)^2 + w_s^2), the largest size so far k, l_0 = s/K at the strength s and l_f = 2 G/s where the edge is broken,
///
/// ```text
/// t = (1 - d) K w,      d = 0 for k <= l_0,  l_f (k - l_0)/(k (l_f - l_0)) up to l_f,  1 from there on
/// ```
///
/// and K w_n undamaged where w_n < 0: broken sides do not pass each other. The opening follows dw/dt = v_2* - v_1*, and the traction is that of
/// the middle of the step, t = (1 - d) K (w + dt/2 dw/dt): stable for each K, and without loss where nothing is damaged. The area
/// under the curve is G. (The intrinsic law of Geubelle and Baylor, Composites B 29, 1998, with damage after Camanho and Davila.)
#[derive(Debug, Clone, PartialEq)]
pub struct Cohesive {
    /// s, Pa.
    pub strength: f64,
    /// G, J/m^2.
    pub energy: f64,
    /// K, Pa/m.
    pub stiffness: f64,
}

/// Opening along the axes x, y, seen from this side, and k; m.
pub(super) const VIRGIN: [f64; 3] = [0.0; 3];

impl Cohesive {
    /// d for the largest opening so far.
    fn damage(&self, largest: f64) -> f64 {
        let (first, last) = (self.strength / self.stiffness, 2.0 * self.energy / self.strength);
        if largest <= first {
            return 0.0;
        }
        (last * (largest - first) / (largest * (last - first))).min(1.0)
    }

    /// The traction along an axis: k (w + dt/2 (t* - t) y) = t.
    fn of_axis(&self, stiffness: f64, opening: f64, (star, compliance): (f64, f64), dt: f64) -> f64 {
        let half = 0.5 * dt * compliance * stiffness;
        (stiffness * opening + half * star) / (1.0 + half)
    }
}

impl Interaction for Cohesive {
    fn pairs(&self) -> Pairs {
        Pairs::Initial
    }

    fn memory(&self) -> &[f64] {
        &VIRGIN
    }

    fn traction(&self, at: &Meeting, memory: &mut [f64]) -> [f64; 2] {
        let (n, s) = (at.normal, tangent(at.normal));
        let [x, y, largest] = memory else { return [0.0; 2] };
        let (opening, stick) = ([*x, *y], at.stick());
        let (along, across) = (dot(opening, n), dot(opening, s));
        let left = (1.0 - self.damage(*largest)) * self.stiffness;
        let open = self.of_axis(left, along, stick[0], at.dt);
        // Pressed sides are not damaged: which of both holds shows in the sign of what they would do.
        let pressed = self.of_axis(self.stiffness, along, stick[0], at.dt);
        let t = [if pressed < 0.0 { pressed } else { open }, self.of_axis(left, across, stick[1], at.dt)];
        let rate = [0, 1].map(|k| (stick[k].0 - t[k]) * stick[k].1 * at.dt);
        let now = [along + rate[0], across + rate[1]];
        *largest = largest.max(now[0].max(0.0).hypot(now[1]));
        (*x, *y) = (*x + rate[0] * n[0] + rate[1] * s[0], *y + rate[0] * n[1] + rate[1] * s[1]);
        [0, 1].map(|i| t[0] * n[i] + t[1] * s[i])
    }
}
