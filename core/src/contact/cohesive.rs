//! A cohesive edge: a crack that takes energy to open.

use super::{Interaction, Meeting, Overlap, Pairs};
use crate::riemann::tangent;

/// Bilinear law of traction and opening: with the opening w (normal part w_n, tangential part w_s), its size
/// l = sqrt(max(0, w_n)^2 + w_s^2), the largest size so far k, l_0 = s/K at the strength s and l_f = 2 G/s where the edge is broken,
///
/// ```text
/// t = (1 - d) K w,      d = 0 for k <= l_0,  l_f (k - l_0)/(k (l_f - l_0)) up to l_f,  1 from there on
/// ```
///
/// and K w_n undamaged where w_n < 0: broken sides do not pass each other. (The intrinsic law of Geubelle and Baylor, Composites B 29,
/// 1998, with the damage of Camanho and Davila.) The area under the curve is G.
///
/// The opening follows dw/dt = v_2* - v_1*. With E(l), what the edge has taken up to the size l, and w_0, w_1 at the start and the end of the
/// step, the traction is
///
/// ```text
/// t = (E(l_1) - E(l_0))/(l_1 - l_0) (w_0 + w_1)/(l_0 + l_1),      so that t.(w_1 - w_0) = E(l_1) - E(l_0)
/// ```
///
/// whatever the step: what is taken from the body is E to rounding, and G where it is broken. (A discrete gradient: Gonzalez, J. Nonlinear
/// Sci. 6, 1996.)
#[derive(Debug, Clone, PartialEq)]
pub struct Cohesive {
    /// s, Pa.
    pub strength: f64,
    /// G, J/m^2.
    pub energy: f64,
    /// K, Pa/m.
    pub stiffness: f64,
}

/// Opening along the normal and the tangent of the edge, which turn with it and have the same signs from both sides, and k; m.
pub(super) const VIRGIN: [f64; 3] = [0.0; 3];

/// Rounds for the opening at the end of a step. Each makes the edge softer, towards the largest stiffness that agrees with its opening;
/// steps that cross a tenth of l_f take about ten.
const ROUNDS: usize = 100;

/// Change of the stiffness that ends them.
const CLOSE: f64 = 1e-14;

/// l of an opening along normal and tangent.
fn size([along, across]: [f64; 2]) -> f64 {
    along.max(0.0).hypot(across)
}

impl Cohesive {
    /// l_0 and l_f.
    fn ends(&self) -> [f64; 2] {
        [self.strength / self.stiffness, 2.0 * self.energy / self.strength]
    }

    /// The traction at a size that is the largest so far.
    fn envelope(&self, size: f64) -> f64 {
        let [first, last] = self.ends();
        if size <= first { self.stiffness * size } else { (self.strength * (last - size) / (last - first)).max(0.0) }
    }

    /// The area under it.
    fn area(&self, size: f64) -> f64 {
        let [first, last] = self.ends();
        let rise = 0.5 * self.envelope(size.min(first)) * size.min(first);
        let fall = (size.min(last) - first).max(0.0);
        rise + 0.5 * (self.strength + self.envelope(size.max(first))) * fall
    }

    /// (1 - d) K at the largest size so far.
    fn secant(&self, largest: f64) -> f64 {
        if largest <= self.ends()[0] { self.stiffness } else { self.envelope(largest) / largest }
    }

    /// Whether sides of so much length are broken and have slid away from each other: they do not meet then.
    fn has_slid(&self, across: f64, largest: f64, length: f64) -> bool {
        self.secant(largest) == 0.0 && across.abs() > length
    }

    /// (E(l_1) - E(l_0))/((l_1 - l_0)(l_0 + l_1)), Pa/m: half of the secant below the largest size so far.
    fn mean(&self, from: f64, to: f64, largest: f64) -> f64 {
        let secant = self.secant(largest);
        if to <= largest {
            return 0.5 * secant;
        }
        let first = 0.5 * secant * (largest - from) * (largest + from);
        (first + self.area(to) - self.area(largest)) / ((to - from) * (to + from))
    }
}

impl Interaction for Cohesive {
    fn pairs(&self) -> Pairs {
        Pairs::Initial
    }

    fn memory(&self) -> &[f64] {
        &VIRGIN
    }

    fn stored(&self, _: &Overlap, length: f64, memory: &[f64]) -> f64 {
        let [along, across, largest] = memory else { return 0.0 };
        if self.has_slid(*across, *largest, length) {
            return 0.0;
        }
        let axis = |stiffness: f64, opening: f64| 0.5 * stiffness * opening * opening;
        let secant = self.secant(*largest);
        axis(secant, along.max(0.0)) + axis(self.stiffness, along.min(0.0)) + axis(secant, *across)
    }

    fn traction(&self, at: &Meeting, memory: &mut [f64]) -> [f64; 2] {
        let (n, s) = (at.normal, tangent(at.normal));
        let [along, across, largest] = memory else { return [0.0; 2] };
        let (stick, start) = (at.stick(), [*along, *across]);
        let before = size(start);
        // t = m (w_0 + w_1) on an axis, with w_1 = w_0 + dt y (t* - t).
        let pull = |k: usize, mean: f64| {
            let (star, compliance) = stick[k];
            let give = mean * compliance * at.dt;
            (2.0 * mean * start[k] + give * star) / (1.0 + give)
        };
        let end = |k: usize, t: f64| start[k] + at.dt * stick[k].1 * (stick[k].0 - t);
        // Pressed sides are not damaged: they are those that undamaged ones would leave pressed.
        let whole = pull(0, 0.5 * self.stiffness);
        let has_slid = self.has_slid(start[1], *largest, at.length);
        let is_pressed = start[0] + end(0, whole) < 0.0 && !has_slid;
        let (mut mean, mut t) = (0.5 * self.secant(*largest), [0.0; 2]);
        let mut after = before;
        for _ in 0..ROUNDS {
            t = [if is_pressed { whole } else { pull(0, mean) }, pull(1, mean)];
            after = size([end(0, t[0]), end(1, t[1])]);
            let softer = self.mean(before, after, *largest).min(mean);
            if mean - softer <= CLOSE * mean {
                break;
            }
            mean = softer;
        }
        *largest = largest.max(after);
        (*along, *across) = (end(0, t[0]), end(1, t[1]));
        [0, 1].map(|i| t[0] * n[i] + t[1] * s[i])
    }
}
