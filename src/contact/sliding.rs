//! Contact of bodies, with Coulomb friction or without.

use super::{Interaction, Meeting, Pairs};
use crate::riemann::tangent;

/// Unilateral contact: with t* and the compliance y of [`Meeting::stick`],
///
/// ```text
/// t_n = min(0, t*_n + max(0, gap)/(y dt)),      |t_s| <= mu |t_n|, in the direction of t*_s
/// ```
///
/// Sides that touch get the star state of the Riemann problem of two bodies where it presses them together; they part where it would
/// pull. Sides that would overlap before the end of the step get what closes the gap by then. The power of both sides is t.(v_1* - v_2*)
/// = -t.(t* - t) y <= 0, for each gap and each friction: contact never makes energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// mu, the coefficient of friction.
    pub friction: f64,
}

impl Interaction for Sliding {
    fn pairs(&self) -> Pairs {
        Pairs::Current
    }

    fn traction(&self, at: &Meeting, _: &mut [f64]) -> [f64; 2] {
        let [(along, compliance), (across, _)] = at.stick();
        let pressed = (along + at.gap.max(0.0) / (compliance * at.step)).min(0.0);
        let held = across.clamp(self.friction * pressed, -self.friction * pressed);
        let (n, s) = (at.normal, tangent(at.normal));
        [0, 1].map(|i| pressed * n[i] + held * s[i])
    }
}
