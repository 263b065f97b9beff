//! Contact of bodies, with Coulomb friction or without.

use super::{Interaction, Meeting, Overlap, Pairs};
use crate::riemann::tangent;
use crate::tensor::dot;

/// Unilateral contact: with t* and the compliance y of [`Meeting::stick`],
///
/// ```text
/// t_n = min(0, t*_n + max(0, gap)/(y dt)),      |t_s| <= mu |t_n|, in the direction of t*_s
/// ```
///
/// Sides that touch get the star state of the Riemann problem of two bodies where it presses them together; they part where it would
/// pull. Sides that would overlap before the end of the step get what closes the gap by then. The power of both sides is t.(v_1* - v_2*)
/// = -t.(t* - t) y <= 0, for each gap and each friction: contact never makes energy.
///
/// Displacements follow the velocities of the bodies, not the star state, so that an impact leaves an overlap of the order of
/// v h/c. A spring between the sides takes it back: the traction k min(0, gap) n is added to t, not to the velocities v*, and its power
/// is then that of the traces, -d/dt (k/2 min(0, gap)^2): what it gives back it has taken before. k is [`PUSH`] times the stiffness of
/// the cells, see [`Overlap::stiffness`]; sides that part get [`BACK`] of it, since the direction of n between faces that are not parallel
/// is not quite that of the gap (a corner of 45 degrees on a flat side made .4 % of energy with all of it).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// mu, the coefficient of friction.
    pub friction: f64,
}

/// k over the stiffness of the cells of both sides in a row. With 2 overlaps of impacts stay below .35 of a cell but for soft
/// bodies at half of their wave speed, and no step of degree 1 to 3 was seen to grow; larger degrees and other values were not tried.
const PUSH: f64 = 2.0;

/// The part of the push that sides get which part already.
const BACK: f64 = 0.5;

impl Sliding {
    /// k/2 depth.
    fn half(overlap: &Overlap) -> f64 {
        0.5 * PUSH * overlap.stiffness * overlap.depth
    }
}

impl Interaction for Sliding {
    fn pairs(&self) -> Pairs {
        Pairs::Current
    }

    fn push(&self, at: &Meeting) -> f64 {
        let [one, two] = &at.sides;
        let rate = dot(two.v, at.normal) - dot(one.v, at.normal);
        2.0 * Self::half(&at.overlap) * if rate > 0.0 { BACK } else { 1.0 }
    }

    fn stored(&self, overlap: &Overlap, _: f64, _: &[f64]) -> f64 {
        Self::half(overlap) * overlap.depth
    }

    fn traction(&self, at: &Meeting, _: &mut [f64]) -> [f64; 2] {
        let [(along, compliance), (across, _)] = at.stick();
        let pressed = (along + at.gap.max(0.0) / (compliance * at.step)).min(0.0);
        let most = self.friction * (self.push(at) - pressed);
        let held = across.clamp(-most, most);
        let (n, s) = (at.normal, tangent(at.normal));
        [0, 1].map(|i| pressed * n[i] + held * s[i])
    }
}
